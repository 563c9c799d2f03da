//! Contacts without friction, against closed solutions; and what has no motion, by name.

use lagrange_core::contact::{Contact, Friction, Transition};
use lagrange_core::{Lagrangian, SolutionOf, prelude::*};
use lagrange_random::{Random, cases};
use lagrange_systems::{Ball, Slot, Stack};

use crate::impacts;

const BALL: Ball = Ball { m: 0.2, g: 9.81, r: 0.0, e: 0.8, thrust: 0.0, floor: Contact::Open };

#[test]
fn a_ball_bounces_and_rests() {
    for method in [1e-13, 1e-15].map(Taylor::with_tolerance) {
        let path =
            BALL.motion(State::new([0.0, 1.0], [0.5, 0.0])).by(method).with_contacts().to(10.0).unwrap();
        let fall = (2.0 / 9.81_f64).sqrt();
        let bounce = |n: i32| fall * (1.0 + 2.0 * 0.8 * (1.0 - 0.8_f64.powi(n)) / 0.2);
        for (n, time) in impacts(path.transitions()).into_iter().take(20).enumerate() {
            assert!((time - bounce(n as i32)).abs() < 1e-14, "{n}: {time} {}", bounce(n as i32));
        }
        let [.., Transition::Rests { contact: "floor", time }] = path.transitions() else {
            panic!("{:?}", path.transitions().last())
        };
        assert!((time - fall * 1.8 / 0.2).abs() < 1e-12, "{:e}", time - fall * 1.8 / 0.2);
        assert_eq!(
            (path.end().state().q[1], path.end().state().v[1], path.system().floor),
            (0.0, 0.0, Contact::Closed)
        );
        let floor = path.at(9.0).unwrap().multiplier("floor").unwrap();
        assert!((floor - 0.2 * 9.81).abs() < 1e-15);
    }
}

/// The heavy block comes with 100ⁿ times the mass of the light one: their collisions are the digits of π (Galperin,
/// *Regular and Chaotic Dynamics* 8, 2003). The level `full` adds the fifth digit, 20 s of an unoptimised test.
#[test]
fn collisions_count_the_digits_of_pi() {
    let digits = [(1.0, 3), (1e2, 31), (1e4, 314), (1e6, 3141), (1e8, 31415)];
    for (m, count) in digits.into_iter().take(cases([3, 4, 5])) {
        let blocks = Stack { m: [1.0, m, 1.0], e: [1.0; 3], ..Stack::default() };
        let start = State::new([1.0, 2.0, 1e6], [0.0, -1.0, 0.0]);
        let path = blocks.motion(start).by(Dop853::default()).with_contacts().to(1e3).unwrap();
        assert_eq!(impacts(path.transitions()).len(), count);
        let energy = blocks.energy(path.end().state()) / blocks.energy(&start) - 1.0;
        assert!(energy.abs() < 1e-13, "{energy:e}");
    }
}

#[test]
fn balls_in_a_row_exchange_their_velocities() {
    let balls = Stack { m: [1.0; 3], low: -2.0, e: [1.0; 3], ..Stack::default() };
    let start = State::new([-1.0, 0.0, 1e-6], [1.0, 0.0, 0.0]);
    let path = balls.motion(start).with_contacts().to(3.0).unwrap();
    assert_eq!(impacts(path.transitions()).len(), 2);
    assert!(
        (path.end().state().v - State::new([0.0; 3], [0.0, 0.0, 1.0]).v).amax() < 1e-12,
        "{}",
        path.end().state().v
    );
}

#[test]
fn a_restitution_that_is_none_is_named_with_its_contact() {
    for e in [-0.1, 1.5, f64::INFINITY] {
        let path =
            Ball { e, ..BALL }.motion(State::at_rest([0.0, 1.0])).with_contacts().towards(2.0).unwrap();
        let said = path.ending().to_string();
        let text = format!("the coefficient of restitution of `floor` is {e}: give it one from 0,");
        assert!(said.contains(&text), "{said}");
    }
}

#[test]
fn a_contact_stated_as_closed_above_its_floor_is_named() {
    let ball = Ball { floor: Contact::Closed, ..BALL };
    let said = |start| ball.motion(start).with_contacts().to(1.0).unwrap_err().to_string();
    let error = said(State::at_rest([0.0, 0.25]));
    let text = "contact `floor` is stated as closed, but its gap is 2.5e-1 at t = 0: set the field `floor` to `Contact::Open`";
    assert!(error.starts_with(text), "{error}");
    let error = said(State::new([0.0; 2], [0.0, 1.0]));
    assert!(error.contains("but its gap changes: its rate is 1e0 at t = 0: set the field"), "{error}");
}

#[test]
fn contacts_that_close_in_on_one_another_are_named() {
    for (e, start) in [(0.0, 0.0), (0.5, 0.3)] {
        let ball = Slot { g: 1.0, e: [e, 0.0], high: 1.0, speed: 1.0, ..Slot::default() };
        let path = ball.motion(State::at_rest([start])).with_contacts().towards(2.0).unwrap();
        let said = path.ending().to_string();
        assert!(said.contains("no forces keep the gaps of `floor`, `ceiling` open at t = "), "{said}");
        // What was computed so far is kept.
        assert!((path.ending().time() - 1.0).abs() < 1e-12 && path.at(0.5).unwrap().state().q[0] >= 0.0);
    }
}

#[test]
fn impacts_without_end_are_told() {
    let motion = |e| Slot { e: [e; 2], ..Slot::default() };
    let start = State::new([0.0], [1.0]);
    let error = motion(1.0).motion(start).with_contacts().to(1.0).unwrap_err().to_string();
    assert!(error.starts_with("impacts follow one another without end at t = 0"), "{error}");
}

/// Impacts follow one another at one time until the rate is its round-off, which is then taken.
#[test]
fn a_ball_in_a_slot_without_room_comes_to_rest() {
    for (e, high) in [(0.0, 0.0), (0.3, 0.0), (0.5, 0.0), (0.5, 1e-17), (0.9, 0.0)] {
        for v in [1.0, -7.7] {
            let slot = Slot { e: [e; 2], high, ..Slot::default() };
            let path = slot.motion(State::new([0.0], [v])).with_contacts().to(1.0).unwrap();
            assert!(
                path.end().state().q[0].abs() <= high && path.end().state().v[0] == 0.0,
                "{e}, {v}: {}",
                path.end()
            );
        }
    }
}

#[cfg(feature = "thorough")]
#[test]
fn a_gap_without_a_gradient_is_named() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(y)]
    #[lagrangian(m/2 * y_dot^2 - m*g*y)]
    #[contact(floor: y^3 >= 0)]
    struct Cubed {
        m: f64,
        g: f64,
        floor: Contact,
    }
    let cubed = Cubed { m: 1.0, g: 9.81, floor: Contact::Open };
    let path = cubed.motion(State::at_rest([1.0])).with_contacts().towards(2.0).unwrap();
    let lagrange_core::Ending::Unsolved { error, time } = path.ending() else { panic!("{}", path.ending()) };
    assert!(matches!(error, Error::NoGradient { constraint: Row::Constraint("floor"), .. }), "{error}");
    assert!((time - (2.0_f64 / 9.81).sqrt()).abs() < 1e-9, "{time}");
    assert!(path.end().state().q[0].abs() < 1e-9);
}

#[test]
fn ends_that_are_none() {
    let to = |end| BALL.motion(State::at_rest([0.0, 1.0])).with_contacts().to(end);
    for end in [f64::NAN, f64::INFINITY] {
        assert!(matches!(to(end), Err(Error::EndNotFinite { .. })));
    }
    assert!(matches!(to(-1.0), Err(Error::MotionBackwards { .. })));
    // No time passes, and nothing happens.
    let path = to(0.0).unwrap();
    assert!(path.transitions().is_empty() && path.end().state().q[1] == 1.0);
    assert_eq!((path.at(0.0).unwrap().state(), path.steps().count()), (path.end().state(), 1));
    assert_eq!(path.csv(3).records().rows.len(), 3);
}

/// What a pointer does not forward would have the default: no contacts, and all constraints on.
#[test]
fn systems_behind_pointers_have_their_contacts() {
    fn of<L: Lagrangian<Scalar = f64>>(system: &L) -> (bool, f64) {
        (L::HAS_CONTACTS, system.compliance()[0])
    }
    assert_eq!([of(&BALL), of(&&BALL), of(&Box::new(BALL))], [(true, 1.0); 3]);
}

/// A rope without mass carries a bob over a floor: its length s has no mass of its own, and a constraint that moves it.
#[derive(Clone, Lagrangian)]
#[coordinates(y, s)]
#[lagrangian(m/2 * y_dot^2 - m*g*y)]
#[constraint(rope: y + s = l)]
#[contact(floor: y >= 0, restitution: e)]
struct Hoist {
    m: f64,
    g: f64,
    l: f64,
    e: f64,
    floor: Contact,
}

#[test]
fn a_coordinate_without_mass_meets_the_floor() {
    let hoist = Hoist { m: 2.0, g: 9.81, l: 3.0, e: 0.5, floor: Contact::Open };
    let path = hoist.motion(State::at_rest([1.0, 2.0])).with_contacts().to(0.6).unwrap();
    let fall = (2.0 / 9.81_f64).sqrt();
    assert!((impacts(path.transitions())[0] - fall).abs() < 1e-14);
    let since = 0.6 - fall;
    let height = 0.5 * (2.0 * 9.81_f64).sqrt() * since - 9.81 / 2.0 * since * since;
    assert!(
        (path.end().state().q[0] - height).abs() < 1e-13
            && (path.end().state().q[1] - 3.0 + height).abs() < 1e-13
    );
}

/// While all contacts are open, accelerations are those of the system without them; dry friction and a rod act all the same.
#[test]
fn in_flight_a_system_is_that_without_contacts() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, theta)]
    #[lagrangian(m/2*(x_dot^2 + y_dot^2) + j*theta_dot^2*(2 + sin(theta))/2 - m*g*y + k*x*sin(theta))]
    #[constraint(rod: x^2 + y^2 = 1)]
    #[friction(belt: theta_dot - 2, sliding: hold)]
    struct Free {
        m: f64,
        j: f64,
        g: f64,
        k: f64,
        hold: f64,
        belt: Friction,
    }
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, theta)]
    #[lagrangian(m/2*(x_dot^2 + y_dot^2) + j*theta_dot^2*(2 + sin(theta))/2 - m*g*y + k*x*sin(theta))]
    #[constraint(rod: x^2 + y^2 = 1)]
    #[friction(belt: theta_dot - 2, sliding: hold)]
    #[contact(floor: y + 2 + cos(theta)/4 >= 0, friction(mu): x_dot + theta_dot)]
    #[contact(wall[i in 0..2]: 2 + x - theta*i >= 0, friction(mu): [y_dot, theta_dot])]
    struct Bounded {
        m: f64,
        j: f64,
        g: f64,
        k: f64,
        mu: f64,
        hold: f64,
        belt: Friction,
        floor: Contact,
        wall: [Contact; 2],
    }
    let mut random = Random(1);
    for belt in [Friction::Sticks, Friction::Slides([1.0, 0.0]), Friction::Slides([-1.0, 0.0])] {
        let [m, j, g, k, hold, mu] = [(); 6].map(|()| random.between(0.5, 2.0));
        let free = Free { m, j, g, k, hold, belt };
        let (floor, wall) = (Contact::Open, [Contact::Open; 2]);
        let bounded = Bounded { m, j, g, k, mu, hold, belt, floor, wall };
        let turn = random.between(0.0, 6.0);
        let q = [turn.cos(), turn.sin(), random.between(-3.0, 3.0)];
        let speed = random.between(-1.0, 1.0);
        let state =
            State::new(q, [-speed * q[1], speed * q[0], if belt == Friction::Sticks { 2.0 } else { 0.3 }]);
        let (expected, found) = (free.solve(&state).unwrap(), bounded.solve(&state).unwrap());
        let ours = found.multipliers.fixed_rows::<2>(0);
        assert!(
            found.multipliers.iter().skip(2).all(|force| *force == 0.0) && found.multipliers_are_unique()
        );
        let off = (expected.accelerations - found.accelerations).amax();
        assert!(off < 1e-13 * expected.accelerations.amax().max(1.0), "{belt:?}: {off:e}");
        assert!((expected.multipliers - ours).amax() < 1e-13 * (1.0 + expected.multipliers.amax()));
        // One that is closed is not forgotten.
        let closed = Bounded { floor: Contact::Slides([1.0, 0.0]), ..bounded };
        let is_same =
            |closed: SolutionOf<Bounded>| (closed.accelerations - expected.accelerations).amax() < 1e-3;
        assert!(!closed.solve(&state).is_ok_and(is_same));
    }
}
