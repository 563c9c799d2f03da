//! How the motion depends on where it starts, on the parameters and on the time: Jacobians, equilibria, linearization.

#[cfg(feature = "alloc")]
mod across;
#[cfg(feature = "alloc")]
mod argument;
#[cfg(feature = "alloc")]
mod columns;
#[cfg(feature = "alloc")]
mod display;
#[cfg(feature = "alloc")]
mod dual_sample;
#[cfg(feature = "alloc")]
mod equilibrium;
#[cfg(feature = "alloc")]
mod francis;
#[cfg(feature = "alloc")]
mod inverse;
mod jacobian;
#[cfg(feature = "alloc")]
mod linearization;
#[cfg(feature = "alloc")]
mod lyapunov;
#[cfg(feature = "alloc")]
mod sampled_sensitivity;
#[cfg(feature = "alloc")]
mod sensitivities;
#[cfg(feature = "alloc")]
mod sensitivity;
#[cfg(feature = "alloc")]
mod singular;
#[cfg(feature = "alloc")]
mod spectrum;
mod state_derivatives;
mod tangent;
#[cfg(test)]
mod tests;
#[cfg(feature = "alloc")]
mod variation;

use core::fmt::Debug;

use nalgebra::SVector;

#[cfg(feature = "alloc")]
pub use across::MotionDerivatives;
#[cfg(feature = "alloc")]
pub use columns::SelectedJacobian;
#[cfg(feature = "alloc")]
pub use dual_sample::{DifferentiableEvent, DualSample, OverDuals};
#[cfg(feature = "alloc")]
pub use equilibrium::Equilibrium;
#[cfg(feature = "alloc")]
pub use inverse::InverseDynamics;
pub use jacobian::{Jacobian, PartialDerivatives};
#[cfg(feature = "alloc")]
pub use linearization::Linearization;
#[cfg(feature = "alloc")]
pub use lyapunov::LyapunovSpectrum;
#[cfg(feature = "alloc")]
pub use sampled_sensitivity::SampledSensitivity;
#[cfg(feature = "alloc")]
pub use sensitivities::TrajectorySensitivity;
#[cfg(feature = "alloc")]
pub use sensitivity::StateSensitivity;
#[cfg(feature = "alloc")]
pub use spectrum::Stability;
pub use state_derivatives::StateDerivatives;
#[cfg(feature = "alloc")]
pub use variation::DifferentiableMethod;

use crate::error::Error;
use crate::number::{Broadcast, Real};
use crate::system::{Lagrangian, ResidualChange, Solution, State};

/// A system whose equations of motion can be differentiated by parameters too: Jacobians, equilibria, linearization.
///
/// `#[derive(Lagrangian)]` implements it too, for `N` coordinates, `M` constraints and `P` parameters: the numbers in
/// the fields that an expression uses. An input of control is a parameter that stands in a
/// `#[force(…)]`, or anywhere else; it is chosen by name at the call.
///
/// The derivatives are exact. With the residual R = (M q̈ − h − Fᵀλ, F q̈ + γ) the change of (q̈, λ) along a direction
/// solves K δ(q̈, λ) = −∂R at fixed (q̈, λ), where K is the matrix of the equations of motion (implicit differentiation;
/// Griewank and Walther, *Evaluating Derivatives*, 15.1); the derive differentiates R.
///
/// What a function that the user supplies (`#[function(…)]`) holds inside is no parameter of the system. Functions must
/// have one derivative more than the equations of motion need: where a `Table` or one by hand has not, this
/// trait is missing and the rest of the system is there. It is missing, too, where fourth derivatives of a function would
/// be needed or where the function would exceed 50,000 operations.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// A pendulum with a motor at the pivot.
/// #[derive(Clone, Lagrangian)]
/// #[coordinates(theta)]
/// #[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
/// #[force(theta: torque)]
/// struct Pendulum { m: f64, l: f64, g: f64, torque: f64 }
///
/// let pendulum = Pendulum { m: 1.0, l: 2.0, g: 9.81, torque: 0.0 };
/// let jacobian = pendulum.jacobian(&State::at_rest([0.3]))?;
/// // ∂θ̈/∂θ = −g/l cos θ
/// assert!((jacobian.accelerations.q[(0, 0)] + 9.81 / 2.0 * 0.3_f64.cos()).abs() < 1e-15);
///
/// # #[cfg(feature = "alloc")] {
/// // The torque that holds it at 30°, and the motion nearby.
/// let held = pendulum.equilibrium(&State::at_rest([0.5236]), &["torque"])?;
/// assert!((held.system.torque - 9.81 * 2.0 * 0.5236_f64.sin()).abs() < 1e-14);
/// let near = held.system.linearize(&held.state, &["torque"])?;
/// assert!((near.b[(1, 0)] - 1.0 / 4.0).abs() < 1e-15);
/// let frequency = near.natural_frequencies()?[0];
/// assert!((frequency - (9.81 / 2.0 * 0.5236_f64.cos()).sqrt()).abs() < 1e-14);
/// # }
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "the Jacobians of `{Self}` are not known",
    label = "no `Linearized`",
    note = "`#[derive(Lagrangian)]` gives it to every system whose functions (`#[function(…)]`) have one derivative more than the equations of motion need"
)]
pub trait Linearized<const N: usize, const M: usize, const P: usize>: StateDerivatives<N, M> {
    /// Names of the parameters, `m` or `m[0]` or `link[2].m`, in the order of the fields: all numbers that the expressions
    /// name, and no others. Of an array of which they name `a[0]` alone, the rest are none.
    const PARAMETERS: [&'static str; P];

    /// The values of the parameters.
    fn parameters(&self) -> SVector<Self::Scalar, P>;

    /// Sets the parameter [`PARAMETERS`](Self::PARAMETERS)`[index]`; false where there is none, or where it is behind a
    /// reference, in a type that only `#[parameter(…)]` gives a shape, in a member of a member of a struct, or one of the
    /// numbers of a rotation or a unit quaternion, which would then be none.
    fn set_parameter(&mut self, index: usize, value: Self::Scalar) -> bool;

    /// What the derivatives of the residual by all parameters are made of: plain numbers.
    type ParameterSlopes: Copy + Debug;

    /// What the derivatives of the residual by all parameters are made of, accelerations and multipliers held at those of
    /// `solution`.
    fn residual_slopes_by_parameters(
        &self,
        state: &State<Self::Scalar, N>,
        solution: &Solution<Self::Scalar, N, M>,
    ) -> Self::ParameterSlopes;

    /// The derivative of the residual where the parameters change at these rates, or at several at once on
    /// [`Lanes`](crate::Lanes), by the slopes of a state; in the order of [`PARAMETERS`](Self::PARAMETERS).
    fn residual_change_by_parameters_with<S: Broadcast<Self::Scalar>>(
        &self,
        slopes: &Self::ParameterSlopes,
        rates: &SVector<S, P>,
    ) -> ResidualChange<S, N, M>;

    /// The derivative of the residual where the parameters change at these rates, in the order of
    /// [`PARAMETERS`](Self::PARAMETERS); accelerations and multipliers held at those of `solution`.
    fn residual_change_by_parameters(
        &self,
        state: &State<Self::Scalar, N>,
        solution: &Solution<Self::Scalar, N, M>,
        rates: &SVector<Self::Scalar, P>,
    ) -> ResidualChange<Self::Scalar, N, M> {
        self.residual_change_by_parameters_with(&self.residual_slopes_by_parameters(state, solution), rates)
    }

    /// Accelerations and multipliers at a state, and their derivatives by the time, coordinates, velocities and
    /// parameters. The derivatives are on the stack: 0.24 MB for 100 coordinates and 50 constraints, two to four times that
    /// where they are handed on without optimization. [`jacobian_by`](Self::jacobian_by) has them on the heap.
    ///
    /// # Errors
    /// As [`solve`](crate::Simulate::solve); [`Error::DerivativeNotFinite`], also where a parameter is at fault that no one
    /// asked for, which [`linearize`](Self::linearize) passes over.
    fn jacobian(&self, state: &State<Self::Scalar, N>) -> Result<Jacobian<Self::Scalar, N, M, P>, Error>
    where
        Self: Lagrangian<N, M, Scalar: Real> + Sized,
    {
        jacobian::jacobian(self, state)
    }

    /// Accelerations and multipliers at a state, and their derivatives by these arguments alone: coordinates `x`,
    /// velocities `x_dot` and parameters `m`, one by one or `r` for all elements of a vector. It takes as long as there are
    /// columns asked for.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(theta)]
    /// #[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
    /// struct Pendulum { m: f64, l: f64, g: f64 }
    ///
    /// let pendulum = Pendulum { m: 1.0, l: 2.0, g: 9.81 };
    /// let by = pendulum.jacobian_by(&State::at_rest([0.3]), &["l", "theta"])?;
    /// // θ̈ = −g/l sin θ
    /// assert!((by.accelerations[(0, 0)] - 9.81 / 4.0 * 0.3_f64.sin()).abs() < 1e-15);
    /// assert!((by.accelerations[(0, 1)] + 9.81 / 2.0 * 0.3_f64.cos()).abs() < 1e-15);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`solve`](crate::Simulate::solve); [`Error::DerivativeNotFinite`]; [`Error::UnknownName`] and
    /// [`Error::RepeatedName`].
    #[cfg(feature = "alloc")]
    fn jacobian_by(
        &self,
        state: &State<Self::Scalar, N>,
        arguments: &[&str],
    ) -> Result<SelectedJacobian<Self::Scalar, N, M>, Error>
    where
        Self: Lagrangian<N, M, Scalar: Real> + Sized,
    {
        columns::jacobian_by(self, state, arguments)
    }

    /// The motion from a state to the time `end` with its derivatives by entries of the state and by parameters, named
    /// as in [`jacobian_by`](Self::jacobian_by): solutions of the variational equations.
    ///
    /// Each step of the derivatives is the derivative of the step of the motion, and they are continuous like it. Steps are
    /// as short as the motion and each derivative need: a derivative is allowed ten times the error of the motion itself, over
    /// the size of the parameter or 1, and of its own largest entry. On
    /// constraints the start is the nearest state to the one given, for other parameters too, and so are its derivatives;
    /// they stay in the tangent space, projected as the state is. [`MotionDerivatives`] goes on across events.
    ///
    /// It takes [`Dop853`](crate::Dop853) and [`Dopri5`](crate::Dopri5), and other embedded [`Pair`](crate::motion::Pair)s, on
    /// Lagrange's equations, and [`Taylor`](crate::Taylor) where the number type of the system is a parameter; motions by
    /// other methods, and in momenta, are not differentiated.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
    /// struct Spring { m: f64, k: f64 }
    ///
    /// let spring = Spring { m: 1.0, k: 4.0 };
    /// let method = Dop853::with_tolerance(1e-12);
    /// let motion = spring.integrate_sensitivities(State::at_rest([0.5]), 3.0, method, &["x", "k"])?;
    /// // x = ½ cos(√k t)
    /// let at = motion.at(1.3)?;
    /// assert!((at.q[(0, 0)] - (2.0 * 1.3_f64).cos()).abs() < 1e-10);
    /// assert!((motion.coordinate(1.3, "x", "k")? + 0.5 * 1.3 / 4.0 * (2.0 * 1.3_f64).sin()).abs() < 1e-10);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`integrate`](crate::Simulate::integrate); [`Error::DerivativeNotFinite`]; [`Error::UnknownName`] and
    /// [`Error::RepeatedName`].
    #[cfg(feature = "alloc")]
    fn integrate_sensitivities<D: DifferentiableMethod<Self, N, M, P>>(
        &self,
        state: State<Self::Scalar, N>,
        end: Self::Scalar,
        method: D,
        arguments: &[&str],
    ) -> Result<TrajectorySensitivity<'_, Self, N, M, P>, Error>
    where
        Self: Lagrangian<N, M, Scalar: Real> + Sized,
    {
        self.motion_with_derivatives(&self.sensitivity(&state, arguments)?).by(method).to(end)
    }

    /// All Lyapunov exponents of the motion from a state to the time `end`: the mean rates at which small changes of the
    /// state grow, as many as the state has degrees of freedom on the constraints.
    ///
    /// Variations from all over the tangent space go along with the motion and are made orthonormal after each step; what that
    /// takes off their lengths is what they have grown (Benettin, Galgani, Giorgilli and Strelcyn, *Meccanica* 15, 1980). Steps
    /// are as short as the motion and the variations need. The
    /// first 21st of the time lets them turn to where they grow, and does not count; the others are looked at one by one, and
    /// tell how far the means can be relied on. Of the limit for infinite times an exponent of zero is off by about
    /// ln t/t. They come in descending order; backwards in time they are rates d(ln |δ|)/dt too, so that what grows on the way
    /// back has a negative one. Lengths are those of (q, q̇) in the units of the system, which make no difference in the limit. Nothing is stored.
    /// Methods are those of [`integrate_sensitivities`](Self::integrate_sensitivities).
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(x_dot^2/2 + x^2/2)]
    /// #[dissipation(x_dot^2/4)]
    /// struct Hill;
    ///
    /// // ẍ = x − ẋ/2 on top of a hill
    /// let spectrum = Hill.lyapunov_spectrum(State::at_rest([0.0]), 50.0, Dop853::default())?;
    /// let root = (1.0_f64 / 16.0 + 1.0).sqrt();
    /// assert!((spectrum.exponents[0] - (root - 0.25)).abs() < 1e-6);
    /// assert!((spectrum.exponents[1] - (-root - 0.25)).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`integrate`](crate::Simulate::integrate): among others, [`Error::Unfinished`] where the steps of the method do
    /// not suffice; [`Error::DerivativeNotFinite`].
    #[cfg(feature = "alloc")]
    fn lyapunov_spectrum<D: DifferentiableMethod<Self, N, M, P>>(
        &self,
        state: State<Self::Scalar, N>,
        end: Self::Scalar,
        method: D,
    ) -> Result<LyapunovSpectrum<Self::Scalar>, Error>
    where
        Self: Lagrangian<N, M, Scalar: Real> + Sized,
    {
        lyapunov::spectrum(self, &state, end, &method)
    }

    /// The inputs by which the system has these accelerations at a state, and the multipliers that belong to them: the
    /// inverse dynamics of an actuated system. An input is a coordinate, which stands for a generalized force on it beside
    /// those of the system, or a parameter.
    ///
    /// There must be values of the inputs that give the accelerations, to √ε of the forces there, and one of each only. So an
    /// input that acts on what the constraints hold is none; multipliers need not be unique. Where a parameter enters the
    /// equations otherwise than a force does, the values are sought from those that it has (Newton's iteration). All is
    /// compared in the units in which masses are 1.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// /// A cart that carries a pendulum, and is driven.
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(x, theta)]
    /// #[lagrangian(x_dot^2 + (x_dot + theta_dot*cos(theta))^2/2 + (theta_dot*sin(theta))^2/2 + 9.81*cos(theta))]
    /// #[force(x: push)]
    /// struct Cart { push: f64 }
    ///
    /// let cart = Cart { push: 0.0 };
    /// let state = State::new([0.0, 0.3], [0.0, 1.0]);
    /// let moved = Cart { push: 7.0 }.solve(&state)?.accelerations;
    /// assert!((cart.inputs_for(&state, &moved, &["push"])?.inputs[0] - 7.0).abs() < 1e-13);
    /// // No push makes the pendulum do as it likes.
    /// let error = cart.inputs_for(&state, &[0.0, 0.0].into(), &["push"]).unwrap_err();
    /// assert!(error.to_string().contains("the row of coordinate `theta` lacks a generalized force of"));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NotRealizable`] where no values of the inputs give these accelerations, or they violate a constraint;
    /// [`Error::InputsNotUnique`]; [`Error::ParameterFixed`], [`Error::UnknownName`] and [`Error::RepeatedName`];
    /// [`Error::EquationsNotFinite`] and [`Error::DerivativeNotFinite`]; [`Error::EigenvaluesNotFound`] where an
    /// entry of the matrix of a step is not finite.
    #[cfg(feature = "alloc")]
    fn inputs_for(
        &self,
        state: &State<Self::Scalar, N>,
        accelerations: &SVector<Self::Scalar, N>,
        inputs: &[&str],
    ) -> Result<InverseDynamics<Self::Scalar, M>, Error>
    where
        Self: Lagrangian<N, M, Scalar: Real> + Clone,
    {
        inverse::inputs_for(self, state, accelerations, inputs)
    }

    /// The linear system near a state, its inputs the parameters of these names (`u` names all elements of a vector
    /// `u: [f64; 3]`). An input may change forces and masses; not a constraint, be it only the accelerations that the
    /// constraint allows at the state.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// /// Two equal pendulums, one below the other.
    /// #[derive(Lagrangian)]
    /// #[coordinates(a, b)]
    /// #[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*cos(a) + cos(b))]
    /// struct DoublePendulum;
    ///
    /// let near = DoublePendulum.linearize(&State::at_rest([0.0, 0.0]), &[])?;
    /// assert_eq!(near.states(), ["a", "b", "a_dot", "b_dot"]);
    /// let modes = near.natural_frequencies()?; // in units of √(g/l)
    /// assert!((modes[0] - (2.0 - 2.0_f64.sqrt()).sqrt()).abs() < 1e-14);
    /// assert!((modes[1] - (2.0 + 2.0_f64.sqrt()).sqrt()).abs() < 1e-14);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Inconsistent`] where the state is off the constraints; [`Error::InputShiftsConstraint`];
    /// [`Error::UnknownName`] and [`Error::RepeatedName`]; as [`jacobian`](Self::jacobian).
    #[cfg(feature = "alloc")]
    fn linearize(
        &self,
        state: &State<Self::Scalar, N>,
        inputs: &[&str],
    ) -> Result<Linearization<Self::Scalar>, Error>
    where
        Self: Lagrangian<N, M, Scalar: Real> + Sized,
    {
        linearization::linearize(self, state, inputs)
    }

    /// An equilibrium or a steady motion near a state, on the constraints: where q̈ = 0.
    ///
    /// What may change is named: coordinates; parameters, where the question is which force (or length, or mass) holds the
    /// system there; velocities, `phi_dot`, where it is how fast it moves steadily. Everything else stays as it is. No
    /// names are all the coordinates. Velocities are zero for an equilibrium; for a steady motion, such as the
    /// precession of a top, those of cyclic coordinates are not. That nothing changes with what moves is checked to first
    /// order, with the multipliers as they are. The time stays as it is: where the system depends on the time, the
    /// equilibrium is one of the moment.
    ///
    /// The method is that of Levenberg and Marquardt, from the guess on, or from the nearest coordinates on the constraints
    /// where all coordinates are sought. It finds stable and unstable equilibria alike.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// /// A bead on a hoop that turns about its vertical diameter.
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(theta)]
    /// #[lagrangian(m*r^2/2 * (theta_dot^2 + omega^2*sin(theta)^2) + m*g*r*cos(theta))]
    /// struct Bead { m: f64, r: f64, g: f64, omega: f64 }
    ///
    /// let bead = Bead { m: 1.0, r: 0.5, g: 9.81, omega: 6.0 };
    /// let off_the_axis = bead.equilibrium(&State::at_rest([0.5]), &[])?;
    /// assert!((off_the_axis.state.q[0].cos() - 9.81 / (0.5 * 36.0)).abs() < 1e-15);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// Of several velocities the guess says which: a top precesses slowly or fast, a pendulum either way round. Where forces
    /// grow with the square of a velocity, zero does not say.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// /// A pendulum in polar angles.
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(theta, phi)]
    /// #[lagrangian(m*l^2/2 * (theta_dot^2 + sin(theta)^2 * phi_dot^2) + m*g*l*cos(theta))]
    /// struct Pendulum { m: f64, l: f64, g: f64 }
    ///
    /// let pendulum = Pendulum { m: 1.0, l: 0.5, g: 9.81 };
    /// let guess = pendulum.state_from(&[("theta", 0.3), ("phi_dot", 1.0)])?;
    /// let cone = pendulum.equilibrium(&guess, &["phi_dot"])?;
    /// assert!((cone.state.v[1] - (9.81 / (0.5 * 0.3_f64.cos())).sqrt()).abs() < 1e-14);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NoEquilibrium`], with the row that is farthest from satisfied and the best point;
    /// [`Error::NotSteady`], with the coordinate that should not move;
    /// [`Error::UnknownName`], [`Error::RepeatedName`] and [`Error::ParameterFixed`];
    /// [`Error::StateNotFinite`], [`Error::EquationsNotFinite`] and [`Error::DerivativeNotFinite`];
    /// [`Error::EigenvaluesNotFound`] where an entry of the matrix of a step is not finite.
    #[cfg(feature = "alloc")]
    fn equilibrium(
        &self,
        guess: &State<Self::Scalar, N>,
        unknowns: &[&str],
    ) -> Result<Equilibrium<Self, N, M>, Error>
    where
        Self: Lagrangian<N, M, Scalar: Real> + Clone,
    {
        equilibrium::equilibrium(self, guess, unknowns)
    }
}
