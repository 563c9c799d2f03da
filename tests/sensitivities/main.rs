//! Derivatives of motions by where they start and by parameters.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod differences;
mod event_differences;
mod event_errors;
mod events;
mod lyapunov;
mod steps;

use std::f64::consts::PI;

use differences::check;
use lagrange_core::function::Function;
use lagrange_core::{Error, Scalar, Sensitivity, prelude::*};

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-13)
}

#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
#[dissipation(c/2 * theta_dot^2)]
struct Damped {
    m: f64,
    l: f64,
    g: f64,
    c: f64,
}

const DAMPED: Damped = Damped { m: 1.2, l: 0.7, g: 9.81, c: 0.3 };

#[test]
fn damped_pendulum() {
    check(&DAMPED, State::new([1.0], [0.5]), 3.0, method());
}

#[test]
fn damped_pendulum_backwards_and_by_the_other_pair() {
    check(&DAMPED, State::new([1.0], [0.5]), -1.5, method());
    check(&DAMPED, State::new([1.0], [0.5]).at_time(2.0), 3.0, Dopri5::with_tolerance(1e-13));
}

#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[define(v = [l[0]*cos(a)*a_dot + l[1]*cos(b)*b_dot, l[0]*sin(a)*a_dot + l[1]*sin(b)*b_dot])]
#[lagrangian(m[0]/2*l[0]^2*a_dot^2 + m[1]/2*dot(v, v) + m[0]*g*l[0]*cos(a) + m[1]*g*(l[0]*cos(a) + l[1]*cos(b)))]
struct DoublePendulum {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
}

#[test]
fn double_pendulum() {
    let system = DoublePendulum { m: [1.0, 0.7], l: [0.8, 1.1], g: 9.81 };
    check(&system, State::new([0.9, -0.4], [0.3, 1.0]), 2.0, method());
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(rod: 1/2 * (x^2 + y^2 + z^2 - l^2) = 0)]
struct Spherical {
    m: f64,
    g: f64,
    l: f64,
}

#[test]
fn spherical_pendulum_in_cartesian_coordinates() {
    let system = Spherical { m: 0.9, g: 9.81, l: 1.1 };
    check(&system, State::new([0.6, 0.2, -0.9], [0.5, 1.0, 0.3]), 2.0, method());
}

#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + g*cos(theta))]
#[dissipation(c/2*theta_dot^2)]
#[force(theta: a*cos(w*t))]
struct Driven {
    g: f64,
    c: f64,
    a: f64,
    w: f64,
}

#[test]
fn driven_pendulum() {
    check(
        &Driven { g: 1.0, c: 0.5, a: 1.15, w: 2.0 / 3.0 },
        State::new([0.3], [0.1]).at_time(1.0),
        6.0,
        method(),
    );
}

/// The blade lets the contact point move along itself only.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(velocity = der([x + a*cos(theta), y + a*sin(theta)]))]
#[lagrangian(m/2*dot(velocity, velocity) + inertia/2*theta_dot^2)]
#[constraint(blade: y_dot*cos(theta) - x_dot*sin(theta) = 0)]
struct ChaplyginSleigh {
    m: f64,
    a: f64,
    inertia: f64,
}

#[test]
fn chaplygin_sleigh() {
    let system = ChaplyginSleigh { m: 1.1, a: 0.4, inertia: 0.3 };
    check(&system, State::new([0.0, 0.0, 0.5], [0.8, 0.4, 1.5]), 3.0, method());
}

/// A ball on a turntable: velocity constraints with a term of their own.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, a, b)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*r^2/5*(a_dot^2 + b_dot^2) - k/2*(x^2 + y^2))]
#[constraint(along: x_dot - r*b_dot = -w*y)]
#[constraint(across: y_dot + r*a_dot = w*x)]
struct Turntable {
    m: f64,
    r: f64,
    w: f64,
    k: f64,
}

#[test]
fn ball_on_a_turntable() {
    let system = Turntable { m: 1.0, r: 0.2, w: 1.3, k: 0.4 };
    check(&system, State::new([0.5, 0.1, 0.0, 0.0], [0.2, 0.0, 0.0, 1.0]), 3.0, method());
}

#[derive(Clone, Lagrangian)]
#[coordinates(q: [4])]
#[define(w = quat_rate_body(q, q_dot))]
#[lagrangian((inertia[0]*w[0]^2 + inertia[1]*w[1]^2 + inertia[2]*w[2]^2)/2 - m*g*l*quat_rotate(q, [0, 0, 1])[2])]
#[constraint(unit: (dot(q, q) - 1)/2 = 0)]
struct Top {
    inertia: [f64; 3],
    m: f64,
    g: f64,
    l: f64,
}

#[test]
fn heavy_top_by_a_quaternion() {
    let top = Top { inertia: [0.5, 0.6, 0.2], m: 1.0, g: 9.81, l: 0.3 };
    let start = State::new([0.9, 0.3, -0.2, 0.1], [0.2, 0.5, 1.0, 2.0]);
    check(&top, start, 1.0, method());
}

/// A bead on a wire that turns ever faster, its height after a rule for velocities.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[define(angle = w*t + b*t^2/2)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z - k/2*(x^2 + y^2))]
#[constraint(wire: x*sin(angle) = y*cos(angle))]
#[constraint(climb: z_dot = c*(x*x_dot + y*y_dot))]
struct BeadOnWire {
    m: f64,
    g: f64,
    w: f64,
    b: f64,
    c: f64,
    k: f64,
}

#[test]
fn bead_on_a_wire_that_turns() {
    let bead = BeadOnWire { m: 1.0, g: 2.0, w: 0.8, b: 0.3, c: 0.5, k: 9.0 };
    check(&bead, State::new([0.7, 0.3, 0.0], [0.1, 0.5, 0.0]).at_time(0.5), 2.0, method());
}

#[derive(Clone)]
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
struct InWell {
    m: f64,
    k: f64,
    well: Well,
}

#[test]
fn potential_that_the_user_supplies() {
    check(&InWell { m: 1.0, k: 2.0, well: Well }, State::new([0.4], [0.2]), 3.0, method());
}

#[derive(Clone, Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian((r_dot^2 + r^2*phi_dot^2)/2 + mu/r)]
struct Kepler {
    mu: f64,
}

#[test]
fn kepler_ellipse() {
    check(&Kepler { mu: 1.0 }, State::new([1.0, 0.0], [0.0, 1.2]), 4.0, method());
}

/// Two constraints of which one follows from the other.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - 9.81*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
#[constraint(again: x*x_dot + y*y_dot = 0)]
struct Twice {
    l: f64,
}

#[test]
fn dependent_constraints() {
    check(&Twice { l: 1.3 }, State::new([0.5, -1.2], [1.2, 0.5]), 1.5, method());
}

/// A slider, its crank turned by a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi, x)]
#[lagrangian(crank/2*theta_dot^2 + rod*l^2/24*phi_dot^2 + slider/2*x_dot^2 - k/2*theta^2)]
#[dissipation(c/2*x_dot^2)]
#[constraint(height: r*sin(theta) + l*sin(phi) = 0)]
#[constraint(length: x = r*cos(theta) + l*cos(phi))]
struct SliderCrank {
    r: f64,
    l: f64,
    crank: f64,
    rod: f64,
    slider: f64,
    k: f64,
    c: f64,
}

#[test]
fn slider_crank() {
    let system = SliderCrank { r: 0.3, l: 1.0, crank: 0.2, rod: 1.5, slider: 2.0, k: 1.0, c: 0.4 };
    check(&system, State::new([1.0, -0.25, 1.13], [0.5, 0.0, 0.0]), 2.0, method());
}

/// x = x₀ cos ωt + v₀/ω sin ωt, at many times within the steps.
#[test]
fn in_between_they_are_as_accurate_as_the_motion() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - w^2/2*x^2)]
    struct Spring {
        w: f64,
    }
    let spring = Spring { w: 2.0 };
    let (x, v) = (0.7, -0.4);
    let arguments = ["x", "x_dot", "w"];
    let motion = spring.integrate_sensitivities(
        State::new([x], [v]),
        2.0 * PI,
        Dop853::with_tolerance(1e-12),
        &arguments,
    );
    let motion = motion.unwrap();
    for k in 0..=200 {
        let t = 2.0 * PI * f64::from(k) / 200.0;
        let Sensitivity { q, v: rate, .. } = motion.at(t).unwrap();
        let (sin, cos) = (2.0 * t).sin_cos();
        let by_w = -x * t * sin + v * (t * cos / 2.0 - sin / 4.0);
        for (found, exact) in
            [(q[0], cos), (q[1], sin / 2.0), (q[2], by_w), (rate[0], -2.0 * sin), (rate[1], cos)]
        {
            assert!((found - exact).abs() < 2e-11 * (1.0 + t), "{t}: {found} for {exact}");
        }
    }
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
