//! Events, samples, controllers and progress along motions with contacts, against closed solutions.

use core::cell::{Cell, RefCell};
use core::ops::ControlFlow;

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::{Ending, prelude::*};
use lagrange_systems::Ball;

use crate::{impacts, method};

const BALL: Ball = Ball { m: 0.2, g: 9.81, r: 0.0, e: 0.8, thrust: 0.0, floor: Contact::Open };

fn start() -> State<f64, 2> {
    State::new([0.0, 1.0], [0.5, 0.0])
}

fn fall() -> f64 {
    (2.0 / 9.81_f64).sqrt()
}

/// Time of impact n, counted from 0.
fn impact(n: i32) -> f64 {
    fall() * (1.0 + 2.0 * 0.8 * (1.0 - 0.8_f64.powi(n)) / 0.2)
}

/// Height and velocity at a time before the ball rests; at an impact, after it.
fn bouncing(t: f64) -> [f64; 2] {
    let v = 9.81 * fall();
    match (0..).take_while(|&n| impact(n) <= t).last() {
        None => [1.0 - 9.81 * t * t / 2.0, -9.81 * t],
        Some(n) => {
            let (since, up) = (t - impact(n), v * 0.8_f64.powi(n + 1));
            [up * since - 9.81 * since * since / 2.0, up - 9.81 * since]
        }
    }
}

#[test]
fn events_are_counted_across_impacts() {
    let apex = || BALL.event("apex", |sample| sample.state().v[1]).falling();
    let post = || BALL.event("post", |sample| sample.state().q[0] - 0.3);
    for is_first in [true, false] {
        let motion = BALL.motion(start()).by(method());
        let path = match is_first {
            true => motion.event(apex()).event(post()).with_contacts().to(3.0),
            false => motion.with_contacts().event(apex()).event(post()).to(3.0),
        };
        let path = path.unwrap();
        let of = |event| path.crossings().iter().filter(move |crossing| crossing.event == event);
        let apices: Vec<_> = of("apex").collect();
        let count = (0..).take_while(|&n| (impact(n) + impact(n + 1)) / 2.0 < 3.0).count();
        assert_eq!(apices.len(), count);
        for (n, apex) in apices.iter().enumerate() {
            let expected = (impact(n as i32) + impact(n as i32 + 1)) / 2.0;
            assert!((apex.state.t - expected).abs() < 1e-12, "{n}: {}", apex.state.t - expected);
            assert_eq!((apex.count, apex.index, apex.rising), (n + 1, 0, false));
        }
        let post: Vec<_> = of("post").collect();
        assert!(matches!(post[..], [post] if (post.state.t - 0.6).abs() < 1e-14 && post.index == 1));
    }
}

/// Functions that are zero where the ball hits the floor: the gap itself, others of it with other round-off, and one that goes
/// on through zero.
#[test]
fn crossings_at_impacts_are_told_once_and_before_the_impact() {
    let functions: [fn(f64, f64) -> f64; 6] = [
        |_, y| y,
        |_, y| (3.0 * y).sin(),
        |_, y| (1.0 + y) * (1.0 + y) - 1.0,
        |_, y| -y,
        |x, _| x - 0.5 * (2.0 / 9.81_f64).sqrt(),
        // Its zero is later than that of the gap, by less than the round-off of y.
        |_, y| y + 1e-16,
    ];
    for (k, function) in functions.into_iter().enumerate() {
        for method in [1e-11, 1e-13, 1e-15].map(Taylor::with_tolerance) {
            let lands = BALL.event("floor", |sample| function(sample.state().q[0], sample.state().q[1]));
            let path = BALL.motion(start()).by(method).with_contacts().event(lands).to(3.0).unwrap();
            let impacts = impacts(path.transitions());
            let expected = if k == 4 { 1 } else { impacts.len() };
            let crossings = path.crossings();
            assert_eq!(crossings.len(), expected, "function {k}");
            for (crossing, time) in crossings.iter().zip(&impacts) {
                assert!((crossing.state.t - time).abs() < 1e-14 && crossing.state.v[1] < 0.0, "{crossing:?}");
                assert_eq!(crossing.rising, k == 3 || k == 4);
            }
            assert_eq!(crossings.last().map(|last| last.count), Some(expected));
        }
    }
}

/// The function jumps from below zero to above it at each impact.
#[test]
fn jumps_at_impacts_are_no_crossings() {
    let turns = BALL.event("turns", |sample| sample.state().v[1]).rising();
    let path = BALL.motion(start()).with_contacts().event(turns).to(3.0).unwrap();
    assert!(impacts(path.transitions()).len() > 5 && path.crossings().is_empty());
}

#[test]
fn terminal_events_end_motions_before_the_impact() {
    for (function, is_at_impact) in [((|y, _| y) as fn(f64, f64) -> f64, true), (|_, v| v, false)] {
        let event = BALL.event("ends", |sample| function(sample.state().q[1], sample.state().v[1]));
        let event = event.falling().terminal_at(4);
        let path = BALL.motion(start()).by(method()).event(event).with_contacts().to(3.0).unwrap();
        let expected = if is_at_impact { impact(3) } else { (impact(3) + impact(4)) / 2.0 };
        assert!(matches!(path.ending(), Ending::Event { event: "ends", .. }));
        assert!((path.end().state().t - expected).abs() < 1e-12, "{}", path.end().state().t);
        assert_eq!(impacts(path.transitions()).len(), if is_at_impact { 3 } else { 4 });
        assert_eq!(path.end().state().v[1] < -1.0, is_at_impact);
        assert_eq!(path.crossings().len(), 4);
    }
}

#[test]
fn samples_are_taken_across_impacts() {
    let method = Taylor::with_tolerance(1e-15);
    let arrived = BALL.motion(start()).by(method).every(0.01).with_contacts().to(3.0).unwrap();
    assert_eq!(arrived.samples().len(), 301);
    for state in arrived.samples() {
        let [y, v] = bouncing(state.t);
        assert!((state.q[1] - y).abs() < 1e-12 && (state.v[1] - v).abs() < 1e-11, "{state:?} {y} {v}");
        assert!((state.q[0] - 0.5 * state.t).abs() < 1e-14);
    }
    // At the impacts themselves, and at the end.
    let times: Vec<f64> = impacts(arrived.transitions()).into_iter().chain([3.0]).collect();
    let motion = BALL.motion(start()).by(method).with_contacts().samples_at(times.clone());
    let motion = motion.quantity("velocity", |sample| sample.velocity("y"));
    let again = motion.to(3.0).unwrap();
    assert_eq!(again.transitions(), arrived.transitions());
    let samples = again.samples();
    assert!(samples.iter().map(|sample| sample.t).eq(times.iter().copied()));
    assert!(samples.iter().map(|sample| sample.v[1]).eq(again.values().iter().copied()));
    for (n, sample) in samples[..samples.len() - 1].iter().enumerate() {
        let up = 9.81 * fall() * 0.8_f64.powi(n as i32 + 1);
        assert!((sample.v[1] - up).abs() < 1e-12, "{n}: {}", sample.v[1] - up);
    }
    // The same states as those of the steps.
    let path = BALL.motion(start()).by(method).with_contacts().to(3.0).unwrap();
    for sample in samples {
        let state = path.at(sample.t).unwrap();
        assert_eq!(
            (state.coordinate("y").unwrap(), state.velocity("y").unwrap()),
            (sample.q[1], sample.v[1])
        );
    }
    assert_eq!(path.end().state(), again.end().state());
}

/// Between calls, a block is lifted with 12 m from t = 0.3 to 0.6; its weight is 10 m.
#[test]
fn a_controller_lifts_a_block_off_its_floor() {
    let block = Ball { m: 1.0, g: 10.0, e: 0.0, ..BALL };
    let (calls, closed) = (Cell::new(0), RefCell::new(Vec::new()));
    for method in [method(), Dop853::with_tolerance(1e-9)] {
        calls.set(0);
        closed.borrow_mut().clear();
        let motion = block.motion(State::at_rest([0.0, 0.0])).by(method).with_contacts();
        let motion = motion.controlled(0.1, |block, _| {
            block.thrust = if (3..6).contains(&calls.get()) { 12.0 } else { 0.0 };
            calls.set(calls.get() + 1);
            closed.borrow_mut().push(block.floor == Contact::Closed);
            Ok::<(), &str>(())
        });
        let motion = motion.every(0.1).quantity("thrust", |sample| sample.system().thrust);
        let arrived = motion.quantity("force", |sample| sample.multiplier("floor")).to(1.0).unwrap();
        let lands = 0.6 + (0.6 + (0.36_f64 + 1.8).sqrt()) / 10.0;
        let transitions = arrived.transitions();
        let [
            Transition::Closes { time: 0.0, .. },
            Transition::Opens { time, .. },
            Transition::Impact { time: hits, impulses },
            Transition::Closes { time: closes, .. },
        ] = transitions
        else {
            panic!("{transitions:?}")
        };
        assert!((time - 0.3).abs() < 1e-15 && (hits - lands).abs() < 1e-12 && closes == hits);
        assert!((impulses[0].1 - (0.36_f64 + 1.8).sqrt()).abs() < 1e-12);
        assert_eq!(calls.get(), 10);
        assert_eq!(*closed.borrow(), [true, true, true, true, false, false, false, false, false, true]);
        // Samples are taken before the call at their time.
        let thrusts = arrived.values().chunks(2).map(|values| values[0]);
        assert!(thrusts.eq((0..=10).map(|k| if (4..7).contains(&k) { 12.0 } else { 0.0 })));
        let forces: Vec<f64> = arrived.values().chunks(2).map(|values| values[1]).collect();
        assert!((forces[2] - 10.0).abs() < 1e-12 && forces[5] == 0.0 && (forces[10] - 10.0).abs() < 1e-12);
        assert!((arrived.samples()[6].q[1] - 0.09).abs() < 1e-13);
        assert_eq!(arrived.end().state().q[1], 0.0);
    }
}

#[test]
fn a_controller_that_fails_or_moves_the_floor_ends_the_motion() {
    let motion = BALL
        .motion(start())
        .with_contacts()
        .controlled(0.1, |_, state| if state.t < 1.0 { Ok(()) } else { Err("enough") });
    let failed = motion.towards(3.0).unwrap();
    assert!(matches!(failed.ending(), Ending::ControllerFailed { time, .. } if (time - 1.0).abs() < 1e-15));
    assert_eq!(impacts(failed.transitions()).len(), 1);
}

#[test]
fn progress_is_that_of_the_whole_motion() {
    let seen = RefCell::new(Vec::new());
    let motion = BALL.motion(start()).with_contacts().on_progress(|progress| {
        seen.borrow_mut().push(progress);
        if progress.time > 2.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let path = motion.to(3.0).unwrap();
    assert!(
        matches!(path.ending(), Ending::Cancelled { time } if *time > 2.0 && *time == path.end().state().t)
    );
    let seen = seen.into_inner();
    assert!(seen.iter().all(|progress| (progress.start, progress.end) == (0.0, 3.0)));
    assert!(seen.windows(2).all(|pair| pair[0].time < pair[1].time && pair[0].steps < pair[1].steps));
    assert_eq!(seen.last().map(|last| last.steps), Some(path.statistics().accepted));
    let limited =
        BALL.motion(start()).by(Dop853::default().max_steps(8)).with_contacts().towards(3.0).unwrap();
    assert!(matches!(limited.ending(), Ending::StepLimit { steps: 8, .. }), "{:?}", limited.ending());
    let none = BALL.motion(start()).with_contacts().max_transitions(3).towards(3.0).unwrap();
    assert!(matches!(none.ending(), Ending::TransitionLimit { transitions: 3, .. }));
}

/// Posts where the controller is called, some of them reached by a unit of round-off before it or after it.
#[test]
fn crossings_at_calls_of_the_controller_are_told_once() {
    for change in [f64::next_down, |x| x, f64::next_up] {
        let posts = (1..20).map(|k| {
            let post = change(0.5 * (0.1 * f64::from(k)));
            BALL.event("post", move |sample| sample.state().q[0] - post)
        });
        let method = Taylor::with_tolerance(1e-15);
        let motion = BALL.motion(start()).by(method).with_contacts().events(posts);
        let arrived = motion.controlled(0.1, |_, _| Ok::<(), &str>(())).to(2.0).unwrap();
        let crossings = arrived.crossings();
        assert!(crossings.iter().map(|crossing| crossing.index).eq(0..19), "{crossings:?}");
        assert!(crossings.iter().all(|crossing| crossing.rising && crossing.count == 1));
    }
}

#[test]
fn events_count_anew_in_the_next_motion() {
    let mut apex = BALL.event("apex", |sample| sample.state().v[1]).falling();
    for end in [2.0, 3.0] {
        let path = BALL.motion(start()).with_contacts().event(&mut apex).to(end).unwrap();
        assert!(path.crossings().iter().map(|crossing| crossing.count).eq(1..=path.crossings().len()));
        assert_eq!(apex.count(), path.crossings().len());
    }
}

/// Of a ball that bounces and comes to rest, the gap and its rate are zero but for round-off from then on: no crossing, and no
/// search for one at the scale of the last bounces.
#[test]
fn events_of_a_gap_at_rest_are_quiet() {
    for function in [(|y, _| y) as fn(f64, f64) -> f64, |_, v| v, |y, v| y + v, |y, _| y + 1e-9] {
        let calls = Cell::new(0);
        let event = BALL.event("gap", |sample| {
            calls.set(calls.get() + 1);
            function(sample.state().q[1], sample.state().v[1])
        });
        let method = Dop853::with_tolerance(1e-12);
        let path = BALL.motion(start()).by(method).with_contacts().event(event.falling()).to(10.0).unwrap();
        let rests = path.transitions().last().unwrap();
        assert!(matches!(rests, Transition::Rests { .. }));
        assert!(path.crossings().iter().all(|crossing| crossing.state.t <= rests.time()));
        assert!(calls.get() < 120 * path.legs().len(), "{} calls, {} legs", calls.get(), path.legs().len());
    }
}

/// A function that falls to zero at the end of a motion, to round-off, does not rise there.
#[test]
fn events_at_the_end_of_a_motion_have_their_direction() {
    for end in (1..100).map(|i| 0.01 * f64::from(i)) {
        let start = State::new([0.0, 1.0], [1.0, 0.0]);
        let event = || BALL.event("reaches", move |sample| end - sample.state().q[0]);
        let count = |event| {
            BALL.motion(start).by(method()).event(event).with_contacts().to(end).unwrap().crossings().len()
        };
        assert_eq!([count(event().rising()), count(event().falling()), count(event())], [0, 1, 1], "{end}");
    }
}
