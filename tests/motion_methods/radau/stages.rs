//! Stiff systems take few steps, by each number of stages.

use std::f64::consts::FRAC_PI_2;

use lagrange_core::{StateDerivatives, nalgebra::Const, prelude::*};
use lagrange_systems::{DoubledRod, TwoBobs};

use crate::radau::off;

/// The motions by three, five and seven stages.
pub(super) fn by_stages<L, const N: usize>(
    system: &L,
    start: State<f64, N>,
    end: f64,
    tolerance: f64,
) -> [Trajectory<&L>; 3]
where
    L: StateDerivatives<N = Const<N>, Scalar = f64>,
{
    let (motion, method) = (|| system.motion(start), Radau::with_tolerance(tolerance));
    [
        motion().by(method).towards(end).unwrap(),
        motion().by(method.stages::<5>()).towards(end).unwrap(),
        motion().by(method.stages::<7>()).towards(end).unwrap(),
    ]
}

/// A pendulum in honey, or with dry friction, all but a jump at rest.
#[derive(Clone, Lagrangian)]
#[coordinates(a)]
#[lagrangian(a_dot^2/2 + 9.81*cos(a))]
#[dissipation(c/2*a_dot^2 + dry*sqrt(a_dot^2 + 1e-12))]
struct Damped {
    c: f64,
    dry: f64,
}

/// The stiff component lies along the constraint, which turns by 90°; the constraint is there twice.
#[test]
fn stiff_motions_on_redundant_constraints_take_few_steps() {
    let (angle, rods) = (Damped { c: 1e6, dry: 0.0 }, DoubledRod { g: 9.81, a: 1.0, c: 1e6 });
    let reference = angle.integrate(State::at_rest([FRAC_PI_2]), 3e5, Radau::with_tolerance(1e-13)).unwrap();
    let path = rods.integrate(State::at_rest([1.0, 0.0]), 3e5, Radau::with_tolerance(1e-9)).unwrap();
    assert!(path.statistics().accepted < 200, "{:?}", path.statistics());
    assert!(!path.statistics().multipliers_are_unique);
    for k in 0..=100 {
        let t = 3e3 * f64::from(k);
        let (state, a) = (*path.at(t).unwrap().state(), reference.at(t).unwrap().coordinate("a").unwrap());
        assert!((state.q[0] - a.sin()).abs().max((state.q[1] + a.cos()).abs()) < 1e-6, "at {t}");
    }
    let a = reference.end().coordinate("a").unwrap();
    assert!(a.abs() < 0.2 && off(path.end().state(), &State::new([a.sin(), -a.cos()], [0.0; 2])) < 1e-5);
}

/// Bobs on stiff springs.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[define(stretch = (norm(r) - 1)^2 + (norm(s - r) - 1)^2)]
#[define(rate = dot(r, r_dot)^2/dot(r, r) + dot(s - r, s_dot - r_dot)^2/dot(s - r, s - r))]
#[lagrangian((dot(r_dot, r_dot) + dot(s_dot, s_dot))/2 - 9.81*(r[1] + s[1]) - k/2*stretch)]
#[dissipation(c/2*rate)]
struct Springs {
    k: f64,
    c: f64,
}

/// The limit of stiff springs are rods; tensions F up to 100 leave errors of the order F/k. With the derivatives at the start of
/// each step alone, it takes thousands of steps.
#[test]
fn stiff_springs_that_swing_take_few_steps() {
    let start = State::at_rest([1.0, 0.0, 2.0, 0.0]);
    let exact = *TwoBobs { m: 1.0, g: 9.81 }.integrate(start, 1.0, Taylor::default()).unwrap().end().state();
    for (k, c) in [(1e10, 0.0), (1e10, 1e6)] {
        let springs = Springs { k, c };
        for (tolerance, most) in [(1e-4, [400, 200, 150]), (1e-6, [400, 200, 150]), (1e-9, [800, 200, 150])] {
            for (path, most) in by_stages(&springs, start, 1.0, tolerance).iter().zip(most) {
                assert!(path.ending().is_complete(), "{}", path.ending());
                let error = (path.end().state().q - exact.q).amax();
                assert!(error < tolerance + 2e-8, "{k}, {c}, {tolerance}: {error:e}");
                let steps = path.statistics().accepted + path.statistics().rejected;
                assert!(steps < most, "{k}, {c}, {tolerance}: {:?}", path.statistics());
            }
        }
    }
}

/// Friction holds it at a constant rate. Guesses far beyond the step before miss that rate: with them it took 100,000 steps.
#[test]
fn a_motion_that_sticks_takes_few_steps() {
    let (damped, start) = (Damped { c: 0.0, dry: 3.0 }, State::new([1.0], [2.0]));
    let exact = *damped.integrate(start, 3.0, Radau::with_tolerance(1e-12)).unwrap().end().state();
    for tolerance in [1e-4, 1e-6, 1e-9] {
        for path in by_stages(&damped, start, 3.0, tolerance) {
            assert!(off(path.end().state(), &exact) < tolerance, "{tolerance}");
            assert!(path.statistics().accepted < 300, "{tolerance}: {:?}", path.statistics());
        }
    }
}
