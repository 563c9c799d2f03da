//! `ours SCENE STEP SECONDS` holds a cube of 1 kg still, and prints how far it has crept, how fast it is at the end, and what a step took.
//! In the scene `grip` a pad presses it against a wall with 20 N, twice as much as it needs; in `slope` it stands on a slope of 25°.
//! Friction has the coefficient 0.5.

use std::time::Instant;

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

/// The wall is x = 0; the pad moves along x. A corner (i, j, k) of the cube is at x ± a, y ± a, z ± a.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4], pad)]
#[frame(cube: translate(r), rotate(q))]
#[define(at(i, j, k) = [(2*i - 1)*a, (2*j - 1)*a, (2*k - 1)*a])]
#[define(corner[i in 0..2, j in 0..2, k in 0..2] = position(cube, at(i, j, k)))]
#[define(slip[i in 0..2, j in 0..2, k in 0..2] = express(velocity(cube, at(i, j, k)), fixed))]
#[lagrangian(kinetic(cube, m, [0, 0, 0], 2/3*m*a^2*identity(3)) + m_pad/2*pad_dot^2 - m*g*r[2])]
#[force(pad: -press)]
#[contact(wall[j in 0..2, k in 0..2]: corner[0][j][k][0] >= 0, friction(mu): slip[0][j][k][1..3])]
#[contact(pads[j in 0..2, k in 0..2]: pad - corner[1][j][k][0] >= 0, friction(mu): slip[1][j][k][1..3])]
struct Grip {
    m: f64,
    m_pad: f64,
    a: f64,
    g: f64,
    mu: f64,
    press: f64,
    wall: [[Contact; 2]; 2],
    pads: [[Contact; 2]; 2],
}

/// Gravity has a part along the slope, which is the plane z = 0.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[frame(cube: translate(r), rotate(q))]
#[define(corner(i, j) = [(2*i - 1)*a, (2*j - 1)*a, -a])]
#[lagrangian(kinetic(cube, m, [0, 0, 0], 2/3*m*a^2*identity(3)) + m*g*(sin(alpha)*r[0] - cos(alpha)*r[2]))]
#[contact(
    slope[i in 0..2, j in 0..2]: position(cube, corner(i, j))[2] >= 0,
    friction(mu): express(velocity(cube, corner(i, j)), fixed)[0..2],
)]
struct Slope {
    m: f64,
    a: f64,
    g: f64,
    alpha: f64,
    mu: f64,
    slope: [[Contact; 2]; 2],
}

const A: f64 = 0.05;
const CLOSED: [[Contact; 2]; 2] = [[Contact::Closed; 2]; 2];

/// Moves a system from a state for so many seconds, in steps of this length.
macro_rules! hold {
    ($system:expr, $start:expr, $step:expr, $seconds:expr) => {{
        let (system, start, now) = ($system, $start, Instant::now());
        let scheme = MoreauJean::with_step($step).max_steps(usize::MAX);
        let path = system.motion(start).by_time_stepping(scheme).to($seconds).expect("a motion");
        let spent = now.elapsed().as_secs_f64() / path.statistics().accepted as f64;
        let end = *path.end().state();
        let creep = (end.q - start.q).fixed_rows::<3>(0).norm();
        let speed = end.v.fixed_rows::<3>(0).norm();
        println!("{{\"creep\": {creep}, \"speed\": {speed}, \"step\": {spent}}}");
    }};
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, step, seconds] = &arguments[..] else { panic!("ours SCENE STEP SECONDS") };
    let [step, seconds] = [step, seconds].map(|number| number.parse().expect("a number"));
    if scene == "grip" {
        let (m, m_pad, g, mu, press) = (1.0, 1.0, 9.81, 0.5, 20.0);
        let grip = Grip { m, m_pad, a: A, g, mu, press, wall: CLOSED, pads: CLOSED };
        hold!(grip, State::at_rest([A, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0 * A]), step, seconds);
    } else {
        let slope = Slope { m: 1.0, a: A, g: 9.81, alpha: 25_f64.to_radians(), mu: 0.5, slope: CLOSED };
        hold!(slope, State::at_rest([0.0, 0.0, A, 1.0, 0.0, 0.0, 0.0]), step, seconds);
    }
}
