//! What is a crossing, and what is none.

use std::cell::Cell;
use std::f64::consts::PI;

use lagrange_core::motion::AnyEvent;
use lagrange_core::{Crossing, Ending, Event, Method, prelude::*};

use lagrange_random::cases;
use lagrange_systems::PushedSpring;

use crate::{FREE, Plane, SPRING, ball};

/// A motion along x = t in steps of 1, and so in pieces of an eighth where g bends.
fn steady(from: f64) -> Motion<&'static PushedSpring<f64>, Dopri5> {
    let method = Dopri5::default().fixed_step(1.0);
    Motion::new(&FREE, State::new([from], [1.0]).at_time(from), method).expect("a start")
}

/// All crossings until `end`.
fn crossings<L, P>(
    motion: &mut Motion<L, P>,
    end: f64,
    events: &mut [&mut dyn AnyEvent<L>],
) -> Vec<Crossing<f64, L::N>>
where
    L: Lagrangian<Scalar = f64>,
    P: Method<L>,
{
    let mut found = Vec::new();
    while let Some(crossing) = motion.advance_to_event(end, events).expect("a motion") {
        assert_eq!(crossing.state.t, motion.state().t);
        found.push(crossing);
    }
    assert_eq!(motion.state().t, end);
    found
}

/// The times at which g(t) crosses zero.
fn times(from: f64, end: f64, g: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut event = FREE.event("g", |s| g(s.time()));
    let found = crossings(&mut steady(from), end, &mut [&mut event]);
    assert_eq!(event.count(), found.len());
    found.iter().map(|crossing| crossing.state.t).collect()
}

fn close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}, not {expected:?}");
    for (x, y) in found.iter().zip(expected) {
        assert!((x - y).abs() <= 4.0 * f64::EPSILON * y.abs().max(1.0), "{found:?}, not {expected:?}");
    }
}

#[test]
fn every_change_of_sign_on_the_grid_is_found() {
    close(&times(0.0, 5.0, |t| t - 2.3), &[2.3]);
    // Two and three in one step, in pieces of their own.
    close(&times(0.0, 5.0, |t| (t - 2.3) * (t - 2.6)), &[2.3, 2.6]);
    close(&times(0.0, 5.0, |t| (t - 2.1) * (t - 2.4) * (t - 2.9)), &[2.1, 2.4, 2.9]);
    // Close together.
    close(&times(0.0, 5.0, |t| (t - 2.3) * (t - 2.31)), &[2.3, 2.31]);
    close(&times(0.0, 5.0, |t| (t - 2.3) * (t - 2.31) * (t - 2.32)), &[2.3, 2.31, 2.32]);
    for pieces in [100, 10] {
        let mut wiggling =
            FREE.event("wiggling", |s| (s.time() - 2.304) * (s.time() - 2.316)).subdivide(pieces);
        assert_eq!(crossings(&mut steady(0.0), 5.0, &mut [&mut wiggling]).len(), 2);
    }
}

/// Wherever in a step a function turns back, and whichever way it is open, both zeros are found however close they are, and
/// none where it has none.
#[test]
fn both_zeros_are_found_in_one_step_where_a_function_turns_back() {
    for k in (0..200).step_by(200 / cases([10, 200, 200])) {
        let first = 2.0 + 0.004 * f64::from(k);
        for (apart, factor) in
            [0.3, 0.126, 0.06, 0.01, 1e-4, 1e-6].into_iter().flat_map(|x| [(x, 1.0), (x, -1e-3)])
        {
            let bent = |t: f64| factor * (1.0 + 0.4 * (3.0 * t).sin());
            let last = first + apart;
            close(&times(0.0, 5.0, |t| factor * (t - first) * (t - last)), &[first, last]);
            close(&times(0.0, 5.0, |t| bent(t) * (t - first) * (t - last)), &[first, last]);
            close(&times(0.0, 5.0, |t| bent(t) * ((t - first).powi(2) + apart.powi(2))), &[]);
        }
    }
}

/// A step on which a function stays away from zero costs four evaluations, the end and three inside, once it is known to be simple.
#[test]
fn a_function_is_looked_at_closely_where_it_comes_near_zero() {
    let calls = std::cell::Cell::new(0);
    let counted = |t: f64| {
        calls.set(calls.get() + 1);
        t - 60.4
    };
    close(&times(0.0, 50.0, counted), &[]);
    // The start and eight neighbours of it, 16 in the first step.
    assert_eq!(calls.get(), 9 + 1 + 16 + 49 * 4);
    calls.set(0);
    close(&times(50.0, 100.0, counted), &[60.4]);
    assert!(calls.get() < 10 + 16 + 49 * 4 + 60, "{} calls", calls.get());
}

/// Two zeros between two samples of a function that is flat elsewhere are seen where samples are as dense as they are.
#[test]
fn pieces_show_what_is_narrower_than_samples_are_apart() {
    let dip = |t: f64| 1.0 - 2.0 * (-((t - 2.25) / 0.05).powi(2)).exp();
    for pieces in [4, 8, 100] {
        let mut event = FREE.event("dip", |s| dip(s.time())).subdivide(pieces);
        let mut other = FREE.event("other", |s| s.time() + 1.0);
        assert_eq!(crossings(&mut steady(0.0), 5.0, &mut [&mut other, &mut event]).len(), 2);
    }
    // What another event asks for does not take away from what this one does.
    let mut turns = FREE.event("turns", |s| (s.time() - 2.3) * (s.time() - 2.44));
    let mut other = FREE.event("other", |s| s.time() + 1.0).subdivide(1);
    assert_eq!(crossings(&mut steady(0.0), 5.0, &mut [&mut turns, &mut other]).len(), 2);
}

/// A pole is found where the sign changes there, to a hundred units of round-off of the time.
#[test]
fn a_pole_is_a_crossing() {
    for pole in [0.5, 0.3, 2.77] {
        let found = times(0.0, 5.0, |t| 1.0 / (pole - t));
        assert!(found.len() == 1 && (found[0] - pole).abs() <= 128.0 * f64::EPSILON * pole, "{found:?}");
    }
}

/// An infinite function is searched no more closely than a constant one.
#[test]
fn a_function_that_becomes_infinite_takes_few_evaluations() {
    let evaluations = |after: f64| {
        let count = Cell::new(0);
        let g = |t| {
            count.set(count.get() + 1);
            if t < 2.3 { 1.0 } else { after }
        };
        close(&times(0.0, 100.0, g), &[2.3]);
        count.get()
    };
    let [constant, infinite] = [-1.0, f64::NEG_INFINITY].map(evaluations);
    assert!(infinite < 2 * constant, "{infinite}, and {constant} of a constant");
}

/// A stone thrown along a round wall leaves it: it is on the wall to its round-off for 10⁻⁸, and does not cross.
#[test]
fn what_leaves_a_zero_slowly_does_not_cross() {
    let stone = Plane { g: 0.0 };
    for k in (0..200).step_by(200 / cases([20, 200, 200])) {
        let (s, c) = (0.005 + 0.0314 * f64::from(k)).sin_cos();
        let start = State::new([c, s], [-0.5 * s, 0.5 * c]);
        for time in [0.0, 1.0, 1e9] {
            let mut lands = stone.event("lands", |sample| sample.state().q.norm() - 1.0).terminal();
            let path = stone.motion(start.at_time(time)).event(&mut lands).towards(time + 3.0);
            assert!(path.unwrap().ending().is_complete(), "{k} at {time}");
        }
    }
}

#[test]
fn a_zero_belongs_to_the_piece_that_it_ends() {
    // At the end of a step, at the end of a piece, and both.
    close(&times(0.0, 5.0, |t| t - 2.0), &[2.0]);
    close(&times(0.0, 5.0, |t| 2.25 - t), &[2.25]);
    close(&times(0.0, 5.0, |t| (t - 2.0) * (t - 2.5) * (t - 3.0)), &[2.0, 2.5, 3.0]);
    // At the end of two pieces that follow each other.
    close(&times(0.0, 5.0, |t| (t - 2.0) * (t - 2.125)), &[2.0, 2.125]);
    // At the end of the motion, and not again where that goes on.
    let mut event = FREE.event("arrival", |s| s.time() - 3.0);
    let mut motion = steady(0.0);
    assert_eq!(crossings(&mut motion, 3.0, &mut [&mut event]).len(), 1);
    assert_eq!(crossings(&mut motion, 6.0, &mut [&mut event]).len(), 0);
    // At the start, where the motion leaves it.
    close(&times(2.0, 5.0, |t| t - 2.0), &[]);
    close(&times(2.0, 5.0, |t| (t - 2.0) * (t - 3.5)), &[3.5]);
    // Also where it comes back within the first piece, and soon.
    for back in [2.2, 2.01, 2.000_01, 2.0 + 1e-10] {
        close(&times(2.0, 5.0, |t| (t - 2.0) * (t - back)), &[back]);
    }
}

#[test]
fn a_touch_counts_where_the_grid_sees_it_once() {
    close(&times(0.0, 5.0, |t| (t - 2.5).powi(2)), &[2.5]);
    close(&times(0.0, 5.0, |t| -(t - 3.0).powi(2)), &[3.0]);
    close(&times(0.0, 5.0, |t| (t - 2.3).powi(2)), &[]);
    let mut touched = FREE.event("touched", |s| (s.time() - 2.5).powi(2)).rising();
    assert_eq!(crossings(&mut steady(0.0), 5.0, &mut [&mut touched]).len(), 0);
    // And a function that is zero for long is crossed once on the way in, and left without.
    close(&times(0.0, 5.0, |t| (t - 1.5).min(0.0)), &[1.5]);
    close(&times(0.0, 5.0, |t| (t - 1.5).max(0.0)), &[]);
}

#[test]
fn directions_are_told_apart_in_both_directions_of_time() {
    for (end, rises, falls) in [
        (10.0, [1.5 * PI, 3.5 * PI], [0.5 * PI, 2.5 * PI]),
        (-10.0, [-1.5 * PI, -3.5 * PI], [-0.5 * PI, -2.5 * PI]),
    ] {
        // Rising and falling as the motion goes, which is back in time in the second.
        let found = |event: Event<PushedSpring<f64>, _>| {
            let mut motion =
                Motion::new(&SPRING, State::at_rest([1.0]), Dop853::with_tolerance(1e-13)).unwrap();
            let mut event = event;
            crossings(&mut motion, end, &mut [&mut event])
        };
        for (event, times, rising) in [
            (SPRING.event("x", place).rising(), rises, true),
            (SPRING.event("x", place).falling(), falls, false),
        ] {
            let found = found(event);
            let expected = times.into_iter().filter(|t| t.abs() < 10.0);
            assert_eq!(found.len(), expected.clone().count());
            for (crossing, t) in found.iter().zip(expected) {
                assert!((crossing.state.t - t).abs() < 1e-11 && crossing.rising == rising, "{crossing:?}");
                assert!(crossing.state.q[0].abs() <= f64::EPSILON);
            }
        }
        assert_eq!(found(SPRING.event("x", place)).len(), 3);
    }
}

fn place(sample: &lagrange_core::Sample<&PushedSpring<f64>>) -> f64 {
    sample.state().q[0]
}

#[test]
fn several_events_come_in_the_order_of_their_times() {
    let at = |time: f64| FREE.event("at", move |s| s.time() - time);
    let mut events = [at(2.7), at(0.1), at(2.6), at(2.7), at(2.65), at(3.0)];
    let [a, b, c, d, e, f] = &mut events;
    let found = crossings(&mut steady(0.0), 5.0, &mut [a, b, c, d, e, f]);
    let order: Vec<usize> = found.iter().map(|crossing| crossing.index).collect();
    assert_eq!(order, [1, 2, 4, 0, 3, 5]);
    assert_eq!(found[3].state, found[4].state);
}

/// Two balls that land at one time are both reported, though the first changes the state.
#[test]
fn events_at_one_time_are_all_reported_when_the_state_changes_in_between() {
    let balls = Plane { g: 1.0 };
    let mut lands = [0, 1].map(|k| balls.event("lands", move |s| s.state().q[k]).falling());
    let [x, y] = &mut lands;
    let mut motion =
        Motion::new(&balls, State::at_rest([0.5, 0.5]), Dop853::default().max_step(1.0)).unwrap();
    for bounce in 0..10 {
        for k in 0..2 {
            let crossing = motion.advance_to_event(100.0, &mut [x, y]).unwrap().expect("a landing");
            assert_eq!(crossing.index, k);
            let off = crossing.state.t - (1.0 + 2.0 * f64::from(bounce));
            assert!(off.abs() < 1e-12, "{off:e}");
            let mut state = *motion.state();
            state.v[k] = -state.v[k];
            motion.set_state(state).unwrap();
        }
    }
}

/// A stop costs no step: who goes on without a change sees the same motion.
#[test]
fn stopping_changes_nothing() {
    let start = || Motion::new(&SPRING, State::at_rest([1.0]), Dop853::default()).unwrap();
    let mut motion = start();
    let mut event = SPRING.event("x", place);
    let found = crossings(&mut motion, 30.0, &mut [&mut event]);
    assert_eq!(found.len(), 10);
    let mut alone = start();
    alone.advance_to(30.0).unwrap();
    assert_eq!(motion.state(), alone.state());
    assert_eq!(motion.statistics().accepted, alone.statistics().accepted);

    // Whatever one does at the stop: time is then asked for from there on.
    let mut motion = start();
    let crossing = motion.advance_to_event(30.0, &mut [&mut event]).unwrap().unwrap();
    assert_eq!(*motion.state(), crossing.state);
    let t = crossing.state.t;
    assert!(motion.at(t + 1e-3).is_err() && motion.at(t - 1e-3).is_ok());
    motion.advance_by(1e-3).unwrap();
    assert_eq!(motion.state().t, t + 1e-3);
    assert!((motion.state().q[0] - (t + 1e-3).cos()).abs() < 1e-8);
    motion.advance_to_event(30.0, &mut [&mut event]).unwrap().unwrap();
    motion.advance_to(0.0).unwrap();
    assert!((motion.state().q[0] - 1.0).abs() < 1e-8);
}

#[test]
fn single_precision_has_events() {
    let single = PushedSpring { m: 1.0_f32, k: 1.0, ..PushedSpring::default() };
    let mut zero = single.event("zero", |s| s.state().q[0]);
    let mut motion = Motion::new(&single, State::at_rest([1.0_f32]), Dopri5::with_tolerance(1e-6)).unwrap();
    for k in 0..5 {
        let state = motion.advance_to_event(100.0, &mut [&mut zero]).unwrap().expect("it swings").state;
        assert!((f64::from(state.t) - PI * (0.5 + f64::from(k))).abs() < 1e-4 && state.q[0].abs() < 1e-7);
    }
}

/// The height above the floor after n bounces, and when: v = √(2h) at first, e times that after each.
#[test]
fn a_ball_bounces_along_the_geometric_series_and_comes_to_rest() {
    let (ball, e, h) = (ball(1.0), 0.9_f64, 0.5_f64);
    // Without a bound, the first step leads to the end at once, whatever the round-off of what lies between.
    for (end, longest) in [(100.0, 1.0), (1e6, 1e6)] {
        let mut lands = ball.event("lands", |s| s.coordinate("x")).falling();
        let method = Dop853::with_tolerance(1e-12).max_step(longest).max_steps(1 << 22);
        let mut motion = Motion::new(&ball, State::at_rest([h]), method).unwrap();
        let ending = loop {
            match motion.advance_to_event(end, &mut [&mut lands]) {
                Ok(Some(Crossing { count, state, .. })) => {
                    // 1 + 2e + 2e² + … times the time of the first fall, which is 1.
                    let expected = 1.0 + 2.0 * e * (1.0 - e.powi(count as i32 - 1)) / (1.0 - e);
                    if count <= 20 && longest == 1.0 {
                        let off = state.t - expected;
                        assert!(off.abs() < 1e-12, "{count}: {} off by {off:e}", state.t);
                        assert!(state.q[0].abs() < 4.0 * f64::EPSILON * h);
                    }
                    motion.set_state(State { v: -e * state.v, ..state }).unwrap();
                }
                Ok(None) => panic!("it fell through the floor at bounce {}", lands.count()),
                Err(ending) => break ending,
            }
        };
        let rest = 1.0 + 2.0 * e / (1.0 - e);
        assert!(
            matches!(ending, Ending::EventsAccumulate { event: "lands", time } if (time - rest).abs() < 1e-6),
            "{ending}"
        );
        assert!(lands.count() > 150 && motion.state().q[0].abs() < 1e-15);
        assert!(ending.to_string().contains("the events `lands` accumulate"), "{ending}");
    }
}

/// After an impact the motion starts at a zero, and leaves it to where it came from: that is no crossing back.
#[test]
fn leaving_a_zero_after_an_impact_is_no_crossing() {
    for square in [0.3_f64, 0.7, 1.9, 2.3, 3.1] {
        let height = square.sqrt();
        let ball = ball(9.81);
        // Mostly no number has this square: the function is not zero at its zero.
        let mut touches = ball.event("touches", |s| s.state().q[0].powi(2) - square);
        let mut motion = Motion::new(&ball, State::at_rest([height + 1.0]), Dop853::default()).unwrap();
        for bounce in 0..20 {
            let Crossing { state, rising, .. } =
                motion.advance_to_event(100.0, &mut [&mut touches]).unwrap().expect("a bounce");
            let expected = (2.0 / 9.81_f64).sqrt() * (3.0 - 2.0 * 0.5_f64.powi(bounce));
            assert!(!rising && (state.t - expected).abs() < 1e-7, "{bounce}: {}", state.t - expected);
            motion.set_state(State { v: -0.5 * state.v, ..state }).unwrap();
        }
    }
}

/// Zero at the start, at the middle of the step, and positive between: it lands once, whatever the round-off at either.
#[test]
fn a_bounce_that_lands_at_the_middle_of_a_step() {
    let (plane, units) = (Plane { g: 0.0 }, [-4.0, -1.0, 0.0, 0.5, 1.0, 4.0]);
    for (start, middle) in units.into_iter().flat_map(|start| units.map(|middle| (start, middle))) {
        for (height, width) in [(4e-5, 1.0), (1.0, 1.0), (1e-9, 0.004), (1e-3, 1e-5)] {
            let lands = plane.event("lands", |sample| {
                let [x, y] = sample.state().q.into();
                let x = x / width;
                // Less than the round-off of y, 10⁻¹⁵ a unit.
                let round_off = 1e-15 * if x < 0.5 { start } else { middle };
                height * x * (1.0 - x) + (y - 7.0) + round_off
            });
            let motion = plane.motion(State::new([0.0, 7.0], [1.0, 0.0]));
            let path = motion.by(RungeKutta4::with_step(2.0 * width)).event(lands.falling()).to(2.0 * width);
            let found: Vec<f64> =
                path.unwrap().crossings().iter().map(|found| found.state.t / width).collect();
            assert!(
                matches!(found[..], [t] if (t - 1.0).abs() < 1e-3),
                "{start} {middle} {height:e}: {found:?}"
            );
        }
    }
}
