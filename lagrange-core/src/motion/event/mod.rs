//! Events: zero crossings of functions of the motion, found within steps.

mod chebyshev;
mod definition;
mod dense;
mod halves;
mod locate;
mod memory;
mod narrow;
mod noise;
mod search;

pub use definition::{AnyEvent, Event, EventFunction, EventValue};
#[cfg(feature = "alloc")]
pub(crate) use definition::{DynEvent, EventInSteps};
pub(crate) use dense::DenseStep;
#[cfg(feature = "alloc")]
pub(crate) use noise::noise;
pub(crate) use search::EventSearch;
