//! Contacts and friction: laws that hold while a constraint does, or instead of it.

use super::lowering::Lowering;
use super::parameters::{CONTACT, Entry, FRICTION, SwitchReading};
use super::problem::{ContactRow, FrictionRows};
use super::value::Value;
use crate::diagnostics::{Diagnostics, Place};
use crate::symbolic::{Id, Rational};
use crate::syntax::{Constraint, Expression, ImpactLaw, Law};
use crate::variables::{Variable, has_velocity};

impl Law {
    pub(crate) fn is_friction(&self) -> bool {
        matches!(self, Self::Coulomb { .. } | Self::Dry { .. })
    }
}

impl Lowering<'_> {
    /// Entry of the field that says whether this element of a family of constraints, up to the last one, holds; if there is one.
    pub(super) fn entry_of_state(
        &mut self,
        constraint: &Constraint,
        elements: [&[usize]; 2],
    ) -> Option<Entry> {
        let field = constraint.when.as_ref()?;
        let ty = match constraint.law {
            Law::Equation => "bool",
            Law::Contact { .. } => CONTACT,
            Law::Dry { .. } => FRICTION,
            // An error in the field has been reported with the contact.
            Law::Coulomb { .. } => {
                return self.parameters.switch((field, CONTACT), elements, &mut Diagnostics::default());
            }
        };
        self.parameters.switch((field, ty), elements, self.diagnostics)
    }

    /// Adds a contact.
    pub(super) fn contact(
        &mut self,
        (value, impact): (Option<&Expression>, ImpactLaw),
        (constraint, element): (&Constraint, &[usize]),
        row: usize,
        entry: Option<Entry>,
    ) {
        let restitution = self.with_indices(&constraint.target.indices, element, |lowering| {
            value.map_or(Some(Id::ZERO), |value| lowering.scalar(value))
        });
        if let (Some(number), Some(value)) = (restitution.and_then(|id| self.graph.as_number(id)), value)
            && (number < Rational::from(0) || number > Rational::from(1))
        {
            let message = "a coefficient of restitution is a number from 0, where the bodies stay together, to 1, where they lose no energy";
            self.diagnostics.error(value.place, message);
        }
        if let (Some(entry), Some(restitution)) = (entry, restitution) {
            self.contacts.push(ContactRow { row, entry, restitution, impact });
        }
    }

    pub(super) fn check_gap(&mut self, gap: &Value, place: Place) {
        if gap.as_scalar().is_none() {
            self.diagnostics.error(place, format!("a gap is a number, but this is {}", gap.shape()));
        }
        if has_velocity(&self.graph, &gap.flat()) {
            let message = "a gap is a distance, a function of the coordinates and the time: velocities have no place in it";
            self.diagnostics.error(place, message);
        }
    }

    /// Adds friction along a velocity, and its forces while it slides.
    pub(super) fn friction(
        &mut self,
        law: &Law,
        (constraint, element): (&Constraint, &[usize]),
        (velocity, row): (&Value, usize),
        entry: Option<Entry>,
        powers: &mut Vec<(Id, Id)>,
    ) {
        let is_right = self.check_velocity(velocity, constraint.left.place);
        let indices = &constraint.target.indices;
        let bounds = self.with_indices(indices, element, |lowering| lowering.bounds(law));
        let (Some(bounds), Some(entry), true) = (bounds, entry, is_right) else { return };
        let contact = self.contacts.iter().position(|contact| contact.entry == entry);
        let press = contact.map_or(Id::ONE, |contact| {
            self.graph.symbol(Variable::Multiplier(self.contacts[contact].row).symbol())
        });
        let coefficient = self.bound_in_force(bounds, entry);
        let force = self.graph.mul(coefficient, press);
        let against = self.graph.neg(force);
        let velocities = velocity.flat();
        let directions = self.directions(&velocities, entry);
        let sliding: Vec<Id> =
            directions.into_iter().map(|direction| self.graph.mul(against, direction)).collect();
        powers.extend(sliding.iter().copied().zip(velocities));
        self.frictions.push(FrictionRows { row, sliding, entry, contact, bounds });
    }

    /// The bound that acts: that of sliding while it slides, and that of sticking where a part of it is stated.
    fn bound_in_force(&mut self, [limit, sliding]: [Id; 2], entry: Entry) -> Id {
        if limit == sliding {
            return sliding;
        }
        let slides = self.read(entry, SwitchReading::Slides);
        let rests = self.graph.sub(Id::ONE, slides);
        let (sliding, limit) = (self.graph.mul(slides, sliding), self.graph.mul(rests, limit));
        self.graph.add(sliding, limit)
    }

    /// Coefficients or forces of sticking and sliding.
    fn bounds(&mut self, law: &Law) -> Option<[Id; 2]> {
        let (limit, sliding) = match law {
            Law::Coulomb { limit, sliding } | Law::Dry { limit, sliding } => (limit.as_ref(), sliding),
            _ => return None,
        };
        let of_sliding = self.scalar(sliding);
        let of_rest = limit.map_or(of_sliding, |limit| self.scalar(limit));
        let bounds = [of_rest?, of_sliding?];
        let [at_rest, slides] = bounds.map(|id| self.graph.as_number(id));
        let is_law = matches!(law, Law::Coulomb { .. });
        if slides.is_some_and(|number| number < Rational::from(0)) {
            let what = if is_law { "a coefficient" } else { "a force" };
            let message =
                format!("{what} of friction is not negative: it acts against the velocity by itself");
            self.diagnostics.error(sliding.place, message);
        } else if at_rest.zip(slides).is_some_and(|(at_rest, slides)| at_rest < slides) {
            let what = if is_law { "the static coefficient" } else { "the limit" };
            let message = format!("{what} is the larger one: friction that holds bears at least what slides");
            self.diagnostics.error(limit.unwrap_or(sliding).place, message);
        }
        Some(bounds)
    }

    /// Components of the direction in which friction slides, each zero while it does not. That of two velocities v is v/|v|,
    /// with the sign of v·d for the direction d of the state: it stays the same as v passes through zero, where the next
    /// state is decided, and is d at rest. It is d as well where the state states the force.
    fn directions(&mut self, velocities: &[Id], entry: Entry) -> Vec<Id> {
        let slip = self.read(entry, SwitchReading::Slip(0));
        if velocities.len() == 1 {
            return vec![slip];
        }
        let [sideways, slides] =
            [SwitchReading::Slip(1), SwitchReading::Slides].map(|reading| self.read(entry, reading));
        let direction = [slip, sideways];
        let start = [0, 1].map(|component| self.read(entry, SwitchReading::Start(component)));
        let started = velocities.iter().zip(start).map(|(&velocity, start)| self.graph.add(velocity, start));
        let velocities: Vec<Id> = started.collect();
        // Where v is perpendicular to d, the start decides the sign.
        let along = [&velocities[..], &start].map(|part| self.graph.dot(part, &direction));
        let along = self.graph.add(along[0], along[1]);
        // |v| |v·d| while it slides, and no zero below a root or a fraction while it does not.
        let rests = self.graph.sub(Id::ONE, slides);
        let sizes = [self.graph.dot(&velocities, &velocities), self.graph.mul(along, along)].map(|square| {
            let square = self.graph.add(square, rests);
            self.graph.sqrt(square)
        });
        let below = self.graph.mul(sizes[0], sizes[1]);
        let part = |(&velocity, &stated): (&Id, &Id)| {
            let above = self.graph.mul(velocity, along);
            let sliding = self.graph.div(above, below);
            let (sliding, stated) = (self.graph.mul(slides, sliding), self.graph.mul(rests, stated));
            self.graph.add(sliding, stated)
        };
        velocities.iter().zip(&direction).map(part).collect()
    }

    /// Node of a number that the state of a constraint stands for.
    pub(super) fn read(&mut self, entry: Entry, reading: SwitchReading) -> Id {
        let variable = self.parameters.reading(entry, reading);
        self.graph.symbol(variable.symbol())
    }

    fn check_velocity(&mut self, velocity: &Value, place: Place) -> bool {
        let velocities = velocity.flat();
        let is_short = velocity.as_scalar().is_some() || velocity.lengths() == [2];
        if !is_short {
            let shape = velocity.shape();
            let message = format!("friction acts along a velocity or a vector of two, but this is {shape}");
            self.diagnostics.error(place, message);
        } else if !has_velocity(&self.graph, &velocities) {
            let message = "no velocity occurs in this, so that there is nothing that friction could stop";
            self.diagnostics.error(place, message);
        } else {
            return true;
        }
        false
    }
}
