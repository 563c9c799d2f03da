//! The laws of Newton and Coulomb at every step where contacts meet: bodies that collide above a floor, and faces without clearance.

use lagrange_core::Sample;
use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

use super::law::{G, STEP, Touch, obeys};
use super::steps;

/// Two balls that may hit one another above a floor on which they rub.
#[derive(Clone, Lagrangian)]
#[coordinates(a: [3], b: [3])]
#[lagrangian(m/2 * (dot(a_dot, a_dot) + dot(b_dot, b_dot)) - m*g*(a[2] + b[2]))]
#[contact(left: a[2] >= 0, restitution: e, friction(mu): [a_dot[0], a_dot[1]])]
#[contact(right: b[2] >= 0, restitution: e, friction(mu): [b_dot[0], b_dot[1]])]
#[contact(both: norm(b - a) - d >= 0, restitution: e)]
struct Pucks {
    m: f64,
    g: f64,
    e: f64,
    mu: f64,
    d: f64,
    left: Contact,
    right: Contact,
    both: Contact,
}

#[test]
fn pucks_that_collide_obey_the_laws_in_the_plane() {
    let [left, right, both] = [Contact::Open; 3];
    let pucks = Pucks { m: 1.0, g: G, e: 0.5, mu: 0.3, d: 0.2, left, right, both };
    let start = State::new([0.0, 0.0, 0.0, 1.0, 0.05, 0.1], [2.0, 0.1, 0.0, -1.0, 0.2, 0.0]);
    let scheme = MoreauJean::with_step(STEP).tolerance(1e-11);
    let steps = steps(pucks.motion(start).by_time_stepping(scheme).stepper().unwrap(), 2.0);
    let mut hits = 0;
    for pair in steps.windows(2) {
        let (from, to) = (&pair[0].state, &pair[1]);
        let middle = from.q + from.v * (0.5 * STEP);
        for (at, name) in [(0, "left"), (3, "right")] {
            let impulse = |of: &str| to.impulse(&format!("{name}{of}")).unwrap();
            let touch = Touch {
                middle: middle[at + 2],
                end: to.state.q[at + 2],
                rates: [from.v[at + 2], to.state.v[at + 2]],
                slip: [to.state.v[at], to.state.v[at + 1]],
                push: impulse(""),
                drag: [impulse("_friction[0]"), impulse("_friction[1]")],
            };
            obeys(&touch, 0.5, 0.3);
        }
        let apart = |x: &[f64]| [x[3] - x[0], x[4] - x[1], x[5] - x[2]];
        let size = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let normal = apart(middle.as_slice());
        let rate = |v: &[f64]| apart(v).iter().zip(normal).map(|(v, n)| v * n).sum::<f64>() / size(normal);
        let touch = Touch {
            middle: size(normal) - 0.2,
            end: size(apart(to.state.q.as_slice())) - 0.2,
            rates: [rate(from.v.as_slice()), rate(to.state.v.as_slice())],
            slip: [0.0; 2],
            push: to.impulse("both").unwrap(),
            drag: [0.0; 2],
        };
        obeys(&touch, 0.5, 0.3);
        hits += usize::from(touch.push > 0.0);
    }
    let end = steps.last().unwrap().state;
    assert!(hits > 0 && end.v.amax() < 1e-9, "{end:?}");
}

/// A slider between two faces, whose weight turns round.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y*cos(w*t))]
#[contact(low: y >= 0, friction(mu): x_dot)]
#[contact(high: clearance - y >= 0, friction(mu): x_dot)]
struct Slider {
    m: f64,
    g: f64,
    mu: f64,
    w: f64,
    clearance: f64,
    low: Contact,
    high: Contact,
}

/// The faces could press the slider between them with any force. That of a face that is relieved is not kept by the other one:
/// friction is μ m g |cos w t|.
#[test]
fn faces_without_clearance_press_no_more_than_the_weight() {
    let (low, high) = (Contact::Closed, Contact::Open);
    let slider = Slider { m: 1.0, g: G, mu: 0.3, w: 2.0, clearance: 0.0, low, high };
    let start = State::new([0.0, 0.0], [5.0, 0.0]);
    // The distance by Simpson's rule, with a weight that turns round within parts: its error is below 1e-6.
    let slowed = |t: f64| 0.3 * 9.81 * (2.0 * t).cos().abs() * (2.3 - t);
    let simpson = |k: usize| slowed(k as f64 * 1e-3) * [2.0, 4.0][k % 2];
    let ride = 11.5 - (0..=2300).map(simpson).sum::<f64>() * 1e-3 / 3.0 + slowed(0.0) * 1e-3 / 3.0;
    for h in [1e-2, 1e-3] {
        let path = slider.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(2.3).unwrap();
        assert!((path.end().state().q[0] - ride).abs() < 0.1 * h, "{h}: {} {ride}", path.end().state().q[0]);
        let both = |step: Sample<Slider>| ["low", "high"].map(|face| step.multiplier(face).unwrap());
        let most = path.steps().map(both).map(|[low, high]| low.min(high)).fold(0.0, f64::max);
        assert!(most < 1e-9 / h, "{h}: {most:e}");
    }
}
