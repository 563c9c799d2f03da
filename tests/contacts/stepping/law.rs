//! The laws of Newton and Coulomb at every step, with gaps and velocities by hand.

use lagrange_core::contact::{Contact, MoreauJean, TimeStep};
use lagrange_core::prelude::*;

const G: f64 = 9.81;
const STEP: f64 = 2e-3;

/// What a contact has in a step: its gaps before and at its middle and at its end, its rates before and after the impulses, the
/// velocity of its friction after them, and the impulses.
struct Touch {
    middle: f64,
    end: f64,
    rates: [f64; 2],
    slip: [f64; 2],
    push: f64,
    drag: [f64; 2],
}

/// Checks the laws up to the tolerance of the impulses, for velocities and impulses of about 1.
#[track_caller]
fn obeys(touch: &Touch, restitution: f64, mu: f64) {
    let Touch { middle, end, rates: [before, after], slip, push, drag } = *touch;
    let tolerance = 1e-8;
    assert!(end >= -1e-5 * G * STEP * STEP, "gap {end}");
    assert!(push >= 0.0, "push {push}");
    let [size, speed] = [drag, slip].map(|[x, y]| x.hypot(y));
    assert!(size <= mu * push * (1.0 + 1e-12), "{size} for {push}");
    if push > tolerance {
        let bounces = (after + restitution * before.min(0.0)).abs() < tolerance;
        let closes = (middle.max(0.0) + 0.5 * STEP * after).abs() < tolerance * STEP;
        assert!(bounces || closes, "gap {middle}, rates {before} and {after}");
    } else {
        assert!(middle + 0.5 * STEP * after >= -1e-5 * G * STEP * STEP, "gap {middle}, rate {after}");
    }
    if speed > 1e-7 {
        // Of all allowed impulses the one that takes most energy.
        let power = drag[0] * slip[0] + drag[1] * slip[1];
        assert!((power + mu * push * speed).abs() < tolerance * speed, "{drag:?} at {slip:?}");
    }
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
fn a_rod_that_tumbles_obeys_the_laws_and_the_balance_of_momentum() {
    for e in [0.0, 0.4] {
        let rod = Rod { m: 1.5, l: 1.0, g: G, e, mu: 0.3, floor: [Contact::Open; 2] };
        let start = State::new([0.0, 1.2, 0.7], [0.5, 0.0, -3.0]);
        let path =
            rod.motion(start).by_time_stepping(MoreauJean::with_step(STEP).tolerance(1e-11)).to(4.0).unwrap();
        let mut pushes = 0;
        for pair in path.steps().windows(2) {
            let (from, to) = (&pair[0].state, &pair[1]);
            let middle = from.q + from.v * (0.5 * STEP);
            let tip = |q: &[f64], s: f64| q[1] + s * 0.5 * q[2].sin();
            let mut momentum = [0.0, -1.5 * G * STEP, 0.0];
            for (k, s) in [(0, -1.0), (1, 1.0)] {
                let (sin, cos) = middle[2].sin_cos();
                let [rate, slip] = [[0.0, 1.0, s * 0.5 * cos], [1.0, 0.0, -s * 0.5 * sin]];
                let along = |row: [f64; 3], v: &[f64]| row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
                let (push, drag) = (
                    to.impulse(&format!("floor[{k}]")).unwrap(),
                    to.impulse(&format!("floor_friction[{k}]")).unwrap(),
                );
                (0..3).for_each(|i| momentum[i] += push * rate[i] + drag * slip[i]);
                let (before, after) = (from.v.as_slice(), to.state.v.as_slice());
                let touch = Touch {
                    middle: tip(middle.as_slice(), s),
                    end: tip(to.state.q.as_slice(), s),
                    rates: [along(rate, before), along(rate, after)],
                    slip: [along(slip, after), 0.0],
                    push,
                    drag: [drag, 0.0],
                };
                obeys(&touch, e, 0.3);
                pushes += usize::from(push > 0.0);
            }
            for (i, inertia) in [1.5, 1.5, 1.5 / 12.0].into_iter().enumerate() {
                let change = inertia * (to.state.v[i] - from.v[i]);
                assert!((change - momentum[i]).abs() < 1e-12, "{change} for {}", momentum[i]);
            }
        }
        assert!(pushes > 100, "{pushes}");
        assert!(path.end().v.amax() < 1e-9, "{:?}", path.end());
    }
}

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
    let path =
        pucks.motion(start).by_time_stepping(MoreauJean::with_step(STEP).tolerance(1e-11)).to(2.0).unwrap();
    let mut hits = 0;
    for pair in path.steps().windows(2) {
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
    assert!(hits > 0);
    assert!(path.end().v.amax() < 1e-9, "{:?}", path.end());
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

/// With θ = ½ an elastic bounce takes no energy, whatever the step.
#[test]
fn an_elastic_ball_keeps_its_energy() {
    let ball = Ball { m: 0.2, g: G, e: 1.0, floor: Contact::Open };
    let motion = ball.motion(State::new([0.0, 0.3], [0.4, 0.0]));
    let path = motion.by_time_stepping(MoreauJean::with_step(7e-3)).to(20.0).unwrap();
    let first = path.energies().next().unwrap();
    assert!(path.energies().all(|energy| (energy - first).abs() < 1e-13));
    let highest = path.steps().iter().rev().take(100).map(|step| step.state.q[1]).fold(0.0, f64::max);
    assert!(highest > 0.29, "{highest}");
}

/// Energy falls at impacts and by friction. It rises by no more than what lifts the rod where its end, which the step moves along
/// a tangent, leaves its circle: m g l/4 (h ω)².
#[test]
fn energy_never_rises() {
    for (e, step) in [(0.0, 1e-2), (0.3, 3e-3), (0.8, 2e-3), (0.95, 1e-2)] {
        let rod = Rod { m: 1.5, l: 1.0, g: G, e, mu: 0.3, floor: [Contact::Open; 2] };
        let start = State::new([0.0, 1.2, 0.7], [0.5, 0.0, -3.0]);
        let path = rod.motion(start).by_time_stepping(MoreauJean::with_step(step)).to(4.0).unwrap();
        let energies: Vec<f64> = path.energies().collect();
        for (pair, at) in energies.windows(2).zip(path.steps()) {
            let lift = 1.5 * G * 0.25 * (step * at.state.v[2]).powi(2);
            // And within the gap that counts as zero.
            let within = 1.5 * G * 1e-6 * G * step * step;
            assert!(pair[1] - pair[0] <= lift + within, "{pair:?} at {at:?}");
        }
        assert!(energies[energies.len() - 1] < 0.5 * energies[0]);
    }
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
    let slider = Slider { m: 1.0, g: 9.81, mu: 0.3, w: 2.0, clearance: 0.0, low, high };
    let start = State::new([0.0, 0.0], [5.0, 0.0]);
    // The distance by Simpson's rule, with a weight that turns round within parts: its error is below 1e-6.
    let slowed = |t: f64| 0.3 * 9.81 * (2.0 * t).cos().abs() * (2.3 - t);
    let simpson = |k: usize| slowed(k as f64 * 1e-3) * [2.0, 4.0][k % 2];
    let ride = 11.5 - (0..=2300).map(simpson).sum::<f64>() * 1e-3 / 3.0 + slowed(0.0) * 1e-3 / 3.0;
    for h in [1e-2, 1e-3] {
        let path = slider.motion(start).by_time_stepping(MoreauJean::with_step(h)).to(2.3).unwrap();
        assert!((path.end().q[0] - ride).abs() < 0.1 * h, "{h}: {} {ride}", path.end().q[0]);
        let both = |step: &TimeStep<Slider>| step.impulse("low").unwrap().min(step.impulse("high").unwrap());
        let most = path.steps().iter().map(both).fold(0.0, f64::max);
        assert!(most < 1e-9, "{h}: {most:e}");
    }
}
