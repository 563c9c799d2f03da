//! Impacts by the laws of Newton and Poisson, with Coulomb's law for the impulses of friction.

use alloc::vec;
use alloc::vec::Vec;

use super::bodies::{Bodies, Measured};
use super::complementarity::{Complementarity, ComplementarySolution};
use super::defect::FOUND;
use super::friction::{BEGIN, TouchingRows};
use super::law::{Grip, Law, NoForces, Touch};
use super::trajectory::Transition;
use super::{Contacts, FrictionRows, ImpactLaw};
use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::system::StateOf;
use crate::vector::{Array, vector};

/// Halvings of the restitution of an impact that would gain energy.
const HALVINGS: usize = 60;

/// An impact under way: the rows of the bodies that touch, and the laws of their contacts.
struct StagedImpact<'a, T> {
    matrix: &'a [Vec<T>],
    /// Rates before the impact, with their round-off.
    measured: &'a [Measured<T>],
    touches: Vec<Touch<T>>,
    /// e γ of the contacts with Newton's law, with the rate γ before.
    returned: Vec<T>,
    /// Poisson's coefficient of restitution of each row, zero for those of other laws.
    expansion: Vec<T>,
}

/// Impulses of all rows, and rates after them.
struct StagedImpulses<T> {
    forces: Vec<T>,
    rates: Vec<T>,
}

impl<T: Real> StagedImpact<'_, T> {
    /// Impulses with the part given of all restitutions. The compression is an impact without Poisson's restitution; in
    /// the expansion, a contact pushes at least with e times its impulse Λ of the compression (Pfeiffer and Glocker,
    /// *Multibody Dynamics with Unilateral Contacts*, 1996, chapter 8).
    fn impulses(&self, part: T) -> Result<StagedImpulses<T>, NoForces> {
        let rates = self.measured.iter().zip(&self.returned);
        let rates = rates.map(|(measured, &returned)| measured.rate + part * returned).collect();
        let mut impulses = self.stage(rates, self.touches.clone())?;
        let mut touches = self.touches.clone();
        for touch in &mut touches {
            touch.least = touch.gap.map_or(touch.least, |k| part * self.expansion[k] * impulses.forces[k]);
        }
        if touches.iter().any(|touch| touch.least > T::constant(0.0)) {
            let expansion = self.stage(impulses.rates, touches)?;
            impulses.rates = expansion.rates;
            impulses.forces.iter_mut().zip(expansion.forces).for_each(|(sum, more)| *sum += more);
        }
        for (rate, &returned) in impulses.rates.iter_mut().zip(&self.returned) {
            *rate -= part * returned;
        }
        Ok(impulses)
    }

    fn stage(&self, rates: Vec<T>, touches: Vec<Touch<T>>) -> Result<StagedImpulses<T>, NoForces> {
        let noise = self.measured.iter().map(|measured| measured.noise[1]).collect();
        let outcome = Law { matrix: self.matrix, rates, noise, touches, accuracy: FOUND }.decide()?;
        Ok(StagedImpulses { forces: outcome.forces, rates: outcome.rates })
    }

    /// Impulses with the restitutions as stated, or lowered in proportion to where they gain no energy.
    fn without_gain(&self) -> Result<StagedImpulses<T>, NoForces> {
        let [mut low, mut high] = [0.0, 1.0].map(T::constant);
        let whole = self.impulses(high)?;
        if !self.gains(&whole) {
            return Ok(whole);
        }
        for _ in 0..HALVINGS {
            let part = (low + high) * T::constant(0.5);
            *if self.gains(&self.impulses(part)?) { &mut high } else { &mut low } = part;
        }
        self.impulses(low)
    }

    /// Whether the impulses work, by the mean of the rates before and after, more than their round-off.
    fn gains(&self, impulses: &StagedImpulses<T>) -> bool {
        let rows = self.measured.iter().zip(&impulses.rates).zip(&impulses.forces);
        let [sum, size] = rows.fold([T::constant(0.0); 2], |[sum, size], ((before, &after), &force)| {
            let work = force * (before.rate + after);
            [sum + work, size + Scalar::abs(work)]
        });
        sum > T::constant(T::EPSILON * BEGIN) * size
    }
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    /// An impact: the contacts that approach or rest push.
    pub(super) fn impact(
        &mut self,
        rows: &TouchingRows<L>,
        resting: &[bool],
        state: &mut StateOf<L>,
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<(), Error> {
        match L::FRICTIONS.is_empty() && !L::IMPACT_LAWS.contains(&ImpactLaw::Poisson) {
            true => self.impact_by_newton(rows, resting, state, transitions),
            false => self.impact_in_stages(rows, resting, state, transitions),
        }
    }

    /// An impact by Newton's law without friction, which never gains energy: each contact that pushes works by
    /// Λ (1 − e) γ/2 with its rate γ ≤ 0 before.
    fn impact_by_newton(
        &mut self,
        TouchingRows { touching, delassus: (matrix, responses), .. }: &TouchingRows<L>,
        resting: &[bool],
        state: &mut StateOf<L>,
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<(), Error> {
        let zero = L::Scalar::constant(0.0);
        let measured: Vec<Measured<L::Scalar>> = touching.iter().map(|&k| self.measured(k, state)).collect();
        // Those that part take part in the next impact, if this one makes them approach.
        let takes_part = |place: &usize| resting[*place] || measured[*place].rate < zero;
        let places: Vec<usize> = (0..touching.len()).filter(takes_part).collect();
        let mut returned = Vec::with_capacity(places.len());
        for &place in &places {
            let restitution = self.restitution(touching[place], state)?;
            returned.push(if resting[place] { zero } else { restitution * measured[place].rate });
        }
        let rates = |state: &StateOf<L>| {
            let of = |(&place, &returned): (&usize, &L::Scalar)| {
                self.measured(touching[place], state).rate + returned
            };
            places.iter().zip(&returned).map(of).collect::<Vec<_>>()
        };
        let problem = Complementarity {
            matrix: places.iter().map(|&j| places.iter().map(|&k| matrix[j][k]).collect()).collect(),
            noise: places.iter().map(|&place| measured[place].noise[1]).collect(),
            constant: rates(state),
        };
        let ComplementarySolution { z: mut impulses, is_active, .. } =
            problem.solve().ok_or_else(|| self.contradiction(touching, state))?;
        let push = |state: &mut StateOf<L>, impulses: &[L::Scalar]| {
            for (&place, &impulse) in places.iter().zip(impulses) {
                state.v = vector(Array::from_fn(|i| state.v[i] + responses[place][i] * impulse));
            }
        };
        push(state, &impulses);
        // What is left by the round-off of the matrix would take or give energy at each impact, always of one sign.
        let active: Vec<usize> = (0..places.len()).filter(|&place| is_active[place]).collect();
        let more = Complementarity { constant: rates(state), ..problem }.equality(&active);
        push(state, &more);
        impulses.iter_mut().zip(more).for_each(|(impulse, more)| *impulse += more);
        self.strikes(places.iter().zip(&impulses).map(|(&place, &impulse)| (impulse, &responses[place])));
        let pushes = places.iter().zip(&impulses).filter(|(_, impulse)| **impulse > zero);
        let impulses = pushes.map(|(&place, &impulse)| (self.name(touching[place]), impulse)).collect();
        transitions.push(Transition::Impact { time: state.t, impulses });
        Ok(())
    }

    /// An impact with friction or by Poisson's law. Newton's law can gain energy with friction (Kane and Levinson, *Dynamics*,
    /// 1985), and so can both laws in one impact: the restitutions are then lowered to where they gain none.
    fn impact_in_stages(
        &mut self,
        rows: &TouchingRows<L>,
        resting: &[bool],
        state: &mut StateOf<L>,
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) -> Result<(), Error> {
        let zero = L::Scalar::constant(0.0);
        let measured: Vec<_> = rows.all.iter().map(|&a| self.measured_at(a, state)).collect();
        let plays: Vec<bool> =
            (0..rows.touching.len()).map(|place| resting[place] || measured[place].rate < zero).collect();
        let (touches, names) = self.touches(rows, &plays, state, undecided::<L>)?;
        let [mut returned, mut expansion] = [0; 2].map(|_| vec![zero; rows.all.len()]);
        for place in (0..plays.len()).filter(|&place| plays[place]) {
            let restitution = self.restitution(rows.touching[place], state)?;
            match L::IMPACT_LAWS[rows.touching[place]] {
                ImpactLaw::Poisson => expansion[place] = restitution,
                ImpactLaw::Newton if !resting[place] => returned[place] = restitution * measured[place].rate,
                ImpactLaw::Newton => {}
            }
        }
        let hit =
            StagedImpact { matrix: &rows.delassus.0, measured: &measured, touches, returned, expansion };
        let StagedImpulses { forces, .. } =
            hit.without_gain().map_err(|why| self.jams(why, &names, state))?;
        for (&impulse, response) in forces.iter().zip(&rows.delassus.1) {
            state.v = vector(Array::from_fn(|i| state.v[i] + response[i] * impulse));
        }
        self.strikes(forces.iter().copied().zip(&rows.delassus.1));
        let acts =
            |&row: &usize| Scalar::abs(rows.delassus.0[row][row] * forces[row]) > measured[row].noise[1];
        let acting = (0..forces.len()).filter(acts);
        let impulses = acting.map(|row| (L::CONSTRAINTS[rows.all[row]], forces[row])).collect();
        transitions.push(Transition::Impact { time: state.t, impulses });
        Ok(())
    }
}

/// Friction of an impact, which is to be decided. Dry friction has no impulse.
fn undecided<L: Contacts>(f: usize) -> Option<Grip<L::Scalar>> {
    let FrictionRows { contact, count, .. } = L::FRICTIONS[f];
    contact.map(|_| if count == 1 { Grip::Open } else { Grip::Sticks })
}
