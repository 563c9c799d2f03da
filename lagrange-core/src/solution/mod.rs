//! Solution of the equations of motion: accelerations and multipliers, consistent states, vector fields.

pub(crate) mod acceleration_field;
pub(crate) mod consistent;
pub(crate) mod crossing;
pub(crate) mod eliminate;
pub(crate) mod energy_field;
#[cfg(feature = "alloc")]
pub(crate) mod impact;
pub(crate) mod interpolant;
pub(crate) mod kkt;
pub(crate) mod limits;
#[cfg(feature = "alloc")]
pub(crate) mod many_body_field;
#[cfg(feature = "alloc")]
pub(crate) mod many_constraints;
pub(crate) mod named_field;
pub(crate) mod near;
pub(crate) mod pivot;
pub(crate) mod reason;
pub(crate) mod round_off;
mod sample;
pub(crate) mod solve;
pub(crate) mod switched;
pub(crate) mod system_checks;
pub(crate) mod vector_field;

pub use consistent::{Adjustment, Consistent};
pub use sample::Sample;
