//! Lagrangian mechanics from a struct.
//!
//! `#[derive(Lagrangian)]` takes a Lagrangian and its constraints in textbook notation and derives the
//! equations of motion and the multipliers; this crate integrates them.
//!
//! ```
//! use lagrange_core::prelude::*;
//!
//! /// A sphere of mass `m` and radius `a` rolling down an incline without slipping.
//! #[derive(Lagrangian)]
//! #[coordinates(x, phi)]
//! #[define(inertia = 2/5 * m * a^2)]
//! #[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*g*x*sin(alpha))]
//! #[constraint(no_slip: x_dot - a*phi_dot = 0)]
//! struct RollingSphere { m: f64, a: f64, g: f64, alpha: f64 }
//!
//! let sphere = RollingSphere { m: 1.0, a: 0.1, g: 9.81, alpha: 0.3 };
//! let path = sphere.integrate(State::at_rest([0.0, 0.0]), 3.0, Dop853::default())?;
//! let (x, friction) = (path.end().coordinate("x")?, path.end().multiplier("no_slip")?);
//! assert!((x - 0.5 * 5.0 / 7.0 * 9.81 * 0.3_f64.sin() * 9.0).abs() < 1e-9);
//! assert!((friction + 2.0 / 7.0 * 9.81 * 0.3_f64.sin()).abs() < 1e-12);
//! # Ok::<(), Error>(())
//! ```
//!
//! The struct's fields are the parameters. `coordinates` names the generalized coordinates, and `x_dot` is the
//! velocity of `x`. A constraint has a name, by which its multiplier is read. [`language`] documents the whole
//! syntax: vectors, frames, forces, user-supplied functions.
//!
//! # States
//!
//! A [`State`] is a time, coordinates and velocities. It can be built from named entries, and `make_consistent`
//! projects it onto the constraints. A state determines the accelerations, multipliers, momenta and the
//! matrices of the equations.
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
//! Multipliers have the sign of Milton (8.7) everywhere: d/dt(∂L/∂q̇) = ∂L/∂q + Q + Fᵀλ, with F = ∂Φ/∂q and Φ =
//! left − right. `Pendulum::equations()` returns the equations in readable form; the documentation of the
//! struct shows them too.
//!
//! # Motions
//!
//! [`integrate`](Simulate::integrate) integrates from a state to an end time by the method given: [`Dop853`] by
//! default, [`Taylor`] for errors near round-off, [`Dopri5`] for coarse tolerances, [`Radau`](linearized::Radau) for stiff
//! systems, and methods such as [`Verlet`](motion::Verlet) for energies that must not drift ([`motion`] compares them).
//! Every step ends on the constraints. A [`Trajectory`] returns the state at any time and its entries by name;
//! an [`Ending`] tells why the trajectory ends. An [`Event`] locates the zero crossings of a function of the
//! motion.
//!
//! ```
//! # use lagrange_core::prelude::*;
//! # #[derive(Lagrangian)]
//! # #[coordinates(x, y)]
//! # #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
//! # #[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
//! # #[observable(pull = -lambda(rod)*l)]
//! # struct Pendulum { m: f64, g: f64, l: f64 }
//! let pendulum = Pendulum { m: 2.0, g: 9.81, l: 1.0 };
//! let lowest = pendulum.event("lowest", |sample| sample.coordinate("x")).falling();
//! let start = State::at_rest([1.0, 0.0]);
//! let path = pendulum.motion(start).event(lowest).towards(5.0)?;
//! // At the lowest point it pulls with 3 m g.
//! for crossing in path.crossings() {
//!     let sample = path.at(crossing.state.t)?;
//!     assert!((sample.observable("pull")? - 3.0 * 2.0 * 9.81).abs() < 1e-6);
//! }
//! println!("{}", path.csv(50).energy());
//! # Ok::<(), Error>(())
//! ```
//!
//! # Inputs
//!
//! A [`Motion`] advances on request: between advances the program may change parameters and read states.
//! Nothing is stored.
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
//! # Other parts of the crate
//!
//! - [`Hamiltonian`]: momenta, the Legendre transform, Hamilton's equations, motion in (q, p).
//! - [`Linearized`] and [`StateDerivatives`]: exact derivatives; equilibria, the linear system near a state,
//!   inverse dynamics, sensitivities of motions; [`MotionDerivatives`]: sensitivities across impacts.
//! - [`PeriodicMotion`](orbits::PeriodicMotion): monodromy matrices, periodic orbits, their families and bifurcations.
//! - [`Ensemble`]: many members at once, on SIMD lanes, on all threads, on many machines ([`ensemble`]).
//! - [`HybridTrajectory`]: a motion in several legs, each with its own system; [`Simulate::impact`].
//! - [`Lagrangian`]: the trait that generated code implements; [`Solution`]: accelerations and multipliers at a
//!   state; [`Scalar`]: requirements on the number type.
//! - [`structure`]: marker traits for the systems that an integrator applies to.
//! - [`StateOf`], [`SolutionOf`] and [`generic`]: types in functions that work for any system.
//! - [`embedded`]: programs without an operating system.
//!
//! The book in the repository follows a course of mechanics and contains how-to guides.
//!
//! # Features
//!
//! - `std` (default): ensembles need it.
//! - `alloc`: trajectories, lookup by name, `Taylor` and `Radau`, contacts and more need it; without it, motions advance
//!   step by step ([`embedded`]).
//! - `libm`: elementary functions for programs without `std`.
//! - `rayon`: ensembles on all threads.
//! - `tables`: tables of ensembles as JSON lines, and ensembles that resume from them; turns on `serde`.
//! - `parquet`: tables of ensembles as Parquet files too.
//! - `mpi`: ensembles on many machines; turns on `tables`, since rows travel as JSON lines.
//! - `serde`: serializes states, solutions, records of trajectories and endings, and deserializes those without
//!   names. Numbers survive JSON to the last bit only with
//!   `serde_json = { version = "1", features = ["float_roundtrip"] }`.
#![cfg_attr(not(feature = "std"), no_std)]
// Makes docs.rs show which feature an item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]
// Ensembles link to their tables, which are documented with that feature.
#![cfg_attr(not(feature = "tables"), allow(rustdoc::broken_intra_doc_links))]
// Without `std` or `alloc`, what only larger parts of the crate call serves nobody.
#![cfg_attr(not(feature = "std"), allow(dead_code, unused_imports))]
// Matrix algorithms read best with indices.
#![allow(clippy::needless_range_loop)]

// Generated code refers to this crate as `::lagrange_core`, also inside the crate.
#[cfg(feature = "alloc")]
extern crate alloc;
extern crate self as lagrange_core;

#[cfg(feature = "alloc")]
mod cone;
pub mod contact;
mod derivatives;
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
pub mod generic;
pub mod hamiltonian;
pub mod language;
#[cfg(feature = "alloc")]
pub mod linearized;
pub mod motion;
mod names;
pub mod number;
mod numerics;
#[cfg(feature = "alloc")]
pub mod orbits;
pub mod prelude;
#[cfg_attr(not(feature = "alloc"), path = "room/in_place.rs")]
mod room;
mod solution;
mod statistics;
pub mod structure;
mod system;
#[cfg(feature = "alloc")]
pub mod trajectory;
mod vector;

pub use derivatives::{Jacobian, Linearized, StateDerivatives};
pub use error::{Ending, Error};
pub use function::Function;
pub use hamiltonian::Hamiltonian;
pub use lagrange_macros::Lagrangian;
pub use motion::{Crossing, Dop853, Dopri5, Event, Method, Motion, RungeKutta4, Simulate, runge_kutta_step};
#[cfg(feature = "mpi")]
pub use mpi;
pub use nalgebra;
pub use number::{Broadcast, Dual, PowerSeries, Real, Scalar};
pub use solution::Sample;
pub use statistics::Statistics;
pub use system::{
    ConstraintKind, Entries, Lagrangian, Pack, Packed, Shared, SolutionOf, StateOf, System, TaylorSeries,
};
#[cfg(feature = "std")]
pub use {ensemble::Ensemble, number::Lanes};
#[cfg(feature = "alloc")]
pub use {
    linearized::{Linearization, MotionDerivatives},
    motion::{MotionBuilder, Taylor},
    solution::impact::Impact,
    solution::many_constraints::{ConstraintRows, Correction},
    system::ManyBodies,
    trajectory::{HybridTrajectory, SampledTrajectory, Trajectory},
};

/// State of `N` coordinates: a [`generic::State`] whose length is a number.
pub type State<T, const N: usize> = generic::State<T, nalgebra::Const<N>>;

/// Accelerations and multipliers for `N` coordinates and `M` constraints: a [`generic::Solution`] whose lengths are numbers.
pub type Solution<T, const N: usize, const M: usize> =
    generic::Solution<T, nalgebra::Const<N>, nalgebra::Const<M>>;

/// Direction of differentiation for `N` coordinates: a [`generic::Direction`] whose length is a number.
pub type Direction<T, const N: usize> = generic::Direction<T, nalgebra::Const<N>>;

/// Derivatives of the residuals for `N` coordinates and `M` constraints: a [`generic::ResidualChange`] whose lengths are
/// numbers.
pub type ResidualChange<T, const N: usize, const M: usize> =
    generic::ResidualChange<T, nalgebra::Const<N>, nalgebra::Const<M>>;

/// State of `N` coordinates and momenta: a [`generic::PhaseState`] whose length is a number.
pub type PhaseState<T, const N: usize> = generic::PhaseState<T, nalgebra::Const<N>>;

/// Compiles and runs the program in the README as a doc test.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
