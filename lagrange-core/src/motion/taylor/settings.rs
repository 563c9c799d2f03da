//! Settings of Taylor's method.

use crate::motion::method::contract::{Limits, limit_setters};

/// Taylor's method. Each step is a power series of the motion about its start; the derive emits the recurrences of its
/// coefficients (Jorba and Zou, *Experimental Mathematics* 14 (2005) 99–117).
///
/// It is for smooth motions with errors below about 10⁻⁹, down to round-off, which is the default. The accelerations
/// and multipliers of all orders are solved for with one factorization, of the matrix at the start of the step. So
/// constraints cost nothing extra, and the cost of a chain is proportional to its length. Constraints of second degree
/// need the fewest sums: state a rod by the square of its length.
///
/// The order follows from the tolerance: 18 for 10⁻⁹, 29 for round-off. The step length follows from the last five
/// coefficients, zeros excepted, because only every fourth may be nonzero after a symmetric start. It is at most ten
/// times that of the step before; the first step changes the state by at most its size. A step is rejected if the
/// accelerations of the series at its end differ from those of the equations by more than the tolerance.
///
/// Rounding errors of the states are carried along (compensated summation). Each state is projected onto the
/// constraints. Its velocities move along the Hamiltonian vector fields of the constraints, so a rounding error in the
/// distance of a body does not change its angular momentum and energy. With constraints, and without magnetic fields
/// and damping, the energy makes a random walk of 9·10⁻¹⁶ of the kinetic energy in a step of 2½ rad, and drifts by some
/// 10⁻¹⁸ a step. The dense output is the series itself.
///
/// # Forces that the series misses
///
/// A force may vanish to round-off at the start of a step and be strong within: a wall by `tanh`, a pulse in time by
/// `exp`, a high power of a sine. The series does not contain such a force. So the equations are also sampled within a
/// step, at up to 128 times, in two cases. The first is a large change of the argument of `exp`, `tanh`, `sinh` or
/// `cosh`, of the base of a power of 16 or more, or of an argument that a field declares. The second is a step more
/// than twice as long as the one before whose series has few terms. The samples are guaranteed to detect a force wider
/// than the distance between two of them, and a Gaussian pulse with a standard deviation of a tenth of that distance.
/// All other steps are compared with the equations at their ends, where a pulse of an eighth of a step shows. Narrower
/// forces can be missed, as by every method that evaluates at points. So can those inside a
/// [`Function`](crate::Function), of which only its values are known. [`max_step`](Self::max_step) tells the method how
/// narrow forces are.
///
/// # Singular poses and kinks
///
/// If constraints become dependent at an isolated pose, a step crosses it by a series that is cut off before the orders
/// that consist of rounding errors, usually with an error of about 10⁻¹². If no step can, the motion ends before the
/// pose.
///
/// A root that reaches zero has a kink there, as √x² has, which its series does not contain. Steps shrink towards it,
/// about thirty on each side, until a step across it makes no difference. If a force jumps there, no step is short
/// enough, and the motion ends at that time. A power whose exponent is a parameter cannot be expanded where its base is
/// zero.
///
/// # Systems
///
/// A system with `abs`, `min`, `max` or `clamp` in its equations has no [`TaylorSeries`](crate::TaylorSeries), which is
/// a compiler error. The same holds with a function that is not defined over every scalar, or whose third derivatives
/// the equations take. A [`Function`](crate::Function) is evaluated on a [`PowerSeries`](crate::PowerSeries) at every
/// order. Kinks inside it are detected at the end of each step and at three times within, to 10⁻¹⁰ of the velocities or
/// 10⁴ tolerances, whichever is more. Parameters may change between steps. A step allocates no memory.
///
/// In an ensemble, four members, or eight with AVX-512, are expanded at once on SIMD lanes, each with its own step:
/// `Ensemble::integrate_on_lanes`. Derivatives of a motion come from the recurrences over dual numbers, to ten times
/// the tolerance: [`integrate_sensitivities`](crate::Linearized::integrate_sensitivities).
///
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(x, y)]
/// #[lagrangian((x_dot^2 + y_dot^2)/2 + 1/sqrt(x^2 + y^2))]
/// struct Kepler;
///
/// // An ellipse of eccentricity 0.5, ten times around.
/// let start = State::new([0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
/// let end = 20.0 * std::f64::consts::PI;
/// let path = Kepler.integrate(start, end, Taylor::default())?;
/// assert!((path.end().coordinate("x")? - 0.5).abs() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Taylor {
    pub(super) relative: f64,
    pub(super) absolute: f64,
    pub(super) max_step: Option<f64>,
    pub(super) limits: Limits,
}

/// Tolerances at round-off, at most 100 000 steps, no limit on wall-clock time.
impl Default for Taylor {
    fn default() -> Self {
        Self::with_tolerance(f64::EPSILON)
    }
}

impl Taylor {
    /// Sets relative and absolute tolerance to the same number.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self { relative: tolerance, absolute: tolerance, max_step: None, limits: Limits::default() }
    }

    /// Sets the relative tolerance: the error allowed as a fraction of each entry of the state. A tolerance below ε of
    /// the scalar counts as ε.
    pub fn relative_tolerance(self, tolerance: f64) -> Self {
        Self { relative: tolerance, ..self }
    }

    /// Sets the absolute tolerance: the error allowed in the unit of each entry. It matters for entries near zero.
    pub fn absolute_tolerance(self, tolerance: f64) -> Self {
        Self { absolute: tolerance, ..self }
    }

    /// Sets the longest step allowed, in units of time.
    pub fn max_step(self, step: f64) -> Self {
        Self { max_step: Some(step), ..self }
    }

    limit_setters! {
        /// Sets the limit on the number of attempted steps.
    }
}
