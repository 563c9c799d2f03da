//! Chosen numbers of methods, of their step control, and of the search for events.

// Steps of embedded pairs

/// Fraction of the predicted step that is taken, so that few steps are rejected (Hairer, Nørsett and Wanner, *Solving Ordinary
/// Differential Equations I*, II.4). Also the fraction of the limit of stability from which a step counts as limited by it.
pub(crate) const SAFETY: f64 = 0.9;

/// Least error of the last step, in units of the tolerance, that the PI controller takes into account, as in `DOPRI5`.
pub(super) const LEAST_ERROR: f64 = 1e-4;

/// Change of the state by the first guess of the first step, in units of its size; and error of Euler's method over the first
/// step, in units of the tolerance (II.4).
pub(super) const FIRST_CHANGE: f64 = 0.01;

/// Size and rate of a state, in units of the tolerance, up to which they tell no step (II.4).
pub(super) const VANISHING: f64 = 1e-5;

/// Part of the time left that the first guess of a step is, where size and rate of the state tell none (II.4).
pub(super) const BLIND: f64 = 1e-6;

/// Largest ratio of the first step to its first guess (II.4).
pub(crate) const FIRST: f64 = 100.0;

/// Tolerance of variations, in units of the tolerance of the motion. Errors of variations are usually about ten times
/// larger; they should shorten steps only if the error of the motion is no guide.
pub(crate) const SLACK: f64 = 10.0;

/// Number of trial steps by which a problem is found to be stiff: more than a third of them are limited by stability.
pub(super) const TRIALS: usize = 15;

/// Widest gap between stages, as a fraction of the step, across which they bound the multipliers. A dip 1 − a exp(−(t/w)²) below
/// zero with w = 0.15 steps, as narrow as the search for events finds all, then shows at a stage.
pub(super) const WIDEST: f64 = 0.3;

/// Number of points at which the Lebesgue function of the stages is taken. It is smooth between stages, so that the error of its largest
/// value falls with the square of this number.
pub(super) const POINTS: usize = 256;

// Steps of implicit methods with steps of one length

/// Number of sweeps after which the hidden terms of an equation count, too. A slow iteration does not end early by them,
/// because its residuals are then far above their round-off.
pub(super) const PATIENCE: usize = 20;

/// Fraction of the visible terms up to which a residual may be the round-off of hidden terms.
pub(super) const HIDDEN: f64 = 1e-3;

/// Largest residual that may remain where it no longer shrinks, in units of ε of its terms: in double precision, and in single
/// precision, where that of double precision would be an error of 5·10⁻⁴.
pub(crate) const REMAINING: [f64; 2] = [4096.0, 32.0];

/// Longest cycle of round-off. Most are of two sweeps: a rounded force pushes the coordinates across the boundary between
/// two of its values, and back.
pub(super) const LONGEST_CYCLE: usize = 4;

/// Largest part by which constraints may have turned since their factorization: an iteration with it then converges.
pub(super) const TURN: f64 = 0.25;

/// Largest ratio of a step to the step before up to which the stages of the step before are extrapolated. A polynomial of
/// degree S − 1 amplifies their rounding errors by the ratio to the power S − 1.
pub(super) const FARTHEST: f64 = 16.0;

// Search for events

/// Highest Chebyshev degree, and number of subintervals between its points, which include the points of all lower degrees. Half
/// of it is the first degree of a motion.
pub(super) const FINEST: usize = 32;

/// Lowest Chebyshev degree.
pub(super) const COARSEST: usize = 4;

/// Ratio of magnitudes from which the smaller one is neglected in the choice of the Chebyshev degree: a coefficient beside the
/// variation of the function, and the variation beside the size of the function.
pub(super) const RESOLVED: f64 = 256.0;

/// Ratio of a step to an interval within it, up to which the interval tells the Chebyshev degree of later steps. Beyond the square of this
/// ratio, low degrees alone are used: the interval surrounds a jump or a pole, which no degree resolves.
pub(super) const WIDE: f64 = 8.0;

/// Largest coefficient that may be all noise, as a part of the noise.
pub(super) const NOISE: f64 = 0.25;

/// Largest number of intervals searched on the way to one crossing; after that, no interval is halved.
pub(super) const INTERVALS: usize = 4096;

/// Crossings count as accumulating after this many consecutive short intervals. Half as many suffice if the state or
/// system changes at each crossing: a function may have a few close zeros, but repeated changes indicate
/// accumulation.
pub(super) const CLOSE_CROSSINGS: usize = 6;

// Records

/// Largest number of regular samples that memory is reserved for before the motion, which may end long before its end time.
pub(super) const RESERVED: usize = 1 << 16;
