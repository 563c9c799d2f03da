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

/// Charges in a magnetic field. The derivatives of its forces are skew, so that they are found by iterations.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [3], y: [3])]
#[lagrangian(sum(i in 0..3, (x_dot[i]^2 + y_dot[i]^2)/2 + w[i]/2 * (x[i]*y_dot[i] - y[i]*x_dot[i])))]
#[contact(wall[i in 0..3]: x[i] + 9 >= 0)]
struct Magnetized {
    w: [f64; 3],
    wall: [Contact; 3],
}

/// A step turns each velocity by 2 atan(w h/2), the rotation of the θ-method with θ = ½, in few iterations whatever w h is. The walls that
/// velocities on the way would reach do not matter.
#[test]
fn skew_forces_turn_velocities_in_steps_of_any_length() {
    for w in [1.0, 10.0, 1e2, 1e3, 1e4, 1e5] {
        for h in [1e-3, 0.01, 0.05] {
            let charges = Magnetized { w: [w, -0.3 * w, 0.01 * w], wall: [Contact::Open; 3] };
            let start = State::new([0.0; 6], [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
            let scheme = MoreauJean::with_step(h).tolerance(1e-12);
            let steps = steps(charges.motion(start).by_time_stepping(scheme).stepper().unwrap(), 100.0 * h);
            for (k, step) in steps.iter().enumerate() {
                assert!(step.iterations <= 12, "{w} {h}: {step:?}");
                for (i, w) in charges.w.iter().enumerate() {
                    let (sin, cos) = (k as f64 * 2.0 * (w * h / 2.0).atan()).sin_cos();
                    let off = (step.state.v[i] - cos).abs().max((step.state.v[3 + i] + sin).abs());
                    assert!(off < 1e-12 * w.abs().max(1e3), "{w} {h}: {off:e} {step:?}");
                }
            }
        }
    }
}

/// A charge on a floor without friction, which the field presses to the floor more and less: it turns about the part of the field across
/// the floor.
#[test]
fn a_contact_carries_skew_forces() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(r: [3])]
    #[define(f = cross(r_dot, b))]
    #[lagrangian(dot(r_dot, r_dot)/2 - g*r[2])]
    #[force(r[0]: f[0])]
    #[force(r[1]: f[1])]
    #[force(r[2]: f[2])]
    #[contact(floor: r[2] >= 0)]
    struct Pressed {
        g: f64,
        b: [f64; 3],
        floor: Contact,
    }
    for h in [1e-3, 0.01, 0.05] {
        let charge = Pressed { g: 9.81, b: [600.0, 0.0, 800.0], floor: Contact::Closed };
        let start = State::new([0.0; 3], [0.01, 0.0, 0.0]);
        let scheme = MoreauJean::with_step(h);
        let steps = steps(charge.motion(start).by_time_stepping(scheme).stepper().unwrap(), 100.0 * h);
        for (k, pair) in steps.windows(2).enumerate() {
            let (sin, cos) = ((k + 1) as f64 * 2.0 * (800.0 * h / 2.0).atan()).sin_cos();
            let v = pair[1].state.v;
            let off = (v[0] - 0.01 * cos).abs().max((v[1] + 0.01 * sin).abs()).max(v[2].abs());
            assert!(off < 1e-7 && pair[1].iterations <= 12, "{h}: {off:e} {:?}", pair[1]);
            let push = 9.81 + 600.0 * (pair[0].state.v[1] + v[1]) / 2.0;
            assert!((pair[1].impulse("floor").unwrap() - h * push).abs() < 1e-6 * h * 9.81, "{:?}", pair[1]);
        }
    }
}

/// The force k ẋ² speeds the body up without bound in such a step: no velocity balances it.
#[test]
fn steps_that_are_too_long_are_named() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2)]
    #[force(x: k*x_dot^2)]
    #[contact(wall: x + 9 >= 0)]
    struct Rocket {
        k: f64,
        wall: Contact,
    }
    let rocket = Rocket { k: 1e3, wall: Contact::Open };
    let motion = rocket.motion(State { t: 2.0, ..State::new([0.0], [1.0]) });
    let error = motion.by_time_stepping(MoreauJean::with_step(0.05)).to(5.0).unwrap_err().to_string();
    assert!(error.contains("within the step from t = 2:") && error.contains("take shorter steps"), "{error}");
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
