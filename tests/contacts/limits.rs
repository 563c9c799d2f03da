//! Friction at its limits: bodies that begin to slide, bounds that change, sliding that turns.

use lagrange_core::contact::{Contact, Friction, Transition};
use lagrange_core::prelude::*;
use lagrange_systems::{Belt, Block, Puck};

#[test]
fn friction_that_begins_at_its_limit_slips() {
    let pulled =
        |from, grows, c, falls| Belt { m: 1.0, from, grows, hold: c, pull: c, falls, ..Belt::default() };
    for (system, end, speed) in [
        // Without friction, from a force of zero.
        (pulled(0.0, 2.0, 0.0, 0.0), 2.0, 4.0),
        // The force is the limit and grows; the limit is the force and falls.
        (pulled(2.0, 1.0, 2.0, 0.0), 1.5, 1.125),
        (pulled(1.0, 0.0, 1.0, 0.25), 2.0, 0.5),
    ] {
        for by in 0..3 {
            let motion = system.motion(State::at_rest([0.0]));
            let path = match by {
                0 => motion.by(Dop853::with_tolerance(1e-12)).with_contacts().to(end).unwrap(),
                1 => motion.by(Taylor::default()).with_contacts().to(end).unwrap(),
                _ => motion.by(Radau::with_tolerance(1e-12)).with_contacts().to(end).unwrap(),
            };
            assert!((path.end().state().v[0] - speed).abs() < 1e-9, "{by}: {:?}", path.end());
        }
    }
}

#[test]
fn friction_that_would_push_is_named() {
    let system = Belt { m: 1.0, hold: 1.0, pull: 1.0, falls: 1.0, ..Belt::default() };
    let path = system.motion(State::new([0.0], [2.0])).with_contacts().towards(4.0).unwrap();
    let ending = path.ending().to_string();
    assert!(ending.contains("the friction of `belt`") && ending.contains("0 ≤ sliding ≤ limit"), "{ending}");
    assert!((path.ending().time() - 1.0).abs() < 0.5, "{}", path.ending());
}

/// On a plate that swings, x_p = A sin ωt, a block sticks as long as A ω² |sin ωt| < μ g, and once it slides, its acceleration is
/// ±μ g until the plate has its velocity again.
#[test]
fn a_block_on_a_plate_that_swings_sticks_and_slides() {
    let (g, mu, a, omega) = (10.0, 0.2, 0.05, 8.0_f64);
    let system = Block { m: 3.0, g, mu, a, omega, floor: Contact::Closed, ..Block::default() };
    let start = State::new([0.0; 2], [a * omega, 0.0]);
    let path = system.motion(start).by(Taylor::default()).with_contacts().to(1.0).unwrap();
    // A ω² = 3.2 > μ g = 2: it slips forwards, relative to the plate, while the plate slows down.
    let slips = (mu * g / (a * omega * omega)).asin() / omega;
    let Transition::Slips { time, .. } = path.transitions()[0] else { panic!("{:?}", path.transitions()) };
    assert!((time - slips).abs() < 1e-13, "{time} for {slips}");
    // It slows down by μ g, until its speed is that of the plate: by bisection.
    let relative =
        |t: f64| a * omega * (omega * slips).cos() - mu * g * (t - slips) - a * omega * (omega * t).cos();
    let (mut low, mut high) = (slips + 0.05, slips + 0.5);
    assert!(relative(low) > 0.0 && relative(high) < 0.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        *if relative(middle) > 0.0 { &mut low } else { &mut high } = middle;
    }
    let time = path.transitions()[1].time();
    assert!((time - low).abs() < 1e-12, "{time} for {low}");
}

fn puck(m: f64, g: f64, mu: f64) -> Puck {
    Puck { m, g, mu, floor: Contact::Closed, ..Puck::default() }
}

/// Place and velocity of a point of the mass 1 by implicit steps, v' = the projection of v + h F onto zero by h μ N.
fn by_hand(force: impl Fn(f64) -> [f64; 2], drag: f64, mut v: [f64; 2], end: f64) -> [[f64; 2]; 2] {
    let (steps, mut q) = (400_000, [0.0; 2]);
    let h = end / f64::from(steps);
    for step in 0..steps {
        let pull = force((f64::from(step) + 0.5) * h);
        let free = [v[0] + h * pull[0], v[1] + h * pull[1]];
        let kept = (1.0 - h * drag / f64::hypot(free[0], free[1])).max(0.0);
        for i in 0..2 {
            q[i] += h * (v[i] + kept * free[i]) / 2.0;
            v[i] = kept * free[i];
        }
    }
    [q, v]
}

#[test]
fn a_point_begins_to_slide_and_turns() {
    let puck = Puck { grows: [1.0, 0.0], push: [0.0, 1.0], ..puck(1.0, 10.0, 0.2) };
    let [_, expected] = by_hand(|t| [t, 1.0], 2.0, [0.0; 2], 4.0);
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        let motion = puck.motion(State::at_rest([0.0; 3])).by(Radau::with_tolerance(tolerance));
        let v = motion.with_contacts().to(4.0).unwrap().end().state().v;
        let error = (v[0] - expected[0]).hypot(v[1] - expected[1]);
        assert!(error < 3e-5 + 100.0 * tolerance, "{tolerance:e}: {v:?} for {expected:?}");
    }
}

#[test]
fn a_puck_begins_to_slide_along_a_load_that_turns() {
    for (b, c) in [(0.2, 1.0), (1.0, 0.2), (-0.4, -0.7)] {
        let [q, _] = by_hand(|t| [b * t + (3.0 * t).sin(), c * t], 0.5, [0.0; 2], 3.0);
        let puck = Puck { grows: [2.0 * b, 2.0 * c], swing: 2.0, omega: 3.0, ..puck(2.0, 1.0, 0.5) };
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let motion = puck.motion(State::at_rest([0.0; 3])).by(Radau::with_tolerance(tolerance));
            let found = motion.with_contacts().to(3.0).unwrap().end().state().q;
            let off = f64::hypot(found[0] - q[0], found[1] - q[1]);
            assert!(off < 1e-5, "({b}, {c}), {tolerance}: {found:?} for {q:?}");
        }
    }
}

#[test]
fn sliding_that_turns_goes_on() {
    for mu in [0.2, 0.0] {
        let puck = Puck { push: [3.0, 0.0], ..puck(1.0, 10.0, mu) };
        let [_, expected] = by_hand(|_| [3.0, 0.0], 10.0 * mu, [-1.0, 0.5], 2.0);
        for by in 0..3 {
            let motion = puck.motion(State::new([0.0; 3], [-1.0, 0.5, 0.0]));
            let path = match by {
                0 => motion.by(Dop853::with_tolerance(1e-12)).with_contacts().to(2.0),
                1 => motion.by(Taylor::default()).with_contacts().to(2.0),
                _ => motion.by(Radau::with_tolerance(1e-10)).with_contacts().to(2.0),
            };
            let v = path.unwrap_or_else(|error| panic!("{by}, {mu}: {error}")).end().state().v;
            let error = (v[0] - expected[0]).hypot(v[1] - expected[1]);
            assert!(error < 2e-5, "{by}, {mu}: {v:?} for {expected:?}");
        }
    }
}

/// A block at rest on a slope that is too steep slides straight down.
#[test]
fn a_block_at_rest_slides_down_a_steep_slope() {
    let (tilt, mu) = (0.5_f64, 0.3);
    let slope = Puck { tilt, down: [0.0, 1.0], ..puck(2.0, 10.0, mu) };
    let expected = 10.0 * (tilt.sin() - mu * tilt.cos()) * 3.0;
    for by_taylor in [true, false] {
        let motion = slope.motion(State::at_rest([0.0; 3]));
        let path = match by_taylor {
            false => motion.by(Dop853::with_tolerance(1e-12)).with_contacts().to(3.0).unwrap(),
            true => motion.by(Taylor::default()).with_contacts().to(3.0).unwrap(),
        };
        let v = path.end().state().v;
        assert!(v[0].abs() < 1e-12 && (v[1] - expected).abs() < 1e-11, "{v:?} {expected}");
    }
}

/// A block at rest on a table that tilts begins to slide where tan(ω t) = μ, with a force that grows slowly: its direction is
/// stiff, which `Radau` follows.
#[test]
fn a_block_on_a_table_that_tilts_begins_to_slide() {
    let (omega, mu) = (0.1, 0.5_f64);
    let table = Puck { tilting: omega, down: [0.6, 0.8], ..puck(2.0, 10.0, mu) };
    let motion = table.motion(State::at_rest([0.0; 3])).by(Radau::with_tolerance(1e-12));
    let path = motion.with_contacts().to(6.0).unwrap();
    let begins = mu.atan() / omega;
    let [Transition::Slips { time, .. }] = path.transitions() else { panic!("{:?}", path.transitions()) };
    assert!((time - begins).abs() < 1e-11, "{time} for {begins}");
    // v̇ = g (sin ωt − μ cos ωt).
    let speed = |t: f64| 10.0 / omega * (-(omega * t).cos() - mu * (omega * t).sin());
    let expected = speed(6.0) - speed(begins);
    let v = path.end().state().v;
    assert!((v[0] - 0.6 * expected).abs() < 1e-8 && (v[1] - 0.8 * expected).abs() < 1e-8, "{v:?} {expected}");
}

/// Dry friction along two velocities: of a force that turns, beside a body that swings.
#[derive(Clone, Default, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2)]
#[force(x: pull*(49/50*cos(3*t) + t/100))]
#[force(y: pull*49/50*sin(3*t))]
#[force(z: -pull*sin(t))]
#[friction(rub: [x_dot, y_dot], sliding: drag)]
struct Foot {
    pull: f64,
    drag: f64,
    rub: Friction,
}

#[test]
fn a_foot_slides_straight_and_stops() {
    let foot = Foot { drag: 1.0, ..Foot::default() };
    let to = |start, end| foot.motion(start).with_contacts().to(end).unwrap();
    let thrown = State::new([0.0; 3], [3.0, 4.0, 0.0]);
    let v = to(thrown, 2.0).end().state().v;
    assert!((v[0] - 1.8).abs() < 1e-12 && (v[1] - 2.4).abs() < 1e-12);
    let path = to(thrown, 6.0);
    assert!(matches!(path.transitions(), [Transition::Sticks { time, .. }] if (time - 5.0).abs() < 1e-11));
    assert_eq!(to(State::at_rest([0.0; 3]), 1.0).end().state().v, State::at_rest([0.0; 3]).v);
}

/// Its velocity is much smaller than the tolerance when it begins to slide. Stages guessed from the step before took 3,354 steps, with
/// those refused.
#[test]
fn a_block_near_its_limit_begins_to_slide_in_few_steps() {
    let foot = Foot { pull: 1.0, drag: 1.0, ..Foot::default() };
    let motion = foot.motion(State::new([0.0; 3], [0.0, 0.0, 1.0]));
    let path = motion.by(Radau::with_tolerance(1e-6)).with_contacts().to(30.0).unwrap();
    assert_eq!(path.transitions().len(), 27);
    let statistics = path.statistics();
    let steps = statistics.accepted + statistics.rejected;
    assert!(steps < 2_400, "{steps} steps");
}

/// A cart on four wheels, of which two on a diagonal carry it: all begin to slide at once, at μ m g, also those without a limit.
#[test]
fn four_wheels_begin_to_slide_at_once() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, z, a, b)]
    #[lagrangian((m*x_dot^2 + m*z_dot^2 + a_dot^2 + b_dot^2)/2 - m*g*z)]
    #[force(x: t)]
    #[define(along = [1, -1, -1, 1])]
    #[define(across = [1, 1, -1, -1])]
    #[contact(wheel[i in 0..4]: z + across[i]*a - along[i]*b >= 0, friction(mu): x_dot)]
    struct Cart {
        m: f64,
        g: f64,
        mu: f64,
        wheel: [Contact; 4],
    }
    let cart = Cart { m: 1.0, g: 10.0, mu: 0.2, wheel: [Contact::Closed; 4] };
    let path = cart.motion(State::at_rest([0.0; 4])).with_contacts().to(5.0).unwrap();
    let slips = path.transitions().iter().filter(|of| matches!(of, Transition::Slips { .. }));
    assert!(slips.clone().count() > 0 && slips.map(Transition::time).all(|time| (time - 2.0).abs() < 1e-11));
    // ẍ = t − μ g.
    assert!((path.end().state().q[0] - 4.5).abs() < 1e-11 && (path.end().state().v[0] - 4.5).abs() < 1e-11);
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
