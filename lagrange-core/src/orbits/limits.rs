//! Limits of the search for periodic orbits, and of the steps along their families.

/// Largest ratio of a period to its guess, or of the guess to it. All motions close after no time, so a search that gets there has
/// left what it was told to find.
pub(super) const LOST: f64 = 10.0;
