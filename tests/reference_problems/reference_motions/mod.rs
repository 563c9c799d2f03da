//! Motions that are known to more digits than `f64` has, and the errors of each method on them.
//!
//! `cargo test --test reference_motions -- --nocapture --test-threads 1` prints a row for each problem and method: errors
//! of coordinates, velocities and multipliers, steps, time. `LAGRANGE_CASES=full` adds the long spans of the literature.
//!
//! The known values lie in `values/`, a table for each motion with its source, or are closed forms beside the system.
//! `recompute.py` computes the tables that name it.

mod classics;
mod fekete;
mod noninertial;
mod particles;
mod rattleback;
mod reference;
mod spherical_pendulum;
mod three_bodies;
mod tops;
