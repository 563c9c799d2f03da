//! Friction that holds, by steps of any length.

use lagrange_core::Error;
use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;
use lagrange_random::Random;

/// A block on a slope that may shake along its normal.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*(x*sin(alpha) + y*cos(alpha)))]
#[contact(floor: y - rise - a*sin(w*t) >= 0, friction(static: mu, kinetic: nu): x_dot)]
struct OnSlope {
    m: f64,
    g: f64,
    alpha: f64,
    a: f64,
    w: f64,
    rise: f64,
    mu: f64,
    nu: f64,
    floor: Contact,
}

const BLOCK: OnSlope = OnSlope {
    m: 1.0,
    g: 9.81,
    alpha: 0.4,
    a: 0.0,
    w: 1.0,
    rise: 0.0,
    mu: 0.6,
    nu: 0.2,
    floor: Contact::Closed,
};

/// It slides up, and stops: the coefficient at rest holds it, wherever in a step it does.
#[test]
fn a_block_that_slides_up_a_slope_stops_there() {
    let distance = 2.0 / (9.81 * (0.4_f64.sin() + 0.2 * 0.4_f64.cos()));
    for h in (0..10).map(|k| 1e-3 + 1e-5 * f64::from(k)) {
        let start = State::new([0.0; 2], [2.0, 0.0]);
        let path = BLOCK.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(1.0).unwrap();
        assert!((path.end().state().q[0] - distance).abs() < 1e-5, "{h}: {:?}", path.end());
        assert!(path.end().state().v.amax() < 1e-15, "{h}: {:?}", path.end());
    }
}

/// The slope is too steep for it once it slides back.
#[test]
fn a_block_that_cannot_stop_slides_back() {
    let block = OnSlope { alpha: 0.7, ..BLOCK };
    let start = State::new([0.0; 2], [2.0, 0.0]);
    let path = block.motion(start).by_time_stepping(MoreauJean::with_step(1e-4)).to(1.0).unwrap();
    let [up, down] = [1.0, -1.0].map(|side| 9.81 * (0.7_f64.sin() + side * 0.2 * 0.7_f64.cos()));
    let speed = down * (1.0 - 2.0 / up);
    assert!((path.end().state().v[0] + speed).abs() < 1e-3, "{:?}", path.end());
}

/// The floor shakes with less than g: the block never leaves it, and is pressed to it enough to hold.
#[test]
fn a_block_on_a_floor_that_shakes_stays_where_it_is() {
    for w in [3.0, 20.0, 60.0] {
        let a = 0.7 * 9.81 / (w * w);
        let block = OnSlope { alpha: 0.05, a, w, ..BLOCK };
        let start = State::new([0.0, 0.0], [0.0, a * w]);
        for h in [1e-3, 1e-4] {
            let path = block.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(1.0).unwrap();
            assert!(path.end().state().q[0].abs() < 1e-9, "{w}, {h}: {:?}", path.end());
            assert!(path.steps().all(|step| step.multiplier("floor").unwrap() > 0.0), "{w}, {h}");
        }
    }
}

#[test]
fn steps_of_uneven_lengths_leave_a_block_at_rest() {
    let mut random = Random(5);
    let block = OnSlope { alpha: 0.5, ..BLOCK };
    let motion = block.motion(State::at_rest([0.0; 2])).by_time_stepping(MoreauJean::with_step(1e-2));
    let mut stepper = motion.stepper().unwrap();
    for _ in 0..2000 {
        let h = 10_f64.powf(random.between(-4.0, -1.7));
        let next = stepper.state().t + h;
        let step = stepper.step_to(next).unwrap();
        assert!(step.state.v.amax() < 1e-15, "{h}: {:?}", step.state);
    }
}

/// A floor that is moved into a body would have to throw it out within a step.
#[test]
fn a_change_that_makes_a_gap_negative_is_named() {
    let motion = BLOCK.motion(State::at_rest([0.0; 2])).by_time_stepping(MoreauJean::with_step(1e-3));
    let mut stepper = motion.stepper().unwrap();
    stepper.step().unwrap();
    stepper.change(|block| block.rise = 0.01);
    assert!(matches!(stepper.step(), Err(Error::Penetration { contact: "floor", .. })));
    stepper.change(|block| block.rise = -0.01);
    assert!(stepper.step().is_ok());
}
