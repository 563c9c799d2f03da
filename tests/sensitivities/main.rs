//! Derivatives of motions by where they start and by parameters.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod differences;
mod discrete;
mod event_differences;
mod event_errors;
mod events;
mod lyapunov;
mod mixed;
mod steps;
mod stiff;
mod trees;

use std::f64::consts::PI;

use differences::{check, check_each};
use lagrange_core::function::Function;
use lagrange_core::{
    Error, Scalar,
    linearized::{DifferentiableMethod, StateSensitivity},
    prelude::*,
};

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-13)
}

#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
#[dissipation(c/2 * theta_dot^2)]
struct Damped<T> {
    m: T,
    l: T,
    g: T,
    c: T,
}

const DAMPED: Damped<f64> = Damped { m: 1.2, l: 0.7, g: 9.81, c: 0.3 };

#[test]
fn damped_pendulum() {
    check_each(&DAMPED, State::new([1.0], [0.5]), 3.0);
}

#[test]
fn damped_pendulum_backwards_and_by_the_other_pair() {
    check_each(&DAMPED, State::new([1.0], [0.5]), -1.5);
    check(&DAMPED, State::new([1.0], [0.5]).at_time(2.0), 3.0, Dopri5::with_tolerance(1e-13));
}

#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[define(v = [l[0]*cos(a)*a_dot + l[1]*cos(b)*b_dot, l[0]*sin(a)*a_dot + l[1]*sin(b)*b_dot])]
#[lagrangian(m[0]/2*l[0]^2*a_dot^2 + m[1]/2*dot(v, v) + m[0]*g*l[0]*cos(a) + m[1]*g*(l[0]*cos(a) + l[1]*cos(b)))]
struct DoublePendulum<T> {
    m: [T; 2],
    l: [T; 2],
    g: T,
}

#[test]
fn double_pendulum() {
    let system = DoublePendulum { m: [1.0, 0.7], l: [0.8, 1.1], g: 9.81 };
    check_each(&system, State::new([0.9, -0.4], [0.3, 1.0]), 2.0);
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(rod: 1/2 * (x^2 + y^2 + z^2 - l^2) = 0)]
struct Spherical<T> {
    m: T,
    g: T,
    l: T,
}

#[test]
fn spherical_pendulum_in_cartesian_coordinates() {
    let system = Spherical { m: 0.9, g: 9.81, l: 1.1 };
    check_each(&system, State::new([0.6, 0.2, -0.9], [0.5, 1.0, 0.3]), 2.0);
}

#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + g*cos(theta))]
#[dissipation(c/2*theta_dot^2)]
#[force(theta: a*cos(w*t))]
struct Driven<T> {
    g: T,
    c: T,
    a: T,
    w: T,
}

#[test]
fn driven_pendulum() {
    check_each(&Driven { g: 1.0, c: 0.5, a: 1.15, w: 2.0 / 3.0 }, State::new([0.3], [0.1]).at_time(1.0), 6.0);
}

/// The blade lets the contact point move along itself only.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(velocity = der([x + a*cos(theta), y + a*sin(theta)]))]
#[lagrangian(m/2*dot(velocity, velocity) + inertia/2*theta_dot^2)]
#[constraint(blade: y_dot*cos(theta) - x_dot*sin(theta) = 0)]
struct ChaplyginSleigh<T> {
    m: T,
    a: T,
    inertia: T,
}

#[test]
fn chaplygin_sleigh() {
    let system = ChaplyginSleigh { m: 1.1, a: 0.4, inertia: 0.3 };
    check_each(&system, State::new([0.0, 0.0, 0.5], [0.8, 0.4, 1.5]), 3.0);
}

/// A ball on a turntable: velocity constraints with a term of their own.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, a, b)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*r^2/5*(a_dot^2 + b_dot^2) - k/2*(x^2 + y^2))]
#[constraint(along: x_dot - r*b_dot = -w*y)]
#[constraint(across: y_dot + r*a_dot = w*x)]
struct Turntable<T> {
    m: T,
    r: T,
    w: T,
    k: T,
}

#[test]
fn ball_on_a_turntable() {
    let system = Turntable { m: 1.0, r: 0.2, w: 1.3, k: 0.4 };
    check_each(&system, State::new([0.5, 0.1, 0.0, 0.0], [0.2, 0.0, 0.0, 1.0]), 3.0);
}

#[derive(Clone, Lagrangian)]
#[coordinates(q: [4])]
#[define(w = quat_rate_body(q, q_dot))]
#[lagrangian((inertia[0]*w[0]^2 + inertia[1]*w[1]^2 + inertia[2]*w[2]^2)/2 - m*g*l*quat_rotate(q, [0, 0, 1])[2])]
#[constraint(unit: (dot(q, q) - 1)/2 = 0)]
struct Top<T> {
    inertia: [T; 3],
    m: T,
    g: T,
    l: T,
}

#[test]
fn heavy_top_by_a_quaternion() {
    let top = Top { inertia: [0.5, 0.6, 0.2], m: 1.0, g: 9.81, l: 0.3 };
    let start = State::new([0.9, 0.3, -0.2, 0.1], [0.2, 0.5, 1.0, 2.0]);
    check_each(&top, start, 1.0);
}

/// A bead on a wire that turns ever faster, its height after a rule for velocities.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[define(angle = w*t + b*t^2/2)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z - k/2*(x^2 + y^2))]
#[constraint(wire: x*sin(angle) = y*cos(angle))]
#[constraint(climb: z_dot = c*(x*x_dot + y*y_dot))]
struct BeadOnWire<T> {
    m: T,
    g: T,
    w: T,
    b: T,
    c: T,
    k: T,
}

#[test]
fn bead_on_a_wire_that_turns() {
    let bead = BeadOnWire { m: 1.0, g: 2.0, w: 0.8, b: 0.3, c: 0.5, k: 9.0 };
    check_each(&bead, State::new([0.7, 0.3, 0.0], [0.1, 0.5, 0.0]).at_time(0.5), 2.0);
}

#[derive(Clone, PartialEq)]
struct Well;

impl Function<1, 1> for Well {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [x.sin() * x + (x * S::constant(0.3)).exp()]
    }
}

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[function(U(x) = well)]
#[lagrangian(m/2*x_dot^2 - k*U(x))]
struct InWell<T> {
    m: T,
    k: T,
    well: Well,
}

#[test]
fn potential_that_the_user_supplies() {
    check_each(&InWell { m: 1.0, k: 2.0, well: Well }, State::new([0.4], [0.2]), 3.0);
}

#[derive(Clone, Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian((r_dot^2 + r^2*phi_dot^2)/2 + mu/r)]
struct Kepler<T> {
    mu: T,
}

#[test]
fn kepler_ellipse() {
    check_each(&Kepler { mu: 1.0 }, State::new([1.0, 0.0], [0.0, 1.2]), 4.0);
}

/// Two constraints of which one follows from the other where neither factor is zero.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - 9.81*y)]
#[constraint(rod: a*(x^2 + y^2 - l^2) = 0)]
#[constraint(again: b*(x*x_dot + y*y_dot) = 0)]
struct Twice<T> {
    l: T,
    a: T,
    b: T,
}

#[test]
fn dependent_constraints() {
    check_each(&Twice { l: 1.3, a: 1.0, b: 1.0 }, State::new([0.5, -1.2], [1.2, 0.5]), 1.5);
}

/// A slider, its crank turned by a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi, x)]
#[lagrangian(crank/2*theta_dot^2 + rod*l^2/24*phi_dot^2 + slider/2*x_dot^2 - k/2*theta^2)]
#[dissipation(c/2*x_dot^2)]
#[constraint(height: r*sin(theta) + l*sin(phi) = 0)]
#[constraint(length: x = r*cos(theta) + l*cos(phi))]
struct SliderCrank<T> {
    r: T,
    l: T,
    crank: T,
    rod: T,
    slider: T,
    k: T,
    c: T,
}

#[test]
fn slider_crank() {
    let system = SliderCrank { r: 0.3, l: 1.0, crank: 0.2, rod: 1.5, slider: 2.0, k: 1.0, c: 0.4 };
    check_each(&system, State::new([1.0, -0.25, 1.13], [0.5, 0.0, 0.0]), 2.0);
}

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - w^2/2*x^2)]
struct Spring<T> {
    w: T,
}

#[test]
fn in_between_they_are_as_accurate_as_the_motion() {
    check_spring(Dop853::with_tolerance(1e-12), 2e-11);
    check_spring(Taylor::default(), 1e-14);
}

/// x = x₀ cos ωt + v₀/ω sin ωt, at many times within the steps.
fn check_spring<D: DifferentiableMethod<Spring<f64>>>(method: D, tolerance: f64) {
    let spring = Spring { w: 2.0 };
    let (x, v) = (0.7, -0.4);
    let arguments = ["x", "x_dot", "w"];
    let motion = spring.integrate_sensitivities(State::new([x], [v]), 2.0 * PI, method, &arguments);
    let motion = motion.unwrap();
    for k in 0..=200 {
        let t = 2.0 * PI * f64::from(k) / 200.0;
        let StateSensitivity { q, v: rate, .. } = motion.at(t).unwrap();
        let (sin, cos) = (2.0 * t).sin_cos();
        let by_w = -x * t * sin + v * (t * cos / 2.0 - sin / 4.0);
        for (found, exact) in
            [(q[0], cos), (q[1], sin / 2.0), (q[2], by_w), (rate[0], -2.0 * sin), (rate[1], cos)]
        {
            assert!((found - exact).abs() < tolerance * (1.0 + t), "{t}: {found} for {exact}");
        }
    }
}

/// Motions that part by five orders of magnitude, and a parameter in each of two blocks of lanes.
#[test]
fn chaos_is_followed_to_the_end() {
    let (system, start) =
        (DoublePendulum { m: [1.0, 1.0], l: [1.0, 1.0], g: 9.81 }, State::at_rest([2.0, 1.0]));
    let names = ["a", "b", "a_dot", "b_dot", "m[0]", "l[1]", "g"];
    let by_series = system.integrate_sensitivities(start, 10.0, Taylor::default(), &names).unwrap();
    let by_pairs = system.integrate_sensitivities(start, 10.0, method(), &names).unwrap();
    let [series, pairs] = [&by_series, &by_pairs].map(|motion| motion.end().unwrap());
    let size = pairs.q.amax().max(pairs.v.amax());
    let apart = (&series.q - &pairs.q).amax().max((&series.v - &pairs.v).amax());
    let state = (series.state.q - pairs.state.q).amax();
    println!("{size:e}, apart {apart:e}, the states {state:e}");
    assert!(size > 1e4 && apart < 1e-8 * size, "{apart:e} of {size:e}");
    // The determinant of the flow is that of the momenta's, by Liouville: M at the start over M at the end.
    let flow =
        nalgebra::DMatrix::from_fn(4, 4, |i, j| if i < 2 { series.q[(i, j)] } else { series.v[(i - 2, j)] });
    let mass = |state: &State<f64, 2>| system.mass_matrix(state).determinant();
    let expected = mass(&start) / mass(&series.state);
    let determinant = flow.determinant();
    // By as much as round-off of the largest entries changes the determinant.
    let stretches = flow.singular_values();
    let limit = f64::EPSILON * stretches.max() / stretches.min();
    assert!(
        limit < 1e-3 && (determinant / expected - 1.0).abs() < limit,
        "{determinant} for {expected}, {limit:e}"
    );
}

#[test]
fn what_cannot_be_is_named() {
    let start = State::new([1.0], [0.5]);
    let error = DAMPED.integrate_sensitivities(start, 1.0, method(), &["thetta"]).err().unwrap();
    assert!(error.to_string().contains("did you mean `theta`?"), "{error}");
    let motion = DAMPED.integrate_sensitivities(start, 1.0, method(), &["l"]).unwrap();
    assert!(matches!(motion.at(1.5), Err(Error::OutsideTrajectory { .. })));
    let error = motion.coordinate(0.5, "theta", "m").unwrap_err();
    assert!(error.to_string().contains("there is no argument of these derivatives `m`"), "{error}");
    // Without arguments it is the motion; without time, the start.
    assert_eq!(
        DAMPED.integrate_sensitivities(start, 1.0, method(), &[]).unwrap().at(0.5).unwrap().q.ncols(),
        0
    );
    let still =
        DAMPED.integrate_sensitivities(start, 0.0, method(), &["theta", "m"]).unwrap().at(0.0).unwrap();
    assert_eq!((still.q.as_slice(), still.v.as_slice()), (&[1.0, 0.0][..], &[0.0, 0.0][..]));
}
