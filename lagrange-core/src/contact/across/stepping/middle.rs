//! The equations of a step, at the state to which the bodies drift first.

use alloc::rc::Rc;
use alloc::vec;
use alloc::vec::Vec;

use super::forces::{ImplicitForces, ThetaForces};
use crate::contact::across::bodies::Bodies;
use crate::contact::across::limits::INSTANT;
use crate::contact::across::rows::{Inertia, SparseRows, TouchingRows};
use crate::contact::{Contacts, ForceDerivatives};
use crate::error::{Error, Row};
use crate::names::name;
use crate::number::limits::{CANCELLED, HALF_THE_DIGITS};
use crate::number::{Real, Scalar};
use crate::numerics::bare::{dot, sqrt};
use crate::system::StateOf;
use crate::vector::{Array, Entrywise, StaticLength, Vector, vector};

/// Equations at the state to which the bodies drift first. Lists of values have one for each constraint, in the order of their indices.
pub(super) struct Middle<L: Contacts<Scalar: Real>> {
    pub(super) state: StateOf<L>,
    pub(super) jacobian: SparseRows,
    pub(super) gaps: Vec<f64>,
    /// Gaps before the step.
    before: Vec<f64>,
    /// Rates with the velocities before the step, and their round-off.
    pub(super) rates: Vec<f64>,
    pub(super) noise: Vec<f64>,
    mass: SparseRows,
    forces: ThetaForces<L>,
    /// The mass matrix with the forces that change with the velocities.
    pub(super) inertia: Inertia,
    /// Sizes of the terms of these forces.
    sizes: Vec<f64>,
    /// Round-off of momenta.
    momenta: Vec<f64>,
    /// What the free bodies gain in the step.
    pub(super) gained: Vec<f64>,
    /// Round-off of gaps; up to where each counts as closed, and up to where a start may be below zero.
    round_off: Vec<f64>,
    pub(super) touching: Vec<f64>,
    pub(super) started: Vec<f64>,
    /// Lengths of the step, and of the second drift.
    pub(super) lengths: [f64; 2],
    /// Contacts that act in this step.
    acts: Vec<bool>,
}

impl<L: ForceDerivatives<Scalar: Real> + Clone> Middle<L> {
    pub(super) fn of(
        bodies: &Bodies<L>,
        from: &StateOf<L>,
        step: L::Scalar,
        theta: f64,
    ) -> Result<Self, Error> {
        let second = step * L::Scalar::constant(theta);
        let first = step - second;
        let q = from.q.plus(&from.v.each(|v| v * first));
        let state = StateOf::<L> { t: from.t + first, q, v: from.v };
        let of_constraints = |v: &Vector<L::Scalar, L::M>| v.iter().map(|x| x.to_f64()).collect::<Vec<f64>>();
        let gaps = of_constraints(&bodies.closed.constraint_residual(&state));
        if let Some(&row) = L::CONTACTS.iter().find(|&&row| !gaps[row].is_finite()) {
            let row = Row::Constraint(L::CONSTRAINTS[row]);
            return Err(Error::EquationsNotFinite { row, time: state.t.to_f64() });
        }
        let before = of_constraints(&bodies.closed.constraint_residual(from));
        let jacobian = bodies.jacobian(&state);
        let rates = of_constraints(&bodies.closed.constraint_rate(&state));
        let (mass, forces) = (bodies.mass(&state), ThetaForces::new(from, step, theta));
        let ImplicitForces { added, sizes } = forces.linearize(bodies);
        // Forces that drive the velocities apart within a step are left to the iteration.
        let inertia = bodies
            .inertia(&mass, &added, (&jacobian, &state))
            .or_else(|_| bodies.inertia(&mass, &[], (&jacobian, &state)))?;
        let mut middle = Self {
            momenta: vec![],
            noise: vec![],
            gained: vec![],
            round_off: vec![],
            touching: vec![],
            started: vec![],
            lengths: [step, second].map(Real::to_f64),
            acts: vec![false; L::CONTACTS.len()],
            state,
            jacobian,
            gaps,
            before,
            rates,
            mass,
            forces,
            inertia,
            sizes,
        };
        middle.measure(bodies, from);
        Ok(middle)
    }

    /// Takes round-off and what the free bodies gain, and lets closed contacts act.
    fn measure(&mut self, bodies: &Bodies<L>, from: &StateOf<L>) {
        let mut gained = self.pull(bodies, &from.v);
        self.inertia.factor.solve_lower(&mut gained);
        self.inertia.factor.solve_upper(&mut gained);
        let (largest, unit, time) =
            (bodies.sizes(&self.state), L::Scalar::EPSILON * CANCELLED, self.state.t.to_f64().abs());
        let fastest = sqrt(dot(&gained, &gained));
        for a in 0..<L::M>::COUNT {
            let [mut of_gap, mut of_rate, mut of_bodies, mut square] = [0.0; 4];
            for &(i, w) in self.jacobian.row(a) {
                of_gap += w.abs() * largest.q[i].to_f64();
                of_rate += w.abs() * largest.v[i].to_f64();
                square += w * w;
                of_bodies += w * self.state.v[i].to_f64();
            }
            let in_time = (self.rates[a].abs() + (self.rates[a] - of_bodies).abs()) * time;
            self.noise.push(unit * (of_rate + (self.rates[a] - of_bodies).abs()));
            let (size, moved) = (of_gap + in_time, self.lengths[0] * sqrt(square) * fastest);
            let touching = unit * size + INSTANT * moved;
            self.round_off.push(unit * size);
            self.touching.push(touching);
            self.started.push(f64::max(2.0 * touching, HALF_THE_DIGITS * size));
        }
        self.gained = gained;
        let speeds: Vec<f64> = largest.v.iter().map(|v| v.to_f64()).collect();
        let momentum = |i: usize| self.mass.row(i).iter().fold(0.0, |sum, &(k, m)| sum + m.abs() * speeds[k]);
        self.momenta = (0..<L::N>::COUNT).map(|i| unit * momentum(i)).collect();
        for (acts, &row) in self.acts.iter_mut().zip(L::CONTACTS) {
            *acts = self.gaps[row] <= self.touching[row];
        }
    }

    /// What the balance of momentum lacks without impulses if these are the velocities after the step: h f − M (v⁺ − v⁻).
    pub(super) fn pull(&self, bodies: &Bodies<L>, after: &Vector<L::Scalar, L::N>) -> Vec<f64> {
        let mut pull = self.forces.impulse(bodies, after);
        let change = self.change(after);
        pull.iter_mut().enumerate().for_each(|(i, pull)| *pull -= self.mass.along(i, &change));
        pull
    }

    /// Change of the velocities in the step, if these are those after it.
    fn change(&self, after: &Vector<L::Scalar, L::N>) -> Vec<f64> {
        after.iter().zip(self.state.v.iter()).map(|(after, before)| (*after - *before).to_f64()).collect()
    }

    /// Change of the velocities by `pull` without impulses, in coordinates of kinetic energy.
    pub(super) fn free_change(&self, pull: &[f64]) -> Vec<f64> {
        let mut own = pull.to_vec();
        self.inertia.factor.solve_lower(&mut own);
        own
    }

    /// The velocities after this change of them, in coordinates of kinetic energy.
    pub(super) fn velocities(&self, change: &[f64]) -> Vector<L::Scalar, L::N> {
        let mut v = change.to_vec();
        self.inertia.factor.solve_upper(&mut v);
        self.state.v.plus(&vector(Array::from_fn(|i| L::Scalar::constant(v[i]))))
    }

    /// The largest part of a momentum, in units of the root of an energy, by which the balance is off but for round-off of momenta, relative to the
    /// largest of its terms.
    pub(super) fn residual(&self, pull: &[f64], after: &Vector<L::Scalar, L::N>, impulses: &[f64]) -> f64 {
        let change = self.change(after);
        let (mut off, mut terms) = (pull.to_vec(), self.sizes.clone());
        for (a, impulse) in impulses.iter().enumerate().filter(|(_, impulse)| **impulse != 0.0) {
            for &(i, w) in self.jacobian.row(a) {
                off[i] += w * impulse;
                terms[i] += (w * impulse).abs();
            }
        }
        let [mut most, mut size] = [0.0_f64; 2];
        for i in 0..<L::N>::COUNT {
            let of_mass = self.mass.row(i).iter().map(|&(k, m)| (m * change[k]).abs()).sum::<f64>();
            let unit = self.inertia.factor.diagonal(i);
            // NaN is kept.
            let rest = (off[i].abs() - self.momenta[i]) / unit;
            most = if rest <= most { most } else { rest };
            size = size.max((terms[i] + of_mass + pull[i].abs()) / unit);
        }
        if most == 0.0 { 0.0 } else { most / size }
    }

    /// Rows of what acts.
    pub(super) fn rows(&self) -> TouchingRows<L> {
        let acting = (0..self.acts.len()).filter(|&k| self.acts[k]).collect();
        TouchingRows::of(acting, &self.jacobian, Rc::clone(&self.inertia.factor))
    }

    /// The rate at which a gap closes, but for its round-off, to be zero in the middle of the next step: were it zero at the end of this one, its rate
    /// would change its sign from step to step. A gap below zero is left to the correction of the position.
    pub(super) fn closing(&self, row: usize) -> f64 {
        (self.round_off[row] - self.gaps[row]).min(0.0) / self.lengths[0]
    }

    /// The first contact whose gap was negative before the step, by more than what the longest step so far leaves.
    pub(super) fn crossed(&self, from: &StateOf<L>, longest: f64) -> Option<Error> {
        let longer = longest / self.lengths[0];
        let allowed = |row: usize| self.started[row] * f64::max(1.0, longer * longer);
        let row = *L::CONTACTS.iter().find(|&&row| self.before[row] < -allowed(row))?;
        let (contact, time) = (name(L::CONSTRAINTS, row), from.t.to_f64());
        Some(Error::Penetration { contact, gap: self.before[row], time })
    }

    /// Lets contacts act whose gaps would be negative in the middle of the next step. Returns whether there are any.
    pub(super) fn joins(&mut self, after: &Vector<L::Scalar, L::N>) -> bool {
        let change = self.change(after);
        let mut any = false;
        for (k, &row) in L::CONTACTS.iter().enumerate() {
            // Where walls move, a part of the rate does not depend on the velocities of bodies.
            let rate = self.rates[row] + self.jacobian.along(row, &change);
            let closes = rate < 0.0 && self.gaps[row] + rate * self.lengths[0] < -self.touching[row];
            if closes && !self.acts[k] {
                (self.acts[k], any) = (true, true);
            }
        }
        any
    }

    pub(super) fn acts(&self, k: usize) -> bool {
        self.acts[k]
    }
}
