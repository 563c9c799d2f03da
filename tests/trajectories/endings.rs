//! What does not reach its end is an error, and says why.

use std::error::Error as StdError;
use std::ops::ControlFlow;
use std::time::Duration;

use lagrange_core::prelude::*;
use lagrange_core::{Ending, Method, Progress};

/// A spring with friction: x'' = −k (x − sin t) − c x'. Where c or √k are large, x soon follows sin t slowly, and fast
/// motions are there in the equations only.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k/2 * (x - sin(t))^2)]
#[force(x: -c*x_dot)]
struct Spring {
    k: f64,
    c: f64,
}

/// x'' = 6 x², so x = 1/(1 − t)².
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 + 2*x^3)]
struct BlowUp;

const START: State<f64, 1> = State {
    t: 0.0,
    q: lagrange_core::nalgebra::SVector::<f64, 1>::new(1.0),
    v: lagrange_core::nalgebra::SVector::<f64, 1>::new(2.0),
};

fn limited(steps: usize) -> Dop853 {
    Dop853::default().max_steps(steps)
}

/// The end that was asked for, and nothing else.
#[test]
fn a_motion_that_stops_early_is_an_error() {
    let spring = Spring { k: 1.0, c: 0.0 };
    let error = spring.integrate(START, 1e6, limited(500)).unwrap_err();
    let Error::Unfinished(ending) = &error else { panic!("{error}") };
    let path = spring.integrate_towards(START, 1e6, limited(500)).unwrap();
    assert_eq!(**ending, *path.ending());
    assert!(
        matches!(**ending, Ending::StepLimit { steps: 500, stiffness: None, time } if time == path.end().time())
    );
    let time = ending.time();
    assert_eq!(
        error.to_string(),
        format!("stopped at t = {time} after 500 steps, the limit; raise it with `max_steps`")
    );
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
            && said.contains("singular nearby, or the tolerance is below the round-off"),
        "{said}"
    );
    let phase = BlowUp.phase_state(&START);
    let said = BlowUp.integrate_hamiltonian(phase, 3.0, Dop853::default()).unwrap_err().to_string();
    assert!(said.starts_with("stopped at t = ") && said.contains("the error of `p(x)`"), "{said}");
    let path = BlowUp.integrate_hamiltonian_towards(phase, 3.0, Dop853::default()).unwrap();
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
fn what_is_wrong_before_the_first_step_is_an_error_of_both() {
    let error = BlowUp.integrate_towards(START, f64::NAN, Dop853::default()).unwrap_err();
    assert!(matches!(error, Error::EndNotFinite { .. }), "{error}");
    let error = BlowUp.integrate_towards(State::new([f64::NAN], [0.0]), 1.0, Dop853::default()).unwrap_err();
    assert!(matches!(error, Error::StateNotFinite { .. }), "{error}");
}

#[test]
fn the_caller_cancels_without_an_error() {
    let after = |steps: usize| {
        move |now: Progress| {
            if now.steps == steps { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }
    };
    let path = BlowUp.integrate_with(START, 3.0, Dop853::default(), after(5)).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }) && !path.ending().is_failure());
    assert_eq!(path.steps().count(), 6);
    let phase = BlowUp.phase_state(&START);
    let path = BlowUp.integrate_hamiltonian_with(phase, 3.0, Dop853::default(), after(5)).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }));
    // Who only looks on gets the error.
    let error = BlowUp.integrate_with(START, 3.0, Dop853::default(), after(usize::MAX)).unwrap_err();
    assert!(matches!(error, Error::Unfinished(_)), "{error}");
}

fn stiffness(spring: &Spring, method: impl Method<Spring, 1, 0>) -> Option<f64> {
    let path = spring.integrate_towards(START, 1e9, method).expect("a start");
    match *path.ending() {
        Ending::StepLimit { stiffness, .. } => stiffness,
        ref other => panic!("{other}"),
    }
}

/// The eigenvalues of x'' = −k x − c x' are (−c ± √(c² − 4k))/2: the fastest is what is found.
#[test]
fn a_stiff_problem_is_told_by_its_fastest_rate() {
    for (k, c, rate) in [(1.0, 1e3, 1e3), (1e4, 1e5, 1e5), (1e12, 2e6, 1e6), (1.0, 1e9, 1e9)] {
        let spring = Spring { k, c };
        for found in [
            stiffness(&spring, Dopri5::with_tolerance(1e-5).max_steps(5000)),
            stiffness(&spring, Dop853::with_tolerance(1e-6).max_steps(5000)),
        ] {
            assert!(found.is_some_and(|found| (found / rate - 1.0).abs() < 0.02), "{found:?}, not {rate}");
        }
    }
    let said = Spring { k: 1.0, c: 1e3 }.integrate(START, 1e9, limited(5000)).unwrap_err().to_string();
    assert!(said.contains("after 5000 steps, the limit: the problem looks stiff"), "{said}");
    assert!(said.contains("grows or dies at a rate of 1.0e3, which keeps steps short"), "{said}");
}

/// Fast vibrations that the tolerance makes the method follow, slow motions, and steps that the caller keeps short.
#[test]
fn what_is_not_stiff_is_not_called_so() {
    for (k, c) in [(1.0, 0.0), (1e4, 0.0), (1e8, 0.0), (1e8, 1.0), (1.0, 1.0)] {
        let spring = Spring { k, c };
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
    assert_eq!(stiffness(&Spring { k: 1.0, c: 1e3 }, slow), None);
}

/// Alone, one of many, and on lanes: the same said of the same motion.
#[test]
fn members_of_an_ensemble_say_the_same() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - x^2/2)]
    #[force(x: -c*x_dot)]
    struct Damped<T> {
        c: T,
    }
    let member = |k: usize| (Damped { c: 10_f64.powi(k as i32) }, START);
    let method = Dop853::with_tolerance(1e-6).max_steps(2000);
    let on_lanes = Ensemble::from_fn(7, member).integrate_on_lanes(1e9, method).unwrap();
    let one_by_one = Ensemble::from_fn(7, member).integrate(1e9, method).unwrap();
    for (k, (a, b)) in on_lanes.members().iter().zip(one_by_one.members()).enumerate() {
        let (system, start) = member(k);
        let alone = system.integrate_towards(start, 1e9, method).unwrap();
        let Ending::StepLimit { stiffness, .. } = *alone.ending() else { panic!("{}", alone.ending()) };
        assert!(stiffness.is_some() || k < 3, "c = 1e{k}");
        for member in [a, b] {
            let arrival = member.arrival().unwrap();
            let Ending::StepLimit { stiffness: found, .. } = arrival.ending else { panic!("{member}") };
            assert_eq!(found.map(|rate| format!("{rate:.1e}")), stiffness.map(|rate| format!("{rate:.1e}")));
        }
    }
}
