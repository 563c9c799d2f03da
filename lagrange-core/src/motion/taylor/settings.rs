//! The settings of Taylor's method.

use crate::motion::method::Limits;

/// Taylor's method: each step is a power series of the motion about its start, whose coefficients come from recurrences
/// that the derive has found (Jorba and Zou, *Experimental Mathematics* 14 (2005) 99–117).
///
/// For smooth motions with errors below about 10⁻⁹, down to round-off, which is the default. The coefficients of accelerations
/// and multipliers of all orders are solved for with the one matrix that the equations have at the start of the step, so that
/// constraints cost nothing extra, and a chain as much as its length. Constraints of second degree take the fewest sums: state a rod by
/// the square of its length.
///
/// The order follows from the tolerance, 18 for 10⁻⁹ and 29 for round-off; the length of a step from the last five
/// coefficients, zeros passed over: from a symmetric start every fourth alone may be there. It is at most ten times that of the step
/// before; the first step moves the state by its size at most. A step is refused where the accelerations of the series at its end are
/// not those of the equations, to the tolerance. Rounding errors of the
/// states are carried along (compensated sums); each state is projected onto the constraints, its velocities along the
/// Hamiltonian vector fields of the constraints, so that what rounding does to the distance of a body leaves its angular momentum
/// and energy. On constraints, without magnetic fields and damping, energy changes as a random walk, of 9·10⁻¹⁶ of the kinetic energy in a step of 2½ rad, and
/// drifts by some 10⁻¹⁸ a step. Between its ends a step is the series itself.
///
/// A force may vanish to round-off where a step begins and be strong within: a wall by `tanh`, a pulse in time by `exp`, a high power
/// of a sine. The series does not know such a force. So the equations are also sampled within a step, at up to 128 times, wherever the
/// argument of `exp`, `tanh`, `sinh` or `cosh` or the base of a power of 16 or more, or one that a field says, goes far, and wherever a step gets more than
/// twice as long while its series has few terms. Guaranteed is that a force wider than the distance between two samples is seen, and a
/// Gaussian pulse whose standard deviation is a tenth of that distance. All other steps are compared with the equations at
/// their ends, where a pulse of an eighth of a step shows. Narrower forces can be missed, as by every method that evaluates at
/// points, and so can those inside of a [`Function`](crate::Function), of which only its values are known:
/// [`max_step`](Self::max_step) says how wide the narrowest is.
///
/// Where constraints become dependent at one pose alone, a step leads across it by a series that is cut off before the orders that
/// consist of rounding errors, to about 10⁻¹² as a rule; where none does, the motion ends before the pose.
///
/// A root that comes down to zero has a kink there, as √x² has, which its series does not know. Steps shrink towards it, about
/// thirty on each side, until a step across it changes nothing. Where a force jumps there, no step is short enough, and the motion
/// ends at that time. A power whose exponent is a parameter cannot be expanded where its base is zero.
///
/// A system with `abs`, `min`, `max` or `clamp` in its equations has no [`TaylorSeries`](crate::TaylorSeries), nor one with a function that is not known over
/// every scalar or whose third derivatives the equations take, and the compiler says so. A [`Function`](crate::Function) is evaluated on a [`PowerSeries`](crate::PowerSeries) at every order; of
/// kinks inside of it each step is aware at its end and three times within, to 10⁻¹⁰ of the velocities or 10⁴ tolerances, whichever is
/// more. Parameters may change between steps. Nothing is allocated in a step.
/// In an ensemble four members, or eight with AVX-512, are expanded at once on SIMD lanes, each with its own step: `Ensemble::integrate_on_lanes`.
/// Derivatives of a motion come from the recurrences over dual numbers, to ten times the tolerance:
/// [`integrate_sensitivities`](crate::Linearized::integrate_sensitivities).
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

/// Tolerances at round-off, at most 100 000 steps, no limit on wall time.
impl Default for Taylor {
    fn default() -> Self {
        Self::with_tolerance(f64::EPSILON)
    }
}

impl Taylor {
    /// This relative and absolute tolerance.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self { relative: tolerance, absolute: tolerance, max_step: None, limits: Limits::default() }
    }

    /// The error allowed as a fraction of each entry. Below the round-off unit of the scalar it counts as that.
    pub fn relative_tolerance(self, tolerance: f64) -> Self {
        Self { relative: tolerance, ..self }
    }

    /// The error allowed in the unit of each entry, which matters where the entry is about zero.
    pub fn absolute_tolerance(self, tolerance: f64) -> Self {
        Self { absolute: tolerance, ..self }
    }

    /// The longest step allowed.
    pub fn max_step(self, step: f64) -> Self {
        Self { max_step: Some(step), ..self }
    }

    /// Sets the limit on the number of attempted steps.
    pub fn max_steps(mut self, steps: usize) -> Self {
        self.limits.max_steps = steps;
        self
    }

    /// How long the integration may take by the clock on the wall.
    #[cfg(feature = "std")]
    pub fn wall_time(mut self, limit: std::time::Duration) -> Self {
        self.limits.wall_time = Some(limit);
        self
    }
}
