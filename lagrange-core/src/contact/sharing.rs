//! Forces of friction that several contacts share: they are not unique, but the motion is.

use alloc::vec::Vec;

use super::complementarity::Complementarity;
use super::cones::{Cone, Cones, length};
use super::defect::FOUND;
use super::friction::{BEGIN, TouchingRows};
use super::grip::Gripped;
use super::instant::Decided;
use super::law::{ContactForces, Grip, Law, NoForces, Rubbing, Touch};
use super::reserve::{Reserve, Resting, reserve};
use super::{Contacts, Friction};
use crate::number::{Real, Scalar, larger, order};
use crate::solution::pivot::least_pivot;

/// Largest number of sweeps.
const SWEEPS: usize = 10_000;

/// Largest number of sets of contacts that are tried, where gaps are combinations of one another: a table on four legs can stand on any
/// three of them.
const TRIES: usize = 64;

/// Rates along a contact, in units of those that the residual allows, up to which it sticks. What sticks has the residual.
const STICKS: f64 = 1e3;

/// Part of its limit that friction at rest has left, where others could begin to slide. Forces of cones, from which it is known which
/// contacts push, are off by up to 10⁻⁹ of it: with 10⁻¹⁰, tables stayed at rest a thousand times on their way to the limit.
const LEFT: f64 = 1e-8;

impl<T> ContactForces<T> {
    /// Whether some friction slides.
    fn slide(&self) -> bool {
        self.grips.iter().any(|grip| matches!(grip, Some(Grip::Slides(_))))
    }
}

impl<T: Real> Law<'_, T> {
    /// Finds forces of friction that several contacts share. Those with which the contacts that push first keep all at rest are
    /// tried first, and then those by cones, where others may push. Friction that has reached its limits together slides.
    pub(super) fn shared(&self) -> Result<ContactForces<T>, NoForces> {
        let obeying = |forces: &ContactForces<T>| self.obeys(forces);
        let at_rest = self.solve().and_then(|outcome| self.with_reserve(outcome)).filter(obeying);
        if let Some(forces) = at_rest.as_ref().filter(|forces| !forces.slide()) {
            return Ok(forces.clone());
        }
        let by_cones = self.by_cones();
        let with_rest = by_cones.clone().filter(|forces| !forces.slide() && self.has_reserve(forces));
        with_rest.or(at_rest).or(by_cones).map_or_else(|| self.in_directions(), Ok)
    }

    /// Whether all friction has some of its limit left.
    fn has_reserve(&self, forces: &ContactForces<T>) -> bool {
        self.touches.iter().all(|touch| {
            let Some(Rubbing { place, count, bounds: [limit, _], .. }) = touch.friction else { return true };
            let press = touch.gap.map_or(T::constant(1.0), |gap| forces.forces[gap]);
            let force = |c: usize| if c < count { forces.forces[place + c] } else { T::constant(0.0) };
            let size = length([force(0), force(1)]);
            size == T::constant(0.0) || size < limit * press * T::constant(1.0 - LEFT)
        })
    }

    /// Size of the terms of what forces change a rate by.
    pub(super) fn size(&self, row: usize, forces: &ContactForces<T>) -> T {
        let parts = self.matrix[row].iter().zip(&forces.forces);
        parts.fold(T::constant(0.0), |sum, (&g, &force)| sum + Scalar::abs(g * force))
    }

    /// The rate of a row with these forces.
    fn rate(&self, row: usize, forces: &[T]) -> T {
        self.matrix[row].iter().zip(forces).fold(self.rates[row], |sum, (&g, &force)| sum + g * force)
    }

    /// Finds forces that satisfy the law to a residual of 10⁻¹², whatever rows depend on one another. Gaps whose rows depend
    /// on others that push do not push. `None` if none are found, or if something slides already.
    pub(super) fn by_cones(&self) -> Option<ContactForces<T>> {
        let mut plays: Vec<bool> = self.touches.iter().map(|_| true).collect();
        self.with_fewer(&self.problem(), &mut plays, &mut { TRIES })
    }

    /// Forces of the contacts that `plays` marks. Where gaps of some are combinations of others, one of those is left out: the one with
    /// the least force first, and the next one if no forces are found without it.
    fn with_fewer(
        &self,
        problem: &Complementarity<T>,
        plays: &mut [bool],
        tries: &mut usize,
    ) -> Option<ContactForces<T>> {
        *tries = tries.checked_sub(1)?;
        let outcome = self.within_cones(plays)?;
        let spares = self.spares(problem, &outcome);
        if spares.is_empty() {
            let outcome = self.of_pushing(&outcome).unwrap_or(outcome);
            let shared = self.with_reserve(outcome.clone());
            return shared.into_iter().chain([outcome]).find(|forces| self.obeys(forces));
        }
        spares.into_iter().find_map(|spare| {
            plays[spare] = false;
            let found = self.with_fewer(problem, plays, tries);
            plays[spare] = true;
            found
        })
    }

    /// Forces with which the contacts that push keep all at rest, to round-off; those found satisfy the law to [`FOUND`] alone.
    fn of_pushing(&self, found: &ContactForces<T>) -> Option<ContactForces<T>> {
        let is_pressed = |k: &usize| self.touches[*k].gap.is_none() || found.pushes[*k];
        let touches = (0..self.touches.len()).filter(is_pressed).map(|k| self.touches[k]).collect();
        let solved = Law { touches, ..self.clone() }.solve().filter(|_| !found.slide())?;
        let is_same = !solved.slide()
            && solved.pushes.iter().filter(|pushes| **pushes).count()
                == found.pushes.iter().filter(|pushes| **pushes).count();
        is_same.then(|| ContactForces { forces: solved.forces, rates: solved.rates, ..found.clone() })
    }

    /// Whether a velocity of friction in the plane that may stick depends on others that may, and on gaps.
    pub(super) fn is_shared(&self) -> bool {
        let sticks = |touch: &Touch<T>| touch.friction.filter(|f| f.count == 2 && f.grip == Grip::Sticks);
        if self.touches.iter().filter_map(sticks).count() < 2 {
            return false;
        }
        let problem = self.problem();
        let mut active = Vec::new();
        // A gap that depends on others may be left out.
        for gap in self.touches.iter().filter_map(|touch| touch.gap) {
            if !problem.depends(gap, &active) {
                active.push(gap);
            }
        }
        let mut rows = self.touches.iter().filter_map(sticks).flat_map(|f| f.place..f.place + f.count);
        rows.any(|row| {
            let depends = problem.depends(row, &active);
            active.push(row);
            depends
        })
    }

    pub(super) fn problem(&self) -> Complementarity<T> {
        Complementarity {
            matrix: self.matrix.to_vec(),
            constant: self.rates.clone(),
            noise: self.noise.clone(),
        }
    }

    /// Contacts that push, and whose gaps are combinations of those of others that push, in the order of their forces, the least
    /// first. Without one of them, the others can hold the body as well.
    fn spares(&self, problem: &Complementarity<T>, outcome: &ContactForces<T>) -> Vec<usize> {
        let mut pushing: Vec<(usize, usize)> = (0..self.touches.len())
            .filter(|&k| outcome.pushes[k])
            .filter_map(|k| Some((k, self.touches[k].gap?)))
            .collect();
        let force = |&(_, gap): &(usize, usize)| outcome.forces[gap];
        pushing.sort_by(|one, other| order(force(one), force(other)));
        let is_spare = |&(_, gap): &(usize, usize)| {
            let mut active = Vec::new();
            for &(_, other) in pushing.iter().rev().filter(|&&(_, other)| other != gap) {
                if !problem.depends(other, &active) {
                    active.push(other);
                }
            }
            problem.depends(gap, &active)
        };
        pushing.iter().filter(|of| is_spare(of)).map(|&(k, _)| k).collect()
    }

    /// Forces of the contacts that `plays` marks, and of dry friction.
    fn within_cones(&self, plays: &[bool]) -> Option<ContactForces<T>> {
        let (mut cones, places) = self.cones(plays)?;
        let residual = cones.solve(T::constant(FOUND), SWEEPS).residual;
        if !residual.is_finite() || residual > T::constant(FOUND) {
            return None;
        }
        let mut forces: Vec<T> = self.rates.iter().map(|_| T::constant(0.0)).collect();
        places.iter().zip(cones.impulses()).for_each(|(&place, &force)| forces[place] = force);
        let rates: Vec<T> = (0..forces.len()).map(|row| self.rate(row, &forces)).collect();
        let still = T::constant(FOUND * STICKS) * cones.scale();
        let allowed = |row: usize| still * Scalar::sqrt(self.matrix[row][row]) + self.noise[row];
        let parts = |touch: &Touch<T>| touch.gap.is_none_or(|gap| rates[gap] >= -allowed(gap));
        let pushes = self.touches.iter().zip(plays).map(|(touch, &plays)| {
            plays && touch.gap.is_some_and(|gap| forces[gap] > T::constant(0.0) && rates[gap] <= allowed(gap))
        });
        let grip = |Rubbing { place, count, .. }: Rubbing<T>| {
            let of = |c: usize| if c < count { rates[place + c] } else { T::constant(0.0) };
            let (size, least) = (length([of(0), of(1)]), larger(allowed(place), allowed(place + count - 1)));
            if size <= least { Grip::Sticks } else { Grip::Slides([of(0) / size, of(1) / size]) }
        };
        let grips = self.touches.iter().map(|touch| touch.friction.map(grip));
        let (pushes, grips) = (pushes.collect(), grips.collect());
        self.touches.iter().all(parts).then_some(ContactForces { forces, rates, pushes, grips, motion: None })
    }

    /// Keeps gaps closed that neither need a force nor open, if those that push do not determine them: a body whose weight is on
    /// two of its four feet would else be free to turn about these.
    pub(super) fn close_idle(&self, outcome: &mut ContactForces<T>) {
        let problem = self.problem();
        let gap = |k: usize| self.touches[k].gap;
        let mut active: Vec<usize> =
            (0..self.touches.len()).filter(|&k| outcome.pushes[k]).filter_map(gap).collect();
        for k in 0..self.touches.len() {
            let Some(gap) = gap(k).filter(|_| !outcome.pushes[k]) else { continue };
            let noise = self.noise[gap] + T::constant(T::EPSILON * BEGIN) * self.size(gap, outcome);
            if Scalar::abs(outcome.rates[gap]) <= noise && !problem.depends(gap, &active) {
                outcome.pushes[k] = true;
                active.push(gap);
            }
        }
    }

    /// Shares out the forces of friction where all of it is at rest.
    fn with_reserve(&self, mut outcome: ContactForces<T>) -> Option<ContactForces<T>> {
        let (mut touches, mut resting) = (Vec::new(), Vec::new());
        // What is not pressed has no force.
        for (k, touch) in self.touches.iter().enumerate() {
            let Some(Rubbing { place, count, bounds: [limit, _], .. }) = touch.friction else { continue };
            let press = touch.gap.map_or(T::constant(1.0), |gap| outcome.forces[gap]);
            let limit = larger(limit * press, T::constant(0.0));
            if !matches!(outcome.grips[k], Some(Grip::Sticks | Grip::Idle)) {
                return None;
            }
            touches.push(k);
            resting.push(Resting { place, count, limit });
        }
        let mut motion = self.rates.iter().map(|_| T::constant(0.0)).collect::<Vec<T>>();
        let Reserve { forces, slips, velocities } = reserve(&self.problem(), &resting, &outcome.forces)?;
        for (n, (&k, Resting { place, count, .. })) in touches.iter().zip(resting).enumerate() {
            outcome.forces[place..place + count].copy_from_slice(&forces[n][..count]);
            motion[place..place + count].copy_from_slice(&velocities[n][..count]);
            if let Some(direction) = slips[n] {
                outcome.grips[k] = Some(Grip::Slides(direction));
            }
        }
        outcome.motion = slips.iter().any(Option::is_some).then_some(motion);
        outcome.rates = (0..self.rates.len()).map(|row| self.rate(row, &outcome.forces)).collect();
        Some(outcome)
    }

    /// The law of the contacts that `plays` marks as a problem of cones, with the place of each of its rows. `None` if friction
    /// slides already, or if smallest forces are stated.
    fn cones(&self, plays: &[bool]) -> Option<(Cones<T>, Vec<usize>)> {
        let (mut cones, mut places) = (Cones::with_room(self.rates.len()), Vec::new());
        let mut push = |cones: &mut Cones<T>, place: usize| {
            places.push(place);
            cones.push_row(self.rates[place], T::constant(0.0), |other| self.matrix[place][places[other]]);
            places.len() - 1
        };
        for (touch, _) in self.touches.iter().zip(plays).filter(|(_, plays)| **plays) {
            if touch.least > T::constant(0.0) {
                return None;
            }
            let press = touch.gap.map(|gap| {
                let row = push(&mut cones, gap);
                cones.push_block(1, Cone::Push);
                row
            });
            let Some(Rubbing { place, count, grip, bounds: [radius, _] }) = touch.friction else { continue };
            if matches!(grip, Grip::Slides(_) | Grip::Idle) {
                return None;
            }
            (place..place + count).for_each(|row| {
                push(&mut cones, row);
            });
            cones.push_block(count, Cone::Disc { radius, press });
        }
        Some((cones, places))
    }
}

/// Friction at rest.
struct RestingFriction<T> {
    f: usize,
    rubbing: Rubbing<T>,
    /// Force of sliding.
    sliding: T,
    /// Part of its limit that is left.
    slack: T,
}

impl<T: Real> Gripped<T> {
    /// Lets friction at rest whose velocity depends on others at rest act with the part of the force of sliding that was found:
    /// the rows that are left are independent, and their forces unique. Those that are furthest from their limits are left.
    pub(super) fn share<L: Contacts<Scalar = T> + Clone>(
        &self,
        rows: &TouchingRows<L>,
        problem: &Complementarity<T>,
        slips: &[Option<[T; 2]>],
        decided: &mut Decided<T>,
    ) {
        let gaps = (0..rows.touching.len()).filter(|&place| decided.states.is_closed[rows.touching[place]]);
        let mut active: Vec<usize> = gaps.collect();
        rows.frictions.iter().for_each(|&(f, _)| decided.slips_from_rest[f] = slips[f].is_none());
        for RestingFriction { f, rubbing: Rubbing { place, count, grip, .. }, sliding, .. } in
            self.at_rest(slips, decided)
        {
            let (mut parts, mut is_implied) = ([Some(0.0); 2], true);
            let before = active.len();
            for (row, part) in (place..place + count).zip(&mut parts) {
                let response = problem.response(row, &active);
                is_implied &= response.is_none();
                // Without a force it sticks if its row is independent enough for the elimination to trust the forces.
                let is_idle = grip == Grip::Idle;
                let least = least_pivot::<T>() * problem.matrix[row][row];
                if response.is_none_or(|response| is_idle && response <= least) {
                    let ratio = (self.forces.forces[row] / sliding).to_f64();
                    *part = Some(if ratio.is_finite() { ratio } else { 0.0 });
                } else {
                    *part = None;
                    active.push(row);
                }
            }
            let kept = active.len() - before;
            match (grip, kept) {
                // It begins to slide, unless the others keep it at rest.
                (Grip::Slides(_), 1..) => active.truncate(before),
                (_, kept) if kept == count => decided.states.frictions[f] = Friction::Sticks,
                _ => decided.states.frictions[f] = Friction::Shares(parts),
            }
            decided.slip_is_implied[f] = is_implied;
        }
    }

    /// Friction at rest, that which sticks first, in the order of what is left of its limit.
    fn at_rest(&self, slips: &[Option<[T; 2]>], decided: &Decided<T>) -> Vec<RestingFriction<T>> {
        let of = |k: usize| {
            let ((contact, f), touch) = (self.names[k], self.touches[k]);
            let (f, rubbing, grip) = (f?, touch.friction?, self.forces.grips[k]?);
            let is_pressed = contact.is_none_or(|contact| decided.states.is_closed[contact]);
            if slips[f].is_some() || !is_pressed {
                return None;
            }
            let press = touch.gap.map_or(T::constant(1.0), |gap| self.forces.forces[gap]);
            let Rubbing { place, count, bounds: [limit, sliding], .. } = rubbing;
            let force = |c: usize| if c < count { self.forces.forces[place + c] } else { T::constant(0.0) };
            let slack = limit * press - length([force(0), force(1)]);
            Some(RestingFriction { f, rubbing: Rubbing { grip, ..rubbing }, sliding: sliding * press, slack })
        };
        let mut resting: Vec<_> = (0..self.names.len()).filter_map(of).collect();
        let slides = |one: &RestingFriction<T>| matches!(one.rubbing.grip, Grip::Slides(_));
        resting.sort_by(|one, other| slides(one).cmp(&slides(other)).then(order(other.slack, one.slack)));
        resting
    }
}
