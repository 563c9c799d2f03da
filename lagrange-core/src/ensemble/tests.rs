//! Ensembles with and without the feature `rayon`; the workspace's `tests/ensemble` covers only the build with it.

#[cfg(feature = "tables")]
use core::ops::ControlFlow;

use crate::Pack;
use crate::motion::{Adaptive, Pair};
use crate::number::Lanes;
use crate::prelude::*;

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k/2 * x^2)]
struct Spring<T> {
    k: T,
}

const END: f64 = 1.0;

/// Springs with ω = 1, 2, …, whose motion is x = cos ωt.
fn springs<'a>() -> Ensemble<'a, Spring<f64>> {
    let omega = |index: usize| 1.0 + index as f64;
    Ensemble::from_fn(10, move |index| (Spring { k: omega(index).powi(2) }, State::at_rest([1.0])))
}

/// Pendulum in Cartesian coordinates; the members have radii 1, 2, ….
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
struct Circle<T> {
    g: T,
    l: T,
}

fn circles<'a>() -> Ensemble<'a, Circle<f64>> {
    let radius = |index: usize| 1.0 + index as f64;
    Ensemble::from_fn(10, move |index| {
        (Circle { g: 9.81, l: radius(index) }, State::at_rest([radius(index), 0.0]))
    })
}

#[test]
fn springs_arrive_on_lanes_and_one_by_one() {
    let method = Dop853::with_tolerance(1e-12);
    for outcome in [springs().integrate_on_lanes(END, method), springs().integrate(END, method)] {
        let outcome = outcome.expect("an outcome");
        assert_eq!(outcome.completed().count(), 10);
        for (index, state) in outcome.completed() {
            let off = state.q[0] - (1.0 + index as f64).cos();
            assert!(off.abs() < 1e-10, "member {index} is off by {off:e}");
        }
    }
}

/// Systems with sums, products and roots alone give the same bits and evaluations on lanes as alone.
#[test]
fn lanes_count_what_each_member_takes_alone() {
    let times = [0.0, 0.3, 0.6, END];
    let rejected = [
        count(|| springs().samples_at(times), Dop853::default().first_step(1.0)),
        count(|| springs().samples_at(times), Dopri5::default().first_step(1.0)),
        count(|| circles().samples_at(times), Dop853::default().first_step(1.0)),
        count(|| circles().samples_at(times), Dopri5::default().first_step(1.0)),
    ];
    assert!(!rejected.contains(&0));
}

/// With fixed steps, a lane evaluates the rates at the end of a step only when they are needed.
#[test]
fn lanes_count_fixed_steps_as_they_are_taken_alone() {
    let (fifth, eighth) = (Dopri5::default().fixed_step(0.05), Dop853::default().fixed_step(0.1));
    let times = [0.0, 0.3, 0.62, END];
    count(springs, fifth);
    count(springs, fifth.max_steps(7));
    count(springs, eighth);
    count(|| springs().samples_at(times), fifth);
    count(|| springs().samples_at(times), eighth);
    count(circles, fifth);
    count(|| circles().samples_at(times), eighth);
    let control = |_: usize, spring: &mut Spring<f64>, state: &State<f64, 1>| {
        spring.k += 0.1 * state.q[0];
        Ok::<_, Error>(())
    };
    count(|| springs().controlled(0.1, control), fifth);
    count(|| springs().controlled(0.13, control), fifth);
    count(|| springs().controlled(0.13, control), Dopri5::default());
}

fn count<L, P, const HAS_DENSE_OUTPUT: bool>(
    ensemble: impl Fn() -> Ensemble<'static, L, HAS_DENSE_OUTPUT>,
    method: Adaptive<P>,
) -> usize
where
    L: Lagrangian<Scalar = f64> + Pack<Lanes, Packed: Lagrangian<N = L::N, M = L::M, Scalar = Lanes>>,
    P: Pair,
    Adaptive<P>: Copy + Sync,
{
    let on_lanes = ensemble().integrate_on_lanes(END, method).expect("an outcome");
    let one_by_one = ensemble().integrate(END, method).expect("an outcome");
    assert_eq!(on_lanes.members().len(), one_by_one.members().len());
    for (member, alone) in on_lanes.members().iter().zip(one_by_one.members()) {
        // Compare results without fingerprints: these differ between the two runs.
        assert_eq!((member.index, &member.result), (alone.index, &alone.result));
    }
    let rejected = on_lanes.members().iter().filter_map(|member| Some(member.arrival()?.statistics.rejected));
    rejected.sum()
}

#[cfg(feature = "tables")]
#[test]
fn what_was_stopped_goes_on() {
    let method = Dop853::default();
    let stopped = springs().on_progress(|progress| match progress.done {
        4 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    });
    let first = stopped.integrate_on_lanes(END, method).expect("an outcome");
    assert_eq!(first.members().len(), 4);
    let rest = springs().resume(&first.json_lines().to_string()).expect("the same ensemble");
    let whole = springs().integrate_on_lanes(END, method).expect("an outcome");
    assert_eq!(rest.integrate_on_lanes(END, method).expect("an outcome"), whole);
}
