//! Motions in steps of one length against motions from impact to impact, whose times are exact to round-off: the error falls with
//! the step, by its first power.

use lagrange_core::contact::{Contact, Contacts, Friction, MoreauJean};
use lagrange_core::{StateOf, prelude::*};

/// Least-squares slope of the logarithm of the deviation of coordinates, the largest of 50 times, over seven steps each half as
/// long as the one before; and the deviation of the last. It depends on the place of an impact within its step: each is
/// the mean over five lengths within a fifth of one another.
fn slope<L>(system: &L, start: StateOf<L>, end: f64, longest: f64) -> (f64, f64)
where
    L: Contacts<Scalar = f64> + Clone,
{
    let exact = system.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(end).unwrap();
    let exact: Vec<(f64, StateOf<L>)> =
        (1..=50).map(|k| end * f64::from(k) / 50.0).map(|t| (t, *exact.at(t).unwrap().state())).collect();
    let error = |h: f64| {
        let path = system.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(end).unwrap();
        exact.iter().fold(0.0, |most: f64, (t, state)| {
            let found = path.at(*t).unwrap().q;
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
    (sum(1) / sum(0), points[6][1].exp())
}

#[track_caller]
fn converges((slope, last): (f64, f64), bound: f64) {
    println!("slope {slope:.3}, error {last:.2e}");
    assert!(slope >= 0.9, "slope {slope}");
    assert!(last < bound, "error {last}");
}

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

#[test]
fn a_ball_bounces_to_rest() {
    let ball = Ball { m: 0.2, g: 9.81, e: 0.5, floor: Contact::Open };
    converges(slope(&ball, State::new([0.0, 0.3], [0.4, 0.0]), 1.5, 7e-3), 2e-3);
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*r^2/5 * phi_dot^2 - m*g*y)]
#[contact(floor: y - r >= 0, friction(mu): x_dot - r*phi_dot)]
struct Sphere {
    m: f64,
    g: f64,
    r: f64,
    mu: f64,
    floor: Contact,
}

#[test]
fn a_sphere_slides_and_then_rolls() {
    let sphere = Sphere { m: 0.4, g: 9.81, r: 0.3, mu: 0.25, floor: Contact::Closed };
    converges(slope(&sphere, State::new([0.0, 0.3, 0.0], [2.0, 0.0, 0.0]), 0.5, 7e-3), 1e-3);
}

/// A block on a belt, held by a spring, whose friction is less while it slides.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[friction(belt: x_dot - speed, limit: hold, sliding: pull)]
#[contact(wall: x + 5 >= 0)]
struct StickSlip {
    m: f64,
    k: f64,
    speed: f64,
    hold: f64,
    pull: f64,
    belt: Friction,
    wall: Contact,
}

#[test]
fn a_block_on_a_belt_sticks_and_slips() {
    let (belt, wall) = (Friction::Sticks, Contact::Open);
    let block = StickSlip { m: 1.0, k: 4.0, speed: 0.2, hold: 2.0, pull: 1.0, belt, wall };
    converges(slope(&block, State::new([0.0], [0.2]), 10.0, 3e-2), 1e-2);
}

/// A thin rod with two ends.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(tip(s) = [x + s*l/2*cos(theta), y + s*l/2*sin(theta)])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*l^2/24 * theta_dot^2 - m*g*y)]
#[contact(floor[k in 0..2]: tip(2*k - 1)[1] >= 0, restitution: e, friction(mu): der(tip(2*k - 1))[0])]
struct Rod {
    m: f64,
    l: f64,
    g: f64,
    e: f64,
    mu: f64,
    floor: [Contact; 2],
}

#[test]
fn a_rod_falls_on_a_rough_floor() {
    let rod = Rod { m: 1.5, l: 1.0, g: 9.81, e: 0.3, mu: 0.3, floor: [Contact::Open; 2] };
    converges(slope(&rod, State::new([0.0, 0.8, 0.7], [0.5, 0.0, -0.4]), 0.7, 5e-3), 2e-3);
}

/// A bead on a ring in the plane, which a wall stops.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[contact(wall: x + 0.2*l >= 0, restitution: e)]
struct Pendulum {
    m: f64,
    l: f64,
    g: f64,
    e: f64,
    wall: Contact,
}

#[test]
fn a_pendulum_hits_a_wall() {
    let pendulum = Pendulum { m: 1.5, l: 1.0, g: 9.81, e: 0.6, wall: Contact::Open };
    let start = State::at_rest([0.6, -0.8]);
    converges(slope(&pendulum, start, 2.0, 5e-3), 1e-2);
    let path = pendulum.motion(start).by_time_stepping(MoreauJean::with_step(5e-3)).to(2.0).unwrap();
    for step in path.steps() {
        let [x, y] = [step.state.q[0], step.state.q[1]];
        assert!((x.hypot(y) - 1.0).abs() < 1e-9 && x > -0.2 - 1e-9, "{step:?}");
    }
}

/// A puck that slides on a plate that turns, with friction of two velocities.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2 * dot(r_dot, r_dot) - m*g*r[2])]
#[contact(plate: r[2] >= 0, friction(mu): [r_dot[0] + omega*r[1], r_dot[1] - omega*r[0]])]
struct Puck {
    m: f64,
    g: f64,
    mu: f64,
    omega: f64,
    plate: Contact,
}

#[test]
fn a_puck_slides_on_a_turning_plate() {
    let puck = Puck { m: 0.3, g: 9.81, mu: 0.2, omega: 1.5, plate: Contact::Closed };
    converges(slope(&puck, State::new([0.4, 0.0, 0.0], [-0.5, 0.8, 0.0]), 1.0, 7e-3), 1e-3);
}

/// Two links from a pivot; the second hits a wall with its end, and rubs along it. The mass matrix depends on the angles.
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

#[test]
fn two_links_hit_a_wall() {
    let links = Links { g: 9.81, e: 0.4, mu: 0.2, wall: Contact::Open };
    converges(slope(&links, State::new([0.5, 0.9], [0.0, 0.5]), 1.5, 4e-3), 5e-3);
}

/// A ball on a table that shakes: the gap depends on the time.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(m/2 * y_dot^2 - m*g*y)]
#[contact(table: y - a*sin(omega*t) >= 0, restitution: e)]
struct Shaken {
    m: f64,
    g: f64,
    e: f64,
    a: f64,
    omega: f64,
    table: Contact,
}

#[test]
fn a_ball_bounces_on_a_table_that_shakes() {
    let ball = Shaken { m: 0.7, g: 9.81, e: 0.3, a: 0.02, omega: 30.0, table: Contact::Open };
    // The impact at 0.868 grazes, and small errors grow tenfold.
    converges(slope(&ball, State::at_rest([0.2]), 0.85, 2e-3), 1e-3);
}
