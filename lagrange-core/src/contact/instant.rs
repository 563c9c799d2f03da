//! What happens at one instant: which contacts hit, which of them close, and which open.

use alloc::vec;
use alloc::vec::Vec;

use super::bodies::{Bodies, Delassus, Measured, States};
use super::complementarity::{Complementarity, ComplementarySolution};
use super::trajectory::Transition;
use super::{Contacts, Friction};
use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::system::StateOf;
use crate::vector::{Array, Vector, vector};

/// Largest number of impacts at one time. Each takes energy, or passes it on to the next of bodies in a row. A light ball that two heavy
/// ones hit in turn takes thousands, until its rates are round-off.
pub(super) const IMPACTS: usize = 100_000;

/// Largest number of rounds that stop contacts which approach at rest.
pub(super) const STOPS: usize = 8;

/// Time within which a bounce is searched for, in units of v/a: it takes 2. The end is at no simple part of it, where a zero
/// would fall on the division of a step.
const BOUNCE: f64 = 2.7;

/// What brings a motion to an instant at which its contacts are decided.
#[derive(Clone, Default)]
pub(super) struct Changed {
    /// A leg ends here, at the end of which all that stuck in it is at rest.
    pub(super) ends_leg: bool,
    /// Open contacts whose gaps have remained zero in that leg because of the closed ones; empty if there is none.
    pub(super) implied: Vec<bool>,
    /// The gap of this contact has just become zero.
    pub(super) closes: Option<usize>,
    /// The multiplier of this contact has just become zero.
    pub(super) opens: Option<usize>,
    /// Friction that has just reached its limit, and lets the bodies slide in these directions.
    pub(super) slips: Vec<(usize, [f64; 2])>,
    /// The velocity of this friction has just become zero.
    pub(super) stops: Option<usize>,
}

impl Changed {
    /// Whether the gap of this open contact has remained zero in the leg that ends here, since closed contacts hold it there.
    pub(super) fn is_implied(&self, k: usize) -> bool {
        self.implied.get(k) == Some(&true)
    }
}

/// Contacts and friction after an instant.
pub(super) struct Decided<T> {
    pub(super) states: States,
    /// Open contacts whose gaps remain zero because of the closed ones.
    pub(super) is_implied: Vec<bool>,
    /// Contacts whose gaps are zero and do not change: closed ones, and open ones that nothing presses together.
    pub(super) is_resting: Vec<bool>,
    /// Friction whose velocities are zero.
    pub(super) slips_from_rest: Vec<bool>,
    /// Friction that does not stick, but whose velocities remain zero because of what is closed and sticks.
    pub(super) slip_is_implied: Vec<bool>,
    /// Time within which the next bounce ends, if one begins.
    pub(super) bounce: Option<T>,
}

impl<T> Decided<T> {
    /// Nothing that is closed, and friction in these states.
    pub(super) fn none<L: Contacts>(frictions: Vec<Friction>) -> Self {
        let [contacts, of_friction] = [L::CONTACTS.len(), frictions.len()].map(|length| vec![false; length]);
        Self {
            states: States { is_closed: contacts.clone(), frictions },
            is_implied: contacts.clone(),
            is_resting: contacts,
            slips_from_rest: of_friction.clone(),
            slip_is_implied: of_friction,
            bounce: None,
        }
    }
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    /// Contacts that are closed, or whose gaps are zero.
    pub(super) fn all_touching(
        &self,
        was_closed: &[bool],
        changed: &Changed,
        state: &StateOf<L>,
    ) -> Vec<usize> {
        let is_touching = |k: usize| {
            was_closed[k]
                || changed.closes == Some(k)
                || changed.is_implied(k)
                || self.gap(k, state) <= self.touching(k, state)
        };
        (0..L::CONTACTS.len()).filter(|&k| is_touching(k)).collect()
    }

    /// Decides what follows at a state: the velocities after impacts, and which contacts are closed from then on, after they were
    /// in the states `was`.
    pub(super) fn settle(
        &mut self,
        state: &mut StateOf<L>,
        (was, changed): (&States, &Changed),
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<Decided<L::Scalar>, Error> {
        if !L::FRICTIONS.is_empty() {
            return self.settle_with_friction(state, (was, changed), transitions);
        }
        let (was_closed, opens) = (&was.is_closed[..], changed.opens);
        let touching = self.all_touching(was_closed, changed, state);
        self.check_gradients(&touching, state)?;
        let rows = self.rows(touching, state)?;
        let (touching, delassus) = (&rows.touching, &rows.delassus);
        for _ in 0..IMPACTS {
            let pressing = self.pressing(&rows.all, state)?;
            let noise = self.motion_noise(&delassus.0, state);
            let resting: Vec<bool> = (0..touching.len())
                .map(|place| self.rests(touching[place], (pressing[place][0], noise[place]), state))
                .collect();
            let approaches = |place: usize| {
                !resting[place] && self.measured(touching[place], state).rate < L::Scalar::constant(0.0)
            };
            if (0..touching.len()).any(approaches) {
                self.impact(&rows, &resting, state, transitions)?;
                continue;
            }
            return self.close(
                (touching, &resting, &pressing),
                delassus,
                state,
                (was_closed, opens),
                transitions,
            );
        }
        Err(Error::ImpactsDoNotEnd { time: state.t.to_f64() })
    }

    /// Closes the resting contacts that have to push, and takes what is left of their rates.
    #[allow(clippy::type_complexity, reason = "slices that belong together")]
    fn close(
        &self,
        (touching, resting, pressing): (&[usize], &[bool], &[[L::Scalar; 2]]),
        (matrix, responses): &Delassus<L>,
        state: &mut StateOf<L>,
        (was_closed, opens): (&[bool], Option<usize>),
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<Decided<L::Scalar>, Error> {
        let mut resting = resting.to_vec();
        let noise = self.motion_noise(matrix, state);
        let (places, problem, solved, accelerations) = loop {
            let rests = |place: &usize| resting[*place] && opens != Some(touching[*place]);
            let places: Vec<usize> = (0..touching.len()).filter(rests).collect();
            let of = |place: usize| places.iter().map(|&k| matrix[place][k]).collect::<Vec<_>>();
            let problem = Complementarity {
                matrix: places.iter().map(|&place| of(place)).collect(),
                constant: places.iter().map(|&place| pressing[place][0]).collect(),
                noise: places.iter().map(|&place| pressing[place][1]).collect(),
            };
            let solved = problem.solve().ok_or_else(|| self.contradiction(touching, state))?;
            let acceleration = |place: usize| {
                let forces = places.iter().zip(&solved.z).map(|(&k, &z)| matrix[place][k] * z);
                forces.fold(pressing[place][0], |sum, part| sum + part)
            };
            let accelerations: Vec<L::Scalar> = (0..touching.len()).map(acceleration).collect();
            // The forces of contacts may press others together, whose bounces are then low.
            let joins = |&place: &usize| {
                !resting[place] && self.rests(touching[place], (accelerations[place], noise[place]), state)
            };
            match (0..touching.len()).find(joins) {
                Some(place) => resting[place] = true,
                None => break (places, problem, solved, accelerations),
            }
        };
        let mut decided = Self::decided((touching, &places), (&problem, &solved), opens);
        // One that parts ever faster is watched as one that rests, since it may start below zero by its round-off.
        for place in (0..touching.len()).filter(|&place| !resting[place]) {
            decided.is_resting[touching[place]] = accelerations[place] >= L::Scalar::constant(0.0);
        }
        decided.bounce = self.bounce((touching, &resting, &accelerations), state);
        let towards = Self::towards((touching, &places), (&problem, &solved));
        self.report(&towards, state, (was_closed, &decided.states.is_closed), transitions)?;
        self.stop((touching, &places), (problem, &solved.is_active), responses, state);
        Ok(decided)
    }

    /// Takes the rates, all but zero, of resting contacts: those that are closed stay so, and no other one approaches.
    fn stop(
        &self,
        (touching, places): (&[usize], &[usize]),
        (problem, is_active): (Complementarity<L::Scalar>, &[bool]),
        responses: &[Vector<L::Scalar, L::N>],
        state: &mut StateOf<L>,
    ) {
        let active: Vec<usize> = (0..places.len()).filter(|&place| is_active[place]).collect();
        let mut problem = problem;
        for _ in 0..STOPS {
            let measured: Vec<Measured<L::Scalar>> =
                places.iter().map(|&place| self.measured(touching[place], state)).collect();
            problem.constant = measured.iter().map(|measured| measured.rate).collect();
            // A rate that is round-off counts, too: in a slot without room, the gap would close again at once.
            let is_wrong = |k: &usize| !is_active[*k] && measured[*k].rate < L::Scalar::constant(0.0);
            // One that depends on others stops along with them.
            let mut together = active.clone();
            for k in (0..places.len()).filter(is_wrong) {
                if !problem.depends(k, &together) {
                    together.push(k);
                }
            }
            for (&place, &impulse) in places.iter().zip(&problem.equality(&together)) {
                state.v = vector(Array::from_fn(|i| state.v[i] + responses[place][i] * impulse));
            }
            if together.len() == active.len() {
                break;
            }
        }
    }

    /// Which contacts are closed, and which are implied by those.
    fn decided(
        (touching, places): (&[usize], &[usize]),
        (problem, solved): (&Complementarity<L::Scalar>, &ComplementarySolution<L::Scalar>),
        opens: Option<usize>,
    ) -> Decided<L::Scalar> {
        let mut decided = Decided::none::<L>(Vec::new());
        let active: Vec<usize> = (0..places.len()).filter(|&place| solved.is_active[place]).collect();
        for (place, &of_touching) in places.iter().enumerate() {
            let (k, is_active) = (touching[of_touching], solved.is_active[place]);
            let is_still = solved.w[place] <= solved.noise[place];
            (decided.states.is_closed[k], decided.is_resting[k]) = (is_active, true);
            decided.is_implied[k] = !is_active && is_still && problem.depends(place, &active);
        }
        // Its multiplier has just become zero, so that its gap begins to open without an acceleration.
        if let Some(k) = opens {
            decided.is_resting[k] = true;
        }
        decided
    }

    /// Time within which the shortest bounce ends: 2 v/a and somewhat more, with the rate v of the gap and its acceleration −a.
    pub(super) fn bounce(
        &self,
        (touching, resting, accelerations): (&[usize], &[bool], &[L::Scalar]),
        state: &StateOf<L>,
    ) -> Option<L::Scalar> {
        let falls = |place: &usize| !resting[*place] && accelerations[*place] < L::Scalar::constant(0.0);
        let time = |place: usize| {
            L::Scalar::constant(-BOUNCE) * self.measured(touching[place], state).rate / accelerations[place]
        };
        (0..touching.len()).filter(falls).map(time).reduce(|one, other| if other < one { other } else { one })
    }

    /// Accelerations towards each closed contact without its own force, while the others that are closed stay so.
    fn towards(
        (touching, places): (&[usize], &[usize]),
        (problem, solved): (&Complementarity<L::Scalar>, &ComplementarySolution<L::Scalar>),
    ) -> Vec<L::Scalar> {
        let mut towards = alloc::vec![L::Scalar::constant(0.0); L::CONTACTS.len()];
        for place in (0..places.len()).filter(|&place| solved.is_active[place]) {
            let others: Vec<usize> =
                (0..places.len()).filter(|&other| other != place && solved.is_active[other]).collect();
            if let Some(response) = problem.response(place, &others) {
                towards[touching[places[place]]] = response * solved.z[place];
            }
        }
        towards
    }

    /// Reports the contacts that close and open.
    pub(super) fn report(
        &self,
        towards: &[L::Scalar],
        state: &StateOf<L>,
        (was_closed, is_closed): (&[bool], &[bool]),
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<(), Error> {
        let [zero, one, two] = [0.0, 1.0, 2.0].map(L::Scalar::constant);
        for k in (0..is_closed.len()).filter(|&k| was_closed[k] != is_closed[k]) {
            let (contact, time, Measured { rate, noise, .. }) =
                (self.name(k), state.t, self.measured(k, state));
            let shrinks = towards[k] * (one - self.restitution(k, state)?);
            transitions.push(match is_closed[k] {
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
