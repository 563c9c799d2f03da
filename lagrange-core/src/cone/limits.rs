//! Chosen constants of the solver of contacts.

use crate::number::limits::ACCUMULATED;

/// Part of its terms by which a rate may be off the law, part of a change of velocities by which it may be off its reactions, and part of the
/// largest pivot below which rows depend on one another: rounding leaves 10⁻¹⁶ to 10⁻¹⁵ of those. With ranks at 10⁻¹⁴ to 10⁻¹², as many of
/// 6,000 random impacts of each kind stay undecided, but for 6 of 113.
pub(crate) const ACCURACY: f64 = 1e-12;

/// Part of its energy that a motion may gain. Defects of rates by [`ACCURACY`] do less work than that up to reactions of GAIN/ACCURACY = 1,000
/// times the largest rate: energy is looked at beyond.
pub(super) const GAIN: f64 = 1e-9;

/// Round-off of a sum, as a part of its terms.
pub(super) const ROUND_OFF: f64 = ACCUMULATED * f64::EPSILON;

/// Factor from one compliance to the next one. Steps of a hundredth or a thousandth leave 1.4 to 3 times as many problems to other guesses.
pub(super) const STIFFER: f64 = 0.1;

/// The same where Newton's method does not settle after it, beyond which guesses end. With 0.5, 10 in the place of 4 of 6,000 impacts of bodies
/// whose masses differ by 10⁸ stay undecided; with no second try, one of 6,000 on independent rows.
pub(super) const SLOWEST: f64 = 0.8;

/// Solved equations of faces, times the number of rows, after which no other reactions are tried to begin with: one stack of 40 contacts took
/// half a minute without this limit. Few contacts come to [`STARTS`] before.
pub(super) const WORK: usize = 40_000;

/// Largest number of initial guesses of the reactions. Problems without a solution, such as Painlevé's rod, try all of them: 200 guesses
/// took its random cases seven minutes, 24 take one.
pub(super) const STARTS: usize = 24;
