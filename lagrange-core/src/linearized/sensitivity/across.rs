//! Public interface to derivatives of a motion across events.

use nalgebra::Const;

use super::events::{DualSample, OverDuals, slope};
use super::state::{StateSensitivity, impact_sensitivity, push_forward, start};
use crate::error::Error;
use crate::linearized::Linearized;
use crate::motion::{Event, EventValue, MotionBuilder};
use crate::number::{Dual, Real};
use crate::system::lookup::index;
use crate::system::{StateOf, check_contacts};

/// Derivatives of a motion of several legs, for every [`Linearized`] system over `f64` or `f32`.
///
/// A leg ends at an event, whose time depends on the initial state and on the parameters. At the event, a state with
/// its derivatives, a [`StateSensitivity`], is mapped to the state after an impact, or to a state of another system,
/// and starts the next leg. This map applies the saltation matrix: R_x + (ẋ⁺ − R_x ẋ⁻ − R_t) g_x/ġ for an event g = 0
/// and a reset x⁺ = R(t, x⁻).
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// A ball in the air.
/// #[derive(Lagrangian)]
/// #[coordinates(y)]
/// #[lagrangian(y_dot^2/2 - g*y)]
/// struct Flying { g: f64 }
///
/// /// On the floor.
/// #[derive(Lagrangian)]
/// #[coordinates(y)]
/// #[lagrangian(y_dot^2/2 - g*y)]
/// #[constraint(floor: y = 0)]
/// struct Touching { g: f64 }
///
/// let (ball, floor, method) = (Flying { g: 9.81 }, Touching { g: 9.81 }, Dop853::with_tolerance(1e-12));
/// let lands = ball.differentiable_event("lands", |sample| sample.coordinate("y")).falling().terminal();
///
/// // Dropped from 1 m: by the height, by gravity, and by the coefficient of restitution.
/// let start = ball.sensitivity(&State::at_rest([1.0]), &["y", "g"])?.with(&["e"])?;
/// let fall = ball.motion_with_derivatives(&start).by(method).event(lands).towards(10.0)?;
/// let landing = fall.derivatives_at_end()?;
/// // It falls for √(2h/g).
/// assert!((landing.t[0] - 0.5 * landing.state.t).abs() < 1e-12);
/// let bounce = floor.impact_sensitivity(landing, "floor", ("e", 0.8))?;
/// let flight = ball.motion_with_derivatives(&bounce).by(method).towards(0.6)?;
/// // y = e v τ − g τ²/2 with v = √(2gh), τ = t − v/g
/// let (v, tau) = ((2.0 * 9.81_f64).sqrt(), 0.6 - (2.0 / 9.81_f64).sqrt());
/// assert!((flight.derivative(0.6, "y", "e")? - v * tau).abs() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
///
/// Parameters are matched by name: `g` in two systems is the same number, and a parameter that a system lacks has no
/// effect there. Coordinates and velocities among the arguments refer to the initial state.
///
/// A motion that touches an event without crossing it has no derivative, and gives [`Error::Grazing`]. The criterion:
/// the rate of the event's function is less than √ε of the sum of its terms, either there or at the start of the step.
/// Neither is there a derivative where two events coincide, which is not checked.
pub trait MotionDerivatives: Linearized<Scalar: Real> + Sized {
    /// An initial state with its derivatives by these arguments: entries of the state and parameters, named as in
    /// [`jacobian_by`](Linearized::jacobian_by).
    ///
    /// # Errors
    /// [`Error::UnknownName`] and [`Error::RepeatedName`].
    fn sensitivity(
        &self,
        state: &StateOf<Self>,
        arguments: &[&str],
    ) -> Result<StateSensitivity<Self::Scalar, Self::N>, Error> {
        start::<Self>(state, arguments)
    }

    /// An event of this system, as by [`event`](crate::Simulate::event), with a differentiable function: it receives a
    /// state over dual numbers, and returns a dual number.
    ///
    /// A run without derivatives evaluates the same function. The function cannot use observables or momenta. Values
    /// that it captures, or reads from [`system`](DualSample::system), are constants.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// /// A block that rides on a belt, held by a spring.
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(x_dot^2/2 - k/2 * x^2)]
    /// #[constraint(friction: x_dot - belt = 0)]
    /// struct Sticking { k: f64, belt: f64 }
    ///
    /// let block = Sticking { k: 4.0, belt: 0.5 };
    /// let gives =
    ///     block.differentiable_event("gives", |s| Ok(s.multiplier("friction")? - s.number("hold", 2.0)));
    /// let gives = gives.rising().terminal();
    /// let start = block.sensitivity(&State::new([0.0], [0.5]), &["k", "belt"])?.with(&["hold"])?;
    /// let ride = block.motion_with_derivatives(&start).event(gives).towards(10.0)?;
    /// // Until t = hold/(k belt)
    /// for (by, expected) in ride.derivatives_at_end()?.t.iter().zip([-0.25, -2.0, 0.5]) {
    ///     assert!((by - expected).abs() < 1e-9);
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    fn differentiable_event<V: EventValue<Dual<Self::Scalar>>, G: Fn(&DualSample<'_, Self>) -> V>(
        &self,
        name: &'static str,
        function: G,
    ) -> Event<Self, OverDuals<G>> {
        Event::new(name, OverDuals(function))
    }

    /// Starts the settings of a motion with derivatives, from a state with given derivatives. Method and events are
    /// chosen as for [`motion`](crate::Simulate::motion).
    ///
    /// If the start is the end of an earlier leg, at an event, its time depends on the arguments too; the derivatives
    /// along the motion are those at fixed times. With constraints, they are projected onto the tangent space.
    /// [`derivatives_at_end`](crate::linearized::TrajectorySensitivity::derivatives_at_end) returns an error if the motion
    /// reached neither its end nor an event, or if the event has no derivative.
    ///
    /// A system with [contacts](crate::contact) would pass through them, and does not compile. Its derivatives are those of
    /// [`Trajectory::sensitivity`](crate::Trajectory::sensitivity).
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
    /// let start = ball.sensitivity(&State::at_rest([1.0]), &["g"])?;
    /// let falls = ball.motion_with_derivatives(&start).to(1.0)?;
    /// # Ok::<(), Error>(())
    /// ```
    fn motion_with_derivatives<'w>(
        &self,
        start: &StateSensitivity<Self::Scalar, Self::N>,
    ) -> MotionBuilder<'_, 'w, Self, StateSensitivity<Self::Scalar, Self::N>> {
        const { check_contacts(Self::HAS_CONTACTS) };
        MotionBuilder::new(self, start.clone())
    }

    /// Returns the state with its derivatives after an [`impact`](crate::Simulate::impact). `self` is the system that
    /// has the constraint. The coefficient of restitution e is given with a name: the argument of that name is e.
    ///
    /// # Errors
    /// The errors of [`impact`](crate::Simulate::impact); [`Error::DerivativeNotFinite`].
    fn impact_sensitivity(
        &self,
        at: &StateSensitivity<Self::Scalar, Self::N>,
        constraint: &str,
        restitution: (&str, Self::Scalar),
    ) -> Result<StateSensitivity<Self::Scalar, Self::N>, Error> {
        let hit = index::<Self>(Self::CONSTRAINTS, "constraint", constraint)?;
        let (name, restitution) = restitution;
        let slopes = |j: usize| slope(Some(at.arguments()[j]), name);
        impact_sensitivity(self, at, hit, (restitution, &slopes))
    }

    /// Returns the state with its derivatives after a reset. `map` computes the new coordinates and velocities from the
    /// state before it; they may be of another system, and of another number. `map` is called once for the state and
    /// once for each argument.
    ///
    /// Parameters of the next system are constants, and cannot depend on the state. If a parameter would be set from
    /// the state at the event, such as the place where a foot comes down, measure coordinates from there: the reset
    /// shifts the coordinates, and the parameter stays.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// /// A pendulum, whose string is cut.
    /// #[derive(Lagrangian)]
    /// #[coordinates(theta)]
    /// #[lagrangian(l^2/2 * theta_dot^2 + g*l*cos(theta))]
    /// struct Pendulum { l: f64, g: f64 }
    ///
    /// let pendulum = Pendulum { l: 2.0, g: 9.81 };
    /// let cut = pendulum.sensitivity(&State::new([0.5], [1.5]), &["theta", "l"])?;
    /// let thrown = pendulum.push_forward(&cut, |sample| {
    ///     let (l, theta, omega) = (sample.parameter("l")?, sample.coordinate("theta")?, sample.velocity("theta")?);
    ///     let (sin, cos) = theta.sin_cos();
    ///     Ok([[l * sin, -l * cos], [l * cos * omega, l * sin * omega]])
    /// })?;
    /// assert_eq!(thrown.state.v[0], 2.0 * 0.5_f64.cos() * 1.5);
    /// assert_eq!((thrown.q[(0, 0)], thrown.q[(0, 1)]), (2.0 * 0.5_f64.cos(), 0.5_f64.sin()));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of `map`.
    fn push_forward<const K: usize>(
        &self,
        at: &StateSensitivity<Self::Scalar, Self::N>,
        map: impl Fn(&DualSample<'_, Self>) -> Result<[[Dual<Self::Scalar>; K]; 2], Error>,
    ) -> Result<StateSensitivity<Self::Scalar, Const<K>>, Error> {
        push_forward(self, at, map)
    }
}

impl<L: Linearized<Scalar: Real>> MotionDerivatives for L {}
