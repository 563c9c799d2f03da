//! Members with constraints stay on them.

use std::ops::ControlFlow;
use std::sync::Mutex;

use lagrange_core::motion::{Adaptive, Pair};
use lagrange_core::prelude::*;

use crate::{Pendulum, Redundant, arrival, noise, on_threads};

/// On a circle of its own radius, with a velocity along it.
pub(crate) fn member(index: usize) -> (Pendulum<f64>, State<f64, 2>) {
    let number = |entry| noise(index, entry);
    let (l, m, speed) = (0.5 + number(0), 1.0 + number(1), 4.0 * number(3) - 2.0);
    let (sin, cos) = (6.0 * number(2)).sin_cos();
    (Pendulum { m, g: 9.81, l, u: 0.0 }, State::new([l * cos, l * sin], [-speed * sin, speed * cos]))
}

pub(crate) fn twice(index: usize) -> (Redundant<f64>, State<f64, 2>) {
    let (angle, l) = (0.2 + noise(index, 0), 1.0 + noise(index, 1));
    (Redundant { m: 1.0, g: 9.81, l, c: 1.0 }, State::at_rest([l * angle.sin(), -l * angle.cos()]))
}

#[test]
fn every_step_of_every_member_ends_on_the_constraints() {
    let worst = Mutex::new((0.0_f64, 0.0_f64, 0_usize));
    let watched = Ensemble::from_fn(21, member).observe(|index, state| {
        let (system, start) = member(index);
        let phi = system.constraint_residual(state)[0].abs().max(system.constraint_rate(state)[0].abs());
        let energy = (system.energy(state) - system.energy(&start)).abs();
        let mut worst = worst.lock().unwrap();
        *worst = (worst.0.max(phi), worst.1.max(energy), worst.2 + 1);
        ControlFlow::Continue(())
    });
    let outcome = watched.integrate_on_lanes(3.0, Dop853::with_tolerance(1e-10)).unwrap();
    let (phi, energy, steps) = worst.into_inner().unwrap();
    assert_eq!(outcome.completed().count(), 21);
    assert!(steps > 21 * 50 && phi < 1e-13 && energy < 1e-7, "{steps}, {phi:e}, {energy:e}");
    for (index, state) in outcome.completed() {
        let (system, start) = member(index);
        let path = system.integrate(start, 3.0, Dop853::with_tolerance(1e-10)).unwrap();
        let off = (state.q - path.end().state().q).amax();
        assert!(off < 1e-7, "member {index} is off by {off:e}");
    }
}

#[test]
fn neighbours_change_no_bit_on_constraints_either() {
    neighbours_change_no_bit(Dop853::default());
    #[cfg(feature = "thorough")]
    neighbours_change_no_bit(Dopri5::with_tolerance(1e-6));
}

fn neighbours_change_no_bit<P: Pair + Copy + Sync>(method: Adaptive<P>) {
    let members = || Ensemble::from_fn(21, member);
    let run = || members().integrate_on_lanes(2.0, method).expect("an outcome");
    let whole = on_threads(1, run);
    assert_eq!((whole.completed().count(), &whole), (21, &on_threads(3, run)));
    for index in 0..21 {
        let alone = members().shard(index, 21).integrate_on_lanes(2.0, method).expect("an outcome");
        assert_eq!(alone.members(), &whole.members()[index..=index]);
    }
}

#[test]
fn constraints_that_depend_on_one_another_are_solved_alone() {
    let method = Dopri5::with_tolerance(0.1);
    let outcome = Ensemble::from_fn(9, twice).integrate_on_lanes(3.0, method).unwrap();
    assert_eq!(outcome.completed().count(), 9);
    for (index, state) in outcome.completed() {
        let (system, start) = twice(index);
        let path = system.integrate(start, 3.0, method).unwrap();
        assert_eq!(state, path.end().state(), "member {index}");
        assert!(!arrival(&outcome, index).statistics.multipliers_are_unique);
    }
}

#[test]
fn a_start_off_the_constraints_is_named() {
    let far = |index: usize| {
        let (system, start) = member(index);
        (system, if index == 3 { State::at_rest([1.0, 2.0]) } else { start })
    };
    let outcome = Ensemble::from_fn(8, far).integrate_on_lanes(1.0, Dop853::default()).unwrap();
    let failures: Vec<String> = outcome.failures().map(ToString::to_string).collect();
    assert_eq!(failures.len(), 1);
    assert!(
        failures[0].starts_with("member 3: the state violates constraint `rod` at t = 0"),
        "{}",
        failures[0]
    );
}
