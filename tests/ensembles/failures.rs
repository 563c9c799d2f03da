//! One bad member is reported by its index, with the reason, and spoils no other.

use lagrange_core::{Ending, prelude::*};
use lagrange_core::{
    Lanes, Pack,
    ensemble::{Member, Outcome},
    nalgebra::Const,
};

use lagrange_systems::DoublePendulum;

use crate::{COUNT, END, Runaway, arrival, ensemble, member, on_threads, steps};

const BAD: usize = 6;

/// The ensemble with another member in one place: on lanes, and one by one.
fn with(bad: fn() -> (DoublePendulum<f64>, State<f64, 2>)) -> [Outcome<f64, Const<2>>; 2] {
    let members = move |index: usize| if index == BAD { bad() } else { member(index) };
    let ensemble = || Ensemble::from_fn(COUNT, members);
    [
        on_threads(1, || ensemble().integrate_on_lanes(END, Dop853::default()).expect("an outcome")),
        ensemble().integrate(END, Dop853::default()).expect("an outcome"),
    ]
}

/// All others are as without it, bit for bit; what became of it.
fn alone_in_its_failure(outcomes: [Outcome<f64, Const<2>>; 2]) -> [Member<f64, Const<2>>; 2] {
    let well = [
        ensemble().integrate_on_lanes(END, Dop853::default()).expect("an outcome"),
        ensemble().integrate(END, Dop853::default()).expect("an outcome"),
    ];
    let mut outcomes = outcomes.into_iter().zip(well).map(|(outcome, well)| {
        for (member, well) in outcome.members().iter().zip(well.members()).filter(|(m, _)| m.index != BAD) {
            assert_eq!(member, well);
        }
        let failures: Vec<_> = outcome.failures().cloned().collect();
        assert_eq!((outcome.members().len(), failures.len(), failures[0].index), (COUNT, 1, BAD));
        failures[0].clone()
    });
    std::array::from_fn(|_| outcomes.next().expect("two outcomes"))
}

#[test]
fn parameters_that_are_no_numbers() {
    let members = alone_in_its_failure(with(|| {
        let (system, start) = member(BAD);
        (DoublePendulum { g: f64::NAN, ..system }, start)
    }));
    for member in members {
        assert!(matches!(member.result, Err(Error::ParameterNotFinite { .. })), "{member}");
        let message = member.to_string();
        assert!(message.starts_with("member 6: the parameter `g` is NaN"), "{message}");
    }
}

#[test]
fn a_start_that_is_no_number() {
    for member in alone_in_its_failure(with(|| (member(BAD).0, State::at_rest([0.1, f64::NAN])))) {
        assert!(matches!(member.result, Err(Error::StateNotFinite { .. })), "{member}");
    }
}

#[test]
fn a_singular_mass_matrix() {
    for member in alone_in_its_failure(with(|| {
        let (system, start) = member(BAD);
        (DoublePendulum { m: [1.0, 0.0], ..system }, start)
    })) {
        assert!(matches!(member.result, Err(Error::Singular { .. })), "{member}");
        assert!(member.to_string().contains("acceleration of `b`"), "{member}");
    }
}

#[test]
fn a_motion_without_end_ends_where_its_steps_do() {
    let members = |index: usize| match index {
        2 => (Runaway { k: 6.0 }, State::new([1.0], [2.0])),
        _ => (Runaway { k: 0.1 }, State::new([0.1 * index as f64], [0.0])),
    };
    stopped(members, 2.0, 2, |member| {
        let arrival = member.arrival().unwrap();
        let Ending::StepTooSmall { time, .. } = arrival.ending else { panic!("{member}") };
        assert_eq!(time, arrival.state.t);
        assert!((time - 1.0).abs() < 1e-2 && arrival.state.q[0] > 1e4, "{arrival:?}");
        assert!(member.to_string().starts_with("member 2: stopped at t = "), "{member}");
    });
}

#[cfg(feature = "thorough")]
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 + c*(1 - x)^(3/2))]
struct Cliff<T> {
    c: T,
}

#[cfg(feature = "thorough")]
#[test]
fn a_motion_to_where_nothing_is_defined_ends_there() {
    let members = |index: usize| (Cliff { c: 0.01 }, State::new([0.0], [if index == 5 { 1.0 } else { 0.1 }]));
    stopped(members, 4.0, 5, |member| {
        let Ending::NotFinite { time, .. } = member.arrival().unwrap().ending else { panic!("{member}") };
        assert!((time - 1.0).abs() < 0.02, "{member}");
    });
}

/// One of eight members stops; checks how, on lanes and one by one, and that the others do not notice.
fn stopped<L>(
    members: impl Fn(usize) -> (L, State<f64, 1>) + Send + Sync,
    end: f64,
    bad: usize,
    check: impl Fn(&Member<f64, Const<1>>),
) where
    L: Lagrangian<N = Const<1>, M = Const<0>, Scalar = f64>
        + Pack<Lanes, Packed: Lagrangian<N = Const<1>, M = Const<0>, Scalar = Lanes>>,
{
    // Without it, another stands in its place.
    let well = |index: usize| members(if index == bad { 0 } else { index });
    let run = |member: &(dyn Fn(usize) -> (L, State<f64, 1>) + Send + Sync)| {
        on_threads(1, || {
            Ensemble::from_fn(8, member).integrate_on_lanes(end, Dop853::default()).expect("an outcome")
        })
    };
    let (outcome, well) = (run(&members), run(&well));
    assert_eq!((outcome.completed().count(), well.completed().count()), (7, 8));
    for (member, well) in outcome.members().iter().zip(well.members()).filter(|(m, _)| m.index != bad) {
        assert_eq!(member, well);
    }
    check(outcome.get(bad).expect("a member"));
    let one_by_one = Ensemble::from_fn(8, members).integrate(end, Dop853::default()).expect("an outcome");
    check(one_by_one.get(bad).expect("a member"));
}

#[test]
fn a_limit_on_steps_ends_the_member_that_meets_it() {
    let limited = |steps| Dop853::default().max_steps(steps);
    let free = ensemble().integrate_on_lanes(END, limited(100_000)).unwrap();
    let needed = |index| steps(arrival(&free, index)).iter().sum::<usize>();
    let mut needed: Vec<usize> = (0..COUNT).map(needed).collect();
    needed.sort_unstable();
    let limit = needed[COUNT / 2];
    let outcome = ensemble().integrate_on_lanes(END, limited(limit)).unwrap();
    for (member, free) in outcome.members().iter().zip(free.members()) {
        let arrival = member.arrival().unwrap();
        match &arrival.ending {
            Ending::StepLimit { steps, time, .. } => {
                assert_eq!((*steps, *time), (limit, arrival.state.t));
                assert!(arrival.state.t < END && arrival.state.t > 0.0);
            }
            _ => assert_eq!(member, free),
        }
    }
    assert!(outcome.failures().count() > COUNT / 4);
}

#[test]
fn what_is_wrong_for_all_is_said_once() {
    let both = |part, parts, end, method| {
        let ensemble = || ensemble().shard(part, parts);
        [ensemble().integrate(end, method), ensemble().integrate_on_lanes(end, method)]
            .map(Result::unwrap_err)
    };
    // The last part is empty.
    for (part, parts) in [(0, 1), (2, 3), (COUNT + 2, COUNT + 3)] {
        for error in both(part, parts, END, Dop853::with_tolerance(-1.0)) {
            assert_eq!(error, Error::Setting { name: "relative tolerance", value: -1.0 });
        }
        for error in both(part, parts, f64::NAN, Dop853::default()) {
            assert_eq!(error.to_string(), "cannot integrate to t = NaN: the end must be finite");
        }
        for error in both(part, parts, f64::INFINITY, Dop853::default()) {
            assert_eq!(error, Error::EndNotFinite { end: f64::INFINITY });
        }
    }
    let error = ensemble().shard(3, 3).integrate(END, Dop853::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "there is no part 3 of 3: parts are counted from 0, and there is at least one"
    );
    assert!(ensemble().shard(0, 0).integrate(END, Dop853::default()).is_err());
}
