//! A system with contacts at a state: gaps, their rates and round-off, and what forces do to them.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::cell::Cell;

use super::limits::{INSTANT, STILL};
use super::rows::TouchingRows;
use super::states::{LegFriction, LegStates};
use super::{Contact, Contacts, Friction};
use crate::error::Error;
use crate::motion::Simulate;
use crate::names::{Row, name};
use crate::number::limits::{ACCUMULATED, CANCELLED, SUM};
use crate::number::{Real, Scalar, larger, power_of_epsilon};
use crate::solution::consistent::gradient;
use crate::solution::solve::solve_near;
use crate::system::{Lagrangian, StateOf};
use crate::vector::{Array, Matrix, Vector, vector};

/// A system with its contacts open and with its contacts closed, and the largest entries of its motion so far.
pub(super) struct Bodies<L: Lagrangian> {
    pub(super) open: L,
    pub(super) closed: L,
    /// Constraints at the state where they were evaluated last.
    last: Cell<Option<Box<ClosedConstraints<L>>>>,
    largest: [Array<L::Scalar, L::N>; 2],
    /// Length of the motion in time.
    pub(super) span: L::Scalar,
    /// Part of the velocities by which steps err.
    pub(super) accuracy: f64,
}

/// Values of all constraints at a state, with all contacts closed.
struct ClosedConstraints<L: Lagrangian> {
    state: StateOf<L>,
    /// Gaps, rates, and accelerations at q̈ = 0.
    values: [Vector<L::Scalar, L::M>; 3],
    jacobian: Matrix<L::Scalar, L::M, L::N>,
}

impl<L: Lagrangian> ClosedConstraints<L> {
    fn of(closed: &L, state: &StateOf<L>) -> Self {
        let (gaps, rates) = (closed.constraint_residual(state), closed.constraint_rate(state));
        let values = [gaps, rates, closed.constraint_bias(state)];
        Self { state: *state, values, jacobian: closed.constraint_jacobian(state) }
    }
}

/// A gap or a velocity of friction at a state, with its rate and round-off.
pub(super) struct Measured<T> {
    pub(super) gap: T,
    pub(super) rate: T,
    /// Round-off of gap and rate.
    pub(super) noise: [T; 2],
}

/// Sum Σ |Gₖⱼ Λⱼ| of what impulses Λⱼ of constraints j change the rate of constraint k by, with the responses G = W K⁻¹ Wᵀ: what is
/// left of it may be round-off.
pub(crate) fn impulse_changes<L: Contacts<Scalar: Real> + Clone>(
    system: &L,
    k: usize,
    impulses: &[(usize, L::Scalar)],
    state: &StateOf<L>,
) -> Result<L::Scalar, Error> {
    let bodies = Bodies::new(system, 0.0);
    let rows = bodies.rows((0..L::CONTACTS.len()).collect(), state)?;
    let place = |row: usize| rows.all.iter().position(|&of| of == row).unwrap_or(0);
    let change = |&(row, impulse): &(usize, L::Scalar)| {
        Scalar::abs(impulse) * L::Scalar::constant(rows.response(place(k), place(row)).abs())
    };
    Ok(impulses.iter().map(change).fold(L::Scalar::constant(0.0), |sum, change| sum + change))
}

/// Sets all contacts and all friction of a system.
pub(super) fn set_all<L: Contacts>(system: &mut L, contact: Contact, friction: Friction) {
    (0..L::FRICTIONS.len()).for_each(|f| {
        system.set_friction(f, friction);
    });
    (0..L::CONTACTS.len()).for_each(|k| {
        system.set_contact(k, contact);
    });
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    pub(super) fn new(system: &L, accuracy: f64) -> Self {
        let largest = [Array::filled(L::Scalar::constant(0.0)); 2];
        let [mut open, mut closed] = [system.clone(), system.clone()];
        set_all(&mut open, Contact::Open, LegFriction::OFF.friction);
        set_all(&mut closed, Contact::Closed, Friction::Sticks);
        Self { open, closed, last: Cell::new(None), largest, span: L::Scalar::constant(0.0), accuracy }
    }

    /// Takes the parameters of this system.
    pub(super) fn take(&mut self, system: &L) {
        let Self { open, closed, .. } = Self::new(system, self.accuracy);
        (self.open, self.closed, self.last) = (open, closed, Cell::new(None));
    }

    /// The system with contacts and friction in these states.
    pub(super) fn with(&self, states: &LegStates) -> L {
        let mut system = self.open.clone();
        for (k, of) in states.contacts.iter().enumerate() {
            system.set_contact(k, if of.is_closed { Contact::Closed } else { Contact::Open });
        }
        for f in (0..states.frictions.len()).filter(|&f| states.is_pressed::<L>(f)) {
            system.set_friction(f, states.frictions[f].friction);
        }
        system
    }

    /// Fails if the gap of a contact that is closed is not zero, or another constraint does not hold. Friction does not count:
    /// velocities say whether it sticks.
    pub(super) fn check_closed(
        &self,
        is_closed: impl Fn(usize) -> bool,
        state: &StateOf<L>,
    ) -> Result<(), Error> {
        self.with(&LegStates::closed::<L>(is_closed)).check_consistent(state).map_err(|error| match error {
            Error::Inconsistent { constraint: Row::Constraint(contact), rate, residual, time }
                if (0..L::CONTACTS.len()).any(|k| self.name(k) == contact) =>
            {
                Error::ClosedApart { contact, rate, residual, time }
            }
            error => error,
        })
    }

    /// Reads the constraints at a state. They are evaluated unless that was the last one: contacts are measured in turn.
    fn at<R>(&self, state: &StateOf<L>, read: impl FnOnce(&ClosedConstraints<L>) -> R) -> R {
        let last = self.last.take().filter(|last| last.state == *state);
        let at = last.unwrap_or_else(|| Box::new(ClosedConstraints::of(&self.closed, state)));
        let found = read(&at);
        self.last.set(Some(at));
        found
    }

    pub(super) fn gap(&self, k: usize, state: &StateOf<L>) -> L::Scalar {
        self.at(state, |at| at.values[0][L::CONTACTS[k]])
    }

    /// Takes note of the entries of a state.
    pub(super) fn passes(&mut self, state: &StateOf<L>) {
        for (largest, entries) in self.largest.iter_mut().zip([&state.q, &state.v]) {
            *largest = Array::from_fn(|i| larger(largest[i], Scalar::abs(entries[i])));
        }
    }

    /// Takes note of what impulses change the velocities by. The round-off of a velocity that they all but stop is that of
    /// the changes.
    pub(super) fn strikes(&mut self, impulses: impl Iterator<Item = Vector<L::Scalar, L::N>>) {
        let mut changes = Array::<_, L::N>::filled(L::Scalar::constant(0.0));
        for change in impulses {
            changes = Array::from_fn(|i| changes[i] + Scalar::abs(change[i]));
        }
        let [_, largest] = &mut self.largest;
        *largest = Array::from_fn(|i| larger(largest[i], changes[i]));
    }

    /// The largest entries so far, at the time of a state.
    pub(super) fn sizes(&self, state: &StateOf<L>) -> StateOf<L> {
        let [q, v] = self.largest.map(vector);
        StateOf::<L> { t: state.t, q, v }
    }

    /// Takes note of what the bodies move in a millionth of the span from rest, without their contacts: where all entries are
    /// zero from the start on, round-off has no other size.
    pub(super) fn reaches(&mut self, state: &StateOf<L>, span: L::Scalar) -> Result<(), Error> {
        self.span = span;
        let part = span * L::Scalar::constant(INSTANT);
        let free = solve_near(&self.open, state, None, |solution, _| solution.accelerations)?;
        for (largest, time) in self.largest.iter_mut().zip([part * part, part]) {
            *largest = Array::from_fn(|i| larger(largest[i], Scalar::abs(free[i]) * time));
        }
        Ok(())
    }

    /// The gap of contact `k`, its rate, and their round-off.
    pub(super) fn measured(&self, k: usize, state: &StateOf<L>) -> Measured<L::Scalar> {
        self.measured_at(L::CONTACTS[k], state)
    }

    /// The rate of constraint `a`, its Φ if it has one, and their round-off, by the largest entries so far: a gap comes from a projection and a
    /// location, a rate from a solve.
    pub(super) fn measured_at(&self, a: usize, state: &StateOf<L>) -> Measured<L::Scalar> {
        self.at(state, |at| {
            let ([gap, rate, bias], row) = (at.values.each_ref().map(|values| values[a]), at.jacobian.row(a));
            let unit = L::Scalar::constant(L::Scalar::EPSILON * CANCELLED);
            let [of_gap, of_rate] = self.largest.each_ref().map(|largest| {
                let sizes = row.iter().zip(largest).map(|(w, &most)| Scalar::abs(*w) * most);
                sizes.fold(L::Scalar::constant(0.0), |sum, size| sum + size)
            });
            let of_bodies = row.iter().zip(&state.v).fold(rate, |rest, (&w, &v)| rest - w * v);
            let in_time = (Scalar::abs(rate) + Scalar::abs(of_bodies)) * Scalar::abs(state.t);
            let rate_in_time = Scalar::abs(bias * state.t);
            Measured { gap, rate, noise: [unit * (of_gap + in_time), unit * (of_rate + rate_in_time)] }
        })
    }

    /// Rates of the rows of contacts and friction, and their round-off.
    pub(super) fn measured_rates(&self, rows: &TouchingRows<L>, state: &StateOf<L>) -> (Vec<f64>, Vec<f64>) {
        let of = |&a: &usize| {
            let Measured { rate, noise, .. } = self.measured_at(a, state);
            (rate.to_f64(), noise[1].to_f64())
        };
        rows.all[..rows.count].iter().map(of).unzip()
    }

    /// Gap up to which the bodies of a contact touch: twice the round-off that events estimate, below which they do not see a gap close.
    pub(super) fn touching(&self, k: usize, state: &StateOf<L>) -> L::Scalar {
        self.measured(k, state).noise[0] * L::Scalar::constant(SUM)
    }

    /// First open contact whose bodies penetrate by more than √ε of the terms of the gap, half of the digits: a start need not be
    /// given more closely. The gap of a closed one is a constraint, zero but for round-off.
    pub(super) fn crossed(&self, is_kept: impl Fn(usize) -> bool, state: &StateOf<L>) -> Option<Error> {
        let gaps = self.closed.constraint_residual(state);
        let is_positive = |k: usize| gaps[L::CONTACTS[k]] >= L::Scalar::constant(0.0);
        (0..L::CONTACTS.len()).filter(|&k| !is_kept(k) && !is_positive(k)).find_map(|k| {
            let Measured { gap, noise: [noise, _], .. } = self.measured(k, state);
            let terms = noise / L::Scalar::constant(CANCELLED * L::Scalar::EPSILON);
            let is_open = gap + terms * power_of_epsilon(0.5) >= L::Scalar::constant(0.0);
            let (contact, time) = (self.name(k), state.t.to_f64());
            (!is_open).then(|| Error::Penetration { contact, gap: gap.to_f64(), time })
        })
    }

    pub(super) fn name(&self, k: usize) -> &'static str {
        name(L::CONSTRAINTS, L::CONTACTS[k])
    }

    /// Accelerations W q̈ + γ of the rows without forces of contacts and friction, and their round-off.
    pub(super) fn pressing(
        &self,
        rows: &TouchingRows<L>,
        state: &StateOf<L>,
    ) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let free = solve_near(&self.open, state, None, |solution, _| solution.accelerations)?;
        Ok(self.at(state, |at| {
            let of = |&a: &usize| {
                let (row, [_, _, bias]) = (at.jacobian.row(a), at.values.each_ref().map(|values| values[a]));
                let terms = || row.iter().zip(&free).map(|(&w, &free)| w * free).chain([bias]);
                let size = terms().fold(L::Scalar::constant(0.0), |sum, term| sum + Scalar::abs(term));
                let sum = terms().fold(L::Scalar::constant(0.0), |sum, term| sum + term);
                (sum.to_f64(), L::Scalar::EPSILON * CANCELLED * size.to_f64())
            };
            rows.all[..rows.count].iter().map(of).unzip()
        }))
    }

    /// Error of the velocities of a friction with this round-off. A step ends where a single velocity becomes zero. Two become zero within a
    /// step, and have the error of its method.
    pub(super) fn sliding_error(&self, count: usize, noise: L::Scalar) -> L::Scalar {
        let by_steps = self.accuracy * STILL / (L::Scalar::EPSILON * CANCELLED);
        if count == 2 { noise * L::Scalar::constant(by_steps.max(1.0)) } else { noise }
    }

    /// Whether a gap that is zero remains so but for round-off: its rate is none, or a bounce would rise by none: events find a gap that rests closed
    /// by up to 12 units of its round-off below zero, and see it positive from 3 units on. The first value is its
    /// acceleration; the second is the round-off of the rate that the motion of all bodies has, see [`TouchingRows::motion_noise`].
    pub(super) fn rests(&self, k: usize, values: [f64; 2], state: &StateOf<L>) -> bool {
        let ([acceleration, of_motion], Measured { rate, noise: [of_gap, of_rate], .. }) =
            (values.map(L::Scalar::constant), self.measured(k, state));
        let low =
            L::Scalar::constant(2.0 * ACCUMULATED) * of_gap * larger(-acceleration, L::Scalar::constant(0.0));
        Scalar::abs(rate) <= larger(of_rate, of_motion) || rate * rate <= low
    }

    /// Fails if the gap of a touching contact has no gradient, along which a force could keep it.
    pub(super) fn check_gradients(&self, touching: &[usize], state: &StateOf<L>) -> Result<(), Error> {
        match touching {
            [] => Ok(()),
            _ => gradient::check(&self.with(&LegStates::closed::<L>(|k| touching.contains(&k))), state),
        }
    }

    pub(super) fn restitution(&self, k: usize, state: &StateOf<L>) -> Result<L::Scalar, Error> {
        let value = self.open.restitution(k, state).unwrap_or(L::Scalar::constant(0.0));
        let is_one = value >= L::Scalar::constant(0.0) && value <= L::Scalar::constant(1.0);
        let constraint = self.name(k);
        if is_one { Ok(value) } else { Err(Error::Restitution { constraint, value: value.to_f64() }) }
    }

    pub(super) fn contradiction(&self, touching: &[usize], state: &StateOf<L>) -> Error {
        let contacts = touching.iter().map(|&k| self.name(k)).collect();
        Error::ContactsContradict { contacts, time: state.t.to_f64() }
    }
}
