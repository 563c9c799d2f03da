//! Lagrangian mechanics from a struct.
//!
//! `#[derive(Lagrangian)]` turns a Lagrangian and its constraints, written the way a textbook does, into the equations
//! of motion and the multipliers; this crate integrates them.
//!
#![cfg_attr(
    feature = "std",
    doc = r#"
```
use lagrange_core::prelude::*;

/// A sphere of mass `m` and radius `a` rolling down an incline without slipping.
#[derive(Lagrangian)]
#[coordinates(x, phi)]
#[define(inertia = 2/5 * m * a^2)]
#[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*g*x*sin(alpha))]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
struct RollingSphere { m: f64, a: f64, g: f64, alpha: f64 }

let sphere = RollingSphere { m: 1.0, a: 0.1, g: 9.81, alpha: 0.3 };
let path = sphere.integrate(State::at_rest([0.0, 0.0]), 3.0, Dop853::default())?;
let (x, friction) = (path.end().coordinate("x")?, path.end().multiplier("no_slip")?);
assert!((x - 0.5 * 5.0 / 7.0 * 9.81 * 0.3_f64.sin() * 9.0).abs() < 1e-9);
assert!((friction + 2.0 / 7.0 * 9.81 * 0.3_f64.sin()).abs() < 1e-12);
# Ok::<(), Error>(())
```
"#
)]
//!
//! - [`Lagrangian`] is the contract that generated code implements, [`Simulate`] what a program calls.
//! - [`Hamiltonian`] is the other side: momenta, the Legendre transform, Hamilton's equations, motion in (q, p).
//! - [`StateDerivatives`] and [`Linearized`] have the derivatives of the motion: Jacobians, equilibria, the linear system near a state;
//!   [`AcrossEvents`] those of motions across events.
//! - [`Solution`] holds accelerations and multipliers; the sign of a multiplier is that of Milton (8.7): the constraint
//!   force on coordinate a is Σ_α λ_α F_αa.
//! - [`Motion`] goes on when it is told to: inputs that change, states at chosen times, nothing stored; [`embedded`] is about
//!   programs without an operating system.
//! - [`Event`]s are where functions of the motion cross zero: a [`Motion`] stops there, a run records them or ends;
//!   a [`Journey`] goes on with another system.
//! - [`ensemble`]: many members at once, on SIMD lanes and on all threads.
//! - [`Dop853`] and [`Dopri5`] are the methods, [`Taylor`] the one for round-off, [`Trajectory`] is what they give, [`Ending`] why it stops.
//!
//! Features: `std` (default), without it there are no ensembles; `alloc`, without it there are no trajectories, but motions
//! step by step; `libm`, elementary functions where there is no `std`; `rayon`, ensembles on all threads; `mpi`, ensembles on many machines; `parquet`, tables of
//! ensembles as files of Parquet; `serde`, states,
//! solutions, records of trajectories and endings can be written, and those without names read.
#![cfg_attr(not(feature = "std"), no_std)]
// Algorithms on matrices read best with indices.
#![allow(clippy::needless_range_loop)]

// Generated code names this crate `::lagrange_core`, also inside it.
#[cfg(feature = "alloc")]
extern crate alloc;
extern crate self as lagrange_core;

pub mod embedded;
mod ending;
#[cfg(feature = "std")]
pub mod ensemble;
mod error;
#[cfg(test)]
mod fixtures;
pub mod function;
#[doc(hidden)]
pub mod generated;
mod hamiltonian;
pub mod language;
pub mod linearized;
pub mod motion;
mod names;
mod number;
pub mod prelude;
mod solution;
mod statistics;
mod system;
#[cfg(feature = "alloc")]
mod trajectory;

pub use ending::Ending;
#[cfg(feature = "std")]
pub use ensemble::{
    Arrival, Ensemble, EnsembleProgress, Fingerprint, Member, MemberEnding, MemberRow, MemberTable, Outcome,
};
pub use error::Error;
#[cfg(feature = "alloc")]
pub use function::Table;
pub use function::{ByHand, Function, HandWritten};
pub use hamiltonian::{Hamiltonian, HamiltonianFlow, PhaseRate, PhaseState};
pub use lagrange_macros::Lagrangian;
#[cfg(feature = "alloc")]
pub use linearized::{
    AcrossEvents, Actuation, DifferentiableMethod, DualSample, Equilibrium, JacobianBy, Linearization,
    LyapunovSpectrum, Sensitivities, Sensitivity, Stability,
};
pub use linearized::{Direction, Jacobian, Linearized, Partials, ResidualChange, StateDerivatives};
#[cfg(feature = "std")]
pub use motion::LaneMethod;
pub use motion::Simulate;
#[cfg(feature = "alloc")]
pub use motion::Taylor;
pub use motion::{Crossing, Dop853, Dopri5, Event, Method, Motion, Progress, RungeKutta4, runge_kutta_step};
#[cfg(feature = "mpi")]
pub use mpi;
pub use nalgebra;
pub use names::{Entry, Names, Row};
#[cfg(feature = "std")]
pub use number::Lanes;
pub use number::{Dual, Filled, Over, PowerSeries, Real, Scalar, Wide};
#[cfg(feature = "alloc")]
pub use solution::Impact;
pub use solution::{Adjustment, Consistent, Sample};
pub use statistics::Statistics;
pub use system::{
    Classification, Conserved, ConstraintKind, Equations, Evidence, Extent, Facts, Integrability, Integrals,
    Lagrangian, LinearPart, Pack, Packed, RightHandSides, Shared, Solution, State, TaylorSeries,
    TotalDerivative,
};
#[cfg(feature = "alloc")]
pub use trajectory::{Csv, Deviation, Drift, Journey, Leg, Named, Records, Trajectory};

/// The README's program is compiled and run with the documentation's examples.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
