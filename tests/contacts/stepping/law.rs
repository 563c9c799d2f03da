//! The laws of Newton and Coulomb at every step, with gaps and velocities by hand.

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;
use lagrange_systems::{Ball, Rod};

use super::steps;

pub(super) const G: f64 = 9.81;
pub(super) const STEP: f64 = 2e-3;

/// What a contact has in a step: its gaps before and at its middle and at its end, its rates before and after the impulses, the
/// velocity of its friction after them, and the impulses.
pub(super) struct Touch {
    pub(super) middle: f64,
    pub(super) end: f64,
    pub(super) rates: [f64; 2],
    pub(super) slip: [f64; 2],
    pub(super) push: f64,
    pub(super) drag: [f64; 2],
}

/// Checks the laws up to the tolerance of the impulses, for velocities and impulses of about 1.
#[track_caller]
pub(super) fn obeys(touch: &Touch, restitution: f64, mu: f64) {
    let Touch { middle, end, rates: [before, after], slip, push, drag } = *touch;
    let tolerance = 1e-8;
    assert!(end >= -1e-5 * G * STEP * STEP, "gap {end}");
    assert!(push >= 0.0, "push {push}");
    let [size, speed] = [drag, slip].map(|[x, y]| x.hypot(y));
    assert!(size <= mu * push * (1.0 + 1e-12), "{size} for {push}");
    if push > tolerance {
        let bounces = (after + restitution * before.min(0.0)).abs() < tolerance;
        // Its gap is zero in the middle of the next step.
        let closes = (middle.max(0.0) + STEP * after).abs() < tolerance * STEP;
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

fn rod(e: f64) -> Rod {
    Rod { m: 1.5, j: 0.125, a: 0.5, g: G, e, mu: [0.3; 2], left: -9.0, ..Rod::default() }
}

#[test]
fn a_rod_that_tumbles_obeys_the_laws_and_the_balance_of_momentum() {
    for e in [0.0, 0.4] {
        let start = State::new([0.0, 1.2, 0.7], [0.5, 0.0, -3.0]);
        let (rod, scheme) = (rod(e), MoreauJean::with_step(STEP).tolerance(1e-11));
        let steps = steps(rod.motion(start).by_time_stepping(scheme).stepper().unwrap(), 4.0);
        let mut pushes = 0;
        for pair in steps.windows(2) {
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
        let end = steps.last().unwrap().state;
        assert!(end.v.amax() < 1e-9, "{end:?}");
    }
}

/// With θ = ½ an elastic bounce takes no energy, whatever the step.
#[test]
fn an_elastic_ball_keeps_its_energy() {
    let ball = Ball { m: 0.2, g: G, e: 1.0, ..Ball::default() };
    let motion = ball.motion(State::new([0.0, 0.3], [0.4, 0.0]));
    let path = motion.by_time_stepping(MoreauJean::with_step(7e-3)).to(20.0).unwrap();
    let first = path.start().energy();
    assert!(path.steps().all(|step| (step.energy() - first).abs() < 1e-13));
    let highest =
        path.steps().filter(|step| step.time() > 19.3).map(|step| step.state().q[1]).fold(0.0, f64::max);
    assert!(highest > 0.29, "{highest}");
}

/// Energy falls at impacts and by friction. It rises by no more than what lifts the rod where its end, which the step moves along
/// a tangent, leaves its circle: m g l/4 (h ω)².
#[test]
fn energy_never_rises() {
    for (e, step) in [(0.0, 1e-2), (0.3, 3e-3), (0.8, 2e-3), (0.95, 1e-2)] {
        let start = State::new([0.0, 1.2, 0.7], [0.5, 0.0, -3.0]);
        let path = rod(e).motion(start).by_time_stepping(MoreauJean::with_step(step)).to(4.0).unwrap();
        let energies: Vec<f64> = path.steps().map(|step| step.energy()).collect();
        for (pair, at) in energies.windows(2).zip(path.steps()) {
            let lift = 1.5 * G * 0.25 * (step * at.state().v[2]).powi(2);
            // And within the gap that counts as zero.
            let within = 1.5 * G * 1e-6 * G * step * step;
            assert!(pair[1] - pair[0] <= lift + within, "{pair:?} at {at:?}");
        }
        assert!(energies[energies.len() - 1] < 0.5 * energies[0]);
    }
}

/// Forces and powers of contacts in a sample are those of its multipliers: a box on a belt that gets faster, and then slides.
#[test]
fn samples_have_the_forces_of_contacts_and_the_work_of_their_impulses() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    #[contact(belt: y >= 0, friction(mu): x_dot - a*t)]
    struct Carried {
        m: f64,
        g: f64,
        mu: f64,
        a: f64,
        belt: Contact,
    }
    for (a, force) in [(3.0, 6.0), (8.0, 9.81)] {
        let carried = Carried { m: 2.0, g: G, mu: 0.5, a, belt: Contact::Open };
        let motion = carried.motion(State::at_rest([0.0; 2])).by_time_stepping(MoreauJean::with_step(STEP));
        let path = motion.to(1.0).unwrap();
        let (last, v) = (path.end(), force / 2.0);
        let found = ["x", "y"].map(|name| last.constraint_force(name).unwrap());
        assert!((found[0] - force).abs() < 1e-9 && (found[1] - 2.0 * G).abs() < 1e-9, "{found:?}");
        // The velocity is that of the belt in the middle of a step.
        assert!((last.energy_rate().unwrap() - force * v).abs() < force * a * STEP, "{last}");
        // Transitions are not located, so that there is nothing to differentiate across.
        let error = path.sensitivity(&["mu"], Dop853::default()).unwrap_err();
        assert!(error.to_string().contains("time steps do not locate"), "{error}");
        let table = path.csv(3).to_string();
        assert!(table.starts_with("t,x,y,x_dot,y_dot,lambda(belt),lambda(belt_friction),force(x),force(y)"));
        let balance = *path.drift().get("energy - work").unwrap();
        assert!(balance.largest < 1e-12, "{balance:?}");
        assert!(
            path.to_string().contains("500 time steps")
                && path.to_string().contains("closed at the end: `belt`")
        );
    }
    // And of impacts.
    let (rod, thrown) = (rod(0.4), State::new([0.0, 1.2, 0.7], [0.5, 0.0, -3.0]));
    let path = rod.motion(thrown).by_time_stepping(MoreauJean::with_step(STEP)).to(1.0).unwrap();
    let balance = *path.drift().get("energy - work").unwrap();
    assert!(balance.largest < 5e-3 * balance.start, "{balance:?}");
}
