//! The numbers that everything is computed with.

mod array;
mod broadcast;
mod dual;
#[cfg(all(feature = "std", target_feature = "avx512f"))]
mod eight;
#[cfg(feature = "alloc")]
mod four;
#[cfg(feature = "std")]
mod lanes;
mod numeric;
#[cfg(feature = "std")]
mod quad;
mod scalar;
mod series;
#[cfg(feature = "std")]
mod sines;

pub(crate) use array::entries;
pub use array::{FixedArray, matrix, vector};
pub use broadcast::{Broadcast, Wide};
pub use dual::Dual;
#[cfg(feature = "alloc")]
pub(crate) use four::Four;
#[cfg(feature = "std")]
pub use lanes::{FourLanes, Lanes};
pub(crate) use numeric::{
    beyond_round_off, exceeds, is_within, larger, largest, norm, power_of_epsilon, power_of_two, smaller, sum,
};
pub use numeric::{only_where, sin_cos_of_small};
pub use scalar::{Real, Scalar};
pub use series::PowerSeries;
#[cfg(feature = "alloc")]
pub(crate) use series::ROOM;
