//! Fingerprints that tell the rows of one run from those of another.

use core::fmt::{self, Write};

use crate::number::Real;
use crate::system::{Lagrangian, State};

/// Whose row it is: three hashes, each the 32-bit FNV-1a of Fowler, Noll and Vo, the same on every machine.
///
/// Rows whose hashes differ are of different runs. Another run passes for this one by chance once in 4·10⁹ times. Code and
/// what it holds cannot be seen: events, a controller, an observer, functions supplied to the system, equations written by hand.
/// A run with one of them is told from another by its [tag](super::Ensemble::tag) alone, and none is resumed without. Limits
/// on steps and time do not count: they may be raised for the members that met them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fingerprint {
    /// Of the system: its declaration ([`Lagrangian::DIGEST`]), its name, coordinates and constraints, and its number type.
    pub system: u32,
    /// Of the method and its settings, whether it was on lanes, the end, the times and quantities of samples, the events by name,
    /// direction, subdivisions and terminal count, the interval of the controller, and the [tag](super::Ensemble::tag).
    pub run: u32,
    /// Hash of the member's initial time, coordinates, velocities and parameters, bit for bit.
    pub start: u32,
}

impl Fingerprint {
    /// What all members of all runs of a system have in common.
    pub(super) fn of_system<L, const N: usize, const M: usize>() -> u32
    where
        L: Lagrangian<N, M, Scalar: Real>,
    {
        let mut system = Hash::new();
        [L::NAME].iter().chain(&L::COORDINATES).chain(&L::CONSTRAINTS).for_each(|text| system.text(text));
        system.bytes(&L::DIGEST.to_le_bytes());
        system.number(L::Scalar::EPSILON);
        system.0
    }

    /// With what one member starts from.
    pub(super) fn with_start<L, const N: usize, const M: usize>(
        self,
        system: &L,
        start: &State<L::Scalar, N>,
    ) -> Self
    where
        L: Lagrangian<N, M, Scalar: Real>,
    {
        let mut hash = Hash::new();
        hash.number(start.t.to_f64());
        start.q.iter().chain(&start.v).for_each(|x| hash.number(x.to_f64()));
        system.visit_parameters(&mut |x| hash.number(x.to_f64()));
        Self { start: hash.0, ..self }
    }

    /// In what two rows of one member differ, and in which column of a table that is.
    pub(super) fn difference(&self, other: &Self) -> Option<(usize, &'static str)> {
        let Self { system, run, start } = *other;
        let differences = [
            (2, OTHER_SYSTEM, self.system != system),
            (3, "the method, one of its settings, an event, the tag or the end is another", self.run != run),
            (4, OTHER_START, self.start != start),
        ];
        differences.into_iter().find_map(|(column, what, differs)| differs.then_some((column, what)))
    }

    /// As of another member of the run.
    pub(super) fn without_start(self) -> Self {
        Self { start: 0, ..self }
    }
}

pub(super) const OTHER_SYSTEM: &str = "the system or its equations are others";
pub(super) const OTHER_START: &str = "the start or the parameters of the member are others";

/// FNV-1a hash of the bytes written so far.
pub(super) struct Hash(pub(super) u32);

impl Hash {
    pub(super) fn new() -> Self {
        Self(0x811c_9dc5)
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |hash, byte| (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193));
    }

    /// With a mark at its end, which no text has.
    pub(super) fn text(&mut self, text: &str) {
        self.bytes(text.as_bytes());
        self.bytes(&[0xff]);
    }

    #[cfg(feature = "parquet")]
    pub(super) fn value(&self) -> u32 {
        self.0
    }

    pub(super) fn number(&mut self, x: f64) {
        self.bytes(&x.to_bits().to_le_bytes());
    }
}

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.bytes(text.as_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values that its authors publish.
    #[test]
    fn the_hash_is_that_of_its_authors() {
        let hash = |text: &str| {
            let mut hash = Hash::new();
            hash.bytes(text.as_bytes());
            hash.0
        };
        assert_eq!([hash(""), hash("a"), hash("foobar")], [0x811c_9dc5, 0xe40c_292c, 0xbf9c_f968]);
    }
}
