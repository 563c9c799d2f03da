//! Motions that go on from where others ended, frame by frame.

use lagrange_core::contact::{Contact, ContactMotion, Transition};
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};
use lagrange_systems::Ball;

use crate::method;

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
        let (block, start) = thrown(seed);
        let method = Dop853::with_tolerance(1e-12);
        let whole = block.motion(start).by(method).with_contacts().to(1.0).unwrap();
        let mut motion = block.motion(start).by(method).with_contacts().begin().unwrap();
        let mut transitions = Vec::new();
        for frame in (1..=60).map(f64::from) {
            motion.advance_to(frame / 60.0).unwrap();
            transitions.extend_from_slice(motion.transitions());
        }
        // Bounces that rise by no more than 64 units of round-off count as rest, with velocities of the order of its root.
        assert!(off(motion.state(), whole.end().state()) < 1e-6, "seed {seed}: {motion:?}");
        let first = |transitions: &[Transition<f64>]| transitions[0].clone();
        let [one, other] = [first(&transitions), first(whole.transitions())].map(|change| change.time());
        assert!((one - other).abs() < 1e-9, "seed {seed}: {one} {other}");
    }
}

fn off(one: &State<f64, 3>, other: &State<f64, 3>) -> f64 {
    (one.q - other.q).amax().max((one.v - other.v).amax())
}

/// Inputs that change between advances are those of a controller with that interval.
#[test]
fn changes_are_those_of_a_controller() {
    for seed in 0..cases([3, 6, 300]) as u64 {
        let ((block, start), method) = (thrown(seed), Dop853::with_tolerance(1e-12));
        let pull = |t: f64| 12.0 * (7.0 * t).sin();
        let controlled =
            block.motion(start).by(method).with_contacts().controlled(1.0 / 64.0, |block, state| {
                block.pull = pull(state.t);
                Ok::<_, Error>(())
            });
        let controlled = controlled.to(1.5).unwrap();
        let mut motion = block.motion(start).by(method).with_contacts().begin().unwrap();
        for frame in 0..96 {
            motion.change(|block| block.pull = pull(f64::from(frame) / 64.0));
            motion.advance_to(f64::from(frame + 1) / 64.0).unwrap();
        }
        assert!(
            off(motion.state(), controlled.end().state()) < 1e-6,
            "seed {seed}: {motion:?} {controlled:?}"
        );
    }
}

/// A ball falls from 1 m and bounces with e = ½.
#[test]
fn a_motion_goes_on_from_events_and_after_faults() {
    let ball = Ball { m: 1.0, g: 9.81, e: 0.5, ..Ball::default() };
    let fall = (2.0_f64 / 9.81).sqrt();
    let mut motion = ball.motion(State::at_rest([0.0, 1.0])).by(method()).with_contacts().begin().unwrap();
    let mut half = ball.event("half", |sample| sample.state().q[1] - 0.5).falling().terminal();
    let mut down = ball.event("down", |sample| sample.state().q[1]).falling().terminal();
    let mut find = |motion: &mut ContactMotion<_, _>, end| {
        motion
            .advance_to_event(end, &mut [&mut half, &mut down])
            .unwrap()
            .map(|found| (found.event, found.state))
    };
    let (event, state) = find(&mut motion, 9.0).expect("it falls");
    assert!(event == "half" && (state.t - 1.0 / 9.81_f64.sqrt()).abs() < 1e-13, "{state:?}");
    // Before the impact, which follows.
    let (event, state) = find(&mut motion, 9.0).expect("it lands");
    assert!(event == "down" && (state.t - fall).abs() < 1e-13 && state.v[1] < -4.4, "{state:?}");
    assert!(motion.transitions().is_empty());
    assert_eq!(find(&mut motion, fall + 0.1), None);
    assert!(matches!(motion.transitions(), [Transition::Impact { time, .. }] if *time == state.t));
    let up = 0.5 * 9.81 * fall * 0.1 - 0.5 * 9.81 * 0.01;
    assert!((motion.state().q[1] - up).abs() < 1e-12, "{motion:?}");
    // Back in time, which forgets no change, and with the floor above the ball.
    let before = *motion.state();
    motion.change(|ball| ball.r = 5.0);
    let error = motion.advance_to(0.0).unwrap_err().to_string();
    assert!(error.contains("cannot go back") && motion.transitions().is_empty(), "{error}");
    assert_eq!(motion.system().r, 5.0);
    let error = motion.advance_to(1.0).unwrap_err().to_string();
    assert!(error.contains("`floor`") && *motion.state() == before, "{error}");
    motion.change(|ball| ball.r = 0.0);
    motion.advance_to(1.0).unwrap();
    // A parameter that is no number is named, and can be mended.
    motion.change(|ball| ball.r = f64::NAN);
    let error = motion.advance_by(0.1).unwrap_err().to_string();
    assert!(error.contains("`r`"), "{error}");
    motion.change(|ball| ball.r = 0.0);
    // Thrown anew, from the floor where it rests.
    motion.advance_to(9.0).unwrap();
    assert_eq!(motion.system().floor, Contact::Closed);
    motion.set_state(State { t: 0.0, ..State::new([0.0, 0.0], [0.0, 1.0]) }).unwrap();
    motion.advance_to(0.1).unwrap();
    assert_eq!(motion.system().floor, Contact::Open);
    assert!((motion.state().q[1] - (0.1 - 0.5 * 9.81 * 0.01)).abs() < 1e-13, "{motion:?}");
}

/// A ball on a table that swings up and down and throws it. Where it lands again is found however many advances end on its flight.
#[test]
fn a_contact_that_opened_at_rest_closes_in_a_later_advance() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(y)]
    #[lagrangian(y_dot^2/2 - g*y)]
    #[contact(table: y - a*sin(w*t) >= 0)]
    struct Swing {
        g: f64,
        a: f64,
        w: f64,
        table: Contact,
    }
    for part in [3.88, 2.5, 1.3] {
        let (g, w) = (10.0, 7.0);
        let swing = Swing { g, a: part * g / (w * w), w, table: Contact::Closed };
        let start = State::new([0.0], [swing.a * w]);
        let whole = swing.motion(start).by(method()).with_contacts().to(2.0).unwrap();
        let mut motion = swing.motion(start).by(method()).with_contacts().begin().unwrap();
        let mut transitions = Vec::new();
        for k in 1..=200 {
            motion.advance_to(0.01 * f64::from(k)).unwrap();
            transitions.extend_from_slice(motion.transitions());
            let State { t, q, .. } = motion.state();
            assert!(q[0] - swing.a * (w * t).sin() > -1e-14, "{part}: {motion:?}");
        }
        assert_eq!(transitions.len(), whole.transitions().len());
        for (one, other) in transitions.iter().zip(whole.transitions()) {
            assert!((one.time() - other.time()).abs() < 1e-9, "{part}: {one} {other}");
        }
    }
}
