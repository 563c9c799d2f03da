//! What happens at one instant to bodies with friction: which contacts push, stick and slide from then on.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::bodies::{Bodies, Delassus, States};
use super::cones::length;
use super::grip::Decision;
use super::instant::{Changed, Decided, IMPACTS, STOPS};
use super::law::{ContactForces, Grip, NoForces, Rubbing, Touch};
use super::trajectory::Transition;
use super::{Contacts, Friction, FrictionRows};
use crate::error::Error;
use crate::names::name;
use crate::number::{Real, Scalar, larger, power_of_epsilon};
use crate::system::StateOf;
use crate::vector::{Array, vector};

/// Speed, in units of its round-off, with which bodies begin to slide along two velocities: friction has no direction at rest.
pub(super) const BEGIN: f64 = 64.0;

impl FrictionRows {
    /// Indices of its velocities among the constraints.
    pub(crate) fn rows(&self) -> Range<usize> {
        self.row..self.row + self.count
    }

    /// Size of a velocity or force with these components.
    pub(crate) fn size<T: Real>(&self, component: impl Fn(usize) -> T) -> T {
        match self.count {
            1 => Scalar::abs(component(self.row)),
            _ => length([component(self.row), component(self.row + 1)]),
        }
    }
}

/// The rows of bodies that touch, at a state.
pub(super) struct TouchingRows<L: Contacts<Scalar: Real>> {
    /// Index of each among the constraints: gaps, then velocities of friction.
    pub(super) all: Vec<usize>,
    /// Contacts that touch, in the order of their rows.
    pub(super) touching: Vec<usize>,
    /// Friction of these, and dry friction, each with the place of its first row.
    pub(super) frictions: Vec<(usize, usize)>,
    pub(super) delassus: Delassus<L>,
}

/// Contact and friction of each touch.
pub(super) type TouchNames = Vec<(Option<usize>, Option<usize>)>;

/// Touches in play, with their names.
type Played<T> = (Vec<Touch<T>>, TouchNames);

/// Limit and sliding force of friction.
pub(super) fn bounds<L: Contacts<Scalar: Real>>(
    system: &L,
    f: usize,
    state: &StateOf<L>,
) -> Result<[L::Scalar; 2], Error> {
    let zero = L::Scalar::constant(0.0);
    let [limit, sliding] = [system.friction_limit(f, state), system.sliding_friction(f, state)]
        .map(|bound| bound.unwrap_or(zero));
    if sliding >= zero && sliding <= limit && limit.to_f64().is_finite() {
        return Ok([limit, sliding]);
    }
    let (friction, time) = (L::CONSTRAINTS[L::FRICTIONS[f].row], state.t.to_f64());
    Err(Error::Friction { friction, bounds: [limit, sliding].map(Real::to_f64), time })
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    /// Does what [`settle`](Self::settle) does, for a system with friction.
    pub(super) fn settle_with_friction(
        &mut self,
        state: &mut StateOf<L>,
        (was, changed): (&States, &Changed),
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<Decided<L::Scalar>, Error> {
        let touching = self.all_touching(&was.is_closed, changed, state);
        self.check_gradients(&touching, state)?;
        let rows = self.rows(touching, state)?;
        let mut changed = changed.clone();
        for _ in 0..IMPACTS {
            let pressing = self.pressing(&rows.all, state)?;
            let noise = self.motion_noise(&rows.delassus.0, state);
            let rests = |place: usize| {
                let k = rows.touching[place];
                changed.is_implied(k) || self.rests(k, (pressing[place][0], noise[place]), state)
            };
            let resting: Vec<bool> = (0..rows.touching.len()).map(rests).collect();
            let approaches = |place: usize| {
                !resting[place] && self.measured(rows.touching[place], state).rate < L::Scalar::constant(0.0)
            };
            if (0..rows.touching.len()).any(approaches) {
                self.impact(&rows, &resting, state, transitions)?;
                (changed.ends_leg, changed.implied) = (false, Vec::new());
                continue;
            }
            return self.grip(&rows, resting, &pressing, state, (was, &changed), transitions);
        }
        Err(Error::ImpactsDoNotEnd { time: state.t.to_f64() })
    }

    /// The rows of these contacts and of all friction that may act with them.
    pub(super) fn rows(&self, touching: Vec<usize>, state: &StateOf<L>) -> Result<TouchingRows<L>, Error> {
        let mut all: Vec<usize> = touching.iter().map(|&k| L::CONTACTS[k]).collect();
        let mut frictions = Vec::new();
        for (f, friction) in L::FRICTIONS.iter().enumerate() {
            if friction.contact.is_none_or(|k| touching.contains(&k)) {
                frictions.push((f, all.len()));
                all.extend(friction.rows());
            }
        }
        let delassus = self.delassus(&all, state)?;
        Ok(TouchingRows { all, touching, frictions, delassus })
    }

    /// Velocity of friction, its size, and the round-off of that.
    fn sliding(&self, f: usize, state: &StateOf<L>) -> ([L::Scalar; 2], [L::Scalar; 2]) {
        let mut velocity = [L::Scalar::constant(0.0); 2];
        let mut noise = velocity[0];
        for (component, a) in L::FRICTIONS[f].rows().enumerate() {
            let measured = self.measured_at(a, state);
            (velocity[component], noise) = (measured.rate, larger(noise, measured.noise[1]));
        }
        (velocity, [length(velocity), noise])
    }

    /// Direction in which bodies slide; `None` if they are at rest but for so many units of round-off.
    pub(super) fn slip(&self, f: usize, state: &StateOf<L>, units: f64) -> Option<[L::Scalar; 2]> {
        let (velocity, [speed, noise]) = self.sliding(f, state);
        (speed > L::Scalar::constant(units) * noise).then(|| velocity.map(|component| component / speed))
    }

    /// Whether bodies are at rest where their velocity along the direction of sliding has become zero. That of one velocity is
    /// the whole; that of two may have turned.
    pub(super) fn is_stopped(&self, f: usize, state: &StateOf<L>) -> bool {
        let (_, [speed, noise]) = self.sliding(f, state);
        L::FRICTIONS[f].count == 1 || speed <= L::Scalar::constant(BEGIN) * noise
    }

    /// The touches of the contacts that `plays` marks, with friction in the states that `grip` gives.
    pub(super) fn touches(
        &self,
        rows: &TouchingRows<L>,
        plays: &[bool],
        state: &StateOf<L>,
        grip: impl Fn(usize) -> Option<Grip<L::Scalar>>,
    ) -> Result<Played<L::Scalar>, Error> {
        let mut touches: Played<L::Scalar> = (Vec::new(), Vec::new());
        for gap in (0..plays.len()).filter(|&place| plays[place]) {
            let least = L::Scalar::constant(0.0);
            touches.0.push(Touch { gap: Some(gap), least, friction: None });
            touches.1.push((Some(rows.touching[gap]), None));
        }
        for &(f, place) in &rows.frictions {
            let (FrictionRows { count, contact, .. }, Some(grip)) = (L::FRICTIONS[f], grip(f)) else {
                continue;
            };
            let friction = Some(Rubbing { place, count, grip, bounds: bounds(&self.closed, f, state)? });
            match contact {
                None => {
                    touches.0.push(Touch { gap: None, least: L::Scalar::constant(0.0), friction });
                    touches.1.push((None, Some(f)));
                }
                Some(_) => {
                    if let Some(k) = touches.1.iter().position(|&(k, _)| k == contact) {
                        (touches.0[k].friction, touches.1[k].1) = (friction, Some(f));
                    }
                }
            }
        }
        Ok(touches)
    }

    /// No forces satisfy the laws of these contacts and frictions.
    pub(super) fn jams(
        &self,
        why: NoForces,
        names: &[(Option<usize>, Option<usize>)],
        state: &StateOf<L>,
    ) -> Error {
        match names.iter().find_map(|(_, friction)| *friction) {
            Some(f) => {
                let (friction, time) = (L::CONSTRAINTS[L::FRICTIONS[f].row], state.t.to_f64());
                match why {
                    NoForces::Jammed => Error::FrictionJams { friction, time },
                    NoForces::Undecided => Error::FrictionUndecided { friction, time },
                }
            }
            None => {
                let contacts: Vec<usize> = names.iter().filter_map(|(contact, _)| *contact).collect();
                self.contradiction(&contacts, state)
            }
        }
    }

    /// Decides which of the contacts at rest push, and which friction sticks, and takes what is left of their rates.
    fn grip(
        &self,
        rows: &TouchingRows<L>,
        resting: Vec<bool>,
        pressing: &[[L::Scalar; 2]],
        state: &mut StateOf<L>,
        (was, changed): (&States, &Changed),
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<Decided<L::Scalar>, Error> {
        let before = *state;
        for _ in 0..STOPS {
            let (decided, towards, forces) =
                self.gripped(rows, resting.clone(), pressing, (&before, state), (was, changed))?;
            self.halt(rows, (&decided, &forces), state);
            if self.slides_back(&decided, state) {
                continue;
            }
            self.report(&towards, &before, (&was.is_closed, &decided.states.is_closed), transitions)?;
            self.report_friction(was, &decided.states, state, transitions);
            return Ok(decided);
        }
        let friction = rows.frictions.first().map_or("", |&(f, _)| name(L::CONSTRAINTS, L::FRICTIONS[f].row));
        Err(Error::FrictionUndecided { friction, time: state.t.to_f64() })
    }

    /// Whether a velocity is against the direction in which it slides: what was left of the rates of contacts at rest has turned it.
    fn slides_back(&self, decided: &Decided<L::Scalar>, state: &StateOf<L>) -> bool {
        (0..L::FRICTIONS.len()).any(|f| {
            let (Friction::Slides(direction), false) =
                (decided.states.frictions[f], decided.slip_is_implied[f])
            else {
                return false;
            };
            let (velocity, [_, noise]) = self.sliding(f, state);
            let along = |c: usize| L::Scalar::constant(direction[c]) * velocity[c];
            along(0) + along(1) < -noise
        })
    }

    /// States, accelerations of closed contacts without their own forces, and forces.
    #[allow(clippy::type_complexity, reason = "what belongs to one decision")]
    fn gripped(
        &self,
        rows: &TouchingRows<L>,
        resting: Vec<bool>,
        pressing: &[[L::Scalar; 2]],
        (before, state): (&StateOf<L>, &StateOf<L>),
        (was, changed): (&States, &Changed),
    ) -> Result<(Decided<L::Scalar>, Vec<L::Scalar>, ContactForces<L::Scalar>), Error> {
        let mut decision = Decision::new(self, (rows, pressing), resting, state, (was, changed));
        let gripped = decision.settle(state)?;
        let Decision { resting, slips, .. } = decision;
        let mut decided = gripped.decided(rows, pressing, &slips);
        let rates = &gripped.forces.rates;
        for place in (0..resting.len()).filter(|&place| !resting[place]) {
            decided.is_resting[rows.touching[place]] = rates[place] >= L::Scalar::constant(0.0);
        }
        if let Some(k) = changed.opens {
            decided.is_resting[k] = true;
        }
        decided.bounce = self.bounce((&rows.touching, &resting, rates), before);
        let mut towards = vec![L::Scalar::constant(0.0); L::CONTACTS.len()];
        for (place, &k) in rows.touching.iter().enumerate() {
            towards[k] = rows.delassus.0[place][place] * gripped.forces.forces[place];
        }
        Ok((decided, towards, gripped.forces))
    }

    /// Takes the rates, all but zero, of what stays at rest, and gives those that begin to slide along two velocities a speed.
    fn halt(
        &self,
        rows: &TouchingRows<L>,
        (decided, outcome): (&Decided<L::Scalar>, &ContactForces<L::Scalar>),
        state: &mut StateOf<L>,
    ) {
        let mut problem = rows.problem();
        let mut active = rows.active(&decided.states);
        problem.constant = rows.all.iter().map(|&a| self.measured_at(a, state).rate).collect();
        for (row, velocity) in self.starts(rows, (decided, outcome), state) {
            problem.constant[row] -= velocity;
            if !problem.depends(row, &active) {
                active.push(row);
            }
        }
        for (&impulse, response) in problem.equality(&active).iter().zip(&rows.delassus.1) {
            state.v = vector(Array::from_fn(|i| state.v[i] + response[i] * impulse));
        }
    }

    /// Velocities with which bodies begin to slide along two: a multiple of their accelerations, as those of one body go
    /// together; along the directions of the forces where these have only reached their limits.
    fn starts(
        &self,
        rows: &TouchingRows<L>,
        (decided, outcome): (&Decided<L::Scalar>, &ContactForces<L::Scalar>),
        state: &StateOf<L>,
    ) -> Vec<(usize, L::Scalar)> {
        let least = power_of_epsilon::<L::Scalar>(0.5);
        let motion = outcome.motion.as_ref().unwrap_or(&outcome.rates);
        let mut starts = Vec::new();
        let mut time = Some(L::Scalar::constant(0.0));
        for &(f, place) in &rows.frictions {
            let Friction::Slides(direction) = decided.states.frictions[f] else { continue };
            let rests = decided.slips_from_rest[f] && !decided.slip_is_implied[f];
            if !rests || L::FRICTIONS[f].count != 2 || direction == [0.0; 2] {
                continue;
            }
            let both = [place, place + 1];
            let changes = both.map(|row| Scalar::abs(rows.delassus.0[row][row] * outcome.forces[row]));
            let speed = self.start(both.map(|row| rows.all[row]), changes, state);
            let acceleration = length(both.map(|row| motion[row]));
            let is_known = outcome.motion.is_some() || acceleration > least * larger(changes[0], changes[1]);
            time = time.filter(|_| is_known).map(|time| larger(time, speed / acceleration));
            starts.extend(both.into_iter().zip(direction.map(|part| speed * L::Scalar::constant(part))));
        }
        if let Some(time) = time {
            starts.iter_mut().for_each(|(row, velocity)| *velocity = motion[*row] * time);
        }
        starts
    }

    /// Speed with which bodies begin to slide: round-off of it, and what the force of friction changes it within the round-off
    /// of the time.
    fn start(&self, rows: [usize; 2], changes: [L::Scalar; 2], state: &StateOf<L>) -> L::Scalar {
        let unit = L::Scalar::constant(L::Scalar::EPSILON) * larger(Scalar::abs(state.t), self.span);
        let [x, y] = rows.map(|a| self.measured_at(a, state).noise[1]);
        L::Scalar::constant(BEGIN) * (larger(x, y) + unit * larger(changes[0], changes[1]))
    }

    /// Reports the friction that begins to stick or to slide, or slides back, while its contact stays closed.
    fn report_friction(
        &self,
        was: &States,
        is: &States,
        state: &StateOf<L>,
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) {
        // At the start of a motion there are none before.
        for (f, FrictionRows { row, count, contact, .. }) in
            L::FRICTIONS.iter().enumerate().take(was.frictions.len())
        {
            let (friction, time) = (L::CONSTRAINTS[*row], state.t);
            let is_pressed = contact.is_none_or(|k| is.is_closed[k]);
            let was_pressed = contact.is_none_or(|k| was.is_closed[k]);
            if !is_pressed || !was_pressed {
                continue;
            }
            match (was.frictions[f], is.frictions[f]) {
                // It has had no force.
                (Friction::Slides([0.0, 0.0]), is) if is.is_at_rest() => {}
                (Friction::Slides(_), is) if is.is_at_rest() => {
                    transitions.push(Transition::Sticks { friction, time });
                }
                (was, Friction::Slides(_)) if was.is_at_rest() => {
                    transitions.push(Transition::Slips { friction, time });
                }
                (Friction::Slides([was, _]), Friction::Slides([is, _])) if *count == 1 && was * is < 0.0 => {
                    transitions.push(Transition::Reverses { friction, time });
                }
                _ => {}
            }
        }
    }
}
