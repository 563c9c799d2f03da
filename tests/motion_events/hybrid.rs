//! Motions of several legs, each of a system of its own.

use std::f64::consts::TAU;
use std::sync::Arc;

use lagrange_core::{Dop853, Ending, HybridTrajectory, prelude::*};

use lagrange_systems::{Ball, LeaningRod, PushedSpring, Sticking};

use crate::runs::{LADDER, leaning};
use crate::{Plane, Rod, SPRING};

/// A block that a belt carries along, and the same, pulled by a force.
const STICKING: Sticking<f64> = Sticking { m: 0.7, k: 3.0, belt: 0.4 };
const SLIPPING: PushedSpring<f64> = PushedSpring { m: 0.7, k: 3.0, u: 1.1, ..SPRING };
const HOLD: f64 = 1.7;

/// 49 events: it gives and is caught by turns, from where the spring is slack.
fn ride() -> HybridTrajectory<f64> {
    let method = Dop853::with_tolerance(1e-13);
    let mut gives = STICKING.event("gives", |s| Ok(s.multiplier("friction")? - HOLD)).rising().terminal();
    let mut catches = SLIPPING.event("catches", |s| s.state().v[0] - STICKING.belt).rising().terminal();
    let (mut trajectory, mut state) = (HybridTrajectory::new(), State::new([0.0], [STICKING.belt]));
    for event in 0..49 {
        if event % 2 == 0 {
            let leg = STICKING.motion(state).by(method).event(&mut gives).towards(1e3).expect("a start");
            state = *leg.end().state();
            trajectory.push(leg.into_owned()).expect("no gap");
        } else {
            let leg = SLIPPING.motion(state).by(method).event(&mut catches).towards(1e3).expect("a start");
            state = State { v: [STICKING.belt].into(), ..*leg.end().state() };
            trajectory.push(leg.into_owned()).expect("no gap");
        }
    }
    trajectory
}

/// Place, velocity and friction in closed form. Slipping it swings about u/k, from the place where it gives to the
/// mirror image of that, where it is as fast as the belt again.
fn exact(t: f64) -> [f64; 3] {
    let Sticking { m, k, belt } = STICKING;
    let (first, d, omega) = (HOLD / k / belt, (HOLD - SLIPPING.u) / k, (k / m).sqrt());
    if t < first {
        return [belt * t, belt, k * belt * t];
    }
    let (slips, sticks) = ((TAU - 2.0 * (omega * d / belt).atan()) / omega, 2.0 * d / belt);
    let since = (t - first) % (slips + sticks);
    if since < slips {
        let (sine, cosine) = (omega * since).sin_cos();
        let place = SLIPPING.u / k + d * cosine + belt / omega * sine;
        return [place, belt * cosine - omega * d * sine, SLIPPING.u];
    }
    let place = SLIPPING.u / k - d + belt * (since - slips);
    [place, belt, k * place]
}

#[test]
fn stick_and_slip_over_49_events() {
    let trajectory = ride();
    assert_eq!(trajectory.legs().len(), 49);
    assert!(trajectory.legs().all(|leg| matches!(leg.ending(), Ending::Event { .. })));
    let ends: Vec<f64> = trajectory.legs().map(|leg| leg.end_time()).collect();
    for pair in ends.windows(2) {
        // Just before and after each event.
        for t in [pair[0] + 1e-6, pair[1] - 1e-6, 0.5 * (pair[0] + pair[1])] {
            let (sample, [x, v, friction]) = (trajectory.at(t).unwrap(), exact(t));
            assert!((sample.coordinate("x").unwrap() - x).abs() < 1e-9);
            assert!((sample.velocity("x").unwrap() - v).abs() < 1e-9);
            let told = sample.multiplier("friction").unwrap_or(SLIPPING.u);
            assert!((told - friction).abs() < 1e-9, "{told} instead of {friction}");
        }
    }
    // The legs are there with their types, and no others.
    assert!(trajectory.leg::<Trajectory<Sticking<f64>>>(0).is_some());
    assert!(trajectory.leg::<Trajectory<PushedSpring<f64>>>(0).is_none());
    let slip = trajectory.leg::<Trajectory<PushedSpring<f64>>>(47).expect("the last slip");
    assert_eq!(slip.end().time(), ends[47]);
    assert!(trajectory.leg::<Trajectory<Sticking<f64>>>(49).is_none());
}

#[test]
fn a_hybrid_trajectory_answers_at_any_time_by_name() {
    let LeaningRod { m, a, g } = LADDER;
    let (sliding, method) = (Arc::new(Rod { m, a, g }), Dop853::with_tolerance(1e-12));
    let mut leaves = LADDER.event("leaves", |s| s.multiplier("wall")).falling().terminal();
    let first = LADDER.motion(leaning(1.2)).by(method).event(&mut leaves).towards(10.0).unwrap();
    let left = first.end().time();
    let mut lies = sliding.event("lies", |s| s.coordinate("theta")).falling().terminal();
    let second = sliding.motion(*first.end().state()).by(method).event(&mut lies).towards(10.0).unwrap();
    let mut trajectory = HybridTrajectory::<f64>::new();
    assert!(trajectory.start_time().is_nan() && trajectory.ending().is_none() && trajectory.at(0.0).is_err());
    trajectory.push(first.into_owned()).unwrap();
    trajectory.push(second.into_owned()).unwrap();
    assert_eq!(
        (trajectory.start_time(), trajectory.end_time()),
        (0.0, trajectory.legs().last().unwrap().end_time())
    );
    assert!(trajectory.ending().unwrap().to_string().contains("`lies`"));
    let energy = trajectory.at(0.0).unwrap().energy();
    let mut count = 0;
    for sample in trajectory.samples(101) {
        let sample = sample.unwrap();
        assert!((sample.energy() / energy - 1.0).abs() < 1e-11);
        assert!(sample.multiplier("floor").or(sample.multiplier("ground")).unwrap() > 0.0);
        // Each leg knows what it has.
        assert_eq!(sample.multiplier("wall").is_ok(), sample.time() < left);
        assert_eq!(sample.observable("foot").is_ok(), sample.time() >= left);
        count += 1;
    }
    assert_eq!(count, 101);
    // Where they meet, the next answers.
    assert!(trajectory.at(left).unwrap().observable("foot").is_ok());
    assert!(trajectory.at(trajectory.end_time() + 1e-9).is_err() && trajectory.at(-1e-9).is_err());
    assert!(matches!(trajectory.at(20.0).err(), Some(Error::OutsideTrajectory { start: 0.0, .. })));
}

#[test]
fn a_leg_that_does_not_go_on_is_refused() {
    let leg = |from: f64, to: f64| {
        let start = State::at_rest([1.0]).at_time(from);
        SPRING.integrate(start, to, Dop853::default()).unwrap().into_owned()
    };
    let mut trajectory = HybridTrajectory::new();
    trajectory.push(leg(0.0, 1.0)).unwrap();
    let error = trajectory.push(leg(2.0, 3.0)).unwrap_err();
    assert!(matches!(error, Error::LegApart { start: 2.0, end: 3.0, expected: 1.0 }), "{error}");
    let error = trajectory.push(leg(1.0, 0.5)).unwrap_err();
    assert!(error.to_string().contains("lead it the same way in time"), "{error}");
    trajectory.push(leg(1.0, 1.0)).unwrap();
    let plane = Plane { g: 9.81 };
    let flight = plane.integrate(State::at_rest([1.0; 2]).at_time(1.0), 2.0, Dop853::default()).unwrap();
    trajectory.push(flight.into_owned()).unwrap();
    assert!(trajectory.at(1.5).unwrap().coordinate("y").is_ok() && trajectory.legs().len() == 3);
    // Back in time.
    let mut trajectory = HybridTrajectory::new();
    trajectory.push(leg(0.0, -1.0)).unwrap();
    trajectory.push(leg(-1.0, -2.0)).unwrap();
    assert!((trajectory.at(-0.5).unwrap().coordinate("x").unwrap() - 0.5_f64.cos()).abs() < 1e-8);
    assert_eq!(trajectory.samples(5).filter_map(Result::ok).last().unwrap().time(), -2.0);
}

/// A ball falls from 1 m, bounces, and flies on as a point of another system.
#[test]
fn a_leg_may_cross_contacts() {
    let ball = Ball { m: 1.0, g: 9.81, e: 0.5, ..Ball::default() };
    let bounces = ball.motion(State::at_rest([0.0, 1.0])).with_contacts().to(0.6).unwrap();
    let flies =
        Plane { g: 9.81 }.integrate(*bounces.end().state(), 0.7, Dop853::default()).unwrap().into_owned();
    let mut trajectory = HybridTrajectory::new();
    trajectory.push(bounces).unwrap();
    trajectory.push(flies).unwrap();
    let fall = (2.0_f64 / 9.81).sqrt();
    for t in [0.3, 0.5, 0.65] {
        let up = 0.5 * 9.81 * fall * (t - fall);
        let y =
            if t < fall { 1.0 } else { up } - 0.5 * 9.81 * if t < fall { t * t } else { (t - fall).powi(2) };
        assert!((trajectory.at(t).unwrap().coordinate("y").unwrap() - y).abs() < 1e-9, "{t}");
    }
}
