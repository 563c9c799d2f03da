//! Derivatives across an impact.

use alloc::vec::Vec;

use super::boundary::Boundary;
use super::change::{is_at_rest, terms};
use super::fails;
use super::law::NamedLaw;
use crate::contact::across::impulse_changes;
use crate::contact::{Contact, Contacts, Friction, FrictionRows, ImpactLaw};
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::sensitivity::state::{StateSensitivity, impact_sensitivity};
use crate::names::name;
use crate::number::{Real, Scalar, largest, power_of_epsilon};
use crate::system::{StateOf, System};
use crate::trajectory::Leg;
use crate::vector::Entrywise;

/// An impact on one contact, at the end of a leg.
pub(super) struct Hit<L> {
    /// Index of the contact.
    contact: usize,
    /// The system with the contacts closed that push, and with their friction as the impulses of it say.
    pushing: L,
}

/// Names and impulses of an impact.
type Impulses<L> = [(&'static str, <L as System>::Scalar)];

impl<L: Linearized<Scalar: Real> + Contacts + Clone> Hit<L> {
    pub(super) fn of(leg: &Leg<L>, impulses: &Impulses<L>, after: &StateOf<L>) -> Result<Self, Error> {
        let mut pushing = leg.system().clone();
        let mut hits = Vec::new();
        for k in 0..L::CONTACTS.len() {
            let pushes = impulses.iter().any(|&(contact, _)| contact == Self::name(k));
            if pushes && leg.system().contact(k) == Some(Contact::Open) {
                hits.push(k);
            }
            pushing.set_contact(k, if pushes { Contact::Closed } else { Contact::Open });
        }
        match hits[..] {
            [contact] if Boundary::of(leg) == Some(Boundary::Gap(contact)) => {
                let mut hit = Self { contact, pushing };
                hit.rub(leg.last(), impulses, after)?;
                hit.check_poisson(after)?;
                Ok(hit)
            }
            _ => {
                let reason = "several contacts are hit at one time, whose order the arguments may change";
                fails(hits.first().map_or("", |&k| Self::name(k)), after.t, reason)
            }
        }
    }

    fn name(contact: usize) -> &'static str {
        name(L::CONSTRAINTS, L::CONTACTS[contact])
    }

    /// Lets friction stick or slide as in the impact. Dry friction has no impulse.
    fn rub(&mut self, before: &StateOf<L>, impulses: &Impulses<L>, after: &StateOf<L>) -> Result<(), Error> {
        for f in 0..L::FRICTIONS.len() {
            let grip = match L::FRICTIONS[f].contact {
                None => Friction::Slides([0.0; 2]),
                Some(k) if self.pushing.contact(k) == Some(Contact::Open) => continue,
                Some(_) => self.grip(f, [before, after], impulses)?,
            };
            self.pushing.set_friction(f, grip);
        }
        Ok(())
    }

    /// Whether friction sticks in the impact: its impulse is below the limit, and its velocity zero afterwards.
    fn grip(
        &self,
        f: usize,
        [before, after]: [&StateOf<L>; 2],
        impulses: &Impulses<L>,
    ) -> Result<Friction, Error> {
        let friction @ FrictionRows { row, count, contact, .. } = L::FRICTIONS[f];
        let (zero, one) = (L::Scalar::constant(0.0), L::Scalar::constant(1.0));
        let of = |a: usize| impulse_of(impulses, L::CONSTRAINTS[a]);
        let limit = self.pushing.friction_limit(f, before).unwrap_or(zero);
        let limit = limit * contact.map_or(zero, |k| of(L::CONTACTS[k]));
        let is_at_limit = friction.size(of) >= limit * (one - power_of_epsilon::<L::Scalar>(0.5));
        let fails = |reason| fails(L::CONSTRAINTS[row], after.t, reason);
        let rate = self.pushing.constraint_rate(after)[row];
        let is_round_off = |a| self.is_still(a, impulses, [before, after]);
        let is_still = friction.rows().map(is_round_off).collect::<Result<Vec<_>, _>>()?;
        let rests = is_at_rest(&self.pushing, f, [before, after]) || is_still.into_iter().all(|still| still);
        match (is_at_limit, rests) {
            (false, true) => Ok(Friction::Sticks),
            (true, true) => {
                fails("its impulse is at the limit, and the arguments decide whether the bodies slide")
            }
            (_, false) if count == 2 => fails("the direction in which the bodies slide turns in the impact"),
            (_, false) => Ok(Friction::Slides([if rate < zero { -1.0 } else { 1.0 }, 0.0])),
        }
    }

    /// Fails where a contact obeys Poisson's law and another one pushes, or its own friction sticks. If it alone pushes, and slides
    /// or has no friction, expansion repeats e times the impulses of compression, as by Newton's law, and so it does in
    /// neighbouring impacts.
    fn check_poisson(&self, after: &StateOf<L>) -> Result<(), Error> {
        let pushes = |k: &usize| self.pushing.contact(*k) != Some(Contact::Open);
        let pushing: Vec<usize> = (0..L::CONTACTS.len()).filter(pushes).collect();
        let Some(&k) = pushing.iter().find(|&&k| L::IMPACT_LAWS[k] == ImpactLaw::Poisson) else {
            return Ok(());
        };
        let sticks = |f: usize| {
            L::FRICTIONS[f].contact == Some(k) && self.pushing.friction(f) == Some(Friction::Sticks)
        };
        let reason = match pushing.len() {
            1 if (0..L::FRICTIONS.len()).any(sticks) => {
                "its friction sticks in an impact by Poisson's law; state `restitution: e` for Newton's"
            }
            1 => return Ok(()),
            _ => "several contacts push in an impact by Poisson's law; state `restitution: e` for Newton's",
        };
        fails(Self::name(k), after.t, reason)
    }

    /// Derivatives after the impact, from those at a fixed time before it.
    pub(super) fn after(
        &self,
        leg: &Leg<L>,
        at: StateSensitivity<L::Scalar, L::N>,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        let at = Boundary::Gap(self.contact).reach(leg, at)?;
        let law = NamedLaw {
            name: Self::name(self.contact),
            value: &|system: &L, state: &StateOf<L>| system.restitution(self.contact, state),
        };
        let slopes = (0..at.arguments().len())
            .map(|j| law.change(&self.pushing, &at.by(j)))
            .collect::<Result<Vec<_>, Error>>()?;
        let restitution = law.at(&self.pushing, &at.state);
        impact_sensitivity(&self.pushing, &at, L::CONTACTS[self.contact], (restitution, &|j| slopes[j]))
    }

    /// Fails if a contact at rest has no impulse and stays at rest, both to √ε, unless the derivatives are the same whether it
    /// pushes or not.
    pub(super) fn check_idle(
        &self,
        leg: &Leg<L>,
        impulses: &Impulses<L>,
        [at, after]: [&StateSensitivity<L::Scalar, L::N>; 2],
    ) -> Result<(), Error> {
        let unit = power_of_epsilon::<L::Scalar>(0.5);
        let all: Vec<L::Scalar> = impulses.iter().map(|&(_, impulse)| impulse).collect();
        let rests = |&k: &usize| leg.system().contact(k) != Some(Contact::Open);
        for k in (0..L::CONTACTS.len()).filter(rests) {
            let (mut other, impulse) = (self.pushing.clone(), impulse_of(impulses, Self::name(k)));
            let pushes = self.pushing.contact(k) != Some(Contact::Open);
            other.set_contact(k, Contact::Closed);
            let [before, now] = [&at.state, &after.state];
            let closed = Self { contact: self.contact, pushing: other.clone() };
            if impulse > unit * largest(&all) || !closed.is_still(L::CONTACTS[k], impulses, [before, now])? {
                continue;
            }
            other.set_contact(k, if pushes { Contact::Open } else { Contact::Closed });
            let other = Self { contact: self.contact, pushing: other }.after(leg, at.clone())?;
            let [one, other] = [&after.v, &other.v];
            if largest((one - other).as_slice()) > unit * largest(one.as_slice()) {
                let reason = "it neither pushes nor parts in the impact, and the arguments decide which";
                return fails(Self::name(k), now.t, reason);
            }
        }
        Ok(())
    }

    /// Whether the rate of a constraint is zero after the impact: below √ε of its terms before and after, and of what the impulses
    /// change it by.
    fn is_still(
        &self,
        row: usize,
        impulses: &Impulses<L>,
        [before, after]: [&StateOf<L>; 2],
    ) -> Result<bool, Error> {
        let of_rows = impulses.iter().filter_map(|&(name, impulse)| {
            Some((L::CONSTRAINTS.iter().position(|&constraint| constraint == name)?, impulse))
        });
        let changes = impulse_changes(&self.pushing, row, &of_rows.collect::<Vec<_>>(), before)?;
        let [one, other] = [before, after].map(|state| terms(&self.pushing, row..row + 1, state, &state.v));
        let rate = Scalar::abs(self.pushing.constraint_rate(after)[row]);
        Ok(rate <= power_of_epsilon::<L::Scalar>(0.5) * (one + other + changes))
    }

    /// Fails if the velocities after the impact are not those of the motion.
    pub(super) fn check(&self, found: &StateOf<L>, expected: &StateOf<L>) -> Result<(), Error> {
        let off = largest(found.v.minus(&expected.v).as_slice());
        if off <= power_of_epsilon::<L::Scalar>(0.5) * largest(expected.v.as_slice()) {
            return Ok(());
        }
        let rate = |state| self.pushing.constraint_rate(state)[L::CONTACTS[self.contact]];
        let reason = match rate(expected) < rate(found) {
            true => "the restitution is lowered there to where friction gains no energy",
            false => "contacts part or press at a rate of zero there, and the arguments decide which",
        };
        fails(Self::name(self.contact), expected.t, reason)
    }
}

/// Impulse of this name, or zero.
fn impulse_of<T: Real>(impulses: &[(&'static str, T)], name: &str) -> T {
    let found = impulses.iter().find(|&&(of, _)| of == name);
    found.map_or(T::constant(0.0), |&(_, impulse)| impulse)
}
