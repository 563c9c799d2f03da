//! Bodies that friction holds.

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;
use lagrange_random::cases;

/// A cube between two pads, with a contact at each corner. The left pad is a wall, the right one presses.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4], pad)]
#[frame(cube: translate(r), rotate(q))]
#[define(at(i, j, k) = [(2*i - 1)*a, (2*j - 1)*a, (2*k - 1)*a])]
#[define(corner[i in 0..2, j in 0..2, k in 0..2] = position(cube, at(i, j, k)))]
#[define(slip[i in 0..2, j in 0..2, k in 0..2] = express(velocity(cube, at(i, j, k)), fixed))]
#[lagrangian(kinetic(cube, m, [0, 0, 0], 2/3*m*a^2*identity(3)) + m/2*pad_dot^2 - m*g*r[2])]
#[force(pad: -press)]
#[contact(wall[j in 0..2, k in 0..2]: corner[0][j][k][0] >= 0, friction(mu): slip[0][j][k][1..3])]
#[contact(pads[j in 0..2, k in 0..2]: pad - corner[1][j][k][0] >= 0, friction(mu): slip[1][j][k][1..3])]
struct Grip {
    m: f64,
    a: f64,
    g: f64,
    mu: f64,
    press: f64,
    wall: [[Contact; 2]; 2],
    pads: [[Contact; 2]; 2],
}

fn held(press: f64, h: f64, end: f64) -> Trajectory<Grip> {
    let sides = [[Contact::Closed; 2]; 2];
    let grip = Grip { m: 1.0, a: 0.05, g: 9.81, mu: 0.5, press, wall: sides, pads: sides };
    let start = State::at_rest([0.05, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.1]);
    grip.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(end).unwrap()
}

/// Below the limit 2 μ F it stands still, and the forces of its corners are alike.
#[test]
fn a_cube_between_pads_is_held() {
    for press in [9.82, 20.0, 1000.0] {
        let path = held(press, 1.0 / 60.0, cases([2, 3, 60]) as f64);
        // A unit of round-off of the impulses is a velocity of this size.
        let still = 1e-15 * f64::max(1.0, press / 20.0);
        assert!(path.steps().all(|step| step.state().v.norm() < still), "{press}: {:?}", path.end());
        assert!(
            path.end().state().q[1].abs() < 1e-15 && path.end().state().q[2].abs() < 1e-14,
            "{press}: {:?}",
            path.end()
        );
        for (side, j, k) in (0..8).map(|at| (["wall", "pads"][at / 4], at / 2 % 2, at % 2)) {
            let push = path.end().multiplier(&format!("{side}[{j}][{k}]")).unwrap();
            let drag = path.end().multiplier(&format!("{side}_friction[{j}][{k}][1]")).unwrap();
            assert!((push - press / 4.0).abs() < 1e-10 * press, "{press}: {side}[{j}][{k}] pushes {push}");
            assert!((drag - 9.81 / 8.0).abs() < 1e-10 * press, "{press}: {side}[{j}][{k}] drags {drag}");
        }
    }
}

/// Above the limit it falls with g − 2 μ F/m, without turning.
#[test]
fn a_cube_between_pads_slides_above_the_limit() {
    let path = held(9.0, 1e-2, 1.0);
    let end = *path.end().state();
    assert!((end.v[2] + 0.81).abs() < 1e-10 && (end.q[2] + 0.405).abs() < 1e-10, "{end:?}");
    assert!((end.q[3] - 1.0).abs() < 1e-12 && end.v[0].abs() < 1e-12, "{end:?}");
}
