//! Contacts that rest where coordinates are zero, and that come to rest together.

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;

/// A pendulum in Cartesian coordinates, with a wall below its pivot.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
#[contact(wall: x >= 0)]
struct Pendulum {
    m: f64,
    g: f64,
    l: f64,
    wall: Contact,
}

/// Without a force, the gap drifts about zero by less than the smallest distance that x has: one impact, and nothing else.
#[test]
fn a_pendulum_rests_at_its_wall() {
    let pendulum = Pendulum { m: 1.0, g: 9.81, l: 1.0, wall: Contact::Open };
    let (s, c) = 1.2_f64.sin_cos();
    let motion = pendulum.motion(State::at_rest([s, -c])).by(Dop853::with_tolerance(1e-12));
    let path = motion.with_contacts().max_transitions(100).to(5.0).unwrap();
    let [Transition::Impact { impulses, .. }] = path.transitions() else {
        panic!("{:?}", path.transitions())
    };
    assert!((impulses[0].1 - (2.0 * 9.81 * (1.0 - c)).sqrt()).abs() < 1e-11, "{impulses:?}");
    assert!(path.end().q[0].abs() < 1e-15 && path.end().v[0].abs() < 1e-15, "{}", path.end());
}

/// A table with a leg at each corner, which stands on any three of them.
#[derive(Clone, Lagrangian)]
#[coordinates(z, a, b)]
#[lagrangian(m/2 * z_dot^2 + j/2 * (a_dot^2 + b_dot^2) - m*g*z)]
#[define(leg = [z + a + b, z + a - b, z - a + b, z - a - b])]
#[contact(legs[i in 0..4]: leg[i] >= 0)]
struct Table {
    m: f64,
    j: f64,
    g: f64,
    legs: [Contact; 4],
}

#[test]
fn tables_stand_on_their_legs() {
    let table = Table { m: 2.0, j: 0.3, g: 9.81, legs: [Contact::Open; 4] };
    // The second one rocks: a leg lifts off, and is back on the floor half-way through a step.
    let starts = [State::at_rest([0.5, 0.0, 0.0]), State::new([0.5, 0.1, 0.05], [0.0, 0.3, -0.2])];
    for start in starts {
        let path = table.motion(start).with_contacts().max_transitions(1_000).to(10.0).unwrap();
        assert!(path.end().q.amax() < 1e-14 && path.end().v.amax() < 1e-14, "{}", path.end());
        let forces = path.system().solve(path.end()).unwrap().multipliers;
        assert!((forces.sum() - 2.0 * 9.81).abs() < 1e-12 && forces.min() >= 0.0, "{forces}");
    }
}

/// Where all entries are zero from the start on, no one of them gives round-off a size.
#[test]
fn tables_stand_at_the_origin() {
    for j in [0.3, 1e-3] {
        let table = Table { m: 2.0, j, g: 9.81, legs: [Contact::Open; 4] };
        let start = State::at_rest([0.0; 3]);
        let path = table.motion(start).with_contacts().max_transitions(100).to(10.0).unwrap();
        assert!(path.end().q.amax() < 1e-20 && path.end().v.amax() < 1e-20, "{}", path.end());
        let forces = path.system().solve(path.end()).unwrap().multipliers;
        // A leg that takes no load has round-off of the others'.
        assert!((forces.sum() - 2.0 * 9.81).abs() < 1e-12 && forces.min() > -1e-13, "{forces}");
    }
}

/// A block whose weight comes in pulses, down to zero and a little below.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(m/2 * y_dot^2 - m*y*(g + b*cos(w*t)))]
#[contact(floor: y >= 0)]
struct Pulsed {
    m: f64,
    g: f64,
    b: f64,
    w: f64,
    floor: Contact,
}

#[test]
fn a_block_that_loses_its_weight_for_an_instant_stays_on_its_floor() {
    for b in [9.81, 9.810_000_1] {
        let block = Pulsed { m: 1.0, g: 9.81, b, w: 3.0, floor: Contact::Open };
        let motion = block.motion(State::at_rest([0.0])).by(Dop853::with_tolerance(1e-12)).with_contacts();
        let path = motion.max_transitions(100).to(5.0).unwrap();
        assert_eq!(path.system().floor, Contact::Closed);
        // The first lifting begins where the weight is zero, and rises by less than 10⁻¹⁰.
        assert!(path.end().q[0].abs() < 1e-15, "{}", path.end());
        let opens =
            path.transitions().iter().find(|transition| matches!(transition, Transition::Opens { .. }));
        assert!(
            (opens.unwrap().time() - core::f64::consts::FRAC_PI_3).abs() < 1e-4,
            "{:?}",
            path.transitions()
        );
    }
}

/// Three blocks on one another.
#[derive(Clone, Lagrangian)]
#[coordinates(y: [3])]
#[lagrangian(m/2 * dot(y_dot, y_dot) - m*g*(y[0] + y[1] + y[2]))]
#[contact(floor: y[0] >= 0, restitution: e)]
#[contact(blocks[i in 0..2]: y[i + 1] - y[i] - h >= 0, restitution: e)]
struct Stack {
    m: f64,
    h: f64,
    g: f64,
    e: f64,
    floor: Contact,
    blocks: [Contact; 2],
}

#[test]
fn blocks_come_to_rest_on_one_another() {
    let stack = Stack { m: 1.0, h: 0.1, g: 9.81, e: 0.5, floor: Contact::Open, blocks: [Contact::Open; 2] };
    let start = State::at_rest([0.5, 0.8, 1.3]);
    let path = stack.motion(start).with_contacts().to(10.0).unwrap();
    let impact = |transition: &&Transition<f64>| matches!(transition, Transition::Impact { .. });
    let last = path.transitions().iter().rfind(impact).unwrap().time();
    for transition in path.transitions() {
        if let Transition::Rests { contact, time } = transition {
            assert!(*time >= 0.0 && *time < last + 1e-5, "`{contact}` rests at {time}, after {last}");
        }
    }
    assert!((path.end().q[0].abs() + (path.end().q[2] - 0.2).abs()) < 1e-14, "{}", path.end());
    // At rest from the start, with y[0] = 0: no entry gives the round-off of this gap a size.
    let path = stack.motion(State::at_rest([0.0, 0.1, 0.2])).with_contacts().to(10.0).unwrap();
    let forces = path.system().solve(path.end()).unwrap().multipliers;
    for (force, blocks) in forces.iter().zip([3.0, 2.0, 1.0]) {
        assert!((force - blocks * 9.81).abs() < 1e-12, "{forces}");
    }
}

/// A ball on a floor that moves.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(m/2 * y_dot^2 - m*g*y)]
#[contact(floor: y - a*sin(w*t) >= 0, restitution: e)]
struct Shaken {
    m: f64,
    g: f64,
    a: f64,
    w: f64,
    e: f64,
    floor: Contact,
}

/// The place of the floor is known to its velocity times the round-off of the time, even where the ball moves along with it.
#[test]
fn a_ball_rests_on_a_moving_floor_at_late_times() {
    let shaken = Shaken { m: 1.0, g: 9.81, a: 0.1, w: 5.0, e: 0.5, floor: Contact::Open };
    let floor = |t: f64| 0.1 * (5.0 * t).sin();
    for start in [0.0, 1e3, 1e5, 1e6] {
        let state = State { t: start, ..State::at_rest([floor(start) + 0.3]) };
        let motion = shaken.motion(state).by(Dop853::with_tolerance(1e-12)).with_contacts();
        let path = motion.max_transitions(1_000).to(start + 1.5).unwrap();
        assert_eq!(path.system().floor, Contact::Closed, "from {start}");
        let gap = path.end().q[0] - floor(path.end().t);
        assert!(gap.abs() < 1e-15 * (1.0 + start), "from {start}: {gap:e}");
    }
}

/// A ball in a slot that leaves it no room, without weight.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2)]
#[contact(floor: y >= 0, restitution: e)]
#[contact(ceiling: room - y >= 0, restitution: e)]
struct Slot {
    e: f64,
    room: f64,
    floor: Contact,
    ceiling: Contact,
}

/// Impacts follow one another at one time until the rate is its round-off, which is then taken.
#[test]
fn a_ball_in_a_slot_without_room_comes_to_rest() {
    for (e, room) in [(0.0, 0.0), (0.3, 0.0), (0.5, 0.0), (0.5, 1e-17), (0.9, 0.0)] {
        for v in [1.0, -7.7] {
            let slot = Slot { e, room, floor: Contact::Open, ceiling: Contact::Open };
            let path = slot.motion(State::new([0.0], [v])).with_contacts().to(1.0).unwrap();
            assert!(path.end().q[0].abs() <= room && path.end().v[0] == 0.0, "{e}, {v}: {}", path.end());
        }
    }
}

/// Three balls in a row, which touch.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [3])]
#[lagrangian(sum(i in 0..3, m[i]/2*x_dot[i]^2))]
#[contact(gap[i in 0..2]: x[i+1] - x[i] >= 0, restitution: e)]
struct Balls {
    m: [f64; 3],
    e: f64,
    gap: [Contact; 2],
}

impl Balls {
    /// Number of impacts, and velocities after them.
    fn after(m: [f64; 3], e: f64, v: [f64; 3]) -> (usize, [f64; 3]) {
        let balls = Self { m, e, gap: [Contact::Open; 2] };
        let path = balls.motion(State::new([0.0; 3], v)).with_contacts().to(0.1).unwrap();
        let is_impact = |of: &&Transition<f64>| matches!(of, Transition::Impact { .. });
        (path.transitions().iter().filter(is_impact).count(), path.end().v.into())
    }
}

/// A heavy ball drives a light one against another that moves away: the light one is hit in turn, thousands of times, until they
/// go on together.
#[test]
fn heavy_balls_catch_a_light_one() {
    for (e, m) in [(0.3, [1.0, 1e-2, 2.0]), (0.9, [1.0, 1e-3, 2.0])] {
        let (_, after) = Balls::after(m, e, [1.0, 0.0, 0.25]);
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
        let (impacts, after) = Balls::after(m, e, [1.0, 2.0, -1.0]);
        assert_eq!(impacts, count, "{light}, {e}");
        let off = after.iter().zip(v).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(off < 1e-8, "{light}, {e}: off by {off:e}");
    }
}

/// A mass between two walls with friction, pulled by a force.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + f[0]*x + f[1]*y)]
#[contact(wall[i in 0..2]: n[i][0]*x + n[i][1]*y >= 0, friction(mu[i]): n[i][1]*x_dot - n[i][0]*y_dot)]
struct Groove {
    f: [f64; 2],
    n: [[f64; 2]; 2],
    mu: [f64; 2],
    wall: [Contact; 2],
}

impl Groove {
    /// Whether forces of the walls balance the one that pulls: those at two edges of their cones of friction do, one of each wall.
    fn is_held(&self) -> bool {
        let edge = |wall: usize, side: f64| {
            let ([x, y], mu) = (self.n[wall], self.mu[wall]);
            [x + side * mu * y, y - side * mu * x]
        };
        let area = |[a, b]: [f64; 2], [c, d]: [f64; 2]| a * d - b * c;
        let sides = [-1.0, 1.0];
        sides.iter().any(|&first| {
            sides.iter().any(|&second| {
                let (one, other) = (edge(0, first), edge(1, second));
                let parts = [area(other, self.f), area(self.f, one)].map(|part| part / area(one, other));
                parts.iter().all(|&part| part > 1e-3)
            })
        })
    }
}

/// A mass at rest in a groove stays, held by forces that are not unique, where the walls lean by little from one another too. Where none
/// of those found can go on, the motion ends as undecided: 4 in 100 may.
#[test]
fn a_mass_in_a_groove_stays() {
    let angles = [0.0_f64, 1.0, 5.0, 20.0];
    let coefficients = [0.2, 0.5, 1.0];
    let (mut held, mut undecided) = (0, 0);
    for number in 0..4 * 4 * 3 * 3 * 4 {
        let digit = |place: usize, base: usize| number / place % base;
        let (lean, opening) = (angles[digit(1, 4)], angles[digit(4, 4)].max(0.01));
        let mu = [coefficients[digit(16, 3)], coefficients[digit(48, 3)]];
        let along = |degrees: f64| [degrees.to_radians().cos(), degrees.to_radians().sin()];
        let n = [along(lean + opening / 2.0), along(180.0 + lean - opening / 2.0)];
        let groove = Groove { f: along(-30.0 * digit(144, 4) as f64), n, mu, wall: [Contact::Open; 2] };
        if !groove.is_held() {
            continue;
        }
        let motion = groove.motion(State::at_rest([0.0; 2])).with_contacts();
        match motion.max_transitions(100).to(0.1) {
            Ok(path) => assert!(path.end().v.norm() < 1e-9, "{lean}, {opening}, {mu:?}"),
            Err(Error::FrictionUndecided { .. }) => undecided += 1,
            Err(error) => panic!("{lean}, {opening}, {mu:?}: {error}"),
        }
        held += 1;
    }
    assert!(held > 500 && 100 * undecided <= 4 * held, "{undecided} of {held} undecided");
}
