//! How sure a statement about a system is.

use core::fmt::{self, Display, Formatter};

/// What stands behind a verdict of the derive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Evidence {
    /// What must vanish vanishes by the form of its expression, and what must not has a value whose error bound
    /// excludes zero.
    Proved,
    /// It held, to rounding, at this many random points (that satisfy the constraints); 0 where none could be found, so that
    /// nothing is known.
    Held(u32),
}

impl Display for Evidence {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Proved => f.write_str("proved"),
            Self::Held(0) => f.write_str("no random point was found at which it could be judged"),
            Self::Held(points) => write!(f, "as far as {points} random points show"),
        }
    }
}
