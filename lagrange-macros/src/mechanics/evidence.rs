//! How sure a statement about a system is.

/// Proved, or only tried.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Evidence {
    /// What must vanish vanishes by its canonical form, and what must not has a value whose error bound excludes 0.
    Proved,
    /// It held at this many random points, to rounding.
    Held(u32),
}

impl Evidence {
    /// Of a statement that rests on two others.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Proved, other) | (other, Self::Proved) => other,
            (Self::Held(first), Self::Held(second)) => Self::Held(first.min(second)),
        }
    }
}
