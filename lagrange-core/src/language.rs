//! The language of the attributes, with an example of each form.
//!
//! # A system
//!
//! A struct's fields are the parameters. `coordinates` and `lagrangian` are given once, everything else as often as
//! needed (`dissipation` at most once). Attribute order matters among definitions only.
//!
//! ```
//! use lagrange_core::prelude::*;
//!
//! #[derive(Lagrangian)]
//! #[coordinates(theta)]
//! #[lagrangian(m/2 * l^2 * theta_dot^2 + m*g*l*cos(theta))]
//! struct Pendulum { m: f64, l: f64, g: f64 }
//!
//! let pendulum = Pendulum { m: 1.0, l: 2.0, g: 9.81 };
//! let state = pendulum.state_from(&[("theta", 0.3)])?;
//! let solution = pendulum.solve(&state)?;
//! assert!((solution.accelerations[0] + 9.81 / 2.0 * 0.3_f64.sin()).abs() < 1e-14);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # Expressions
//!
//! | written | meaning |
//! |---|---|
//! | `2/5`, `9.81`, `1_000`, `6.02e23` | exact numbers; no suffixes, no hexadecimal |
//! | `t`, `pi` | time, π |
//! | `x`, `x_dot` or `ẋ` | a coordinate and its velocity; `x_ddot` or `ẍ` in observables only |
//! | `+ - * / ^` | the usual precedence; `-x^2` is `-(x^2)`, `^` groups to the right |
//! | `sin cos tan asin acos atan atan2 sinh cosh tanh exp ln sqrt abs` | functions; `atan2(y, x)` |
//! | `der(expr)` | the total time derivative |
//! | `[a, b, c]`, `v[0]`, `dot(v, w)`, `cross(v, w)`, `norm(v)`, `A * v` | vectors, and matrix times vector |
//! | `sum(i in 0..3, expr)` | a sum; ranges are half-open, indices whole numbers |
//! | `lambda(name)` | the multiplier of a constraint, in observables only |
//!
//! Fields, coordinates, definitions and built-in names share one namespace; constraints and observables have one
//! each. A field may be a number, a reference, an array or a nalgebra vector or matrix of numbers; a field that no
//! expression uses may have any type.
//!
//! # Definitions
//!
//! Values, functions and families. A family over 0..n is a vector. Definitions are kept as they are written: what
//! is shared is computed once, and a recursion along a chain costs as much as its length.
//!
//! ```
//! use lagrange_core::prelude::*;
//!
//! /// Three links in a plane, each position and velocity from the one before.
//! #[derive(Lagrangian)]
//! #[coordinates(theta: [3])]
//! #[define(square(x) = x^2)]
//! #[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
//! #[define(vx[i in 1..3] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
//! #[define(y[0] = -l[0]*cos(theta[0]))]
//! #[define(y[i in 1..3] = y[i-1] - l[i]*cos(theta[i]))]
//! #[lagrangian(sum(i in 0..3, m[i]/2*(square(vx[i]) + square(der(y[i]))) - m[i]*g*y[i]))]
//! struct Chain { m: [f64; 3], l: [f64; 3], g: f64 }
//!
//! let chain = Chain { m: [1.0; 3], l: [0.5; 3], g: 9.81 };
//! let hanging = State::at_rest([0.0; 3]);
//! assert_eq!(chain.solve(&hanging)?.accelerations.norm(), 0.0);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # Constraints and multipliers
//!
//! `name: left = right` stands for Φ = left − right. Without velocities it is holonomic and enforced on coordinates
//! and velocities; with them it must be linear in them, and it is enforced on the velocities. Each scalar equation
//! has one multiplier, and the constraint force on coordinate a is Σ_α λ_α F_αa, with F = ∂Φ/∂q or the coefficients
//! of q̇. A vector equation is one constraint a component, `c[0]`, `c[1]`, …; a family is written
//! `rod[i in 0..3]: …`.
//!
//! ```
//! use lagrange_core::prelude::*;
//!
//! /// A bead on a ring that turns at a given rate.
//! #[derive(Lagrangian)]
//! #[coordinates(x, y, z)]
//! #[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
//! #[constraint(ring: x^2 + y^2 + z^2 = a^2)]
//! #[constraint(plane: y*cos(omega*t) = x*sin(omega*t))]
//! #[observable(push = lambda(plane))]
//! struct Bead { m: f64, g: f64, a: f64, omega: f64 }
//!
//! let bead = Bead { m: 0.1, g: 9.81, a: 0.5, omega: 4.0 };
//! let rough = bead.state_from(&[("x", 0.3), ("z", -0.4), ("y_dot", 1.0)])?;
//! let (start, moved) = bead.make_consistent(&rough)?;
//! println!("{moved}");
//! let path = bead.integrate(start, 1.0, Dop853::default())?;
//! let push = path.end().observable("push")?;
//! assert!(push.is_finite());
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # Forces, dissipation, observables
//!
//! ```
//! use lagrange_core::prelude::*;
//!
//! /// A driven, damped oscillator.
//! #[derive(Lagrangian)]
//! #[coordinates(x)]
//! #[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
//! #[dissipation(c/2 * x_dot^2)]
//! #[force(x: f * cos(omega*t))]
//! #[observable(power = f * cos(omega*t) * x_dot)]
//! #[observable(felt = x_ddot)]
//! struct Oscillator { m: f64, k: f64, c: f64, f: f64, omega: f64 }
//!
//! let oscillator = Oscillator { m: 1.0, k: 4.0, c: 0.1, f: 1.0, omega: 2.0 };
//! let state = State::new([0.5], [1.0]);
//! let solution = oscillator.solve(&state)?;
//! assert_eq!(oscillator.power(&state), 1.0);
//! // What needs accelerations or multipliers takes the solution too.
//! assert!((oscillator.felt(&state, &solution) - (1.0 - 0.1 - 2.0)).abs() < 1e-15);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # What is conserved
//!
//! The derive finds cyclic coordinates and their momenta, whether the energy E = p·q̇ − L is conserved and whether it
//! is T + U, and terms of L that are total time derivatives; constraints and forces are taken into account. All of it
//! is in [`FACTS`](crate::Lagrangian::FACTS), with how sure it is: proved by the form of the expressions, or seen to
//! hold at random states that satisfy the constraints.
//!
//! `#[conserved(name = expression)]` is an observable that must be conserved. The derive evaluates its rate of change
//! on such states, with random parameters and random functions in place of those that the user supplies; where it is
//! not zero within rounding, that is a compile error with the numbers. A
//! [`Trajectory`](crate::Trajectory::drift) reports how far each conserved quantity strays.
//!
#![cfg_attr(
    feature = "std",
    doc = r#"
```
use lagrange_core::prelude::*;

/// A pendulum bob on a string.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(string: x^2 + y^2 + z^2 = l^2)]
#[conserved(l_z = m*(x*y_dot - y*x_dot))]
struct Bob { m: f64, g: f64, l: f64 }

assert_eq!(Bob::FACTS.energy_is_conserved, Some(Evidence::Proved));
let bob = Bob { m: 0.1, g: 9.81, l: 0.5 };
let path = bob.integrate(State::new([0.3, 0.0, -0.4], [0.0, 1.0, 0.0]), 5.0, Dop853::default())?;
println!("{}", path.drift());
assert!(path.drift().iter().all(|quantity| quantity.largest < 1e-6));
# Ok::<(), Error>(())
```
"#
)]
//!
//! ```compile_fail
//! use lagrange_core::prelude::*;
//!
//! #[derive(Lagrangian)]
//! #[coordinates(x, y)]
//! #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - k/2 * (x^2 + 2*y^2))]
//! #[conserved(rotation = m*(x*y_dot - y*x_dot))] // the springs differ
//! struct TwoSprings { m: f64, k: f64 }
//! ```
//!
//! # Number types
//!
//! The number type is what the fields in use are made of, else `f64`. With a type parameter one derive serves
//! `f64`, `f32`, SIMD lanes and dual numbers; the bound [`Scalar`](crate::Scalar) is added where it is needed.
//!
//! ```
//! use lagrange_core::prelude::*;
//!
//! #[derive(Lagrangian)]
//! #[coordinates(x)]
//! #[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
//! struct Spring<T> { m: T, k: T }
//!
//! let single = Spring { m: 1.0_f32, k: 4.0 };
//! assert_eq!(single.accelerations(&State::new([0.5], [0.0])).accelerations[0], -2.0);
//! ```
