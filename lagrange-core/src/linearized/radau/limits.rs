//! Constants of Radau's step control and iteration.
//!
//! Ranges were measured by evaluations and errors of 1,400 motions by 3, 5 and 7 stages, at tolerances from 10⁻⁴ to 10⁻¹²: Andrews'
//! squeezer, a car axis, a slider crank, rods in honey, stiff springs that swing, dry friction, relaxation oscillations, four-bar
//! linkages that fold flat, and bodies that slide along two velocities.

/// Part of the tolerance, of the order of the estimate, that the estimate may use (Hairer and Wanner, program RADAU5). Errors of a car
/// axis by 3, 5 and 7 stages then are 90, 6 and 1 tolerances in the mean; 0.03 costs a fifth more and makes them a quarter.
pub(super) const PART: f64 = 0.1;

/// Least ratio of a step to the one before, as in RADAU5, and that after a first step whose error is too large.
pub(super) const SHRINK: f64 = 0.2;

/// Largest ratio of a step to the one before, as in RADAU5.
pub(super) const GROWTH: f64 = 8.0;

/// Largest ratio of a step to the one before for which it keeps the length, and the factorizations with it, as in RADAU5.
pub(super) const SAME: f64 = 1.2;

/// Contraction of the iteration below which it is as good as exact: the next step uses the derivatives again, as in RADAU5.
pub(super) const REUSED: f64 = 1e-3;

/// Largest contraction of the iteration that the next step aims for (Gustafsson and Söderlind, *Control strategies for the iterative
/// solution of nonlinear equations in ODE solvers*, 1997). It grows with the length of a step. From 0.25 to 0.5 evaluations differ by
/// 2 %; with 0.2 and less, dry friction takes many more.
pub(super) const CONTRACTION: f64 = 0.4;

/// Largest ratio of a correction to the one before, with the derivatives at each stage. It measures how far the guess is from the
/// solution, and 1/4 is the bound that Kantorovich's theorem leaves it (Deuflhard, *Newton Methods for Nonlinear Problems*, 2.1).
/// With 1/4, springs that swing led in one of 60 motions to errors above 10⁻⁴, with 1/10 in one of 270.
pub(super) const FAST: f64 = 0.1;

/// Two limits of steps with derivatives at each stage. They are taken where they are longer by this factor than steps with the derivatives
/// at the start: with a factor of 1, evaluations grow by 1 % and factorizations of seven stages by a tenth. They are at most longer by
/// this factor than the step before, whose polynomial is their guess: without this limit, swinging stiff springs take up to a fifth more
/// evaluations.
pub(super) const COUPLED: f64 = 2.0;

/// Growth of the longest step with the derivatives at its start, after one for which the iteration did not converge: a longer one is
/// tried once in ten. With 1.2, evaluations grow by 2 %.
pub(super) const RETRIED: f64 = 1.05;

/// Error of an iteration, in units of the tolerance, that counts for nothing, as in RADAU5. From 0.001 to 0.1 nothing changes at
/// tolerances below 10⁻³, where the power of the tolerance is smaller.
pub(super) const NEGLIGIBLE: f64 = 0.03;
