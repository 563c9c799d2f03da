//! Inverse dynamics: what drives a mechanism, against what its energy says.

use lagrange_core::{Error, error::Row, prelude::*};

/// Declares a crank, a rod and a slider with further attributes and parameters.
macro_rules! slider_crank {
    ($(#[$attribute:meta])* $name:ident { $($field:ident),* }) => {
        #[derive(Clone, Lagrangian)]
        #[coordinates(theta, phi, x)]
        #[define(center = [r*cos(theta) + l/2*cos(phi), r*sin(theta) + l/2*sin(phi)])]
        #[define(speed = der(center))]
        #[lagrangian(crank/2*theta_dot^2 + rod/2*dot(speed, speed) + rod*l^2/24*phi_dot^2 + slider/2*x_dot^2
            - rod*g*center[1])]
        #[dissipation(c/2*x_dot^2)]
        #[constraint(height: r*sin(theta) + l*sin(phi) = 0)]
        #[constraint(length: x = r*cos(theta) + l*cos(phi))]
        $(#[$attribute])*
        struct $name {
            r: f64,
            l: f64,
            crank: f64,
            rod: f64,
            slider: f64,
            g: f64,
            c: f64,
            $($field: f64),*
        }
    };
}

slider_crank! {
    // It turns as it is told: nothing is free.
    #[constraint(drive: theta = omega*t)]
    Driven { omega }
}
slider_crank! {
    // A motor turns it.
    #[force(theta: torque)]
    #[force(x: push^3)]
    Motor { torque, push }
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
