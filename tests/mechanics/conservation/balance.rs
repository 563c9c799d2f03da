//! The rate of an energy that changes: against differences of the energy along the motion, and against its work.

use lagrange_core::StateOf;
use lagrange_core::contact::{Contact, Friction};
use lagrange_core::prelude::*;

/// A pendulum whose support is shaken by its length, damped, and driven.
#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2*theta_dot^2 + m*(g + a*omega^2*cos(omega*t))*l*cos(theta))]
#[dissipation(c/2*theta_dot^2)]
#[force(theta: torque*sin(3*t))]
pub(super) struct Driven {
    m: f64,
    l: f64,
    g: f64,
    a: f64,
    omega: f64,
    c: f64,
    torque: f64,
}

/// A bob on a rod, whose pivot moves up and down.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: (x^2 + (y - a*sin(omega*t))^2 - l^2)/2 = 0)]
struct Shaken {
    m: f64,
    g: f64,
    l: f64,
    a: f64,
    omega: f64,
}

/// A ball that rolls on a turntable, which does work on it: Milton (8.4).
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, a: [3])]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*r^2/5*dot(a_dot, a_dot))]
#[constraint(along_x: x_dot - r*a_dot[1] = -w*y)]
#[constraint(along_y: y_dot + r*a_dot[0] = w*x)]
struct Turntable {
    m: f64,
    r: f64,
    w: f64,
}

/// A block on a belt, on a spring; the belt drags it along or slides beneath it.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*x^2)]
#[friction(belt: x_dot - speed, limit: hold, sliding: pull)]
pub(super) struct Block {
    pub(super) m: f64,
    pub(super) k: f64,
    pub(super) speed: f64,
    pub(super) hold: f64,
    pub(super) pull: f64,
    pub(super) belt: Friction,
}

/// A block thrown along a floor: sliding friction is a multiple of the floor's multiplier.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[contact(floor: y >= 0, friction(mu): x_dot)]
pub(super) struct Thrown {
    pub(super) m: f64,
    pub(super) g: f64,
    pub(super) mu: f64,
    pub(super) floor: Contact,
}

/// Compares the rate with the difference of the energies shortly before and after, which the accelerations lead to.
#[track_caller]
pub(super) fn check_rate<L: Lagrangian<Scalar = f64>>(system: &L, guess: impl Into<StateOf<L>>, most: f64) {
    let (state, _) = system.make_consistent(&guess.into()).expect("a consistent state");
    let solution = system.solve(&state).expect("a solution");
    let energy = |h: f64| {
        let mut beside = state;
        beside.t += h;
        for (i, acceleration) in solution.accelerations.iter().enumerate() {
            beside.q[i] += (state.v[i] + acceleration * h / 2.0) * h;
            beside.v[i] += acceleration * h;
        }
        system.energy(&beside)
    };
    let h = 1e-4;
    let rate = system.energy_rate(&state, &solution.multipliers);
    let expected = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
    assert!((rate - expected).abs() <= most, "{rate} is not {expected}");
    assert!(rate.abs() > 0.01, "nothing to see: {rate}");
}

pub(super) fn driven() -> Driven {
    Driven { m: 1.2, l: 0.7, g: 9.81, a: 0.1, omega: 5.0, c: 0.3, torque: 0.4 }
}

fn shaken() -> Shaken {
    Shaken { m: 1.2, g: 9.81, l: 0.7, a: 0.1, omega: 5.0 }
}

fn turntable() -> Turntable {
    Turntable { m: 0.5, r: 0.2, w: 2.0 }
}

#[test]
fn the_rate_is_that_of_the_energy() {
    check_rate(&driven(), State::new([0.8], [1.3]).at_time(0.4), 1e-9);
    check_rate(&shaken(), State::new([0.4, -0.5], [0.3, 0.1]).at_time(0.4), 1e-8);
    check_rate(&turntable(), State::new([0.4, -0.5, 0.0, 0.0, 0.0], [0.3, 0.1, 0.2, -0.4, 1.0]), 1e-9);
    let block = |belt| Block { m: 1.1, k: 4.0, speed: 0.2, hold: 9.0, pull: 1.0, belt };
    check_rate(&block(Friction::Sticks), State::new([0.3], [0.2]), 1e-9);
    check_rate(&block(Friction::Slides([1.0, 0.0])), State::new([0.3], [0.5]), 1e-9);
    check_rate(&block(Friction::Slides([-1.0, 0.0])), State::new([0.3], [-0.5]), 1e-9);
    let thrown = Thrown { m: 2.0, g: 10.0, mu: 0.3, floor: Contact::Closed };
    let sliding = Thrown { floor: Contact::Slides([1.0, 0.0]), ..thrown };
    check_rate(&sliding, State::new([0.0, 0.0], [2.0, 0.0]), 1e-8);
}

/// The energy changes a lot, and the balance does not.
#[track_caller]
fn check_balance<L: Lagrangian<Scalar = f64>>(system: &L, start: impl Into<StateOf<L>>) {
    let (start, _) = system.make_consistent(&start.into()).expect("a consistent state");
    let path = system.integrate(start, 5.0, Dop853::with_tolerance(1e-12)).expect("a motion");
    let energies = path.steps().map(|step| step.energy());
    let change = energies.map(|energy| (energy - system.energy(&start)).abs()).fold(0.0, f64::max);
    let drift = path.drift();
    let balance = drift.get("energy - work").expect("a balance");
    assert!(balance.largest < 1e-9 && change > 0.05, "{drift}, a change of {change}");
    assert_eq!(balance.start, path.start().energy());
}

#[test]
fn the_energy_less_its_work_is_conserved() {
    check_balance(&driven(), State::new([0.8], [1.3]));
    check_balance(&shaken(), State::new([0.4, -0.5], [0.3, 0.1]));
    check_balance(&turntable(), State::new([0.4, -0.5, 0.0, 0.0, 0.0], [0.3, 0.1, 0.2, -0.4, 1.0]));
}
