//! Certainty of a statement about a system.

use core::fmt::{self, Display, Formatter};

/// Evidence for a verdict of the derive macro.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Evidence {
    /// Exact: zeros vanish in canonical form, and nonzeros have a value whose error bound excludes zero.
    Proved,
    /// Numerical: the statement holds, to rounding, at this number of random points that satisfy the
    /// constraints. For 0 no such point was found, so nothing is known.
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
