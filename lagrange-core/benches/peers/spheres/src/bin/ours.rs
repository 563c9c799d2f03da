//! `ours RATE ENDS` moves the spheres by time stepping with so many steps a second.

use std::time::Instant;

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;
use spheres::{COUNT, FRICTION, GRAVITY, MASS, RADIUS, RESTITUTION, Run, SECONDS, position, velocity};

/// The angles are those of the turns about the three axes: the inertia is the same about all.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [100], y: [100], z: [100], a: [100], b: [100], c: [100])]
#[define(fall = dot(x_dot, x_dot) + dot(y_dot, y_dot) + dot(z_dot, z_dot))]
#[define(spin = dot(a_dot, a_dot) + dot(b_dot, b_dot) + dot(c_dot, c_dot))]
#[lagrangian(m/2 * fall + m*r^2/5 * spin - m*g*sum(i in 0..100, z[i]))]
#[contact(
    floor[i in 0..100]: z[i] - r >= 0,
    restitution: e,
    friction(mu): [x_dot[i] - r*b_dot[i], y_dot[i] + r*a_dot[i]],
)]
struct Spheres {
    m: f64,
    r: f64,
    g: f64,
    e: f64,
    mu: f64,
    floor: [Contact; 100],
}

fn run(rate: f64) -> Run {
    let floor = [Contact::Open; COUNT];
    let spheres = Spheres { m: MASS, r: RADIUS, g: GRAVITY, e: RESTITUTION, mu: FRICTION, floor };
    let (mut q, mut v) = ([0.0; 6 * COUNT], [0.0; 6 * COUNT]);
    for i in 0..COUNT {
        [q[i], q[COUNT + i], q[2 * COUNT + i]] = position(i);
        [v[i], v[COUNT + i]] = velocity(i);
    }
    let (motion, now) = (spheres.motion(State::new(q, v)), Instant::now());
    let path =
        motion.by_time_stepping(MoreauJean::with_step(1.0 / rate)).to(SECONDS as f64).expect("a motion");
    let mut run = Run { spent: now.elapsed(), ..Run::default() };
    path.steps().for_each(|step| (0..COUNT).for_each(|i| run.passes(step.state().q[2 * COUNT + i])));
    let v = path.end().state().v;
    for i in 0..COUNT {
        let along = [v[i], v[COUNT + i]];
        run.ends(i, along, [along[0] - RADIUS * v[4 * COUNT + i], along[1] + RADIUS * v[3 * COUNT + i]]);
    }
    run
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let rate = arguments.next().and_then(|rate| rate.parse().ok()).expect("a rate");
    let ends = arguments.next().expect("a file");
    // The equations of 600 coordinates and 300 constraints need a larger stack than that of the main thread.
    let thread = std::thread::Builder::new().stack_size(64 << 20);
    thread.spawn(move || spheres::answer(&ends, || run(rate))).expect("a thread").join().expect("an answer");
}
