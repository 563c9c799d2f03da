//! Chosen numbers of the functions that users supply.

/// Number of step lengths of differences, each half of the one before: from 0.1 to 10⁻⁴ of the argument, below which round-off of the
/// first derivatives exceeds what is to be found.
pub(super) const STEPS: usize = 11;
