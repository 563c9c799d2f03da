//! A tower of ten blocks in the plane, with twenty corner contacts.

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

/// Blocks of half width b and half height h on a floor. Each stands with its two lower corners on the one below.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [10], y: [10], theta: [10])]
#[define(corner_x(i, s) = x[i] + s*b*cos(theta[i]) + h*sin(theta[i]))]
#[define(corner_y(i, s) = y[i] + s*b*sin(theta[i]) - h*cos(theta[i]))]
#[define(along(i, s) = cos(theta[i])*(corner_x(i + 1, s) - x[i]) + sin(theta[i])*(corner_y(i + 1, s) - y[i]))]
#[define(above(i, s) = cos(theta[i])*(corner_y(i + 1, s) - y[i]) - sin(theta[i])*(corner_x(i + 1, s) - x[i]) - h)]
#[lagrangian(
    m/2 * (dot(x_dot, x_dot) + dot(y_dot, y_dot)) + m*(b^2 + h^2)/6 * dot(theta_dot, theta_dot)
    - m*g*sum(i in 0..10, y[i])
)]
#[contact(floor[k in 0..2]: corner_y(0, 2*k - 1) >= 0, friction(mu): der(corner_x(0, 2*k - 1)))]
#[contact(left[i in 0..9]: above(i, -1) >= 0, friction(mu): der(along(i, -1)))]
#[contact(right[i in 0..9]: above(i, 1) >= 0, friction(mu): der(along(i, 1)))]
struct Tower {
    m: f64,
    b: f64,
    h: f64,
    g: f64,
    mu: f64,
    floor: [Contact; 2],
    left: [Contact; 9],
    right: [Contact; 9],
}

fn tower() -> Tower {
    let (floor, nine) = ([Contact::Open; 2], [Contact::Open; 9]);
    Tower { m: 1.0, b: 0.5, h: 0.25, g: 9.81, mu: 0.5, floor, left: nine, right: nine }
}

fn standing() -> State<f64, 30> {
    let mut start = State::at_rest([0.0; 30]);
    (0..10).for_each(|i| start.q[10 + i] = 0.25 + 0.5 * i as f64);
    start
}

#[test]
fn a_tower_of_ten_blocks_stands() {
    let path = tower().motion(standing()).by_time_stepping(MoreauJean::with_step(0.05)).to(100.0).unwrap();
    assert_eq!(path.steps().count(), 2001);
    for step in path.steps() {
        let moved = (step.state().q - standing().q).amax();
        assert!(moved < 1e-6, "{moved} at t = {}", step.time());
    }
    // The floor carries all blocks, and each two corners those above.
    let last = path.end();
    let carried = |left: &str, right: &str| last.multiplier(left).unwrap() + last.multiplier(right).unwrap();
    assert!((carried("floor[0]", "floor[1]") - 10.0 * 9.81).abs() < 1e-5);
    for i in 0..9 {
        let weight = f64::from(9 - i) * 9.81;
        let found = carried(&format!("left[{i}]"), &format!("right[{i}]"));
        assert!((found - weight).abs() < 1e-5, "{found} for {weight}");
    }
}

/// A tower is hit in the middle while its top block, thrown up, tumbles down on it. Energy rises by no more than what lifts the blocks where corners leave circles.
#[test]
fn a_tower_that_is_hit_slides_and_tumbles_and_its_energy_falls() {
    let (mut start, h) = (standing(), 4e-3);
    (start.v[5], start.v[19], start.v[29]) = (6.0, 2.0, 3.0);
    let path = tower().motion(start).by_time_stepping(MoreauJean::with_step(h)).to(0.8).unwrap();
    let energies: Vec<f64> = path.steps().map(|step| step.energy()).collect();
    for (pair, at) in energies.windows(2).zip(path.steps()) {
        let turn = at.state().v.as_slice()[20..].iter().fold(0.0, |most: f64, omega| most.max(omega.abs()));
        let lift = 10.0 * 9.81 * 0.5 * 0.5_f64.hypot(0.25) * (h * turn).powi(2);
        assert!(pair[1] - pair[0] <= lift + 1e-6 * 10.0 * (9.81 * h).powi(2), "{pair:?}, {lift}");
    }
    let turned = path.steps().fold(0.0, |most: f64, step| most.max(step.state().q[29].abs()));
    assert!(turned > 0.5, "{turned}");
}
