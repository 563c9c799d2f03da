//! Friction at its limits: forces that begin there, bounds that change, sliding that turns.

use lagrange_core::contact::{Contact, Friction, Transition};
use lagrange_core::prelude::*;

/// A block that a force pulls, which grows from `from` by `grows` in each second, with friction of a coefficient that may be
/// zero, or may change.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[force(x: from + grows*t)]
#[friction(belt: x_dot, sliding: c*(1 - falls*t))]
struct Pulled {
    m: f64,
    from: f64,
    grows: f64,
    c: f64,
    falls: f64,
    belt: Friction,
}

#[test]
fn friction_that_begins_at_its_limit_slips() {
    let system = |from, grows, c, falls| Pulled { m: 1.0, from, grows, c, falls, belt: Friction::Sticks };
    for (system, end, speed) in [
        // Without friction, from a force of zero.
        (system(0.0, 2.0, 0.0, 0.0), 2.0, 4.0),
        // The force is the limit and grows; the limit is the force and falls.
        (system(2.0, 1.0, 2.0, 0.0), 1.5, 1.125),
        (system(1.0, 0.0, 1.0, 0.25), 2.0, 0.5),
    ] {
        let start = State::at_rest([0.0]);
        for by in 0..3 {
            let motion = system.motion(start);
            let path = match by {
                0 => motion.by(Dop853::with_tolerance(1e-12)).with_contacts().to(end).unwrap(),
                1 => motion.by(Taylor::default()).with_contacts().to(end).unwrap(),
                _ => motion.by(Radau::with_tolerance(1e-12)).with_contacts().to(end).unwrap(),
            };
            assert!((path.end().v[0] - speed).abs() < 1e-9, "{by}: {:?}", path.end());
        }
    }
}

#[test]
fn friction_that_would_push_is_named() {
    let system = Pulled { m: 1.0, from: 0.0, grows: 0.0, c: 1.0, falls: 1.0, belt: Friction::Sticks };
    let path = system.motion(State::new([0.0], [2.0])).with_contacts().towards(4.0).unwrap();
    assert!(path.ending().to_string().contains("the sliding force -"), "{}", path.ending());
    assert!((path.ending().time() - 1.0).abs() < 0.5, "{}", path.ending());
}

/// A point on a table, pulled with a force (f t + p, q).
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2*x_dot^2 + k*m/2*y_dot^2 + m/2*z_dot^2 - weight*z)]
#[force(x: p + f*t)]
#[force(y: q)]
#[contact(table: z >= 0, friction(mu): [x_dot, y_dot])]
struct Puck {
    m: f64,
    k: f64,
    weight: f64,
    p: f64,
    f: f64,
    q: f64,
    mu: f64,
    table: Contact,
}

const PUCK: Puck =
    Puck { m: 1.0, k: 1.0, weight: 10.0, p: 0.0, f: 1.0, q: 1.0, mu: 0.2, table: Contact::Closed };

/// Implicit steps, each with the friction of its end: v⁺ = (v + h F/m)·(1 − h μ N/(m |v + h F/m|)) for equal masses.
fn by_hand(puck: &Puck, mut v: [f64; 2], start: f64, end: f64, steps: usize) -> [f64; 2] {
    let h = (end - start) / steps as f64;
    for k in 0..steps {
        let t = start + (k as f64 + 1.0) * h;
        let free = [v[0] + h * (puck.p + puck.f * t) / puck.m, v[1] + h * puck.q / puck.m];
        let speed = free[0].hypot(free[1]);
        let left = (1.0 - h * puck.mu * puck.weight / puck.m / speed).max(0.0);
        v = free.map(|v| left * v);
    }
    v
}

#[test]
fn a_point_begins_to_slide_and_turns() {
    let expected = by_hand(&PUCK, [0.0; 2], 0.0, 4.0, 400_000);
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        let motion = PUCK.motion(State::at_rest([0.0; 3])).by(Radau::with_tolerance(tolerance));
        let v = motion.with_contacts().to(4.0).unwrap().end().v;
        let error = (v[0] - expected[0]).hypot(v[1] - expected[1]);
        println!("{tolerance:e}: {v:?} for {expected:?}");
        assert!(error < 3e-5 + 100.0 * tolerance, "{tolerance:e}: {v:?} for {expected:?}");
    }
}

#[test]
fn sliding_that_turns_goes_on() {
    for mu in [0.2, 0.0] {
        let puck = Puck { f: 0.0, p: 3.0, q: 0.0, mu, ..PUCK };
        let expected = by_hand(&puck, [-1.0, 0.5], 0.0, 2.0, 400_000);
        for by in 0..3 {
            let motion = puck.motion(State::new([0.0; 3], [-1.0, 0.5, 0.0]));
            let path = match by {
                0 => motion.by(Dop853::with_tolerance(1e-12)).with_contacts().to(2.0),
                1 => motion.by(Taylor::default()).with_contacts().to(2.0),
                _ => motion.by(Radau::with_tolerance(1e-10)).with_contacts().to(2.0),
            };
            let v = path.unwrap_or_else(|error| panic!("{by}, {mu}: {error}")).end().v;
            let error = (v[0] - expected[0]).hypot(v[1] - expected[1]);
            assert!(error < 2e-5, "{by}, {mu}: {v:?} for {expected:?}");
        }
    }
}

/// Dry friction along two velocities.
#[test]
fn a_foot_slides_straight_and_stops() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
    #[friction(foot: [x_dot, y_dot], sliding: s)]
    struct Foot {
        m: f64,
        s: f64,
        foot: Friction,
    }
    let foot = Foot { m: 1.0, s: 1.0, foot: Friction::Sticks };
    let path = foot.motion(State::new([0.0; 2], [3.0, 4.0])).with_contacts().to(2.0).unwrap();
    assert!((path.end().v[0] - 1.8).abs() < 1e-12 && (path.end().v[1] - 2.4).abs() < 1e-12);
    let path = foot.motion(State::new([0.0; 2], [3.0, 4.0])).with_contacts().to(6.0).unwrap();
    assert!(matches!(path.transitions(), [Transition::Sticks { time, .. }] if (time - 5.0).abs() < 1e-11));
    assert!(foot.motion(State::at_rest([0.0; 2])).with_contacts().to(1.0).is_ok());
}

/// A block that rests on a wedge, in coordinates along and across its face, of which the second has no size.
#[test]
fn a_block_rests_on_a_wedge_that_is_shaken() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, s, n)]
    #[define(place = [x + s*cos(al) - n*sin(al), -s*sin(al) - n*cos(al)])]
    #[lagrangian(wedge/2 * x_dot^2 + block/2 * dot(der(place), der(place)) + block*g*place[1])]
    #[force(x: pull*sin(3*t))]
    #[contact(face: n >= 0, friction(mu): s_dot)]
    struct Wedge {
        wedge: f64,
        block: f64,
        g: f64,
        al: f64,
        mu: f64,
        pull: f64,
        face: Contact,
    }
    for (al, mu, pull) in [(0.4, 0.3, 60.0), (0.2, 0.5, 20.0), (0.6, 0.7, 5.0)] {
        let wedge = Wedge { wedge: 3.0, block: 1.0, g: 9.81, al, mu, pull, face: Contact::Closed };
        let path = wedge.motion(State::at_rest([0.0; 3])).with_contacts().towards(2.0).unwrap();
        assert!(path.ending().to_string().contains("reached the end"), "{al}: {}", path.ending());
        assert!(path.transitions().len() < 100, "{:?}", path.transitions().len());
    }
}

/// A leg with a foot; hip at (x, y), thigh, shank and foot by their angles, and springs in the joints.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, a, b, c)]
#[define(knee = [x + l*sin(a), y - l*cos(a)])]
#[define(ankle = knee + [l*sin(b), -l*cos(b)])]
#[define(heel = ankle + [-back*cos(c) + up*sin(c), -back*sin(c) - up*cos(c)])]
#[define(toe = ankle + [front*cos(c) + up*sin(c), front*sin(c) - up*cos(c)])]
#[define(thigh = [x + l/2*sin(a), y - l/2*cos(a)])]
#[define(shank = knee + [l/2*sin(b), -l/2*cos(b)])]
#[define(sole = (heel + toe)/2)]
#[define(moving = 5*(x_dot^2 + y_dot^2) + 1.5*dot(der(thigh), der(thigh)) + dot(der(shank), der(shank)))]
#[define(turning = 0.02*a_dot^2 + 0.0133*b_dot^2 + 0.4*dot(der(sole), der(sole)) + 0.005*c_dot^2)]
#[define(weight = g*(10*y + 3*thigh[1] + 2*shank[1] + 0.8*sole[1]))]
#[define(springs = k/2*((a - b - 0.6)^2 + (c - b - 0.3)^2 + (a - 0.3)^2))]
#[lagrangian(moving + turning - weight - springs)]
#[dissipation(d/2*((a_dot - b_dot)^2 + (c_dot - b_dot)^2 + a_dot^2))]
#[contact(heel_floor: heel[1] >= 0, friction(mu): der(heel)[0])]
#[contact(toe_floor: toe[1] >= 0, friction(mu): der(toe)[0])]
struct Leg {
    l: f64,
    back: f64,
    front: f64,
    up: f64,
    g: f64,
    k: f64,
    d: f64,
    mu: f64,
    heel_floor: Contact,
    toe_floor: Contact,
}

/// Heel and toe of a foot that lies on the floor have one velocity, and stop at one time.
#[test]
fn heel_and_toe_stop_together() {
    for mu in [0.02, 0.035, 0.05, 0.065, 0.08] {
        let (heel_floor, toe_floor) = (Contact::Open, Contact::Open);
        let (l, back, front, up) = (0.4, 0.06, 0.16, 0.06);
        let leg = Leg { l, back, front, up, g: 9.81, k: 200.0, d: 8.0, mu, heel_floor, toe_floor };
        let start = State::new([0.0, 1.0, 0.3, -0.3, 0.1], [0.2, 0.0, 0.0, 0.0, 0.0]);
        let path = leg.motion(start).with_contacts().towards(1.5).unwrap();
        assert!(!path.ending().is_failure(), "mu = {mu}: {}", path.ending());
        let mut energy = f64::INFINITY;
        for step in path.legs().iter().flat_map(|leg| leg.steps()) {
            let now = leg.energy(step.state());
            assert!(now < energy + 1e-8 * energy.abs().min(1e3), "mu = {mu}: gains {:e}", now - energy);
            energy = energy.min(now);
        }
    }
}
