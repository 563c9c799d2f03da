//! Broken input of every kind, by every method to which it applies: each ends in an error whose text names what is wrong, or
//! in correct numbers. What was computed is kept, and no motion hangs or panics.
//!
//! `cargo test --test motion_control faults -- --nocapture` prints the kinds, the methods and the texts.

// Helpers of tests may panic as tests do.
#![allow(clippy::unwrap_used)]

mod case;
mod kinds;
mod methods;
#[cfg(feature = "thorough")]
mod singular;
mod systems;
