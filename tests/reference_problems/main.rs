//! Benchmark problems of multibody dynamics, and motions that are known to more digits than `f64` has, with the errors of several
//! methods on them.
//!
//! `cargo test --test reference_problems --features thorough -- --nocapture --test-threads 1` prints a row for each problem and method:
//! errors of coordinates, velocities and multipliers, steps, time. `LAGRANGE_CASES=full` adds the long spans of the literature, and
//! methods that take many steps.
//!
//! The known values lie in `values/`, a table for each motion with its source, or are closed forms beside the system. `recompute.py`
//! computes the tables that name it.

// A test that fails says why by a panic.
#![allow(clippy::unwrap_used)]

mod andrews;
mod bicycle;
mod bricard;
mod classics;
mod fekete;
mod four_bars;
mod governor;
mod nonholonomic;
mod noninertial;
mod particles;
mod rattleback;
mod reference;
mod spherical_pendulum;
mod test_set;
mod three_bodies;
mod tops;
