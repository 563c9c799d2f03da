//! A state with its derivatives, and their jump at an event.
//!
//! At an event the time depends on the arguments too. Let δ be the change of the state at fixed time. The event g(t, q,
//! q̇, p) = 0 gives δt = −(g_q δq + g_q̇ δq̇ + g_p δp)/ġ, and the state at the event changes by Δ = δ + ẋ⁻ δt. A reset
//! x⁺ = R(t, x⁻, p) maps this change to R_t δt + R_x Δ + R_p δp. At fixed time after the event, the change is that
//! minus ẋ⁺ δt. Together these are the saltation matrix, R_x + (ẋ⁺ − R_x ẋ⁻ − R_t) g_x/ġ (Leine and Nijmeijer,
//! *Dynamics and Bifurcations of Non-Smooth Mechanical Systems*, 2004, chapter 7; Kong, Payne, Zhu and Johnson,
//! "Saltation matrices: the unsung heroes of hybrid optimal control", *Proceedings of the IEEE* 112, 2024, (3)).

use alloc::string::ToString;
use alloc::vec::Vec;

use nalgebra::{Const, DMatrix, DVector};

use super::events::DualSample;
use crate::derivatives::tangent::Tangent;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::argument::Argument;
use crate::names::Entry;
use crate::number::{Dual, Real, Scalar, larger, power_of_epsilon};
use crate::solution::impact::impact;
use crate::solution::solve::solve;
use crate::system::{Direction, Lagrangian, ResidualChange, Solution, State, StateOf, System};
use crate::vector::{Array, Element, Entrywise, StaticLength, Vector, from_fn, vector, zeros};

/// A state of a motion with its derivatives by some arguments: entries of the initial state, parameters, and numbers
/// captured by events and resets.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSensitivity<T: Element, N: StaticLength> {
    /// The state.
    pub state: State<T, N>,
    /// Derivatives of the time, one for each argument: nonzero at an event, whose time depends on the arguments; zero
    /// at a given time.
    pub t: DVector<T>,
    /// Derivatives of the coordinates: one row per coordinate, one column per argument.
    pub q: DMatrix<T>,
    /// Derivatives of the velocities: one row per velocity, one column per argument.
    pub v: DMatrix<T>,
    arguments: Vec<Entry>,
}

impl<T: Real, N: StaticLength> StateSensitivity<T, N> {
    /// A state with all derivatives zero.
    pub(super) fn of(state: State<T, N>, arguments: Vec<Entry>) -> Self {
        let count = arguments.len();
        let none = || DMatrix::from_element(N::COUNT, count, T::constant(0.0));
        Self { state, t: DVector::from_element(count, T::constant(0.0)), q: none(), v: none(), arguments }
    }

    /// The arguments, in the order of the columns.
    pub fn arguments(&self) -> &[Entry] {
        &self.arguments
    }

    /// Adds arguments: parameters of any system that the motion will enter, or numbers captured by events and resets.
    /// The state does not depend on them yet.
    ///
    /// # Errors
    /// [`Error::RepeatedName`].
    pub fn with(mut self, names: &[&'static str]) -> Result<Self, Error> {
        for name in names {
            if self.arguments.iter().any(|known| known.to_string() == *name) {
                return Err(Error::RepeatedName { name: (*name).into() });
            }
            self.arguments.push(Entry::Parameter(name));
        }
        let (count, zero) = (self.arguments.len(), T::constant(0.0));
        self.t = self.t.resize_vertically(count, zero);
        for x in [&mut self.q, &mut self.v] {
            *x = core::mem::take(x).resize_horizontally(count, zero);
        }
        Ok(self)
    }

    /// Derivative of the state by argument `j`.
    pub(super) fn direction(&self, j: usize) -> Direction<T, N> {
        let column = |x: &DMatrix<T>| vector(from_fn(|i| x[(i, j)]));
        Direction { t: self.t[j], q: column(&self.q), v: column(&self.v) }
    }

    /// The state as it changes with argument `j`.
    pub(super) fn by(&self, j: usize) -> ChangingState<'_, T, N> {
        ChangingState { state: &self.state, direction: self.direction(j), argument: Some(self.arguments[j]) }
    }

    /// Converts column `j` to a state whose time changes by `by` more: adds `by` times the rates of the state.
    pub(super) fn delay(&mut self, j: usize, by: T, accelerations: &Vector<T, N>) {
        self.t[j] += by;
        let rates = [&self.state.v, accelerations];
        for (x, rate) in [&mut self.q, &mut self.v].into_iter().zip(rates) {
            x.column_mut(j).iter_mut().zip(rate).for_each(|(x, rate)| *x += *rate * by);
        }
    }

    /// Sets column `j` of the derivatives of the state.
    pub(super) fn set(&mut self, j: usize, [q, v]: [&[T]; 2]) {
        self.q.column_mut(j).copy_from_slice(q);
        self.v.column_mut(j).copy_from_slice(v);
    }
}

/// See [`MotionDerivatives::sensitivity`](crate::linearized::MotionDerivatives::sensitivity).
pub(super) fn start<L: Linearized<Scalar: Real>>(
    state: &StateOf<L>,
    names: &[&str],
) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
    let arguments = Argument::named::<L>(names)?;
    let entries = arguments.iter().map(|argument| argument.entry::<L>()).collect();
    let mut start = StateSensitivity::of(*state, entries);
    for (j, argument) in arguments.iter().enumerate() {
        match *argument {
            Argument::Coordinate(i) => start.q[(i, j)] = L::Scalar::constant(1.0),
            Argument::Velocity(i) => start.v[(i, j)] = L::Scalar::constant(1.0),
            Argument::Parameter(_) => {}
        }
    }
    Ok(start)
}

/// A state that changes along a direction, and with a parameter at unit rate if that is the argument.
#[derive(Clone, Copy, Debug)]
pub struct ChangingState<'s, T: Element, N: StaticLength> {
    pub(super) state: &'s State<T, N>,
    pub(super) direction: Direction<T, N>,
    /// `None` for a rate along the motion.
    pub(super) argument: Option<Entry>,
}

/// Changing state of a system.
pub(super) type ChangingStateOf<'s, L> = ChangingState<'s, <L as System>::Scalar, <L as Lagrangian>::N>;

impl<'s, T: Real, N: StaticLength> ChangingState<'s, T, N> {
    /// The state along a direction of the motion, for all arguments alike.
    pub(super) fn along(state: &'s State<T, N>, direction: Direction<T, N>) -> Self {
        Self { state, direction, argument: None }
    }
}

/// Derivative of the function of an event at a changing state.
pub(super) type EventChange<'c, L> =
    dyn Fn(&ChangingStateOf<'_, L>) -> Result<<L as System>::Scalar, Error> + 'c;

/// Converts derivatives at fixed time to derivatives at the event of this name. `before` is an earlier state of the motion,
/// at which the rate of the event's function gives the scale for grazing.
///
/// # Errors
/// [`Error::Grazing`].
pub(super) fn at_event<L: Linearized<Scalar: Real>>(
    system: &L,
    mut at: StateSensitivity<L::Scalar, L::N>,
    (event, change): (&'static str, &EventChange<'_, L>),
    before: &StateOf<L>,
) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
    let accelerations = solve(system, &at.state)?.accelerations;
    // The event's function may have no derivative at the earlier state.
    let earlier = rate(system, before, change).map_or(L::Scalar::constant(0.0), |(_, terms)| terms);
    let (rate, terms) = rate(system, &at.state, change)?;
    if Scalar::abs(rate) <= power_of_epsilon::<L::Scalar>(0.5) * larger(terms, earlier) {
        return Err(Error::Grazing { event, time: at.state.t.to_f64() });
    }
    for j in 0..at.arguments.len() {
        let change = change(&at.by(j))?;
        at.delay(j, -change / rate, &accelerations);
    }
    Ok(at)
}

/// Rate of an event's function along the motion, and the sum of the magnitudes of its terms.
fn rate<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    change: &EventChange<'_, L>,
) -> Result<(L::Scalar, L::Scalar), Error> {
    let accelerations = solve(system, state)?.accelerations;
    let zero = Direction::zero();
    let mut sums = [L::Scalar::constant(0.0); 2];
    for i in 0..=2 * <L::N>::COUNT {
        let direction = match i {
            i if i < <L::N>::COUNT => Direction { q: only(i, &state.v), ..zero },
            i if i < 2 * <L::N>::COUNT => Direction { v: only(i - <L::N>::COUNT, &accelerations), ..zero },
            _ => Direction::of_time(),
        };
        let part = change(&ChangingState::along(state, direction))?;
        sums = [sums[0] + part, sums[1] + Scalar::abs(part)];
    }
    Ok(sums.into())
}

/// Vector with entry `i` of `x` alone, others zero.
fn only<T: Real, N: StaticLength>(i: usize, x: &Vector<T, N>) -> Vector<T, N> {
    vector(from_fn(|j| if i == j { x[j] } else { T::constant(0.0) }))
}

/// See [`MotionDerivatives::push_forward`](crate::linearized::MotionDerivatives::push_forward).
pub(super) fn push_forward<L: Linearized<Scalar: Real>, const K: usize>(
    system: &L,
    at: &StateSensitivity<L::Scalar, L::N>,
    map: impl Fn(&DualSample<'_, L>) -> Result<[[Dual<L::Scalar>; K]; 2], Error>,
) -> Result<StateSensitivity<L::Scalar, Const<K>>, Error> {
    let still = ChangingState::along(&at.state, Direction::zero());
    let [q, v] = map(&DualSample::of(system, &still))?.map(|half| vector(Array(half.map(|x| x.value))));
    let mut after = StateSensitivity::of(State { t: at.state.t, q, v }, at.arguments.clone());
    after.t.copy_from(&at.t);
    for j in 0..at.arguments.len() {
        let slopes = map(&DualSample::of(system, &at.by(j)))?.map(|half| half.map(|x| x.slope));
        after.set(j, [&slopes[0], &slopes[1]]);
    }
    Ok(after)
}

/// See [`MotionDerivatives::impact_sensitivity`](crate::linearized::MotionDerivatives::impact_sensitivity); `hit` is the index of the
/// constraint. The coefficient of restitution is given with its derivatives by the arguments.
///
/// The velocity jump J and the impulses Λ solve M J − FᵀΛ = 0, F J + ρ = 0 with ρ = F q̇⁻ + b, multiplied by 1 + e in
/// the row of the impact. Differentiation needs two terms. δM J − δFᵀΛ is the change of the residual of motion with
/// accelerations J and multipliers Λ, less the change with both zero. δF J is the same difference for the residual of
/// the acceleration constraints.
pub(super) fn impact_sensitivity<L: Linearized<Scalar: Real>>(
    system: &L,
    at: &StateSensitivity<L::Scalar, L::N>,
    hit: usize,
    (restitution, slopes): (L::Scalar, &dyn Fn(usize) -> L::Scalar),
) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
    let impact = impact(system, &at.state, hit, restitution)?;
    let jump = Solution::given(impact.state.v.minus(&at.state.v), impact.impulses);
    let jumped = Tangent::of(system, &at.state, jump);
    let still = Tangent::of(system, &at.state, Solution::given(zeros(), zeros()));
    let rate = system.constraint_rate(&at.state)[hit];
    let mut after = StateSensitivity { state: impact.state, ..at.clone() };
    for (j, &argument) in at.arguments.iter().enumerate() {
        let direction = at.direction(j);
        let [with, without] =
            [&jumped, &still].map(|tangent| tangent.change_with(&direction, Some(argument)));
        let mut acceleration = with.acceleration.minus(&without.acceleration).plus(&with.rate);
        acceleration[hit] = acceleration[hit] + restitution * with.rate[hit] + slopes(j) * rate;
        let motion = with.motion.minus(&without.motion);
        let jump = jumped.response(&ResidualChange { motion, acceleration, ..with }, argument)?.accelerations;
        after.v.column_mut(j).iter_mut().zip(&jump).for_each(|(v, jump)| *v += *jump);
    }
    Ok(after)
}
