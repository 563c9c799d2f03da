//! An end before the start: the same motion, the other way.

use lagrange_core::{Ending, Method, motion::Progress, prelude::*};
use lagrange_systems::Spring;

use crate::times::{allowed, exact};
use crate::{spring_of, stop_if};

fn checked_backwards(method: impl Method<Spring<f64>> + Copy, bound: impl Fn(usize) -> f64) {
    for (start, omega, end) in
        [(0.0, 1.0, -20.0), (1.7e9, 1e3, 1.7e9 - 0.125), (-3.0, 1e3, -3.5), (2.0, 1e-12, -2e13)]
    {
        let spring = spring_of(omega);
        let path = spring.integrate(State::at_rest([1.0]).at_time(start), end, method).expect("a start");
        assert_eq!(*path.ending(), Ending::Complete { time: end });
        assert!(path.steps().map(|step| step.time()).is_sorted_by(|a, b| a > b));
        let bound = bound(path.statistics().accepted);
        for sample in path.steps() {
            let off = sample.state().q[0] - (omega * (sample.time() - start)).cos();
            assert!(off.abs() <= bound + 1e-6, "ω = {omega:e}: off by {off:e} at {}", sample.time());
        }
        let off = path.end().state().q[0] - exact(omega, start, end);
        assert!(off.abs() <= bound, "ω = {omega:e}: off by {off:e}");
    }
}

#[test]
fn a_spring_swings_back_as_its_solution_says() {
    checked_backwards(Dop853::default().absolute_tolerance(1e-14), |steps| allowed(steps, 1e-9));
    checked_backwards(Dopri5::with_tolerance(1e-8).absolute_tolerance(1e-14), |steps| allowed(steps, 1e-8));
}

#[test]
fn queries_of_a_path_backwards_are_in_its_order() {
    let spring = spring_of(1.0);
    let path = spring.integrate(State::at_rest([1.0]).at_time(3.0), -7.0, Dop853::default()).unwrap();
    let times: Vec<f64> = path.samples(11).map(|sample| sample.time()).collect();
    assert_eq!(times, [3.0, 2.0, 1.0, 0.0, -1.0, -2.0, -3.0, -4.0, -5.0, -6.0, -7.0]);
    for k in 0..=1000 {
        let t = 3.0 - 0.01 * f64::from(k);
        let sample = path.at(t.max(-7.0)).unwrap();
        assert_eq!(sample.time(), t.max(-7.0));
        assert!((sample.state().q[0] - (t - 3.0).cos()).abs() < 1e-7);
        assert!((sample.state().v[0] + (t - 3.0).sin()).abs() < 1e-7);
    }
    for outside in [3.0 + 1e-9, -7.0 - 1e-9, f64::NAN] {
        let error = path.at(outside).unwrap_err();
        assert!(matches!(error, Error::OutsideTrajectory { start: 3.0, end: -7.0, .. }), "{error}");
    }
    for step in path.steps() {
        assert_eq!(path.at(step.time()).unwrap().state(), step.state());
    }
    assert!(path.drift().iter().all(|quantity| quantity.largest < 1e-7));
    assert_eq!(path.csv(5).to_string().lines().count(), 6);
}

#[test]
fn what_stops_a_motion_stops_it_backwards() {
    let spring = spring_of(1.0);
    let path =
        spring.motion(State::at_rest([1.0])).by(Dopri5::default().max_steps(50)).towards(-1e9).unwrap();
    assert!(
        matches!(path.ending(), Ending::StepLimit { time, steps: 50, .. } if *time < -1.0),
        "{}",
        path.ending()
    );
    let watch = |progress: Progress| stop_if(progress.time < -20.0);
    let path = spring.motion(State::at_rest([1.0])).on_progress(watch).to(-1e300).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }), "{}", path.ending());
    let off = path.end().state().q[0] - path.end().time().cos();
    assert!(off.abs() <= allowed(path.statistics().accepted, 1e-9), "{off:e}");
    let path = spring.motion(State::at_rest([1.0]).at_time(1e17)).towards(1e17 - 1e3).unwrap();
    assert!(
        matches!(path.ending(), Ending::TimeTooCoarse { .. } | Ending::StepTooSmall { .. }),
        "{}",
        path.ending()
    );
}
