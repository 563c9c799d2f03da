//! Stiff systems take few steps.

use std::f64::consts::FRAC_PI_2;

use lagrange_core::prelude::*;

use crate::radau::off;

/// A spring in honey.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[dissipation(c/2*x_dot^2)]
struct Slow {
    c: f64,
}

impl Slow {
    /// The motion from rest at 1, in closed form.
    fn at(&self, t: f64) -> State<f64, 1> {
        let root = (self.c * self.c / 4.0 - 1.0).sqrt();
        let fast = -self.c / 2.0 - root;
        let slow = 1.0 / fast;
        let [a, b] = [fast / (fast - slow), -slow / (fast - slow)];
        let (x, y) = (a * (slow * t).exp(), b * (fast * t).exp());
        State::new([x + y], [slow * x + fast * y]).at_time(t)
    }
}

#[test]
fn stiff_damping_takes_few_steps() {
    let slow = Slow { c: 1e6 };
    for (tolerance, steps) in [(1e-6, 30), (1e-9, 50), (1e-12, 150)] {
        let path = slow.integrate(State::at_rest([1.0]), 1e6, Radau::with_tolerance(tolerance)).unwrap();
        assert!(off(path.end().state(), &slow.at(1e6)) < tolerance.max(1e-12), "{tolerance}");
        assert!(path.statistics().accepted < steps, "{:?}", path.statistics());
        // Dense output, from the steep start on.
        for t in [1e-5, 1e-2, 10.0, 3e3, 7e5] {
            let error = off(path.at(t).unwrap().state(), &slow.at(t));
            assert!(error < 30.0 * tolerance.powf(0.75), "{error:e} at {t}, tolerance {tolerance}");
        }
    }
    // Backwards in time the spring flees from its end, and is followed.
    let end = slow.at(2e-6);
    let path = slow.integrate(end, 0.0, Radau::default()).unwrap();
    let back = off(path.end().state(), &slow.at(0.0));
    assert!(back < 1e-7, "{back:e}");
}

/// A pendulum in honey, by its angle from the horizontal and by a rod.
#[derive(Clone, Lagrangian)]
#[coordinates(a)]
#[lagrangian(a_dot^2/2 - 9.81*sin(a))]
#[dissipation(c/2*a_dot^2)]
struct Angle {
    c: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - 9.81*y)]
#[constraint(rod: x^2 + y^2 = 1)]
#[constraint(again: a*x^2 + b*y^2 = 1)]
#[dissipation(c/2*(x_dot^2 + y_dot^2))]
struct Rods {
    a: f64,
    b: f64,
    c: f64,
}

/// The stiff component lies along the constraint, which turns by 90°; the constraint is there twice.
#[test]
fn stiff_motions_on_redundant_constraints_take_few_steps() {
    let (angle, rods) = (Angle { c: 1e6 }, Rods { a: 1.0, b: 1.0, c: 1e6 });
    let reference = angle.integrate(State::at_rest([0.0]), 3e5, Radau::with_tolerance(1e-13)).unwrap();
    let path = rods.integrate(State::at_rest([1.0, 0.0]), 3e5, Radau::with_tolerance(1e-9)).unwrap();
    assert!(path.statistics().accepted < 200, "{:?}", path.statistics());
    assert!(!path.statistics().multipliers_are_unique);
    for k in 0..=100 {
        let t = 3e3 * f64::from(k);
        let (state, a) = (*path.at(t).unwrap().state(), reference.at(t).unwrap().coordinate("a").unwrap());
        assert!((state.q[0] - a.cos()).abs().max((state.q[1] - a.sin()).abs()) < 1e-6, "at {t}");
    }
    let a = reference.end().coordinate("a").unwrap();
    assert!(
        (a + FRAC_PI_2).abs() < 0.2
            && off(path.end().state(), &State::new([a.cos(), a.sin()], [0.0; 2])) < 1e-5
    );
}

/// Bobs on stiff springs, and on rods.
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

#[derive(Clone, Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[lagrangian((dot(r_dot, r_dot) + dot(s_dot, s_dot))/2 - 9.81*(r[1] + s[1]))]
#[constraint(upper: dot(r, r) = 1)]
#[constraint(lower: dot(s - r, s - r) = 1)]
struct TwoRods;

/// The limit of stiff springs are rods; tensions F up to 100 leave errors of the order F/k. With the derivatives at the start of
/// each step alone, it takes thousands of steps.
#[test]
fn stiff_springs_that_swing_take_few_steps() {
    let start = State::at_rest([1.0, 0.0, 2.0, 0.0]);
    let exact = *TwoRods.integrate(start, 1.0, Taylor::default()).unwrap().end().state();
    for (k, c) in [(1e10, 0.0), (1e10, 1e6)] {
        let springs = Springs { k, c };
        for (tolerance, most) in [(1e-4, [400, 200, 150]), (1e-6, [400, 200, 150]), (1e-9, [800, 200, 150])] {
            let method = Radau::with_tolerance(tolerance);
            let paths = [
                springs.integrate(start, 1.0, method).unwrap(),
                springs.integrate(start, 1.0, method.stages::<5>()).unwrap(),
                springs.integrate(start, 1.0, method.stages::<7>()).unwrap(),
            ];
            for (path, most) in paths.iter().zip(most) {
                let error = (path.end().state().q - exact.q).amax();
                assert!(error < tolerance + 2e-8, "{k}, {c}, {tolerance}: {error:e}");
                let steps = path.statistics().accepted + path.statistics().rejected;
                assert!(steps < most, "{k}, {c}, {tolerance}: {:?}", path.statistics());
            }
        }
    }
}

/// Dry friction, all but a jump at rest: the bob swings, and sticks.
#[derive(Clone, Lagrangian)]
#[coordinates(a)]
#[lagrangian(a_dot^2/2 + 9.81*cos(a))]
#[dissipation(3*sqrt(a_dot^2 + 1e-12))]
struct Sticking;

/// Friction holds it at a constant rate. Guesses far beyond the step before miss that rate: with them it took 100,000 steps.
#[test]
fn a_motion_that_sticks_takes_few_steps() {
    let start = State::new([1.0], [2.0]);
    let exact = *Sticking.integrate(start, 3.0, Radau::with_tolerance(1e-12)).unwrap().end().state();
    for tolerance in [1e-4, 1e-6, 1e-9] {
        let method = Radau::with_tolerance(tolerance);
        let paths = [
            Sticking.integrate(start, 3.0, method).unwrap(),
            Sticking.integrate(start, 3.0, method.stages::<5>()).unwrap(),
            Sticking.integrate(start, 3.0, method.stages::<7>()).unwrap(),
        ];
        for path in paths {
            assert!(off(path.end().state(), &exact) < tolerance, "{tolerance}");
            assert!(path.statistics().accepted < 300, "{tolerance}: {:?}", path.statistics());
        }
    }
}
