//! Ensembles: many motions of one kind of system, with different initial states and parameters.
//!
//! [`Ensemble::integrate_on_lanes`] integrates four members at once on SIMD lanes (with AVX-512 eight).
//! [`Ensemble::integrate`] integrates one member after the other. With the feature `rayon` both use all threads of
//! rayon's current pool. The result of a member is the same bit for bit, whatever its neighbours, the number of threads
//! and the part of the ensemble that runs. A member that fails reports its error and does not affect the others. Along
//! each motion the ensemble can keep [samples](Ensemble::samples_at) at given times and crossings of
//! [events](Ensemble::event).
//!
//! Members are integrated in coordinates and velocities; ensembles of motions in (q, p) are not supported.
//!
#![doc = include_str!("machines.md")]

mod contacts;
mod fingerprint;
mod job;
#[cfg(any(feature = "mpi", feature = "parquet"))]
mod limits;
#[cfg(feature = "serde")]
mod line;
mod names;
mod outcome;
#[cfg(feature = "parquet")]
mod parquet;
mod plan;
#[cfg(feature = "mpi")]
mod ranks;
mod row;
mod settings;
#[cfg(feature = "tables")]
mod table;
#[cfg(test)]
mod tests;
mod within;

pub use crate::error::EnsembleError;
pub use crate::motion::Arrival;
pub use fingerprint::Fingerprint;
pub use outcome::{Member, Outcome};
#[cfg(feature = "parquet")]
pub use parquet::ParquetTable;
pub use plan::EnsembleProgress;
#[cfg(feature = "mpi")]
pub use ranks::OnRanks;
pub use row::{MemberCrossing, MemberEnding, MemberRow};
pub use settings::Ensemble;
#[cfg(feature = "tables")]
pub use table::MemberTable;
