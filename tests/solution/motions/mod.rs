//! Motions, and all that is computed along them, by every method.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod cancelled;
mod counted;
mod switches;
mod units;
