//! The trait [`Linearized`]: derivatives by parameters, and what the derivatives are for.

use core::fmt::Debug;

use super::{Jacobian, StateDerivatives, jacobian};
use crate::error::Error;
use crate::number::{Broadcast, Real};
use crate::system::{Lagrangian, ResidualChange, SolutionOf, StateOf};
use crate::vector::{StaticLength, Vector};
#[cfg(feature = "alloc")]
use crate::{
    linearized::{
        DifferentiableMethod, Equilibrium, InverseDynamics, Linearization, LocalCoordinates,
        LyapunovSpectrum, MotionDerivatives, Regressor, SelectedJacobian, TrajectorySensitivity, equilibrium,
        inverse, jacobian_by, linearization, lyapunov,
    },
    nalgebra::DVector,
};

/// A system whose equations of motion can be differentiated by parameters too: Jacobians, sensitivities, equilibria,
/// linearization.
///
/// `#[derive(Lagrangian)]` implements this trait for `N` coordinates, `M` constraints and `P` parameters. Parameters
/// are the numbers in the fields that an expression uses. Control inputs are parameters too, mostly of a
/// `#[force(…)]`: functions such as [`linearize`](Self::linearize) take their names.
///
/// The derivatives are exact. For the residual R = (M q̈ − h − Fᵀλ, F q̈ + γ), the derivative of (q̈, λ) along a
/// direction solves K δ(q̈, λ) = −∂R, where ∂R is taken at fixed (q̈, λ) and K is the KKT matrix of the equations of
/// motion (implicit differentiation; Griewank and Walther, *Evaluating Derivatives*, 15.1). The derive macro
/// differentiates R.
///
/// Numbers inside a function that the user supplies (`#[function(…)]`) are no parameters of the system. Functions must
/// have one derivative more than the equations of motion need. If a `Table` or a user's function does not have it, the
/// system lacks this trait alone. It also lacks this trait if fourth derivatives of a function would be needed, or if
/// the code of its derivatives would exceed 50,000 operations.
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
/// // The torque that holds it at 30°, and the motion nearby.
/// let held = pendulum.equilibrium(&State::at_rest([0.5236]), &["torque"])?;
/// assert!((held.system.torque - 9.81 * 2.0 * 0.5236_f64.sin()).abs() < 1e-14);
/// let near = held.system.linearize(&held.state, &["torque"])?;
/// assert!((near.b[(1, 0)] - 1.0 / 4.0).abs() < 1e-15);
/// let frequency = near.natural_frequencies()?[0];
/// assert!((frequency - (9.81 / 2.0 * 0.5236_f64.cos()).sqrt()).abs() < 1e-14);
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "the Jacobians of `{Self}` are not known",
    label = "no `Linearized`",
    note = "`#[derive(Lagrangian)]` gives it to every system whose functions (`#[function(…)]`) have one derivative more than the equations of motion need"
)]
pub trait Linearized: StateDerivatives {
    /// Names of the parameters in the order of the fields, such as `m`, `m[0]` or `link[2].m`: exactly the numbers that
    /// the expressions use. If they use only `a[0]` of an array, its other elements are not parameters.
    const PARAMETERS: &'static [&'static str];

    /// Number of the parameters.
    type P: StaticLength;

    /// Values of the parameters.
    fn parameters(&self) -> Vector<Self::Scalar, Self::P>;

    /// Sets the parameter [`PARAMETERS`](Self::PARAMETERS)`[index]`. Returns false if there is none, or if it cannot be
    /// set: because it is behind a reference, in a type whose shape is known from `#[parameter(…)]` alone, in a struct
    /// within a struct, or because it is one number of a rotation or a unit quaternion, which would no longer be one.
    fn set_parameter(&mut self, index: usize, value: Self::Scalar) -> bool;

    /// Plain numbers from which the derivatives of the residual by all parameters are computed.
    type ParameterSlopes: Copy + Debug;

    /// Computes the coefficients that
    /// [`residual_change_by_parameters_with`](Self::residual_change_by_parameters_with) combines with the rates of the
    /// parameters. Accelerations and multipliers are held at those of `solution`.
    fn residual_slopes_by_parameters(
        &self,
        state: &StateOf<Self>,
        solution: &SolutionOf<Self>,
    ) -> Self::ParameterSlopes;

    /// Derivative of the residual if the parameters change at these rates, in the order of
    /// [`PARAMETERS`](Self::PARAMETERS). Uses the slopes of a state; on [`Lanes`](crate::Lanes), several rates at once.
    fn residual_change_by_parameters_with<S: Broadcast<Self::Scalar>>(
        &self,
        slopes: &Self::ParameterSlopes,
        rates: &Vector<S, Self::P>,
    ) -> ResidualChange<S, Self::N, Self::M>;

    /// Derivative of the residual if the parameters change at these rates, in the order of
    /// [`PARAMETERS`](Self::PARAMETERS). Accelerations and multipliers are held at those of `solution`.
    fn residual_change_by_parameters(
        &self,
        state: &StateOf<Self>,
        solution: &SolutionOf<Self>,
        rates: &Vector<Self::Scalar, Self::P>,
    ) -> ResidualChange<Self::Scalar, Self::N, Self::M> {
        self.residual_change_by_parameters_with(&self.residual_slopes_by_parameters(state, solution), rates)
    }

    /// Accelerations and multipliers at a state, with their derivatives by the time, coordinates, velocities and
    /// parameters. The derivatives are on the stack: 0.24 MB for 100 coordinates and 50 constraints, and two to four
    /// times that in unoptimized builds, which copy them. [`jacobian_by`](Self::jacobian_by) keeps them on the heap.
    ///
    /// # Errors
    /// The errors of [`solve`](crate::Simulate::solve). [`Error::DerivativeNotFinite`], even for a parameter without
    /// interest to the caller; [`linearize`](Self::linearize) differentiates only by the requested inputs.
    fn jacobian(
        &self,
        state: &StateOf<Self>,
    ) -> Result<Jacobian<Self::Scalar, Self::N, Self::M, Self::P>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        jacobian::jacobian(self, state)
    }

    /// Accelerations and multipliers at a state, with their derivatives by these arguments alone: coordinates `x`,
    /// velocities `x_dot` and parameters `m`. The name of a vector, `r`, stands for all its elements. The cost is
    /// proportional to the number of columns.
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
    /// The errors of [`solve`](crate::Simulate::solve); [`Error::DerivativeNotFinite`]; [`Error::UnknownName`] and
    /// [`Error::RepeatedName`].
    #[cfg(feature = "alloc")]
    fn jacobian_by(
        &self,
        state: &StateOf<Self>,
        arguments: &[&str],
    ) -> Result<SelectedJacobian<Self::Scalar, Self::N, Self::M>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        jacobian_by(self, state, arguments)
    }

    /// Integrates the motion to the time `end` together with its derivatives by entries of the initial state and by
    /// parameters, named as in [`jacobian_by`](Self::jacobian_by). The derivatives solve the variational equations.
    ///
    /// Each step of the derivatives is the exact derivative of the step of the motion, and dense output covers both.
    /// The motion and each derivative limit the step length. The allowed error of a derivative is ten times the
    /// tolerance, applied to two scales: its own largest entry, and the motion divided by the size of the parameter (by
    /// 1 for an initial value). With constraints, the initial state is projected onto them, for varied parameters too,
    /// and the derivatives include this projection. Along the motion they stay in the tangent space, projected as the
    /// state is. [`MotionDerivatives`] continues across events.
    ///
    /// Every [`DifferentiableMethod`] is supported. Motions by other methods, and in momenta, are not differentiated.
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
    /// let at = motion.derivatives_at(1.3)?;
    /// assert!((at.q[(0, 0)] - (2.0 * 1.3_f64).cos()).abs() < 1e-10);
    /// assert!((motion.derivative(1.3, "x", "k")? + 0.5 * 1.3 / 4.0 * (2.0 * 1.3_f64).sin()).abs() < 1e-10);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`integrate`](crate::Simulate::integrate); [`Error::DerivativeNotFinite`]; [`Error::UnknownName`]
    /// and [`Error::RepeatedName`].
    #[cfg(feature = "alloc")]
    fn integrate_sensitivities<D: DifferentiableMethod<Self>>(
        &self,
        state: StateOf<Self>,
        end: Self::Scalar,
        method: D,
        arguments: &[&str],
    ) -> Result<TrajectorySensitivity<'_, Self>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        self.motion_with_derivatives(&self.sensitivity(&state, arguments)?).by(method).to(end)
    }

    /// All Lyapunov exponents of the motion from a state to the time `end`: the mean growth rates of small changes of
    /// the state. Their number is the number of degrees of freedom of the state on the constraints.
    ///
    /// Variations that span the tangent space are integrated along the motion and orthonormalized after each step; the
    /// lengths removed are their growth (Benettin, Galgani, Giorgilli and Strelcyn, *Meccanica* 15, 1980). The motion
    /// and the variations limit the step length. Nothing is stored.
    ///
    /// The first 21st of the time, in which the variations turn to the growing directions, does not count. The other 20
    /// parts give standard errors of the means. An exponent whose limit is zero is off by about ln t/t.
    ///
    /// Exponents are in descending order. Backwards in time they are rates d(ln |δ|)/dt too: a variation that grows on
    /// the way back has a negative exponent. Lengths are those of (q, q̇) in the units of the system, which make no
    /// difference in the limit. Methods are those of [`integrate_sensitivities`](Self::integrate_sensitivities). By
    /// [`Radau`](crate::linearized::Radau), exponents of changes that decay within a step are those of the step.
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
    /// The errors of [`integrate`](crate::Simulate::integrate), among them [`Error::Unfinished`] if the method does not
    /// reach the end; [`Error::DerivativeNotFinite`]. A system with [contacts](crate::contact) does not compile:
    ///
    /// ```compile_fail
    /// # use lagrange_core::contact::Contact;
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Clone, Lagrangian)]
    /// # #[coordinates(y)]
    /// # #[lagrangian(y_dot^2/2 - g*y)]
    /// # #[contact(floor: y >= 0)]
    /// # struct Ball { g: f64, floor: Contact }
    /// # let ball = Ball { g: 9.81, floor: Contact::Open };
    /// let spectrum = ball.lyapunov_spectrum(State::at_rest([1.0]), 50.0, Dop853::default())?;
    /// # Ok::<(), Error>(())
    /// ```
    #[cfg(feature = "alloc")]
    fn lyapunov_spectrum<D: DifferentiableMethod<Self>>(
        &self,
        state: StateOf<Self>,
        end: Self::Scalar,
        method: D,
    ) -> Result<LyapunovSpectrum<Self::Scalar>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        lyapunov::spectrum(self, &state, end, &method)
    }

    /// Inverse dynamics of an actuated system: finds the inputs that produce these accelerations at a state, and the
    /// multipliers. An input is a parameter, or a coordinate, which stands for an additional generalized force on it.
    ///
    /// The inputs must produce the accelerations to √ε of the forces, and must be unique. So an input that acts only
    /// against constraints is rejected; multipliers need not be unique. For parameters that do not enter the equations
    /// linearly, as forces do, Newton's method starts from their present values. Rows are compared in units in which
    /// masses are 1.
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
    /// [`Error::NotRealizable`] if no values of the inputs give these accelerations, or if these violate a constraint;
    /// [`Error::InputsNotUnique`]; [`Error::ParameterFixed`], [`Error::UnknownName`] and [`Error::RepeatedName`];
    /// [`Error::EquationsNotFinite`] and [`Error::DerivativeNotFinite`]; [`Error::EigenvaluesNotFound`] if the matrix
    /// of a step has an entry that is not finite.
    #[cfg(feature = "alloc")]
    fn inputs_for(
        &self,
        state: &StateOf<Self>,
        accelerations: &Vector<Self::Scalar, Self::N>,
        inputs: &[&str],
    ) -> Result<InverseDynamics<Self::Scalar, Self::M>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Clone,
    {
        inverse::inputs_for(self, state, accelerations, inputs)
    }

    /// Completes accelerations on the constraints: those of the `held` coordinates stay, the others become those that the
    /// rows F q̈ + γ = 0 demand. Closed chains are led in this way: choose the accelerations of as many coordinates as there
    /// are degrees of freedom, complete them, and ask [`inputs_for`](Self::inputs_for) for the forces.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// /// A crank that drives a slider by a rod.
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(crank, rod, x)]
    /// #[lagrangian(crank_dot^2 + rod_dot^2/2 + x_dot^2/2)]
    /// #[constraint(closed: [cos(crank) + 3*cos(rod) - x, sin(crank) + 3*sin(rod)] = 0)]
    /// #[force(crank: torque)]
    /// struct SliderCrank { torque: f64 }
    ///
    /// let slider = SliderCrank { torque: 0.0 };
    /// let start = slider.state_from(&[("crank", 1.0), ("crank_dot", 2.0), ("rod", -0.3), ("x", 3.0)])?;
    /// let (state, _) = slider.make_consistent_holding(&start, &["crank", "crank_dot"])?;
    /// // The crank shall turn at constant speed.
    /// let wanted = slider.complete_accelerations(&state, &[0.0; 3].into(), &["crank"])?;
    /// let torque = slider.inputs_for(&state, &wanted, &["torque"])?.inputs[0];
    /// let moved = SliderCrank { torque }.solve(&state)?.accelerations;
    /// assert!(moved[0].abs() < 1e-12 && (moved[2] - wanted[2]).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::AccelerationsNotUnique`] if more must be held, [`Error::NotRealizable`] if what is held violates a
    /// constraint (to √ε of its terms); [`Error::Inconsistent`] if the state does; [`Error::UnknownName`] and
    /// [`Error::RepeatedName`]; [`Error::EquationsNotFinite`].
    #[cfg(feature = "alloc")]
    fn complete_accelerations(
        &self,
        state: &StateOf<Self>,
        accelerations: &Vector<Self::Scalar, Self::N>,
        held: &[&str],
    ) -> Result<Vector<Self::Scalar, Self::N>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        inverse::complete(self, state, accelerations, held)
    }

    /// Regressor of the inertial parameters of some bodies at a state with these accelerations: the generalized forces as Y
    /// π + τ₀ (C. G. Atkeson, C. H. An and J. M. Hollerbach, "Estimation of inertial parameters of manipulator loads and
    /// links", *International Journal of Robotics Research* 5, 1986). A body is a field, or an element of one, with the
    /// members `m`, `centre: [3]` and `inertia: symmetric` of `kinetic(frame, body.m, body.centre, body.inertia)`.
    ///
    /// ```
    /// use lagrange_core::nalgebra::{Matrix3, Vector3};
    /// use lagrange_core::linearized::BaseParameters;
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Clone)]
    /// struct Body { m: f64, centre: Vector3<f64>, inertia: Matrix3<f64> }
    ///
    /// /// Two links in a vertical plane.
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(q: [2])]
    /// #[frame(upper: rotate_z(q[0]))]
    /// #[frame(lower in upper: translate([0.5, 0, 0]), rotate_z(q[1]))]
    /// #[parameter(a: {m, centre: [3], inertia: symmetric})]
    /// #[parameter(b: {m, centre: [3], inertia: symmetric})]
    /// #[lagrangian(kinetic(upper, a.m, a.centre, a.inertia) + kinetic(lower, b.m, b.centre, b.inertia)
    ///     - g*(a.m*position(upper, a.centre)[1] + b.m*position(lower, b.centre)[1]))]
    /// struct Arm { a: Body, b: Body, g: f64 }
    ///
    /// let body = |m| Body { m, centre: Vector3::new(0.2, 0.01, 0.0), inertia: Matrix3::identity() * 0.03 * m };
    /// let arm = Arm { a: body(2.0), b: body(1.0), g: 9.81 };
    /// let pi = arm.inertial_parameters(&["a", "b"])?;
    /// assert_eq!((pi[0], pi[1], pi[10]), (2.0, 0.4, 1.0)); // m(a), mc(a)[0], m(b)
    /// let at = |k: f64| arm.regressor(&State::new([k, 2.0 - k * k], [3.0 - k, k]), &[5.0 * k, -k * k].into(), &["a", "b"]);
    /// let regressors = (1..20).map(|k| at(0.3 * f64::from(k))).collect::<Result<Vec<_>, _>>()?;
    /// // Of the twenty parameters six combinations can be found from motions.
    /// let base = BaseParameters::of(&regressors)?;
    /// assert_eq!(base.to_string().lines().collect::<Vec<_>>(), [
    ///     "I(a)[2][2] + 0.25 m(b)", "I(b)[2][2]", "mc(a)[0] + 0.5 m(b)", "mc(a)[1]", "mc(b)[0]", "mc(b)[1]",
    /// ]);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::UnknownName`] and [`Error::RepeatedName`]; [`Error::ParameterFixed`]; [`Error::NotInertial`] if the parameters
    /// enter in another way; [`Error::DerivativeNotFinite`]; with constraints, the errors of [`solve`](crate::Simulate::solve).
    #[cfg(feature = "alloc")]
    fn regressor(
        &self,
        state: &StateOf<Self>,
        accelerations: &Vector<Self::Scalar, Self::N>,
        bodies: &[&str],
    ) -> Result<Regressor<Self::Scalar>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Clone,
    {
        inverse::regressor(self, state, accelerations, bodies)
    }

    /// Inertial parameters π of some bodies, in the order of the columns of their [regressor](Self::regressor): mass m,
    /// first moment m c and inertia I_O about the origin of the frame, for each.
    ///
    /// # Errors
    /// [`Error::UnknownName`] and [`Error::RepeatedName`].
    #[cfg(feature = "alloc")]
    fn inertial_parameters(&self, bodies: &[&str]) -> Result<DVector<Self::Scalar>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        inverse::inertial_parameters(self, bodies)
    }

    /// Linearizes the system near a state. The inputs are the parameters of these names (`u` stands for all elements of
    /// a vector `u: [f64; 3]`). An input may change forces and masses, but not a constraint, nor the accelerations that
    /// a constraint allows at the state.
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
    /// [`Error::Inconsistent`] if the state violates a constraint; [`Error::InputShiftsConstraint`];
    /// [`Error::UnknownName`] and [`Error::RepeatedName`]; the errors of [`jacobian`](Self::jacobian).
    #[cfg(feature = "alloc")]
    fn linearize(&self, state: &StateOf<Self>, inputs: &[&str]) -> Result<Linearization<Self::Scalar>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        linearization::linearize(self, state, inputs)
    }

    /// Local coordinates of the changes of a state whose frames are turned by quaternions: three for each quaternion, in the
    /// place of four that a constraint holds together.
    ///
    /// # Errors
    /// [`Error::StateNotFinite`]; [`Error::Inconsistent`] if a quaternion does not have length 1, or another constraint is
    /// violated.
    #[cfg(feature = "alloc")]
    fn local_coordinates(&self, state: &StateOf<Self>) -> Result<LocalCoordinates<Self::Scalar>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        LocalCoordinates::at(self, state)
    }

    /// Change from one state to another in [local coordinates](Self::local_coordinates), of any size: places and velocities by
    /// their differences, each quaternion by the rotation vector δφ along the axes of its frame that turns one orientation into the other, |δφ|
    /// ≤ π, and δω, the difference of the angular velocities, each along the axes of its own frame. Feedback u = −K z of a
    /// [linearized](Self::linearize_locally) system takes z from here.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// /// A satellite with three wheels.
    /// #[derive(Lagrangian)]
    /// #[coordinates(q: [4])]
    /// #[frame(body: rotate(q))]
    /// #[lagrangian(kinetic(body, 1, [0, 0, 0], [[2, 0, 0], [0, 3, 0], [0, 0, 4]]))]
    /// #[power(torque, angular_velocity(body))]
    /// struct Satellite { torque: [f64; 3] }
    ///
    /// let wanted = State::at_rest([1.0, 0.0, 0.0, 0.0]);
    /// // It points the other way.
    /// let start = State::at_rest([0.0, 0.0, 1.0, 0.0]);
    /// let mut motion = Motion::new(Satellite { torque: [0.0; 3] }, start, Dop853::default())?;
    /// for tick in 1..=300 {
    ///     let z = motion.system().local_change(&wanted, motion.state())?;
    ///     motion.system_mut().torque = [0, 1, 2].map(|k| -2.0 * z[k] - 4.0 * z[3 + k]);
    ///     motion.advance_to(f64::from(tick) / 10.0)?;
    /// }
    /// let z = motion.system().local_change(&wanted, motion.state())?;
    /// assert!(z.amax() < 1e-4);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// J. Solà, J. Deray and D. Atchuthan (2018), (26): x ⊖ y, on the right. Pinocchio's `difference`, but for the place of a free body.
    ///
    /// # Errors
    /// Those of [`local_coordinates`](Self::local_coordinates), of each state.
    #[cfg(feature = "alloc")]
    fn local_change(&self, from: &StateOf<Self>, to: &StateOf<Self>) -> Result<DVector<Self::Scalar>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        linearization::change(self, [from, to])
    }

    /// A state changed by these [local coordinates](Self::local_coordinates), of any size: the inverse of
    /// [`local_change`](Self::local_change). The time stays. Constraints beyond the lengths of quaternions are not enforced: see
    /// [`make_consistent`](crate::Simulate::make_consistent).
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(q: [4])]
    /// #[frame(body: rotate(q))]
    /// #[lagrangian(kinetic(body, 1, [0, 0, 0], [[2, 0, 0], [0, 3, 0], [0, 0, 4]]))]
    /// struct Body;
    ///
    /// let state = State::at_rest([1.0, 0.0, 0.0, 0.0]);
    /// // A turn by 90° about the first axis, and a spin of 4 about the same.
    /// let turned = Body.locally_changed(&state, &[std::f64::consts::FRAC_PI_2, 0.0, 0.0, 4.0, 0.0, 0.0])?;
    /// let half = 0.5_f64.sqrt();
    /// let expected = State::new([half, half, 0.0, 0.0], [-2.0 * half, 2.0 * half, 0.0, 0.0]);
    /// assert!((turned.q - expected.q).amax() < 1e-15 && (turned.v - expected.v).amax() < 1e-15);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::LocalChange`] for another number of local coordinates; [`Error::LocalChangeNotFinite`]; those of
    /// [`local_coordinates`](Self::local_coordinates); [`Error::StateNotFinite`] if the sum overflows.
    #[cfg(feature = "alloc")]
    fn locally_changed(&self, state: &StateOf<Self>, change: &[Self::Scalar]) -> Result<StateOf<Self>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        linearization::changed(self, state, change)
    }

    /// Linearizes the system near a state in [local coordinates](Self::local_coordinates): ż = A z + B u, where z is the change
    /// of the state, with three numbers for each quaternion. For a free body with 12 joints A is 36 × 36; its lower half
    /// holds the derivatives of the accelerations by 18 changes of place and 18 changes of velocity.
    ///
    /// At a state in motion, z is the change of the moving state, and its coordinates are taken along the axes of the
    /// bodies, which turn: δφ̇ = δω − ω × δφ. This A is the matrix of the variational equations along the motion, at that
    /// moment. Inputs are as in [`linearize`](Self::linearize).
    ///
    /// All constraints must be those of quaternions; otherwise it does not compile, and `linearize` is the method:
    ///
    /// ```compile_fail,E0080
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Lagrangian)]
    /// # #[coordinates(x, y)]
    /// # #[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
    /// # #[constraint(rod: x^2 + y^2 = 1)]
    /// # struct Pendulum { g: f64 }
    /// Pendulum { g: 9.81 }.linearize_locally(&State::at_rest([0.0, -1.0]), &[])?;
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// Without constraints the two are the same.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// /// A free body.
    /// #[derive(Lagrangian)]
    /// #[coordinates(q: [4])]
    /// #[frame(body: rotate(q))]
    /// #[lagrangian(kinetic(body, 1, [0, 0, 0], [[a, 0, 0], [0, b, 0], [0, 0, c]]))]
    /// struct Body { a: f64, b: f64, c: f64 }
    ///
    /// let body = Body { a: 1.0, b: 2.0, c: 3.0 };
    /// // It spins about its middle axis: q̇ = ½ q ⊗ (0, 0, ω, 0).
    /// let spin = 4.0;
    /// let state = State::new([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, spin / 2.0, 0.0]);
    /// let near = body.linearize_locally(&state, &[])?;
    /// assert_eq!(near.states()[3..], ["omega(q)[0]", "omega(q)[1]", "omega(q)[2]"]);
    /// // a ω̇₀ = (b − c) ω₁ ω₂, c ω̇₂ = (a − b) ω₀ ω₁
    /// assert!((near.a[(3, 5)] - (2.0 - 3.0) / 1.0 * spin).abs() < 1e-14);
    /// assert!((near.a[(5, 3)] - (1.0 - 2.0) / 3.0 * spin).abs() < 1e-14);
    /// // δφ̇ = δω − ω × δφ
    /// assert!((near.a[(0, 2)] + spin).abs() < 1e-14 && (near.a[(0, 3)] - 1.0).abs() < 1e-14);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`linearize`](Self::linearize).
    #[cfg(feature = "alloc")]
    fn linearize_locally(
        &self,
        state: &StateOf<Self>,
        inputs: &[&str],
    ) -> Result<Linearization<Self::Scalar>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        linearization::linearize_locally(self, state, inputs)
    }

    /// Finds an equilibrium or a steady motion near a state, on the constraints: a state with q̈ = 0.
    ///
    /// `unknowns` names the quantities that may change: coordinates; parameters, to find the force (or length, or mass)
    /// that holds the system there; velocities, `phi_dot`, to find the speed of a steady motion. Everything else stays
    /// as in the guess. An empty list means all coordinates. Velocities are zero at an equilibrium; in a steady motion,
    /// such as the precession of a top, velocities of cyclic coordinates are not. The search checks to first order, at
    /// constant multipliers, that the equations do not change along the motion. The time is that of the guess: if the
    /// system depends on the time, the equilibrium holds at that moment.
    ///
    /// Uses the Levenberg–Marquardt method. If all coordinates are unknowns, the guess is first projected onto the
    /// constraints. The search finds stable and unstable equilibria alike.
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
    /// If several velocities solve the equations, the guess selects one: a top precesses slowly or fast, a pendulum in
    /// either direction. If forces are quadratic in a velocity, the guess must not be zero, where their derivative
    /// vanishes.
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
    /// [`Error::NoEquilibrium`], with the row of the largest residual and the best point; [`Error::NotSteady`], with
    /// the coordinate that should not move; [`Error::UnknownName`], [`Error::RepeatedName`] and
    /// [`Error::ParameterFixed`]; [`Error::StateNotFinite`], [`Error::EquationsNotFinite`] and
    /// [`Error::DerivativeNotFinite`]; [`Error::EigenvaluesNotFound`] if the matrix of a step has an entry that is not
    /// finite.
    #[cfg(feature = "alloc")]
    fn equilibrium(&self, guess: &StateOf<Self>, unknowns: &[&str]) -> Result<Equilibrium<Self>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Clone,
    {
        equilibrium::equilibrium(self, guess, unknowns)
    }
}
