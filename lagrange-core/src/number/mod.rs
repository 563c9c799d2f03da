//! Scalar types of the equations of motion.

mod broadcast;
mod dual;
#[cfg(all(feature = "std", target_feature = "avx512f"))]
mod eight;
#[cfg(feature = "std")]
mod lanes;
pub(crate) mod numeric;
mod parts;
#[cfg(feature = "std")]
mod quad;
mod real;
mod scalar;
mod series;
#[cfg(feature = "std")]
mod simd;
#[cfg(feature = "std")]
mod sines;

pub use broadcast::{Broadcast, Wide};
pub use dual::Dual;
#[cfg(feature = "std")]
pub use lanes::{FourLanes, Lanes};
#[cfg(feature = "alloc")]
pub(crate) use numeric::order;
pub(crate) use numeric::{
    are_finite, beyond_round_off, exceeds, is_within, larger, largest, norm, power_of_epsilon, power_of_two,
    smaller, sum, unit_of,
};
pub use parts::Parts;
pub use real::Real;
pub use scalar::Scalar;
pub use series::PowerSeries;
#[cfg(feature = "alloc")]
pub(crate) use series::ROOM;
