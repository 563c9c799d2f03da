//! Fingerprints that distinguish the table rows of different runs.

use core::fmt::{self, Write};

use crate::StateOf;
use crate::generic::Numbers;
use crate::motion::{Simulate, SystemChecks};
use crate::number::Real;
use crate::solution::system_checks::ChecksOf;

/// Identifies the run and the member of a table row by three hashes: 32-bit FNV-1a (Fowler, Noll and Vo), the same on
/// every machine.
///
/// Rows with different hashes come from different runs. Two different runs have equal hashes by chance once in 4·10⁹
/// times. The hashes cannot see code and the values that it captures: events, quantities, a controller, an observer, functions
/// supplied to the system, equations written by hand. Only its [tag](super::Ensemble::tag) distinguishes a run with
/// such code from another, and such a run is not resumed without a tag. Limits on steps and wall-clock time are left
/// out: they may be raised for the members that reached them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fingerprint {
    /// Hash of the system: its declaration ([`Lagrangian::DIGEST`](crate::Lagrangian::DIGEST)), name, coordinates, constraints and number type.
    pub system: u32,
    /// Hash of the run: the method and its settings, whether members ran on SIMD lanes, the end time, the times and
    /// quantities of samples, the events (name, direction, subdivisions, terminal count), the interval of the
    /// controller, and the [tag](super::Ensemble::tag).
    pub run: u32,
    /// Hash of the member's initial time, coordinates, velocities and parameters, bit for bit, and of its switches.
    pub start: u32,
}

impl Fingerprint {
    /// Hash of a system, the same for all members of all runs.
    pub(super) fn of_system<L: Simulate>() -> u32 {
        let mut system = Hash::new();
        let names = ChecksOf::<L>::COORDINATES.iter().chain(ChecksOf::<L>::CONSTRAINTS);
        [ChecksOf::<L>::name()].iter().chain(names).for_each(|text| system.text(text));
        system.bytes(&ChecksOf::<L>::DIGEST.to_le_bytes());
        system.number(L::Scalar::EPSILON);
        system.0
    }

    /// Adds the hash of a member's start and parameters to the fingerprint of its run.
    pub(super) fn with_start<L: Simulate>(self, system: &L, start: &StateOf<L>) -> Self {
        let mut hash = Hash::new();
        hash.number(start.t.to_f64());
        start.q.entries().iter().chain(start.v.entries()).for_each(|x| hash.number(x.to_f64()));
        ChecksOf::<L>::visit_numbers(system, &mut |x| hash.number(x));
        Self { start: hash.0, ..self }
    }

    /// First difference between two rows of one member.
    pub(super) fn difference(&self, other: &Self) -> Option<&'static str> {
        let Self { system, run, start } = *other;
        let differences = [
            (OTHER_SYSTEM, self.system != system),
            (OTHER_RUN, self.run != run),
            (OTHER_START, self.start != start),
        ];
        differences.into_iter().find_map(|(what, differs)| differs.then_some(what))
    }

    /// Fingerprint of the run alone, to compare rows of different members.
    #[cfg(feature = "tables")]
    pub(super) fn without_start(self) -> Self {
        Self { start: 0, ..self }
    }
}

const OTHER_SYSTEM: &str = "the system or its equations are others";
const OTHER_RUN: &str =
    "the method, one of its settings, a sample, a quantity, an event, the tag or the end is another";
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

    /// Hashes a text and an end mark, the byte 0xff, which never occurs in UTF-8.
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

    /// Test values published by the authors of FNV.
    #[test]
    fn the_hash_is_that_of_its_authors() {
        let hash = |text: &str| {
            let mut hash = Hash::new();
            hash.bytes(text.as_bytes());
            hash.0
        };
        assert_eq!([hash(""), hash("a"), hash("foobar")], [0x811c_9dc5, 0xe40c_292c, 0xbf9c_f968]);
    }

    /// What comes first in one text and what ends the other are told apart.
    #[test]
    fn texts_end_where_they_end() {
        let hash = |texts: [&str; 2]| {
            let mut hash = Hash::new();
            texts.into_iter().for_each(|text| hash.text(text));
            hash.0
        };
        assert_ne!(hash(["a", "bc"]), hash(["ab", "c"]));
    }
}
