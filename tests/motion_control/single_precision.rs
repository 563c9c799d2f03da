//! Times and steps in single precision.

use lagrange_core::{Ending, prelude::*};

use crate::spring_of;

/// A motion in single precision with as many steps as there are numbers in a few of its seconds.
#[test]
fn single_precision_far_from_zero_is_that_near_zero() {
    let off = |start: f32, tolerance: f64| {
        let spring = spring_of(1.0_f32);
        let path = spring
            .integrate(State::at_rest([1.0]).at_time(start), start + 100.0, Dop853::with_tolerance(tolerance))
            .unwrap();
        assert!(path.ending().is_complete(), "{}", path.ending());
        f64::from(path.end().coordinate("x").unwrap()) - 100_f64.cos()
    };
    for start in [0.0, 1e4, 1e5, 1e6] {
        let off = off(start, 1e-6);
        assert!(off.abs() < 1e-4, "from {start}: off by {off:e}");
    }
}

/// Where the numbers of the times are few.
#[test]
fn no_step_is_longer_than_allowed() {
    let spring = spring_of(1.0_f32);
    let start = State::at_rest([1.0]).at_time(1e4);
    let path = spring.integrate(start, 1.001e4, Dop853::default().max_step(0.01)).unwrap();
    let times: Vec<f32> = path.steps().map(|step| step.time()).collect();
    assert!(path.ending().is_complete() && times.windows(2).all(|t| t[1] > t[0] && t[1] - t[0] <= 0.01));
}

#[test]
fn fixed_steps_are_as_many_as_fit() {
    let spring = spring_of(1.0_f32);
    let method = Dopri5::default().fixed_step(0.05);
    let path = spring.integrate(State::at_rest([1.0]), 1e4, method.max_steps(1_000_000)).unwrap();
    assert_eq!((path.ending().is_complete(), path.statistics().accepted), (true, 200_000));
    let times: Vec<f32> = path.steps().map(|step| step.time()).collect();
    // Two numbers below 10⁴ are 2⁻¹⁰ apart, and 200 000 numbers 0.05 off by half an ulp each.
    let off = times.iter().zip(0..).map(|(t, k)| (f64::from(*t) - 0.05 * f64::from(k)).abs());
    assert!(off.fold(0.0, f64::max) < 2e-3);
}

/// What a setting in `f64` becomes in `f32` may be nothing.
#[test]
fn settings_too_small_for_single_precision_are_no_steps_of_no_length() {
    let spring = spring_of(1.0_f32);
    let start = State::at_rest([1.0]);
    for method in [Dop853::default().max_step(1e-50), Dop853::default().fixed_step(1e-50)] {
        let path = spring.motion(start).by(method).towards(1.0).unwrap();
        assert!(matches!(path.ending(), Ending::TimeTooCoarse { time: 0.0, .. }), "{}", path.ending());
        assert!(path.drift().iter().all(|quantity| quantity.largest == 0.0));
    }
    let path = spring.integrate(start, 1.0, Dop853::default().first_step(1e-50)).unwrap();
    assert!(path.ending().is_complete() && (path.end().state().q[0] - 1_f32.cos()).abs() < 1e-5);
}

#[test]
fn single_precision_goes_back() {
    let spring = spring_of(1.0_f32);
    let path = spring.integrate(State::at_rest([1.0]), -10.0, Dopri5::with_tolerance(1e-6)).unwrap();
    assert!((path.end().state().q[0] - 10_f32.cos()).abs() < 1e-4);
}
