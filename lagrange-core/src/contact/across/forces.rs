//! Forces at one instant, of contacts none of which others make needless.

use alloc::vec;
use alloc::vec::Vec;

use super::grip::{Decision, Gripped};
use super::reactions::{NoForces, ReactionProblem, Reactions};
use super::{Contacts, Friction};
use crate::cone::{Face, Limit, Set};
use crate::error::Error;
use crate::number::Real;
use crate::number::limits::ITERATIONS;
use crate::numerics::bare::length;
use crate::system::StateOf;

impl<L: Contacts<Scalar: Real> + Clone> Decision<'_, L> {
    /// Forces with this part of the limits of friction at rest.
    pub(super) fn forces(&self, part: f64, state: &StateOf<L>) -> Result<Gripped, Error> {
        let mut plays = self.carries.clone().unwrap_or_else(|| self.plays());
        let found = self.with_fewer(part, &mut plays, &mut { ITERATIONS });
        let mut gripped = found.map_err(|why| self.bodies.jams(why, (self.rows, &plays), state))?;
        self.close_idle(&mut gripped);
        Ok(gripped)
    }

    /// Forces of the contacts that `plays` marks. Where gaps of some are combinations of others, one of those is left out: the one with
    /// the least force first, and the next one if what is at rest does not stay so without it.
    fn with_fewer(&self, part: f64, plays: &mut [bool], tries: &mut usize) -> Result<Gripped, NoForces> {
        *tries = tries.checked_sub(1).ok_or(NoForces::Undecided)?;
        let gripped = self.of_playing(part, plays)?;
        let spares = self.spares(&gripped);
        if spares.is_empty() {
            return Ok(gripped);
        }
        let mut moves = Err(NoForces::Undecided);
        for spare in spares {
            plays[spare] = false;
            let found = self.with_fewer(part, plays, tries);
            plays[spare] = true;
            let stays = |of: &Gripped| of.rates[spare] >= -self.noise(spare, &of.forces);
            match found.ok().filter(stays) {
                Some(found) if self.rests(&found) => return Ok(found),
                Some(found) if moves.is_err() => moves = Ok(found),
                _ => {}
            }
        }
        moves
    }

    /// Contacts that push, and whose gaps are combinations of those of others that push: those that were open before, then those that
    /// were closed, each in the order of their forces, the least first.
    fn spares(&self, gripped: &Gripped) -> Vec<usize> {
        let mut pushing: Vec<usize> = (0..gripped.pushes.len()).filter(|&gap| gripped.pushes[gap]).collect();
        let mut span = self.rows.span([]);
        if pushing.iter().all(|&gap| span.add(gap)) {
            return Vec::new();
        }
        let was_closed = |gap: usize| self.was.is_closed(self.rows.touching[gap]);
        pushing.sort_by(|&one, &other| {
            let by_force = gripped.forces[one].total_cmp(&gripped.forces[other]);
            was_closed(one).cmp(&was_closed(other)).then(by_force)
        });
        let others = |gap: usize| pushing.iter().copied().filter(move |&of| of != gap);
        pushing.iter().copied().filter(|&gap| self.rows.span(others(gap)).depends(gap)).collect()
    }

    /// Keeps gaps closed that neither need a force nor open, if those that push do not determine them: a body whose weight is on
    /// two of its four feet would else be turned about these by the round-off of friction. Where a contact opens, others that were open do
    /// not take its place without a force: the body tips.
    fn close_idle(&self, gripped: &mut Gripped) {
        let pushing: Vec<usize> = (0..gripped.pushes.len()).filter(|&gap| gripped.pushes[gap]).collect();
        if pushing.is_empty() || self.rows.frictions.is_empty() {
            return;
        }
        let (mut span, plays) = (self.rows.span(pushing), self.plays());
        let may_close =
            |&gap: &usize| plays[gap] && (!self.opens() || self.was.is_closed(self.rows.touching[gap]));
        for gap in (0..plays.len()).filter(may_close) {
            let is_still = gripped.rates[gap].abs() <= self.noise(gap, &gripped.forces);
            if !gripped.pushes[gap] && is_still && span.add(gap) {
                gripped.pushes[gap] = true;
            }
        }
    }

    /// Forces of the contacts that `plays` marks, and of their friction and dry friction.
    fn of_playing(&self, part: f64, plays: &[bool]) -> Result<Gripped, NoForces> {
        let (rates, noise) = self.pressing;
        let mut problem = ReactionProblem::new(self.rows, rates.clone(), noise);
        let mut gaps = vec![None; plays.len()];
        for gap in (0..plays.len()).filter(|&gap| plays[gap]) {
            gaps[gap] = Some(problem.push(gap..gap + 1, Set::HalfLine));
        }
        let mut frictions = vec![None; L::FRICTIONS.len()];
        for &(f, place) in &self.rows.frictions {
            let gap = L::FRICTIONS[f].contact.map(|k| self.rows.gap(k).and_then(|gap| gaps[gap]));
            if gap == Some(None) {
                continue;
            }
            let (places, gap, [limit, sliding]) =
                (place..place + L::FRICTIONS[f].count, gap.flatten(), self.bounds[f]);
            let set = match (self.direction(f), gap) {
                (None, Some(_)) => Set::Disc(Limit { radius: 0.0, mu: part * limit, gap }),
                (None, None) => Set::Disc(Limit { radius: part * limit, mu: 0.0, gap }),
                (Some(along), Some(gap)) => Set::Ray { force: along.map(|x| -sliding * x), gap },
                (Some(along), None) => {
                    places.zip(along).for_each(|(place, x)| problem.know(place, -sliding * x));
                    continue;
                }
            };
            frictions[f] = Some(problem.push(places, set));
        }
        Ok(self.gripped(problem.decide()?, plays, (&gaps, &frictions)))
    }

    /// What contacts and friction do with these forces.
    fn gripped(
        &self,
        found: Reactions,
        plays: &[bool],
        (gaps, frictions): (&[Option<usize>], &[Option<usize>]),
    ) -> Gripped {
        let Reactions { mut forces, rates, faces, .. } = found;
        forces.truncate(self.rows.count);
        // A force that only takes the round-off of a rate is none.
        let is_force = |gap: usize| self.rows.response(gap, gap) * forces[gap] > self.pressing.1[gap];
        let pushes = |gap: usize| gaps[gap].is_some() && faces[gap] != Face::Open && is_force(gap);
        let pushes = (0..gaps.len()).map(pushes).collect();
        let mut grips = vec![None; L::FRICTIONS.len()];
        for &(f, place) in &self.rows.frictions {
            let moves = || self.moves(f, place, (&forces, &rates));
            grips[f] = match (self.direction(f), frictions[f].map(|_| faces[place])) {
                (Some(direction), _) => Some(Friction::Slides(direction)),
                (None, Some(Face::Slide(force))) if moves().is_some() => {
                    Some(Friction::Slides(force.map(|x| -x)))
                }
                (None, Some(Face::Stick | Face::Slide(_))) => Some(Friction::Sticks),
                (None, Some(Face::Open)) => Some(moves().map_or(Friction::Sticks, Friction::Slides)),
                (None, None) => None,
            };
        }
        Gripped { forces, rates, pushes, grips, carries: plays.to_vec() }
    }

    /// Direction of the rates of a friction, if they are more than round-off. At its limit it may be at rest.
    fn moves(&self, f: usize, place: usize, (forces, rates): (&[f64], &[f64])) -> Option<[f64; 2]> {
        let rate = |c: usize| if c < L::FRICTIONS[f].count { rates[place + c] } else { 0.0 };
        let (size, noise) = (length([rate(0), rate(1)]), self.noise(place, forces));
        (size > noise).then(|| [rate(0) / size, rate(1) / size])
    }
}
