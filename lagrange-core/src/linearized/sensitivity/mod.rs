//! Derivatives along motions: states with their derivatives, motions of these, and their jumps at events and contacts.

mod across;
mod contacts;
mod events;
mod sampled;
mod state;
mod trajectory;

pub use across::MotionDerivatives;
pub use events::{DifferentiableEvent, DualSample, OverDuals};
pub use sampled::SampledSensitivity;
pub use state::StateSensitivity;
pub use trajectory::TrajectorySensitivity;
