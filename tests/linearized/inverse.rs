//! Inverse dynamics: what drives a mechanism, against what its energy says.

use std::f64::consts::PI;

use lagrange_core::{
    Error,
    error::{Entry, Row},
    prelude::*,
};

/// A crank, a rod and a slider, which turn as they are told: nothing is free.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi, x)]
#[define(center = [r*cos(theta) + l/2*cos(phi), r*sin(theta) + l/2*sin(phi)])]
#[define(speed = der(center))]
#[lagrangian(crank/2*theta_dot^2 + rod/2*dot(speed, speed) + rod*l^2/24*phi_dot^2 + slider/2*x_dot^2 - rod*g*center[1])]
#[dissipation(c/2*x_dot^2)]
#[constraint(height: r*sin(theta) + l*sin(phi) = 0)]
#[constraint(length: x = r*cos(theta) + l*cos(phi))]
#[constraint(drive: theta = omega*t)]
struct Driven {
    r: f64,
    l: f64,
    crank: f64,
    rod: f64,
    slider: f64,
    g: f64,
    c: f64,
    omega: f64,
}

const DRIVEN: Driven =
    Driven { r: 0.3, l: 1.0, crank: 0.2, rod: 1.5, slider: 2.0, g: 9.81, c: 0.7, omega: 4.0 };

impl Driven {
    /// The state at a time, by trigonometry.
    fn at(&self, t: f64) -> State<f64, 3> {
        let &Self { r, l, omega, .. } = self;
        let theta = omega * t;
        let phi = (-r * theta.sin() / l).asin();
        let turn = -r * theta.cos() * omega / (l * phi.cos());
        let slide = -r * theta.sin() * omega - l * phi.sin() * turn;
        State::new([theta, phi, r * theta.cos() + l * phi.cos()], [omega, turn, slide]).at_time(t)
    }

    /// What the drive has to do: Ė, and what friction takes, over the rate at which it turns.
    fn torque(&self, t: f64) -> f64 {
        let energy = |t: f64| self.energy(&self.at(t));
        let (h, weights) = (1e-3, [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0]);
        let rise: f64 = (1..)
            .zip(weights)
            .map(|(k, w)| w / h * (energy(t + f64::from(k) * h) - energy(t - f64::from(k) * h)))
            .sum();
        (rise + self.c * self.at(t).v[2].powi(2)) / self.omega
    }
}

/// The same, the crank turned by a motor.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi, x)]
#[define(center = [r*cos(theta) + l/2*cos(phi), r*sin(theta) + l/2*sin(phi)])]
#[define(speed = der(center))]
#[lagrangian(crank/2*theta_dot^2 + rod/2*dot(speed, speed) + rod*l^2/24*phi_dot^2 + slider/2*x_dot^2 - rod*g*center[1])]
#[dissipation(c/2*x_dot^2)]
#[constraint(height: r*sin(theta) + l*sin(phi) = 0)]
#[constraint(length: x = r*cos(theta) + l*cos(phi))]
#[force(theta: torque)]
#[force(x: push^3)]
struct Motor {
    r: f64,
    l: f64,
    crank: f64,
    rod: f64,
    slider: f64,
    g: f64,
    c: f64,
    torque: f64,
    push: f64,
}

const MOTOR: Motor =
    Motor { r: 0.3, l: 1.0, crank: 0.2, rod: 1.5, slider: 2.0, g: 9.81, c: 0.7, torque: 0.4, push: 1.0 };

#[test]
fn what_drives_a_mechanism_without_freedom_does_the_work() {
    for k in 0..16 {
        let t = 0.05 + 0.1 * f64::from(k);
        let state = DRIVEN.at(t);
        let solution = DRIVEN.solve(&state).unwrap();
        let torque = DRIVEN.torque(t);
        assert!((solution.multipliers[2] - torque).abs() < 1e-9 * torque.abs().max(1.0), "{t}");
        // M a = h + Fᵀλ: nothing is lacking.
        let left = DRIVEN.inverse_dynamics(&state, &solution.accelerations, &solution.multipliers);
        let terms = DRIVEN.mass_matrix(&state).abs() * solution.accelerations.abs()
            + DRIVEN.constraint_jacobian(&state).abs().transpose() * solution.multipliers.abs();
        for i in 0..3 {
            assert!(left[i].abs() <= 8.0 * f64::EPSILON * terms[i].max(1.0), "{left} of {terms}");
        }
        // Without a drive the accelerations are given all the same, and so are the multipliers.
        let found = DRIVEN.inputs_for(&state, &solution.accelerations, &[]).unwrap();
        assert!((found.multipliers - solution.multipliers).amax() < 1e-12 * solution.multipliers.amax());
    }
}

#[test]
fn a_motor_has_to_do_what_a_drive_does() {
    for k in 0..16 {
        let t = 0.05 + 0.1 * f64::from(k);
        let state = DRIVEN.at(t);
        let driven = DRIVEN.solve(&state).unwrap();
        let still = Motor { push: 0.0, ..MOTOR };
        let close = |x: f64, y: f64| (x - y).abs() < 1e-11 * driven.multipliers.amax();
        let by_torque = still.inputs_for(&state, &driven.accelerations, &["torque"]).unwrap();
        assert_eq!(by_torque.names(), ["torque"]);
        assert!(close(by_torque.inputs[0], driven.multipliers[2]), "{t}");
        assert!(close(by_torque.multipliers[0], driven.multipliers[0]));
        assert!(close(by_torque.multipliers[1], driven.multipliers[1]));
        // A force on the coordinate acts beside the torque that is there.
        let by_force = still.inputs_for(&state, &driven.accelerations, &["theta"]).unwrap();
        assert!(close(by_force.inputs[0] + 0.4, driven.multipliers[2]));
        // The force on the slider that does the same work, which enters by its cube.
        let push = MOTOR.inputs_for(&state, &driven.accelerations, &["push"]).unwrap().inputs[0];
        let moved = Motor { push, ..MOTOR }.solve(&state).unwrap().accelerations;
        assert!((moved - driven.accelerations).amax() < 1e-9 * driven.accelerations.amax(), "{t}: {push}");
    }
}

#[test]
fn inputs_that_cannot_or_are_too_many_are_refused() {
    let state = DRIVEN.at(0.3);
    let driven = DRIVEN.solve(&state).unwrap().accelerations;
    // The rod follows the crank: one torque, but no two.
    let error = MOTOR.inputs_for(&state, &driven, &["torque", "theta", "g"]).unwrap_err();
    assert!(
        matches!(&error, Error::InputsNotUnique { inputs, time }
        if inputs.as_slice() == ["torque", "theta", "g"] && *time == 0.3),
        "{error}"
    );
    assert!(
        error
            .to_string()
            .contains("many values of `torque`, `theta`, `g` give these accelerations at t = 0.3")
    );
    // What the drive holds, no torque moves.
    let held = DRIVEN.inputs_for(&state, &driven, &["theta"]).unwrap_err();
    assert!(
        matches!(&held, Error::InputsNotUnique { inputs, .. } if inputs.as_slice() == ["theta"]),
        "{held}"
    );
    let none = MOTOR.inputs_for(&state, &driven, &[]).unwrap_err();
    assert!(matches!(none, Error::NotRealizable { row: Row::Coordinate(_), .. }), "{none}");
    let torn = MOTOR.inputs_for(&state, &[0.0, 0.0, 1.0].into(), &["torque"]).unwrap_err();
    assert!(matches!(torn, Error::NotRealizable { row: Row::Constraint(_), .. }), "{torn}");
    assert!(torn.to_string().contains("these accelerations violate constraint `"), "{torn}");
    let unknown = MOTOR.inputs_for(&state, &driven, &["torqe"]).unwrap_err();
    assert!(
        unknown.to_string().contains("there is no coordinate or parameter `torqe`: did you mean `torque`?")
    );
    let wrong = MOTOR.inputs_for(&state, &[f64::NAN, 0.0, 0.0].into(), &["torque"]).unwrap_err();
    assert!(matches!(wrong, Error::EquationsNotFinite { .. }), "{wrong}");
}

/// An arm of two links: as many motors as coordinates give any accelerations.
#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(m*l^2*(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b)) + m*g*l*(2*cos(a) + cos(b)))]
#[force(a: u[0] - u[1])]
#[force(b: u[1])]
struct Arm {
    m: f64,
    l: f64,
    g: f64,
    u: [f64; 2],
}

#[test]
fn the_torques_of_an_arm_give_the_accelerations_back() {
    let arm = Arm { m: 1.3, l: 0.7, g: 9.81, u: [0.3, -2.0] };
    let state = State::new([PI / 5.0, -0.4], [1.0, 2.0]);
    let asked = [3.0, -5.0].into();
    let found = arm.inputs_for(&state, &asked, &["u"]).unwrap();
    assert_eq!(found.names(), ["u[0]", "u[1]"]);
    let moved = Arm { u: [found.inputs[0], found.inputs[1]], ..arm }.solve(&state).unwrap();
    assert!((moved.accelerations - asked).amax() < 1e-13 * 5.0, "{}", moved.accelerations);
}

/// Pushes along one line, one that hardly acts, and one whose effect begins with an infinite slope.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[force(x: sin(x)*(u[0] + u[1]) + sqrt(root))]
#[force(y: cos(x)*(u[0] + 1.000000000001*u[1]) + 1e-14*weak)]
struct Pushed {
    u: [f64; 2],
    weak: f64,
    root: f64,
}

#[test]
fn inputs_have_their_own_units_and_must_tell_apart() {
    let pushed = Pushed { u: [0.0; 2], weak: 0.0, root: 0.0 };
    let state = State::at_rest([0.7, 0.0]);
    let found = pushed.inputs_for(&state, &[0.0, 3.0].into(), &["weak"]).unwrap();
    assert!((found.inputs[0] - 3e14).abs() < 1.0, "{found:?}");
    // In the same direction but for digits that the equations have not.
    let both = pushed.inputs_for(&state, &[0.7_f64.sin(), 0.7_f64.cos()].into(), &["u"]).unwrap_err();
    assert!(
        matches!(&both, Error::InputsNotUnique { inputs, .. } if inputs.as_slice() == ["u[0]", "u[1]"]),
        "{both}"
    );
    let steep = pushed.inputs_for(&state, &[1.0, 0.0].into(), &["root"]).unwrap_err();
    let entry = Entry::Parameter("root");
    let expected = Error::DerivativeNotFinite { row: Row::Coordinate("x"), entry, time: 0.0 };
    assert_eq!(steep, expected);
    assert_eq!(pushed.jacobian_by(&state, &["weak", "root"]).unwrap_err(), expected);
}

/// A plane linkage of two bars and a coupler, with the coupler's constraint given twice.
#[derive(Clone, Lagrangian)]
#[coordinates(a: [2], b: [2], free)]
#[lagrangian((a_dot[0]^2 + a_dot[1]^2 + 2*b_dot[0]^2 + b_dot[1]^2 + free_dot^2)/2 - g*(a[1] + b[1]) - free^2/2)]
#[constraint(left: dot(a, a) = 1)]
#[constraint(right: (b[0] - 3)^2 + b[1]^2 = 1)]
#[constraint(coupler: dot(b - a, b - a) = 9)]
#[constraint(again: scale*(b[0] - a[0])^2 + other*(b[1] - a[1])^2 = 9*scale)]
#[force(a: push)]
struct Linkage {
    g: f64,
    scale: f64,
    other: f64,
    push: [f64; 2],
}

#[test]
fn accelerations_are_completed_to_those_of_the_motion() {
    for scale in [1.0, 1e-6, 1e6] {
        let linkage = Linkage { g: 9.81, scale, other: scale, push: [0.3, -0.2] };
        let guess = linkage
            .state_from(&[("a[0]", 0.3), ("a[1]", 0.9), ("b[0]", 3.2), ("b[1]", 1.0), ("a_dot[0]", 1.3)])
            .unwrap();
        let (state, _) = linkage.make_consistent(&guess).unwrap();
        let moved = linkage.solve(&state).unwrap().accelerations;
        for held in ["a[0]", "a[1]", "b[0]", "b[1]"] {
            // What is not held does not matter.
            let mut given = [7.0; 5];
            let i = Linkage::COORDINATES.iter().position(|name| *name == held).unwrap();
            (given[i], given[4]) = (moved[i], moved[4]);
            let found = linkage.complete_accelerations(&state, &given.into(), &[held, "free"]).unwrap();
            assert!((found - moved).amax() < 1e-12 * moved.amax(), "by {held}: {found} for {moved}");
        }
        // Both of a vector, as they are.
        let found = linkage.complete_accelerations(&state, &moved, &["a", "free"]).unwrap();
        assert!((found - moved).amax() < 1e-12 * moved.amax());
        let told = |given: [f64; 5], held: &[&str]| {
            linkage.complete_accelerations(&state, &given.into(), held).unwrap_err().to_string()
        };
        let error = told([0.0; 5], &["a[0]"]);
        assert!(error.contains("do not determine those of `free` at t = 0"), "{error}");
        let error = told([0.0; 5], &["free"]);
        assert!(error.contains("those of `a[0]`, `a[1]`, `b[0]`, `b[1]` at"), "{error}");
        let error = told([5.0; 5], &["a", "free"]);
        assert!(error.contains("violate constraint `left`"), "{error}");
        assert!(told([f64::NAN; 5], &["a[0]", "free"]).contains("constraint"));
        assert!(told([0.0; 5], &["c"]).contains("no coordinate `c`"));
        assert!(told([0.0; 5], &["a", "a[1]"]).contains("`a[1]`"));
    }
}

/// At rest the torques are all there is: they hold the weight, and nothing else gives the scale of what is left.
#[test]
fn motors_hold_an_arm_in_every_pose() {
    let arm = Holding { m: 1.0, l: 0.5, g: 9.81, torque: [0.0; 2] };
    for k in 0..1000 {
        let k = f64::from(k);
        let state = State::at_rest([(1.3 * k).sin() * 3.0, (0.7 * k).cos() * 3.0]);
        let found = arm.inputs_for(&state, &[0.0; 2].into(), &["torque"]).unwrap();
        let exact = arm.inverse_dynamics(&state, &[0.0; 2].into(), &[].into());
        assert!((found.inputs[0] - exact[0]).abs() < 1e-13 && (found.inputs[1] - exact[1]).abs() < 1e-13);
    }
}

#[derive(Clone, Lagrangian)]
#[coordinates(q: [2])]
#[define(elbow = l*[cos(q[0]), sin(q[0])])]
#[define(tip = elbow + l*[cos(q[0] + q[1]), sin(q[0] + q[1])])]
#[lagrangian(m/2*(dot(der(elbow), der(elbow)) + dot(der(tip), der(tip))) - m*g*(elbow[1] + tip[1]))]
#[force(q: torque)]
struct Holding {
    m: f64,
    l: f64,
    g: f64,
    torque: [f64; 2],
}
