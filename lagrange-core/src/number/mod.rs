//! Scalar types of the equations of motion.

mod broadcast;
mod dual;
#[cfg(feature = "std")]
mod lanes;
pub(crate) mod limits;
pub(crate) mod numeric;
mod parts;
#[cfg(any(feature = "std", feature = "libm"))]
mod plain;
mod real;
mod scalar;
mod series;

pub use broadcast::{Broadcast, Wide};
pub use dual::Dual;
#[cfg(feature = "std")]
pub use lanes::{FourLanes, Lanes};
pub(crate) use numeric::order;
pub(crate) use numeric::{
    are_finite, beyond_round_off, dot, exceeds, is_within, larger, largest, norm, power_of_epsilon,
    power_of_two, smaller, sum, unit_of,
};
pub use parts::Parts;
pub use real::Real;
pub use scalar::Scalar;
pub use series::PowerSeries;
pub(crate) use series::ROOM;
