//! For a machine.

use std::f64::consts::PI;

use lagrange_core::nalgebra::{DMatrix, DVector, Vector2};
use lagrange_core::prelude::*;

type Result = std::result::Result<(), Box<dyn std::error::Error>>;

/// A crane: a load on a rope under a trolley.
#[derive(Clone, Lagrangian)]
#[coordinates(x, theta)]
#[define(load = [x + l*sin(theta), -l*cos(theta)])]
#[lagrangian(trolley/2*x_dot^2 + m/2*dot(der(load), der(load)) - m*g*load[1])]
#[dissipation(drag/2*theta_dot^2)]
#[force(x: push)]
struct Crane<T> {
    trolley: T,
    m: T,
    l: T,
    g: T,
    drag: T,
    push: T,
}

const CRANE: Crane<f64> = Crane { trolley: 100.0, m: 300.0, l: 5.0, g: 9.81, drag: 20.0, push: 0.0 };

/// The gains K of u = −K z that make Σ (zᵀQz + c uᵀu) over the ticks least, by Riccati's iteration.
fn regulator(a: &DMatrix<f64>, b: &DMatrix<f64>, tick: f64, weights: &[f64], c: f64) -> DMatrix<f64> {
    let (n, k) = b.shape();
    let mut held = DMatrix::zeros(n + k, n + k);
    held.view_mut((0, 0), (n, n)).copy_from(a);
    held.view_mut((0, n), (n, k)).copy_from(b);
    let held = (held * tick).exp();
    let (a, b) = (held.view((0, 0), (n, n)).into_owned(), held.view((0, n), (n, k)).into_owned());
    let weights = DMatrix::from_diagonal(&DVector::from_column_slice(weights));
    let (mut cost, mut gain) = (weights.clone(), DMatrix::zeros(k, n));
    for _ in 0..3000 {
        let normal = DMatrix::identity(k, k) * c + b.transpose() * &cost * &b;
        gain = normal.try_inverse().expect("positive") * b.transpose() * &cost * &a;
        cost = &weights + a.transpose() * &cost * (&a - &b * &gain);
    }
    gain
}

/// “Bring the load 10 m aside in 15 s with less than 2 kN, so that it ends there within 10 cm and swings by less than that; for ropes from 4 to 6 m and loads from 100 to
/// 400 kg, with one feedback.”
#[test]
fn a_crane_that_does_not_swing() -> Result {
    let rest = State::at_rest([0.0, 0.0]);
    let near = CRANE.linearize(&rest, &["push"])?;
    let gain = regulator(&near.a, &near.b, 0.05, &[10.0, 1000.0, 10.0, 1000.0], 1e-4);
    let gain: [f64; 4] = [0, 1, 2, 3].map(|i| gain[i]);
    let cranes = Ensemble::from_fn(25, |k| {
        let (rope, load) = (4.0 + 0.5 * (k % 5) as f64, 100.0 + 75.0 * (k / 5) as f64);
        (Crane { l: rope, m: load, ..CRANE }, rest)
    });
    let outcome = cranes
        .controlled(0.05, |_, crane, state| {
            // The goal moves there in 9 s, and begins and ends at rest.
            let part = (state.t / 9.0).min(1.0);
            let (goal, speed) =
                (10.0 * part * part * (3.0 - 2.0 * part), 10.0 / 9.0 * 6.0 * part * (1.0 - part));
            let z = [state.q[0] - goal, state.q[1], state.v[0] - speed, state.v[1]];
            crane.push = -z.iter().zip(gain).map(|(z, gain)| z * gain).sum::<f64>();
            if crane.push.abs() < 2000.0 { Ok(()) } else { Err("the motor is too weak") }
        })
        .integrate_on_lanes(15.0, Dop853::default())?;
    assert_eq!(outcome.completed().count(), 25);
    for (index, state) in outcome.completed() {
        let rope = 4.0 + 0.5 * (index % 5) as f64;
        let swings = rope * state.q[1].hypot(state.v[1] * (rope / 9.81).sqrt());
        assert!((state.q[0] - 10.0).abs() < 0.1 && swings < 0.1, "crane {index}: {state:?}");
    }
    Ok(())
}

/// “From a log of the trolley's force and the rope's angle: how long is the rope, how heavy is the load?”
#[test]
fn a_crane_weighed_by_its_swing() -> Result {
    /// The crane, pushed to and fro.
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, theta)]
    #[define(load = [x + l*sin(theta), -l*cos(theta)])]
    #[lagrangian(trolley/2*x_dot^2 + m/2*dot(der(load), der(load)) - m*g*load[1])]
    #[dissipation(drag/2*theta_dot^2)]
    #[force(x: 300*sin(t))]
    struct Shaken {
        trolley: f64,
        m: f64,
        l: f64,
        g: f64,
        drag: f64,
    }

    let log = |[m, l]: [f64; 2]| -> std::result::Result<(DVector<f64>, DMatrix<f64>), Error> {
        let crane = Shaken { trolley: 100.0, m, l, g: 9.81, drag: 20.0 };
        let start = State::at_rest([0.0, 0.0]);
        let motion = crane.integrate_sensitivities(start, 20.0, Dop853::default(), &["m", "l"])?;
        let (mut angles, mut by) = (DVector::zeros(200), DMatrix::zeros(200, 2));
        for k in 0..200 {
            let at = motion.derivatives_at(0.1 * k as f64)?;
            angles[k] = at.state.q[1];
            by.row_mut(k).copy_from(&at.q.row(1));
        }
        Ok((angles, by))
    };
    // Read to a mrad.
    let seen = log([320.0, 5.3])?.0.map(|angle| (angle * 1000.0).round() / 1000.0);
    let mut sought = Vector2::new(250.0, 5.0);
    for _ in 0..10 {
        let (angles, by) = log(sought.into())?;
        let normal = by.tr_mul(&by).try_inverse().ok_or("the log does not tell them apart")?;
        sought += (normal * by.tr_mul(&(&seen - angles))).fixed_rows::<2>(0);
    }
    assert!((sought[0] - 320.0).abs() < 2.0 && (sought[1] - 5.3).abs() < 0.01, "{sought}");
    Ok(())
}

/// “A reaction wheel holds a cube on its corner. Which torque does the motor need after a push, and does the wheel stay below its
/// speed?” In the plane: a body with a wheel, on a point.
#[test]
fn a_body_balanced_by_a_wheel() -> Result {
    /// `theta` leans from the upright; the wheel turns by `phi` in the body.
    #[derive(Clone, Lagrangian)]
    #[coordinates(theta, phi)]
    #[lagrangian(body/2*theta_dot^2 + wheel/2*(theta_dot + phi_dot)^2 - weight*cos(theta))]
    #[force(phi: clamp(torque, -0.25, 0.25))]
    struct Cube {
        body: f64,
        wheel: f64,
        weight: f64,
        torque: f64,
    }

    let cube = Cube { body: 3.3e-3, wheel: 5.7e-4, weight: 0.52, torque: 0.0 };
    let top = State::at_rest([0.0, 0.0]);
    let near = cube.linearize(&top, &["torque"])?;
    assert_eq!(format!("{:?}", near.stability()?), "Unstable");
    // Where the wheel stands does not matter; how fast it turns does, a little.
    let gain = regulator(&near.a, &near.b, 0.01, &[1.0, 1e-9, 1.0, 1e-4], 1.0);
    let start = State::new([0.05, 0.0], [0.0, 0.0]);
    let mut motion = Motion::new(cube, start, Dop853::default())?;
    let (mut largest, mut fastest) = (0.0_f64, 0.0_f64);
    for tick in 1..=1000 {
        let state = *motion.state();
        let z = DVector::from_column_slice(&[state.q[0], state.q[1], state.v[0], state.v[1]]);
        let torque = -(&gain * z)[0];
        (largest, fastest) = (largest.max(torque.abs()), fastest.max(state.v[1].abs()));
        motion.system_mut().torque = torque;
        motion.advance_to(0.01 * f64::from(tick))?;
    }
    assert!(motion.state().q[0].abs() < 1e-3, "{:?}", motion.state());
    assert!(largest < 0.25 && fastest < 6000.0 / 60.0 * 2.0 * PI, "{largest} N m, {fastest} rad/s");
    Ok(())
}
