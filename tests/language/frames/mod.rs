//! Frames: each word of their language against poses multiplied by hand, systems against the same systems without frames.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod growing;
mod moving;
mod poses;
mod vocabulary;

// Systems twice, in frames and without.
#[cfg(feature = "thorough")]
mod powers;
#[cfg(feature = "thorough")]
mod same;
