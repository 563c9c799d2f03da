//! Equations of motion that are stated as accelerations.

use nalgebra::Const;

use super::consistent::{Adjustment, Consistent};
use super::system_checks::{SystemChecks, check_length};
use super::vector_field::{ActiveConstraints, StagePoint, VectorField, VelocityField};
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Parts, Real, Scalar, are_finite};
use crate::system::{State, StateOf, System};
use crate::vector::{Array, Numbers, PhaseVector, VectorOf};

/// The accelerations of a [`System`] that is stated by them alone.
#[derive(Clone, Copy, Debug)]
pub struct AccelerationField;

impl<L: System<Scalar: Real, M = Const<0>>> VectorField<L> for AccelerationField {
    const HOLDS_VELOCITY: bool = true;

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
            let row = <Self as SystemChecks<L>>::row(row);
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
}

impl<L: System<Scalar: Real, M = Const<0>>> VelocityField<L> for AccelerationField {}

impl<L: System<Scalar: Real, M = Const<0>>> SystemChecks<L> for AccelerationField {
    const HAS_CONTACTS: bool = false;
    const HAS_FRICTION: bool = false;
    const COORDINATES: &'static [&'static str] = &[];
    const CONSTRAINTS: &'static [&'static str] = &[];
    const DIGEST: u32 = 0;
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
        // Entries that `accelerations` does not write, or adds to, stay NaN.
        rates[1].fill(L::Scalar::constant(f64::NAN));
        <Self as VectorField<L>>::evaluate(system, &point, None, &mut rates).map(|_| ())
    }

    fn check_constraints(_: &L, _: &StateOf<L>) -> Result<(), Error> {
        Ok(())
    }

    fn adjust(system: &L, state: &StateOf<L>) -> Result<Consistent<L::Scalar, L::Length>, Error> {
        Ok((state.clone(), Adjustment::none(system.length())))
    }

    fn visit_numbers(_: &L, _: &mut dyn FnMut(f64)) {}

    fn momenta(_: &L, state: &StateOf<L>) -> VectorOf<L::Scalar, L::Length> {
        state.v.clone()
    }
}
