//! A motion across contacts: its legs and its transitions.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

use crate::error::{Ending, Error};
use crate::number::{Real, Scalar};
use crate::system::{Lagrangian, StateOf};
use crate::trajectory::{HybridTrajectory, Named};

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
            | Self::Slips { time, .. } => time,
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
        }
    }
}

/// A motion of a system with contacts: [`with_contacts`](crate::MotionBuilder::with_contacts).
pub struct ContactTrajectory<L: Lagrangian> {
    pub(super) legs: HybridTrajectory<L::Scalar>,
    pub(super) transitions: Vec<Transition<L::Scalar>>,
    pub(super) system: L,
    pub(super) end: StateOf<L>,
    pub(super) ending: Ending,
}

impl<L: Lagrangian<Scalar: Real>> ContactTrajectory<L> {
    /// Returns the transitions, in the order of time; at one time, impacts before what closes and opens.
    pub fn transitions(&self) -> &[Transition<L::Scalar>] {
        &self.transitions
    }

    /// Returns the legs between the transitions. Each has a system of its own, with the contacts of the leg.
    pub fn legs(&self) -> &HybridTrajectory<L::Scalar> {
        &self.legs
    }

    /// Returns the state at this time, for lookup by name; at an impact, the state after it.
    ///
    /// # Errors
    /// Those of [`HybridTrajectory::at`].
    pub fn at(&self, t: L::Scalar) -> Result<alloc::boxed::Box<dyn Named<L::Scalar> + '_>, Error> {
        self.legs.at(t)
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
