//! Motions across the contacts of a system: each between two impacts, or by time steps.

mod bodies;
mod builder;
mod condition;
mod driver;
mod forces;
mod friction;
mod grip;
mod impact;
mod instant;
mod kinetic;
mod last_value;
mod legs;
mod lifting;
mod limits;
mod motion;
mod reactions;
mod rows;
mod sharing;
mod span;
mod states;
mod stepping;
mod watched;

use super::{Contact, Contacts, ForceDerivatives, Friction, FrictionRows, ImpactLaw};
use crate::trajectory::Transition;

pub(crate) use bodies::impulse_changes;
pub(crate) use builder::arrive;
pub use builder::{AcrossContacts, CrossesContacts, Located, Stepwise};
pub use motion::ContactMotion;
pub use stepping::{ContactStepper, MoreauJean, TimeStep};
pub(crate) use watched::held;
