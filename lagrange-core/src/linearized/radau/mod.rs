//! The methods Radau IIA of order 5, 9 and 13, for stiff systems.

mod chart;
mod collocation;
mod coupled;
mod equations;
mod estimate;
mod iteration;
mod limits;
mod memory;
mod pose;
mod step;
mod tableau;
mod variations;

use nalgebra::Const;

use crate::motion::method::contract::{Limits, limit_setters};
use crate::motion::method::control::Tolerance;
use crate::number::Real;

pub use collocation::Collocation;
pub use memory::RadauMemory;
pub use tableau::RadauStages;

/// The implicit Runge–Kutta method Radau IIA with 3, 5 or 7 stages, of order 5, 9 or 13: for stiff systems.
///
/// Strong damping and stiff springs force an explicit method to steps as short as their time constants. The steps of this
/// method are as long as the motion allows, because it is L-stable: what decays fast is damped out. It takes any system
/// with derivatives ([`StateDerivatives`](crate::StateDerivatives)): the iteration for the stages uses the exact ∂q̈/∂q
/// and ∂q̈/∂q̇. The constraints are eliminated from the accelerations, redundant ones by their rank, and each step ends
/// on them.
///
/// Step-size control, the simplified Newton iteration and the starting values are those of Hairer and Wanner (*Solving
/// Ordinary Differential Equations II*, IV.8; "Stiff differential equations solved by Radau methods", *Journal of
/// Computational and Applied Mathematics* 111, 1999). Dense output is the collocation polynomial, of the order of the number
/// of stages.
///
/// Where stiff forces turn within a step, as on a stiff spring that swings, the iteration takes the derivatives at each stage. Such
/// motions lose the order of the method to that of its stages: take 5 or 7.
///
/// A pose at which constraints depend on one another, as where a linkage folds flat, is crossed on the branch of the motion.
/// Where multipliers grow without bound towards it, the motion ends before
/// ([`Error::UnboundedMultipliers`](crate::Error::UnboundedMultipliers)).
///
/// Derivatives have no value on the kink of a force, as of |x| at x = 0; there they are evaluated beside it, within the
/// tolerance.
///
/// Derivatives of a motion ([`integrate_sensitivities`](crate::Linearized::integrate_sensitivities)) are those of its steps at
/// fixed step lengths, by the implicit function theorem at the stages. Their errors are estimated as that of the motion, and limit
/// the steps as for other methods: where a motion rests, or a damping stops what a velocity starts, derivatives need the shorter ones.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// A spring in honey.
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(x_dot^2/2 - x^2/2)]
/// #[dissipation(c/2 * x_dot^2)]
/// struct Slow { c: f64 }
///
/// let path = Slow { c: 1e6 }.integrate(State::at_rest([1.0]), 1e6, Radau::default())?;
/// // x = e^(−t/c), but for the start.
/// assert!((path.end().coordinate("x")? - (-1.0_f64).exp()).abs() < 1e-6);
/// assert!(path.statistics().accepted < 200);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Radau<const STAGES: usize = 3> {
    relative: f64,
    absolute: f64,
    max_step: Option<f64>,
    first_step: Option<f64>,
    limits: Limits,
}

/// Relative and absolute tolerance 10⁻⁹, at most 100 000 steps, no limit on wall-clock time.
impl Default for Radau {
    fn default() -> Self {
        Self::with_tolerance(1e-9)
    }
}

impl Radau {
    /// Sets relative and absolute tolerance to the same number.
    pub fn with_tolerance(tolerance: f64) -> Self {
        let (max_step, first_step) = (None, None);
        Self { relative: tolerance, absolute: tolerance, max_step, first_step, limits: Limits::default() }
    }

    /// Sets the number of stages: 3, 5 or 7, for order 5, 9 or 13. More stages take fewer steps to small errors: for 10⁻⁹ of
    /// a car axis 4,400, 260 and 90.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Lagrangian)]
    /// # #[coordinates(x)]
    /// # #[lagrangian(x_dot^2/2 - x^2/2)]
    /// # struct Spring;
    /// let method = Radau::with_tolerance(1e-12).stages::<7>();
    /// let path = Spring.integrate(State::at_rest([1.0]), 10.0, method)?;
    /// assert!((path.end().coordinate("x")? - 10.0_f64.cos()).abs() < 1e-11);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn stages<const STAGES: usize>(self) -> Radau<STAGES>
    where
        Const<STAGES>: RadauStages,
    {
        let Self { relative, absolute, max_step, first_step, limits } = self;
        Radau { relative, absolute, max_step, first_step, limits }
    }
}

impl<const STAGES: usize> Radau<STAGES> {
    /// Sets the relative tolerance: the error allowed as a fraction of each entry of the state.
    pub fn relative_tolerance(self, tolerance: f64) -> Self {
        Self { relative: tolerance, ..self }
    }

    /// Sets the absolute tolerance: the error allowed in the unit of each entry.
    pub fn absolute_tolerance(self, tolerance: f64) -> Self {
        Self { absolute: tolerance, ..self }
    }

    limit_setters! {
        /// Sets the limit on steps, rejected ones included.
    }

    /// Sets the longest step allowed, in units of time.
    pub fn max_step(self, step: f64) -> Self {
        Self { max_step: Some(step), ..self }
    }

    /// Sets the first step to try, instead of an estimate.
    pub fn first_step(self, step: f64) -> Self {
        Self { first_step: Some(step), ..self }
    }

    /// Tolerances of the error estimate.
    fn tolerance<T: Real>(&self) -> Tolerance {
        let wanted = self.relative.max(16.0 * T::EPSILON);
        let relative = limits::PART * of_estimate::<T, STAGES>(wanted);
        Tolerance { relative, absolute: relative * (self.absolute / wanted) }
    }
}

/// Error of the estimate for an error of the method. The estimate is of the order of the stages, and overestimates the error of the
/// method: as in Hairer and Wanner's program, the power of this error that makes the steps those of the order of the method.
fn of_estimate<T: Real, const STAGES: usize>(error: f64) -> f64 {
    iteration::power::<T>(error, (STAGES + 1) as f64 / (2 * STAGES) as f64)
}
