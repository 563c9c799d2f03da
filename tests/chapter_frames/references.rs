//! Systems in moving frames and with magnetic forces whose motion is known: the terms of L that are linear in the
//! velocity, and constraints that move.
//!
//! Where no closed form is given, the values were integrated in 113- and in 170-bit arithmetic, which agree in all
//! digits given.

use lagrange_core::prelude::*;

use crate::largest;

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-12)
}

/// A bead on a hoop that turns about its vertical diameter, by its angle.
#[derive(Lagrangian)]
#[coordinates(th)]
#[lagrangian(a^2/2*(th_dot^2 + turn^2*sin(th)^2) + g*a*cos(th))]
struct OnHoop {
    a: f64,
    g: f64,
    turn: f64,
}

/// The same as a free particle with two constraints, one of which moves.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - g*z)]
#[constraint(ring: x^2 + y^2 + z^2 - a^2 = 0)]
#[constraint(plane: y*cos(turn*t) - x*sin(turn*t) = 0)]
struct OnTurningRing {
    a: f64,
    g: f64,
    turn: f64,
}

#[test]
fn bead_on_a_turning_hoop() {
    let (hoop, ring) = (OnHoop { a: 0.5, g: 9.81, turn: 6.0 }, OnTurningRing { a: 0.5, g: 9.81, turn: 6.0 });
    let (sine, cosine) = 0.4_f64.sin_cos();
    let start = State::new([0.5 * sine, 0.0, -0.5 * cosine], [0.0, 3.0 * sine, 0.0]);
    let by_angle = hoop.integrate(State::at_rest([0.4]), 50.0, method()).unwrap();
    let by_position = ring.integrate(start, 50.0, method()).unwrap();
    let apart = largest(by_angle.samples(1001).zip(by_position.samples(1001)).map(|(angle, position)| {
        let (th, s) = (angle.state().q[0], position.state());
        let out = 0.5 * th.sin();
        let turned = (6.0 * s.t).sin_cos();
        let off = [s.q[0] - out * turned.1, s.q[1] - out * turned.0, s.q[2] + 0.5 * th.cos()];
        largest(off.map(f64::abs))
    }));
    assert!(apart < 1e-8, "{apart:e}");

    let at_5 = by_angle.at(5.0).unwrap();
    assert!((at_5.state().q[0] - 1.074_627_832_131_206).abs() < 1e-10);
    assert!((at_5.state().v[0] - 2.218_126_947_131_934).abs() < 1e-9);
    let at_5 = by_position.at(5.0).unwrap();
    assert!((at_5.multiplier("ring").unwrap() + 21.050_799_138_007_107).abs() < 1e-8);
    assert!((at_5.multiplier("plane").unwrap() - 6.335_763_306_672_252).abs() < 1e-8);
}

/// It stays at cos θ = g/(a Ω²).
#[test]
fn equilibrium_on_the_hoop() {
    let hoop = OnHoop { a: 0.5, g: 9.81, turn: 6.0 };
    let solution = hoop.solve(&State::at_rest([0.994_407_212_058_699_5])).unwrap();
    assert!(solution.accelerations[0].abs() < 1e-13);
}

/// A bead on a straight wire that turns in a plane.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[constraint(wire: y*cos(w*t) - x*sin(w*t) = 0)]
struct OnWire {
    w: f64,
}

/// r = cosh wt, λ = 2 w ṙ. The energy grows: the constraint depends on time.
#[test]
fn bead_on_a_turning_wire() {
    let path = OnWire { w: 2.0 }.integrate(State::new([1.0, 0.0], [0.0, 2.0]), 2.0, method()).unwrap();
    let deviation = largest(path.samples(201).flat_map(|sample| {
        let (s, angle) = (sample.state(), 2.0 * sample.time());
        let (r, rate) = (angle.cosh(), 2.0 * angle.sinh());
        let lambda = sample.multiplier("wire").unwrap();
        [s.q[0] - r * angle.cos(), s.q[1] - r * angle.sin(), lambda - 4.0 * rate].map(|d| d.abs() / r)
    }));
    assert!(deviation < 1e-9, "{deviation:e}");
    let lambda = path.end().multiplier("wire").unwrap();
    assert!((lambda / 218.319_337_577_022_02 - 1.0).abs() < 1e-9, "{lambda}");
}

/// A charge in crossed fields B e_z and E e_y.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2*dot(r_dot, r_dot) + charge*b/2*(r[0]*r_dot[1] - r[1]*r_dot[0]) + charge*e*r[1])]
struct Charge {
    m: f64,
    charge: f64,
    b: f64,
    e: f64,
}

/// It drifts at E/B along x and circles at qB/m.
#[test]
fn charge_in_crossed_fields() {
    let charge = Charge { m: 1.2, charge: 0.7, b: 2.5, e: 0.9 };
    let path = charge.integrate(State::new([0.0; 3], [0.3, -0.4, 0.2]), 50.0, method()).unwrap();
    let (rate, drift) = (0.7 * 2.5 / 1.2, 0.9 / 2.5);
    let (u, v) = (0.3 - drift, -0.4);
    let deviation = largest(path.samples(1001).flat_map(|sample| {
        let s = sample.state();
        let (sine, cosine) = (rate * s.t).sin_cos();
        let x = drift * s.t + (u * sine + v * (1.0 - cosine)) / rate;
        let y = (v * sine - u * (1.0 - cosine)) / rate;
        let energy = charge.energy(s) - 0.174;
        [s.q[0] - x, s.q[1] - y, s.q[2] - 0.2 * s.t, energy].map(f64::abs)
    }));
    assert!(deviation < 1e-8, "{deviation:e}");
}

/// The restricted problem of three bodies in the frame that turns with the two heavy ones.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[define(earth = sqrt((x + mu)^2 + y^2))]
#[define(moon = sqrt((x - 1 + mu)^2 + y^2))]
#[lagrangian(((x_dot - y)^2 + (y_dot + x)^2)/2 + (1 - mu)/earth + mu/moon)]
struct ThreeBodies {
    mu: f64,
}

/// Arenstorf's orbit closes after its period (Hairer, Nørsett and Wanner, II.0), though it comes close to the moon.
#[test]
fn arenstorf_orbit() {
    let bodies = ThreeBodies { mu: 0.012_277_471 };
    let start = State::new([0.994, 0.0], [0.0, -2.001_585_106_379_082_5]);
    let path = bodies.integrate(start, 17.065_216_560_157_963, Dop853::with_tolerance(1e-14)).unwrap();
    let end = *path.end().state();
    // An error of the start grows by some five orders of magnitude in one period.
    assert!((end.q - start.q).norm() < 1e-8, "{:e}", (end.q - start.q).norm());
    let jacobi = largest(path.steps().map(|s| (bodies.energy(s.state()) + 1.428_206_260_104_929).abs()));
    assert!(jacobi < 1e-10, "{jacobi:e}");
}

/// Five points of rest.
#[test]
fn lagrange_points() {
    let bodies = ThreeBodies { mu: 0.012_150_585_609_624 };
    let triangle = 3.0_f64.sqrt() / 2.0;
    let points = [
        [0.836_915_125_772_357_4, 0.0],
        [1.155_682_165_444_884, 0.0],
        [-1.005_062_645_810_277_9, 0.0],
        [0.487_849_414_390_376, triangle],
        [0.487_849_414_390_376, -triangle],
    ];
    for point in points {
        let solution = bodies.solve(&State::at_rest(point)).unwrap();
        assert!(solution.accelerations.norm() < 1e-13, "{:e}", solution.accelerations.norm());
    }
}
