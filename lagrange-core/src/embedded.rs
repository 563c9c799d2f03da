//! Programs without an operating system: real time, single precision, no allocator.
//!
//! # Available without an allocator
//!
//! Without the feature `alloc` the crate has the equations, [`Simulate::solve`](crate::Simulate::solve),
//! consistent states, Jacobians ([`Linearized::jacobian`](crate::Linearized::jacobian)), the Legendre transform,
//! [`runge_kutta_step`](crate::runge_kutta_step), and [`Motion`](crate::Motion) with its events, by the explicit
//! pairs, [`RungeKutta4`](crate::RungeKutta4) and the methods with steps of one length. All else asks for `alloc`:
//! lookup by name, motions that are integrated from start to end, `Taylor` and `Radau`, contacts, tables, and what
//! derivatives are for. In `Cargo.toml`:
//!
//! ```toml
//! [dependencies]
//! lagrange-core = { version = "0.1", default-features = false, features = ["libm"] }
//! ```
//!
//! # In real time
//!
//! [`runge_kutta_step`](crate::runge_kutta_step) takes constant time: four evaluations of straight-line code
//! without branches. Results that cannot be trusted are NaN; check for NaN once a step. A
//! [`Motion`](crate::Motion) with [`RungeKutta4`](crate::RungeKutta4) takes the same step, then projects the
//! state onto the constraints and reports errors by name. With [`Dopri5`](crate::Dopri5) the tolerance
//! determines the number of steps, at most [`max_steps`](crate::motion::Adaptive::max_steps) per advance.
//! Without the feature `alloc` nothing allocates; with it, no step allocates.
//!
//! A motion contains the working arrays of its method: about 20 times 2N numbers for `Dopri5` and `Dop853`,
//! which is 1.6 kB for ten coordinates in `f32`, and three states for `RungeKutta4`. `runge_kutta_step` alone
//! needs stack space for four slopes.
//!
//! # Single precision
//!
//! A system over a type parameter, `struct Pendulum<T> { l: T }`, runs on `f32`, with constants rounded once.
//! However, sine and cosine of `f32` come from `libm`, which computes in double precision and includes argument
//! reduction for angles of any size. On a microcontroller with a single-precision FPU only, both functions are
//! slow and large. A user-defined [`Scalar`](crate::Scalar) with only the functions that the accelerations need
//! keeps them small and fast:
//!
//! ```
#![doc = include_str!("../examples/single_precision.rs")]
//! ```
//!
//! Such a scalar has no comparisons that a step control could use ([`Real`](crate::Real) is implemented only
//! for `f64` and `f32`). It therefore works with [`runge_kutta_step`](crate::runge_kutta_step), which does not
//! branch.
