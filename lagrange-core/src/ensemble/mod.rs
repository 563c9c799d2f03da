//! Many motions of one kind of system: other starts, other parameters.
//!
//! [`Ensemble::integrate_on_lanes`] integrates four members at once on SIMD lanes (with AVX-512 eight), [`Ensemble::integrate`] one after
//! the other, and both with the feature `rayon` on all threads of rayon's current pool. What a member gives is bit
//! for bit the same whatever its neighbours, the number of threads and the part of the ensemble that is run. A member
//! that fails says why, and spoils no other. What lies within the motions can be kept of each: [samples](Ensemble::samples_at) at
//! given times, and crossings of [events](Ensemble::event).
//!
//! Members move in coordinates and velocities; there are no ensembles of motions in (q, p).
//!
#![doc = include_str!("machines.md")]

mod fingerprint;
mod job;
mod outcome;
#[cfg(feature = "parquet")]
mod parquet;
mod plan;
#[cfg(feature = "mpi")]
mod ranks;
mod settings;
mod table;
#[cfg(test)]
mod tests;
mod within;

pub use crate::error::EnsembleError;
pub use crate::motion::record::Arrival;
pub use fingerprint::Fingerprint;
pub use outcome::{Member, Outcome};
#[cfg(feature = "parquet")]
pub use parquet::ParquetTable;
pub use plan::EnsembleProgress;
#[cfg(feature = "mpi")]
pub use ranks::OnRanks;
pub use settings::Ensemble;
pub use table::{MemberEnding, MemberRow, MemberTable};
