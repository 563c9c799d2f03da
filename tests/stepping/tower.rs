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
    let began = std::time::Instant::now();
    let path = tower().motion(standing()).by_time_stepping(MoreauJean::with_step(0.01)).to(100.0).unwrap();
    println!("{path}\n{:?}", began.elapsed());
    let moved = path.steps().iter().map(|step| (step.state.q - standing().q).amax()).fold(0.0, f64::max);
    println!("{moved:e}");
    assert!(moved < 1e-6, "{moved}");
}
