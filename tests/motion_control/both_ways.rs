//! Motions in momenta, on lanes and on constraints: far from zero, in both directions of time, and into a hole.

use lagrange_core::{Ending, motion::Adjustment, nalgebra::Const, prelude::*};
use lagrange_systems::DoublePendulum;

use crate::spring_of;
use crate::steered::into_a_hole;
use crate::times::far::{FAR, Motion, TOLERANCE, check, motion};
use crate::times::{allowed, exact};

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

/// Without velocities and time in the forces, t → −t gives a motion: to the last bit, as all of it is symmetric.
#[test]
fn backwards_is_forwards_with_velocities_and_times_of_the_other_sign() {
    let pendulum = DoublePendulum { m: [1.0; 2], l: [1.0; 2], g: 9.81 };
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
    let off: Adjustment<f64, Const<2>> =
        Adjustment { q: end.state().q - start.q, v: end.state().v - start.v };
    assert!(off.largest_coordinate_change() < 1e-9 && off.largest_velocity_change() < 1e-9, "{off}");
    // Both ways are the same motion in between.
    for sample in there.samples(50) {
        let other = back.at(sample.time()).unwrap();
        assert!((sample.state().q - other.state().q).norm() < 1e-8);
        assert!((sample.state().v - other.state().v).norm() < 1e-8);
    }
}

#[test]
fn there_and_back_again_in_momenta_is_the_start() {
    let (start, method) = (WINCH.phase_state(&hanging()), Dop853::with_tolerance(1e-11));
    let there = WINCH.motion_in_momenta(start).by(method).to(5.0).unwrap();
    let back = WINCH.motion_in_momenta(WINCH.phase_state(there.end().state())).by(method).to(0.0).unwrap();
    let end = WINCH.phase_state(back.end().state());
    assert!((end.q - start.q).norm() < 1e-8 && (end.p - start.p).norm() < 1e-8);
    assert!(back.steps().map(|step| step.time()).is_sorted_by(|a, b| a > b));
}

/// Members of one ensemble may go either way.
#[test]
fn lanes_go_both_ways() {
    let member = |k: usize| {
        let start = State::new([0.1 * k as f64], [0.3]);
        (spring_of(1.0 + k as f64), start.at_time(if k.is_multiple_of(3) { 0.0 } else { 4.0 }))
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
fn motions_in_momenta_far_from_zero_are_those_from_zero() {
    for case in FAR {
        let (start, omega, end) = case;
        let (spring, from) = (spring_of(omega), PhaseState::new([1.0], [0.0]).at_time(start));
        check(case, &motion!(spring.motion_in_momenta(from).to(end)));
    }
}

/// Members that start at different times.
#[test]
fn motions_on_lanes_far_from_zero_are_those_from_zero() {
    let end = 1.7e9 + 1e-3;
    let member = |index: usize| {
        let start = 1.7e9 + 1e-4 * (index % 7) as f64;
        (1e3 * (1 + 9 * index) as f64, State::at_rest([1.0]).at_time(start))
    };
    let ensemble = || Ensemble::from_fn(12, |index| (spring_of(member(index).0), member(index).1));
    let outcome = ensemble().integrate_on_lanes(end, Dop853::default()).unwrap();
    let alone = ensemble().integrate(end, Dop853::default()).unwrap();
    // Their fingerprints say which of the two they are.
    assert!(outcome.members().iter().map(|x| &x.result).eq(alone.members().iter().map(|x| &x.result)));
    assert_eq!(outcome.completed().count(), 12);
    for arrived in outcome.members() {
        let (omega, start) = member(arrived.index);
        let arrival = arrived.arrival().unwrap();
        let off = arrival.state.q[0] - exact(omega, start.t, end);
        assert!(off.abs() <= allowed(arrival.statistics.accepted, TOLERANCE), "{arrived}: off by {off:e}");
    }
    for method in [Dop853::default().max_step(1e-8), Dop853::default().fixed_step(1e-8)] {
        let one = [(spring_of(1.0), State::at_rest([1.0]).at_time(1.7e9))];
        let outcome = Ensemble::new(&one).integrate_on_lanes(1.7e9 + 1.0, method).unwrap();
        let arrival = outcome.get(0).unwrap().arrival().unwrap();
        assert_eq!(arrival.ending, Ending::TimeTooCoarse { time: 1.7e9, step: 1e-8 });
    }
}

/// On a lane as alone.
#[test]
fn a_lane_steps_into_a_hole_as_a_motion_does() {
    let ([whole, holed], start, at, method) = into_a_hole();
    let ensemble = || Ensemble::from_fn(5, |index| (if index == 1 { holed } else { whole }, start));
    for (end, is_complete) in [(0.5, true), (1.0, false)] {
        let on_lanes = ensemble().integrate_on_lanes(end, method).unwrap();
        let one_by_one = ensemble().integrate(end, method).unwrap();
        for (index, (lane, alone)) in on_lanes.members().iter().zip(one_by_one.members()).enumerate() {
            assert_eq!(lane.result, alone.result);
            let arrival = lane.arrival().unwrap();
            assert_eq!(arrival.ending.is_complete(), index != 1 || is_complete, "{}", arrival.ending);
            assert!(index != 1 || arrival.state == at);
        }
    }
}
