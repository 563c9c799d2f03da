//! What happens between two legs of a motion.

use alloc::vec::Vec;
use core::fmt::{self, Display, Formatter};

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

impl<T> Transition<T> {
    /// Names of the kinds, in the order in which summaries list them.
    const KINDS: [&'static str; 7] = ["impact", "rest", "closing", "opening", "stick", "slip", "reversal"];

    fn kind(&self) -> &'static str {
        match self {
            Self::Impact { .. } => "impact",
            Self::Rests { .. } => "rest",
            Self::Closes { .. } => "closing",
            Self::Opens { .. } => "opening",
            Self::Sticks { .. } => "stick",
            Self::Slips { .. } => "slip",
            Self::Reverses { .. } => "reversal",
        }
    }
}

/// Writes how many of these transitions there are of each kind that occurs.
pub(super) fn write_counts<T>(transitions: &[Transition<T>], f: &mut Formatter<'_>) -> fmt::Result {
    if transitions.is_empty() {
        return f.write_str("no transitions");
    }
    let mut before = "";
    for kind in Transition::<T>::KINDS {
        let count = transitions.iter().filter(|transition| transition.kind() == kind).count();
        if count > 0 {
            write!(f, "{before}{count} {kind}{}", if count == 1 { "" } else { "s" })?;
            before = ", ";
        }
    }
    Ok(())
}
