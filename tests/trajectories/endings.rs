//! What does not reach its end is an error, and says why.

use std::error::Error as StdError;
use std::ops::ControlFlow;
use std::time::Duration;

use lagrange_core::prelude::*;
use lagrange_core::{Ending, Method, Statistics, motion::Progress};

use crate::{BlowUp, START, Spring};

fn spring(k: f64, c: f64) -> Spring<f64> {
    Spring { k, c, f: 1.0, ..Spring::default() }
}

fn limited(steps: usize) -> Dop853 {
    Dop853::default().max_steps(steps)
}

/// A summary has the counts of the statistics, the crossings and the ending.
#[test]
fn a_motion_prints_as_a_summary() {
    let spring = spring(1.0, 0.0);
    let turning = spring.event("turning", |sample| sample.velocity("x"));
    let path = spring.motion(START).event(turning).towards(3.0).unwrap();
    let Statistics { accepted, rejected, evaluations, .. } = path.statistics();
    let counts = format!("{accepted} steps, {rejected} rejected, {evaluations} evaluations");
    let crossings = path.crossings().len();
    assert_eq!(crossings, 1);
    assert_eq!(
        path.to_string(),
        format!("Spring from t = 0 to t = 3: {counts}, 1 crossing\nreached the end at t = 3")
    );
    let plain = spring.motion(START).towards(1.0).unwrap().to_string();
    assert!(plain.ends_with(" evaluations\nreached the end at t = 1"), "{plain}");
}

/// The end that was asked for, and nothing else.
#[test]
fn a_motion_that_stops_early_is_an_error() {
    let spring = spring(1.0, 0.0);
    let error = spring.integrate(START, 1e6, limited(500)).unwrap_err();
    let Error::Unfinished(ending) = &error else { panic!("{error}") };
    let path = spring.motion(START).by(limited(500)).towards(1e6).unwrap();
    assert_eq!(**ending, *path.ending());
    assert!(matches!(**ending, Ending::StepLimit { steps: 500, pace, time }
            if time == path.end().time() && pace.stiffness.or(pace.time_apart).is_none()));
    let (said, time) = (error.to_string(), ending.time());
    assert!(
        said.starts_with(&format!("stopped at t = {time} after 500 steps, the limit, where the next is ")),
        "{said}"
    );
    assert!(said.contains("e-1 long; raise it with `max_steps`, unless steps only shrink"), "{said}");
    let fixed = spring.integrate(START, 1e6, Dop853::default().fixed_step(0.125).max_steps(8)).unwrap_err();
    assert_eq!(fixed.to_string(), "stopped at t = 1 after 8 steps, the limit; raise it with `max_steps`");
    // What is kept is the motion: x'' + x = sin t.
    for sample in path.samples(50) {
        let t = sample.time();
        let exact = t.cos() + 2.5 * t.sin() - 0.5 * t * t.cos();
        assert!((sample.coordinate("x").unwrap() - exact).abs() < 1e-6 * (1.0 + t));
    }
}

#[test]
fn the_error_tells_time_coordinate_and_cause() {
    let error = BlowUp.integrate(START, 3.0, Dop853::default()).unwrap_err();
    let said = error.to_string();
    let Error::Unfinished(ending) = &error else { panic!("{said}") };
    assert!(
        (ending.time() - 1.0).abs() < 1e-6 && said.contains(&format!("t = {}: ", ending.time())),
        "{said}"
    );
    assert!(
        said.contains("the error of `x_dot`")
            && said.contains(
                "singular nearby, the tolerance is below the round-off, or the time is counted from far away"
            ),
        "{said}"
    );
    let phase = BlowUp.phase_state(&START);
    let said = BlowUp.motion_in_momenta(phase).to(3.0).unwrap_err().to_string();
    assert!(said.starts_with("stopped at t = ") && said.contains("the error of `p(x)`"), "{said}");
    let path = BlowUp.motion_in_momenta(phase).towards(3.0).unwrap();
    assert!(
        path.ending().is_failure() && (path.at(0.5).unwrap().coordinate("x").unwrap() - 4.0).abs() < 1e-7
    );
    let hurried = Dop853::default().wall_time(Duration::ZERO);
    let said = BlowUp.integrate(START, 0.5, hurried).unwrap_err().to_string();
    assert_eq!(said, "stopped at t = 0 by the limit on wall time; raise it with `wall_time`");
}

#[test]
fn it_goes_through_boxes() {
    fn run() -> Result<f64, Box<dyn StdError + Send + Sync>> {
        let system = BlowUp;
        Ok(system.integrate(START, 3.0, Dop853::default())?.end().coordinate("x")?)
    }
    let error = run().unwrap_err();
    assert!(matches!(error.downcast_ref(), Some(Error::Unfinished(_))), "{error}");
}

#[test]
fn the_caller_cancels_without_an_error() {
    let after = |steps: usize| {
        move |now: Progress| {
            if now.steps == steps { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }
    };
    let path = BlowUp.motion(START).on_progress(after(5)).to(3.0).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }) && !path.ending().is_failure());
    assert_eq!(path.steps().count(), 6);
    let phase = BlowUp.phase_state(&START);
    let path = BlowUp.motion_in_momenta(phase).on_progress(after(5)).to(3.0).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }));
    // Who only looks on gets the error.
    let error = BlowUp.motion(START).on_progress(after(usize::MAX)).to(3.0).unwrap_err();
    assert!(matches!(error, Error::Unfinished(_)), "{error}");
}

fn stiffness(spring: &Spring<f64>, method: impl Method<Spring<f64>>) -> Option<f64> {
    let path = spring.motion(START).by(method).towards(1e9).expect("a start");
    match *path.ending() {
        Ending::StepLimit { pace, .. } => pace.stiffness,
        ref other => panic!("{other}"),
    }
}

/// The eigenvalues of x'' = −k x − c x' are (−c ± √(c² − 4k))/2: the fastest is what is found.
#[test]
fn a_stiff_problem_is_told_by_its_fastest_rate() {
    for (k, c, rate) in [(1.0, 1e3, 1e3), (1e4, 1e5, 1e5), (1e12, 2e6, 1e6), (1.0, 1e9, 1e9)] {
        let spring = spring(k, c);
        for found in [
            stiffness(&spring, Dopri5::with_tolerance(1e-5).max_steps(5000)),
            stiffness(&spring, Dop853::with_tolerance(1e-6).max_steps(5000)),
        ] {
            assert!(found.is_some_and(|found| (found / rate - 1.0).abs() < 0.02), "{found:?}, not {rate}");
        }
    }
    let said = spring(1.0, 1e3).integrate(START, 1e9, limited(5000)).unwrap_err().to_string();
    assert!(said.contains("after 5000 steps, the limit: the problem looks stiff"), "{said}");
    assert!(said.contains("grows or dies at a rate of 1.0e3, which keeps steps short"), "{said}");
}

/// Fast vibrations that the tolerance makes the method follow, slow motions, and steps that the caller keeps short.
#[test]
fn what_is_not_stiff_is_not_called_so() {
    for (k, c) in [(1.0, 0.0), (1e4, 0.0), (1e8, 0.0), (1e8, 1.0), (1.0, 1.0)] {
        let spring = spring(k, c);
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
            for steps in [50, 400] {
                let found = [
                    stiffness(&spring, Dopri5::with_tolerance(tolerance).max_steps(steps)),
                    stiffness(&spring, Dop853::with_tolerance(tolerance).max_steps(steps)),
                ];
                assert_eq!(found, [None; 2], "k = {k:e}, c = {c}, {tolerance:e}, {steps} steps");
            }
        }
    }
    let slow = Dop853::default().max_step(1e-4).max_steps(5000);
    assert_eq!(stiffness(&spring(1.0, 1e3), slow), None);
}

/// Alone, one of many, and on lanes: the same said of the same motion.
#[cfg(feature = "thorough")]
#[test]
fn members_of_an_ensemble_say_the_same() {
    let member = |k: usize| (Spring { f: 0.0, ..spring(1.0, 10_f64.powi(k as i32)) }, START);
    let method = Dop853::with_tolerance(1e-6).max_steps(2000);
    let on_lanes = Ensemble::from_fn(7, member).integrate_on_lanes(1e9, method).unwrap();
    let one_by_one = Ensemble::from_fn(7, member).integrate(1e9, method).unwrap();
    for (k, (a, b)) in on_lanes.members().iter().zip(one_by_one.members()).enumerate() {
        let (system, start) = member(k);
        let alone = system.motion(start).by(method).towards(1e9).unwrap();
        let Ending::StepLimit { pace, .. } = *alone.ending() else { panic!("{}", alone.ending()) };
        let stiffness = pace.stiffness;
        assert!(stiffness.is_some() || k < 3, "c = 1e{k}");
        for member in [a, b] {
            let arrival = member.arrival().unwrap();
            let Ending::StepLimit { pace, .. } = arrival.ending else { panic!("{member}") };
            assert_eq!(
                pace.stiffness.map(|rate| format!("{rate:.1e}")),
                stiffness.map(|rate| format!("{rate:.1e}"))
            );
        }
    }
}

fn forced<P: Method<Spring<f64>>>(s: f64, method: P) -> (usize, Ending) {
    let system = Spring { s, ..spring(1.0, 0.0) };
    let path = system.motion(State::at_rest([1.0]).at_time(s)).by(method).towards(s + 3.0).expect("a start");
    (path.statistics().accepted + path.statistics().rejected, path.ending().clone())
}

/// The same motion, counted from near and from far. Where that takes three times the steps, the time is to blame; and only where
/// the force, whose rate is at most 1, changes the velocity within one rounding of the time by half the tolerance.
#[test]
fn a_time_too_coarse_for_the_tolerance_is_said() {
    fn check<P: Method<Spring<f64>>>(tolerance: f64, method: impl Fn(usize) -> P, blamed: &mut usize) {
        let (near, _) = forced(0.0, method(1000));
        for s in [0.0, 1e3, 1e6, 1e8, 1.7e9, 1e11] {
            let (steps, ending) = forced(s, method(1000));
            let (_, early) = forced(s, method(if steps < 1000 { 3 * steps / 4 } else { 1000 }));
            let Ending::StepLimit { pace, .. } = early else { panic!("{early}") };
            match pace.time_apart {
                None => assert!(steps < 3 * near, "{steps} for {near} at {s:e}: {ending}"),
                Some(apart) => {
                    *blamed += 1;
                    // A mean over coordinate and velocity.
                    let lost = apart * pace.step.unwrap() / tolerance / 2.0_f64.sqrt();
                    assert!(lost >= 0.5, "{lost} at {s:e}, {steps} for {near}");
                    assert_eq!(apart, (s + 1.0).next_up() - (s + 1.0));
                    let said = early.to_string();
                    assert!(said.contains("count the time from nearby, or allow a larger error"), "{said}");
                }
            }
        }
    }
    let mut blamed = 0;
    for tolerance in [1e-6, 1e-9, 1e-11, 1e-12, 1e-13] {
        check(tolerance, |steps| Dop853::with_tolerance(tolerance).max_steps(steps), &mut blamed);
        check(tolerance, |steps| Dopri5::with_tolerance(tolerance).max_steps(steps), &mut blamed);
    }
    assert!(blamed >= 5, "{blamed}");
}

/// Friction that sticks, and a spiral into the centre: raising the limit does not help.
#[cfg(feature = "thorough")]
#[test]
fn steps_that_only_shrink_are_not_asked_for_more() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - x^2/2)]
    #[dissipation(mu*abs(x_dot))]
    struct Dry {
        mu: f64,
    }
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian((x_dot^2 + y_dot^2)/2 + 1/sqrt(x^2 + y^2))]
    #[dissipation(c/2*(x_dot^2 + y_dot^2))]
    struct Spiral {
        c: f64,
    }
    let dry = Dry { mu: 0.3 }.integrate(State::new([1.0], [-0.1]), 20.0, limited(2000)).unwrap_err();
    let start = State::new([1.0, 0.0], [0.0, 1.0]);
    let spiral = Spiral { c: 0.2 }.integrate(start, 30.0, limited(5000)).unwrap_err();
    let series = Spiral { c: 0.2 }.integrate(start, 30.0, Taylor::default().max_steps(2000)).unwrap_err();
    for said in [dry.to_string(), spiral.to_string(), series.to_string()] {
        assert!(
            said.contains(
                "unless steps only shrink: then the motion falls into a singularity, or forces jump"
            ),
            "{said}"
        );
    }
}
