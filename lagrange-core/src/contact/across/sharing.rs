//! Forces of friction that several contacts share: they are not unique, but the motion is.

use alloc::vec::Vec;

use super::grip::{Decision, Gripped};
use super::states::LegStates;
use super::{Contacts, Friction};
use crate::cone::ACCURACY;
use crate::number::Real;
use crate::numerics::bare::length;

/// Friction at rest.
struct RestingFriction {
    f: usize,
    place: usize,
    slides: bool,
    limit: f64,
    /// What is left of its limit.
    slack: f64,
}

impl<L: Contacts<Scalar: Real> + Clone> Decision<'_, L> {
    /// Whether rows that stay at rest depend on one another, those of friction among them.
    pub(super) fn is_shared(&self, gripped: &Gripped) -> bool {
        let gaps = (0..gripped.pushes.len()).filter(|&gap| gripped.pushes[gap]);
        let mut span = self.rows.span(gaps.collect::<Vec<_>>());
        let resting = self.rows.frictions.iter().filter(|(f, _)| gripped.grips[*f] == Some(Friction::Sticks));
        let mut rows = resting.flat_map(|&(f, place)| place..place + L::FRICTIONS[f].count);
        rows.any(|row| !span.add(row))
    }

    /// Lets friction at rest whose velocity depends on others at rest act with the part of its limit that was found:
    /// the rows that are left are independent, and their forces unique. Those that are furthest from their limits are left.
    pub(super) fn share(&self, gripped: &Gripped, states: &mut LegStates) {
        let gaps = (0..self.rows.touching.len()).filter(|&place| states.is_closed(self.rows.touching[place]));
        let mut span = self.rows.span(gaps.collect::<Vec<_>>());
        for RestingFriction { f, place, slides, limit, .. } in self.at_rest(gripped, states) {
            let (count, before) = (L::FRICTIONS[f].count, span.size());
            let mut parts = [Some(0.0); 2];
            for (row, part) in (place..place + count).zip(&mut parts) {
                let ratio = gripped.forces[row] / limit;
                let shared = Some(if ratio.is_finite() { ratio } else { 0.0 });
                *part = if span.add(row) { None } else { shared };
            }
            let kept = span.size() - before;
            match (slides, kept) {
                // It begins to slide, unless the others keep it at rest.
                (true, 1..) => span.truncate(before),
                (true, 0) if self.is_driven(place, gripped) => {}
                (_, kept) if kept == count => states.frictions[f].friction = Friction::Sticks,
                _ => states.frictions[f].friction = Friction::Shares(parts),
            }
            states.frictions[f].is_implied = kept == 0 && states.frictions[f].friction.is_at_rest();
        }
    }

    /// Whether a velocity changes by more than what forces are known to, although it is that of others at rest: at this instant alone, as
    /// that of a slider at its dead centre. All forces leave round-off along it, |J x| ≤ |J| |x|, even where none has a part along it.
    fn is_driven(&self, place: usize, gripped: &Gripped) -> bool {
        let terms = self.pressing.0[place].abs() + self.rows.size(place, &gripped.forces);
        let all = gripped.forces.iter().enumerate().map(|(of, force)| force.abs() * self.rows.length(of));
        let round_off = L::Scalar::EPSILON * self.rows.length(place) * all.sum::<f64>();
        gripped.rates[place].abs() > ACCURACY * terms + round_off
    }

    /// Friction at rest, that which sticks first, in the order of what is left of its limit.
    fn at_rest(&self, gripped: &Gripped, states: &LegStates) -> Vec<RestingFriction> {
        let of = |&(f, place): &(usize, usize)| {
            if self.slips[f].is_some() || !states.is_pressed::<L>(f) {
                return None;
            }
            let gap = L::FRICTIONS[f].contact.and_then(|k| self.rows.gap(k));
            let press = gap.map_or(1.0, |gap| gripped.forces[gap]);
            let limit = self.bounds[f][0] * press;
            let force = |c: usize| if c < L::FRICTIONS[f].count { gripped.forces[place + c] } else { 0.0 };
            let slack = limit - length([force(0), force(1)]);
            let slides = matches!(gripped.grips[f], Some(Friction::Slides(_)));
            Some(RestingFriction { f, place, slides, limit, slack })
        };
        let mut resting: Vec<_> = self.rows.frictions.iter().filter_map(of).collect();
        resting.sort_by(|one, other| one.slides.cmp(&other.slides).then(other.slack.total_cmp(&one.slack)));
        resting
    }
}
