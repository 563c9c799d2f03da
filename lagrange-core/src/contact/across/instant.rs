//! What happens at one instant: which contacts hit, which of them close, and which open.

use alloc::vec::Vec;

use super::Contacts;
use super::Transition;
use super::bodies::{Bodies, Measured};
use super::grip::{Decision, Gripped};
use super::limits::{BOUNCE, STOPPED, TRANSITIONS};
use super::rows::TouchingRows;
use super::states::LegStates;
use crate::error::Error;
use crate::names::name;
use crate::number::limits::ITERATIONS;
use crate::number::{Real, Scalar};
use crate::system::StateOf;
use crate::vector::Entrywise;

/// What ends a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LegEnd {
    /// The gap of this contact has just become zero.
    Closes(usize),
    /// The multiplier of this contact has just become zero.
    Opens(usize),
    /// Friction has just reached its limit.
    Leaves,
    /// The velocity of this friction has just become zero.
    Stops(usize),
    /// The velocity of a friction has turned.
    Turns,
}

/// Contacts and friction after an instant.
pub(super) struct Decided<T> {
    pub(super) states: LegStates,
    /// Time within which the next bounce ends, if one begins.
    pub(super) bounce: Option<T>,
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    /// Contacts that are closed, or whose gaps are zero.
    fn all_touching(&self, was: &LegStates, end: Option<LegEnd>, state: &StateOf<L>) -> Vec<usize> {
        let is_touching = |k: usize| {
            was.is_closed(k)
                || end == Some(LegEnd::Closes(k))
                || (end.is_some() && was.contacts[k].is_implied)
                || self.gap(k, state) <= self.touching(k, state)
        };
        (0..L::CONTACTS.len()).filter(|&k| is_touching(k)).collect()
    }

    /// Decides what follows at a state: the velocities after impacts, and which contacts are closed from then on, after they were
    /// in the states `was`, up to the end of a leg if one ends here.
    pub(super) fn settle(
        &mut self,
        state: &mut StateOf<L>,
        (was, mut end): (&LegStates, Option<LegEnd>),
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<Decided<L::Scalar>, Error> {
        let touching = self.all_touching(was, end, state);
        self.check_gradients(&touching, state)?;
        let rows = self.rows(touching, state)?;
        for _ in 0..TRANSITIONS {
            let pressing = self.pressing(&rows, state)?;
            let noise = rows.motion_noise(state);
            let rests = |place: usize| {
                let k = rows.touching[place];
                let is_kept = end.is_some() && was.contacts[k].is_implied;
                is_kept || self.rests(k, [pressing.0[place], noise[place]], state)
            };
            let resting: Vec<bool> = (0..rows.touching.len()).map(rests).collect();
            let approaches = |place: usize| {
                !resting[place] && self.measured(rows.touching[place], state).rate < L::Scalar::constant(0.0)
            };
            if (0..rows.touching.len()).any(approaches) {
                self.impact(&rows, &resting, state, transitions)?;
                end = None;
                continue;
            }
            return self.grip((&rows, &pressing), resting, state, (was, end), transitions);
        }
        Err(Error::ImpactsDoNotEnd { time: state.t.to_f64() })
    }

    /// Decides which of the contacts at rest push, and which friction sticks, and takes what is left of their rates.
    fn grip(
        &self,
        (rows, pressing): (&TouchingRows<L>, &(Vec<f64>, Vec<f64>)),
        mut resting: Vec<bool>,
        state: &mut StateOf<L>,
        (was, end): (&LegStates, Option<LegEnd>),
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<Decided<L::Scalar>, Error> {
        let before = *state;
        for _ in 0..ITERATIONS {
            let mut decision = Decision::new(self, (rows, pressing), resting.clone(), state, (was, end))?;
            let gripped = decision.settle(state)?;
            let states = decision.states(&gripped);
            let bounce = self.bounce((&rows.touching, &decision.resting, &gripped.rates), &before);
            self.halt(rows, (&states, &gripped), state);
            let comes = self.comes_to_rest(rows, pressing, &mut resting, state);
            if comes || self.slides_back(&states, state) {
                continue;
            }
            self.report(&decision.towards(&gripped, &states), &before, (was, &states), transitions)?;
            self.report_friction(was, &states, state, transitions);
            return Ok(Decided { states, bounce });
        }
        let friction = rows.frictions.first().map_or("", |&(f, _)| name(L::CONSTRAINTS, L::FRICTIONS[f].row));
        Err(Error::FrictionUndecided { friction, time: state.t.to_f64() })
    }

    /// Marks gaps that have opened but whose rates went with those of others at rest. Returns whether there are any.
    fn comes_to_rest(
        &self,
        rows: &TouchingRows<L>,
        pressing: &(Vec<f64>, Vec<f64>),
        resting: &mut [bool],
        state: &StateOf<L>,
    ) -> bool {
        let noise = rows.motion_noise(state);
        let mut any = false;
        for (place, rests) in resting.iter_mut().enumerate().filter(|(_, rests)| !**rests) {
            *rests = self.rests(rows.touching[place], [pressing.0[place], noise[place]], state);
            any |= *rests;
        }
        any
    }

    /// Takes the rates, all but zero, of what stays at rest: closed gaps, and friction that sticks. No other gap at rest closes. What begins
    /// to slide along two velocities gets a speed.
    fn halt(
        &self,
        rows: &TouchingRows<L>,
        (states, gripped): (&LegStates, &Gripped),
        state: &mut StateOf<L>,
    ) {
        let (rates, _) = self.measured_rates(rows, state);
        let mut span = rows.span([]);
        for place in rows.active(states) {
            span.add_change(place, -rates[place]);
        }
        let most = STOPPED * rows.speed(&self.sizes(state).v);
        for (place, velocity) in self.starts(rows, (states, gripped), state) {
            span.add_change_within(place, velocity - rates[place], most);
        }
        // A rate that is round-off counts, too: in a slot without room, the gap would close again at once.
        let approaches = |place: &usize| {
            let of = states.contacts[rows.touching[*place]];
            of.is_resting && !of.is_closed
        };
        let mut apart: Vec<usize> = (0..rows.touching.len()).filter(approaches).collect();
        while let Some(at) = apart.iter().position(|&place| rates[place] + span.rate(place) < 0.0) {
            let place = apart.swap_remove(at);
            span.add_change(place, -rates[place]);
        }
        state.v = state.v.plus(&rows.velocities(&span.change));
    }

    /// Time within which the shortest bounce ends: 2 v/a and somewhat more, with the rate v of the gap and its acceleration −a.
    fn bounce(
        &self,
        (touching, resting, accelerations): (&[usize], &[bool], &[f64]),
        state: &StateOf<L>,
    ) -> Option<L::Scalar> {
        let falls = |place: &usize| !resting[*place] && accelerations[*place] < 0.0;
        let time = |place: usize| {
            L::Scalar::constant(-BOUNCE / accelerations[place]) * self.measured(touching[place], state).rate
        };
        (0..touching.len()).filter(falls).map(time).reduce(|one, other| if other < one { other } else { one })
    }

    /// Reports the contacts that close and open.
    fn report(
        &self,
        towards: &[f64],
        state: &StateOf<L>,
        (was, is): (&LegStates, &LegStates),
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<(), Error> {
        let [zero, one, two] = [0.0, 1.0, 2.0].map(L::Scalar::constant);
        for k in (0..L::CONTACTS.len()).filter(|&k| was.is_closed(k) != is.is_closed(k)) {
            let (contact, time, Measured { rate, noise, .. }) =
                (self.name(k), state.t, self.measured(k, state));
            let shrinks = L::Scalar::constant(towards[k]) * (one - self.restitution(k, state)?);
            transitions.push(match is.is_closed(k) {
                true if rate > noise[1] && shrinks > zero => {
                    Transition::Rests { contact, time: time + two * rate / shrinks }
                }
                true => Transition::Closes { contact, time },
                false => Transition::Opens { contact, time },
            });
        }
        Ok(())
    }
}
