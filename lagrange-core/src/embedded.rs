//! Programs without an operating system: real time, single precision, no allocator.
//!
//! # What is there
//!
//! Without the feature `alloc` there are the equations, [`Simulate::solve`](crate::Simulate::solve), consistent states, the
//! methods except `Taylor`, [`Motion`](crate::Motion) and [`runge_kutta_step`](crate::runge_kutta_step); what stores steps
//! (trajectories, ensembles) is not. In `Cargo.toml`:
//!
//! ```toml
//! [dependencies]
//! lagrange-core = { version = "0.1", default-features = false, features = ["libm"] }
//! ```
//!
//! # In real time
//!
//! [`runge_kutta_step`](crate::runge_kutta_step) takes the same time whatever happens: four evaluations of straight-line code, no
//! decision. What nobody can vouch for is NaN; look at it once a step. A [`Motion`](crate::Motion) with
//! [`RungeKutta4`](crate::RungeKutta4) does the same, projected onto the constraints and with errors by name;
//! with [`Dopri5`](crate::Dopri5) and a tolerance it takes as many steps as that demands, at most
//! [`max_steps`](crate::motion::Adaptive::max_steps) an advance. Without the feature `alloc`
//! none of them allocates, and with it no step does.
//!
//! A motion holds its method's working arrays: some 20 times 2N numbers for `Dopri5` and `Dop853`, 1.6 kB for ten coordinates in
//! `f32`, three states for `RungeKutta4`. The step by itself needs the stack for four slopes.
//!
//! # Single precision
//!
//! Write systems over a type parameter, `struct Pendulum<T> { l: T }`: they run on `f32`, with constants rounded once. But
//! sine and cosine of `f32` are those of `libm`, which computes them in double precision, and brings a reduction of
//! arguments of any size: on a microcontroller with a unit for single precision alone, both are slow and long. A
//! [`Scalar`](crate::Scalar) of one's own, of which the accelerations take what they need, makes them short:
//!
//! ```
#![doc = include_str!("../examples/single_precision.rs")]
//! ```
//!
//! Such a number cannot decide ([`Real`](crate::Real) is `f64` and `f32` alone), so it goes with
//! [`runge_kutta_step`](crate::runge_kutta_step), which needs no decision.
