//! Runs that are given events: what they record, and where they end.

use lagrange_core::{Dop853, Ending, prelude::*};

use lagrange_systems::LeaningRod;

use crate::SPRING;

/// A uniform ladder of length 2a between a smooth wall and a smooth floor; x and y are its middle.
pub(crate) const LADDER: LeaningRod<f64> = LeaningRod { m: 3.0, a: 2.5, g: 9.81 };

pub(crate) fn leaning(theta: f64) -> State<f64, 3> {
    State::at_rest([2.5 * theta.cos(), 2.5 * theta.sin(), theta])
}

/// The wall stops pushing where sin θ is two thirds of what it was at rest.
#[test]
fn a_ladder_leaves_the_wall_at_two_thirds_of_its_height() {
    for theta in [0.3_f64, 0.8, 1.2, 1.5] {
        let mut leaves = LADDER.event("leaves", |s| s.multiplier("wall")).falling().terminal();
        let method = Dop853::with_tolerance(1e-13);
        let path = LADDER.motion(leaning(theta)).by(method).event(&mut leaves).towards(100.0).unwrap();
        assert!(matches!(path.ending(), Ending::Event { event: "leaves", .. }), "{}", path.ending());
        let angle = path.end().coordinate("theta").unwrap();
        let expected = (2.0 / 3.0 * theta.sin()).asin();
        assert!((angle - expected).abs() < 1e-11, "{angle} instead of {expected}");
        let force = path.end().multiplier("wall").unwrap();
        assert!(force.abs() <= 8.0 * f64::EPSILON * LADDER.m * LADDER.g, "{force:e}");
        // The last state is on the constraints like all others.
        let residual = LADDER.constraint_residual(path.end().state()).norm();
        let rate = LADDER.constraint_rate(path.end().state()).norm();
        assert!(residual < 4e-15 && rate < 4e-14, "{residual:e}, {rate:e}");
        // And the trajectory leads there, and no farther.
        let end = path.ending().time();
        assert_eq!(path.end().time(), end);
        assert!(path.at(end + 1e-6).is_err() && path.at(end - 1e-6).is_ok());
        assert_eq!(path.crossings().len(), 1);
        assert_eq!(path.crossings()[0].state, *path.end().state());
    }
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(sphere: (x^2 + y^2 - a^2)/2 = 0)]
#[observable(push = a * lambda(sphere))]
struct Bead {
    m: f64,
    g: f64,
    a: f64,
}

/// From the top with the speed v, the push ends where cos θ = (2 + v²/(g a))/3.
#[test]
fn a_bead_leaves_the_sphere_where_its_push_ends() {
    let bead = Bead { m: 2.0, g: 9.81, a: 0.7 };
    for speed in [0.05, 0.5, 2.0] {
        let start = State::new([0.0, bead.a], [speed, 0.0]);
        let expected = (2.0 + speed * speed / (bead.g * bead.a)) / 3.0;
        let method = Dop853::with_tolerance(1e-13);
        let check = |end: lagrange_core::Sample<&Bead>| {
            let angle = (end.coordinate("y").unwrap() / bead.a).acos();
            assert!((angle - expected.acos()).abs() < 1e-11, "{angle} instead of {}", expected.acos());
        };
        let mut leaves = bead.event("leaves", |s| s.observable("push")).falling().terminal();
        check(
            bead.motion(start).by(method).event(&mut leaves).towards(10.0).unwrap().finished().unwrap().end(),
        );
        // In (q, p), too.
        let phase = bead.phase_state(&start);
        let mut leaves = bead.event("leaves", |s| s.constraint_force("y")).falling().terminal();
        let path = bead.motion_in_momenta(phase).by(method).event(&mut leaves).towards(10.0).unwrap();
        let end = *path.end().state();
        check(bead.sample(end));
    }
}

#[test]
fn runs_record_count_and_end() {
    let method = Dop853::with_tolerance(1e-12);
    let start = State::at_rest([1.0]);
    let mut zero = SPRING.event("zero", |s| s.state().q[0]);
    let mut turn = SPRING.event("turn", |s| s.velocity("x")).falling().terminal_at(5);
    let path = SPRING.motion(start).by(method).event(&mut zero).event(&mut turn).towards(100.0).unwrap();
    // ẋ = −sin t falls through 0 at 2π, 4π, …: the start is at one.
    assert_eq!((zero.count(), turn.count()), (10, 5));
    assert!((path.ending().time() - 10.0 * std::f64::consts::PI).abs() < 1e-9);
    assert!(!path.ending().is_failure() && !path.ending().is_complete());
    assert_eq!(path.ending().to_string(), format!("ended by the event `turn` at t = {}", path.end().time()));
    let names: Vec<&str> = path.crossings().iter().map(|crossing| crossing.event).collect();
    assert_eq!(names, ["zero", "zero", "turn"].repeat(5));
    for crossing in path.crossings() {
        let at = path.at(crossing.state.t).unwrap();
        assert!((at.state().q - crossing.state.q).norm() < 1e-14);
    }
    assert_eq!(path.steps().last().unwrap().time(), path.ending().time());
    assert_eq!(path.into_owned().crossings().len(), 15);
    // Without an end by an event, all is as without events.
    let mut zero = SPRING.event("zero", |s| s.state().q[0]);
    let path = SPRING.motion(start).by(method).event(&mut zero).towards(100.0).unwrap();
    let plain = SPRING.integrate(start, 100.0, method).unwrap();
    assert!(path.ending().is_complete() && path.crossings().len() == 32);
    assert_eq!((path.end().state(), path.statistics()), (plain.end().state(), plain.statistics()));
}

/// Who puts the motion back after each crossing comes no farther.
#[test]
fn a_storm_of_events_has_an_end() {
    let mut crosses = SPRING.event("crosses", |s| s.state().q[0]).falling();
    let mut motion = Motion::new(&SPRING, State::at_rest([1.0]), Dop853::default()).unwrap();
    let ending = loop {
        match motion.advance_to_event(1e6, &mut [&mut crosses]) {
            Ok(Some(crossing)) => {
                let back = State { q: [1e-12].into(), ..crossing.state };
                motion.set_state(back).unwrap();
            }
            Ok(None) => panic!("it went through"),
            Err(ending) => break ending,
        }
    };
    assert!(matches!(ending, Ending::EventsAccumulate { event: "crosses", .. }) && crosses.count() < 10);
}

#[test]
fn what_is_wrong_with_a_function_is_told_and_the_way_there_kept() {
    let start = State::at_rest([1.0]);
    let mut root = SPRING.event("root", |s| s.state().q[0].sqrt());
    let path = SPRING.motion(start).event(&mut root).towards(10.0).unwrap();
    assert!(matches!(path.ending(), Ending::EventNotFinite { event: "root", .. }));
    assert!(path.end().coordinate("x").unwrap() > 0.0 && path.end().time() > 0.5);
    assert!(path.at(0.5).is_ok() && path.crossings().is_empty());
    let error = path.finished().unwrap_err();
    assert!(matches!(&error, Error::Unfinished(_)), "{error}");

    let mut event = SPRING.event("never", |_| f64::NAN);
    let error = SPRING.motion(start).event(&mut event).towards(1.0).unwrap_err();
    assert!(matches!(error, Error::EventNotFinite { event: "never", time: 0.0 }), "{error}");
    let mut event = SPRING.event("typo", |s| s.velocity("x_dot"));
    let error = SPRING.motion(start).event(&mut event).towards(1.0).unwrap_err();
    assert!(matches!(error, Error::UnknownName { .. }), "{error}");
}

/// Where a function jumps there is a crossing, and it is found to the last bit of the time.
#[test]
fn jumps_are_crossings() {
    let mut jumps = SPRING.event("jumps", |s| if s.time() < 2.25 + 1e-3 { -1.0 } else { 1e9 });
    let path = SPRING.motion(State::at_rest([1.0])).event(&mut jumps).towards(10.0);
    let path = path.unwrap();
    assert_eq!(path.crossings().len(), 1);
    assert!((path.crossings()[0].state.t - 2.251).abs() <= 2.0 * f64::EPSILON * 2.251);
}

/// An event that has ended one motion does not end the next before its time, and each leg counts from 1.
#[test]
fn an_event_counts_anew_in_each_run() {
    let method = Dop853::with_tolerance(1e-12);
    let mut turn = SPRING.event("turn", |s| s.velocity("x")).falling().terminal_at(2);
    let mut start = State::at_rest([1.0]);
    for again in [State::at_rest([2.0]), State::at_rest([1.0]).at_time(0.5), State::at_rest([1.0])] {
        let path = SPRING.motion(start).by(method).event(&mut turn).towards(100.0).unwrap();
        assert_eq!((turn.count(), path.crossings().len()), (2, 2));
        assert!(
            (path.ending().time() - start.t - 4.0 * std::f64::consts::PI).abs() < 1e-9,
            "{:?}",
            path.ending()
        );
        start = again;
    }
    let mut zero = SPRING.event("zero", |s| s.state().q[0]);
    let first = SPRING.motion(start).by(method).event(&mut zero).towards(5.0).unwrap();
    assert_eq!(zero.count(), 2);
    let leg = *first.end().state();
    SPRING.motion(leg).by(method).event(&mut zero).towards(10.0).unwrap();
    assert_eq!(zero.count(), 1);
    let mut motion = Motion::new(&SPRING, State::at_rest([1.0]), method).unwrap();
    let crossing = motion.advance_to_event(9.0, &mut [&mut zero]).unwrap().unwrap();
    assert_eq!((crossing.count, zero.count()), (1, 1));
}
