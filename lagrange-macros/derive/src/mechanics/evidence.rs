//! Certainty of a statement about a system.

use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Verdict};

/// Evidence for a statement: a proof, or tests at random points.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Evidence {
    /// Zeros vanish in canonical form; nonzeros have a value whose error bound excludes 0.
    Proved,
    /// The statement held at this many random points, to rounding.
    Held(u32),
}

impl Evidence {
    /// Evidence of a zero; `None` if the expression is not zero or the test is undecided.
    pub(super) fn of(verdict: Verdict) -> Option<Self> {
        match verdict {
            Verdict::Zero => Some(Self::Proved),
            Verdict::Held(points) => Some(Self::Held(points)),
            Verdict::NonZero | Verdict::Undecided => None,
        }
    }

    /// Evidence of a statement that follows from two others: the weaker one.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Proved, other) | (other, Self::Proved) => other,
            (Self::Held(first), Self::Held(second)) => Self::Held(first.min(second)),
        }
    }
}

/// Evidence that an expression is zero everywhere; `None` if it is not zero or cannot be decided.
pub(super) fn vanishes(graph: &mut Graph, problem: &Problem, root: Id) -> Option<Evidence> {
    Evidence::of(graph.is_zero(root, |symbol, draw| problem.drawn(symbol, draw)))
}
