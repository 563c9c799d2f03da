//! Motions that go on from where others ended, frame by frame.

use lagrange_core::contact::Contact;
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};

/// A block with two corners on a floor, pulled along it.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(corner(s) = [x + s*b*cos(theta) + h*sin(theta), y + s*b*sin(theta) - h*cos(theta)])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*(b^2 + h^2)/6 * theta_dot^2 - m*g*y)]
#[force(x: pull)]
#[contact(
    floor[i in 0..2]: corner(2*i - 1)[1] >= 0,
    restitution: e,
    friction(static: mu, kinetic: nu): der(corner(2*i - 1))[0],
)]
struct Thrown {
    m: f64,
    b: f64,
    h: f64,
    g: f64,
    e: f64,
    mu: f64,
    nu: f64,
    pull: f64,
    floor: [Contact; 2],
}

fn thrown(seed: u64) -> (Thrown, State<f64, 3>) {
    let mut random = Random(seed);
    let nu = random.between(0.1, 0.4);
    let (mu, e) = (nu + random.between(0.0, 0.2), random.between(0.0, 0.4));
    let floor = [Contact::Open; 2];
    let block = Thrown { m: 1.0, b: 0.2, h: 0.1, g: 9.81, e, mu, nu, pull: random.between(0.0, 4.0), floor };
    let [v, turn, spin] = [(); 3].map(|()| random.between(-1.0, 1.0));
    (block, State::new([0.0, 0.3, 0.15 * turn], [v, 0.0, spin]))
}

/// The force changes from frame to frame; no start is refused, and no corner sinks in.
#[test]
fn each_frame_starts_where_the_last_one_ended() {
    for seed in 0..cases([3, 6, 500]) as u64 {
        let (mut block, mut state) = thrown(seed);
        let most = 2.0 * block.pull;
        for frame in (1..=200).map(f64::from) {
            block.pull = most * (frame / 30.0).sin();
            let path = block.motion(state).with_contacts().to(frame / 60.0);
            let path = path.unwrap_or_else(|error| panic!("seed {seed}, frame {frame}: {error}"));
            (state, block) = (*path.end().state(), path.system().clone());
            let (sin, cos) = state.q[2].sin_cos();
            let depth = [-0.2, 0.2].map(|b| 0.1 * cos - b * sin - state.q[1]);
            assert!(depth.iter().all(|depth| *depth < 1e-15), "seed {seed}, frame {frame}: {depth:?}");
        }
    }
}

#[test]
fn frames_are_one_motion() {
    for seed in 0..cases([5, 10, 500]) as u64 {
        let (mut block, mut state) = thrown(seed);
        let method = Dop853::with_tolerance(1e-12);
        let whole = block.motion(state).by(method).with_contacts().to(1.0).unwrap();
        for frame in (1..=60).map(f64::from) {
            let path = block.motion(state).by(method).with_contacts().to(frame / 60.0).unwrap();
            (state, block) = (*path.end().state(), path.system().clone());
        }
        // Bounces that rise by no more than 64 units of round-off count as rest, with velocities of the order of its root.
        let off = (state.q - whole.end().state().q).amax().max((state.v - whole.end().state().v).amax());
        assert!(off < 1e-6, "seed {seed}: {off:e}");
    }
}
