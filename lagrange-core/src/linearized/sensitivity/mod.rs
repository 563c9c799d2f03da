//! Derivatives along motions: states with their derivatives, motions of these, and their jumps at events and contacts.

mod across;
mod along;
mod contacts;
mod course;
mod events;
mod state;
mod trajectory;

pub use across::MotionDerivatives;
pub use events::{DifferentiableEvent, DualSample, OverDuals};
pub use state::StateSensitivity;
pub use trajectory::{SampledSensitivity, TrajectorySensitivity};
