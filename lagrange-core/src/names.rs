//! Names of entries of a state and of rows of the equations, for messages and tables.

use core::fmt::{self, Debug, Display, Formatter};
use core::ops::Deref;

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
    /// The generalized coordinate of this name, in a system that [writes its names](WrittenName).
    WrittenCoordinate(WrittenName),
    /// The generalized velocity of the coordinate of this name, in a system that writes its names.
    WrittenVelocity(WrittenName),
}

impl Display for Entry {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time => f.write_str("t"),
            Self::Coordinate(name) | Self::Parameter(name) => f.write_str(name),
            Self::Velocity(name) => write_velocity(name, f),
            Self::Momentum(name) => write!(f, "p({name})"),
            Self::WrittenCoordinate(name) => f.write_str(name),
            Self::WrittenVelocity(name) => write_velocity(name, f),
        }
    }
}

/// Writes the name of the velocity of a coordinate: `r_dot[0]` for `r[0]`.
pub(crate) fn write_velocity(coordinate: &str, to: &mut dyn fmt::Write) -> fmt::Result {
    let (base, index) = coordinate.split_at(coordinate.find('[').unwrap_or(coordinate.len()));
    write!(to, "{base}_dot{index}")
}

/// A row of the equations of motion: the equation of a coordinate, or a constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// The Euler–Lagrange equation of this coordinate.
    Coordinate(&'static str),
    /// The constraint of this name.
    Constraint(&'static str),
    /// The equation of the coordinate of this name, in a system that writes its names.
    Written(WrittenName),
    /// The constraint of this name, in a system that writes its names.
    WrittenConstraint(WrittenName),
}

impl Display for Row {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Coordinate(name) => write!(f, "coordinate `{name}`"),
            Self::Constraint(name) => write!(f, "constraint `{name}`"),
            Self::Written(name) => write!(f, "coordinate `{name}`"),
            Self::WrittenConstraint(name) => write!(f, "constraint `{name}`"),
        }
    }
}

/// Name of a coordinate of a system whose length is known when the program runs: `r[3][1]`, or `q[3]` where the accelerations alone are
/// stated. It is written when a message needs it, without an allocation. Of a long name the end is kept, which has the indices.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct WrittenName {
    text: [u8; Self::ROOM],
    length: u8,
}

impl WrittenName {
    /// Bytes of a name. An error with two of them, [`Error::DerivativeNotFinite`](crate::Error::DerivativeNotFinite), takes no more room
    /// than the largest with [`Names`].
    const ROOM: usize = 39;

    /// Returns the name that a function writes.
    pub fn of(write: impl FnOnce(&mut dyn fmt::Write) -> fmt::Result) -> Self {
        let mut name = Self { text: [0; Self::ROOM], length: 0 };
        // Writing to memory does not fail; after an error of the function's own the name is what it wrote until then.
        write(&mut name).ok();
        name
    }

    fn push(&mut self, byte: u8) {
        if usize::from(self.length) == Self::ROOM {
            self.text.copy_within(1.., 0);
            self.length -= 1;
        }
        self.text[usize::from(self.length)] = byte;
        self.length += 1;
    }
}

impl fmt::Write for WrittenName {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.bytes().for_each(|byte| self.push(byte));
        Ok(())
    }
}

impl Deref for WrittenName {
    type Target = str;

    fn deref(&self) -> &str {
        let bytes = &self.text[..usize::from(self.length)];
        // A character whose first byte is lost is lost.
        let whole = bytes.iter().position(|byte| byte & 0xC0 != 0x80).unwrap_or(0);
        core::str::from_utf8(&bytes[whole..]).unwrap_or("?")
    }
}

impl Display for WrittenName {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self)
    }
}

impl Debug for WrittenName {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Debug::fmt(&**self, f)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn written(text: &str) -> WrittenName {
        WrittenName::of(|to| text.chars().try_for_each(|c| to.write_char(c)))
    }

    #[test]
    fn entries_have_the_names_that_a_system_writes() {
        let name = written("r[3][1]");
        assert_eq!(Entry::WrittenCoordinate(name).to_string(), "r[3][1]");
        assert_eq!(Entry::WrittenVelocity(name).to_string(), "r_dot[3][1]");
        assert_eq!(Row::Written(name).to_string(), "coordinate `r[3][1]`");
        assert_eq!(Entry::WrittenVelocity(written("θ")).to_string(), "θ_dot");
    }

    /// Characters are kept whole.
    #[test]
    fn a_long_name_keeps_its_end() {
        let long = "θ".repeat(30) + "[3][1]";
        assert_eq!(*written(&long), *("θ".repeat(16) + "[3][1]"));
        assert_eq!(*written(&"x".repeat(39)), *"x".repeat(39));
        assert_eq!(*written(&("y".to_string() + &"x".repeat(39))), *"x".repeat(39));
    }
}
