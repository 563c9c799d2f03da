//! Limits of the search for periodic orbits, and of the steps along their families.

/// Largest ratio of a period to its guess, or of the guess to it. All motions close after no time, so a search that gets there has
/// left what it was told to find.
pub(super) const LOST: f64 = 10.0;

/// Tangent of the largest angle between neighbours of a family, 20°; a step over which the family turns or strays more is halved. 20°
/// are small enough that a step does not end on another family that crosses at a right angle.
pub(super) const BEND: f64 = 0.36;

/// Steps of Newton's method up to which the next step along a family is longer. Where more are needed, errors are those of the motion,
/// and longer steps end in its noise.
pub(super) const EASY: usize = 6;

/// Factor by which a step along a family grows after it was taken.
pub(super) const GROWTH: f64 = 1.3;

/// Part below which something vanishes beside its unit: the error of a member beside the size of the orbit, the test of a bifurcation
/// at its zero beside its values at both neighbours, the distance of a fold from a branch point beside the step. At a zero the search
/// gains a digit or more with each member and ends far below; at a pole or a jump it gains none.
pub(super) const VANISHING: f64 = 1e-3;

/// Angle by which multipliers may turn in a step, in radians, at their rate where it starts. A pair that passes 1 or −1 within such
/// a step shows it by the slopes of its test.
pub(super) const TURN: f64 = core::f64::consts::FRAC_PI_2;

/// Minimum of a cubic, as part of the values at the ends, above which the test is taken not to reach zero between. Of a pair of
/// multipliers that turns by 90°, through 1 or −1, the cubic errs by 6 % of these values.
pub(super) const SHALLOW: f64 = 0.5;
