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
//! The struct's fields are the parameters. `coordinates` names the variables, `x_dot` is the velocity of `x`, a constraint has a name, under
//! which its multiplier is had. [`language`] has all forms: vectors, frames, forces, functions of one's own.
//!
//! # States
//!
//! A [`State`] is a time, coordinates and velocities; those that are named make one, and `make_consistent` moves it onto the
//! constraints. At a state everything is known: accelerations, multipliers, momenta, the matrices of the equations.
//!
//! ```
//! # use lagrange_core::prelude::*;
//! /// A bob on a rod, in the plane.
//! #[derive(Lagrangian)]
//! #[coordinates(x, y)]
//! #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
//! #[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
//! #[observable(pull = -lambda(rod)*l)]
//! struct Pendulum { m: f64, g: f64, l: f64 }
//!
//! let pendulum = Pendulum { m: 2.0, g: 9.81, l: 1.0 };
//! let (state, _) = pendulum.make_consistent(&State::at_rest([0.1, -1.0]))?;
//! let solution = pendulum.solve(&state)?;
//! assert_eq!(solution.accelerations.len(), 2);
//! // At rest the rod carries m g cos θ.
//! assert!((pendulum.pull(&state, &solution) + 2.0 * 9.81 * state.q[1]).abs() < 1e-12);
//! # Ok::<(), Error>(())
//! ```
//!
//! The sign of a multiplier is that of Milton (8.7), everywhere: d/dt(∂L/∂q̇) = ∂L/∂q + Q + Fᵀλ, with F = ∂Φ/∂q and Φ = left − right.
//! `Pendulum::equations()` is the system to be read, and stands in its documentation.
//!
//! # Motions
//!
//! [`integrate`](Simulate::integrate) goes from a state to a time by a method that the call names: [`Dop853`] as a rule, [`Taylor`] to round-off,
//! [`Dopri5`] for coarse errors ([`motion`] compares them). Every step ends on the constraints. A [`Trajectory`] answers at any
//! time, by name; why it ends is an [`Ending`]. Where a function of the motion crosses zero is an [`Event`].
//!
#![cfg_attr(
    feature = "std",
    doc = r#"
```
# use lagrange_core::prelude::*;
# #[derive(Lagrangian)]
# #[coordinates(x, y)]
# #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
# #[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
# #[observable(pull = -lambda(rod)*l)]
# struct Pendulum { m: f64, g: f64, l: f64 }
let pendulum = Pendulum { m: 2.0, g: 9.81, l: 1.0 };
let lowest = pendulum.event("lowest", |sample| sample.coordinate("x")).falling();
let start = State::at_rest([1.0, 0.0]);
let path = pendulum.motion(start).event(lowest).towards(5.0)?;
// At the lowest point it pulls with 3 m g.
for crossing in path.crossings() {
    let sample = path.at(crossing.state.t)?;
    assert!((sample.observable("pull")? - 3.0 * 2.0 * 9.81).abs() < 1e-6);
}
println!("{}", path.csv(50).energy());
# Ok::<(), Error>(())
```
"#
)]
//!
//! # Inputs
//!
//! A [`Motion`] goes on when it is told to: parameters change in between, states are read, nothing is stored.
//!
//! ```
//! # use lagrange_core::prelude::*;
//! #[derive(Lagrangian)]
//! #[coordinates(x)]
//! #[lagrangian(m/2 * x_dot^2)]
//! #[force(x: push)]
//! struct Cart { m: f64, push: f64 }
//!
//! let mut motion = Motion::new(Cart { m: 2.0, push: 0.0 }, State::at_rest([1.0]), Dop853::default())?;
//! for tick in 1..=1000 {
//!     let state = *motion.state();
//!     motion.system_mut().push = -3.0 * state.q[0] - 4.0 * state.v[0];
//!     motion.advance_to(0.01 * f64::from(tick))?;
//! }
//! assert!(motion.state().q[0].abs() < 1e-3);
//! # Ok::<(), Error>(())
//! ```
//!
//! # What else there is
//!
//! - [`Hamiltonian`]: momenta, the Legendre transform, Hamilton's equations, motion in (q, p).
//! - [`Linearized`] and [`StateDerivatives`]: exact derivatives; equilibria, the linear system near a state, inverse dynamics, motions with
//!   their derivatives; [`MotionDerivatives`] those across impacts.
//! - [`Ensemble`]: many members at once, on SIMD lanes, on all threads, on many machines ([`ensemble`]).
//! - [`HybridTrajectory`]: a motion of several legs, of several systems; [`Simulate::impact`].
//! - [`Lagrangian`] is the contract that generated code implements, [`Solution`] what it gives; [`Scalar`] what numbers must be.
//! - [`embedded`] is about programs without an operating system.
//!
//! The book in the repository follows a course of mechanics, and has how-tos.
//!
//! # Features
//!
//! `std` (default), without it there are no ensembles; `alloc`, without it there are no trajectories and no Taylor
//! series, but motions step by step; `libm`, elementary functions where there is no `std`; `rayon`, ensembles on all threads; `mpi`, ensembles on many machines; `parquet`, tables of
//! ensembles as files of Parquet; `serde`, states,
//! solutions, records of trajectories and endings can be written, and those without names read; from JSON to the last bit only with
//! `serde_json = { version = "1", features = ["float_roundtrip"] }`.
#![cfg_attr(not(feature = "std"), no_std)]
// docs.rs shows which feature an item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]
// Algorithms on matrices read best with indices.
#![allow(clippy::needless_range_loop)]

// Generated code names this crate `::lagrange_core`, also inside it.
#[cfg(feature = "alloc")]
extern crate alloc;
extern crate self as lagrange_core;

pub mod embedded;
#[cfg(feature = "std")]
pub mod ensemble;
pub mod error;
pub mod facts;
#[cfg(test)]
mod fixtures;
pub mod function;
#[doc(hidden)]
pub mod generated;
pub mod hamiltonian;
pub mod language;
pub mod linearized;
pub mod motion;
mod names;
pub mod number;
pub mod prelude;
mod room;
mod solution;
mod statistics;
mod system;
#[cfg(feature = "alloc")]
pub mod trajectory;

#[cfg(feature = "std")]
pub use ensemble::Ensemble;
pub use error::{Ending, Error};
pub use function::Function;
pub use hamiltonian::{Hamiltonian, PhaseState};
pub use lagrange_macros::Lagrangian;
pub use linearized::{Jacobian, Linearized, StateDerivatives};
#[cfg(feature = "alloc")]
pub use linearized::{Linearization, MotionDerivatives};
pub use motion::{Crossing, Dop853, Dopri5, Event, Method, Motion, RungeKutta4, Simulate, runge_kutta_step};
#[cfg(feature = "alloc")]
pub use motion::{MotionBuilder, Taylor};
#[cfg(feature = "mpi")]
pub use mpi;
pub use nalgebra;
#[cfg(feature = "std")]
pub use number::Lanes;
pub use number::{Broadcast, Dual, PowerSeries, Real, Scalar};
#[cfg(feature = "alloc")]
pub use solution::Impact;
pub use solution::Sample;
pub use statistics::Statistics;
pub use system::{
    ConstraintKind, Direction, Entries, Lagrangian, Pack, Packed, ResidualChange, Shared, Solution, State,
    TaylorSeries,
};
#[cfg(feature = "alloc")]
pub use trajectory::{HybridTrajectory, Trajectory};

/// The README's program is compiled and run with the documentation's examples.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
