//! Limits of the work that is done at once for an ensemble.

#[cfg(feature = "mpi")]
use core::time::Duration;

/// Number of rows in a row group of a Parquet file, which are converted together. During the conversion each number takes some hundred
/// bytes, so that members with a hundred numbers need 10 MB.
#[cfg(feature = "parquet")]
pub(super) const ROWS_IN_GROUP: usize = 1024;

/// Time that rank 0 sleeps when no message is waiting: a thousandth of the duration of a batch unless another is set, so that a rank
/// waits no longer than that part of its time.
#[cfg(feature = "mpi")]
pub(super) const PAUSE: Duration = Duration::from_millis(1);

/// Smallest number of members in a batch, unless fewer are left: two vectors of the widest lanes, eight.
#[cfg(feature = "mpi")]
pub(super) const LEAST: usize = 16;
