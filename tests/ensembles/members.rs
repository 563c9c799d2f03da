//! The members' motions: right, and the same whoever is beside them.

use std::ops::ControlFlow;

use lagrange_core::{Ending, Method, nalgebra::Const, prelude::*};

use crate::{COUNT, END, ensemble, member, noise, on_threads};

#[test]
fn one_by_one_each_member_moves_as_it_does_alone() {
    let outcome = ensemble().integrate(END, Dop853::default()).unwrap();
    assert_eq!(outcome.members().len(), COUNT);
    for (index, state) in outcome.completed() {
        let (system, start) = member(index);
        let path = system.integrate(start, END, Dop853::default()).unwrap();
        assert_eq!(state, path.end().state(), "member {index}");
        let statistics = outcome.get(index).unwrap().arrival().unwrap().statistics;
        let alone = path.statistics();
        assert_eq!((statistics.accepted, statistics.rejected), (alone.accepted, alone.rejected));
        assert!(statistics.evaluations < alone.evaluations, "interpolants are not needed");
    }
}

/// The largest difference of an entry of a member on lanes from a motion alone.
fn strays<M>(on_lanes: &lagrange_core::ensemble::Outcome<f64, Const<2>>, method: M) -> f64
where
    M: Method<crate::DoublePendulum<f64>> + Copy,
{
    assert_eq!(on_lanes.completed().count(), COUNT);
    on_lanes.completed().fold(0.0, |most, (index, state)| {
        let (system, start) = member(index);
        let path = system.integrate(start, END, method).expect("a consistent start");
        let exact = path.end();
        most.max((state.q - exact.state().q).amax()).max((state.v - exact.state().v).amax())
    })
}

/// The rounding of sines and sums differs, the motions are chaotic, and the tolerance is what both keep.
#[test]
fn on_lanes_each_member_moves_as_it_does_alone() {
    let method = Dop853::with_tolerance(1e-12);
    let off = strays(&ensemble().integrate_on_lanes(END, method).unwrap(), method);
    assert!(off < 1e-8, "{off:e}");
    let method = Dopri5::with_tolerance(1e-11);
    let off = strays(&ensemble().integrate_on_lanes(END, method).unwrap(), Dop853::with_tolerance(1e-13));
    assert!(off < 1e-6, "{off:e}");
    let method = Dop853::default().fixed_step(0.003);
    let off = strays(&ensemble().integrate_on_lanes(END, method).unwrap(), Dop853::with_tolerance(1e-13));
    assert!(off < 1e-8, "{off:e}");
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*x^2 + m*x*cos(5*t))]
pub(crate) struct Spring<T> {
    pub(crate) m: T,
    pub(crate) k: T,
}

/// Where a spring driven by cos 5t is, and how fast, with x = 0.5 and ẋ = −1 at the time `from`.
pub(crate) fn driven(omega: f64, from: f64, t: f64) -> (f64, f64) {
    let forced =
        |t: f64| ((5.0 * t).cos() / (omega.powi(2) - 25.0), -5.0 * (5.0 * t).sin() / (omega.powi(2) - 25.0));
    let (a, b) = (0.5 - forced(from).0, (-1.0 - forced(from).1) / omega);
    let (sin, cos) = (omega * (t - from)).sin_cos();
    (a * cos + b * sin + forced(t).0, omega * (b * cos - a * sin) + forced(t).1)
}

/// Each ends at the right place for its own parameters, start and starting time.
#[test]
fn springs_swing_as_they_should() {
    let k = |index: usize| 1.0 + 20.0 * noise(index, 0);
    let from = |index: usize| 2.0 * noise(index, 1);
    let springs = Ensemble::from_fn(50, |index| {
        (Spring { m: 2.0, k: k(index) }, State::new([0.5], [-1.0]).at_time(from(index)))
    });
    let outcome = springs.integrate_on_lanes(7.0, Dop853::with_tolerance(1e-12)).unwrap();
    assert_eq!(outcome.completed().count(), 50);
    for (index, state) in outcome.completed() {
        let (x, v) = driven((k(index) / 2.0).sqrt(), from(index), 7.0);
        let off = (state.q[0] - x).hypot(state.v[0] - v);
        assert!(state.t == 7.0 && off < 1e-9, "member {index} is off by {off:e}");
    }
}

#[test]
fn neighbours_threads_and_order_change_no_bit() {
    for method in [Dop853::default(), Dop853::default().fixed_step(0.02)] {
        let whole = on_threads(1, || ensemble().integrate_on_lanes(END, method).unwrap());
        for threads in [2, 5] {
            assert_eq!(whole, on_threads(threads, || ensemble().integrate_on_lanes(END, method).unwrap()));
        }
        for index in 0..COUNT {
            let alone = ensemble().shard(index, COUNT).integrate_on_lanes(END, method).unwrap();
            assert_eq!(alone.members(), &whole.members()[index..=index]);
        }
        let backwards = Ensemble::from_fn(COUNT, |index| member(COUNT - 1 - index));
        let backwards = backwards.integrate_on_lanes(END, method).unwrap();
        for (a, b) in whole.members().iter().zip(backwards.members().iter().rev()) {
            assert_eq!(a.result, b.result);
        }
    }
    let whole = on_threads(1, || ensemble().integrate(END, Dopri5::default()).unwrap());
    assert_eq!(whole, on_threads(3, || ensemble().integrate(END, Dopri5::default()).unwrap()));
}

/// Beyond 10⁸ rad the lanes have no sines; those steps are taken alone, and only those.
#[test]
fn a_large_angle_is_no_wrong_number() {
    let far = |index: usize| if index == 2 { 2e9 * std::f64::consts::PI } else { 0.0 };
    let members = |index: usize| {
        let (system, start) = member(index);
        (system, State::at_rest(start.q.add_scalar(far(index))))
    };
    let (end, method) = (0.1, Dop853::with_tolerance(1e-10));
    let near = Ensemble::from_fn(4, member).integrate_on_lanes(end, method).unwrap();
    let turned = Ensemble::from_fn(4, members).integrate_on_lanes(end, method).unwrap();
    for index in [0, 1, 3] {
        assert_eq!(near.get(index), turned.get(index));
    }
    let (system, start) = members(2);
    let path = system.integrate(start, end, method).unwrap();
    let state = turned.get(2).unwrap().arrival().unwrap().state;
    assert_eq!(&state, path.end().state());
}

#[test]
fn the_observer_sees_every_step_and_ends_a_member() {
    let turns = |index: usize, state: &State<f64, 2>| match index.is_multiple_of(2) && state.t > 0.4 {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let whole = ensemble().integrate_on_lanes(END, Dop853::default()).unwrap();
    for outcome in [
        ensemble().observe(turns).integrate_on_lanes(END, Dop853::default()).unwrap(),
        ensemble().observe(turns).integrate(END, Dop853::default()).unwrap(),
    ] {
        assert_eq!(outcome.failures().count(), 0);
        for (index, member) in outcome.members().iter().enumerate() {
            let arrival = member.arrival().unwrap();
            assert_eq!(matches!(arrival.ending, Ending::Cancelled { .. }), index % 2 == 0);
            assert!(arrival.state.t > 0.4 && arrival.ending.time() == arrival.state.t);
            let all_steps = whole.get(index).unwrap().arrival().unwrap().statistics.accepted;
            assert!(index % 2 == 1 || arrival.statistics.accepted < all_steps);
        }
    }
    let count = std::sync::atomic::AtomicUsize::new(0);
    let counting = ensemble().observe(|_, _| {
        count.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        ControlFlow::Continue(())
    });
    let outcome = counting.integrate_on_lanes(END, Dop853::default()).unwrap();
    let steps = |member: &lagrange_core::ensemble::Member<f64, Const<2>>| {
        member.arrival().unwrap().statistics.accepted
    };
    assert_eq!(count.into_inner(), outcome.members().iter().map(steps).sum::<usize>());
}

#[test]
fn single_precision_and_lists_of_members_are_ensembles_too() {
    #[derive(Lagrangian, Clone)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - k/2*x^2)]
    struct Single {
        k: f32,
    }
    let members = [1.0_f32, 4.0, 9.0].map(|k| (Single { k }, State::at_rest([1.0_f32])));
    let outcome = Ensemble::new(&members).integrate(1.0, Dopri5::with_tolerance(1e-5)).unwrap();
    for (index, state) in outcome.completed() {
        assert!((state.q[0] - (index as f32 + 1.0).cos()).abs() < 1e-4);
    }
    assert_eq!(outcome.completed().count(), 3);
    let none: Ensemble<'_, Single> = Ensemble::new(&[]);
    assert!(none.integrate(1.0, Dopri5::default()).unwrap().members().is_empty());
}
