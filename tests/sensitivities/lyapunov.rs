//! Lyapunov exponents in closed form.

use lagrange_core::{linearized::DifferentiableMethod, prelude::*};
use lagrange_systems::DrivenSpring;

use crate::Damped;

pub(crate) fn method() -> Dop853 {
    Dop853::with_tolerance(1e-9).max_steps(10_000_000)
}

/// Volumes in the phase space of (θ, θ̇) shrink at the rate of friction, whatever the motion.
#[test]
fn exponents_of_a_driven_pendulum_sum_to_its_friction() {
    let driven = Damped { m: 1.0, l: 1.0, g: 1.0, c: 0.5, a: 1.5, w: 2.0 / 3.0 };
    let start = State::new([0.3], [0.1]);
    let spectrum = driven.lyapunov_spectrum(start, 150.0, Taylor::default()).unwrap();
    let sum: f64 = spectrum.exponents.iter().sum();
    assert!((sum + 0.5).abs() < 1e-11, "{:?}", spectrum.exponents);
}

#[test]
fn what_ends_too_early_is_an_error() {
    let error = HILL.lyapunov_spectrum(State::at_rest([1.0]), 100.0, method().max_steps(10)).unwrap_err();
    assert!(error.to_string().contains("10 steps"), "{error}");
}

/// The top of a hill: ẍ + ẋ/2 = x.
const HILL: DrivenSpring<f64> = DrivenSpring { m: 1.0, k: -1.0, c: 0.5, a: 0.0, w: 0.0 };

/// Where the motion stands still its own error is zero, and would allow any step.
#[test]
fn variations_choose_the_steps_too() {
    stands_still(Dop853::default(), 1e-7);
    stands_still(Taylor::default(), 1e-13);
}

fn stands_still<D: DifferentiableMethod<DrivenSpring<f64>> + Copy>(method: D, tolerance: f64) {
    let top = State::at_rest([0.0]);
    let root = (1.0_f64 / 16.0 + 1.0).sqrt();
    let [up, down] = [root - 0.25, -root - 0.25];
    let spectrum = HILL.lyapunov_spectrum(top, 200.0, method).unwrap();
    for (found, exact) in spectrum.exponents.iter().zip([up, down]) {
        assert!((found - exact).abs() < tolerance, "{found} for {exact}");
    }
    let motion = HILL.integrate_sensitivities(top, 10.0, method, &["x"]).unwrap();
    for t in [0.1, 3.7, 10.0] {
        let exact = (up * (down * t).exp() - down * (up * t).exp()) / (up - down);
        let found = motion.derivative(t, "x", "x").unwrap();
        assert!((found / exact - 1.0).abs() < tolerance, "{found} for {exact} at {t}");
    }
}

/// Rates by the time, of the same linear equation, whichever way it is followed.
#[test]
fn exponents_descend_backwards_too() {
    let root = (1.0_f64 / 16.0 + 1.0).sqrt();
    for end in [200.0, -200.0] {
        let spectrum = HILL.lyapunov_spectrum(State::at_rest([0.0]), end, method()).unwrap();
        let expected = [root - 0.25, -root - 0.25];
        let all = [&spectrum.exponents].into_iter().chain(spectrum.running.iter().map(|(_, means)| means));
        for means in all {
            for (found, expected) in means.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-5, "{means:?} for {expected:?}");
            }
        }
        assert!(spectrum.errors.iter().all(|error| *error < 1e-6), "{:?}", spectrum.errors);
    }
}
