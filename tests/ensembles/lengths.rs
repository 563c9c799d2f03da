//! Members whose numbers of coordinates are known when the program runs, and differ.

use lagrange_core::nalgebra::Dyn;
use lagrange_core::{Event, Sample, generic, prelude::*};

use lagrange_systems::{Chain, ChainOf};

const BETA: f64 = 0.7;

/// Chains of 1, 2, … masses.
fn chain(k: usize) -> (Chain, generic::State<f64, Dyn>) {
    (Chain { masses: 1 + k, beta: BETA }, Chain::start(1 + k))
}

/// Event: the first mass passes its place at rest to the right.
fn first_passes(chain: &Chain) -> Event<Chain, impl Fn(&Sample<&Chain>) -> f64 + Send + Sync + use<>> {
    chain.event("passes", |sample| sample.state().q[0]).rising()
}

#[test]
fn members_of_different_lengths_move_as_alone() {
    let energy = |sample: &Sample<&Chain>| sample.state().v.norm_squared() / 2.0;
    let steer = |chain: &mut Chain, state: &generic::State<f64, Dyn>| {
        chain.beta = BETA + 0.1 * state.q[0];
        Ok::<_, Error>(())
    };
    let chains = Ensemble::from_fn(12, chain).every(0.5).quantity("kinetic energy", energy);
    let chains =
        chains.event(first_passes(&chain(0).0)).controlled(2.0, move |_, chain, state| steer(chain, state));
    let outcome = chains.integrate(10.0, Dop853::default()).unwrap();
    assert_eq!(outcome.completed().count(), 12);
    for k in 0..12 {
        let (system, start) = chain(k);
        let motion = system.motion(start).every(0.5).quantity("kinetic energy", energy);
        let alone = motion.event(first_passes(&system)).controlled(2.0, steer).to(10.0).unwrap();
        let arrival = outcome.get(k).unwrap().arrival().unwrap();
        assert_eq!((&arrival.state, &arrival.samples[..]), (alone.end().state(), alone.samples()));
        assert_eq!((&arrival.crossings[..], &arrival.statistics), (alone.crossings(), alone.statistics()));
        assert_eq!((arrival.state.q.len(), alone.samples().len()), (1 + k, 21));
        assert!(!alone.crossings().is_empty());
        assert!(outcome.quantity(k, "kinetic energy").unwrap().eq(alone.quantity("kinetic energy").unwrap()));
    }
}

/// A constant length gives the same bits.
#[test]
fn lengths_do_not_change_results() {
    let method = Verlet::with_step(0.05);
    let at_run_time = Ensemble::from_fn(8, |k| {
        let mut start = Chain::start(3);
        start.v[1] = 0.1 * k as f64;
        (Chain { masses: 3, beta: BETA }, start)
    });
    let constant = Ensemble::from_fn(8, |k| {
        let mut start = ChainOf::<3>::start();
        start.v[1] = 0.1 * k as f64;
        (ChainOf::<3> { beta: BETA }, start)
    });
    let at_run_time = at_run_time.integrate(20.0, method).unwrap();
    let constant = constant.integrate(20.0, method).unwrap();
    for ((_, one), (_, other)) in at_run_time.completed().zip(constant.completed()) {
        assert_eq!(
            (one.t, one.q.as_slice(), one.v.as_slice()),
            (other.t, other.q.as_slice(), other.v.as_slice())
        );
    }
    assert_eq!(at_run_time.completed().count(), 8);
}

#[test]
fn a_start_of_another_length_fails_alone() {
    let bad = |k: usize| if k == 2 { (chain(2).0, Chain::start(7)) } else { chain(k) };
    let outcome = Ensemble::from_fn(4, bad).integrate(1.0, Dopri5::default()).unwrap();
    assert_eq!(outcome.completed().map(|(index, _)| index).collect::<Vec<_>>(), [0, 1, 3]);
    let failed = outcome.get(2).unwrap();
    assert_eq!(failed.result, Err(Error::StateLength { found: 7, expected: 3 }));
}

/// Parts are merged; a member with another start is told from one that was integrated already.
#[test]
fn parts_of_different_lengths_are_merged() {
    let part = |k| Ensemble::from_fn(6, chain).shard(k, 2).integrate(3.0, Dop853::default()).unwrap();
    let whole = Ensemble::from_fn(6, chain).integrate(3.0, Dop853::default()).unwrap();
    assert_eq!(part(0).merge(part(1)).unwrap(), whole);
    let longer = |k: usize| (Chain { masses: 2 + k, beta: BETA }, Chain::start(2 + k));
    let other = Ensemble::from_fn(6, longer).integrate(3.0, Dop853::default()).unwrap();
    assert!(whole.merge(other).unwrap_err().to_string().contains("the start or the parameters"));
}
