//! A motion across contacts: its legs and its transitions.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

use super::driver::Ended;
use super::legs::AllLegs;
use super::{Contact, Contacts};
use crate::error::{Ending, Error};
use crate::names::name;
use crate::number::{Real, Scalar};
use crate::solution::Sample;
use crate::solution::crossing::Crossing;
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State, StateOf};
use crate::trajectory::{Csv, Drift, Tabulated, Trajectory, between};
use crate::vector::{Array, vector};

/// A change of contacts, or an impact.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Transition<T> {
    /// Gaps close at a rate, and velocities jump.
    Impact {
        /// Time of the impact.
        time: T,
        /// The contacts that push, and their friction, with their impulses Λ: momenta jump by WᵀΛ.
        impulses: Vec<(&'static str, T)>,
    },
    /// Impacts accumulate, and the gap stays closed from then on.
    Rests {
        /// Name of the contact.
        contact: &'static str,
        /// Time at which the impacts end.
        time: T,
    },
    /// The gap stays closed from then on.
    Closes {
        /// Name of the contact.
        contact: &'static str,
        /// Time from which it is closed.
        time: T,
    },
    /// The contact pushes no more.
    Opens {
        /// Name of the contact.
        contact: &'static str,
        /// Time from which it is open.
        time: T,
    },
    /// Friction stops the bodies, and keeps them together from then on.
    Sticks {
        /// Name of the friction.
        friction: &'static str,
        /// Time from which it sticks.
        time: T,
    },
    /// Friction has reached its limit, and the bodies slide.
    Slips {
        /// Name of the friction.
        friction: &'static str,
        /// Time from which it slides.
        time: T,
    },
    /// The velocity of friction changes its sign, and the bodies slide back. That of two velocities turns instead.
    Reverses {
        /// Name of the friction.
        friction: &'static str,
        /// Time from which it slides back.
        time: T,
    },
}

impl<T: Copy> Transition<T> {
    /// Returns the time of the transition.
    pub fn time(&self) -> T {
        match *self {
            Self::Impact { time, .. }
            | Self::Rests { time, .. }
            | Self::Closes { time, .. }
            | Self::Opens { time, .. }
            | Self::Sticks { time, .. }
            | Self::Slips { time, .. }
            | Self::Reverses { time, .. } => time,
        }
    }
}

impl<T: Display> Display for Transition<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Impact { time, impulses } => {
                write!(f, "impact at t = {time}")?;
                let mut before = ": ";
                for (contact, impulse) in impulses {
                    write!(f, "{before}`{contact}` gives {impulse}")?;
                    before = ", ";
                }
                Ok(())
            }
            Self::Rests { contact, time } => write!(f, "`{contact}` rests from t = {time} on"),
            Self::Closes { contact, time } => write!(f, "`{contact}` closes at t = {time}"),
            Self::Opens { contact, time } => write!(f, "`{contact}` opens at t = {time}"),
            Self::Sticks { friction, time } => write!(f, "`{friction}` sticks from t = {time} on"),
            Self::Slips { friction, time } => write!(f, "`{friction}` slips from t = {time} on"),
            Self::Reverses { friction, time } => write!(f, "`{friction}` reverses at t = {time}"),
        }
    }
}

/// A motion of a system with contacts: [`with_contacts`](crate::MotionBuilder::with_contacts).
///
/// It consists of legs between its transitions, each with a system whose contacts are open or closed as in the leg. At a
/// transition, states are those after it; those before it end the [legs](Self::legs).
///
#[cfg_attr(
    feature = "std",
    doc = r#"
```
use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - g*y)]
#[observable(height = y)]
#[contact(floor: y >= 0)]
struct Stone { g: f64, floor: Contact }

let stone = Stone { g: 9.81, floor: Contact::Open };
let path = stone.motion(State::at_rest([1.0])).with_contacts().to(1.0)?;
assert_eq!(path.at(0.9)?.observable("height")?, 0.0);
assert_eq!(path.at(0.9)?.multiplier("floor")?, 9.81);
assert_eq!(path.csv(50).to_string().lines().next(), Some("t,y,y_dot,lambda(floor),force(y),height"));
let text = "Stone from t = 0 to t = 1: 1 impact, 0 rests, 1 closing, 0 openings
closed at the end: `floor`
reached the end at t = 1";
assert_eq!(path.to_string(), text);
# Ok::<(), Error>(())
```
"#
)]
pub struct ContactTrajectory<L: Lagrangian> {
    legs: Vec<Trajectory<L>>,
    /// Number of transitions before each leg.
    before: Vec<usize>,
    transitions: Vec<Transition<L::Scalar>>,
    crossings: Vec<Crossing<L::Scalar, L::N>>,
    statistics: Statistics,
    system: L,
    start: L::Scalar,
    end: StateOf<L>,
    ending: Ending,
}

impl<L: Lagrangian> ContactTrajectory<L> {
    pub(super) fn of(ended: Ended<L, AllLegs<L>>, start: L::Scalar) -> Self {
        let Ended { kept, transitions, crossings, statistics, system, state, ending } = ended;
        let AllLegs { legs, transitions: before, .. } = kept;
        Self { legs, before, transitions, crossings, statistics, system, start, end: state, ending }
    }

    /// Returns the transitions in the order in which they are decided, which is that of time but for [`Transition::Rests`]: it has
    /// the later time when its bounces end. At one time impacts come before what closes and opens.
    pub fn transitions(&self) -> &[Transition<L::Scalar>] {
        &self.transitions
    }

    /// Returns the legs between the transitions. Each has a system of its own, with the contacts of the leg, and its crossings
    /// are those of events and of contacts.
    pub fn legs(&self) -> &[Trajectory<L>] {
        &self.legs
    }

    /// The transitions before each leg, after the one before it.
    pub(crate) fn transitions_before_legs(&self) -> impl Iterator<Item = &[Transition<L::Scalar>]> {
        let starts = core::iter::once(0).chain(self.before.iter().copied());
        starts.zip(&self.before).map(|(from, &to)| &self.transitions[from..to])
    }

    /// The transitions after the last leg.
    pub(crate) fn transitions_after_legs(&self) -> &[Transition<L::Scalar>] {
        &self.transitions[self.before.last().copied().unwrap_or(0)..]
    }

    /// Returns the crossings of the [events](crate::MotionBuilder::event), in the order of the motion; at a transition, the state
    /// is that before it. A function that jumps at a transition does not cross there. A terminal event ends the motion before
    /// the transition.
    pub fn crossings(&self) -> &[Crossing<L::Scalar, L::N>] {
        &self.crossings
    }

    /// Returns the numbers of steps and evaluations of all legs.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// Returns the last state.
    pub fn end(&self) -> &StateOf<L> {
        &self.end
    }

    /// Returns the system, with the contacts as they are at the end.
    pub fn system(&self) -> &L {
        &self.system
    }

    /// Returns why the motion ends.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// Returns the motion, unless a failure kept it from its end.
    ///
    /// # Errors
    /// [`Error::Unfinished`] with the [`ending`](Self::ending).
    pub fn finished(self) -> Result<Self, Error> {
        if self.ending.is_failure() { Err(self.ending.into()) } else { Ok(self) }
    }

    /// Returns a table of `count` states at evenly spaced times, as comma-separated values.
    pub fn csv(&self, count: usize) -> Csv<'_, Self> {
        Csv::of(self, count)
    }
}

impl<L: Lagrangian<Scalar: Real>> ContactTrajectory<L> {
    /// Returns the state at this time, with the system as it is then; at a transition, those after it.
    ///
    /// # Errors
    /// Those of [`Trajectory::at`].
    pub fn at(&self, t: L::Scalar) -> Result<Sample<L>, Error>
    where
        L: Clone,
    {
        self.system_and_state(t).map(|(system, state)| Sample { system: system.clone(), state })
    }

    fn system_and_state(&self, t: L::Scalar) -> Result<(&L, StateOf<L>), Error> {
        if t == self.end.t {
            return Ok((&self.system, self.end));
        }
        let after = self.legs.partition_point(|leg| leg.start_time() <= t);
        match self.legs[..after].last() {
            Some(leg) if t < self.end.t => Ok((leg.system(), leg.state_at(t)?)),
            _ => {
                let [time, start, end] = [t, self.start, self.end.t].map(Real::to_f64);
                Err(Error::OutsideTrajectory { time, start, end })
            }
        }
    }

    /// Returns the states that the method computed, first and last included; at a transition, the state before it and the
    /// state after it.
    pub fn steps(&self) -> impl Iterator<Item = Sample<L>> + '_
    where
        L: Clone,
    {
        self.states_of_steps().map(|(system, state)| Sample { system: system.clone(), state })
    }

    fn states_of_steps(&self) -> impl Iterator<Item = (&L, StateOf<L>)> {
        let steps = self.legs.iter().flat_map(|leg| leg.states_of_steps().map(|state| (leg.system(), state)));
        let is_after = self.legs.last().is_none_or(|leg| *leg.last_state() != self.end);
        steps.chain(is_after.then_some((&self.system, self.end)))
    }

    /// Returns `count` states at evenly spaced times, first and last included. If [`at`](Self::at) fails, coordinates and
    /// velocities are NaN.
    pub fn samples(&self, count: usize) -> impl Iterator<Item = Sample<L>> + '_
    where
        L: Clone,
    {
        self.states(count).map(|(system, state)| Sample { system: system.clone(), state })
    }

    /// Numbers of impacts, of contacts that come to rest, that close, and that open, and of friction that sticks, slips and
    /// reverses.
    fn counts(&self) -> [usize; 7] {
        let mut counts = [0; 7];
        for transition in &self.transitions {
            counts[match transition {
                Transition::Impact { .. } => 0,
                Transition::Rests { .. } => 1,
                Transition::Closes { .. } => 2,
                Transition::Opens { .. } => 3,
                Transition::Sticks { .. } => 4,
                Transition::Slips { .. } => 5,
                Transition::Reverses { .. } => 6,
            }] += 1;
        }
        counts
    }
}

impl<L: Contacts<Scalar: Real>> ContactTrajectory<L> {
    /// Returns the largest deviation of each quantity that is conserved between impacts from its initial value, and that of
    /// the balance of an energy that is not conserved, or only while nothing slides, without what impacts take.
    pub fn drift(&self) -> Drift<L::Scalar> {
        let drift = Drift::of(self.states_of_steps());
        let is_conserved = L::FACTS.energy_is_conserved.is_some() && L::FRICTIONS.is_empty();
        if is_conserved { drift } else { drift.balanced(&self.legs) }
    }
}

impl<L: Lagrangian<Scalar: Real>> Tabulated for ContactTrajectory<L> {
    type System = L;

    fn states(&self, count: usize) -> impl Iterator<Item = (&L, StateOf<L>)> {
        let intervals = count.saturating_sub(1).max(1);
        let nowhere = vector(Array::filled(L::Scalar::constant(f64::NAN)));
        (0..count).map(move |i| {
            let t = between(self.start, self.end.t, i as f64 / intervals as f64);
            self.system_and_state(t).unwrap_or((&self.system, State { t, q: nowhere, v: nowhere }))
        })
    }
}

/// A summary: transitions by their kind, the contacts that are closed at the end, and the ending.
impl<L: Contacts<Scalar: Real>> Display for ContactTrajectory<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} from t = {} to t = {}:", L::NAME, self.start, self.end.t)?;
        let mut before = " ";
        let kinds = ["impact", "rest", "closing", "opening", "stick", "slip", "reversal"];
        let kinds = if L::FRICTIONS.is_empty() { &kinds[..4] } else { &kinds };
        for (count, kind) in self.counts().into_iter().zip(kinds) {
            write!(f, "{before}{count} {kind}{}", if count == 1 { "" } else { "s" })?;
            before = ", ";
        }
        before = "\nclosed at the end: ";
        for (k, &row) in L::CONTACTS.iter().enumerate() {
            if self.system.contact(k) != Some(Contact::Open) {
                write!(f, "{before}`{}`", name(L::CONSTRAINTS, row))?;
                before = ", ";
            }
        }
        write!(f, "\n{}", self.ending)
    }
}

impl<L: Lagrangian> Debug for ContactTrajectory<L>
where
    L::Scalar: Scalar,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("ContactTrajectory");
        text.field("system", &L::NAME).field("end", &self.end).field("ending", &self.ending);
        text.field("transitions", &self.transitions).finish_non_exhaustive()
    }
}
