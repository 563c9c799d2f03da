//! Impacts by the laws of Newton and Poisson, with Coulomb's law for the impulses of friction.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::Transition;
use super::bodies::Bodies;
use super::friction::bounds;
use super::reactions::{NoForces, ReactionProblem, Reactions};
use super::rows::TouchingRows;
use super::{Contacts, ImpactLaw};
use crate::cone::{ConeSearch, Limit, Set};
use crate::error::Error;
use crate::number::limits::ACCUMULATED;
use crate::number::{Real, Scalar};
use crate::system::StateOf;
use crate::vector::Entrywise;

/// An impact under way, or the kick of a time step: the rows of the bodies that touch, and the laws of their contacts.
pub(super) struct StagedImpact<'a, L> {
    pub(super) rows: &'a TouchingRows<L>,
    /// Rates before, and those without impulses; the same at an impact.
    pub(super) before: Vec<f64>,
    pub(super) rates: Vec<f64>,
    /// Round-off of the rates.
    pub(super) noise: Vec<f64>,
    /// Which of the touching contacts take part.
    pub(super) plays: Vec<bool>,
    pub(super) frictions: Vec<StagedFriction>,
    /// e γ of the contacts with Newton's law, with the rate γ before.
    pub(super) returned: Vec<f64>,
    /// Poisson's coefficient of restitution of each row, zero for those of other laws.
    pub(super) expansion: Vec<f64>,
    /// How impulses are looked for, with faces by constraints.
    pub(super) search: ConeSearch<'a>,
}

/// Friction that takes part in an impact.
pub(super) struct StagedFriction {
    /// Places of its velocities and of its gap, if it has one.
    pub(super) places: Range<usize>,
    pub(super) gap: Option<usize>,
    /// The limit, as a multiple of the impulse of the gap if it has one.
    pub(super) limit: f64,
}

impl<L: Contacts<Scalar: Real>> StagedImpact<'_, L> {
    /// Impulses with the part given of all restitutions. The compression is an impact without Poisson's restitution; in
    /// the expansion, a contact pushes at least with e times its impulse Λ of the compression (Pfeiffer and Glocker,
    /// *Multibody Dynamics with Unilateral Contacts*, 1996, chapter 8).
    fn impulses(&self, part: f64) -> Result<Reactions, NoForces> {
        let mut rates = self.rates.clone();
        rates.iter_mut().zip(&self.returned).for_each(|(rate, returned)| *rate += part * returned);
        let mut impulses = self.stage(rates, &vec![0.0; self.plays.len()])?;
        let least = |(e, impulse): (&f64, &f64)| part * e * impulse;
        let least: Vec<f64> = self.expansion.iter().zip(&impulses.forces).map(least).collect();
        if least.iter().any(|least| *least > 0.0) {
            let expansion = self.stage(impulses.rates, &least)?;
            impulses.rates = expansion.rates;
            impulses.forces.iter_mut().zip(expansion.forces).for_each(|(sum, more)| *sum += more);
            impulses.change.iter_mut().zip(expansion.change).for_each(|(sum, more)| *sum += more);
        }
        for (rate, returned) in impulses.rates.iter_mut().zip(&self.returned) {
            *rate -= part * returned;
        }
        Ok(impulses)
    }

    /// Impulses, of which those of gaps are at least these.
    fn stage(&self, rates: Vec<f64>, least: &[f64]) -> Result<Reactions, NoForces> {
        let mut problem = ReactionProblem::new(self.rows, rates, &self.noise).by(self.search);
        let mut gaps = vec![None; self.plays.len()];
        for gap in (0..self.plays.len()).filter(|&gap| self.plays[gap]) {
            if least[gap] > 0.0 {
                problem.know(gap, least[gap]);
            }
            gaps[gap] = Some(problem.push(gap..gap + 1, Set::HalfLine));
        }
        for &StagedFriction { ref places, gap, limit } in &self.frictions {
            let limit = match gap {
                Some(place) => Limit { radius: limit * least[place], mu: limit, gap: gaps[place] },
                None => Limit { radius: limit, mu: 0.0, gap },
            };
            problem.push(places.clone(), Set::Disc(limit));
        }
        problem.decide()
    }

    /// Impulses with the restitutions as stated, or lowered in proportion to where they gain no energy.
    pub(super) fn without_gain(&self) -> Result<Reactions, NoForces> {
        let whole = self.impulses(1.0)?;
        if !self.gains(&whole) {
            return Ok(whole);
        }
        let [mut low, mut high] = [0.0, 1.0];
        for _ in 0..f64::MANTISSA_DIGITS {
            let part = (low + high) * 0.5;
            *if self.gains(&self.impulses(part)?) { &mut high } else { &mut low } = part;
        }
        self.impulses(low)
    }

    /// Whether a contact bounces, and the impulses work, by the mean of the rates before and after, more than their round-off.
    fn gains(&self, impulses: &Reactions) -> bool {
        let rows = self.before.iter().zip(&impulses.rates).zip(&impulses.forces);
        let [sum, size] = rows.fold([0.0; 2], |[sum, size], ((before, after), force)| {
            let work = force * (before + after);
            [sum + work, size + work.abs()]
        });
        let bounces = self.returned.iter().chain(&self.expansion).any(|x| *x != 0.0);
        bounces && sum > L::Scalar::EPSILON * ACCUMULATED * size
    }
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    /// An impact: the contacts that approach or rest push. Those that part take part in the next impact, if this one makes them approach.
    /// Newton's law can gain energy with friction (Kane and Levinson, *Dynamics*, 1985), and so can both laws in one impact: the
    /// restitutions are then lowered to where they gain none.
    pub(super) fn impact(
        &mut self,
        rows: &TouchingRows<L>,
        resting: &[bool],
        state: &mut StateOf<L>,
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<(), Error> {
        let hit = self.staged(rows, resting, state)?;
        let Reactions { forces, change, .. } =
            hit.without_gain().map_err(|why| self.jams(why, (rows, &hit.plays), state))?;
        state.v = state.v.plus(&rows.velocities(&change));
        let acting = (0..rows.count).filter(|&place| forces[place] != 0.0);
        self.strikes(acting.map(|place| rows.change(place, forces[place])));
        let acts = |&place: &usize| (rows.response(place, place) * forces[place]).abs() > hit.noise[place];
        let acting = (0..rows.count).filter(acts);
        let impulse = |place: usize| (L::CONSTRAINTS[rows.all[place]], L::Scalar::constant(forces[place]));
        transitions.push(Transition::Impact { time: state.t, impulses: acting.map(impulse).collect() });
        Ok(())
    }

    fn staged<'a>(
        &self,
        rows: &'a TouchingRows<L>,
        resting: &[bool],
        state: &StateOf<L>,
    ) -> Result<StagedImpact<'a, L>, Error> {
        let (rates, noise) = self.measured_rates(rows, state);
        let plays: Vec<bool> =
            resting.iter().zip(&rates).map(|(&is_resting, rate)| is_resting || *rate < 0.0).collect();
        let [mut returned, mut expansion] = [(); 2].map(|()| vec![0.0; rows.count]);
        for place in (0..plays.len()).filter(|&place| plays[place]) {
            let restitution = self.restitution(rows.touching[place], state)?.to_f64();
            match L::IMPACT_LAWS[rows.touching[place]] {
                ImpactLaw::Poisson => expansion[place] = restitution,
                ImpactLaw::Newton if !resting[place] => returned[place] = restitution * rates[place],
                ImpactLaw::Newton => {}
            }
        }
        let mut frictions = Vec::new();
        for &(f, place) in &rows.frictions {
            let gap = L::FRICTIONS[f].contact.and_then(|k| rows.gap(k));
            if let Some(gap) = gap.filter(|&gap| plays[gap]) {
                let [limit, sliding] = bounds(&self.closed, f, state)?;
                let limit = if self.slip(f, state, [1.0, 0.0]).is_some() { sliding } else { limit };
                let places = place..place + L::FRICTIONS[f].count;
                frictions.push(StagedFriction { places, gap: Some(gap), limit: limit.to_f64() });
            }
        }
        let before = rates.clone();
        Ok(StagedImpact {
            rows,
            before,
            rates,
            noise,
            plays,
            frictions,
            returned,
            expansion,
            search: ConeSearch::Law,
        })
    }
}
