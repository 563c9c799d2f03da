//! A box that is set down by a hand, and comes to rest in ever smaller impacts on six contacts.

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

/// A hand at the height z with two fingers along x, whose pads at z ± p squeeze a box of half width b and half height c.
#[derive(Clone, Lagrangian)]
#[coordinates(z, left, right, x, y, theta)]
#[frame(container: translate([x, y, 0]), rotate_z(theta))]
#[define(pad = [[left, z + p, 0], [left, z - p, 0], [right, z + p, 0], [right, z - p, 0]])]
#[define(at[i in 0..4] = express(vector(fixed, pad[i]) - vector(fixed, position(container)), container))]
#[define(corner[i in 0..2] = [(2*i - 1)*b, -c, 0])]
#[lagrangian(
    hand/2 * z_dot^2 + finger/2 * (left_dot^2 + right_dot^2 + 2*z_dot^2)
    + m/2 * (x_dot^2 + y_dot^2) + m*(b^2 + c^2)/6 * theta_dot^2
    - g*((hand + 2*finger)*z + m*y) - centre/2 * (left + right)^2
)]
#[force(z: lift; left: squeeze; right: -squeeze)]
#[dissipation(damp/2 * (left_dot^2 + right_dot^2))]
#[contact(lpad[i in 0..2]: -b - at[i][0] >= 0, friction(static: mu, kinetic: nu): der(at[i], container)[1])]
#[contact(rpad[i in 0..2]: at[i + 2][0] - b >= 0, friction(static: mu, kinetic: nu): der(at[i + 2], container)[1])]
#[contact(floor[i in 0..2]: position(container, corner[i])[1] >= 0,
    friction(rough): express(velocity(container, corner[i]), fixed)[0])]
struct Gripper {
    hand: f64,
    finger: f64,
    m: f64,
    b: f64,
    c: f64,
    p: f64,
    g: f64,
    centre: f64,
    damp: f64,
    lift: f64,
    squeeze: f64,
    mu: f64,
    nu: f64,
    rough: f64,
    lpad: [Contact; 2],
    rpad: [Contact; 2],
    floor: [Contact; 2],
}

/// It squeezes for 0.3 s, lifts by 0.2 m in half a second, and loosens from 1.2 s on.
fn control(gripper: &mut Gripper, state: &State<f64, 6>) {
    let rise = ((state.t - 0.3) / 0.5).clamp(0.0, 1.0);
    let goal = 0.07 + 0.2 * (3.0 - 2.0 * rise) * rise * rise;
    let weight = 9.81 * (1.4 + if state.t > 0.3 { 0.8 } else { 0.0 });
    gripper.lift = weight + 800.0 * (goal - state.q[0]) - 60.0 * state.v[0];
    gripper.squeeze = 9.0 * (2.2 - state.t).clamp(0.0, 1.0);
}

#[test]
fn a_box_that_slips_out_of_a_hand_comes_to_rest() {
    let (lpad, rpad, floor) = ([Contact::Open; 2], [Contact::Open; 2], [Contact::Closed; 2]);
    let mut gripper = Gripper {
        hand: 1.0,
        finger: 0.2,
        m: 0.8,
        b: 0.04,
        c: 0.06,
        p: 0.01,
        g: 9.81,
        centre: 50.0,
        damp: 2.0,
        lift: 0.0,
        squeeze: 0.0,
        mu: 0.6,
        nu: 0.4,
        rough: 0.5,
        lpad,
        rpad,
        floor,
    };
    let start = State::at_rest([0.07, -0.06, 0.05, 0.0, 0.06, 0.0]);
    let mut stepper = gripper.motion(start).by_time_stepping(MoreauJean::with_step(1e-3)).stepper().unwrap();
    while stepper.state().t < 1.6 {
        let state = *stepper.state();
        stepper.change(|gripper| control(gripper, &state));
        stepper.step().unwrap();
    }
    assert!(stepper.state().q[4] > 0.1, "it is lifted: {:?}", stepper.state());
    gripper.floor = [Contact::Open; 2];
    let motion =
        gripper.motion(*stepper.state()).with_contacts().every(0.1).controlled(1e-3, |gripper, state| {
            control(gripper, state);
            Ok::<(), &str>(())
        });
    let arrival = motion.to(1.85).unwrap();
    let end = *arrival.end().state();
    assert!((end.q[4] - 0.06).abs() < 1e-12 && end.q[5].abs() < 1e-12, "{end:?}");
}
