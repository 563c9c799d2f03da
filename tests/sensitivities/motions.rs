//! Derivatives by every entry of the start and every parameter, by each method.

use std::f64::consts::PI;

use lagrange_core::{Error, linearized::DifferentiableMethod, prelude::*};
use lagrange_systems::DrivenSpring;

use crate::differences::{check, check_each, flat};
use crate::{BEAD, DAMPED, bead_start, method};

#[test]
fn damped_pendulum() {
    check(&DAMPED, State::new([1.0], [0.5]).at_time(1.0), 4.0, method());
    check(&DAMPED, State::new([1.0], [0.5]).at_time(1.0), 4.0, Taylor::default());
    check(&DAMPED, State::new([1.0], [0.5]), -1.5, method());
}

#[test]
fn bead_on_a_wire_that_turns() {
    check_each(&BEAD, bead_start(), 2.0);
}

#[test]
fn in_between_they_are_as_accurate_as_the_motion() {
    check_spring(Dop853::with_tolerance(1e-12), 2e-11);
    check_spring(Taylor::default(), 1e-14);
}

/// x = x₀ cos ωt + v₀/ω sin ωt, at many times within the steps; ∂/∂k = ∂/∂ω/2ω.
fn check_spring<D: DifferentiableMethod<DrivenSpring<f64>>>(method: D, tolerance: f64) {
    let ([x, v], start) = ([0.7, -0.4], State::new([0.7], [-0.4]));
    let spring = DrivenSpring { m: 1.0, k: 4.0, c: 0.0, a: 0.0, w: 0.0 };
    let motion = spring.integrate_sensitivities(start, 2.0 * PI, method, &["x", "x_dot", "k"]).unwrap();
    for k in 0..=200 {
        let t = 2.0 * PI * f64::from(k) / 200.0;
        let at = motion.derivatives_at(t).unwrap();
        let (sin, cos) = (2.0 * t).sin_cos();
        let by_k = (-x * t * sin + v * (t * cos / 2.0 - sin / 4.0)) / 4.0;
        let exact =
            [(at.q[0], cos), (at.q[1], sin / 2.0), (at.q[2], by_k), (at.v[0], -2.0 * sin), (at.v[1], cos)];
        for (found, exact) in exact {
            assert!((found - exact).abs() < tolerance * (1.0 + t), "{t}: {found} for {exact}");
        }
    }
}

/// At rest where the spring holds against the push, at x = 1; ω = 1.
fn held(size: f64) -> (DrivenSpring<f64>, State<f64, 1>) {
    (DrivenSpring { m: size, k: size, c: 0.0, a: size, w: 0.0 }, State::at_rest([1.0]))
}

/// The error of a motion at rest is zero, and says nothing about variations. ∂x/∂a = (1 − cos t)/k.
#[test]
fn parameters_count_by_their_size() {
    for size in [1e-8, 1.0, 1e8] {
        let (held, start) = held(size);
        let motion = held.integrate_sensitivities(start, 10.0, Dop853::default(), &["a"]).unwrap();
        let found = motion.derivative(10.0, "x", "a").unwrap() * size;
        assert!((found - (1.0 - 10.0_f64.cos())).abs() < 1e-7, "{found} at {size}");
    }
}

#[test]
fn a_step_too_long_for_variations_is_taken_back() {
    let (held, start) = held(1.0);
    let method = Dop853::default().first_step(8.0);
    let motion = held.integrate_sensitivities(start, 100.0, method, &["x"]).unwrap();
    for t in [1.0_f64, 8.0, 100.0] {
        let found = motion.derivative(t, "x", "x").unwrap();
        assert!((found - t.cos()).abs() < 1e-6, "{found} at {t}");
    }
    // And the next is as long as the variations like it, not ten times the last.
    let statistics = motion.statistics();
    assert!(statistics.rejected >= 1 && 5 * statistics.rejected < statistics.accepted, "{statistics:?}");
}

/// On top of a hill variations grow as eᵗ, and steps get no shorter.
#[test]
fn variations_that_grow_are_followed_to_the_same_digits() {
    let (spring, start) = held(1.0);
    let hill = DrivenSpring { k: -1.0, a: -1.0, ..spring };
    let steps = |end: f64| {
        let motion = hill.integrate_sensitivities(start, end, Dop853::default(), &["x"]).unwrap();
        let found = motion.derivative(end, "x", "x").unwrap();
        assert!((found / end.cosh() - 1.0).abs() < 1e-6, "{found} at {end}");
        motion.statistics().accepted
    };
    let (half, whole) = (steps(30.0), steps(60.0));
    assert!(whole <= 2 * half + 2, "{half} and {whole}");
}

#[test]
fn what_cannot_be_is_named() {
    let seek = |end: f64, names: &[&str]| {
        DAMPED.integrate_sensitivities(State::new([1.0], [0.5]), end, method(), names)
    };
    let error = seek(1.0, &["thetta"]).err().unwrap();
    assert!(error.to_string().contains("did you mean `theta`?"), "{error}");
    let motion = seek(1.0, &["l"]).unwrap();
    assert!(matches!(motion.derivatives_at(1.5), Err(Error::OutsideTrajectory { .. })));
    let error = motion.derivative(0.5, "theta", "m").unwrap_err();
    assert!(error.to_string().contains("there is no argument of these derivatives `m`"), "{error}");
    // Without arguments it is the motion; without time, the start.
    assert_eq!(seek(1.0, &[]).unwrap().derivatives_at(0.5).unwrap().q.ncols(), 0);
    let still = seek(0.0, &["theta", "m"]).unwrap().derivatives_at(0.0).unwrap();
    assert_eq!((still.q.as_slice(), still.v.as_slice()), (&[1.0, 0.0][..], &[0.0, 0.0][..]));
    assert_eq!(flat(&still.state).as_slice(), [1.0, 0.5]);
}
