//! One step: the bodies drift, impulses change their velocities, they drift on, and gaps that are left negative are closed.

use alloc::vec::Vec;

use nalgebra::ComplexField;

use super::super::cones::{Cone, Cones, Swept};
use super::super::friction::bounds;
use super::MoreauJean;
use super::trajectory::TimeStep;
use crate::contact::bodies::Bodies;
use crate::contact::{Contacts, FrictionRows};
use crate::error::{Error, Row};
use crate::names::name;
use crate::number::{Real, Scalar, larger};
use crate::solution::kkt::Rank;
use crate::solution::pivot::is_trustworthy;
use crate::solution::solve::solve_in_general;
use crate::system::{Lagrangian, SolutionOf, StateOf};
use crate::vector::{Array, Entrywise, Length, Matrix, Vector, vector, zeros};

/// Gaps and residuals of constraints count as zero up to this part of what the free bodies move in a step: a hundred times what
/// velocities whose residual is the default tolerance move them, so that contacts at rest stay closed.
const TOUCHING: f64 = 1e-6;

/// Round-off of gaps, in units of the round-off of the sums Σ |Wᵢ qᵢ| over the largest entries so far, as for motions from impact to impact.
const UNITS: f64 = 8.0;

/// Part of the limit below which friction counts as sticking.
const WITHIN: f64 = 1.0 - 1e-9;

/// Largest number of Gauss–Newton corrections of a position. Convergence is quadratic, and the first violation that of a step.
const CORRECTIONS: usize = 20;

/// Bisections for the restitution of a step that would gain energy.
const HALVINGS: usize = 30;

/// A motion under way, with the memory of its steps.
pub(super) struct Stepper<L: Contacts<Scalar: Real>> {
    bodies: Bodies<L>,
    settings: MoreauJean,
    cones: Cones<L::Scalar>,
    /// Constraint of each row of the problem, and what an impulse of 1 does.
    rows: Vec<usize>,
    responses: Vec<SolutionOf<L>>,
    /// Entries of one row of the constraints that are not zero, with their coordinates.
    entries: Vec<(usize, L::Scalar)>,
    /// Contacts that act in this step.
    acts: Vec<bool>,
    /// Friction that did not reach its limit in the last step.
    sticks: Vec<bool>,
    /// Part of the restitution that applies in this step, and whether a contact bounces with it.
    returned: L::Scalar,
    bounces: bool,
    /// Impulses of the last step, with which sweeps begin.
    impulses: Vector<L::Scalar, L::M>,
}

/// Number of sweeps and residual, and the velocities after the impulses.
type Kicked<L> =
    ((usize, <L as Lagrangian>::Scalar), Vector<<L as Lagrangian>::Scalar, <L as Lagrangian>::N>);

/// Equations at the state to which the bodies drift first.
struct Middle<L: Contacts<Scalar: Real>> {
    state: StateOf<L>,
    factor: L::Factor,
    jacobian: Matrix<L::Scalar, L::M, L::N>,
    gaps: Vector<L::Scalar, L::M>,
    /// Rates with the velocities before the step.
    rates: Vector<L::Scalar, L::M>,
    /// Changes of velocities and impulses of constraints without contacts.
    free: SolutionOf<L>,
    /// Gap up to which each counts as closed.
    touching: Array<L::Scalar, L::M>,
    /// Lengths of the step, and of the second drift.
    lengths: [L::Scalar; 2],
}

impl<L: Contacts<Scalar: Real> + Clone> Stepper<L> {
    pub(super) fn new(bodies: Bodies<L>, settings: MoreauJean, state: &StateOf<L>) -> Self {
        let rows = <L::M>::COUNT;
        let (rates, sizes) = (bodies.closed.constraint_rate(state), bodies.closed.rate_magnitude(state));
        let unit = L::Scalar::constant(L::Scalar::EPSILON * UNITS);
        let is_still = |a: usize| Scalar::abs(rates[a]) <= unit * sizes[a];
        let sticks = |friction: &FrictionRows| friction.rows().all(is_still);
        Self {
            settings,
            cones: Cones::with_room(rows),
            rows: Vec::with_capacity(rows),
            responses: Vec::with_capacity(rows),
            entries: Vec::with_capacity(<L::N>::COUNT),
            acts: alloc::vec![false; L::CONTACTS.len()],
            sticks: L::FRICTIONS.iter().map(sticks).collect(),
            returned: L::Scalar::constant(1.0),
            bounces: false,
            impulses: zeros(),
            bodies,
        }
    }

    /// Takes a step from a state to the time `end`.
    pub(super) fn step(&mut self, from: &StateOf<L>, end: L::Scalar) -> Result<TimeStep<L>, Error> {
        self.bodies.passes(from);
        let middle = self.drift(from, end - from.t)?;
        let (swept, after) = self.kick(&middle)?;
        let q = middle.state.q.plus(&after.each(|v| v * middle.lengths[1]));
        let mut state = StateOf::<L> { t: end, q, v: after };
        self.take_impulses(&middle);
        self.correct(&mut state, &middle.touching)?;
        check_finite::<L>(&state)?;
        Ok(TimeStep { state, impulses: self.impulses, iterations: swept.0, residual: swept.1 })
    }

    /// Impulses and the velocities after them. Newton's restitution with friction may give energy, as at an impact of a rod: it is
    /// then reduced until it takes some, for all contacts of the step alike, as in a motion from impact to impact.
    fn kick(&mut self, middle: &Middle<L>) -> Result<Kicked<L>, Error> {
        let [zero, one] = [0.0, 1.0].map(L::Scalar::constant);
        self.returned = one;
        let kicked = self.kick_once(middle)?;
        if !self.gains(middle, &kicked.1) {
            return Ok(kicked);
        }
        let (mut low, mut high) = (zero, one);
        for _ in 0..HALVINGS {
            self.returned = (low + high) * L::Scalar::constant(0.5);
            let (_, after) = self.kick_once(middle)?;
            *if self.gains(middle, &after) { &mut high } else { &mut low } = self.returned;
        }
        self.returned = low;
        self.kick_once(middle)
    }

    /// Impulses with the restitution as it is. Contacts whose gaps would be negative at the end of the step join in.
    fn kick_once(&mut self, middle: &Middle<L>) -> Result<Kicked<L>, Error> {
        self.begin(middle)?;
        loop {
            let swept = self.sweep(middle.state.t)?;
            let after = self.kicked(middle);
            if !self.activate(middle, |k| would_close(k, middle, &after))? {
                return Ok((swept, after));
            }
        }
    }

    /// Whether the impulses of contacts that bounce give energy, p (u⁻ + u⁺)/2 in all, by more than their tolerance.
    fn gains(&self, middle: &Middle<L>, after: &Vector<L::Scalar, L::N>) -> bool {
        if !self.bounces {
            return false;
        }
        let (mut given, mut size) = (L::Scalar::constant(0.0), L::Scalar::constant(0.0));
        for (&row, &push) in self.rows.iter().zip(self.cones.impulses()) {
            let (before, after) = (middle.rates[row], rate_after(row, middle, after));
            given += push * (before + after);
            size += Scalar::abs(push) * (Scalar::abs(before) + Scalar::abs(after));
        }
        given > L::Scalar::constant(self.settings.tolerance) * size
    }

    /// Drifts to where forces and gaps are evaluated. Forces that depend on velocities have those at half of the step.
    fn drift(&self, from: &StateOf<L>, step: L::Scalar) -> Result<Middle<L>, Error> {
        let Bodies { open, closed, .. } = &self.bodies;
        let second = step * L::Scalar::constant(self.settings.theta);
        let first = step - second;
        let q = from.q.plus(&from.v.each(|v| v * first));
        let state = StateOf::<L> { t: from.t + first, q, v: from.v };
        let gaps = closed.constraint_residual(&state);
        if let Some(&row) = L::CONTACTS.iter().find(|&&row| !gaps[row].is_finite()) {
            return Err(Error::EquationsNotFinite {
                row: Row::Constraint(L::CONSTRAINTS[row]),
                time: state.t.to_f64(),
            });
        }
        let (factor, off) = (open.factor(&state), open.constraint_rate(&state));
        let change = |forcing: Vector<L::Scalar, L::N>, length: L::Scalar| {
            self.solved((&state, &factor), (forcing.each(|h| h * length), off))
        };
        let half = change(open.forcing(&state), step * L::Scalar::constant(0.5))?;
        let halfway = StateOf::<L> { v: state.v.plus(&half.accelerations), ..state };
        let free = change(open.forcing(&halfway), step)?;
        let (jacobian, rates) = (closed.constraint_jacobian(&state), closed.constraint_rate(&state));
        let touching =
            touching::<L>([&state, &self.bodies.sizes(&state)], &jacobian, &rates, &free.accelerations, step);
        Ok(Middle { state, factor, jacobian, gaps, rates, free, touching, lengths: [step, second] })
    }

    /// Solves with a factorization of the equations with all contacts open.
    fn solved(
        &self,
        (state, factor): (&StateOf<L>, &L::Factor),
        (forcing, bias): (Vector<L::Scalar, L::N>, Vector<L::Scalar, L::M>),
    ) -> Result<SolutionOf<L>, Error> {
        let open = &self.bodies.open;
        let fast = open.solve_with(factor, &forcing, &bias);
        if is_trustworthy(&fast) {
            return Ok(fast);
        }
        let all = Array::filled(true);
        Ok(solve_in_general(open, state, (forcing, bias), &all, Rank::on_constraints())?.0)
    }

    /// Begins the problem of a step with dry friction, and the contacts whose gaps are closed.
    fn begin(&mut self, middle: &Middle<L>) -> Result<(), Error> {
        self.cones.clear();
        self.rows.clear();
        self.responses.clear();
        self.acts.fill(false);
        self.bounces = false;
        for f in (0..L::FRICTIONS.len()).filter(|&f| L::FRICTIONS[f].contact.is_none()) {
            self.add_friction(f, None, middle)?;
        }
        self.activate(middle, |k| middle.gaps[L::CONTACTS[k]] <= middle.touching[L::CONTACTS[k]])?;
        Ok(())
    }

    /// Adds the contacts to which this applies. Returns whether there are any.
    fn activate(&mut self, middle: &Middle<L>, applies: impl Fn(usize) -> bool) -> Result<bool, Error> {
        let mut any = false;
        for (k, &row) in L::CONTACTS.iter().enumerate() {
            if self.acts[k] || !applies(k) {
                continue;
            }
            (self.acts[k], any) = (true, true);
            let least = self.least_rate(k, middle)?;
            self.bounces |= least > L::Scalar::constant(0.0);
            let press = self.add_row(row, -least, middle)?;
            self.cones.push_block(1, Cone::Push);
            for f in (0..L::FRICTIONS.len()).filter(|&f| L::FRICTIONS[f].contact == Some(k)) {
                self.add_friction(f, Some(press), middle)?;
            }
        }
        Ok(any)
    }

    /// Smallest rate that the law allows a gap after the step: Newton's −e v; or, for plastic impacts and contacts that rest, the
    /// rate at which it closes exactly. A contact rests if it is approached no faster than the free bodies gain in a step.
    fn least_rate(&self, k: usize, middle: &Middle<L>) -> Result<L::Scalar, Error> {
        let (row, zero) = (L::CONTACTS[k], L::Scalar::constant(0.0));
        let restitution = self.returned * self.bodies.restitution(k, &middle.state)?;
        let approach = larger(-middle.rates[row], zero);
        let gained = (0..<L::N>::COUNT)
            .fold(zero, |sum, i| sum + middle.jacobian[(row, i)] * middle.free.accelerations[i]);
        let rests = approach <= Scalar::abs(gained) || restitution == zero;
        Ok(if rests { -larger(middle.gaps[row], zero) / middle.lengths[1] } else { restitution * approach })
    }

    /// Adds a row whose rate shall be zero or more with this added. Returns its place.
    fn add_row(&mut self, row: usize, added: L::Scalar, middle: &Middle<L>) -> Result<usize, Error> {
        let none = zeros();
        let of_row = vector(Array::from_fn(|i| middle.jacobian[(row, i)]));
        let response = self.solved((&middle.state, &middle.factor), (of_row, none))?;
        let place = self.rows.len();
        self.rows.push(row);
        self.responses.push(response);
        self.entries.clear();
        self.entries
            .extend(of_row.iter().copied().enumerate().filter(|(_, w)| *w != L::Scalar::constant(0.0)));
        let (entries, responses) = (&self.entries, &self.responses);
        let along = |change: &Vector<L::Scalar, L::N>| {
            entries.iter().fold(L::Scalar::constant(0.0), |sum, &(i, w)| sum + w * change[i])
        };
        let rate = middle.rates[row] + along(&middle.free.accelerations) + added;
        self.cones.push_row(rate, self.impulses[row], |other| along(&responses[other].accelerations));
        Ok(place)
    }

    /// Adds a friction. One that sticks has the limit, one that slides the sliding force.
    fn add_friction(&mut self, f: usize, press: Option<usize>, middle: &Middle<L>) -> Result<(), Error> {
        let FrictionRows { row, count, .. } = L::FRICTIONS[f];
        let [limit, sliding] = bounds(&self.bodies.closed, f, &middle.state)?;
        let bound = if self.sticks[f] { limit } else { sliding };
        for row in row..row + count {
            self.add_row(row, L::Scalar::constant(0.0), middle)?;
        }
        let radius = if press.is_some() { bound } else { bound * middle.lengths[0] };
        self.cones.push_block(count, Cone::Disc { radius, press });
        Ok(())
    }

    /// Finds the impulses, and returns the number of sweeps and the residual.
    fn sweep(&mut self, time: L::Scalar) -> Result<(usize, L::Scalar), Error> {
        let MoreauJean { tolerance, max_iterations, .. } = self.settings;
        let tolerance = L::Scalar::constant(tolerance);
        let Swept { iterations, residual } = self.cones.solve(tolerance, max_iterations);
        if residual <= tolerance {
            return Ok((iterations, residual));
        }
        let (residual, time) = (residual.to_f64(), time.to_f64());
        Err(Error::ImpulsesNotFound { residual, iterations, time })
    }

    /// Velocities after the impulses.
    fn kicked(&self, middle: &Middle<L>) -> Vector<L::Scalar, L::N> {
        let kick = |i: usize| {
            let pushes = self.cones.impulses().iter().zip(&self.responses);
            pushes
                .fold(middle.free.accelerations[i], |sum, (&p, response)| sum + p * response.accelerations[i])
        };
        vector(Array::from_fn(|i| middle.state.v[i] + kick(i)))
    }

    /// Takes note of the impulses of a step, and of what sticks.
    fn take_impulses(&mut self, middle: &Middle<L>) {
        let pushes = || self.cones.impulses().iter().zip(&self.responses);
        self.impulses = vector(Array::from_fn(|a| {
            pushes().fold(middle.free.multipliers[a], |sum, (&p, response)| sum + p * response.multipliers[a])
        }));
        for row in L::CONTACTS {
            self.impulses[*row] = L::Scalar::constant(0.0);
        }
        for row in L::FRICTIONS.iter().flat_map(FrictionRows::rows) {
            self.impulses[row] = L::Scalar::constant(0.0);
        }
        for (&row, &impulse) in self.rows.iter().zip(self.cones.impulses()) {
            self.impulses[row] = impulse;
        }
        for (f, friction) in L::FRICTIONS.iter().enumerate() {
            let size = friction.size(|a| self.impulses[a]);
            let place = self.rows.iter().position(|&other| other == friction.row);
            let radius = place.and_then(|place| self.cones.radius(place));
            self.sticks[f] = radius.is_some_and(|radius| size < L::Scalar::constant(WITHIN) * radius);
        }
    }

    /// Moves a state to where no gap is negative and the constraints hold, by Gauss–Newton steps in the metric of the
    /// mass matrix. Velocities stay.
    fn correct(&mut self, state: &mut StateOf<L>, touching: &Array<L::Scalar, L::M>) -> Result<(), Error> {
        for _ in 0..CORRECTIONS {
            if self.violation(state, touching).is_none() {
                return Ok(());
            }
            self.correct_once(state, touching)?;
        }
        self.violation(state, touching).map_or(Ok(()), Err)
    }

    /// The first gap that is negative, or constraint that does not hold.
    fn violation(&self, state: &StateOf<L>, touching: &Array<L::Scalar, L::M>) -> Option<Error> {
        let Bodies { open, closed, .. } = &self.bodies;
        let (gaps, residual, time) =
            (closed.constraint_residual(state), open.constraint_residual(state), state.t.to_f64());
        let closed = L::CONTACTS.iter().find(|&&row| gaps[row] < -touching[row]);
        if let Some(&row) = closed {
            let contact = name(L::CONSTRAINTS, row);
            return Some(Error::Penetration { contact, gap: gaps[row].to_f64(), time });
        }
        let off = (0..<L::M>::COUNT).find(|&a| Scalar::abs(residual[a]) > touching[a])?;
        let (constraint, residual) = (name(L::CONSTRAINTS, off), residual[off].to_f64());
        Some(Error::NotProjected { constraint, residual, iterations: CORRECTIONS, time })
    }

    fn correct_once(
        &mut self,
        state: &mut StateOf<L>,
        touching: &Array<L::Scalar, L::M>,
    ) -> Result<(), Error> {
        let (factor, jacobian) =
            (self.bodies.open.factor(state), self.bodies.closed.constraint_jacobian(state));
        let gaps = self.bodies.closed.constraint_residual(state);
        let none = zeros();
        let mut change =
            self.solved((state, &factor), (none, self.bodies.open.constraint_residual(state)))?.accelerations;
        self.cones.clear();
        self.responses.clear();
        for (k, &row) in L::CONTACTS.iter().enumerate() {
            if !self.acts[k] && gaps[row] > touching[row] {
                continue;
            }
            let of_row = vector(Array::from_fn(|i| jacobian[(row, i)]));
            let none = zeros();
            self.responses.push(self.solved((state, &factor), (of_row, none))?);
            let responses = &self.responses;
            let gap = gaps[row] + of_row.dot(&change);
            self.cones
                .push_row(gap, L::Scalar::constant(0.0), |other| of_row.dot(&responses[other].accelerations));
            self.cones.push_block(1, Cone::Push);
        }
        self.sweep(state.t)?;
        for (&push, response) in self.cones.impulses().iter().zip(&self.responses) {
            change = change.plus(&response.accelerations.each(|x| x * push));
        }
        state.q = state.q.plus(&change);
        Ok(())
    }
}

/// Whether the gap of a contact would be negative at the end of the step.
fn would_close<L: Contacts<Scalar: Real>>(
    k: usize,
    middle: &Middle<L>,
    after: &Vector<L::Scalar, L::N>,
) -> bool {
    let row = L::CONTACTS[k];
    let zero = L::Scalar::constant(0.0);
    // Rates have a part that does not depend on velocities, if walls move.
    let rate = (0..<L::N>::COUNT)
        .fold(middle.rates[row], |sum, i| sum + middle.jacobian[(row, i)] * (after[i] - middle.state.v[i]));
    rate < zero && middle.gaps[row] + rate * middle.lengths[1] < -middle.touching[row]
}

/// Rate of a row with the velocities after the impulses. It has a part that does not depend on them if walls move.
fn rate_after<L: Contacts<Scalar: Real>>(
    row: usize,
    middle: &Middle<L>,
    after: &Vector<L::Scalar, L::N>,
) -> L::Scalar {
    (0..<L::N>::COUNT)
        .fold(middle.rates[row], |sum, i| sum + middle.jacobian[(row, i)] * (after[i] - middle.state.v[i]))
}

/// Gaps and residuals that count as zero: round-off, and a small part of what the free bodies move in a step.
fn touching<L: Contacts<Scalar: Real>>(
    [state, largest]: [&StateOf<L>; 2],
    jacobian: &Matrix<L::Scalar, L::M, L::N>,
    rates: &Vector<L::Scalar, L::M>,
    gained: &Vector<L::Scalar, L::N>,
    step: L::Scalar,
) -> Array<L::Scalar, L::M> {
    let [unit, part] = [L::Scalar::EPSILON * UNITS, TOUCHING].map(L::Scalar::constant);
    let zero = L::Scalar::constant(0.0);
    Array::from_fn(|a| {
        let (mut sizes, mut moved, mut of_bodies) = (zero, zero, zero);
        for i in 0..<L::N>::COUNT {
            let w = jacobian[(a, i)];
            sizes += Scalar::abs(w) * largest.q[i];
            moved += Scalar::abs(w * gained[i]);
            of_bodies += w * state.v[i];
        }
        let in_time = (Scalar::abs(rates[a]) + Scalar::abs(rates[a] - of_bodies)) * Scalar::abs(state.t);
        unit * (sizes + in_time) + part * step * moved
    })
}

/// Checks that a step ends at a state of numbers.
fn check_finite<L: Contacts<Scalar: Real>>(state: &StateOf<L>) -> Result<(), Error> {
    let is_finite = |i: usize| state.q[i].is_finite() && state.v[i].is_finite();
    match (0..<L::N>::COUNT).find(|&i| !is_finite(i)) {
        None => Ok(()),
        Some(i) => {
            Err(Error::EquationsNotFinite { row: Row::Coordinate(L::COORDINATES[i]), time: state.t.to_f64() })
        }
    }
}
