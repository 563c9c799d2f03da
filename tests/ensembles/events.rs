//! Events of members, lane by lane.

use std::f64::consts::PI;

use lagrange_core::motion::{Adaptive, AnyEvent, Pair};
use lagrange_core::{Crossing, Ending, Sample, StateOf, ensemble::Arrival, nalgebra::Const, prelude::*};

use lagrange_systems::PushedSpring;

use crate::{COUNT, Pendulum, Runaway, arrival, ensemble, member, on_threads, some, steps};

/// A run alone has these crossings, ending and last state, bit for bit.
fn assert_alone<L, P>(
    arrival: &Arrival<f64, L::N>,
    (system, start): (L, StateOf<L>),
    end: f64,
    method: Adaptive<P>,
    events: &mut [&mut dyn AnyEvent<L>],
) where
    L: Lagrangian<Scalar = f64>,
    P: Pair + Copy,
{
    let path = system.motion(start).by(method).events(events).towards(end).expect("a start");
    assert_eq!(arrival.crossings, path.crossings());
    assert_eq!((&arrival.state, &arrival.ending), (path.end().state(), path.ending()));
    assert_eq!(steps(arrival), [path.statistics().accepted, path.statistics().rejected]);
}

#[test]
fn one_by_one_events_are_those_of_a_run() {
    let any = member(0).0;
    let upper = || any.event("upper", |s| s.coordinate("a")).terminal_at(2);
    let lower = || any.event("lower", |s| s.velocity("b")).rising().subdivide(2);
    let (end, method) = (2.0, Dop853::default());
    let outcome = ensemble().event(upper()).event(lower()).integrate(end, method).unwrap();
    let ended =
        outcome.members().iter().filter(|m| matches!(m.arrival().unwrap().ending, Ending::Event { .. }));
    assert!((5..COUNT).contains(&ended.count()) && outcome.failures().count() == 0);
    for index in some() {
        let (mut upper, mut lower) = (upper(), lower());
        assert_alone(arrival(&outcome, index), member(index), end, method, &mut [&mut upper, &mut lower]);
    }
}

/// Bit for bit, whoever is beside a member; by rounding as the motion alone.
#[test]
fn neighbours_and_threads_change_no_bit_of_an_event() {
    let any = member(0).0;
    let times = || (0..=100).map(|k| 0.03 * f64::from(k));
    let run = |indices: &[usize], threads| {
        let upper = any.event("upper", |s| s.state().q[0]).terminal_at(2);
        let lower = any.event("lower", |s| s.state().v[1]).rising();
        let few = ensemble().members(indices.iter().copied()).event(upper).event(lower).samples_at(times());
        on_threads(threads, || few.integrate_on_lanes(3.0, Dop853::with_tolerance(1e-12)).unwrap())
    };
    let all: Vec<usize> = (0..COUNT).collect();
    let whole = run(&all, 1);
    assert_eq!(whole, run(&all, 4));
    for index in some() {
        assert_eq!(run(&[index], 1).members(), &whole.members()[index..=index]);
        let (system, start) = member(index);
        let mut upper = any.event("upper", |s| s.state().q[0]).terminal_at(2);
        let mut lower = any.event("lower", |s| s.state().v[1]).rising();
        let path = system
            .motion(start)
            .by(Dop853::with_tolerance(1e-12))
            .event(&mut upper)
            .event(&mut lower)
            .towards(3.0)
            .unwrap();
        let found = arrival(&whole, index);
        assert_eq!(found.crossings.len(), path.crossings().len());
        for (on_lanes, alone) in found.crossings.iter().zip(path.crossings()) {
            assert_eq!((on_lanes.event, on_lanes.count), (alone.event, alone.count));
            assert!((on_lanes.state.t - alone.state.t).abs() < 1e-7);
        }
        // Samples end where the motion does.
        let until = found.ending.time();
        assert_eq!(found.samples.len(), times().filter(|t| *t <= until).count());
    }
}

const KINDS: usize = 8;

/// x = cos t, with the kind of event that a member is about and the level of that.
fn spring(index: usize) -> (PushedSpring<f64>, State<f64, 1>) {
    let mark = [(index % KINDS) as f64, -0.9 + 0.2 * (index / KINDS) as f64];
    (PushedSpring { m: 1.0, k: 1.0, mark, ..PushedSpring::default() }, State::at_rest([1.0]))
}

/// What each kind of member crosses; a one where it is about something else.
fn about(sample: &Sample<&PushedSpring<f64>>, event: f64) -> f64 {
    let (PushedSpring { mark: [kind, level], .. }, State { t, q, v }) = (**sample.system(), *sample.state());
    match (kind as usize, event as usize) {
        // Ends where x falls through the level, each at another time.
        (0, 0) => q[0] - level,
        // Ends with the third fall.
        (1, 1) => q[0],
        // At rest at the start, which is no crossing, and at π, 2π, ….
        (2, 2) => v[0],
        // Twice in a step.
        (3, 2) => (t - 1.0 - level) * (t - 1.5 - level),
        // Two of them at one time, the first of which ends the run.
        (4, 0 | 2) => 2.5 + level - t,
        // All but touches zero at 2π, 4π, …, by more than the error of the motion.
        (5, 2) => 1.0 + 1e-9 - q[0],
        // No number from some time on, and no zero before.
        (6, 2) => 1.0 + (4.0 + level - t).sqrt(),
        _ => 1.0,
    }
}

/// 64 members on lanes side by side, equal to the runs alone to the last bit: the equations are sums and products.
#[test]
fn different_events_of_sixty_four_members_are_found_as_the_rule_says() {
    let any = spring(0).0;
    let ends = || any.event("ends", |s| about(s, 0.0)).falling().terminal();
    let counted = || any.event("counted", |s| about(s, 1.0)).falling().terminal_at(3);
    let kept = || any.event("kept", |s| about(s, 2.0));
    let (end, method) = (20.0, Dop853::with_tolerance(1e-11));
    let springs = || Ensemble::from_fn(64, spring).event(ends()).event(counted()).event(kept());
    let outcome = springs().integrate_on_lanes(end, method).unwrap();
    for index in 0..64 {
        let (mut ends, mut counted, mut kept) = (ends(), counted(), kept());
        let events: &mut [&mut dyn AnyEvent<_>] = &mut [&mut ends, &mut counted, &mut kept];
        let found = arrival(&outcome, index);
        assert_alone(found, spring(index), end, method, events);
        let [kind, level] = spring(index).0.mark;
        let times: Vec<f64> = found.crossings.iter().map(|crossing| crossing.state.t).collect();
        let (expected, ending): (Vec<f64>, _) = match kind as usize {
            0 => (vec![level.acos()], "ends"),
            1 => ((0..3).map(|k| PI / 2.0 + 2.0 * PI * f64::from(k)).collect(), "counted"),
            2 => ((1..=6).map(|k| PI * f64::from(k)).collect(), "complete"),
            3 => (vec![1.0 + level, 1.5 + level], "complete"),
            4 => (vec![2.5 + level], "ends"),
            6 => (vec![], "no number"),
            _ => (vec![], "complete"),
        };
        assert_eq!(times.len(), expected.len(), "member {index}: {times:?}");
        for (t, expected) in times.iter().zip(&expected) {
            assert!((t - expected).abs() < 1e-9, "member {index}: {t} instead of {expected}");
        }
        match (&found.ending, ending) {
            (Ending::Event { event, time }, ending) => {
                assert_eq!((*event, Some(time), found.state.t), (ending, times.last(), *time));
            }
            (Ending::EventNotFinite { event: "kept", time }, "no number") => {
                assert!(*time <= 4.0 + level && *time > 3.0 + level && found.state.t == *time);
            }
            (ending, "complete") => assert!(ending.is_complete(), "{ending}"),
            (ending, expected) => panic!("member {index}: {ending} instead of {expected}"),
        }
    }
    assert_eq!(outcome.failures().count(), 8);
}

/// At one time the first given is reported, and ends the run before the other.
#[test]
fn events_at_one_time_come_in_the_order_given() {
    let any = spring(0).0;
    let one = any.event("one", |s| s.time() - 1.25);
    let two = any.event("two", |s| s.time() - 1.25).terminal();
    let three = any.event("three", |s| 1.25 - s.time());
    let outcome = Ensemble::from_fn(5, spring).event(one).event(two).event(three);
    let outcome = outcome.integrate_on_lanes(3.0, Dop853::default()).unwrap();
    for member in outcome.members() {
        let names = |crossing: &Crossing<f64, Const<1>>| (crossing.event, crossing.index, crossing.rising);
        let found = member.arrival().unwrap().crossings.iter().map(names);
        assert!(found.eq([("one", 0, true), ("two", 1, true)]), "{member:?}");
    }
}

/// sin ln x crosses zero ever faster on the way to t = 1: 1 − t falls by the same factor each time.
#[test]
fn a_storm_of_events_ends_its_member_alone() {
    let runs = |index: usize| match index {
        2 => (Runaway { k: 6.0 }, State::new([1.0], [2.0])),
        _ => (Runaway { k: 0.1 }, State::new([0.5 + 0.1 * index as f64], [0.0])),
    };
    let storm = || runs(0).0.event("storm", |s| s.state().q[0].ln().sin());
    let method = Dop853::with_tolerance(1e-12);
    let plain = Ensemble::from_fn(6, runs).integrate_on_lanes(2.0, method).unwrap();
    let outcome = Ensemble::from_fn(6, runs).event(storm()).integrate_on_lanes(2.0, method).unwrap();
    for index in 0..6 {
        let (found, mut storm) = (arrival(&outcome, index), storm());
        assert_alone(found, runs(index), 2.0, method, &mut [&mut storm]);
        if index == 2 {
            let Ending::EventsAccumulate { event: "storm", time } = found.ending else { panic!("{found:?}") };
            assert!((time - 1.0).abs() < 1e-6 && found.state.t == time);
            assert!((5..100).contains(&found.crossings.len()));
            for (k, crossing) in found.crossings.iter().take(4).enumerate() {
                let expected = 1.0 - (-PI * (k + 1) as f64 / 2.0).exp();
                assert!((crossing.state.t - expected).abs() < 1e-9, "{crossing:?}");
            }
        } else {
            assert_eq!(found.state, arrival(&plain, index).state);
        }
    }
}

/// From the top with the speed v, a bead leaves the sphere where cos θ = (2 + v²/(g a))/3.
#[test]
fn beads_leave_their_spheres_on_the_constraint() {
    let bead = |index: usize| {
        let a = 0.5 + 0.25 * index as f64;
        (Pendulum { m: 2.0, g: 9.81, l: a, u: 0.0 }, State::new([0.0, a], [0.1 + 0.05 * index as f64, 0.0]))
    };
    let leaves = || bead(0).0.event("leaves", |s| s.multiplier("rod")).falling().terminal();
    let method = Dop853::with_tolerance(1e-13);
    let outcome = Ensemble::from_fn(10, bead).event(leaves()).integrate_on_lanes(10.0, method).unwrap();
    for index in 0..10 {
        let (found, (system, start), mut leaves) = (arrival(&outcome, index), bead(index), leaves());
        assert_alone(found, (system, start), 10.0, method, &mut [&mut leaves]);
        let State { q, v, .. } = found.state;
        let off = (q.norm() / system.l - 1.0).abs().max(q.normalize().dot(&v.normalize()).abs());
        // Half of it is the rounding of what is measured here: lengths, quotients, products.
        assert!(off < 8.0 * f64::EPSILON, "{off:e}");
        let expected = (2.0 + start.v[0].powi(2) / (system.g * system.l)) / 3.0;
        let angle = (q[1] / system.l).acos();
        assert!((angle - expected.acos()).abs() < 1e-11, "{angle} instead of {}", expected.acos());
        assert!(found.crossings[0].state == found.state && found.crossings.len() == 1);
    }
}

/// An event that was of use before is as new for each member, and a function that is no number at the start is told.
#[test]
fn members_begin_anew_and_wrong_functions_are_told() {
    let (any, start) = spring(0);
    let mut third = any.event("third", |s| s.coordinate("x")).terminal_at(3);
    any.motion(start).event(&mut third).towards(5.0).unwrap();
    assert_eq!(third.count(), 2);
    let outcome = Ensemble::from_fn(3, spring).event(third).integrate(20.0, Dop853::default()).unwrap();
    for member in outcome.members() {
        assert!((member.arrival().unwrap().ending.time() - 2.5 * PI).abs() < 1e-7, "{member}");
    }
    let never = any.event("never", |_| f64::NAN);
    for member in Ensemble::from_fn(3, spring)
        .event(never)
        .integrate_on_lanes(1.0, Dop853::default())
        .unwrap()
        .members()
    {
        assert!(matches!(member.result, Err(Error::EventNotFinite { event: "never", .. })), "{member}");
    }
    let typo = any.event("typo", |s| s.velocity("x_dot"));
    for member in
        Ensemble::from_fn(3, spring).event(typo).integrate(1.0, Dop853::default()).unwrap().members()
    {
        assert!(matches!(member.result, Err(Error::UnknownName { .. })), "{member}");
    }
}
