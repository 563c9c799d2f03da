//! Motions in steps of one length against motions from impact to impact, whose times are exact to round-off: the error falls with
//! the step, by its first power.

use lagrange_core::contact::{Contact, ForceDerivatives, MoreauJean};
use lagrange_core::{StateOf, prelude::*};
use lagrange_systems::{Ball, Belt, Puck, Rod, Shaken, Sphere, Walled};

/// Fails where the least-squares slope of the logarithm of the deviation of coordinates, the largest of 50 times, over seven
/// steps each half as long as the one before, is below 0.9; or the deviation of the last is above the bound. It depends
/// on the place of an impact within its step: each is the mean over five lengths within a fifth of one another.
#[track_caller]
fn converges<L>(system: &L, start: StateOf<L>, end: f64, longest: f64, bound: f64)
where
    L: ForceDerivatives<Scalar = f64> + Clone,
{
    let exact = system.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(end).unwrap();
    let exact: Vec<(f64, StateOf<L>)> =
        (1..=50).map(|k| end * f64::from(k) / 50.0).map(|t| (t, *exact.at(t).unwrap().state())).collect();
    let error = |h: f64| {
        let path = system.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(end).unwrap();
        exact.iter().fold(0.0, |most: f64, (t, state)| {
            let found = path.at(*t).unwrap().state().q;
            found.iter().zip(state.q.iter()).fold(most, |most, (x, y)| most.max((x - y).abs()))
        })
    };
    let point = |k: i32| {
        let h = longest * 0.5_f64.powi(k);
        let mean = (0..5).map(|j| error(h * (1.0 - 0.04 * f64::from(j)))).sum::<f64>() / 5.0;
        [h.ln(), mean.ln()]
    };
    let points: Vec<[f64; 2]> = (0..7).map(point).collect();
    let mean = [0, 1].map(|c| points.iter().map(|point| point[c]).sum::<f64>() / points.len() as f64);
    let sum = |c: usize| points.iter().map(|point| (point[0] - mean[0]) * (point[c] - mean[c])).sum::<f64>();
    let (slope, last) = (sum(1) / sum(0), points[6][1].exp());
    println!("{}: slope {slope:.3}, error {last:.2e}", L::NAME);
    assert!(slope >= 0.9 && last < bound, "{}: slope {slope}, error {last}", L::NAME);
}

#[test]
fn bounces_converge() {
    let ball = Ball { m: 0.2, g: 9.81, e: 0.5, ..Ball::default() };
    converges(&ball, State::new([0.0, 0.3], [0.4, 0.0]), 1.5, 7e-3, 2e-3);
    let rod = Rod { m: 1.5, j: 0.125, a: 0.5, g: 9.81, e: 0.3, mu: [0.3; 2], left: -9.0, ..Rod::default() };
    converges(&rod, State::new([0.0, 0.8, 0.7], [0.5, 0.0, -0.4]), 0.7, 5e-3, 2e-3);
    // The impact at 0.868 grazes, and small errors grow tenfold.
    let shaken = Shaken { m: 0.7, g: 9.81, e: 0.3, a: 0.02, w: 30.0, ..Shaken::default() };
    converges(&shaken, State::at_rest([0.2]), 0.85, 2e-3, 1e-3);
}

#[test]
fn sliding_converges() {
    let sphere = Sphere { m: 0.4, g: 9.81, r: 0.3, e: 0.0, mu: 0.25, floor: Contact::Closed };
    converges(&sphere, State::new([0.0, 0.3, 0.0], [2.0, 0.0, 0.0]), 0.5, 7e-3, 1e-3);
    let block = Belt { m: 1.0, k: 4.0, speed: 0.2, hold: 2.0, pull: 1.0, ..Belt::default() };
    converges(&block, State::new([0.0], [0.2]), 10.0, 3e-2, 1e-2);
    // On a plate that turns.
    let puck = Puck { m: 0.3, g: 9.81, mu: 0.2, turning: 1.5, floor: Contact::Closed, ..Puck::default() };
    converges(&puck, State::new([0.4, 0.0, 0.0], [-0.5, 0.8, 0.0]), 1.0, 7e-3, 1e-3);
}

#[test]
fn a_pendulum_that_hits_a_wall_converges_and_stays_on_its_rod() {
    let pendulum = Walled { m: 1.5, l: 1.0, g: 9.81, d: 0.2, e: 0.6, ..Walled::default() };
    let start = State::at_rest([-0.6, -0.8]);
    converges(&pendulum, start, 2.0, 5e-3, 1e-2);
    let path = pendulum.motion(start).by_time_stepping(MoreauJean::with_step(5e-3)).to(2.0).unwrap();
    for step in path.steps() {
        let [x, y] = [step.state().q[0], step.state().q[1]];
        assert!((x.hypot(y) - 1.0).abs() < 1e-9 && x < 0.2 + 1e-9, "{step:?}");
    }
}

/// The second of two links from a pivot hits a wall with its end, and rubs along it. The mass matrix depends on the angles.
#[test]
fn two_links_hit_a_wall() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(a, b)]
    #[define(elbow = [sin(a), -cos(a)])]
    #[define(end = elbow + [sin(b), -cos(b)])]
    #[lagrangian(dot(der(elbow), der(elbow))/2 + dot(der(end), der(end))/2 - g*elbow[1] - g*end[1])]
    #[contact(wall: end[0] + 0.3 >= 0, restitution: e, friction(mu): der(end)[1])]
    struct Links {
        g: f64,
        e: f64,
        mu: f64,
        wall: Contact,
    }
    let links = Links { g: 9.81, e: 0.4, mu: 0.2, wall: Contact::Open };
    converges(&links, State::new([0.5, 0.9], [0.0, 0.5]), 1.5, 4e-3, 5e-3);
}
