//! Integration of several motions at once on SIMD lanes, for every method that supports it.
//!
//! A step is computed for all lanes at once, and accepted or rejected lane by lane, as for a single motion. Lanes
//! cannot handle an unreliable elimination, dependent constraints, numbers that are not finite, or the end of all
//! steps. In these cases the scalar method takes the step of that lane alone. No lane depends on the others.

mod alone;
mod batch;
mod contract;
mod motion;
mod pair;
mod reliability;

pub(crate) use batch::Batch;
pub use contract::LaneMethod;
pub(crate) use contract::{LaneMotions, unpacked, unpacked_phase};
pub(crate) use motion::{LaneMotion, LaneOutcome};
pub(crate) use reliability::LaneReliability;
