//! Events: zero crossings of functions of the motion, found within steps.

mod chebyshev;
mod definition;
mod dense;
mod halves;
mod locate;
mod memory;
mod noise;
#[cfg(feature = "alloc")]
pub(crate) mod recorded;
mod search;

pub(crate) use definition::DynEvent;
pub use definition::{AnyEvent, Event, EventFunction, EventValue};
pub(crate) use dense::DenseStep;
pub(crate) use noise::noise;
pub(crate) use search::EventSearch;
