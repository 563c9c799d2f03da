//! The equations of motion solved: accelerations and multipliers, consistent states, the rates of a motion.

pub(crate) mod consistent;
pub(crate) mod eliminate;
pub(crate) mod flow;
pub(crate) mod kkt;
pub(crate) mod near;
pub(crate) mod newton;
mod sample;
pub(crate) mod solve;

pub use consistent::{Adjustment, Consistent};
pub use sample::Sample;
