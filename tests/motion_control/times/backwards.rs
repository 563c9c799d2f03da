//! An end before the start: the same motion, the other way.

use lagrange_core::{
    Ending, Method,
    motion::{Adjustment, Progress},
    prelude::*,
};

use crate::times::{Spring, allowed, exact};

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*g*cos(a) + g*cos(b))]
struct DoublePendulum<T> {
    g: T,
}

/// Time enters, and so do velocities: what is not the same in both directions.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian(1/2 * (x_dot^2 + y_dot^2) - g*y)]
#[constraint(rod: 1/2 * (x^2 + y^2 - (l + rate*t)^2) = 0)]
#[dissipation(c/2 * (x_dot^2 + y_dot^2))]
struct Winch<T> {
    g: T,
    l: T,
    rate: T,
    c: T,
}

const WINCH: Winch<f64> = Winch { g: 9.81, l: 1.0, rate: 0.05, c: 0.1 };

fn hanging() -> State<f64, 2> {
    WINCH.make_consistent(&State::new([0.6, -0.8], [1.0, 0.5])).expect("a state nearby").0
}

fn checked_backwards(method: impl Method<Spring<f64>> + Copy, bound: impl Fn(usize) -> f64) {
    for (start, omega, end) in
        [(0.0, 1.0, -20.0), (1.7e9, 1e3, 1.7e9 - 0.125), (-3.0, 1e3, -3.5), (2.0, 1e-12, -2e13)]
    {
        let spring = Spring { omega };
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
    let spring = Spring { omega: 1.0 };
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

/// Without velocities and time in the forces, t → −t gives a motion: to the last bit, as all of it is symmetric.
#[test]
fn backwards_is_forwards_with_velocities_and_times_of_the_other_sign() {
    let pendulum = DoublePendulum { g: 9.81 };
    let mirrored = |s: &State<f64, 2>| State { t: -s.t, q: s.q, v: -s.v };
    for t in [0.0, 1.7e9, -0.3] {
        for method in
            [Dop853::default(), Dop853::default().max_step(0.01), Dop853::default().fixed_step(0.003)]
        {
            let start = State::new([1.0, -2.0], [0.3, 0.1]).at_time(t);
            let there = pendulum.integrate(start, t + 3.0, method).unwrap();
            let back = pendulum.integrate(mirrored(&start), -(t + 3.0), method).unwrap();
            assert_eq!(there.statistics(), back.statistics());
            assert!(there.steps().zip(back.steps()).all(|(a, b)| *a.state() == mirrored(b.state())));
            assert!(there.samples(99).zip(back.samples(99)).all(|(a, b)| *a.state() == mirrored(b.state())));
        }
    }
}

#[test]
fn there_and_back_again_is_the_start() {
    let (start, method) = (hanging(), Dop853::with_tolerance(1e-12));
    let there = WINCH.integrate(start, 5.0, method).unwrap();
    let back = WINCH.integrate(*there.end().state(), 0.0, method).unwrap();
    assert!(there.ending().is_complete() && back.ending().is_complete());
    let end = back.end();
    let off = Adjustment { q: end.state().q - start.q, v: end.state().v - start.v };
    assert!(off.largest_coordinate_change() < 1e-9 && off.largest_velocity_change() < 1e-9, "{off}");
    // Both ways are the same motion in between.
    for sample in there.samples(50) {
        let other = back.at(sample.time()).unwrap();
        assert!((sample.state().q - other.state().q).norm() < 1e-8);
        assert!((sample.state().v - other.state().v).norm() < 1e-8);
    }
}

#[test]
fn so_it_is_in_momenta() {
    let (start, method) = (WINCH.phase_state(&hanging()), Dop853::with_tolerance(1e-11));
    let there = WINCH.motion_in_momenta(start).by(method).to(5.0).unwrap();
    let back = WINCH.motion_in_momenta(WINCH.phase_state(there.end().state())).by(method).to(0.0).unwrap();
    let end = WINCH.phase_state(back.end().state());
    assert!((end.q - start.q).norm() < 1e-8 && (end.p - start.p).norm() < 1e-8);
    assert!(back.steps().map(|step| step.time()).is_sorted_by(|a, b| a > b));
}

#[test]
fn single_precision_goes_back() {
    let spring = Spring { omega: 1.0_f32 };
    let path = spring.integrate(State::at_rest([1.0]), -10.0, Dopri5::with_tolerance(1e-6)).unwrap();
    assert!((path.end().state().q[0] - 10_f32.cos()).abs() < 1e-4);
}

/// Members of one ensemble may go either way.
#[test]
fn lanes_go_both_ways() {
    let member = |k: usize| {
        let start = State::new([0.1 * k as f64, 1.0], [0.0, 0.3]);
        (DoublePendulum { g: 9.81 }, start.at_time(if k.is_multiple_of(3) { 0.0 } else { 4.0 }))
    };
    let ensemble = || Ensemble::from_fn(23, member);
    let lanes = ensemble().integrate_on_lanes(2.0, Dop853::with_tolerance(1e-11)).unwrap();
    let alone = ensemble().integrate(2.0, Dop853::with_tolerance(1e-11)).unwrap();
    assert_eq!((lanes.completed().count(), alone.completed().count()), (23, 23));
    for (a, b) in lanes.members().iter().zip(alone.members()) {
        let (a, b) = (a.arrival().unwrap(), b.arrival().unwrap());
        assert!((a.state.q - b.state.q).norm() < 1e-8 && (a.state.v - b.state.v).norm() < 1e-8);
    }
}

#[test]
fn what_stops_a_motion_stops_it_backwards() {
    let spring = Spring { omega: 1.0 };
    let path =
        spring.motion(State::at_rest([1.0])).by(Dopri5::default().max_steps(50)).towards(-1e9).unwrap();
    assert!(
        matches!(path.ending(), Ending::StepLimit { time, steps: 50, .. } if *time < -1.0),
        "{}",
        path.ending()
    );
    let watch = |progress: Progress| match progress.time < -20.0 {
        true => core::ops::ControlFlow::Break(()),
        false => core::ops::ControlFlow::Continue(()),
    };
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
