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
//! | `2/5`, `9.81`, `1_000`, `6.62607015e-34` | exact numbers, in the range of `f64`; what comes to more than 38 digits, as a product of three numbers of 16 does, is rounded once, to the nearest `f64`, and sums of such numbers that cancel within their rounding are zero; no suffixes, no hexadecimal |
//! | `t`, `pi` | time, π |
//! | `x`, `x_dot` or `ẋ` | a coordinate and its velocity; `x_ddot` or `ẍ` in observables only |
//! | `+ - * / ^` | the usual precedence; `-x^2` is `-(x^2)`, `^` groups to the right |
//! | `sin cos tan asin acos atan atan2 sinh cosh tanh exp ln sqrt abs` | functions; `atan2(y, x)` |
//! | `min(x, y)`, `max(x, y)`, `clamp(x, low, high)` | limits, in forces and observables: a Lagrangian, a constraint or a frame has slopes everywhere |
//! | `der(expr)` | the total time derivative |
//! | `base.m`, `link[2].c[0]` | members of fields that are structs, of the shape that is declared |
//! | `[a, b, c]`, `v[0]`, `v[1..3]`, `dot(v, w)`, `cross(v, w)`, `norm(v)` | vectors |
//! | `[[a, b], [c, d]]`, `A[0][1]`, `A*v`, `v*A`, `A*B`, `transpose(A)`, `trace(A)`, `identity(3)`, `skew(v)` | matrices, by their rows |
//! | `rot_x(angle)`, `rot_y(angle)`, `rot_z(angle)`, `rot(axis, angle)` | matrices of rotations |
//! | `quat_rotate(q, v)`, `quat_mul(p, q)`, `quat_conj(q)`, `quat_rate(q, q_dot)`, `quat_rate_body(q, q_dot)` | orientations as quaternions |
//! | `sum(i in 0..3, expr)` | a sum; ranges are half-open, indices whole numbers |
//! | `lambda(name)` | the multiplier of a constraint, in observables only |
//!
//! Fields, coordinates, definitions and built-in names share one namespace; constraints and observables have one
//! each. A field may be a number, a reference, an array or a vector, matrix, rotation (`Rotation3`) or quaternion
//! (`UnitQuaternion`, which is (w, x, y, z) in expressions) of nalgebra, or an array of these, or a struct (below); a field
//! that no expression uses may have any type.
//!
//! `#[parameter(inertia: symmetric)]` says that a field of square matrices is symmetric: of the two numbers across the diagonal
//! one is the parameter, and less is computed. `#[parameter(turn: rotation)]` says that they are rotations, as a `Rotation3`
//! is by its type. Random checks keep to it, and so must you: `solve`, and whatever starts from a state, gives
//! [`Error::ParameterNotAsSaid`](crate::Error::ParameterNotAsSaid) where a matrix is off by more than round-off (ε^(2/3) of
//! its size, 4·10⁻¹¹ for `f64`); the functions ending in `_unchecked` do not look.
//!
//! Everything is written out when it is compiled. So ranges end at 10,000 at most, the expressions of a system use at most
//! 10,000 numbers of its fields, and there are at most 1,000 coordinates and 1,000 constraints. What has more parts belongs
//! into a function of its own, with a loop in it (below).
//!
//! # Structs among the fields
//!
//! What belongs together may stand in a struct of its own, `link[i].m` beside `link[i].c`. A derive cannot see another
//! type: `#[parameter(link: [6] {m, c: [3]})]` says how many structs a field is, if there are several, and of what shape those
//! of their members are that expressions use.
//!
//! | declared | type of the member |
//! |---|---|
//! | `m` | a number |
//! | `c: [3]` | `[f64; 3]` or `Vector3<f64>` |
//! | `A: [3, 3]` | `[[f64; 3]; 3]` or `Matrix3<f64>` |
//! | `I: symmetric` | the same, a symmetric matrix of 3 by 3 |
//! | `R: rotation` | the same or `Rotation3<f64>`: a rotation |
//! | `q: quaternion` | `UnitQuaternion<f64>` |
//! | `place: pose` | `Isometry3<f64>`, with the members `translation`, a vector, and `rotation`, a quaternion |
//! | `tip: {m, c: [3]}`, `wheel: [4] {m}` | a struct again, or an array of such |
//!
//! The field may own the structs, or be a reference to them, or a `Vec`, which must have as many, or a smart pointer. A member
//! that the struct has not, or of another type, is a compile error where it is declared. What is declared symmetric or
//! a rotation is verified as with other fields. The numbers are parameters like others, called as in expressions; those of
//! members of members, and behind references, cannot be set. A field that is an `Isometry3` is a pose without being declared;
//! the step `pose(place)` of a frame uses it as a whole.
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
//! Values, functions and families. A family over 0..n is a vector, one of two indices,
//! `#[define(d[i in 0..3, j in 0..3] = …)]`, a matrix of the entries `d[i][j]`; the range of an index may depend on those before
//! it, `d[i in 0..3, j in 0..i]`. Definitions come before what uses them, but for elements of families: where a family needs
//! an element of another one, or of its own, that is found first, so that two recursions may use each other, and one may run
//! from its end, `#[define(p[i in 0..4] = a[i] + x*p[i+1])]`. Definitions are kept as they are written: what
//! is shared is computed once, and a recursion along a chain costs as much as its length. That holds for the solved
//! accelerations too: the rates of velocities that definitions name are unknowns beside the accelerations where that
//! makes the equations sparse (the articulated-body algorithm). So name the velocities of a chain or a tree, or its places
//! with `der(…)` in L. Each from the one before, `x[i] = x[i-1] + …`, or as a sum, `x[i] = sum(j in 0..i+1, …)`, is the
//! same: sums in L that have terms in common are written by what they share (but not where frames are declared). Where
//! bodies turn in space, declare their [frames](#frames) instead, which costs a fraction.
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
//! A coordinate `r: [3]` is a vector, `r_dot` its velocity and `r[0]` an entry; so is a field of type `[f64; 3]` or
//! `Vector3<f64>`. A coordinate `r: [4, 3]` is an array of four vectors `r[i]`, of velocities `r_dot[i]`, and has entries `r[i][j]`,
//! by which states, tables and equations name them too. Vectors add up with vectors of the same length, and take factors and divisors that are numbers; the literal
//! 0 is the zero vector. `norm(v)^2` is `dot(v, v)`, without a root that would have no slope at the origin.
//! Definitions, forces, constraints and observables may be vectors; L is a number. A force on all of a coordinate has its
//! shape; `#[force(r[1]: …)]` acts on one vector of an array, `#[force(r[1][2]: …)]` on an entry, `#[force(r[i in 0..4]: …)]`
//! on each.
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
//! A field `[[f64; 3]; 2]` or `Matrix3<f64>` is a matrix, and so are rows of numbers, `[[a, b], [c, d]]`. In `A*v` the vector is a
//! column, in `v*A` a row; `skew(v)*w` is `cross(v, w)`. `rot_z(a)` turns a vector by the angle a from x towards y,
//! `rot_x(a)` from y towards z, `rot_y(a)` from z towards x: as R = rot_z(φ) rot_x(θ) rot_z(ψ) with Euler's angles, R takes what is
//! said in the frame of the body into the fixed one, and `transpose(R)*der(R)` is `skew` of the angular velocity in
//! the frame of the body. The axis of `rot(axis, a)` need not be of length 1, but must not be zero.
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
//! A quaternion is a vector of 4, (w, x, y, z). `quat_rotate(q, v)` is the vector that it turns v into, from the
//! body's frame to the fixed one; `quat_rate(q, q_dot)` is the angular velocity in the fixed frame,
//! `quat_rate_body(q, q_dot)` in the body's, as 2 q̇ q̄ and 2 q̄ q̇. `quat_mul(p, q)` is Hamilton's product, first q and then
//! p as rotations; `quat_conj(q)` is q̄. Nothing is divided by |q|²: the constraint
//! `dot(q, q) = 1` keeps it 1, and makes up for the mass matrix, which alone is singular. The macro completes it by that
//! row: no term that vanishes need be added to L.
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
//! `#[frame(name in parent: step, step, …)]` declares a frame by the steps that lead to it from the one that it is in,
//! each step in the axes that the steps before have reached. Without `in` it starts from the frame at rest, which is
//! called `fixed`. A family, `link[i in 1..6] in link[i-1]`, is a chain; with a table of whole numbers,
//! `#[define(parent = [0, 0, 1, 1])]` and `part[i in 1..4] in part[parent[i]]`, a tree; with two indices,
//! `leg[i in 0..4, j in 1..3] in leg[i][j-1]`, several chains. Families may lie in each other's elements, as joints about two
//! axes in turn do: `a[i in 1..6] in b[i-1]` and `b[i in 0..6] in a[i]`.
//!
//! | step | |
//! |---|---|
//! | `translate(v)` | the origin moves by a vector |
//! | `rotate_x(angle)`, `rotate_y`, `rotate_z` | about an axis of its own, by the right-hand rule |
//! | `rotate(axis, angle)` | about any axis, of whatever length |
//! | `rotate(q)` | by a quaternion (w, x, y, z), of whatever length but zero; where it is a coordinate, the constraint `dot(q, q) = 1` comes with it, named like it, after those that you state; so it does for each `rotate(q[i])` of a coordinate `q: [3, 4]`, named `q[i]`. Those of several coordinates come in the order in which the frames, as declared, first turn by them |
//! | `rotate(R)` | by a rotation matrix, which turns vectors from the new axes into the old: a `Rotation3`, a `Matrix3` with `#[parameter(R: rotation)]`, a product of rotations, which is taken turn by turn |
//! | `pose(place)` | `translate(place.translation), rotate(place.rotation)`: by an `Isometry3`, which takes a point r of the new frame to R r + t in the old |
//!
//! What a step is made of may depend on coordinates and on time: a joint, or a motion that is prescribed.
//!
//! | | |
//! |---|---|
//! | `position(frame, point)` | where a point is, from the origin of the fixed frame and along its axes; the point by its components in the frame, the frame's origin without |
//! | `velocity(frame, point)` | its velocity relative to the fixed frame, along the axes of `frame`; if the point moves in the frame, with that. The material at a point that moves, where a wheel touches the ground, has the velocity `velocity(wheel) + cross(angular_velocity(wheel), point)` |
//! | `angular_velocity(frame)` | relative to the fixed frame, along the axes of `frame` |
//! | `jacobian(v)` | ∂v/∂q̇ of a velocity, linear or angular or any other, in observables: a row for each component and a column for each coordinate. What a force along v does, Jᵀ·force, is `#[power(force, v)]` |
//! | `kinetic(frame, m, c, I)` | the kinetic energy of a rigid body: mass, centre of mass, inertia about the centre, all in the axes of `frame`; without `I` that of a point, without `c` of one at the origin. Each of them may depend on time, coordinates and supplied functions, `m` and `I` also on velocities; the equations then have ṁ u, İ ω, ∂m/∂q u²/2 and ω·∂I/∂q ω/2. Entries of `I` across the diagonal that differ for all parameters are an error; where fields decide, as in a matrix field, the symmetric part (I + Iᵀ)/2 counts |
//! | `express(v, frame)` | a vector along the axes of another frame |
//! | `vector(frame, [a, b, c])` | the vector with these components along the axes of `frame` |
//! | `der(v)`, `der(v, frame)` | the rate of change of a vector as seen from the fixed frame, or from another: (dv/dt)_B = dv/dt − ω_B × v |
//!
//! Vectors know along which axes they are: those of different frames are not added, nor is the product of two taken, before one
//! is expressed in the axes of the other; `v[0]` is a component along the frame's own axis. Plain numbers, `[1, 0, 0]` or a
//! field, take the axes of the vector that they meet; what is computed from coordinates has to say its own, `vector(fixed, r_dot)`.
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
//! Frames are not only shorter to write. The macro knows how velocities go from frame to frame, and differentiates none of
//! it: accelerations come from the recursions of Newton and Euler and from the inertia of what moves as one, or from the
//! articulated-body algorithm, whichever is faster (Featherstone, *Rigid Body Dynamics Algorithms*). An arm of six joints
//! takes some 2,300 operations this way, and four times as many by `der` of positions along the fixed axes; where three angles
//! or more turn, one after another, what `der` differentiates, the equations of a struct say so in its documentation. What is
//! not used is not computed: a potential `m*g*position(body, c)[2]` needs one row of a rotation, or none.
//!
//! # Functions that you supply
//!
//! `#[function(U(r) = field)]` makes a field a function: a potential, a field, a prescribed motion. Without `= field`
//! it is the field of the function's own name. A formal that bears a coordinate's name has its shape, others say it,
//! `U(s: [3])`, or are numbers; `A(r): [3]` has a vector for a result. The arguments at a call are any expressions
//! of these shapes, and `der(Omega(t))` and all derivatives that the equations need are taken.
//!
//! The field's type implements [`Function<I, O>`](crate::Function) for `I` numbers, all arguments together, and `O`
//! results. It is written once for every scalar, so that its derivatives are known, and that the system serves every
//! number type. (A closure takes one type of number, and so cannot be one.)
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
//! For `f64` alone there are two further forms. A [`FunctionWithDerivatives`](crate::function::FunctionWithDerivatives) function gives its value,
//! gradient and second derivatives, and is put into [`WithDerivatives`](crate::function::WithDerivatives);
//! [`check_derivatives`](crate::function::check_derivatives) compares them with differences. A [`Table`](crate::function::Table) is the
//! curve through measured points with two continuous derivatives, a [`SmoothTable`](crate::function::SmoothTable) the one with four, along
//! which motions keep their digits. Where the equations need a third derivative, which a `SmoothTable` alone has of these, that is
//! an error at the field's type while compiling. [`Linearized`](crate::Linearized) takes one derivative more than the
//! equations: where that is the third, it is missing for the other forms, and the rest of the system is there.
//! [`Taylor`](crate::Taylor) takes a `Function` alone. Numbers inside of a function are no parameters of the system: none
//! can be differentiated by or sought.
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
//! `name: left = right` stands for Φ = left − right. Without velocities it is holonomic and enforced on coordinates
//! and velocities; with them it must be linear in them, and it is enforced on the velocities. Each scalar equation
//! has one multiplier, and the constraint force on coordinate a is Σ_α λ_α F_αa, with F = ∂Φ/∂q or the coefficients
//! of q̇. A vector equation is one constraint a component, `c[0]`, `c[1]`, …; a family is written
//! `rod[i in 0..3]: …` or, with two indices, `rod[i in 0..3, j in 0..i]: …`.
//!
//! A constraint that contradicts others, `y = 0` and `y = 1`, or follows from them is an error while compiling where that is
//! certain: its row of F is a combination of the others' rows at every state and for all parameters. So are `x_dot = a*phi_dot`
//! beside `x = a*phi`, the sum of two others, and `x_dot = v*cos(th)` beside the two components of the velocity along
//! and across `th`. Rows that are dependent only on the constraints, as in some closed linkages, at some poses or for some
//! parameters are for the numbers to tell: the motion is right, and multipliers are those of least norm. Those that are dependent to
//! first order alone, as `|a| = l`, `|b| = l` and `|a - b| = 2*l`, are an error as soon as a motion starts.
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
//! Whether a velocity constraint could be integrated is found out at compile time, for each one and for the set;
//! see [`Integrability`](crate::facts::Integrability). Where the integral is found it is a method, and stands in the
//! equations.
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
//! let [no_slip, edge] = Pair::CONSTRAINT_CLASSES;
//! assert_eq!(no_slip.integrability, Integrability::Exact);
//! assert_eq!(edge, Classification { integrability: Integrability::Nonholonomic, evidence: Evidence::Proved });
//! assert_eq!(Pair::INTEGRALS.map(Integrals::extent), Some(Extent::Some));
//! assert!(Pair::equations().text().contains("integrable: x − a φ is constant"));
//! let state = State::at_rest([3.0, 1.0, 0.0, 0.0, 0.0]);
//! assert_eq!(Pair { a: 0.5 }.constraint_integral(0, &state), Some(2.5));
//! ```
//!
//! # Forces, dissipation, observables
//!
//! An observable is a method of its name, and gives a number, a vector (`SVector`) or a matrix (`SMatrix`); its entries are
//! asked for as `spin[2]` and `turn[0][1]`. Those of a family, `#[observable(height[i in 0..3] = y[i])]`, are one
//! vector, and vectors in a family a matrix, one a row. Forces may be families too, `#[force(theta[i in 0..3]: -k[i]*theta_dot[i])]`,
//! and so may powers: `#[power(i in 0..3, push[i], velocity(leg[i], foot))]`, for each i and in all.
//!
//! `#[power(f, v)]` is a force f along a velocity v by the power f·v, with components along the same axes: plain numbers take those of v,
//! which for `velocity(rod, …)` turn with `rod`. A weight keeps its direction, `#[power([0, 0, -m*g], express(velocity(rod, …), fixed))]`.
//!
//! `#[dissipation(D)]` is Rayleigh's function: the force is −∂D/∂q̇, and takes the power q̇·∂D/∂q̇ from the motion. A function that
//! certainly takes none is an error: one without velocities, one odd in them such as `c*x_dot`, and one whose power is nowhere positive
//! as long as no parameter is negative, such as `-c/2*x_dot^2`. What drives is a `#[force(…)]`.
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
//! The derive finds cyclic coordinates and their momenta, whether the energy E = p·q̇ − L is conserved and what it
//! consists of ([`EnergyForm`](crate::facts::EnergyForm): T + U only where that is certain), and terms of L that are total
//! time derivatives; constraints and forces are taken into account. All of it
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
use lagrange_core::{prelude::*, facts::Evidence};

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
//! assert_eq!(single.accelerations_unchecked(&State::new([0.5], [0.0])).accelerations[0], -2.0);
//! ```
