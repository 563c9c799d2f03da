//! The numbers that everything is computed with.

pub(crate) mod array;
mod dual;
#[cfg(feature = "std")]
mod lanes;
pub(crate) mod numeric;
pub(crate) mod scalar;

pub use dual::Dual;
#[cfg(feature = "std")]
pub use lanes::Lanes;
pub use scalar::{Real, Scalar};
