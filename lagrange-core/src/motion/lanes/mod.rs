//! Motions side by side on SIMD lanes, by every method that can step so.
//!
//! A step is computed for all lanes at once; what decides is done lane by lane, as for a motion alone. Where a lane meets what
//! the lanes cannot do (an elimination that is not to be trusted, constraints that depend on one another, numbers that are not
//! finite, the end of all steps) its step is taken alone, by the scalar method. Nothing in a lane depends on the others.

mod alone;
mod batch;
mod contract;
mod motion;
mod pair;
mod reliability;

pub(crate) use batch::Batch;
pub use contract::LaneMethod;
pub(crate) use contract::{LaneMotions, unpacked};
pub(crate) use motion::{LaneMotion, LaneOutcome};
pub(crate) use reliability::LaneReliability;
