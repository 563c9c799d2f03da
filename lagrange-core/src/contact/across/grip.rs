//! A decision at one instant: which of the contacts at rest push, and which friction sticks.

use alloc::vec;
use alloc::vec::Vec;

use super::bodies::Bodies;
use super::friction::bounds;
use super::instant::LegEnd;
use super::rows::TouchingRows;
use super::states::{LegContact, LegFriction, LegStates};
use super::{Contacts, Friction};
use crate::cone::ACCURACY;
use crate::error::Error;
use crate::number::Real;
use crate::number::limits::ACCUMULATED;
use crate::number::limits::HALF_THE_DIGITS;
use crate::system::StateOf;
use crate::vector::StaticLength;

/// Halvings up to which is known what is left of the limits of friction: the bits of the accuracy of forces.
const HALVINGS: u32 = ((1.0 / ACCURACY) as u64).ilog2();

/// 1 after so many halvings.
fn halved(halvings: u32) -> f64 {
    (0..halvings).fold(1.0, |part, _| 0.5 * part)
}

/// A decision under way.
pub(super) struct Decision<'a, L: Contacts<Scalar: Real>> {
    pub(super) bodies: &'a Bodies<L>,
    pub(super) rows: &'a TouchingRows<L>,
    /// Rates of the rows without forces, and their round-off.
    pub(super) pressing: &'a (Vec<f64>, Vec<f64>),
    /// Limit and sliding force of each friction.
    pub(super) bounds: Vec<[f64; 2]>,
    /// The states before, and what ended them.
    pub(super) was: &'a LegStates,
    end: Option<LegEnd>,
    /// Which of the touching contacts are at rest.
    pub(super) resting: Vec<bool>,
    /// Direction in which each friction slides; none if it is at rest.
    pub(super) slips: Vec<Option<[f64; 2]>>,
    /// Friction that has fallen from its limit to a smaller force of sliding, with its direction.
    fallen: Vec<(usize, [f64; 2])>,
    /// Friction that has fallen, but is held back.
    held: Vec<usize>,
    /// Part of the limits of friction at rest that may be used: less than 1 where friction has left them, on the contacts that carry the
    /// bodies then.
    part: f64,
    pub(super) carries: Option<Vec<bool>>,
}

/// Forces that satisfy the law.
pub(super) struct Gripped {
    pub(super) forces: Vec<f64>,
    pub(super) rates: Vec<f64>,
    /// Whether each touching contact stays closed.
    pub(super) pushes: Vec<bool>,
    /// What each friction does, if it acts.
    pub(super) grips: Vec<Option<Friction>>,
    /// Which of the touching contacts may push, without those that others make needless.
    pub(super) carries: Vec<bool>,
}

impl<'a, L: Contacts<Scalar: Real> + Clone> Decision<'a, L> {
    pub(super) fn new(
        bodies: &'a Bodies<L>,
        (rows, pressing): (&'a TouchingRows<L>, &'a (Vec<f64>, Vec<f64>)),
        resting: Vec<bool>,
        state: &StateOf<L>,
        (was, end): (&'a LegStates, Option<LegEnd>),
    ) -> Result<Self, Error> {
        // What has the same velocity as another friction stops with it.
        let units = if matches!(end, Some(LegEnd::Stops(_))) { ACCUMULATED } else { 1.0 };
        let is_at_rest = |f| end == Some(LegEnd::Stops(f)) || (end.is_some() && was.is_at_rest::<L>(f));
        let mut of_friction = vec![[0.0; 2]; L::FRICTIONS.len()];
        let mut least = vec![0.0; L::FRICTIONS.len()];
        for &(f, place) in &rows.frictions {
            of_friction[f] = bounds(&bodies.closed, f, state)?.map(Real::to_f64);
            least[f] = bodies.least_slip((rows, &pressing.0), (f, place), of_friction[f][0], state);
        }
        let slip = |f: usize| if is_at_rest(f) { None } else { bodies.slip(f, state, [units, least[f]]) };
        let slips = (0..L::FRICTIONS.len()).map(|f| slip(f).map(|along| along.map(Real::to_f64))).collect();
        let (bounds, fallen, held, part, carries) = (of_friction, Vec::new(), Vec::new(), 1.0, None);
        Ok(Self { bodies, rows, pressing, bounds, was, end, resting, slips, fallen, held, part, carries })
    }

    /// Finds forces after which nothing else comes to rest or begins to slide.
    pub(super) fn settle(&mut self, state: &StateOf<L>) -> Result<Gripped, Error> {
        if self.end == Some(LegEnd::Leaves) {
            self.leave(state)?;
        }
        loop {
            let gripped = self.with_reserve(self.forces(self.part, state)?, state);
            if !self.joins(&gripped, state) && !self.is_held(&gripped) && !self.falls(&gripped) {
                return Ok(gripped);
            }
        }
    }

    /// Lets friction slide that does so with limits that are lower by half of the digits, on the contacts that push then: the direction of
    /// sliding is off by that, and by round-off divided by it.
    fn leave(&mut self, state: &StateOf<L>) -> Result<(), Error> {
        let gripped = self.forces(1.0 - halved(HALVINGS), state)?;
        if !self.rests(&gripped) {
            (self.part, self.carries) = (1.0 - HALF_THE_DIGITS, Some(gripped.carries));
        }
        Ok(())
    }

    /// Where friction at rest shares its forces, those with the largest part of all limits left, but for a factor of 2: they last longest as
    /// loads grow.
    fn with_reserve(&self, gripped: Gripped, state: &StateOf<L>) -> Gripped {
        if !self.rests(&gripped) || !self.is_shared(&gripped) {
            return gripped;
        }
        let mut rests = gripped;
        // Halvings with which friction is known to slide, and to rest.
        let [mut low, mut high] = [0, HALVINGS + 1];
        while low + 1 < high {
            let halvings = (low + high) / 2;
            match self.forces(1.0 - halved(halvings), state) {
                Ok(found) if self.rests(&found) => (high, rests) = (halvings, found),
                _ => low = halvings,
            }
        }
        rests
    }

    /// Which of the touching contacts may push.
    pub(super) fn plays(&self) -> Vec<bool> {
        let touching = self.rows.touching.iter().zip(&self.resting);
        touching.map(|(&k, &rests)| rests && self.end != Some(LegEnd::Opens(k))).collect()
    }

    /// Whether a contact has ceased to push.
    pub(super) fn opens(&self) -> bool {
        matches!(self.end, Some(LegEnd::Opens(_)))
    }

    /// What is known of the friction `f`: the direction in which it slides, if it does.
    pub(super) fn direction(&self, f: usize) -> Option<[f64; 2]> {
        let fallen = self.fallen.iter().find(|(of, _)| *of == f).map(|(_, direction)| *direction);
        fallen.or(self.slips[f])
    }

    /// Direction in which a friction at rest begins to slide.
    fn begins(&self, f: usize, gripped: &Gripped) -> Option<[f64; 2]> {
        match (gripped.grips[f], self.direction(f)) {
            (Some(Friction::Slides(direction)), None) => Some(direction),
            _ => None,
        }
    }

    /// Whether nothing begins to slide.
    pub(super) fn rests(&self, gripped: &Gripped) -> bool {
        (0..L::FRICTIONS.len()).all(|f| self.begins(f, gripped).is_none())
    }

    /// Round-off of the rate of a row with these forces.
    pub(super) fn noise(&self, place: usize, forces: &[f64]) -> f64 {
        self.pressing.1[place] + L::Scalar::EPSILON * ACCUMULATED * self.rows.size(place, forces)
    }

    /// Whether the forces press another contact together, whose bounces are then low: it counts as at rest from now on.
    fn joins(&mut self, gripped: &Gripped, state: &StateOf<L>) -> bool {
        let noise = self.rows.motion_noise(state);
        let joins = |&place: &usize| {
            let rate = [gripped.rates[place], noise[place]];
            !self.resting[place] && self.bodies.rests(self.rows.touching[place], rate, state)
        };
        let joining = (0..self.resting.len()).find(joins);
        if let Some(place) = joining {
            (self.resting[place], self.carries) = (true, None);
        }
        joining.is_some()
    }

    /// Whether another friction begins to slide with a force below its limit.
    fn falls(&mut self, gripped: &Gripped) -> bool {
        let falls = |f: &usize| self.bounds[*f][1] < self.bounds[*f][0];
        let begins = |f: usize| self.begins(f, gripped).map(|direction| (f, direction));
        let fallen = (0..L::FRICTIONS.len()).filter(falls).find_map(begins);
        self.fallen.extend(fallen);
        fallen.is_some()
    }

    /// Whether friction that has fallen would slide back: its force is then decided anew.
    fn is_held(&mut self, gripped: &Gripped) -> bool {
        let is_back = |&(f, direction): &(usize, [f64; 2])| {
            let Some(&(_, place)) = self.rows.frictions.iter().find(|(of, _)| *of == f) else { return false };
            let [along, noise] = (0..L::FRICTIONS[f].count).fold([0.0; 2], |[sum, noise], c| {
                let round_off = self.noise(place + c, &gripped.forces);
                [sum + direction[c] * gripped.rates[place + c], noise + direction[c].abs() * round_off]
            });
            along < -noise
        };
        let held = self.fallen.iter().position(|fallen| !self.held.contains(&fallen.0) && is_back(fallen));
        held.map(|k| self.held.push(self.fallen.remove(k).0)).is_some()
    }

    /// LegStates of contacts and friction from here on.
    pub(super) fn states(&self, gripped: &Gripped) -> LegStates {
        let mut states = LegStates::closed::<L>(|k| self.rows.gap(k).is_some_and(|gap| gripped.pushes[gap]));
        for &(f, _) in &self.rows.frictions {
            let friction = gripped.grips[f].unwrap_or(LegFriction::OFF.friction);
            states.frictions[f] =
                LegFriction { friction, from_rest: self.slips[f].is_none(), is_implied: false };
        }
        self.share(gripped, &mut states);
        let (span, plays) = (self.rows.span(self.rows.active(&states)), self.plays());
        for (place, &k) in self.rows.touching.iter().enumerate() {
            let LegContact { is_closed, .. } = states.contacts[k];
            let is_still = gripped.rates[place].abs() <= self.noise(place, &gripped.forces);
            let is_implied = plays[place] && !is_closed && is_still && span.depends(place);
            // A contact that parts ever faster is watched as one that rests, since it may start below zero by its round-off. So is one whose
            // multiplier has just become zero, as its gap begins to open without an acceleration.
            let is_resting = self.resting[place] || gripped.rates[place] >= 0.0;
            states.contacts[k] = LegContact { is_closed, is_implied, is_resting };
        }
        states
    }

    /// Acceleration towards each closed contact without its own forces, while the others that are closed stay so.
    pub(super) fn towards(&self, gripped: &Gripped, states: &LegStates) -> Vec<f64> {
        let (mut towards, active) = (vec![0.0; L::CONTACTS.len()], self.rows.active(states));
        for (place, &k) in self.rows.touching.iter().enumerate().filter(|(_, k)| states.is_closed(**k)) {
            let of_friction =
                self.rows.frictions.iter().filter(|&&(f, _)| L::FRICTIONS[f].contact == Some(k));
            let of_friction = of_friction.flat_map(|&(f, first)| first..first + L::FRICTIONS[f].count);
            let own: Vec<usize> = of_friction.chain([place]).collect();
            let mut by = vec![0.0; <L::N>::COUNT];
            for &of in &own {
                by.iter_mut().zip(self.rows.row(of)).for_each(|(x, j)| *x += gripped.forces[of] * j);
            }
            let others = active.iter().copied().filter(|of| !own.contains(of));
            let by = self.rows.span(others).rest(by);
            towards[k] = by.iter().zip(self.rows.row(place)).map(|(x, j)| x * j).sum();
        }
        towards
    }
}
