//! Contacts that rest where coordinates are zero, and that come to rest together.

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;
use lagrange_systems::{Shaken, Stack, Walled};

use crate::impacts;

/// Without a force, the gap drifts about zero by less than the smallest distance that x has: one impact, and nothing else.
#[test]
fn a_pendulum_rests_at_its_wall() {
    let pendulum = Walled { m: 1.0, g: 9.81, l: 1.0, ..Walled::default() };
    let (s, c) = 1.2_f64.sin_cos();
    let motion = pendulum.motion(State::at_rest([-s, -c])).by(Dop853::with_tolerance(1e-12));
    let path = motion.with_contacts().max_transitions(100).to(5.0).unwrap();
    let [Transition::Impact { impulses, .. }] = path.transitions() else {
        panic!("{:?}", path.transitions())
    };
    assert!((impulses[0].1 - (2.0 * 9.81 * (1.0 - c)).sqrt()).abs() < 1e-11, "{impulses:?}");
    assert!(path.end().state().q[0].abs() < 1e-15 && path.end().state().v[0].abs() < 1e-15, "{}", path.end());
}

/// Its weight comes in pulses, down to zero and a little below.
#[test]
fn a_block_that_loses_its_weight_for_an_instant_stays_on_its_floor() {
    for b in [9.81, 9.810_000_1] {
        let block = Shaken { m: 1.0, g: 9.81, b, w: 3.0, ..Shaken::default() };
        let motion = block.motion(State::at_rest([0.0])).by(Dop853::with_tolerance(1e-12)).with_contacts();
        let path = motion.max_transitions(100).to(5.0).unwrap();
        assert_eq!(path.system().floor, Contact::Closed);
        // The first lifting begins where the weight is zero, and rises by less than 10⁻¹⁰.
        assert!(path.end().state().q[0].abs() < 1e-15, "{}", path.end());
        let opens = path.transitions().iter().find(|of| matches!(of, Transition::Opens { .. })).unwrap();
        assert!((opens.time() - core::f64::consts::FRAC_PI_3).abs() < 1e-4, "{:?}", path.transitions());
    }
}

#[test]
fn blocks_come_to_rest_on_one_another() {
    let stack = Stack { m: [1.0; 3], h: 0.1, g: 9.81, e: [0.5; 3], ..Stack::default() };
    let path = stack.motion(State::at_rest([0.5, 0.8, 1.3])).with_contacts().to(10.0).unwrap();
    let last = *impacts(path.transitions()).last().unwrap();
    for transition in path.transitions() {
        if let Transition::Rests { contact, time } = transition {
            assert!(*time >= 0.0 && *time < last + 1e-5, "`{contact}` rests at {time}, after {last}");
        }
    }
    assert!(
        (path.end().state().q[0].abs() + (path.end().state().q[2] - 0.2).abs()) < 1e-14,
        "{}",
        path.end()
    );
    // At rest from the start, with y[0] = 0: no entry gives the round-off of this gap a size.
    let path = stack.motion(State::at_rest([0.0, 0.1, 0.2])).with_contacts().to(10.0).unwrap();
    let forces = path.system().solve(path.end().state()).unwrap().multipliers;
    for (force, blocks) in forces.iter().zip([3.0, 2.0, 1.0]) {
        assert!((force - blocks * 9.81).abs() < 1e-12, "{forces}");
    }
}

/// The place of the floor is known to its velocity times the round-off of the time, even where the ball moves along with it.
#[test]
fn a_ball_rests_on_a_moving_floor_at_late_times() {
    let shaken = Shaken { m: 1.0, g: 9.81, a: 0.1, w: 5.0, e: 0.5, ..Shaken::default() };
    let floor = |t: f64| 0.1 * (5.0 * t).sin();
    for start in [0.0, 1e3, 1e5, 1e6] {
        let state = State { t: start, ..State::at_rest([floor(start) + 0.3]) };
        let motion = shaken.motion(state).by(Dop853::with_tolerance(1e-12)).with_contacts();
        let path = motion.max_transitions(1_000).to(start + 1.5).unwrap();
        assert_eq!(path.system().floor, Contact::Closed, "from {start}");
        let gap = path.end().state().q[0] - floor(path.end().state().t);
        assert!(gap.abs() < 1e-15 * (1.0 + start), "from {start}: {gap:e}");
    }
}

/// Number of impacts of three balls in a row that touch, and velocities after them.
fn after(m: [f64; 3], e: f64, v: [f64; 3]) -> (usize, [f64; 3]) {
    let balls = Stack { m, low: -9.0, e: [e; 3], ..Stack::default() };
    let path = balls.motion(State::new([0.0; 3], v)).with_contacts().to(0.1).unwrap();
    (impacts(path.transitions()).len(), path.end().state().v.into())
}

/// A heavy ball drives a light one against another that moves away: the light one is hit in turn, thousands of times, until they
/// go on together.
#[test]
fn heavy_balls_catch_a_light_one() {
    for (e, m) in [(0.3, [1.0, 1e-2, 2.0]), (0.9, [1.0, 1e-3, 2.0])] {
        let (_, after) = after(m, e, [1.0, 0.0, 0.25]);
        // Momentum is kept.
        let together = (m[0] + 0.25 * m[2]) / (m[0] + m[1] + m[2]);
        assert!(after.iter().all(|v| (v - together).abs() < 1e-12), "e = {e}: {after:?} for {together}");
    }
}

/// A light ball between two heavy ones that close in is hit thousands of times, until they part: as by Newton's law for one impact after
/// another.
#[test]
fn a_light_ball_drives_heavy_ones_apart() {
    for (light, e) in [(1e-8, 0.9999), (1e-6, 0.99999)] {
        let (m, mut v) = ([1.0, light, 1.0], [1.0, 2.0, -1.0]);
        let mut count = 0;
        while let Some(i) = (0..2).find(|&i| v[i + 1] < v[i]) {
            let impulse = (1.0 + e) * (v[i] - v[i + 1]) * m[i] * m[i + 1] / (m[i] + m[i + 1]);
            (v[i], v[i + 1]) = (v[i] - impulse / m[i], v[i + 1] + impulse / m[i + 1]);
            count += 1;
        }
        let (impacts, after) = after(m, e, [1.0, 2.0, -1.0]);
        assert_eq!(impacts, count, "{light}, {e}");
        let off = after.iter().zip(v).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(off < 1e-8, "{light}, {e}: off by {off:e}");
    }
}

/// Its velocities along the floor are the round-off of nothing, with no size of their own.
#[test]
fn a_block_at_rest_that_is_steered_stays_at_rest() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, theta)]
    #[define(corner[i in 0..2] = [
        x + (2*i - 1)*b*cos(theta) + b*sin(theta),
        y + (2*i - 1)*b*sin(theta) - b*cos(theta)
    ])]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*b^2/3 * theta_dot^2 - m*g*y)]
    #[contact(floor[i in 0..2]: corner[i][1] >= 0, friction(mu): der(corner[i])[0])]
    struct Steered {
        m: f64,
        b: f64,
        g: f64,
        mu: f64,
        floor: [Contact; 2],
    }
    let block = Steered { m: 1.0, b: 0.1, g: 9.81, mu: 0.5, floor: [Contact::Open; 2] };
    let motion = block.motion(State::at_rest([0.0, 0.1, 0.0])).with_contacts().every(0.01);
    let arrival = motion.controlled(1e-3, |_, _| Ok::<(), &str>(())).to(0.1).unwrap();
    assert!(
        matches!(arrival.transitions()[..], [Transition::Closes { .. }, Transition::Closes { .. }]),
        "{:?}",
        arrival.transitions()
    );
}
