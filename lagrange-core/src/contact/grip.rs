//! Forces at one instant: which of the contacts at rest push, and which friction sticks.

use alloc::vec;
use alloc::vec::Vec;

use super::bodies::{Bodies, OFF, States};
use super::complementarity::Complementarity;
use super::friction::{BEGIN, TouchNames, TouchingRows};
use super::instant::{Changed, Decided};
use super::law::{ContactForces, Grip, Law, Touch};
use super::watched::BEYOND;
use super::{Contacts, Friction};
use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::system::StateOf;

/// A decision under way.
pub(super) struct Decision<'a, L: Contacts<Scalar: Real>> {
    bodies: &'a Bodies<L>,
    rows: &'a TouchingRows<L>,
    /// Rates of the rows without forces, with their round-off.
    pressing: &'a [[L::Scalar; 2]],
    /// The contact that has just ceased to push.
    opens: Option<usize>,
    /// The contacts that were closed in the leg that ends here, if none of them opens and no other one closes.
    were_closed: Option<&'a [bool]>,
    /// Which of the touching contacts are at rest.
    pub(super) resting: Vec<bool>,
    /// Direction in which each friction slides; none if it is at rest.
    pub(super) slips: Vec<Option<[L::Scalar; 2]>>,
    /// Friction that has left its limit from rest, with its direction.
    begun: Vec<(usize, [L::Scalar; 2])>,
    /// Friction that has left its limit, but is held back.
    held: Vec<usize>,
}

/// Forces that satisfy the laws, and the touches that they belong to.
pub(super) struct Gripped<T> {
    pub(super) forces: ContactForces<T>,
    pub(super) touches: Vec<Touch<T>>,
    pub(super) names: TouchNames,
    /// Which of the touching contacts may push.
    plays: Vec<bool>,
}

impl<'a, L: Contacts<Scalar: Real> + Clone> Decision<'a, L> {
    pub(super) fn new(
        bodies: &'a Bodies<L>,
        (rows, pressing): (&'a TouchingRows<L>, &'a [[L::Scalar; 2]]),
        resting: Vec<bool>,
        state: &StateOf<L>,
        (was, changed): (&'a States, &Changed),
    ) -> Self {
        // What has the same velocity as another friction stops with it.
        let units = if changed.stops.is_some() { BEGIN } else { 1.0 };
        let has_stuck = |f: usize| {
            let is_pressed = L::FRICTIONS[f].contact.is_none_or(|k| was.is_closed[k]);
            changed.ends_leg && is_pressed && was.frictions.get(f).is_some_and(Friction::is_at_rest)
        };
        let is_at_rest = |f| changed.stops == Some(f) || has_stuck(f);
        let slip = |f| if is_at_rest(f) { None } else { bodies.slip(f, state, units) };
        let slips = (0..L::FRICTIONS.len()).map(slip).collect();
        let begun = changed.slips.iter().map(|&(f, direction)| (f, direction.map(L::Scalar::constant)));
        let (begun, held) = (begun.collect(), Vec::new());
        let goes_on = changed.ends_leg && changed.opens.is_none() && changed.closes.is_none();
        let were_closed = goes_on.then_some(&was.is_closed[..]);
        Self { bodies, rows, pressing, opens: changed.opens, were_closed, resting, slips, begun, held }
    }

    /// Finds forces after which nothing else comes to rest or begins to slide.
    pub(super) fn settle(&mut self, state: &StateOf<L>) -> Result<Gripped<L::Scalar>, Error> {
        loop {
            let gripped = self.forces(state)?;
            if !self.joins(&gripped, state) && !self.is_held(&gripped) && !self.falls(&gripped) {
                return Ok(gripped);
            }
        }
    }

    fn forces(&self, state: &StateOf<L>) -> Result<Gripped<L::Scalar>, Error> {
        let touching = self.rows.touching.iter().zip(&self.resting);
        let plays: Vec<bool> = touching.map(|(&k, &rests)| rests && self.opens != Some(k)).collect();
        if let Some(gripped) = self.by_those_before(&plays, state) {
            return Ok(gripped);
        }
        self.of_playing(plays, state)
    }

    /// Forces of the contacts that were closed before, if they hold the bodies at rest without others that touch.
    fn by_those_before(&self, plays: &[bool], state: &StateOf<L>) -> Option<Gripped<L::Scalar>> {
        let were_closed = self.were_closed?;
        let of_those = |(&plays, &k): (&bool, &usize)| plays && were_closed[k];
        let those: Vec<bool> = plays.iter().zip(&self.rows.touching).map(of_those).collect();
        if those == plays {
            return None;
        }
        let gripped = self.of_playing(those, state).ok()?;
        let stays_apart = |place: usize| {
            gripped.forces.rates[place] >= -self.rows.noise(place, self.pressing, &gripped.forces)
        };
        let others = (0..plays.len()).filter(|&place| plays[place] && !gripped.plays[place]);
        let holds = gripped.forces.motion.is_none() && others.clone().all(stays_apart);
        holds.then(|| Gripped { plays: plays.to_vec(), ..gripped })
    }

    fn of_playing(&self, plays: Vec<bool>, state: &StateOf<L>) -> Result<Gripped<L::Scalar>, Error> {
        let grip = |f: usize| {
            let begun = self.begun.iter().find(|(of, _)| *of == f).map(|(_, direction)| *direction);
            let undecided = if L::FRICTIONS[f].count == 1 { Grip::Open } else { Grip::Sticks };
            Some(begun.or(self.slips[f]).map_or(undecided, Grip::Slides))
        };
        let (touches, names) = self.bodies.touches(self.rows, &plays, state, grip)?;
        let (rates, noise) = self.pressing.iter().map(|&[rate, noise]| (rate, noise)).unzip();
        let (matrix, touching) = (&self.rows.delassus.0, touches.clone());
        let law = Law { matrix, rates, noise, touches: touching, accuracy: BEYOND };
        let forces = law.decide().map_err(|why| self.bodies.jams(why, &names, state))?;
        Ok(Gripped { forces, touches, names, plays })
    }

    /// Whether the forces press another contact together, whose bounces are then low: it counts as at rest from now on.
    fn joins(&mut self, gripped: &Gripped<L::Scalar>, state: &StateOf<L>) -> bool {
        let noise = self.bodies.motion_noise(&self.rows.delassus.0, state);
        let joins = |&place: &usize| {
            let (k, rate) = (self.rows.touching[place], gripped.forces.rates[place]);
            !self.resting[place] && self.bodies.rests(k, (rate, noise[place]), state)
        };
        let joining = (0..self.resting.len()).find(joins);
        joining.into_iter().for_each(|place| self.resting[place] = true);
        joining.is_some()
    }

    /// Whether friction that has left its limit would slide back: its force is then decided anew.
    fn is_held(&mut self, gripped: &Gripped<L::Scalar>) -> bool {
        let is_back = |&(f, direction): &(usize, [L::Scalar; 2])| {
            let Some(&(_, place)) = self.rows.frictions.iter().find(|(of, _)| *of == f) else { return false };
            let zero = L::Scalar::constant(0.0);
            let [along, noise] = (0..L::FRICTIONS[f].count).fold([zero; 2], |[sum, noise], c| {
                let round_off = self.rows.noise(place + c, self.pressing, &gripped.forces);
                let part = direction[c] * gripped.forces.rates[place + c];
                [sum + part, noise + Scalar::abs(direction[c]) * round_off]
            });
            along < -noise
        };
        let held = self.begun.iter().position(|begun| !self.held.contains(&begun.0) && is_back(begun));
        held.map(|k| self.held.push(self.begun.remove(k).0)).is_some()
    }

    /// Whether another friction begins to slide with a force below its limit.
    fn falls(&mut self, gripped: &Gripped<L::Scalar>) -> bool {
        let begins = |k: usize| {
            let (friction, f) = (gripped.touches[k].friction?, gripped.names[k].1?);
            let Grip::Slides(direction) = gripped.forces.grips[k]? else { return None };
            let is_new = self.slips[f].is_none() && !self.begun.iter().any(|(of, _)| *of == f);
            (is_new && friction.bounds[1] < friction.bounds[0]).then_some((f, direction))
        };
        let begun = (0..gripped.touches.len()).find_map(begins);
        self.begun.extend(begun);
        begun.is_some()
    }
}

impl<L: Contacts<Scalar: Real> + Clone> TouchingRows<L> {
    /// Round-off of the rate of a row with these forces.
    fn noise(
        &self,
        place: usize,
        pressing: &[[L::Scalar; 2]],
        forces: &ContactForces<L::Scalar>,
    ) -> L::Scalar {
        let parts = self.delassus.0[place].iter().zip(&forces.forces);
        let size = parts.fold(L::Scalar::constant(0.0), |sum, (&g, &f)| sum + Scalar::abs(g * f));
        pressing[place][1] + L::Scalar::constant(L::Scalar::EPSILON * BEGIN) * size
    }

    /// Rows that stay at rest: closed gaps, and velocities of friction that sticks.
    pub(super) fn active(&self, states: &States) -> Vec<usize> {
        let gaps = (0..self.touching.len()).filter(|&place| states.is_closed[self.touching[place]]);
        let sticks = self.frictions.iter().flat_map(|&(f, place)| {
            let is_pressed = L::FRICTIONS[f].contact.is_none_or(|k| states.is_closed[k]);
            let is_kept = move |c: &usize| is_pressed && states.frictions[f].keeps(*c);
            (0..L::FRICTIONS[f].count).filter(is_kept).map(move |c| place + c)
        });
        gaps.chain(sticks).collect()
    }

    /// The matrix G over all rows, to decide which depend on others.
    pub(super) fn problem(&self) -> Complementarity<L::Scalar> {
        let none = vec![L::Scalar::constant(0.0); self.all.len()];
        Complementarity { matrix: self.delassus.0.clone(), constant: none.clone(), noise: none }
    }
}

impl<T: Real> Gripped<T> {
    /// States of contacts and friction, and which of them those determine.
    pub(super) fn decided<L: Contacts<Scalar = T> + Clone>(
        &self,
        rows: &TouchingRows<L>,
        pressing: &[[T; 2]],
        slips: &[Option<[T; 2]>],
    ) -> Decided<T> {
        let mut decided = Decided::none::<L>(vec![OFF; L::FRICTIONS.len()]);
        self.mark(&mut decided);
        let problem = rows.problem();
        self.share(rows, &problem, slips, &mut decided);
        let active = rows.active(&decided.states);
        for place in (0..self.plays.len()).filter(|&place| self.plays[place]) {
            let k = rows.touching[place];
            decided.is_resting[k] = true;
            // Forces at the limits of friction are off by what is left of these.
            let is_still = self.forces.motion.is_some()
                || Scalar::abs(self.forces.rates[place]) <= rows.noise(place, pressing, &self.forces);
            decided.is_implied[k] =
                !decided.states.is_closed[k] && is_still && problem.depends(place, &active);
        }
        decided
    }

    /// Marks what is closed, and what sticks or slides.
    fn mark(&self, decided: &mut Decided<T>) {
        for (k, &(contact, friction)) in self.names.iter().enumerate() {
            if let Some(contact) = contact {
                decided.states.is_closed[contact] = self.forces.pushes[k];
            }
            if let (Some(f), Some(grip)) = (friction, self.forces.grips[k]) {
                decided.states.frictions[f] = match grip {
                    Grip::Slides(direction) => Friction::Slides(direction.map(Real::to_f64)),
                    Grip::Idle => OFF,
                    Grip::Open | Grip::Sticks => Friction::Sticks,
                };
            }
        }
    }
}
