//! Motions from their start to an end: the settings, and what is kept of the way.

pub(crate) mod builder;
pub(crate) mod progress;
pub(crate) mod record;
pub(crate) mod sampled;
pub(crate) mod store;
