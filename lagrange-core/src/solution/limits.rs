//! Chosen numbers of solutions and of projections onto constraints.

/// Number of nearby states by which the round-off of a function is estimated. They change all entries with random signs, and
/// underestimate the sum of the effects of all entries by more than a half with a probability of less than 1 in 250: all eight
/// would have to lie below the median of the magnitude.
pub(crate) const NEIGHBOURS: u64 = 8;

/// Ratio of the possible error of a function to its largest change between these states, for what they do not show.
pub(crate) const MARGIN: f64 = 16.0;

/// Number of refinements of a solution of the general solver. On independent constraints, errors of multipliers up to 10⁷ of 1
/// were gone after four.
pub(super) const REFINEMENTS: usize = 4;

/// Number of states from which an assembly begins.
pub(super) const STARTS: usize = 10;

/// Number of directions, beside the remainders of the dependent rows, along which second derivatives are taken. A nonzero
/// quadratic form H may vanish along one of them by chance, but hardly along three.
pub(super) const DIRECTIONS: usize = 3;

/// Displacement of the coordinates, as a part of a unit, for the test whether a gradient vanishes throughout a neighbourhood;
/// and part of a step over which differences give the impulse of a correction, to a thousandth of it.
pub(super) const ASIDE: f64 = 1.0 / 1024.0;

/// Share, as a part of the largest, from which a coordinate is named in an error.
pub(super) const NAMED: f64 = 0.1;

/// Largest correction of coordinates that velocities follow, in units of 64 ε: beside dependent constraints corrections are
/// larger. And the size of the coordinates up to which they follow, in units of their change in a step: angular rates are about
/// 3 per step at most, so that velocities change, relatively, by at most 50 times as much as coordinates.
pub(super) const FOLLOWED: f64 = 16.0;

/// Corrections with which a projection reaches round-off at the end of a step: the step leaves a residual of about its tolerance, the first
/// correction about the square of that.
pub(super) const CORRECTIONS: usize = 3;
