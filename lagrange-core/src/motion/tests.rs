use core::ops::ControlFlow;
use std::time::Duration;

use crate::error::Ending;
use crate::fixtures::{
    GRAVITY, Mechanism, dependent_on_the_manifold, free, oscillator, plane_pendulum, rolling_sphere,
    spherical_pendulum,
};
use crate::motion::Pair;
use crate::motion::{Method, Progress};
use crate::prelude::*;
use crate::solution::Sample;

type Pendulum = Mechanism<3, 1, 1>;

fn close(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a} is not {b} to {relative}");
}

#[test]
fn a_sphere_rolls_down_an_incline() {
    let sphere = rolling_sphere();
    let g = GRAVITY * 0.3_f64.sin();
    let path = sphere.integrate(State::at_rest([0.0, 0.0]), 3.0, Dop853::with_tolerance(1e-12)).unwrap();
    let end = path.end();
    close(end.coordinate("x").unwrap(), 0.5 * 5.0 / 7.0 * g * 9.0, 1e-12);
    close(end.velocity("y").unwrap(), 5.0 / 7.0 * g * 3.0 / 0.1, 1e-12);
    close(end.acceleration("x").unwrap(), 5.0 / 7.0 * g, 1e-14);
    close(end.multiplier("c0").unwrap(), -2.0 / 7.0 * 2.0 * g, 1e-14);
    close(end.constraint_force("y").unwrap(), 0.1 * 2.0 / 7.0 * 2.0 * g, 1e-14);
    assert_eq!(*path.ending(), Ending::Complete { time: 3.0 });
    assert!(path.multipliers_are_unique());
}

fn starts() -> [State<f64, 3>; 4] {
    [
        State::new([0.6, 0.0, -0.8], [0.0, 1.0, 0.0]),
        State::new([0.0, 1.0, 0.0], [0.5, 0.0, 0.0]),
        State::new([0.0, 0.6, 0.8], [0.3, 0.4, -0.3]),
        State::new([0.28, 0.0, -0.96], [0.0, 6.0, 0.0]),
    ]
}

/// The largest |Φ| and |Φ̇|, as fractions of the squared length and of length times speed.
fn off_constraints<'a>(pendulum: &Pendulum, samples: impl Iterator<Item = Sample<&'a Pendulum>>) -> f64 {
    samples.fold(0.0, |most, sample| {
        let s = sample.state();
        let phi = pendulum.constraint_residual(s)[0].abs();
        let rate = pendulum.constraint_rate(s)[0].abs() / s.v.norm().max(1.0);
        most.max(phi).max(rate)
    })
}

fn drift(path: &Trajectory<&Pendulum>) -> (f64, f64) {
    let energy = |s: &State<f64, 3>| 0.5 * s.v.norm_squared() + GRAVITY * s.q[2];
    let moment = |s: &State<f64, 3>| s.q[0] * s.v[1] - s.q[1] * s.v[0];
    let start = path.start();
    let (e, l) = (energy(start.state()), moment(start.state()));
    path.steps().fold((0.0, 0.0), |(de, dl), sample| {
        let s = sample.state();
        (f64::max(de, (energy(s) - e).abs() / GRAVITY), f64::max(dl, (moment(s) - l).abs()))
    })
}

fn swing(method: impl Method<Pendulum> + Copy, bound: f64) {
    let pendulum = spherical_pendulum();
    for start in starts() {
        let path = pendulum.integrate(start, 100.0, method).unwrap();
        assert!(path.ending().is_complete(), "{}", path.ending());
        let (at_steps, between) =
            (off_constraints(&pendulum, path.steps()), off_constraints(&pendulum, path.samples(20_001)));
        let (energy, moment) = drift(&path);
        assert!(at_steps < 1e-12, "{at_steps:e} off at the steps");
        assert!(between < 1e-9, "{between:e} off between the steps");
        assert!(energy < bound && moment < bound, "energy drifts by {energy:e}, momentum by {moment:e}");
    }
}

#[test]
fn dop853_keeps_a_spherical_pendulum_on_its_sphere() {
    swing(Dop853::with_tolerance(1e-10), 2e-8);
    swing(Dop853::with_tolerance(1e-12), 1e-10);
}

#[test]
fn dopri5_keeps_a_spherical_pendulum_on_its_sphere() {
    swing(Dopri5::with_tolerance(1e-10), 1e-7);
}

/// A system, and its exact motion from t = 0 on as (q, v).
type Solved = (Mechanism<1, 0, 0>, fn(f64) -> (f64, f64));

fn solved() -> [Solved; 2] {
    [
        (oscillator(), |t| (t.cos(), -t.sin())),
        // Nonlinear, and explicitly dependent on time.
        (free(|s| [3.0 * s.q[0].powi(2) + 3.0 / (1.0 + s.t).powi(4)]), |t| {
            ((1.0 + t).powi(-2), -2.0 * (1.0 + t).powi(-3))
        }),
    ]
}

/// Mean slope of log error over log step in four halvings: at the end, and of the largest error in between.
fn slopes<P: Method<Mechanism<1, 0, 0>>>(
    (system, exact): Solved,
    method: impl Fn(f64) -> P,
    coarsest: f64,
) -> (f64, f64) {
    let errors = |h: f64| {
        let (q, v) = exact(0.0);
        let path = system.integrate(State::new([q], [v]), 8.0, method(h)).unwrap();
        let error = |s: &Sample<&Mechanism<1, 0, 0>>| {
            let (q, v) = exact(s.time());
            (s.state().q[0] - q).hypot(s.state().v[0] - v)
        };
        (error(&path.end()), path.samples(1000).map(|s| error(&s)).fold(0.0, f64::max))
    };
    let (coarse, fine) = (errors(coarsest), errors(coarsest / 16.0));
    ((coarse.0 / fine.0).log2() / 4.0, (coarse.1 / fine.1).log2() / 4.0)
}

#[test]
fn the_orders_of_convergence_are_five_and_eight() {
    for (system, steps) in solved().into_iter().zip([[0.5, 2.0], [0.25, 0.5]]) {
        let (end, between) = slopes(system, |h| Dopri5::default().fixed_step(h), steps[0]);
        assert!(end >= 4.9 && between >= 4.5, "{end}, {between}");
        let (end, between) = slopes(system, |h| Dop853::default().fixed_step(h), steps[1]);
        assert!(end >= 7.7 && between >= 7.5, "{end}, {between}");
    }
}

fn check_coefficients<P: Pair>() {
    let sum = |row: &[(usize, f64)]| row.iter().map(|(_, c)| c).sum::<f64>();
    for (row, node) in P::STAGES.iter().zip(&P::NODES[1..]) {
        assert!((sum(row) - node).abs() < 1e-13);
    }
    for (row, node) in P::INTERPOLATION_STAGES.iter().zip(P::NODES.iter().skip(P::STAGES.len() + 2)) {
        assert!((sum(row) - node).abs() < 1e-13);
    }
    // Quadrature of a power k < order: Σ bᵢ cᵢᵏ = 1/(k + 1). Rows of the error estimates and of the interpolant sum to
    // zero.
    for k in 0..P::ORDER as i32 {
        let moment: f64 = P::WEIGHTS.iter().map(|(i, b)| b * P::NODES[*i].powi(k)).sum();
        assert!((moment - 1.0 / f64::from(k + 1)).abs() < 1e-13, "{k}: {moment}");
    }
    for row in [P::ERROR, P::LOWER_ERROR].into_iter().chain(P::INTERPOLATION.iter().copied()) {
        assert!(sum(row).abs() < 1e-12, "{}", sum(row));
    }
}

#[test]
fn the_coefficients_satisfy_the_quadrature_conditions() {
    check_coefficients::<super::DormandPrince54>();
    check_coefficients::<super::DormandPrince853>();
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(1/2 * (x_dot^2 - k*x^2))]
struct Spring<T> {
    k: T,
}

#[test]
fn single_precision_is_integrated_to_its_round_off() {
    let spring = Spring { k: 4.0_f32 };
    let path = spring.integrate(State::new([1.0], [0.0]), 10.0, Dop853::default()).unwrap();
    assert!(path.ending().is_complete());
    assert!((path.end().coordinate("x").unwrap() - 20.0_f32.cos()).abs() < 2e-5);
}

#[test]
fn the_continuous_extension_meets_the_steps() {
    let pendulum = spherical_pendulum();
    let path = pendulum.integrate(starts()[0], 5.0, Dop853::with_tolerance(1e-6)).unwrap();
    for step in path.steps() {
        let (state, t) = (step.state(), step.time());
        assert_eq!(path.at(t).unwrap().state(), state);
        for near in [t - 1e-13, t + 1e-13] {
            if let Ok(sample) = path.at(near) {
                assert!((sample.state().q - state.q).norm() < 1e-11);
                assert!((sample.state().v - state.v).norm() < 1e-11);
            }
        }
    }
}

#[test]
fn the_derivative_of_the_continuous_extension_is_the_velocity() {
    let system = oscillator();
    let path = system.integrate(State::new([1.0], [0.0]), 10.0, Dop853::with_tolerance(1e-10)).unwrap();
    for i in 1..100 {
        let (t, h) = (0.0999 * f64::from(i), 1e-4);
        let x = |t| path.at(t).unwrap().coordinate("x").unwrap();
        let slope = (x(t + h) - x(t - h)) / (2.0 * h);
        assert!((slope - path.at(t).unwrap().velocity("x").unwrap()).abs() < 1e-7);
    }
}

#[test]
fn the_error_follows_the_tolerance() {
    let error = |tolerance: f64| {
        let system = oscillator();
        let path =
            system.integrate(State::new([1.0], [0.0]), 20.0, Dop853::with_tolerance(tolerance)).unwrap();
        (path.end().coordinate("x").unwrap() - 20.0_f64.cos()).abs()
    };
    assert!(error(1e-4) < 1e-3 && error(1e-8) < 1e-7 && error(1e-12) < 1e-11);
    assert!(error(1e-4) > error(1e-12));
}

#[test]
fn a_blow_up_ends_with_the_coordinate_named() {
    // x = 1/(1 − t)².
    let system = free::<1>(|s| [6.0 * s.q[0] * s.q[0]]);
    for path in [
        system.motion(State::new([1.0], [2.0])).towards(3.0).unwrap(),
        system.motion(State::new([1.0], [2.0])).by(Dopri5::default()).towards(3.0).unwrap(),
    ] {
        assert!(!path.ending().is_complete());
        assert!((path.ending().time() - 1.0).abs() < 1e-6, "{}", path.ending());
        assert!(std::format!("{}", path.ending()).contains("`x"), "{}", path.ending());
        let half = path.at(0.5).unwrap().coordinate("x").unwrap();
        assert!((half - 4.0).abs() < 1e-6, "what was computed before is kept: {half}");
    }
}

#[test]
fn equations_that_become_undefined_end_the_motion() {
    // A fall from 1 to 0 with force −1/√x, which is not a number below 0.
    let system = free::<1>(|s| [-1.0 / s.q[0].sqrt()]);
    let path = system.motion(State::new([1.0], [-1.0])).towards(3.0).unwrap();
    assert!(!path.ending().is_complete(), "{}", path.ending());
    let end = path.end().coordinate("x").unwrap();
    assert!((0.0..1e-3).contains(&end), "{end}");
    let message = std::format!("{}", path.ending());
    assert!(message.contains("`x"), "{message}");
}

#[test]
fn a_mass_that_vanishes_ends_the_motion() {
    let system = Mechanism { mass: |s| [[if s.t < 0.5 { 1.0 } else { 0.0 }]], ..free(|_| [0.0]) };
    let path = system.motion(State::new([1.0], [1.0])).by(Dopri5::default()).towards(1.0).unwrap();
    let Ending::Singular { time, error: Error::Singular { coordinates, .. } } = path.ending() else {
        panic!("{}", path.ending());
    };
    assert_eq!(coordinates.as_slice(), ["x"]);
    assert!((time - 0.5).abs() < 1e-12 && path.at(0.4).is_ok());
}

#[test]
fn constraints_that_come_to_contradict_end_the_motion() {
    // From t = 0.5 on, the second constraint demands another acceleration than the first.
    let system = Mechanism::<2, 2, 2> {
        mass: crate::fixtures::identity,
        forcing: |_| [0.0; 2],
        residual: |s| [s.q[0]; 2],
        rate: |s| [s.v[0]; 2],
        jacobian: |_| [[1.0, 0.0]; 2],
        bias: |s| [0.0, if s.t < 0.5 { 0.0 } else { 1.0 }],
    };
    let path = system.motion(State::new([0.0, 0.0], [0.0, 1.0])).towards(1.0).unwrap();
    let Ending::Contradictory { time, error: Error::Contradictory { constraint: "c0" | "c1", .. } } =
        path.ending()
    else {
        panic!("{}", path.ending());
    };
    assert!((time - 0.5).abs() < 1e-12);
}

/// Each error maps to its ending; errors other than those of singular equations are not `Singular`.
#[test]
fn each_error_is_the_ending_that_says_it() {
    let (time, constraint) = (2.0, "rod");
    let of = |error: Error| Ending::of(error, time);
    let row = crate::names::Row::Constraint(constraint);
    assert_eq!(of(Error::EquationsNotFinite { row, time: 3.0 }), Ending::NotFinite { time, row });
    let error = Error::NotProjected { constraint: row, residual: 1.0, iterations: 3, time: 3.0 };
    assert_eq!(of(error.clone()), Ending::OffConstraints { time, error });
    let error = Error::Contradictory { constraint, time: 3.0 };
    assert_eq!(of(error.clone()), Ending::Contradictory { time, error });
    let coordinates = crate::names::Names::default();
    for error in
        [Error::Singular { coordinates, time: 3.0 }, Error::VelocityUndetermined { coordinates, time: 3.0 }]
    {
        assert_eq!(of(error.clone()), Ending::Singular { time, error });
    }
    for error in [
        Error::MomentumNotReached { coordinate: "x", residual: 1.0, iterations: 3, time: 3.0 },
        Error::EigenvaluesNotFound,
    ] {
        assert_eq!(of(error.clone()), Ending::Unsolved { time, error });
    }
}

#[test]
fn constraints_that_part_end_the_motion() {
    // A point on the circle of radius √(1 − t), which vanishes at t = 1.
    let system = Mechanism::<2, 1, 1> {
        mass: crate::fixtures::identity,
        forcing: |_| [0.0; 2],
        residual: |s| [0.5 * (s.q.norm_squared() - 1.0 + s.t)],
        rate: |s| [s.q.dot(&s.v) + 0.5],
        jacobian: |s| [s.q.into()],
        bias: |s| [s.v.norm_squared()],
    };
    let path = system.motion(State::new([1.0, 0.0], [-0.5, 0.0])).towards(2.0).unwrap();
    assert!(!path.ending().is_complete());
    assert!((path.end().time() - 1.0).abs() < 1e-6, "{}", path.ending());
}

#[test]
fn limits_end_the_motion_and_keep_it() {
    let system = oscillator();
    let start = State::new([1.0], [0.0]);
    let path = system.motion(start).by(Dopri5::default().max_steps(50)).towards(1e6).unwrap();
    assert!(matches!(path.ending(), Ending::StepLimit { steps: 50, .. }), "{}", path.ending());
    assert!(path.end().time() > 0.5 && path.steps().count() == path.statistics().accepted + 1);
    let method = Dopri5::default().wall_time(Duration::from_millis(20)).max_steps(usize::MAX);
    let path = system.motion(start).by(method).towards(1e9).unwrap();
    assert!(matches!(path.ending(), Ending::WallTimeLimit { .. }), "{}", path.ending());
    let mut seen = 0;
    let watch = |progress: Progress| {
        seen += 1;
        assert_eq!(progress.steps, seen);
        if progress.time > 2.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let path = system.motion(start).on_progress(watch).to(10.0).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { time } if *time > 2.0 && *time < 10.0));
    let longest = 0.01;
    let path = system.integrate(start, 1.0, Dop853::default().max_step(longest).first_step(1e-3)).unwrap();
    let times: std::vec::Vec<_> = path.steps().map(|s| s.time()).collect();
    assert!(times.windows(2).all(|t| t[1] - t[0] <= longest) && times[1] == 1e-3);
}

/// If the equations are undefined at a time that only the interpolant needs, 7/9 of the step, a shorter step is taken.
/// Without a request for interpolants the step is accepted.
#[test]
fn a_step_whose_interpolant_fails_is_taken_back() {
    let system = free::<1>(|s| [if (s.t - 7.0 / 9.0).abs() < 1e-3 { f64::NAN } else { -s.q[0] }]);
    let (start, method) = (State::new([1.0], [0.0]), Dop853::with_tolerance(1e-6).first_step(1.0));
    let path = system.integrate(start, 3.0, method).unwrap();
    assert!(path.ending().is_complete() && path.statistics().rejected > 0, "{:?}", path.statistics());
    assert_ne!(path.steps().nth(1).unwrap().time(), 1.0);
    assert!(path.samples(100).all(|sample| (sample.state().q[0] - sample.time().cos()).abs() < 1e-5));
    let mut motion = Motion::new(system, start, method).unwrap();
    motion.advance_to(1.0).unwrap();
    assert_eq!((motion.statistics().accepted, motion.statistics().rejected), (1, 0));
    let error = motion.at(0.5).unwrap_err();
    assert!(matches!(error, Error::EquationsNotFinite { .. }), "{error}");
    motion.advance_to(3.0).unwrap();
    assert!((motion.state().q[0] - 3_f64.cos()).abs() < 1e-5);
}

#[test]
fn wrong_settings_are_refused() {
    let system = oscillator();
    let start = State::new([1.0], [0.0]);
    for method in [
        Dop853::with_tolerance(0.0),
        Dop853::default().relative_tolerance(-1.0),
        Dop853::default().absolute_tolerance(f64::NAN),
        Dop853::default().max_step(0.0),
        Dop853::default().first_step(f64::INFINITY),
        Dop853::default().fixed_step(-0.1),
    ] {
        let error = system.integrate(start, 1.0, method).unwrap_err();
        assert!(matches!(error, Error::Setting { .. }), "{error}");
    }
    let error = system.integrate(start, 1.0, Dopri5::with_tolerance(-1.0)).unwrap_err();
    assert_eq!(std::format!("{error}"), "the relative tolerance is -1: it must be positive and finite");
    for end in [f64::NAN, f64::INFINITY] {
        let error = system.integrate(start, end, Dop853::default()).unwrap_err();
        assert!(matches!(error, Error::EndNotFinite { .. }), "{error}");
    }
    let error = system.integrate(State::new([1.0], [f64::NAN]), 1.0, Dop853::default()).unwrap_err();
    assert!(std::format!("{error}").starts_with("`x_dot` is NaN"), "{error}");
    let error = system.integrate(start.at_time(f64::NAN), 1.0, Dop853::default()).unwrap_err();
    assert!(std::format!("{error}").starts_with("`t` is NaN"), "{error}");
}

#[test]
fn a_motion_of_no_length_is_its_start() {
    let system = oscillator();
    let path = system.integrate(State::new([1.0], [2.0]), 0.0, Dop853::default()).unwrap();
    assert!(path.ending().is_complete() && path.steps().count() == 1);
    assert_eq!(path.end().velocity("x"), Ok(2.0));
    assert_eq!(path.samples(3).count(), 3);
}

#[test]
fn constraints_that_depend_on_one_another_only_where_they_hold_do_no_harm() {
    let redundant = dependent_on_the_manifold();
    let single = plane_pendulum();
    let start = State::at_rest([0.6, -0.8]);
    let alone = single.integrate(start, 10.0, Dop853::default()).unwrap();
    let path = redundant.integrate(start, 10.0, Dop853::default()).unwrap();
    assert!(path.ending().is_complete(), "{}", path.ending());
    assert!((path.end().state().q - alone.end().state().q).norm() < 1e-8);
    assert!(path.statistics().accepted < 2 * alone.statistics().accepted);
    assert!(!path.multipliers_are_unique());
    let by_fixed_steps = redundant.integrate(start, 1.0, RungeKutta4::with_step(0.01)).unwrap();
    assert!(!by_fixed_steps.multipliers_are_unique());
}
