//! Vector fields that the methods integrate: Lagrange's equations in (q, q̇), Hamilton's in (q, p), stated accelerations.

use nalgebra::Const;

use super::consistent::{Adjustment, BOTH, Consistent, check, project, project_to_round_off};
use super::solve::{solve, solve_near};
use crate::error::Error;
use crate::names::{Entry, Row, name};
use crate::number::{Parts, Real, Scalar, are_finite};
use crate::system::finite::check_finite;
use crate::system::{Lagrangian, State, StateOf, System};
use crate::vector::{
    Array, Element, Length, Numbers, PhaseVector, StaticLength, Vector, VectorOf, array, vector,
};

/// First-order equations of motion for a [`PhaseVector`], whose first half is q.
pub trait VectorField<L: System<Scalar: Real>> {
    /// True if the second half of a phase is the velocity, so that a state is known without evaluating its
    /// rates.
    const HOLDS_VELOCITY: bool;
    /// True for a system with [contacts](crate::contact).
    const HAS_CONTACTS: bool;
    /// True if the force of friction is a multiple of a multiplier.
    const HAS_FRICTION: bool;

    /// Returns the name of the system.
    fn name() -> &'static str;

    /// Checks that the entries of a state and the parameters are finite, and that the state has as many entries as the system has
    /// coordinates.
    ///
    /// # Errors
    /// [`Error::StateNotFinite`], [`Error::StateLength`] and [`Error::ParameterNotAsSaid`].
    fn check_entries(system: &L, state: &StateOf<L>) -> Result<(), Error>;

    /// Checks that the equations of motion have a solution at a state.
    ///
    /// # Errors
    /// Those of [`Simulate::solve`](crate::Simulate::solve).
    fn check_solution(system: &L, state: &StateOf<L>) -> Result<(), Error>;

    /// Checks that a state satisfies the constraints, to √ε.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] and [`Error::NoGradient`].
    fn check_constraints(system: &L, state: &StateOf<L>) -> Result<(), Error>;

    /// Projects a state that satisfies the constraints to √ε onto them, to round-off.
    ///
    /// # Errors
    /// [`Error::NotProjected`].
    fn adjust(system: &L, state: &StateOf<L>) -> Result<Consistent<L::Scalar, L::Length>, Error>;

    /// Returns the phase of a state.
    fn phase(system: &L, state: &StateOf<L>) -> PhaseVector<L::Scalar, L::Length>;

    /// Returns the momenta; of a system that is stated by its accelerations, the velocities.
    fn momenta(system: &L, state: &StateOf<L>) -> VectorOf<L::Scalar, L::Length>;

    /// Writes the rates at `point` to `rates`. `active` marks the constraints to use; for `None` an independent
    /// set is chosen.
    ///
    /// # Errors
    /// Those of [`Simulate::solve`](crate::Simulate::solve), and of the search for the velocity.
    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, L::Length>,
        active: Option<&Array<bool, L::M>>,
        rates: &mut PhaseVector<L::Scalar, L::Length>,
    ) -> Result<ActiveConstraints<L::Scalar, L::M>, Error>;

    /// Returns the state at `point`. If the search for its velocity fails, uses the initial guess `point.velocity`.
    fn state(system: &L, point: &StagePoint<L::Scalar, L::Length>) -> StateOf<L>;

    /// Returns the nearest state on the constraints.
    ///
    /// # Errors
    /// Those of [`Simulate::make_consistent`](crate::Simulate::make_consistent), and of the search for the
    /// velocity.
    fn project(system: &L, point: &StagePoint<L::Scalar, L::Length>) -> Result<StateOf<L>, Error>;

    /// Returns the entry of the phase in this half, 0 or 1, that belongs to a coordinate.
    fn entry(half: usize, coordinate: usize) -> Entry;

    /// Returns the equation of a coordinate.
    fn row(coordinate: usize) -> Row;
}

/// Equations of motion in coordinates and velocities.
#[diagnostic::on_unimplemented(
    message = "this method does not integrate the equations `{Self}` of `{L}`",
    label = "integrates coordinates and velocities",
    note = "motions in (q, p), `motion_in_momenta`, are integrated by `Dop853`, `Dopri5` and other pairs alone"
)]
pub trait VelocityField<L: System<Scalar: Real>>: VectorField<L> {}

/// A time and a point of the phase space, as at a stage of a method.
#[derive(Clone, Debug)]
pub struct StagePoint<T: Element, N: Length> {
    /// Time.
    pub t: T,
    /// Point of the phase space.
    pub y: PhaseVector<T, N>,
    /// A nearby velocity, the initial guess of the search for the velocity that belongs to the momenta. It has no entries where
    /// the length is known when the program runs: there are no momenta.
    pub velocity: VectorOf<T, N>,
}

impl<T: Element, N: Length> StagePoint<T, N> {
    /// Returns the point of a state, with its velocities as the second half.
    pub fn of(state: &State<T, N>) -> Self {
        Self::at(state.t, PhaseVector::joined(&state.q, &state.v))
    }

    /// Returns the point of coordinates and velocities.
    #[inline(always)]
    pub fn at(t: T, y: PhaseVector<T, N>) -> Self {
        Self { t, velocity: y.half_if_constant(1), y }
    }
}

impl<T: Element, N: Length> Copy for StagePoint<T, N>
where
    PhaseVector<T, N>: Copy,
    VectorOf<T, N>: Copy,
{
}

/// The constraints that determine the rates of a phase.
#[derive(Clone, Copy, Debug)]
pub struct ActiveConstraints<T: Element, M: StaticLength> {
    /// True for each constraint that determines the rates.
    pub active: Array<bool, M>,
    /// Multiplier of each constraint.
    pub multipliers: Array<T, M>,
    /// True if the constraints are independent.
    pub multipliers_are_unique: bool,
}

/// Lagrange's equations in coordinates and velocities.
#[derive(Clone, Copy, Debug)]
pub struct LagrangianVectorField;

impl<L: Lagrangian<Scalar: Real>> VectorField<L> for LagrangianVectorField {
    const HOLDS_VELOCITY: bool = true;
    const HAS_CONTACTS: bool = L::HAS_CONTACTS;
    const HAS_FRICTION: bool = L::HAS_FRICTION;

    fn name() -> &'static str {
        L::NAME
    }

    fn check_entries(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        check_finite(system, state)
    }

    fn check_solution(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        solve(system, state).map(|_| ())
    }

    #[inline]
    fn check_constraints(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        check(system, state)
    }

    fn adjust(system: &L, state: &StateOf<L>) -> Result<Consistent<L::Scalar, L::N>, Error> {
        project_to_round_off(system, state)
    }

    #[inline]
    fn phase(_: &L, state: &StateOf<L>) -> PhaseVector<L::Scalar, L::N> {
        PhaseVector::<_, L::N>::of(state.q, state.v)
    }

    fn momenta(system: &L, state: &StateOf<L>) -> Vector<L::Scalar, L::N> {
        system.momentum(state)
    }

    // Always inlined: otherwise every stage would copy the returned value and the result moved out of the
    // closure.
    #[inline(always)]
    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, L::N>,
        active: Option<&Array<bool, L::M>>,
        rates: &mut PhaseVector<L::Scalar, L::N>,
    ) -> Result<ActiveConstraints<L::Scalar, L::M>, Error> {
        rates.set(0, point.y.half(1));
        solve_near(system, &Self::state(system, point), active, |solution, &active| {
            rates.set(1, array(solution.accelerations));
            let multipliers = array(solution.multipliers);
            ActiveConstraints {
                active,
                multipliers,
                multipliers_are_unique: solution.multipliers_are_unique(),
            }
        })
    }

    #[inline]
    fn state(_: &L, point: &StagePoint<L::Scalar, L::N>) -> StateOf<L> {
        State { t: point.t, q: vector(point.y.half(0)), v: vector(point.y.half(1)) }
    }

    #[inline]
    fn project(system: &L, point: &StagePoint<L::Scalar, L::N>) -> Result<StateOf<L>, Error> {
        let mut state = Self::state(system, point);
        project(system, &BOTH, &mut state)?;
        Ok(state)
    }

    fn entry(half: usize, coordinate: usize) -> Entry {
        let name = name(L::COORDINATES, coordinate);
        if half == 0 { Entry::Coordinate(name) } else { Entry::Velocity(name) }
    }

    fn row(coordinate: usize) -> Row {
        Row::Coordinate(name(L::COORDINATES, coordinate))
    }
}

impl<L: Lagrangian<Scalar: Real>> VelocityField<L> for LagrangianVectorField {}

/// Checks that a state has as many coordinates and velocities as its system has coordinates.
pub(crate) fn check_length<L: System>(system: &L, state: &StateOf<L>) -> Result<(), Error> {
    let expected = system.length().count();
    match [state.q.entries(), state.v.entries()].iter().find(|half| half.len() != expected) {
        None => Ok(()),
        Some(half) => Err(Error::StateLength { found: half.len(), expected }),
    }
}

/// The accelerations of a [`System`] that is stated by them alone.
#[derive(Clone, Copy, Debug)]
pub struct AccelerationField;

impl<L: System<Scalar: Real, M = Const<0>>> VectorField<L> for AccelerationField {
    const HOLDS_VELOCITY: bool = true;
    const HAS_CONTACTS: bool = false;
    const HAS_FRICTION: bool = false;

    fn name() -> &'static str {
        let path = core::any::type_name::<L>();
        let pointers = ["alloc::sync::Arc<", "alloc::rc::Rc<", "alloc::boxed::Box<"];
        let path = pointers.iter().fold(path, |path, pointer| path.strip_prefix(pointer).unwrap_or(path));
        let path = path.split(['<', '>']).next().unwrap_or(path);
        path.rsplit(':').next().unwrap_or(path)
    }

    fn check_entries(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        check_length(system, state)?;
        let halves = [state.q.entries(), state.v.entries()];
        let numbered = |half: usize| {
            let entries = halves[half].iter().enumerate();
            entries.map(move |(i, &x)| (<Self as VectorField<L>>::entry(half, i), x))
        };
        let mut all = [(Entry::Time, state.t)].into_iter().chain(numbered(0)).chain(numbered(1));
        match all.find(|(_, x)| !Parts::is_finite(*x)) {
            None => Ok(()),
            Some((entry, x)) => Err(Error::StateNotFinite { entry, value: x.to_f64() }),
        }
    }

    fn check_solution(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        let point = StagePoint::of(state);
        let mut rates = point.y.clone();
        // What is not written, or added to what was there, is found out at the start.
        rates[1].fill(L::Scalar::constant(f64::NAN));
        <Self as VectorField<L>>::evaluate(system, &point, None, &mut rates).map(|_| ())
    }

    fn check_constraints(_: &L, _: &StateOf<L>) -> Result<(), Error> {
        Ok(())
    }

    fn adjust(system: &L, state: &StateOf<L>) -> Result<Consistent<L::Scalar, L::Length>, Error> {
        Ok((state.clone(), Adjustment::none(system.length())))
    }

    fn phase(_: &L, state: &StateOf<L>) -> PhaseVector<L::Scalar, L::Length> {
        PhaseVector::joined(&state.q, &state.v)
    }

    fn momenta(_: &L, state: &StateOf<L>) -> VectorOf<L::Scalar, L::Length> {
        state.v.clone()
    }

    #[inline(always)]
    fn evaluate(
        system: &L,
        point: &StagePoint<L::Scalar, L::Length>,
        _: Option<&Array<bool, Const<0>>>,
        rates: &mut PhaseVector<L::Scalar, L::Length>,
    ) -> Result<ActiveConstraints<L::Scalar, Const<0>>, Error> {
        rates[0].copy_from_slice(&point.y[1]);
        system.accelerations(point.t, point.y.view(0), point.y.view(1), rates.view_mut(1));
        if !are_finite(&rates[1]) {
            let row = rates[1].iter().position(|a| !Parts::is_finite(*a)).unwrap_or(0);
            let row = <Self as VectorField<L>>::row(row);
            return Err(Error::EquationsNotFinite { row, time: point.t.to_f64() });
        }
        Ok(ActiveConstraints {
            active: Array::filled(true),
            multipliers: Array::filled(point.t),
            multipliers_are_unique: true,
        })
    }

    fn state(_: &L, point: &StagePoint<L::Scalar, L::Length>) -> StateOf<L> {
        let [q, v] = [0, 1].map(|half| VectorOf::<_, L::Length>::from_entries(&point.y[half]));
        State { t: point.t, q, v }
    }

    fn project(system: &L, point: &StagePoint<L::Scalar, L::Length>) -> Result<StateOf<L>, Error> {
        Ok(<Self as VectorField<L>>::state(system, point))
    }

    fn entry(half: usize, coordinate: usize) -> Entry {
        Entry::Numbered(half, coordinate)
    }

    fn row(coordinate: usize) -> Row {
        Row::Numbered(coordinate)
    }
}

impl<L: System<Scalar: Real, M = Const<0>>> VelocityField<L> for AccelerationField {}
