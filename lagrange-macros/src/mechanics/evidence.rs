//! How sure a statement about a system is.

use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Verdict};

/// Proved, or only tried.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Evidence {
    /// What must vanish vanishes by its canonical form, and what must not has a value whose error bound excludes 0.
    Proved,
    /// It held at this many random points, to rounding.
    Held(u32),
}

impl Evidence {
    /// Evidence of a statement that follows from two others: the weaker one.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Proved, other) | (other, Self::Proved) => other,
            (Self::Held(first), Self::Held(second)) => Self::Held(first.min(second)),
        }
    }
}

/// Whether an expression is zero everywhere, and why one may think so.
pub(super) fn vanishes(graph: &mut Graph, problem: &Problem, root: Id) -> Option<Evidence> {
    match graph.is_zero(root, |symbol, draw| problem.drawn(symbol, draw)) {
        Verdict::Zero => Some(Evidence::Proved),
        Verdict::Held(points) => Some(Evidence::Held(points)),
        Verdict::NonZero | Verdict::Undecided => None,
    }
}
