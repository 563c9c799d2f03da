//! States over dual numbers, and events whose functions take them.

use core::fmt::{self, Debug, Formatter};

use nalgebra::ComplexField;

use super::state::{ChangingState, ChangingStateOf};
use crate::derivatives::tangent::Tangent;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::argument::check_parameters;
use crate::motion::{AnyEvent, Event, EventFunction, EventValue};
use crate::names::Entry;
use crate::number::{Dual, Real, Scalar};
use crate::solution::Sample;
use crate::solution::solve::solve;
use crate::system::lookup::index;
use crate::system::{Direction, Solution, State, StateOf};
use crate::vector::{Entrywise, StaticLength, zeros};

/// State of a system over dual numbers: values, and their derivatives by one argument, for functions to be
/// differentiated.
///
/// Quantities have the names they have in a [`Sample`]: coordinates, velocities, accelerations,
/// multipliers and constraint forces. Parameters and captured numbers must be read with [`parameter`](Self::parameter)
/// and [`number`](Self::number): values that the function captures, or reads from the system, are constants. [`Dual`]
/// numbers have the mathematical functions of [`Scalar`].
pub struct DualSample<'a, L: Linearized> {
    system: &'a L,
    state: State<Dual<L::Scalar>, L::N>,
    /// Parameter of differentiation; `None` if only the value or the rate along the motion is wanted.
    argument: Option<Entry>,
}

impl<'a, L: Linearized<Scalar: Real>> DualSample<'a, L> {
    pub(super) fn of(system: &'a L, at: &ChangingStateOf<'_, L>) -> Self {
        let dual = |value, slope| Dual { value, slope };
        let ChangingState { state: State { t, q, v }, direction, argument } = at;
        let (q, v) = (q.each_with(&direction.q, dual), v.each_with(&direction.v, dual));
        Self { system, state: State { t: dual(*t, direction.t), q, v }, argument: *argument }
    }

    /// The system.
    pub fn system(&self) -> &'a L {
        self.system
    }

    /// Time, coordinates and velocities.
    pub fn state(&self) -> &State<Dual<L::Scalar>, L::N> {
        &self.state
    }

    /// Time; it has a slope too, because the time of an event depends on the argument.
    pub fn time(&self) -> Dual<L::Scalar> {
        self.state.t
    }

    /// Generalized coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn coordinate(&self, name: &str) -> Result<Dual<L::Scalar>, Error> {
        Ok(self.state.q[index::<L>(L::COORDINATES, "coordinate", name)?])
    }

    /// Generalized velocity of the coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn velocity(&self, name: &str) -> Result<Dual<L::Scalar>, Error> {
        Ok(self.state.v[index::<L>(L::COORDINATES, "coordinate", name)?])
    }

    /// Generalized acceleration of the coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`], and those of [`solution`](Self::solution).
    pub fn acceleration(&self, name: &str) -> Result<Dual<L::Scalar>, Error> {
        let index = index::<L>(L::COORDINATES, "coordinate", name)?;
        Ok(self.solution()?.accelerations[index])
    }

    /// Multiplier λ of the constraint of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`], and those of [`solution`](Self::solution).
    pub fn multiplier(&self, name: &str) -> Result<Dual<L::Scalar>, Error> {
        let index = index::<L>(L::CONSTRAINTS, "constraint", name)?;
        Ok(self.solution()?.multipliers[index])
    }

    /// Generalized constraint force Σ_α λ_α F_αa on the coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`], and those of [`solution`](Self::solution).
    pub fn constraint_force(&self, name: &str) -> Result<Dual<L::Scalar>, Error> {
        let i = index::<L>(L::COORDINATES, "coordinate", name)?;
        let (solution, (state, direction)) = (self.solution()?, self.parts());
        let [multipliers, changes] =
            [solution.multipliers.each(|x| x.value), solution.multipliers.each(|x| x.slope)];
        // Derivative of Fᵀλ at fixed λ, from two derivatives of M q̈ − h − Fᵀλ: the one with zero multipliers
        // minus the one with λ.
        let accelerations = solution.accelerations.each(|x| x.value);
        let motion = |multipliers| {
            let tangent = Tangent::of(self.system, &state, Solution::given(accelerations, multipliers));
            tangent.change_with(&direction, self.argument).motion[i]
        };
        let by_direction = motion(zeros()) - motion(multipliers);
        let force = |multipliers| self.system.constraint_force(&state, multipliers)[i];
        Ok(Dual { value: force(&multipliers), slope: force(&changes) + by_direction })
    }

    /// Parameter of this name; its slope is 1 if it is the argument of differentiation, else 0.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn parameter(&self, name: &str) -> Result<Dual<L::Scalar>, Error> {
        const { check_parameters::<L>() };
        let index = index::<L>(L::PARAMETERS, "parameter", name)?;
        Ok(self.number(L::PARAMETERS[index], self.system.parameters()[index]))
    }

    /// A number captured by the function, as a dual number: its slope is 1 if `name` is the argument of
    /// differentiation, else 0.
    pub fn number(&self, name: &str, value: L::Scalar) -> Dual<L::Scalar> {
        Dual { value, slope: slope(self.argument, name) }
    }

    /// Accelerations and multipliers.
    ///
    /// # Errors
    /// The errors of [`Linearized::jacobian_by`].
    pub fn solution(&self) -> Result<Solution<Dual<L::Scalar>, L::N, L::M>, Error> {
        let (state, direction) = self.parts();
        if self.argument.is_none() && direction == Direction::zero() {
            return Ok(dual(&solve(self.system, &state)?, &Solution::given(zeros(), zeros())));
        }
        let tangent = Tangent::at(self.system, &state)?;
        let change = tangent.change_with(&direction, self.argument);
        Ok(dual(&tangent.solution, &tangent.response(&change, self.argument.unwrap_or(Entry::Time))?))
    }

    /// Splits the dual state into the state and the direction of its change.
    fn parts(&self) -> (StateOf<L>, Direction<L::Scalar, L::N>) {
        let State { t, q, v } = self.state;
        let state = State { t: t.value, q: q.each(|x| x.value), v: v.each(|x| x.value) };
        (state, Direction { t: t.slope, q: q.each(|x| x.slope), v: v.each(|x| x.slope) })
    }
}

/// Combines a solution and its derivatives to a solution over dual numbers.
fn dual<T: Real, N: StaticLength, M: StaticLength>(
    solution: &Solution<T, N, M>,
    change: &Solution<T, N, M>,
) -> Solution<Dual<T>, N, M> {
    let dual = |value, slope| Dual { value, slope };
    Solution {
        accelerations: solution.accelerations.each_with(&change.accelerations, dual),
        multipliers: solution.multipliers.each_with(&change.multipliers, dual),
        pivot: dual(solution.pivot, T::constant(0.0)),
        rank: solution.rank,
    }
}

/// Derivative of the number `name` by the argument: 1 if it is the argument, else 0.
pub(super) fn slope<T: Scalar>(argument: Option<Entry>, name: &str) -> T {
    let is_argument = matches!(argument, Some(Entry::Parameter(known)) if known == name);
    T::constant(if is_argument { 1.0 } else { 0.0 })
}

impl<L: Linearized> Debug for DualSample<'_, L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut sample = f.debug_struct("DualSample");
        sample
            .field("system", &L::NAME)
            .field("state", &self.state)
            .field("argument", &self.argument)
            .finish()
    }
}

/// Function of an event that takes a state over dual numbers.
#[derive(Clone, Copy, Debug)]
pub struct OverDuals<G>(pub(super) G);

impl<L, G, V> EventFunction<L> for OverDuals<G>
where
    L: Linearized<Scalar: Real>,
    G: Fn(&DualSample<'_, L>) -> V,
    V: EventValue<Dual<L::Scalar>>,
{
    fn at(&self, sample: &Sample<&L>) -> Result<L::Scalar, Error> {
        let still = ChangingState::along(sample.state(), Direction::zero());
        Ok((self.0)(&DualSample::of(*sample.system(), &still)).value()?.value)
    }
}

/// An event of a system with a differentiable function, made by
/// [`MotionDerivatives::differentiable_event`](crate::linearized::MotionDerivatives::differentiable_event).
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an event of `{L}` that can be differentiated",
    note = "make one by `system.differentiable_event(\"name\", |sample| …)`, of the same system"
)]
pub trait DifferentiableEvent<L: Linearized>: AnyEvent<L> {
    /// Derivative of the event's function at a changing state; an error with the event's name if it is not finite.
    #[doc(hidden)]
    fn change(&self, system: &L, at: &ChangingStateOf<'_, L>) -> Result<L::Scalar, Error>;

    /// Name of the event.
    #[doc(hidden)]
    fn called(&self) -> &'static str;
}

impl<L, G, V> DifferentiableEvent<L> for Event<L, OverDuals<G>>
where
    L: Linearized<Scalar: Real>,
    G: Fn(&DualSample<'_, L>) -> V,
    V: EventValue<Dual<L::Scalar>>,
{
    fn change(&self, system: &L, at: &ChangingStateOf<'_, L>) -> Result<L::Scalar, Error> {
        let OverDuals(function) = self.function();
        let slope = function(&DualSample::of(system, at)).value()?.slope;
        match slope.is_finite() {
            true => Ok(slope),
            false => Err(Error::EventNotFinite { event: self.name(), time: at.state.t.to_f64() }),
        }
    }

    fn called(&self) -> &'static str {
        self.name()
    }
}

impl<L: Linearized<Scalar: Real>, W: DifferentiableEvent<L> + ?Sized> DifferentiableEvent<L> for &mut W {
    fn change(&self, system: &L, at: &ChangingStateOf<'_, L>) -> Result<L::Scalar, Error> {
        (**self).change(system, at)
    }

    fn called(&self) -> &'static str {
        DifferentiableEvent::<L>::called(&**self)
    }
}
