//! Language of the attributes, with an example of each form.
//!
//! # A system
//!
//! The fields of a struct are the parameters. `coordinates` and `lagrangian` are given once, `dissipation` at most
//! once, all other attributes as often as needed, or once with several statements separated by `;`. The order of
//! attributes matters among definitions only.
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
//! Several statements in one attribute:
//!
//! ```
//! # use lagrange_core::prelude::*;
//! #[derive(Lagrangian)]
//! #[coordinates(x, y)]
//! #[lagrangian(m/2*(x_dot^2 + y_dot^2))]
//! #[force(x: wind - drag*x_dot; y: -drag*y_dot - m*g)]
//! #[observable(
//!     speed = sqrt(x_dot^2 + y_dot^2);
//!     height = y
//! )]
//! struct Kite { m: f64, g: f64, drag: f64, wind: f64 }
//!
//! let kite = Kite { m: 0.5, g: 9.81, drag: 0.2, wind: 3.0 };
//! let solution = kite.solve(&State::at_rest([0.0, 4.0]))?;
//! assert_eq!((solution.accelerations[0], solution.accelerations[1]), (6.0, -9.81));
//! assert_eq!(Kite::OBSERVABLES, ["speed", "height"]);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # Expressions
//!
//! | written | meaning |
//! |---|---|
//! | `2/5`, `9.81`, `1_000`, `6.62607015e-34` | exact numbers, in the range of `f64`. A result of more than 38 digits, such as a product of three numbers of 16 digits, is rounded once, to the nearest `f64`; sums of such numbers that cancel within their rounding are zero. No suffixes, no hexadecimal |
//! | `t`, `pi` | time, π |
//! | `x`, `x_dot` or `ẋ` | a coordinate and its velocity; `x_ddot` or `ẍ` in observables only |
//! | `+ - * / ^` | the usual precedence; `-x^2` is `-(x^2)`, `^` groups to the right |
//! | `sin cos tan asin acos atan atan2 sinh cosh tanh exp ln sqrt abs` | functions; `atan2(y, x)` |
//! | `min(x, y)`, `max(x, y)`, `clamp(x, low, high)` | limits, in forces and observables only: a Lagrangian, a constraint or a frame must be differentiable everywhere |
//! | `der(expr)` | the total time derivative |
//! | `base.m`, `link[2].c[0]` | members of fields that are structs, with the declared shapes |
//! | `[a, b, c]`, `v[0]`, `v[1..3]`, `dot(v, w)`, `cross(v, w)`, `norm(v)` | vectors |
//! | `[[a, b], [c, d]]`, `A[0][1]`, `A*v`, `v*A`, `A*B`, `transpose(A)`, `trace(A)`, `identity(3)`, `skew(v)` | matrices, written by rows |
//! | `rot_x(angle)`, `rot_y(angle)`, `rot_z(angle)`, `rot(axis, angle)` | rotation matrices |
//! | `quat_rotate(q, v)`, `quat_mul(p, q)`, `quat_conj(q)`, `quat_rate(q, q_dot)`, `quat_rate_body(q, q_dot)` | orientations as quaternions |
//! | `sum(i in 0..3, expr)` | a sum; ranges are half-open, indices whole numbers |
//! | `lambda(name)` | the multiplier of a constraint, in observables only |
//!
//! Fields, coordinates, definitions and built-in names share one namespace; constraints have their own, and so have
//! observables. A field may be a number, a reference, or an array. It may be a vector, matrix, rotation (`Rotation3`)
//! or quaternion (`UnitQuaternion`, which is (w, x, y, z) in expressions) of nalgebra, or an array of these, or a
//! struct (below). A field that no expression uses may have any type.
//!
//! `#[parameter(inertia: symmetric)]` declares that a field holds symmetric matrices: of the two entries across the
//! diagonal only one is a parameter, which saves operations. `#[parameter(turn: rotation)]` declares rotations, as the
//! type `Rotation3` does. Random checks respect the declaration, and your values must: `solve`, and every function that
//! starts from a state, returns [`Error::ParameterNotAsSaid`](crate::Error::ParameterNotAsSaid) if a matrix is off by
//! more than round-off (ε^(2/3) of its size, 4·10⁻¹¹ for `f64`). The functions ending in `_unchecked` do not check.
//!
//! The macro writes out all sums and families over numbers at compile time. So ranges have at most 10,000 elements, the
//! expressions of a system use at most 10,000 numbers of its fields, and there are at most 1,000 coordinates and 1,000
//! constraints. Lengths that have names instead become loops ([any number of bodies](#any-number-of-bodies)). A supplied
//! function (below) may contain a loop, too.
//!
//! # Structs among the fields
//!
//! Related parameters may be grouped in a struct, `link[i].m` beside `link[i].c`. A derive macro cannot see another
//! type, so the attribute declares it: `#[parameter(link: [6] {m, c: [3]})]` tells the number of structs, if the field
//! holds several, and the shapes of the members that expressions use.
//!
//! | declared | type of the member |
//! |---|---|
//! | `m` | a number |
//! | `c: [3]` | `[f64; 3]` or `Vector3<f64>` |
//! | `A: [3, 3]` | `[[f64; 3]; 3]` or `Matrix3<f64>` |
//! | `I: symmetric` | the same: a symmetric 3×3 matrix |
//! | `R: rotation` | the same or `Rotation3<f64>`: a rotation |
//! | `q: quaternion` | `UnitQuaternion<f64>` |
//! | `place: pose` | `Isometry3<f64>`, with the members `translation`, a vector, and `rotation`, a quaternion |
//! | `tip: {m, c: [3]}`, `wheel: [4] {m}` | a nested struct, or an array of structs |
//!
//! The field may own the structs, be a reference to them, a smart pointer, or a `Vec` of the declared length. If the
//! struct lacks a declared member, or has it with another type, the declaration does not compile. Members declared
//! symmetric or rotations are checked like other fields. The members are parameters, named as in expressions; members
//! of nested structs, and those behind references, cannot be set. A field of type `Isometry3` is a pose without a
//! declaration; the step `pose(place)` of a frame uses it as a whole.
//!
//! ```
//! use lagrange_core::nalgebra::{Isometry3, Vector3};
//! use lagrange_core::prelude::*;
//!
//! struct Rod { m: f64, l: f64 }
//!
//! /// Two rods, one on the other, hung up somewhere.
//! #[derive(Lagrangian)]
//! #[coordinates(q: [2])]
//! #[parameter(rod: [2] {m, l})]
//! #[frame(upper: pose(place), rotate_z(q[0]))]
//! #[frame(lower in upper: translate([rod[0].l, 0, 0]), rotate_z(q[1]))]
//! #[define(point(i) = [rod[i].l/2, 0, 0])]
//! #[define(ends(i) = rod[i].m*rod[i].l^2/12*[[0, 0, 0], [0, 1, 0], [0, 0, 1]])]
//! #[define(height = rod[0].m*position(upper, point(0))[1] + rod[1].m*position(lower, point(1))[1])]
//! #[lagrangian(kinetic(upper, rod[0].m, point(0), ends(0)) + kinetic(lower, rod[1].m, point(1), ends(1)) - g*height)]
//! struct Rods { rod: [Rod; 2], place: Isometry3<f64>, g: f64 }
//!
//! let place = Isometry3::new(Vector3::zeros(), -core::f64::consts::FRAC_PI_2 * Vector3::z());
//! let rods = Rods { rod: [Rod { m: 2.0, l: 1.0 }, Rod { m: 1.0, l: 0.5 }], place, g: 9.81 };
//! // They hang straight down.
//! assert!(rods.solve(&State::at_rest([0.0; 2]))?.accelerations.norm() < 1e-12);
//! assert!(Rods::PARAMETERS.contains(&"rod[1].l") && Rods::PARAMETERS.contains(&"place.rotation[0]"));
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # Definitions
//!
//! A definition is a value, a function or a family. A family over 0..n is a vector; one with two indices, `#[define(d[i
//! in 0..3, j in 0..3] = …)]`, is a matrix with the entries `d[i][j]`. The range of an index may depend on the indices
//! before it, `d[i in 0..3, j in 0..i]`.
//!
//! A definition precedes its uses, except for elements of families: an element that a family needs, of another family
//! or its own, is computed first. So two recursions may use each other, and one may run from its end, `#[define(p[i in
//! 0..4] = a[i] + x*p[i+1])]`.
//!
//! Definitions are kept as written: shared expressions are computed once, and a recursion along a chain costs
//! operations in proportion to its length. The same holds for solving for the accelerations: if it makes the equations
//! sparse, the rates of defined velocities become unknowns beside the accelerations (the articulated-body algorithm).
//! So define the velocities of a chain or a tree, or its positions with `der(…)` in L. A recursion, `x[i] = x[i-1] +
//! …`, and a sum, `x[i] = sum(j in 0..i+1, …)`, cost the same: sums in L with common terms are factored into shared
//! partial sums (but not in systems with frames). If bodies rotate in space, declare their [frames](#frames) instead,
//! which costs a fraction.
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
//! # Vectors
//!
//! A coordinate `r: [3]` is a vector, with the velocity `r_dot` and the entries `r[0]`; so is a field of type `[f64;
//! 3]` or `Vector3<f64>`. A coordinate `r: [4, 3]` is an array of four vectors `r[i]` with velocities `r_dot[i]`. Its
//! entries are `r[i][j]`, in states, tables and equations too. Vectors of the same length can be added, and multiplied
//! or divided by numbers; the literal 0 is the zero vector. `norm(v)^2` is `dot(v, v)`, without the square root, which
//! has no derivative at the origin. Definitions, forces, constraints and observables may be vectors; L is a number. A
//! force on a whole coordinate has its shape; `#[force(r[1]: …)]` acts on one vector of an array, `#[force(r[1][2]:
//! …)]` on an entry, `#[force(r[i in 0..4]: …)]` on each vector.
//!
//! ```
//! use lagrange_core::prelude::*;
//!
//! /// Four beads on a string of three pieces, in the wind.
//! #[derive(Lagrangian)]
//! #[coordinates(r: [4, 3])]
//! #[lagrangian(sum(i in 0..4, m/2*dot(r_dot[i], r_dot[i]) - m*g*r[i][2]))]
//! #[constraint(rod[i in 0..3]: norm(r[i+1] - r[i])^2 = l^2)]
//! #[force(r[i in 0..4]: c*(wind - r_dot[i]))]
//! #[observable(height[i in 0..4] = r[i][2])]
//! struct Beads { m: f64, g: f64, l: f64, c: f64, wind: [f64; 3] }
//!
//! let beads = Beads { m: 0.1, g: 9.81, l: 0.5, c: 0.1, wind: [2.0, 0.0, 0.0] };
//! let rough = beads.state_from(&[("r[1][0]", 0.5), ("r[2][0]", 1.0), ("r[3][0]", 1.5), ("r_dot[3][1]", 1.0)])?;
//! let (start, _) = beads.make_consistent(&rough)?;
//! let path = beads.integrate(start, 20.0, Dop853::default())?;
//! // In the end it falls as fast as the air lets it, all beads alike.
//! let end = path.end();
//! assert!((end.velocity("r[2][2]")? + 0.1 * 9.81 / 0.1).abs() < 1e-4);
//! assert_eq!(beads.height(end.state())[3], end.observable("height[3]")?);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! A field `[[f64; 3]; 2]` or `Matrix3<f64>` is a matrix, and so are rows of numbers, `[[a, b], [c, d]]`. In `A*v` the
//! vector is a column, in `v*A` a row; `skew(v)*w` is `cross(v, w)`. `rot_z(a)` rotates a vector by the angle a from x
//! towards y, `rot_x(a)` from y towards z, `rot_y(a)` from z towards x. With Euler's angles, R = rot_z(φ) rot_x(θ)
//! rot_z(ψ) maps components in the body frame to components in the fixed frame, and `transpose(R)*der(R)` is `skew` of
//! the angular velocity in the body frame. The axis of `rot(axis, a)` may have any length except zero.
//!
//! ```
//! use lagrange_core::nalgebra::Vector3;
//! use lagrange_core::prelude::*;
//!
//! /// Two links that turn about axes across each other, with a mass at the tip.
//! #[derive(Lagrangian)]
//! #[coordinates(yaw, pitch)]
//! #[define(tip = rot_z(yaw)*(base + rot_y(pitch)*link))]
//! #[lagrangian(m/2*dot(der(tip), der(tip)) - m*g*tip[2])]
//! #[observable(position = tip)]
//! struct Arm { base: Vector3<f64>, link: Vector3<f64>, m: f64, g: f64 }
//!
//! let (base, link) = (Vector3::new(0.0, 0.0, 1.0), Vector3::new(0.5, 0.0, 0.0));
//! let arm = Arm { base, link, m: 2.0, g: 9.81 };
//! // A quarter of a turn to the left, the link straight down.
//! let quarter = core::f64::consts::FRAC_PI_2;
//! let tip = arm.position(&State::at_rest([quarter, quarter]));
//! assert!((tip - Vector3::new(0.0, 0.0, 0.5)).norm() < 1e-15);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! A quaternion is a vector of 4, (w, x, y, z). `quat_rotate(q, v)` rotates v, from the body frame to the fixed frame.
//! `quat_rate(q, q_dot)` is the angular velocity in the fixed frame, the vector part of 2 q̇ q̄; `quat_rate_body(q,
//! q_dot)` in the body frame, that of 2 q̄ q̇. `quat_mul(p, q)` is Hamilton's product, as rotations first q and then p;
//! `quat_conj(q)` is q̄. No function divides by |q|²: the constraint `dot(q, q) = 1` keeps it 1. The mass matrix alone
//! is singular; the macro completes it by the row of this constraint, and L needs no extra term.
//!
//! ```
//! use lagrange_core::nalgebra::{Matrix3, Vector3};
//! use lagrange_core::prelude::*;
//!
//! /// A heavy rigid body that turns about a fixed point.
//! #[derive(Lagrangian)]
//! #[coordinates(q: [4])]
//! #[define(w = quat_rate_body(q, q_dot))]
//! #[lagrangian(dot(w, inertia*w)/2 - m*g*quat_rotate(q, centre)[2])]
//! #[constraint(unit: dot(q, q) = 1)]
//! #[observable(spin = quat_rotate(q, inertia*w))]
//! struct Top { inertia: Matrix3<f64>, centre: Vector3<f64>, m: f64, g: f64 }
//!
//! let inertia = Matrix3::from_diagonal(&Vector3::new(2.0, 2.0, 1.0));
//! let top = Top { inertia, centre: Vector3::new(0.0, 0.0, 0.5), m: 1.0, g: 9.81 };
//! // Tilted by 60° about the x-axis, turning about its own axis: q̇ = ½ q (0, 0, 20).
//! let (c, s) = (0.75_f64.sqrt(), 0.5);
//! let start = State::new([c, s, 0.0, 0.0], [0.0, 0.0, -10.0 * s, 10.0 * c]);
//! let path = top.integrate(start, 1.0, Dop853::default())?;
//! // Gravity has no torque about the vertical.
//! let (before, after) = (top.spin(&start)[2], path.end().observable("spin[2]")?);
//! assert!((after / before - 1.0).abs() < 1e-8);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # Frames
//!
//! `#[frame(name in parent: step, step, …)]` declares a frame by the steps that lead to it from its parent. Each step
//! acts in the axes reached by the steps before. Without `in` the parent is the frame at rest, which is called `fixed`.
//! A family, `link[i in 1..6] in link[i-1]`, is a chain. With a table of whole numbers, `#[define(parent = [0, 0, 1,
//! 1])]` and `part[i in 1..4] in part[parent[i]]`, it is a tree; with two indices, `leg[i in 0..4, j in 1..3] in
//! leg[i][j-1]`, several chains. Families may alternate, as for joints about two successive axes: `a[i in 1..6] in
//! b[i-1]` and `b[i in 0..6] in a[i]`.
//!
//! | step | |
//! |---|---|
//! | `translate(v)` | moves the origin by a vector |
//! | `rotate_x(angle)`, `rotate_y`, `rotate_z` | rotates about an axis of its own, by the right-hand rule |
//! | `rotate(axis, angle)` | rotates about any axis, of any length |
//! | `rotate(q)` | rotates by a quaternion (w, x, y, z), of any length except zero. For a coordinate the macro adds the constraint `dot(q, q) = 1` with the coordinate's name, after the constraints that you declare; for each `rotate(q[i])` of a coordinate `q: [3, 4]` likewise, with the name `q[i]`. Several of them come in the order in which the declared frames first use their coordinates |
//! | `rotate(R)` | rotates by a rotation matrix, which maps components along the new axes to components along the old: a `Rotation3`, a `Matrix3` with `#[parameter(R: rotation)]`, or a product of rotations, which is applied one rotation at a time |
//! | `pose(place)` | `translate(place.translation), rotate(place.rotation)`: moves by an `Isometry3`, which maps a point r of the new frame to R r + t in the old |
//!
//! The arguments of a step may depend on coordinates, for a joint, and on time, for a prescribed motion.
//!
//! | | |
//! |---|---|
//! | `position(frame, point)` | position of a point relative to the origin of the fixed frame, along the fixed axes. The point is given by its components in `frame`; without it, the origin of `frame` |
//! | `velocity(frame, point)` | velocity of the point relative to the fixed frame, along the axes of `frame`; it includes a motion of the point within the frame. The material at a moving point, such as the contact of a wheel with the ground, has the velocity `velocity(wheel) + cross(angular_velocity(wheel), point)` |
//! | `angular_velocity(frame)` | angular velocity relative to the fixed frame, along the axes of `frame` |
//! | `jacobian(v)` | Jacobian ∂v/∂q̇ of a velocity, linear, angular or any other, in observables only: one row per component, one column per coordinate. The generalized force Jᵀ·force of a force along v is `#[power(force, v)]` |
//! | `kinetic(frame, m, c, I)` | kinetic energy of a rigid body: mass, centre of mass, inertia about the centre of mass, all in the axes of `frame`. Without `I` it is a point mass, without `c` a point mass at the origin. Each argument may depend on time, coordinates and supplied functions, `m` and `I` also on velocities; the equations then contain the terms ṁ u, İ ω, ∂m/∂q u²/2 and ω·∂I/∂q ω/2. Off-diagonal entries of `I` that differ for all parameters are an error; if the values of fields decide, as for a matrix field, the symmetric part (I + Iᵀ)/2 is used |
//! | `express(v, frame)` | the same vector with components along the axes of another frame |
//! | `vector(frame, [a, b, c])` | the vector with these components along the axes of `frame` |
//! | `der(v)`, `der(v, frame)` | rate of change of a vector in the fixed frame, or in another frame: (dv/dt)_B = dv/dt − ω_B × v |
//!
//! Each vector has the axes of a frame. Vectors of different frames can neither be added nor multiplied before one is
//! expressed in the axes of the other; `v[0]` is a component along an axis of the vector's own frame. Plain numbers,
//! `[1, 0, 0]` or a field, take the axes of the vector that they are combined with. A vector computed from coordinates
//! must declare its axes, `vector(fixed, r_dot)`.
//!
//! ```
//! use lagrange_core::nalgebra::{Matrix3, Vector3};
//! use lagrange_core::prelude::*;
//!
//! /// A car that pulls a trailer. Its wheels do not slip sideways.
//! #[derive(Lagrangian)]
//! #[coordinates(x, y, heading, hitch)]
//! #[frame(car: translate([x, y, 0]), rotate_z(heading))]
//! #[frame(trailer in car: translate([-b, 0, 0]), rotate_z(hitch), translate([-l, 0, 0]))]
//! #[lagrangian(kinetic(car, m, centre, inertia) + kinetic(trailer, m, [0, 0, 0], inertia))]
//! #[constraint(rear_axle: velocity(car)[1] = 0)]
//! #[constraint(trailing_axle: velocity(trailer)[1] = 0)]
//! #[observable(ahead = velocity(car)[0])]
//! #[observable(J = jacobian(express(velocity(car, seat), fixed)))]
//! #[observable(felt = der(velocity(car, seat)))]
//! struct Car { m: f64, b: f64, l: f64, centre: Vector3<f64>, inertia: Matrix3<f64>, seat: Vector3<f64> }
//!
//! let inertia = Matrix3::from_diagonal_element(2.0);
//! let [centre, seat] = [Vector3::new(0.5, 0.0, 0.0), Vector3::new(1.0, 0.3, 0.0)];
//! let car = Car { m: 1.0, b: 0.5, l: 2.0, centre, inertia, seat };
//! // Pulled ahead, the trailer falls into line, and the seat comes to rest in a frame that does not turn.
//! let (start, _) = car.make_consistent(&State::new([0.0, 0.0, 0.0, 0.3], [1.0, 0.0, 0.0, 0.0]))?;
//! let path = car.integrate(start, 60.0, Dop853::default())?;
//! assert!(path.end().observable("ahead")? > 0.9);
//! assert!(path.end().coordinate("hitch")?.abs() < 1e-5);
//! assert!(path.end().observable("felt[1]")?.abs() < 1e-5);
//! // Turned by its heading alone, the seat moves across its distance from the axle.
//! assert_eq!(car.J(&State::at_rest([0.0; 4])).column(2), Vector3::new(-0.3, 1.0, 0.0));
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! Frames are faster as well as shorter to write. The macro propagates velocities from frame to frame without
//! differentiating them. Accelerations come from the Newton–Euler recursions with composite rigid-body inertias, or
//! from the articulated-body algorithm, whichever is faster (Featherstone, *Rigid Body Dynamics Algorithms*). An arm of
//! six joints takes some 2,300 operations this way, and four times as many by `der` of positions along the fixed axes.
//! If `der` differentiates three or more successive rotations, the documentation of the struct's equations says so.
//! Unused quantities are not computed: a potential `m*g*position(body, c)[2]` needs one row of a rotation, or none.
//!
//! # Functions that you supply
//!
//! `#[function(U(r) = field)]` makes a field a function: a potential, a field, a prescribed motion. Without `= field`
//! it is the field of the function's own name. A formal argument with the name of a coordinate has its shape; other
//! shapes are declared, `U(s: [3])`, or else the argument is a number. `A(r): [3]` returns a vector. A call takes any
//! expressions of these shapes. The macro takes `der(Omega(t))` and all derivatives that the equations need.
//!
//! The field's type implements [`Function<I, O>`](crate::Function) with `I` numbers, all arguments together, and `O`
//! results. It is written once for every scalar type, which provides its derivatives and lets the system work with
//! every number type. (A closure takes one type of number, so it cannot be used.)
//!
//! ```
//! use lagrange_core::prelude::*;
//!
//! /// The support moves up and down.
//! struct Shaking { amplitude: f64, rate: f64 }
//!
//! impl Function<1, 2> for Shaking {
//!     fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 2] {
//!         [S::constant(0.0), S::constant(self.amplitude) * (S::constant(self.rate) * t).cos()]
//!     }
//! }
//!
//! /// Kapitza's pendulum: it stands on its head.
//! #[derive(Lagrangian)]
//! #[coordinates(theta)]
//! #[function(support(t): [2] = motion)]
//! #[define(p = support(t) + l*[sin(theta), -cos(theta)])]
//! #[lagrangian(m/2 * dot(der(p), der(p)) - m*g*p[1])]
//! struct Kapitza<F> { m: f64, l: f64, g: f64, motion: F }
//!
//! let pendulum = Kapitza { m: 1.0, l: 1.0, g: 9.81, motion: Shaking { amplitude: 0.1, rate: 100.0 } };
//! let upright = core::f64::consts::PI;
//! let path = pendulum.integrate(State::at_rest([upright + 0.1]), 10.0, Dop853::default())?;
//! assert!((path.end().coordinate("theta")? - upright).abs() < 0.2);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! For `f64` alone there are two further forms. A [`FunctionWithDerivatives`](crate::function::FunctionWithDerivatives)
//! returns its value, gradient and second derivatives, and is wrapped in
//! [`WithDerivatives`](crate::function::WithDerivatives); [`check_derivatives`](crate::function::check_derivatives)
//! compares them with finite differences. A [`Table`](crate::function::Table) interpolates measured points with two
//! continuous derivatives, a [`SmoothTable`](crate::function::SmoothTable) with four, with which integration keeps its
//! accuracy.
//!
//! Of these, only a `SmoothTable` has third derivatives: if the equations need one, another form is a compile error at
//! the field's type. [`Linearized`](crate::Linearized) needs one derivative more than the equations: if that is the
//! third, the system lacks this trait for the other forms, and nothing else. [`Taylor`](crate::Taylor) requires a
//! `Function`. Numbers inside a function are not parameters of the system: nothing is differentiated by them, and no
//! search changes them.
//!
//! ```
//! use lagrange_core::{prelude::*, function::WithDerivatives};
//! use lagrange_core::function::{FunctionWithDerivatives, Table};
//!
//! /// z = x² − y²
//! struct Saddle;
//!
//! impl FunctionWithDerivatives<2, 1> for Saddle {
//!     fn value(&self, [x, y]: [f64; 2]) -> [f64; 1] {
//!         [x * x - y * y]
//!     }
//!     fn gradient(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 1] {
//!         [[2.0 * x, -2.0 * y]]
//!     }
//!     fn hessian(&self, _: [f64; 2]) -> [[[f64; 2]; 2]; 1] {
//!         [[[2.0, 0.0], [0.0, -2.0]]]
//!     }
//! }
//!
//! /// A bead on a surface, under a measured force potential along x.
//! #[derive(Lagrangian)]
//! #[coordinates(x, y, z)]
//! #[function(f(x, y) = surface)]
//! #[function(U(x) = potential)]
//! #[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z - U(x))]
//! #[constraint(on: z = f(x, y))]
//! struct Bead { m: f64, g: f64, surface: WithDerivatives<Saddle>, potential: Table }
//!
//! let potential = Table::new(&[(-2.0, 0.0), (0.0, 0.0), (1.0, 0.5), (2.0, 3.0)])?;
//! let bead = Bead { m: 1.0, g: 9.81, surface: WithDerivatives(Saddle), potential };
//! let start = State::new([0.0; 3], [1.0, 2.0, 0.0]);
//! // At the saddle z̈ = 2 ẋ² − 2 ẏ².
//! let solution = bead.solve(&start)?;
//! assert!((solution.accelerations[2] - (2.0 - 8.0)).abs() < 1e-12);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # Constraints and multipliers
//!
//! `name: left = right` means Φ = 0 with Φ = left − right. A constraint without velocities is holonomic, and is
//! enforced on coordinates and velocities. A constraint with velocities must be linear in them, and is enforced on the
//! velocities. Each scalar equation has one multiplier, and the constraint force on coordinate a is Σ_α λ_α F_αa, with
//! F = ∂Φ/∂q or the coefficients of q̇. A vector equation gives one constraint per component, `c[0]`, `c[1]`, …. A
//! family is written `rod[i in 0..3]: …` or, with two indices, `rod[i in 0..3, j in 0..i]: …`.
//!
//! A constraint that contradicts others, `y = 0` and `y = 1`, or follows from them is a compile error if that is
//! certain: its row of F is a combination of the other rows at every state and for all parameters. Examples are `x_dot
//! = a*phi_dot` beside `x = a*phi`, the sum of two others, and `x_dot = v*cos(th)` beside the two components of the
//! velocity along and across `th`.
//!
//! Other rows are dependent only on the constraints, as in some closed linkages, at some poses or for some parameters.
//! These are detected numerically: the motion is correct, and the multipliers are those of least norm, in units in which
//! the rows of F have length 1: a constraint that is stated twice carries half of the force by each. Constraints that
//! are dependent only to first order, such as `|a| = l`, `|b| = l` and `|a - b| = 2*l`, are an error as soon as a
//! motion starts.
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
//! The macro determines at compile time whether velocity constraints are integrable, each alone and all together; see
//! [`Integrability`](crate::facts::Integrability). An integral that it finds is a method of the system, and is printed
//! with the equations.
//!
//! ```
//! use lagrange_core::{prelude::*, facts::{Classification, Evidence, Extent, Integrability, Integrals}};
//!
//! /// A cylinder that rolls, and a skate beside it.
//! #[derive(Lagrangian)]
//! #[coordinates(x, phi, u, v, theta)]
//! #[lagrangian(x_dot^2 + phi_dot^2 + u_dot^2 + v_dot^2 + theta_dot^2)]
//! #[constraint(no_slip: x_dot - a*phi_dot = 0)]
//! #[constraint(edge: u_dot*sin(theta) - v_dot*cos(theta) = 0)]
//! struct Pair { a: f64 }
//!
//! let [no_slip, edge] = [0, 1].map(|index| Pair::CONSTRAINT_CLASSES[index]);
//! assert_eq!(no_slip.integrability, Integrability::Exact);
//! assert_eq!(edge, Classification { integrability: Integrability::Nonholonomic, evidence: Evidence::Proved });
//! assert_eq!(Pair::INTEGRALS.map(Integrals::extent), Some(Extent::Some));
//! assert!(Pair::equations().text().contains("integrable: x − a φ is constant"));
//! let state = State::at_rest([3.0, 1.0, 0.0, 0.0, 0.0]);
//! assert_eq!(Pair { a: 0.5 }.constraint_integral(0, &state), Some(2.5));
//! ```
//!
//! # Contacts, and constraints that come and go
//!
//! A gap that never becomes negative is a contact: `#[contact(floor: y - r >= 0, restitution: e)]`. The gap is a function of
//! coordinates and time, and its multiplier is never negative: 0 ≤ gap ⊥ λ ≥ 0. A field of the same name and of the type
//! [`Contact`](crate::contact::Contact), or an array of them for a family, says whether it is closed. With restitution, a gap
//! that closes at the rate v opens at the rate −e v; without, it stays closed as long as the contact pushes. This is Newton's
//! law; `restitution(poisson): e` is [Poisson's](crate::contact#poissons-law-of-impact), by which an impulse Λ that stops the gap is
//! followed by e Λ.
//!
//! `friction(mu): x_dot - r*phi_dot` after the gap adds Coulomb's friction, along a velocity that is linear in q̇ or a vector
//! of two, with a multiplier `floor_friction`; `friction(static: mu, kinetic: nu): …` has a coefficient while bodies stick and one while
//! they slide. `#[friction(belt: x_dot - speed, limit: hold, sliding: pull)]` is dry friction
//! with bounds of its own, by a field `belt` of the type [`Friction`](crate::contact::Friction): it keeps the velocity at zero
//! with a force up to `limit`, and else pulls against it with `sliding`. The bounds are numbers ≥ 0, and may depend on the state.
//!
//! `motion(start).with_contacts().to(end)` goes from impact to impact, and opens and closes the contacts. A motion without
//! `with_contacts` does not compile.
//!
//! A constraint may be switched as well, `#[constraint(grip: x = y, when: held)]`, by a field of the type `bool`, or by an array
//! of them for a family. While it is off, its row of F, its residual and its multiplier are zero. What the macro proves of
//! constraints, as that one follows from others, it does not ask of those that come and go.
//!
//! ```
//! use lagrange_core::contact::Contact;
//! use lagrange_core::prelude::*;
//!
//! /// A block that a hand holds above a table.
//! #[derive(Clone, Lagrangian)]
//! #[coordinates(y)]
//! #[lagrangian(m/2 * y_dot^2 - m*g*y)]
//! #[contact(table: y >= 0, restitution: e)]
//! #[constraint(hand: y = height, when: held)]
//! struct Block { m: f64, g: f64, e: f64, height: f64, table: Contact, held: bool }
//!
//! let held = Block { m: 2.0, g: 9.81, e: 0.5, height: 1.0, table: Contact::Open, held: true };
//! let start = State::at_rest([1.0]);
//! assert_eq!(held.solve(&start)?.multipliers.as_slice(), [0.0, 2.0 * 9.81]);
//! let path = Block { held: false, ..held }.motion(start).with_contacts().to(5.0)?;
//! assert_eq!((path.end().state().q[0], path.system().table), (0.0, Contact::Closed));
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # Forces, dissipation, observables
//!
//! An observable is a method with its name that returns a number, a vector (`SVector`) or a matrix (`SMatrix`); its
//! entries have names like `spin[2]` and `turn[0][1]`. A family, `#[observable(height[i in 0..3] = y[i])]`, is one
//! vector; a family of vectors is a matrix, with one vector per row. Forces may be families too, `#[force(theta[i in
//! 0..3]: -k[i]*theta_dot[i])]`, and so may powers: `#[power(i in 0..3, push[i], velocity(leg[i], foot))]` adds one for
//! each i.
//!
//! `#[power(f, v)]` adds a force f along a velocity v, with the power f·v. Both have components along the same axes:
//! plain numbers take the axes of v, and those of `velocity(rod, …)` rotate with `rod`. A weight keeps its direction:
//! `#[power([0, 0, -m*g], express(velocity(rod, …), fixed))]`.
//!
//! `#[dissipation(D)]` is Rayleigh's dissipation function: the force is −∂D/∂q̇, and removes the power q̇·∂D/∂q̇ from
//! the motion. A function that certainly removes none is an error: one without velocities, one odd in them such as
//! `c*x_dot`, and one whose power is nowhere positive as long as no parameter is negative, such as `-c/2*x_dot^2`. A
//! driving force belongs in `#[force(…)]`.
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
//! // Observables of accelerations or multipliers take the solution too.
//! assert!((oscillator.felt(&state, &solution) - (1.0 - 0.1 - 2.0)).abs() < 1e-15);
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # What is conserved
//!
//! The macro finds cyclic coordinates and their momenta, decides whether the energy E = p·q̇ − L is conserved and which
//! form it has ([`EnergyForm`](crate::facts::EnergyForm): T + U only if that is certain), and finds terms of L that are
//! total time derivatives. It takes constraints and forces into account. The results are in
//! [`FACTS`](crate::Lagrangian::FACTS), each with its evidence: proved from the form of the expressions, or observed at
//! random states that satisfy the constraints. Such states may all lie on one side of a kink of `max`, `min`, `clamp`,
//! `abs` or √(x²), so that expressions with kinks need a proof.
//!
//! `#[conserved(name = expression)]` is an observable that must be conserved. The macro evaluates its rate of change at
//! such states, with random parameters and with random functions in place of supplied ones. A rate that is not zero
//! within rounding is a compile error that shows the numbers; a force beyond a kink that no such state reaches is not seen.
//! A [`Trajectory`](crate::Trajectory::drift) reports the
//! drift of each conserved quantity, and balances an energy that changes with its work.
//!
//! ```
//! use lagrange_core::{prelude::*, facts::Evidence};
//!
//! /// A pendulum bob on a string.
//! #[derive(Lagrangian)]
//! #[coordinates(x, y, z)]
//! #[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
//! #[constraint(string: x^2 + y^2 + z^2 = l^2)]
//! #[conserved(l_z = m*(x*y_dot - y*x_dot))]
//! struct Bob { m: f64, g: f64, l: f64 }
//!
//! assert_eq!(Bob::FACTS.energy_is_conserved, Some(Evidence::Proved));
//! let bob = Bob { m: 0.1, g: 9.81, l: 0.5 };
//! let path = bob.integrate(State::new([0.3, 0.0, -0.4], [0.0, 1.0, 0.0]), 5.0, Dop853::default())?;
//! println!("{}", path.drift());
//! assert!(path.drift().iter().all(|quantity| quantity.largest < 1e-6));
//! # Ok::<(), Error>(())
//! ```
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
//! # Any number of bodies
//!
//! The lengths of a coordinate may be known when the program runs, `r: [n, 3]` or `u: [rows, columns]`. Such a length is
//!
//! | | |
//! |---|---|
//! | `#[parameter(m: [n])]` for `m: Vec<f64>` | length of a field; further fields of this length have to agree |
//! | `n: usize` | value of a field |
//! | `N` | a constant of the crate, or a const generic of the struct, without lower-case letters |
//!
//! or a sum of such names and whole numbers, `#[parameter(k: [n + 1])]`. The fields hold numbers, `Vec<f64>` or `&[f64]`, or
//! vectors, `Vec<[f64; 3]>`. Expressions take single elements. An index is a sum of running indices, lengths and whole numbers,
//! `q[n-1-i]`, or an entry of a table of type `Vec<usize>` or `Vec<[usize; 2]>`, `r[bond[b][0]]` with `#[parameter(bond:
//! [bonds, 2])]`. Sums over lengths nest, `sum(i in 0..n, sum(j in 0..i, …))` over pairs. In L they are added, and multiplied by
//! what contains no such sum; forces, constraints and observables take them anywhere. Definitions, forces and constraints may be
//! families over lengths. Velocities that multiply each other in L belong to one element.
//!
//! The struct implements [`ManyBodies`](crate::ManyBodies), which has the energy, the momenta and states, in the place of
//! [`Lagrangian`](crate::Lagrangian). Where the momentum or the angular momentum is proved to be conserved, it has the methods
//! `total_momentum` and `total_angular_momentum`. It moves by pairs, by [`RungeKutta4`](crate::RungeKutta4) and, if its
//! forces contain no velocities and it has no constraints, by `Verlet`. There are no frames, supplied functions, contacts, frictions and
//! `#[power]`, and no accelerations and multipliers in observables; each is an error at its place. A definition by recursion,
//! `#[define(x[0] = …)]` with `#[define(x[i in 1..n] = x[i-1] + …)]` or `x[parent[i]]`, defines places from the coordinates of its own
//! index; it stands in systems without constraints, and is eliminated in time proportional to n.
//! Constraints have to be independent ([`multipliers`](crate::ManyBodies::multipliers) are a method).
//!
//! ```
//! use lagrange_core::prelude::*;
//!
//! /// Beads on a string of springs that falls, pulled aside at its first bead.
//! #[derive(Lagrangian)]
//! #[coordinates(r: [n, 2])]
//! #[parameter(m: [n]; k: [n - 1])]
//! #[define(mass = sum(i in 0..n, m[i]))]
//! #[define(stretch[i in 0..n-1] = norm(r[i+1] - r[i]))]
//! #[lagrangian(sum(i in 0..n, m[i]/2*dot(r_dot[i], r_dot[i]) - m[i]*g*r[i][1]) - sum(i in 0..n-1, k[i]/2*stretch[i]^2))]
//! #[force(r[0]: [pull, 0])]
//! #[observable(centre = sum(i in 0..n, m[i]*r[i])/mass)]
//! struct Beads { m: Vec<f64>, k: Vec<f64>, g: f64, pull: f64 }
//!
//! let beads = Beads { m: vec![1.0, 2.0, 3.0, 4.0], k: vec![50.0; 3], g: 9.81, pull: 2.0 };
//! let start = beads.at_rest((0..4).flat_map(|i| [f64::from(i), 0.0]));
//! let path = beads.integrate(start.clone(), 2.0, Dop853::default())?;
//! let moved = beads.centre(path.end().state()) - beads.centre(&start);
//! // The centre of mass moves as one body of mass 10: by a t²/2 in each direction.
//! assert!((moved[0] - 0.2 * 2.0).abs() < 1e-8 && (moved[1] + 9.81 * 2.0).abs() < 1e-8);
//!
//! // Lengths that do not agree are told of before the first step.
//! let short = Beads { k: vec![50.0; 2], ..beads };
//! let error = short.integrate(start, 2.0, Dop853::default()).unwrap_err();
//! assert_eq!(error.to_string(), "the field `k` has 2 elements, and `n - 1` is 3: give it 3");
//! # Ok::<(), lagrange_core::Error>(())
//! ```
//!
//! # Number types
//!
//! The number type of a system is that of the fields in use, or else `f64`. With a type parameter, one derive serves
//! `f64`, `f32`, SIMD lanes and dual numbers; the macro adds the bound [`Scalar`](crate::Scalar) where needed.
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
//! assert_eq!(single.accelerations_unchecked(&State::new([0.5], [0.0])).accelerations[0], -2.0);
//! ```
