//! One step: the bodies drift, impulses change their velocities, they drift on, and gaps that are left negative are closed.

use alloc::vec;
use alloc::vec::Vec;
use core::mem::{discriminant, replace, take};

use nalgebra::ComplexField;

use super::MoreauJean;
use super::acceleration::Acceleration;
use super::middle::Middle;
use super::time_step::TimeStep;
use crate::cone::{ConeSearch, Face};
use crate::contact::across::bodies::Bodies;
use crate::contact::across::friction::bounds;
use crate::contact::across::impact::{StagedFriction, StagedImpact};
use crate::contact::across::reactions::Reactions;
use crate::contact::across::rows::TouchingRows;
use crate::contact::{Contacts, ForceDerivatives, FrictionRows};
use crate::error::{Error, Row};
use crate::number::limits::CANCELLED;
use crate::number::{Real, Scalar};
use crate::numerics::bare::{dot, sqrt};
use crate::system::StateOf;
use crate::vector::{Array, Entrywise, StaticLength, Vector, vector};

/// What is kept from step to step.
pub(super) struct Steps<L: Contacts<Scalar: Real>> {
    pub(super) bodies: Bodies<L>,
    pub(super) settings: MoreauJean,
    /// Face of each constraint in the last step, with which the next one begins; those of open contacts stick.
    faces: Vec<Face>,
    /// Friction that did not reach its limit in the last step.
    sticks: Vec<bool>,
    /// Length of the longest step.
    longest: f64,
    /// True if parameters have been changed since the last step.
    pub(super) is_changed: bool,
}

/// What a friction may take in a step: its limit, or the force of sliding where that is less.
#[derive(Clone, Copy, PartialEq)]
enum Hold {
    /// The limit: it stuck in the step before.
    Limit,
    /// The force of sliding.
    Sliding,
    /// The limit, if it sticks with that: it was at rest, or stops in this step.
    Trial,
    /// The force of sliding: its limit does not stop it.
    SlidingBack,
}

/// What impulses do within a step.
struct Kicked {
    /// Change of the velocities, in coordinates of kinetic energy.
    change: Vec<f64>,
    /// Impulse of each constraint.
    impulses: Vec<f64>,
    /// By what the law of contacts is off, or the balance of momentum if that is more.
    residual: f64,
}

impl<L: ForceDerivatives<Scalar: Real> + Clone> Steps<L> {
    pub(super) fn new(bodies: Bodies<L>, settings: MoreauJean, state: &StateOf<L>) -> Self {
        let (rates, sizes) = (bodies.closed.constraint_rate(state), bodies.closed.rate_magnitude(state));
        let unit = L::Scalar::constant(L::Scalar::EPSILON * CANCELLED);
        let is_still = |a: usize| Scalar::abs(rates[a]) <= unit * sizes[a];
        let sticks = |friction: &FrictionRows| friction.rows().all(is_still);
        let sticks = L::FRICTIONS.iter().map(sticks).collect();
        let faces = vec![Face::Stick; <L::M>::COUNT];
        Self { bodies, settings, faces, sticks, longest: settings.step, is_changed: false }
    }

    /// Takes a step from a state to the time `end`.
    pub(super) fn step(&mut self, from: &StateOf<L>, end: L::Scalar) -> Result<TimeStep<L>, Error> {
        self.bodies.passes(from);
        let mut middle = Middle::of(&self.bodies, from, end - from.t, self.settings.theta)?;
        if take(&mut self.is_changed) {
            middle.crossed(from, self.longest).map_or(Ok(()), Err)?;
        }
        self.longest = self.longest.max(middle.lengths[0]);
        let pull = middle.pull(&self.bodies, &from.v);
        check_finite::<L>(|i| pull[i].is_finite(), from.t)?;
        let (Kicked { change, impulses, residual }, iterations) =
            self.balance(&mut middle, pull, from.t.to_f64())?;
        let (impulses, residual) =
            (vector(Array::from_fn(|a| L::Scalar::constant(impulses[a]))), L::Scalar::constant(residual));
        let state = self.drift_on(&middle, middle.velocities(&change), end)?;
        self.take_sticking(&middle);
        let means = TimeStep::<L>::means([from, &state], &impulses);
        Ok(TimeStep { state, impulses, iterations, residual, means })
    }

    /// Iterates over forces and impulses until they balance the change of the momenta in a step from this time. A contact whose gap would be
    /// negative in the middle of the next step is added. Returns the impulses and the number of iterations.
    fn balance(
        &mut self,
        middle: &mut Middle<L>,
        mut pull: Vec<f64>,
        time: f64,
    ) -> Result<(Kicked, usize), Error> {
        let (mut holds, mut acceleration) = (self.holds(middle)?, Acceleration::default());
        let (mut about, mut residual, mut iterations) = (vec![0.0; <L::N>::COUNT], 0.0, 0);
        while iterations < self.settings.max_iterations && f64::is_finite(residual) {
            let before: Vec<_> = self.faces.iter().map(discriminant).collect();
            let kicked = self.kick(middle, &mut holds, &about, &pull)?;
            let after = middle.velocities(&kicked.change);
            let left = middle.pull(&self.bodies, &after);
            residual = middle.residual(&left, &after, &kicked.impulses);
            let is_balanced = residual <= self.settings.tolerance;
            if is_balanced && !middle.joins(&after) {
                let residual = residual.max(kicked.residual);
                return Ok((Kicked { residual, ..kicked }, iterations + 1));
            }
            if is_balanced || !self.faces.iter().map(discriminant).eq(before) {
                acceleration = Acceleration::default();
            }
            if !is_balanced {
                iterations += 1;
                about = acceleration.next(about, &kicked.change);
                pull = middle.pull(&self.bodies, &middle.velocities(&about));
            }
        }
        Err(Error::StepTooLong { residual, iterations, time })
    }

    /// The end of a step, where no gap is negative and the constraints hold.
    fn drift_on(
        &self,
        middle: &Middle<L>,
        after: Vector<L::Scalar, L::N>,
        end: L::Scalar,
    ) -> Result<StateOf<L>, Error> {
        let second = L::Scalar::constant(middle.lengths[1]);
        let q = middle.state.q.plus(&after.each(|v| v * second));
        let mut state = StateOf::<L> { t: end, q, v: after };
        middle.correct(&self.bodies, &mut state)?;
        check_finite::<L>(|i| state.q[i].is_finite() && state.v[i].is_finite(), end)?;
        Ok(state)
    }

    /// Impulses of the contacts that act, with forces that are linear in the velocities about those after this change, where the balance of
    /// momentum lacks `pull`.
    fn kick(
        &mut self,
        middle: &Middle<L>,
        holds: &mut [Hold],
        about: &[f64],
        pull: &[f64],
    ) -> Result<Kicked, Error> {
        let own = middle.free_change(pull);
        let add = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x + y).collect::<Vec<f64>>();
        let (free, rows) = (add(&own, about), middle.rows());
        let found = self.decide(middle, &rows, holds, &free)?;
        let (change, step) = (add(&found.change, &free), add(&found.change, &own));
        self.faces.fill(Face::Stick);
        let mut impulses = vec![0.0; <L::M>::COUNT];
        for (place, &a) in rows.all.iter().enumerate() {
            self.faces[a] = found.faces[place];
            impulses[a] = found.forces[place] - middle.inertia.along[a] * rows.along(place, &step);
        }
        Ok(Kicked { change, impulses, residual: found.residual })
    }

    /// Takes note of the friction that sticks at the end of a step.
    fn take_sticking(&mut self, middle: &Middle<L>) {
        for (sticks, friction) in self.sticks.iter_mut().zip(L::FRICTIONS) {
            let acts = friction.contact.is_none_or(|k| middle.acts(k));
            *sticks = acts && self.faces[friction.row] == Face::Stick;
        }
    }

    /// What each friction may take in a step.
    fn holds(&self, middle: &Middle<L>) -> Result<Vec<Hold>, Error> {
        let of = |(f, &sticks): (usize, &bool)| {
            let [limit, sliding] = bounds(&self.bodies.closed, f, &middle.state)?.map(Real::to_f64);
            let is_still = L::FRICTIONS[f].rows().all(|a| middle.rates[a].abs() <= middle.noise[a]);
            Ok(match sticks || limit == sliding {
                true => Hold::Limit,
                false if is_still => Hold::Trial,
                false => Hold::Sliding,
            })
        };
        self.sticks.iter().enumerate().map(of).collect()
    }

    /// Impulses of a step. Friction whose velocity they reverse stops if its limit allows it, and slides back else.
    fn decide(
        &self,
        middle: &Middle<L>,
        rows: &TouchingRows<L>,
        holds: &mut [Hold],
        free: &[f64],
    ) -> Result<Reactions, Error> {
        loop {
            let staged = self.staged(middle, rows, holds, free)?;
            let found = staged.without_gain();
            let found =
                found.map_err(|why| match self.bodies.jams(why, (rows, &staged.plays), &middle.state) {
                    Error::FrictionUndecided { friction, time } => Error::ImpulsesNotFound { friction, time },
                    error => error,
                })?;
            let mut is_decided = true;
            for &(f, place) in &rows.frictions {
                let places = place..place + L::FRICTIONS[f].count;
                let along: f64 = places.map(|place| staged.before[place] * found.rates[place]).sum();
                let next = match (holds[f], found.faces[place]) {
                    (Hold::Sliding, Face::Slide(_)) if along < 0.0 => Hold::Trial,
                    (Hold::Trial, Face::Slide(_)) => Hold::SlidingBack,
                    (hold, _) => hold,
                };
                is_decided &= next == replace(&mut holds[f], next);
            }
            if is_decided {
                return Ok(found);
            }
        }
    }

    /// The problem of a step: contacts open at a least rate, and friction has the limit or the sliding force.
    fn staged<'a>(
        &'a self,
        middle: &Middle<L>,
        rows: &'a TouchingRows<L>,
        holds: &[Hold],
        free: &[f64],
    ) -> Result<StagedImpact<'a, L>, Error> {
        let of = |values: &[f64]| rows.all.iter().map(|&a| values[a]).collect::<Vec<f64>>();
        let (before, mut rates, mut noise) = (of(&middle.rates), of(&middle.rates), of(&middle.noise));
        let speed = sqrt(dot(free, free));
        for place in 0..rows.all.len() {
            rates[place] += rows.along(place, free);
            noise[place] += f64::EPSILON * rows.length(place) * speed;
        }
        let mut returned = vec![0.0; rows.all.len()];
        for (place, &k) in rows.touching.iter().enumerate() {
            match self.bounce(k, middle)? {
                Some(bounce) => returned[place] = -bounce,
                None => rates[place] -= middle.closing(L::CONTACTS[k]),
            }
        }
        let mut frictions = Vec::new();
        for &(f, place) in &rows.frictions {
            let FrictionRows { count, contact, .. } = L::FRICTIONS[f];
            let [limit, sliding] = bounds(&self.bodies.closed, f, &middle.state)?;
            let bound = if matches!(holds[f], Hold::Limit | Hold::Trial) { limit } else { sliding }.to_f64();
            let limit = if contact.is_some() { bound } else { bound * middle.lengths[0] };
            let gap = contact.and_then(|k| rows.gap(k));
            frictions.push(StagedFriction { places: place..place + count, gap, limit });
        }
        let (plays, expansion) = (vec![true; rows.touching.len()], vec![]);
        let search = ConeSearch::Near { faces: &self.faces, tolerance: self.settings.tolerance };
        Ok(StagedImpact { rows, before, rates, noise, plays, frictions, returned, expansion, search })
    }

    /// The rate at which a gap opens after the step if it bounces, Newton's e v. It closes without a bounce if it has no restitution, or is
    /// approached no faster than the free bodies gain in a step.
    fn bounce(&self, k: usize, middle: &Middle<L>) -> Result<Option<f64>, Error> {
        let row = L::CONTACTS[k];
        let restitution = self.bodies.restitution(k, &middle.state)?.to_f64();
        let approach = (-middle.rates[row]).max(0.0);
        let rests = approach <= middle.jacobian.along(row, &middle.gained).abs() || restitution == 0.0;
        Ok((!rests).then_some(restitution * approach))
    }
}

/// Fails by the name of the first coordinate whose equation is not finite at this time.
fn check_finite<L: Contacts<Scalar: Real>>(
    is_finite: impl Fn(usize) -> bool,
    time: L::Scalar,
) -> Result<(), Error> {
    let wrong = (0..<L::N>::COUNT).find(|&i| !is_finite(i));
    wrong.map_or(Ok(()), |i| {
        let row = Row::Coordinate(L::COORDINATES[i]);
        Err(Error::EquationsNotFinite { row, time: time.to_f64() })
    })
}
