//! The members' motions: right, and the same whoever is beside them.

use std::ops::ControlFlow;

use lagrange_core::{Ending, Method, nalgebra::Const, prelude::*};

use lagrange_random::cases;
use lagrange_systems::PushedSpring;

use crate::{COUNT, END, arrival, ensemble, member, on_threads, some};

/// The largest difference of an entry of a member on lanes from a motion alone.
fn strays<M>(on_lanes: &lagrange_core::ensemble::Outcome<f64, Const<2>>, method: M) -> f64
where
    M: Method<crate::DoublePendulum<f64>> + Copy,
{
    assert_eq!(on_lanes.completed().count(), COUNT);
    on_lanes.completed().step_by(cases([4, 1, 1])).fold(0.0, |most, (index, state)| {
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
}

#[cfg(feature = "thorough")]
#[test]
fn on_lanes_by_other_methods_too() {
    let method = Dopri5::with_tolerance(1e-11);
    let off = strays(&ensemble().integrate_on_lanes(END, method).unwrap(), Dop853::with_tolerance(1e-13));
    assert!(off < 1e-6, "{off:e}");
    let method = Dop853::default().fixed_step(0.003);
    let off = strays(&ensemble().integrate_on_lanes(END, method).unwrap(), Dop853::with_tolerance(1e-13));
    assert!(off < 1e-8, "{off:e}");
}

#[test]
fn neighbours_threads_and_order_change_no_bit() {
    let methods = [Dop853::default(), Dop853::default().fixed_step(0.02)];
    for method in methods.into_iter().take(cases([1, 2, 2])) {
        let whole = on_threads(1, || ensemble().integrate_on_lanes(END, method).unwrap());
        for threads in [2, 5] {
            assert_eq!(whole, on_threads(threads, || ensemble().integrate_on_lanes(END, method).unwrap()));
        }
        for index in some() {
            let alone = ensemble().shard(index, COUNT).integrate_on_lanes(END, method).unwrap();
            assert_eq!(alone.members(), &whole.members()[index..=index]);
        }
        let backwards = Ensemble::from_fn(COUNT, |index| member(COUNT - 1 - index));
        let backwards = backwards.integrate_on_lanes(END, method).unwrap();
        for (a, b) in whole.members().iter().zip(backwards.members().iter().rev()) {
            assert_eq!(a.result, b.result);
        }
    }
    let whole = on_threads(1, || ensemble().integrate(END, Dop853::default()).unwrap());
    assert_eq!(whole, on_threads(3, || ensemble().integrate(END, Dop853::default()).unwrap()));
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
            let found = member.arrival().unwrap();
            assert_eq!(matches!(found.ending, Ending::Cancelled { .. }), index % 2 == 0);
            assert!(found.state.t > 0.4 && found.ending.time() == found.state.t);
            let all_steps = arrival(&whole, index).statistics.accepted;
            assert!(index % 2 == 1 || found.statistics.accepted < all_steps);
        }
    }
    let count = std::sync::atomic::AtomicUsize::new(0);
    let counting = ensemble().observe(|_, _| {
        count.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        ControlFlow::Continue(())
    });
    let outcome = counting.integrate_on_lanes(END, Dop853::default()).unwrap();
    let steps = (0..COUNT).map(|index| arrival(&outcome, index).statistics.accepted);
    assert_eq!(count.into_inner(), steps.sum::<usize>());
}

#[test]
fn single_precision_and_lists_of_members_are_ensembles_too() {
    let members = [1.0_f32, 4.0, 9.0]
        .map(|k| (PushedSpring { m: 1.0_f32, k, ..PushedSpring::default() }, State::at_rest([1.0_f32])));
    let zero = members[0].0.event("zero", |s| s.state().q[0]);
    let outcome = Ensemble::new(&members).event(zero).integrate(2.0, Dopri5::with_tolerance(1e-5)).unwrap();
    for (index, state) in outcome.completed() {
        let omega = index as f32 + 1.0;
        assert!((state.q[0] - (2.0 * omega).cos()).abs() < 1e-4);
        let first = outcome.get(index).unwrap().arrival().unwrap().crossings[0].state.t * omega;
        assert!((first - std::f32::consts::FRAC_PI_2).abs() < 1e-3, "{first}");
    }
    assert_eq!(outcome.completed().count(), 3);
    let none: Ensemble<'_, PushedSpring<f32>> = Ensemble::new(&[]);
    assert!(none.integrate(1.0, Dopri5::default()).unwrap().members().is_empty());
}
