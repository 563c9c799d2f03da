//! Contacts without friction, against closed solutions.

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;
use lagrange_random::cases;

/// A ball over a floor.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[contact(floor: y >= 0, restitution: e)]
struct Ball {
    m: f64,
    g: f64,
    e: f64,
    floor: Contact,
}

fn impacts<T: Copy>(transitions: &[Transition<T>]) -> impl Iterator<Item = T> {
    transitions.iter().filter_map(|transition| match transition {
        Transition::Impact { time, .. } => Some(*time),
        _ => None,
    })
}

#[test]
fn a_ball_bounces_and_rests() {
    let ball = Ball { m: 0.2, g: 9.81, e: 0.8, floor: Contact::Open };
    for method in [1e-13, 1e-15].map(Taylor::with_tolerance) {
        let path =
            ball.motion(State::new([0.0, 1.0], [0.5, 0.0])).by(method).with_contacts().to(10.0).unwrap();
        let fall = (2.0 / 9.81_f64).sqrt();
        let bounce = |n: i32| fall * (1.0 + 2.0 * 0.8 * (1.0 - 0.8_f64.powi(n)) / 0.2);
        for (n, time) in impacts(path.transitions()).take(20).enumerate() {
            assert!((time - bounce(n as i32)).abs() < 1e-14, "{n}: {time} {}", bounce(n as i32));
        }
        let [.., Transition::Rests { contact: "floor", time }] = path.transitions() else {
            panic!("{:?}", path.transitions().last())
        };
        assert!((time - fall * 1.8 / 0.2).abs() < 1e-12, "{:e}", time - fall * 1.8 / 0.2);
        assert_eq!((path.end().q[1], path.end().v[1], path.system().floor), (0.0, 0.0, Contact::Closed));
        let floor = path.at(9.0).unwrap().multiplier("floor").unwrap();
        assert!((floor - 0.2 * 9.81).abs() < 1e-15);
    }
}

/// Two blocks and a wall, without any force.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(light/2 * x_dot^2 + heavy/2 * y_dot^2)]
#[contact(wall: x >= 0, restitution: 1)]
#[contact(blocks: y - x >= 0, restitution: 1)]
struct Blocks {
    light: f64,
    heavy: f64,
    wall: Contact,
    blocks: Contact,
}

/// The heavy block comes with 100ⁿ times the mass of the light one: their collisions are the digits of π (Galperin,
/// *Regular and Chaotic Dynamics* 8, 2003). The level `full` adds the fifth digit, 20 s of an unoptimised test.
#[test]
fn collisions_count_the_digits_of_pi() {
    let digits = [(1.0, 3), (1e2, 31), (1e4, 314), (1e6, 3141), (1e8, 31415)];
    let known = cases([3, 4, 5]);
    for (heavy, count) in digits.into_iter().take(known) {
        let blocks = Blocks { light: 1.0, heavy, wall: Contact::Open, blocks: Contact::Open };
        let start = State::new([1.0, 2.0], [0.0, -1.0]);
        let path = blocks.motion(start).by(Taylor::default()).with_contacts().to(1e3).unwrap();
        assert_eq!(impacts(path.transitions()).count(), count);
        let energy = blocks.energy(path.end()) / blocks.energy(&start) - 1.0;
        assert!(energy.abs() < 1e-13, "{energy:e}");
    }
}

/// Five balls in a row, with small gaps.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [5])]
#[lagrangian(dot(x_dot, x_dot)/2)]
#[contact(balls[i in 0..4]: x[i + 1] - x[i] >= 0, restitution: 1)]
struct Cradle {
    balls: [Contact; 4],
}

#[test]
fn balls_in_a_row_exchange_their_velocities() {
    let cradle = Cradle { balls: [Contact::Open; 4] };
    let start = State::new([-1.0, 0.0, 1e-6, 2e-6, 3e-6], [1.0, 0.0, 0.0, 0.0, 0.0]);
    let path = cradle.motion(start).with_contacts().to(3.0).unwrap();
    assert_eq!(impacts(path.transitions()).count(), 4);
    for (v, expected) in path.end().v.iter().zip([0.0, 0.0, 0.0, 0.0, 1.0]) {
        assert!((v - expected).abs() < 1e-12, "{}", path.end().v);
    }
}

/// A bead that slides off a sphere.
#[derive(Clone, Lagrangian)]
#[coordinates(r, theta)]
#[lagrangian(m/2 * (r_dot^2 + r^2 * theta_dot^2) - m*g*r*cos(theta))]
#[contact(sphere: r - a >= 0)]
struct Bead {
    m: f64,
    g: f64,
    a: f64,
    sphere: Contact,
}

#[test]
fn a_bead_leaves_its_sphere_where_it_would_pull() {
    let bead = Bead { m: 1.0, g: 9.81, a: 1.0, sphere: Contact::Closed };
    let start = State::new([1.0, 0.0], [0.0, 0.1]);
    let path = bead.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(1.5).unwrap();
    let [Transition::Opens { contact: "sphere", time }] = path.transitions() else {
        panic!("{:?}", path.transitions())
    };
    let angle = path.at(*time).unwrap().coordinate("theta").unwrap();
    assert!((angle.cos() - (2.0 + 0.01 / 9.81) / 3.0).abs() < 1e-11);
}

/// A ball on a floor with any restitution.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - y)]
#[contact(floor: y >= 0, restitution: e)]
struct Dropped {
    e: f64,
    floor: Contact,
}

#[test]
fn a_restitution_that_is_none_is_named_with_its_contact() {
    for e in [-0.1, 1.5, f64::INFINITY] {
        let ball = Dropped { e, floor: Contact::Open };
        let path = ball.motion(State::at_rest([1.0])).with_contacts().towards(2.0).unwrap();
        let said = path.ending().to_string();
        let text = format!("the coefficient of restitution of `floor` is {e}: give it one from 0,");
        assert!(said.contains(&text), "{said}");
    }
}

#[test]
fn a_contact_stated_as_closed_above_its_floor_is_named() {
    let ball = Dropped { e: 0.5, floor: Contact::Closed };
    let error = ball.motion(State::at_rest([0.25])).with_contacts().to(1.0).unwrap_err().to_string();
    let text = "contact `floor` is stated as closed, but its gap is 2.5e-1 at t = 0: set the field `floor` to `Contact::Open`";
    assert!(error.starts_with(text), "{error}");
    let error = ball.motion(State::new([0.0], [1.0])).with_contacts().to(1.0).unwrap_err().to_string();
    assert!(error.contains("but its gap changes: its rate is 1e0 at t = 0: set the field"), "{error}");
}

/// A ball between a floor and a press that comes down.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - y)]
#[contact(floor: y >= 0, restitution: e)]
#[contact(press: 1 - t - y >= 0)]
struct Pressed {
    e: f64,
    floor: Contact,
    press: Contact,
}

#[test]
fn contacts_that_close_in_on_one_another_are_named() {
    for (e, start) in [(0.0, 0.0), (0.5, 0.3)] {
        let ball = Pressed { e, floor: Contact::Open, press: Contact::Open };
        let path = ball.motion(State::at_rest([start])).with_contacts().towards(2.0).unwrap();
        let said = path.ending().to_string();
        assert!(said.contains("no forces keep the gaps of `floor`, `press` open at t = "), "{said}");
        // What was computed so far is kept.
        assert!((path.ending().time() - 1.0).abs() < 1e-12 && path.at(0.5).unwrap().state().q[0] >= 0.0);
    }
}

/// A ball in a slot as wide as itself.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2)]
#[contact(floor: y >= 0, restitution: e)]
#[contact(ceiling: -y >= 0, restitution: e)]
struct Slot {
    e: f64,
    floor: Contact,
    ceiling: Contact,
}

#[test]
fn impacts_without_end_are_told() {
    let motion = |e| Slot { e, floor: Contact::Open, ceiling: Contact::Open };
    let start = State::new([0.0], [1.0]);
    let error = motion(1.0).motion(start).with_contacts().to(1.0).unwrap_err().to_string();
    assert!(error.starts_with("impacts follow one another without end at t = 0"), "{error}");
    let path = motion(0.0).motion(start).with_contacts().to(1.0).unwrap();
    assert_eq!(path.end().v[0], 0.0);
}
