//! Steady motions of further systems.

use lagrange_core::prelude::*;

/// Watt's governor: two balls on arms of length l, a sleeve below that they lift; an engine drives it against drag.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian(m*l^2*(theta_dot^2 + sin(theta)^2*phi_dot^2) + 2*sleeve*l^2*sin(theta)^2*theta_dot^2
    + 2*(m + sleeve)*g*l*cos(theta))]
#[force(phi: engine - drag*phi_dot)]
struct Governor {
    m: f64,
    sleeve: f64,
    l: f64,
    g: f64,
    engine: f64,
    drag: f64,
}

/// φ̇² = (1 + sleeve/m) g/(l cos θ), and the engine gives what the drag takes.
#[test]
fn a_governor_stands_at_the_angle_of_its_rate() {
    let governor = Governor { m: 0.5, sleeve: 2.0, l: 0.2, g: 9.81, engine: 0.0, drag: 0.01 };
    let rate = (5.0 * 9.81 / (0.2 * 0.6_f64.cos())).sqrt();
    let found = governor.equilibrium(&State::new([0.6, 0.0], [0.0, 5.0]), &["phi_dot", "engine"]).unwrap();
    assert!((found.state.v[1] / rate - 1.0).abs() < 1e-14, "{found:?}");
    assert!((found.system.engine / (0.01 * rate) - 1.0).abs() < 1e-14, "{}", found.system.engine);
    // And back: the angle and the rate from the engine.
    let driven =
        found.system.equilibrium(&State::new([1.0, 0.0], [0.0, 10.0]), &["theta", "phi_dot"]).unwrap();
    assert!((driven.state.q[0] - 0.6).abs() < 1e-14 && (driven.state.v[1] / rate - 1.0).abs() < 1e-14);
}

/// Two wheels whose rims roll on one another, one driven, one braked.
#[derive(Clone, Lagrangian)]
#[coordinates(w: [2])]
#[lagrangian((w_dot[0]^2 + w_dot[1]^2)/2)]
#[constraint(rim: r*w_dot[0] - s*w_dot[1] = 0)]
#[force(w: [motor, -brake*w_dot[1]^3])]
struct Wheels {
    r: f64,
    s: f64,
    motor: f64,
    brake: f64,
}

/// The rim carries −motor/r = −brake ω³/s; all velocities of a vector are sought at once.
#[test]
fn velocities_are_sought_on_the_constraints() {
    let wheels = Wheels { r: 0.2, s: 0.5, motor: 3.0, brake: 0.7 };
    let found = wheels.equilibrium(&State::new([0.0; 2], [1.0, 2.0]), &["w_dot"]).unwrap();
    let second = (3.0 * 0.5 / (0.2 * 0.7_f64)).cbrt();
    assert!((found.state.v[1] / second - 1.0).abs() < 1e-14, "{found:?}");
    assert!((found.state.v[0] / (second * 2.5) - 1.0).abs() < 1e-14, "{found:?}");
    assert!((found.multipliers[0] / (-3.0 / 0.2) - 1.0).abs() < 1e-14, "{found:?}");
    wheels.check_consistent(&found.state).unwrap();
}

/// A groove whose walls steepen and flatten along it, but that runs straight.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[force(y: (1 - y - sin(y))*(2 + cos(x)))]
struct Groove;

/// At its bottom, which is hit but for round-off, the forces stay zero.
#[test]
fn what_moves_along_equilibria_is_steady() {
    for x in [0.5, 1.0, 2.0, 4.0] {
        let y = Groove.equilibrium(&State::new([x, 0.9], [1.0, 0.0]), &["y"]).unwrap().state.q[1];
        assert!((y + y.sin() - 1.0).abs() < 1e-15, "{y}");
    }
}

/// Three carts that two springs join, pulled apart.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - k/2*(0.3*(y - x - 1)^2 + 0.7*(z - y - 1)^2))]
#[force(x: -1.3)]
#[force(z: 1.3)]
struct Train {
    k: f64,
}

/// The changes by each coordinate cancel but for round-off; at the guess the springs are too soft for any.
#[test]
fn what_moves_as_one_is_steady() {
    for speed in [0.3, 1.1, 1.7, 2.9] {
        let guess = State::new([0.0, 3.0, 7.0], [speed; 3]);
        let found = Train { k: 1e-9 }.equilibrium(&guess, &["k", "y"]).unwrap();
        let stretch = found.state.q[1] - 1.0;
        assert!((stretch - 3.5).abs() < 1e-14, "{found:?}");
        assert!((0.3 * found.system.k * stretch - 1.3).abs() < 1e-14, "{}", found.system.k);
    }
}
