//! Names of entries of a state and of rows of the equations, for messages and tables.

use core::fmt::{self, Display, Formatter};

/// An entry of a state: the time, a coordinate `x`, its velocity `x_dot` (`r_dot[0]` for an element `r[0]`), or its
/// momentum `p(x)`; or a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entry {
    /// The time.
    Time,
    /// The generalized coordinate of this name.
    Coordinate(&'static str),
    /// The generalized velocity of the coordinate of this name.
    Velocity(&'static str),
    /// The generalized momentum of the coordinate of this name.
    Momentum(&'static str),
    /// The parameter of this name.
    Parameter(&'static str),
    /// An entry of a system whose coordinates have no names: its half, 0 for coordinates and 1 for velocities, and its index.
    Numbered(usize, usize),
}

impl Display for Entry {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time => f.write_str("t"),
            Self::Coordinate(name) | Self::Parameter(name) => f.write_str(name),
            Self::Velocity(name) => {
                let (base, index) = name.split_at(name.find('[').unwrap_or(name.len()));
                write!(f, "{base}_dot{index}")
            }
            Self::Momentum(name) => write!(f, "p({name})"),
            Self::Numbered(half, index) => write!(f, "{}[{index}]", if *half == 0 { "q" } else { "q_dot" }),
        }
    }
}

/// A row of the equations of motion: the equation of a coordinate, or a constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// The Euler–Lagrange equation of this coordinate.
    Coordinate(&'static str),
    /// The constraint of this name.
    Constraint(&'static str),
    /// The equation of the coordinate of this index, in a system whose coordinates have no names.
    Numbered(usize),
}

impl Display for Row {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Coordinate(name) => write!(f, "coordinate `{name}`"),
            Self::Constraint(name) => write!(f, "constraint `{name}`"),
            Self::Numbered(index) => write!(f, "coordinate `q[{index}]`"),
        }
    }
}

/// A list of names: the first four, and the total count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Names {
    first: [&'static str; 4],
    count: usize,
}

impl Names {
    /// Returns the stored names, at most four.
    pub fn as_slice(&self) -> &[&'static str] {
        self.first.get(..self.count).unwrap_or(&self.first)
    }
}

impl FromIterator<&'static str> for Names {
    fn from_iter<I: IntoIterator<Item = &'static str>>(names: I) -> Self {
        let mut all = Self::default();
        for name in names {
            if let Some(slot) = all.first.get_mut(all.count) {
                *slot = name;
            }
            all.count += 1;
        }
        all
    }
}

impl Display for Names {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (i, name) in self.as_slice().iter().enumerate() {
            write!(f, "{}`{name}`", if i == 0 { "" } else { ", " })?;
        }
        match self.count - self.as_slice().len() {
            0 => Ok(()),
            more => write!(f, " and {more} more"),
        }
    }
}

/// Returns the name at `index`, or `?` if there is none.
pub(crate) fn name(names: &'static [&'static str], index: usize) -> &'static str {
    names.get(index).copied().unwrap_or("?")
}

/// Serializes entries and rows as the text of their `Display`.
#[cfg(feature = "serde")]
mod written {
    use serde::{Serialize, Serializer};

    use super::{Entry, Row};

    macro_rules! as_text {
        ($($type:ty),*) => {$(
            impl Serialize for $type {
                fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    serializer.collect_str(self)
                }
            }
        )*};
    }

    as_text!(Entry, Row);
}
