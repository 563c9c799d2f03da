//! Equations of motion that are stated as accelerations.

use core::fmt;
use core::marker::PhantomData;

use nalgebra::Const;

use super::consistent::{Adjustment, Consistent};
use super::named_field::NamedField;
use super::system_checks::{SystemChecks, check_length};
use super::vector_field::{ActiveConstraints, StagePoint, VectorField, VelocityField};
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Parts, Real, Scalar, are_finite};
use crate::system::{State, StateOf, System};
use crate::vector::{Array, Length, Numbers, PhaseVector, VectorOf};

/// Accelerations that a system states, in the place of equations that are solved for them. `K` tells what else the system states.
#[derive(Clone, Copy, Debug)]
pub struct Stated<K>(PhantomData<K>);

/// The accelerations of a [`System`] that is stated by them alone.
pub type AccelerationField = Stated<AccelerationsAlone>;

/// Kind of the systems that are stated by their accelerations alone.
#[derive(Clone, Copy, Debug)]
pub enum AccelerationsAlone {}

/// Fields of a system whose accelerations alone a motion evaluates.
pub trait StatedField<L: System<Scalar: Real>>: NamedField<L> {
    /// Hash of the equations; 0 if they are written by hand.
    const DIGEST: u32;

    /// Checks that the fields of a system fit one another.
    ///
    /// # Errors
    /// The field that does not fit.
    fn check_fields(system: &L) -> Result<(), Error>;

    /// Calls `visit` with each number of the fields.
    fn visit_fields(system: &L, visit: &mut dyn FnMut(f64));

    /// Reason why a state has no accelerations, if it is not one of numbers.
    fn fault(_: &L, _: &StateOf<L>) -> Option<Error> {
        None
    }

    /// Checks that a state satisfies the constraints, to √ε.
    ///
    /// # Errors
    /// [`Error::Inconsistent`].
    fn check_constraints(_: &L, _: &StateOf<L>) -> Result<(), Error> {
        Ok(())
    }

    /// True if the system has constraints.
    const HAS_CONSTRAINTS: bool = false;

    /// Projects coordinates and velocities near the constraints onto them, to round-off.
    ///
    /// # Errors
    /// [`Error::NotProjected`].
    fn project(_: &L, _t: L::Scalar, _: [&mut [L::Scalar]; 2]) -> Result<(), Error> {
        Ok(())
    }
}

impl<L: System<Scalar: Real>> NamedField<L> for AccelerationField {
    fn write_name(_: &L, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
        write!(to, "q[{coordinate}]")
    }
}

impl<L: System<Scalar: Real>> StatedField<L> for AccelerationField {
    const DIGEST: u32 = 0;

    fn check_fields(_: &L) -> Result<(), Error> {
        Ok(())
    }

    fn visit_fields(_: &L, _: &mut dyn FnMut(f64)) {}
}

impl<L: System<Scalar: Real, M = Const<0>>, K> VectorField<L> for Stated<K>
where
    Self: StatedField<L>,
{
    const HOLDS_VELOCITY: bool = true;

    const HAS_CONSTRAINTS: bool = <Self as StatedField<L>>::HAS_CONSTRAINTS;

    type Checks = Self;

    fn phase(_: &L, state: &StateOf<L>) -> PhaseVector<L::Scalar, L::Length> {
        PhaseVector::joined(&state.q, &state.v)
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
            let not_finite =
                Error::EquationsNotFinite { row: Self::row(system, row), time: point.t.to_f64() };
            let fault =
                <Self as StatedField<L>>::fault(system, &<Self as VectorField<L>>::state(system, point));
            return Err(fault.unwrap_or(not_finite));
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
        let mut state = <Self as VectorField<L>>::state(system, point);
        <Self as StatedField<L>>::project(system, state.t, [state.q.entries_mut(), state.v.entries_mut()])?;
        Ok(state)
    }

    #[inline]
    fn settle(system: &L, point: &mut StagePoint<L::Scalar, L::Length>) -> Result<(), Error> {
        let (q, v) = point.y.flat_mut().split_at_mut(system.length().count());
        <Self as StatedField<L>>::project(system, point.t, [q, v])
    }
}

impl<L: System<Scalar: Real, M = Const<0>>, K> VelocityField<L> for Stated<K> where Self: StatedField<L> {}

impl<L: System<Scalar: Real, M = Const<0>>, K> SystemChecks<L> for Stated<K>
where
    Self: StatedField<L>,
{
    const HAS_CONTACTS: bool = false;
    const HAS_FRICTION: bool = false;
    const COORDINATES: &'static [&'static str] = &[];
    const CONSTRAINTS: &'static [&'static str] = &[];
    const DIGEST: u32 = <Self as StatedField<L>>::DIGEST;
    const SUPPLIED: &'static [&'static str] = &[];

    fn name() -> &'static str {
        let mut path = core::any::type_name::<L>();
        let pointers = ["&", "alloc::sync::Arc<", "alloc::rc::Rc<", "alloc::boxed::Box<"];
        while let Some(behind) = pointers.iter().find_map(|pointer| path.strip_prefix(pointer)) {
            path = behind;
        }
        let path = path.split(['<', '>']).next().unwrap_or(path);
        path.rsplit(':').next().unwrap_or(path)
    }

    fn check_fit(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        check_length(system, state)?;
        Self::check_fields(system)
    }

    fn check_entries(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        Self::check_fit(system, state)?;
        let is_wrong = |x: &L::Scalar| !Parts::is_finite(*x);
        let halves = [state.q.entries(), state.v.entries()];
        let wrong = |half: usize| {
            let coordinate = halves[half].iter().position(is_wrong)?;
            Some((Self::state_entry(system, half, coordinate), halves[half][coordinate]))
        };
        let of_time = is_wrong(&state.t).then_some((Entry::Time, state.t));
        match of_time.or_else(|| wrong(0)).or_else(|| wrong(1)) {
            None => Ok(()),
            Some((entry, x)) => Err(Error::StateNotFinite { entry, value: x.to_f64() }),
        }
    }

    fn check_solution(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        let point = StagePoint::of(state);
        let mut rates = point.y.clone();
        // Entries that `accelerations` does not write, or adds to, stay NaN.
        rates[1].fill(L::Scalar::constant(f64::NAN));
        <Self as VectorField<L>>::evaluate(system, &point, None, &mut rates).map(|_| ())
    }

    fn check_constraints(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        <Self as StatedField<L>>::check_constraints(system, state)
    }

    fn adjust(system: &L, state: &StateOf<L>) -> Result<Consistent<L::Scalar, L::Length>, Error> {
        let settled = <Self as VectorField<L>>::project(system, &StagePoint::of(state))?;
        let adjustment = Adjustment::between(state, &settled);
        Ok((settled, adjustment))
    }

    fn visit_numbers(system: &L, visit: &mut dyn FnMut(f64)) {
        Self::visit_fields(system, visit);
    }

    fn momenta(_: &L, state: &StateOf<L>) -> VectorOf<L::Scalar, L::Length> {
        state.v.clone()
    }
}
