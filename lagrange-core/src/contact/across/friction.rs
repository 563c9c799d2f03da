//! What happens at one instant to bodies with friction: which contacts push, stick and slide from then on.

use alloc::vec::Vec;
use core::ops::Range;

use super::Transition;
use super::bodies::Bodies;
use super::grip::Gripped;
use super::reactions::NoForces;
use super::rows::TouchingRows;
use super::states::{LegFriction, LegStates};
use super::{Contacts, Friction, FrictionRows};
use crate::error::Error;
use crate::number::limits::ACCUMULATED;
use crate::number::{Real, Scalar, larger};
use crate::numerics::bare;
use crate::system::StateOf;

/// Length of a vector in a plane.
fn length<T: Real>([x, y]: [T; 2]) -> T {
    Scalar::sqrt(x * x + y * y)
}

impl FrictionRows {
    /// Indices of its velocities among the constraints.
    pub(crate) fn rows(&self) -> Range<usize> {
        self.row..self.row + self.count
    }

    /// Size of a velocity or force with these components.
    pub(crate) fn size<T: Real>(&self, component: impl Fn(usize) -> T) -> T {
        match self.count {
            1 => Scalar::abs(component(self.row)),
            _ => length([component(self.row), component(self.row + 1)]),
        }
    }
}

/// Limit and sliding force of friction.
pub(super) fn bounds<L: Contacts<Scalar: Real>>(
    system: &L,
    f: usize,
    state: &StateOf<L>,
) -> Result<[L::Scalar; 2], Error> {
    let zero = L::Scalar::constant(0.0);
    let [limit, sliding] = [system.friction_limit(f, state), system.sliding_friction(f, state)]
        .map(|bound| bound.unwrap_or(zero));
    if sliding >= zero && sliding <= limit && limit.to_f64().is_finite() {
        return Ok([limit, sliding]);
    }
    let (friction, time) = (L::CONSTRAINTS[L::FRICTIONS[f].row], state.t.to_f64());
    Err(Error::Friction { friction, bounds: [limit, sliding].map(Real::to_f64), time })
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    /// Velocity of friction, its size, and the error of that.
    fn sliding(&self, f: usize, state: &StateOf<L>) -> ([L::Scalar; 2], [L::Scalar; 2]) {
        let mut velocity = [L::Scalar::constant(0.0); 2];
        let mut noise = velocity[0];
        for (component, a) in L::FRICTIONS[f].rows().enumerate() {
            let measured = self.measured_at(a, state);
            (velocity[component], noise) = (measured.rate, larger(noise, measured.noise[1]));
        }
        let noise = self.sliding_error(L::FRICTIONS[f].count, noise);
        (velocity, [length(velocity), noise])
    }

    /// Direction in which bodies slide; `None` if they are at rest but for so many units of round-off, or slower than the least speed.
    pub(super) fn slip(
        &self,
        f: usize,
        state: &StateOf<L>,
        [units, least]: [f64; 2],
    ) -> Option<[L::Scalar; 2]> {
        let (velocity, [speed, noise]) = self.sliding(f, state);
        let slides = speed > L::Scalar::constant(units) * noise && speed.to_f64() > least;
        slides.then(|| velocity.map(|component| component / speed))
    }

    /// Speed of a friction that its limit stops within the round-off of the time, with the accelerations of gaps towards one another.
    pub(super) fn least_slip(
        &self,
        (rows, pressing): (&TouchingRows<L>, &[f64]),
        (f, place): (usize, usize),
        limit: f64,
        state: &StateOf<L>,
    ) -> f64 {
        let gap = L::FRICTIONS[f].contact.map(|k| rows.gap(k));
        let press =
            gap.map_or(1.0, |gap| gap.map_or(0.0, |gap| pressing[gap].abs() / rows.response(gap, gap)));
        self.time_unit(state) * limit * press * rows.response(place, place)
    }

    /// Round-off of the time.
    fn time_unit(&self, state: &StateOf<L>) -> f64 {
        L::Scalar::EPSILON * f64::max(state.t.to_f64().abs(), self.span.to_f64())
    }

    /// Whether bodies are at rest where their velocity along the direction of sliding has become zero. That of one velocity is
    /// the whole; that of two may have turned.
    pub(super) fn is_stopped(&self, f: usize, state: &StateOf<L>) -> bool {
        let (_, [speed, noise]) = self.sliding(f, state);
        L::FRICTIONS[f].count == 1 || speed <= L::Scalar::constant(ACCUMULATED) * noise
    }

    /// No forces are known that satisfy the laws of the touching contacts that play.
    pub(super) fn jams(
        &self,
        why: NoForces,
        (rows, plays): (&TouchingRows<L>, &[bool]),
        state: &StateOf<L>,
    ) -> Error {
        let playing = || rows.touching.iter().zip(plays).filter(|(_, plays)| **plays).map(|(&k, _)| k);
        let rubs = |f: &usize| L::FRICTIONS[*f].contact.is_none_or(|k| playing().any(|of| of == k));
        let Some(f) = rows.frictions.iter().map(|&(f, _)| f).find(rubs) else {
            return self.contradiction(&playing().collect::<Vec<_>>(), state);
        };
        let (friction, time) = (L::CONSTRAINTS[L::FRICTIONS[f].row], state.t.to_f64());
        match why {
            NoForces::Jammed => Error::FrictionJams { friction, time },
            NoForces::Undecided => Error::FrictionUndecided { friction, time },
        }
    }

    /// Whether a velocity is against the direction in which it slides: what was left of the rates of contacts at rest has turned it.
    pub(super) fn slides_back(&self, states: &LegStates, state: &StateOf<L>) -> bool {
        (0..L::FRICTIONS.len()).any(|f| {
            let LegFriction { friction: Friction::Slides(direction), is_implied: false, .. } =
                states.frictions[f]
            else {
                return false;
            };
            let (velocity, [_, noise]) = self.sliding(f, state);
            let along = |c: usize| L::Scalar::constant(direction[c]) * velocity[c];
            along(0) + along(1) < -noise
        })
    }

    /// Velocities with which bodies begin to slide: zero along one; along two, which have no direction at rest, a multiple of their
    /// accelerations, as those of one body go together.
    pub(super) fn starts(
        &self,
        rows: &TouchingRows<L>,
        (states, gripped): (&LegStates, &Gripped),
        state: &StateOf<L>,
    ) -> Vec<(usize, f64)> {
        let begins = |&&(f, _): &&(usize, usize)| {
            let LegFriction { friction, from_rest, is_implied } = states.frictions[f];
            let slides = matches!(friction, Friction::Slides(along) if along != [0.0; 2]);
            from_rest && !is_implied && slides
        };
        let begun = |count: usize| {
            let begun =
                rows.frictions.iter().filter(begins).filter(move |&&(f, _)| L::FRICTIONS[f].count == count);
            begun.map(|&(_, place)| place)
        };
        let time = begun(2).fold(0.0_f64, |time, place| {
            let both = [place, place + 1];
            let changes = both.map(|row| (rows.response(row, row) * gripped.forces[row]).abs());
            let (speed, acceleration) = (
                self.start(both.map(|row| rows.all[row]), changes, state),
                bare::length(both.map(|row| gripped.rates[row])),
            );
            if acceleration > 0.0 { time.max(speed / acceleration) } else { time }
        });
        let along_two =
            begun(2).flat_map(|place| [place, place + 1]).map(|row| (row, gripped.rates[row] * time));
        along_two.chain(begun(1).map(|row| (row, 0.0))).collect()
    }

    /// Speed with which bodies begin to slide along two velocities: its error, and its change by the force of friction within the round-off
    /// of the time.
    fn start(&self, rows: [usize; 2], changes: [f64; 2], state: &StateOf<L>) -> f64 {
        let unit = self.time_unit(state);
        let [x, y] = rows.map(|a| self.sliding_error(2, self.measured_at(a, state).noise[1]).to_f64());
        ACCUMULATED * (x.max(y) + unit * changes[0].max(changes[1]))
    }

    /// Reports the friction that begins to stick or to slide, or slides back, while its contact stays closed.
    pub(super) fn report_friction(
        &self,
        was: &LegStates,
        is: &LegStates,
        state: &StateOf<L>,
        transitions: &mut Vec<Transition<L::Scalar>>,
    ) {
        // At the start of a motion there are none before.
        for (f, was_friction) in was.frictions.iter().enumerate() {
            let FrictionRows { row, count, .. } = L::FRICTIONS[f];
            let (friction, time) = (L::CONSTRAINTS[row], state.t);
            if !is.is_pressed::<L>(f) || !was.is_pressed::<L>(f) {
                continue;
            }
            match (was_friction.friction, is.frictions[f].friction) {
                // It has had no force.
                (Friction::Slides([0.0, 0.0]), is) if is.is_at_rest() => {}
                (Friction::Slides(_), is) if is.is_at_rest() => {
                    transitions.push(Transition::Sticks { friction, time });
                }
                (was, Friction::Slides(_)) if was.is_at_rest() => {
                    transitions.push(Transition::Slips { friction, time });
                }
                (Friction::Slides([was, _]), Friction::Slides([is, _])) if count == 1 && was * is < 0.0 => {
                    transitions.push(Transition::Reverses { friction, time });
                }
                _ => {}
            }
        }
    }
}
