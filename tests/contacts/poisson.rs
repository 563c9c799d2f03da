//! Poisson's law of impact between several bodies, its derivatives, and where it does not apply.

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};
use lagrange_systems::Stack;

use crate::method;
use crate::restitution::{after, distance, rod};

#[test]
fn time_stepping_names_the_law() {
    let start = State::new([0.0, 1.0, 1.0], [0.0, -1.0, 0.0]);
    let path = rod([2.0, 0.5, 0.6, 0.3]).motion(start).by_time_stepping(MoreauJean::with_step(1e-2)).to(1.0);
    assert!(matches!(path, Err(Error::ImpactLaw { contact: "floor[0]" })));
}

/// Where the rod slides all the way, the derivatives are those of differences of motions; where it sticks, the friction is named.
#[test]
fn derivatives_where_the_rod_slides() {
    let method = method();
    let end = |e: f64, mu: f64, s: f64| {
        let start = State::new([0.0, 1.0, 1.0], [s, -1.0, 0.2]);
        rod([2.0, 0.5, e, mu]).motion(start).by(method).with_contacts().to(1.0).unwrap()
    };
    let found = end(0.6, 0.05, 2.0).sensitivity(&["e[0]", "mu", "x_dot"], method).unwrap();
    let step = 1e-5;
    for (column, [e, mu, s]) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate() {
        let at = |part: f64| end(0.6 + part * e, 0.05 + part * mu, 2.0 + part * s).end().state().v;
        let difference = (at(step) - at(-step)) / (2.0 * step);
        let error = (difference - found.v.column(column)).amax();
        assert!(error < 1e-8, "{column}: {error:e}");
    }
    let sticks = end(0.6, 1.2, 0.2).sensitivity(&["e[0]"], method);
    let Err(Error::NoDerivativeAcross { contact: "floor[0]", reason, .. }) = sticks else {
        panic!("{sticks:?}")
    };
    assert!(reason.contains("sticks in an impact by Poisson's law"), "{reason}");
}

/// Three balls in a row that touch.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [3])]
#[lagrangian(sum(i in 0..3, m[i]/2 * x_dot[i]^2))]
#[contact(balls[i in 0..2]: x[i + 1] - x[i] >= 0, restitution(poisson): e[i])]
struct Balls {
    m: [f64; 3],
    e: [f64; 2],
    balls: [Contact; 2],
}

fn by_newton(m: [f64; 3], e: [f64; 2]) -> Stack {
    Stack { m, low: -9.0, e: [0.0, e[0], e[1]], ..Stack::default() }
}

/// Compression leaves all balls with 1/3, by impulses of 2/3 and 1/3. The second contact returns its 1/3, and the first one pushes
/// with 1/6, so that the first two stay together. By Newton's law, a contact at rest returns nothing.
#[test]
fn a_ball_hits_two_at_rest() {
    let start = State::new([1.0; 3], [1.0, 0.0, 0.0]);
    let (m, e, balls) = ([1.0; 3], [0.0, 1.0], [Contact::Open; 2]);
    let poisson = after(&Balls { m, e, balls }, start);
    assert!(distance(poisson, [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0]) < 1e-15, "{poisson:?}");
    let newton = after(&by_newton(m, e), start);
    assert!(distance(newton, [1.0 / 3.0; 3]) < 1e-15, "{newton:?}");
}

/// Without friction and with one coefficient, each impulse of expansion is e times that of compression, and so by Newton's law.
/// With several, and with both laws in one impact, no energy is gained.
#[test]
fn three_balls_gain_no_energy() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x: [3])]
    #[lagrangian(sum(i in 0..3, m[i]/2 * x_dot[i]^2))]
    #[contact(first: x[1] - x[0] >= 0, restitution: e[0])]
    #[contact(second: x[2] - x[1] >= 0, restitution(poisson): e[1])]
    struct MixedBalls {
        m: [f64; 3],
        e: [f64; 2],
        first: Contact,
        second: Contact,
    }
    let mut random = Random(7);
    for case in 0..cases([400, 2_000, 20_000]) {
        let mut next = |low: f64, high: f64| random.between(low, high);
        let m = [next(0.1, 2.0), next(0.01, 2.0), next(0.1, 2.0)];
        let is_one = case % 4 == 0;
        let first = next(0.0, 1.0);
        let e = [first, if is_one { first } else { next(0.0, 1.0) }];
        let [u, w] = [next(0.0, 2.0), if case % 2 == 0 { 0.0 } else { next(0.0, 2.0) }];
        let start = State::new([1.0; 3], [u, 0.0, -w]);
        let balls @ [first, second] = [Contact::Open; 2];
        let poisson = after(&Balls { m, e, balls }, start);
        let mixed = after(&MixedBalls { m, e, first, second }, start);
        if is_one {
            let newton = after(&by_newton(m, e), start);
            assert!(distance(newton, poisson) < 1e-12, "case {case}: {newton:?} {poisson:?}");
        }
        let energy = |v: [f64; 3]| (0..3).map(|k| m[k] * v[k] * v[k] / 2.0).sum::<f64>();
        let before = energy(start.v.into());
        for after in [poisson, mixed] {
            assert!(energy(after) <= before * (1.0 + 1e-13), "case {case}: {}", energy(after) - before);
        }
    }
}
