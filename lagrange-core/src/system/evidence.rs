//! How sure a statement about a system is.

/// What stands behind a verdict of the derive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Evidence {
    /// What must vanish vanishes by the form of its expression, and what must not has a value whose error bound
    /// excludes zero.
    Proved,
    /// It held, to rounding, at this many random points (that satisfy the constraints).
    Held(u32),
}
