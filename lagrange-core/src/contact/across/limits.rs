//! Chosen constants of motions across contacts.

/// Part of a motion or a step in time that counts as an instant. What bodies move in it from rest is the least size of which round-off is
/// taken, and no gap between them.
pub(super) const INSTANT: f64 = 1e-6;

/// Part of the error that a step may have, within which two velocities of friction are zero together. The direction of a velocity of
/// 64 such errors, or a sixteenth of a step's, is known well enough to slide along.
pub(super) const STILL: f64 = 1.0 / 1024.0;

/// Part of the largest force by which friction at rest may exceed its limit, or a contact may pull, at the start of a leg. It may be off
/// by as much more before the leg ends, so that forces are off their law by 10⁻⁶. The solver of dependent contacts shares forces by
/// their least norm, which need not be within the limits.
pub(super) const BEYOND: f64 = 5e-7;

/// Time within which a bounce is searched for, in units of v/a: it takes 2. The end is at no simple part of it, where a zero
/// would fall on the division of a step.
pub(super) const BOUNCE: f64 = 2.7;

/// Largest number of transitions unless [`max_transitions`](crate::MotionBuilder::max_transitions) sets another, and of impacts at one time.
/// Each takes energy, or passes it on to the next of bodies in a row. A light ball that two heavy ones hit in turn takes thousands, until its
/// rates are round-off.
pub(super) const TRANSITIONS: usize = 100_000;

/// Part of the largest speed so far by which a velocity of friction that stops may differ from zero: two velocities pass zero as closely as
/// the errors of the motion let them. With 10⁻⁸, a puck whose load turns takes 10⁵ steps and more where it stops for a moment. The velocity of a
/// slider at its dead centre is zero because of the place: nothing stops there.
pub(super) const STOPPED: f64 = 1e-6;
