//! Samples of members at given times.

use std::ops::ControlFlow;

use lagrange_core::{Lanes, Method, Pack, ensemble::Outcome, nalgebra::Const, prelude::*};
use lagrange_random::cases;

use crate::{COUNT, END, Pendulum, Redundant, Runaway, arrival, ensemble, far, member, some, steps};

const TIMES: [f64; 9] = [0.0, 1e-9, 0.1, 0.1, 0.125, 0.5, 0.75, 0.999, END];

#[test]
fn one_by_one_samples_are_those_of_a_trajectory() {
    alone_and_sampled(Dop853::default());
    #[cfg(feature = "thorough")]
    alone_and_sampled(Dopri5::with_tolerance(1e-6));
    #[cfg(feature = "thorough")]
    alone_and_sampled(lagrange_core::RungeKutta4::with_step(0.01));
}

fn alone_and_sampled<P: Method<crate::DoublePendulum<f64>> + Copy + Sync>(method: P) {
    let plain = ensemble().integrate(END, method).expect("a motion");
    let sampled = ensemble().samples_at(TIMES).integrate(END, method).expect("a motion");
    for index in some() {
        let (system, start) = member(index);
        let path = system.integrate(start, END, method).expect("a motion");
        let expected = TIMES.map(|t| *path.at(t).expect("a motion").state());
        let (plain, sampled) = (arrival(&plain, index), arrival(&sampled, index));
        assert_eq!(sampled.samples, expected);
        assert_eq!((sampled.state, &sampled.ending), (plain.state, &plain.ending));
        assert_eq!(sampled.statistics.accepted, plain.statistics.accepted);
    }
}

#[test]
fn samples_on_lanes_change_no_bit_of_the_end_and_follow_the_motion() {
    let method = Dop853::with_tolerance(1e-12);
    let plain = ensemble().integrate_on_lanes(END, method).unwrap();
    let sampled = ensemble().samples_at(TIMES).integrate_on_lanes(END, method).unwrap();
    for index in some() {
        let (system, start) = member(index);
        let path = system.integrate(start, END, method).unwrap();
        let (plain, sampled) = (arrival(&plain, index), arrival(&sampled, index));
        assert_eq!((sampled.state, sampled.samples.last()), (plain.state, Some(&plain.state)));
        assert_eq!((sampled.samples[0], sampled.samples[2]), (start, sampled.samples[3]));
        assert_eq!(steps(sampled), steps(plain));
        // Three evaluations more for each step that has a sample within.
        let more = sampled.statistics.evaluations - plain.statistics.evaluations;
        assert!((6..=21).contains(&more) && more.is_multiple_of(3), "{more}");
        for (state, t) in sampled.samples.iter().zip(TIMES) {
            let alone = path.at(t).unwrap();
            let off = (state.q - alone.state().q).amax().max((state.v - alone.state().v).amax());
            assert!(state.t == t && off < 1e-8, "member {index} at {t} is off by {off:e}");
        }
    }
}

/// Samples are on the constraint; the energy is kept, and the pull that keeps a bob on its circle is
/// m v²/l − m g·r/l. Where constraints are not independent each step is taken alone.
#[test]
fn samples_are_on_the_constraints_and_have_quantities() {
    let l = |index: usize| 0.5 + 0.25 * index as f64;
    let start = |index: usize| State::at_rest([l(index) * 0.6, -l(index) * 0.8]);
    let times = || (0..60).map(|k| 0.03 * f64::from(k));
    let (m, g) = (2.0, 9.81);
    let single = Ensemble::from_fn(7, |k| (Pendulum { m, g, l: l(k), u: 0.0 }, start(k)))
        .samples_at(times())
        .quantity("pull", |s| s.observable("pull"))
        .quantity("energy", |s| s.energy());
    let double = Ensemble::from_fn(7, |k| (Redundant { m, g, l: l(k), c: 0.5 }, start(k)))
        .samples_at(times())
        .quantity("pull", |s| s.observable("pull"))
        .quantity("energy", |s| s.energy());
    let method = Dop853::with_tolerance(1e-11);
    let outcomes =
        [single.integrate_on_lanes(2.0, method).unwrap(), double.integrate_on_lanes(2.0, method).unwrap()];
    for outcome in &outcomes {
        for index in 0..7 {
            let samples = &arrival(outcome, index).samples;
            assert_eq!(samples.len(), 60);
            let pulls: Vec<f64> = outcome.quantity(index, "pull").unwrap().collect();
            let energies: Vec<f64> = outcome.quantity(index, "energy").unwrap().collect();
            assert_eq!((pulls.len(), energies.len()), (60, 60));
            for ((state, pull), energy) in samples.iter().zip(pulls).zip(energies) {
                let (r, v) = (state.q, state.v);
                let off = (r.norm() - l(index)).abs().max(r.dot(&v).abs());
                assert!(off < 1e-14, "{off:e}");
                let expected = -m * v.norm_squared() / l(index) + m * g * r[1] / l(index);
                assert!((pull - expected).abs() < 1e-11, "{pull} instead of {expected}");
                assert!((energy + m * g * 0.8 * l(index)).abs() < 1e-8, "{energy}");
            }
        }
        let error = outcome.quantity(0, "push").map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("`pull`"), "{error}");
    }
    assert!(arrival(&outcomes[0], 3).statistics.multipliers_are_unique);
    assert!(!arrival(&outcomes[1], 3).statistics.multipliers_are_unique);
}

/// Steps with sines of such angles are taken alone, and so is what lies within.
#[test]
fn what_the_lanes_cannot_do_is_done_alone_within_steps_too() {
    let (end, method) = (0.02 * cases([1, 5, 5]) as f64, Dop853::with_tolerance(1e-10));
    let times = [0.11, 0.5, 0.9].map(|part| part * end);
    let near = Ensemble::from_fn(4, member).samples_at(times).integrate_on_lanes(end, method).unwrap();
    let turned = Ensemble::from_fn(4, far).samples_at(times).integrate_on_lanes(end, method).unwrap();
    for index in [0, 1, 3] {
        assert_eq!(near.get(index), turned.get(index));
    }
    let (system, start) = far(2);
    let path = system.integrate(start, end, method).unwrap();
    assert_eq!(&arrival(&turned, 2).state, path.end().state());
    assert_eq!(arrival(&turned, 2).samples, times.map(|t| *path.at(t).unwrap().state()));
}

fn either<L>(
    make: impl Fn(usize) -> (L, State<f64, 1>) + Send + Sync + Copy,
    times: &[f64],
    end: f64,
    observer: impl Fn(usize, &State<f64, 1>) -> ControlFlow<()> + Send + Sync + Copy,
) -> [Outcome<f64, Const<1>>; 2]
where
    L: Lagrangian<N = Const<1>, M = Const<0>, Scalar = f64>
        + Pack<Lanes, Packed: Lagrangian<N = Const<1>, M = Const<0>, Scalar = Lanes>>,
{
    let runs = || Ensemble::from_fn(6, make).observe(observer).samples_at(times.iter().copied());
    let method = Dop853::with_tolerance(1e-11);
    [
        runs().integrate_on_lanes(end, method).expect("an outcome"),
        runs().integrate(end, method).expect("an outcome"),
    ]
}

#[test]
fn a_member_that_ends_early_has_its_samples_up_to_there() {
    let times: Vec<f64> = (0..=20).map(|k| 0.095 * f64::from(k)).collect();
    let runs = |index: usize| match index {
        3 => (Runaway { k: 6.0 }, State::new([1.0], [2.0])),
        _ => (Runaway { k: 1.0 }, State::at_rest([0.5])),
    };
    let cancel = |index: usize, state: &State<f64, 1>| match index == 4 && state.t > 0.75 {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    for outcome in either(runs, &times, 2.0, cancel) {
        let lost = arrival(&outcome, 3);
        assert!(lost.ending.is_failure());
        assert_eq!(lost.samples.len(), 11);
        for state in &lost.samples {
            assert!((state.q[0] * (1.0 - state.t).powi(2) - 1.0).abs() < 1e-7, "{state:?}");
        }
        let cancelled = arrival(&outcome, 4);
        let until = cancelled.ending.time();
        assert!(until > 0.75 && until < 2.0);
        assert_eq!(cancelled.samples.len(), times.iter().filter(|t| **t <= until).count());
        for index in [0, 1, 2, 5] {
            assert_eq!(arrival(&outcome, index).samples.len(), 21);
        }
    }
}

#[test]
fn times_go_back_where_the_motion_does_and_may_be_both_ends() {
    let runs = |index: usize| (Runaway { k: 6.0 }, State::new([1.0], [2.0]).at_time(0.1 * index as f64));
    for outcome in either(runs, &[0.0, -0.5, -1.0, -2.0], -2.0, |_, _| ControlFlow::Continue(())) {
        for index in 0..6 {
            let samples = &arrival(&outcome, index).samples;
            assert!(samples.iter().map(|state| state.t).eq([0.0, -0.5, -1.0, -2.0]));
            for state in samples {
                let since = state.t - 0.1 * index as f64;
                assert!((state.q[0] * (1.0 - since).powi(2) - 1.0).abs() < 1e-8, "{state:?}");
            }
        }
    }
    // A motion without length.
    let here = |_| (Runaway { k: 6.0 }, State::new([1.0], [2.0]).at_time(3.0));
    for outcome in either(here, &[3.0, 3.0], 3.0, |_, _| ControlFlow::Continue(())) {
        assert_eq!(arrival(&outcome, 5).samples, [State::new([1.0], [2.0]).at_time(3.0); 2]);
    }
}

#[test]
fn wrong_times_and_names_are_told() {
    let run = |times: &[f64]| {
        ensemble().samples_at(times.iter().copied()).integrate_on_lanes(END, Dop853::default())
    };
    for (times, wrong, index) in [
        (&[0.1, f64::NAN, 0.2][..], "NaN", 1),
        (&[f64::INFINITY], "inf", 0),
        (&[0.0, 0.2, 0.1], "0.1", 2),
        (&[0.0, 0.2, 0.2, 0.0], "0", 3),
        (&[0.5, 0.2, 0.3], "0.3", 2),
    ] {
        let error = run(times).unwrap_err();
        assert!(matches!(error, Error::SampleTime { index: i, .. } if i == index), "{error}");
        assert!(error.to_string().contains(&format!("{index} (counted from 0) is {wrong}:")), "{error}");
    }
    // In order, but not in that of the motion.
    for member in run(&[0.5, 0.2]).unwrap().members() {
        assert!(matches!(member.result, Err(Error::SampleTime { index: 1, .. })), "{member}");
    }
    for times in [&[0.5, 1.5][..], &[-0.5, 0.5], &[1.5], &[-1.0]] {
        let outcome = run(times).unwrap();
        for member in outcome.members() {
            assert!(
                matches!(member.result, Err(Error::OutsideTrajectory { start: 0.0, end: 1.0, .. })),
                "{member}"
            );
        }
    }
    let unknown = ensemble().samples_at([0.5]).quantity("c", |s| s.coordinate("c"));
    for member in unknown.integrate(END, Dop853::default()).unwrap().members() {
        assert!(matches!(member.result, Err(Error::UnknownName { .. })), "{member}");
    }
}

/// The function of a quantity gives up on the way: the member ends there, with what was kept, and no other does.
#[test]
fn a_quantity_that_cannot_be_had_ends_its_member() {
    let stops = ensemble().samples_at((0..10).map(|k| 0.1 * f64::from(k))).quantity("early", |s| {
        let is_bad = s.time() > 0.45 && s.system().m[0] == member(7).0.m[0];
        if is_bad { s.coordinate("nowhere") } else { Ok(s.time()) }
    });
    let outcome = stops.integrate_on_lanes(END, Dop853::default()).unwrap();
    for index in 0..COUNT {
        let (arrival, values) = (arrival(&outcome, index), outcome.quantity(index, "early").unwrap().count());
        assert_eq!(arrival.samples.len(), values);
        assert_eq!((values, arrival.ending.is_complete()), if index == 7 { (5, false) } else { (10, true) });
        assert!(index != 7 || (arrival.state.t, arrival.ending.time()) == (0.5, 0.5));
    }
}
