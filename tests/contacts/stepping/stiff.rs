//! Forces that change much within a step: springs and dampers act by the θ-method together with the contacts.

use lagrange_core::contact::{Contact, Friction, MoreauJean};
use lagrange_core::prelude::*;

use super::steps;

/// A quarter of a car: a body on a spring and a damper over a wheel on a floor.
#[derive(Clone, Lagrangian)]
#[coordinates(z, w)]
#[lagrangian(m/2 * z_dot^2 + wheel/2 * w_dot^2 - m*g*z - wheel*g*w - k/2 * (z - w - l)^2)]
#[dissipation(c/2 * (z_dot - w_dot)^2)]
#[contact(road: w - r >= 0)]
struct QuarterCar {
    m: f64,
    wheel: f64,
    g: f64,
    k: f64,
    c: f64,
    l: f64,
    r: f64,
    road: Contact,
}

const CAR: QuarterCar =
    QuarterCar { m: 250.0, wheel: 20.0, g: 9.81, k: 4e4, c: 4e3, l: 0.4, r: 0.3, road: Contact::Open };

/// At rest the spring carries the body: z = r + l − m g/k, with any step.
#[test]
fn a_car_on_a_stiff_spring_comes_to_rest_with_any_step() {
    for (h, theta) in
        [(1.0 / 60.0, 0.5), (1.0 / 60.0, 1.0), (1.0 / 240.0, 0.5), (1e-3, 0.5), (1e-3, 0.7), (1e-4, 0.5)]
    {
        let scheme = MoreauJean::with_step(h).theta(theta);
        let path = CAR.motion(State::at_rest([0.75, 0.31])).by_time_stepping(scheme).to(4.0).unwrap();
        let (end, rest) = (*path.end().state(), 0.7 - 250.0 * 9.81 / 4e4);
        assert!((end.q[0] - rest).abs() < 1e-9 && (end.q[1] - 0.3).abs() < 1e-9, "{h}: {end:?}");
        assert!(end.v.amax() < 1e-9, "{h}: {end:?}");
        let push = path.end().multiplier("road").unwrap();
        assert!((push - 270.0 * 9.81).abs() < 1e-6, "{h}: {push}");
        // One evaluation a step.
        assert!(path.statistics().evaluations <= path.statistics().accepted, "{path}");
    }
}

/// Until the wheel lifts off, the body moves as on a wall: z = z₀ + A e^(−ct/2m) cos …, whose error falls with the step.
#[test]
fn a_car_that_is_let_go_oscillates_as_the_closed_solution() {
    let (rest, lift, t) = (0.7 - 250.0 * 9.81 / 4e4, 0.05, 0.5_f64);
    let (decay, omega) = (4e3 / 500.0, (4e4 / 250.0 - (4e3_f64 / 500.0).powi(2)).sqrt());
    let exact = rest + lift * (-decay * t).exp() * ((omega * t).cos() + decay / omega * (omega * t).sin());
    let error = |h: f64| {
        let start = State::at_rest([rest + lift, 0.3]);
        let path = CAR.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(t).unwrap();
        (path.end().state().q[0] - exact).abs()
    };
    let errors = [0.02, 0.01, 0.005, 0.0025].map(error);
    assert!(errors.windows(2).all(|pair| pair[1] < 0.3 * pair[0]), "{errors:?}");
}

/// A top whose gyroscopic forces are large: their derivatives are skew, so that they are found by iterations.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + w/2 * (x*y_dot - y*x_dot))]
#[contact(wall: x + 9 >= 0)]
struct Magnetized {
    w: f64,
    wall: Contact,
}

/// A charge in a magnetic field goes round in a circle at its speed, w h below 2; the θ-method with θ = ½ keeps its energy.
#[test]
fn skew_forces_keep_the_energy() {
    for (h, most) in [(0.01, 12), (0.05, 40)] {
        let (charge, start) =
            (Magnetized { w: 10.0, wall: Contact::Open }, State::new([0.0, 0.0], [1.0, 0.0]));
        let scheme = MoreauJean::with_step(h).tolerance(1e-13);
        for step in steps(charge.motion(start).by_time_stepping(scheme).stepper().unwrap(), 5.0) {
            assert!((step.state.v.norm() - 1.0).abs() < 1e-10, "{step:?}");
            assert!(step.iterations <= most, "{step:?}");
        }
    }
}

#[test]
fn steps_that_are_too_long_are_named() {
    let charge = Magnetized { w: 1e3, wall: Contact::Open };
    let step = MoreauJean::with_step(0.05);
    let error = charge
        .motion(State::new([0.0, 0.0], [1.0, 0.0]))
        .by_time_stepping(step)
        .to(5.0)
        .unwrap_err()
        .to_string();
    assert!(error.contains("take shorter steps"), "{error}");
}

/// Friction that stuck before a step has its larger limit in all iterations of it: the force k ẏ² is above the limit with the velocity before the
/// step, but below it with the one that it has in the step.
#[test]
fn friction_sticks_where_the_forces_of_the_step_are_below_its_limit() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian((x_dot^2 + y_dot^2)/2)]
    #[force(x: k*y_dot^2)]
    #[force(y: -c*y_dot)]
    #[contact(floor: y + 9 >= 0)]
    #[friction(grip: x_dot, limit: hold, sliding: pull)]
    struct Gripped {
        k: f64,
        c: f64,
        hold: f64,
        pull: f64,
        floor: Contact,
        grip: Friction,
    }
    let gripped =
        Gripped { k: 3.6, c: 20.0, hold: 2.0, pull: 1.0, floor: Contact::Open, grip: Friction::Sticks };
    let start = State::new([0.0, 0.0], [0.0, 1.0]);
    let mut stepper = gripped.motion(start).by_time_stepping(MoreauJean::with_step(0.05)).stepper().unwrap();
    let step = stepper.step().unwrap();
    assert!(step.iterations > 1, "{step:?}");
    // The velocity falls from 1 to 1/3: the force is k (2/3)² in the step.
    assert!(step.state.v[0].abs() < 1e-12 && (step.state.v[1] - 1.0 / 3.0).abs() < 1e-8, "{step:?}");
    assert!((step.impulse("grip").unwrap() / 0.05 + 3.6 * 4.0 / 9.0).abs() < 1e-7, "{step:?}");
}
