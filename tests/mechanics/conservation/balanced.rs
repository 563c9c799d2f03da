//! The balance of the energy across contacts, and by other methods.

use lagrange_core::contact::{Contact, Friction};
use lagrange_core::prelude::*;

use super::balance::{Block, Thrown, driven};

/// A ball is thrown onto a floor that it bounces from and slides along, and a block sticks to a belt and slips.
#[test]
fn the_energy_is_balanced_across_contacts() {
    let thrown = Thrown { m: 2.0, g: 10.0, mu: 0.3, floor: Contact::Open };
    let motion = thrown.motion(State::new([0.0, 0.5], [2.0, 0.0])).by(Dop853::with_tolerance(1e-12));
    let path = motion.with_contacts().to(3.0).expect("a motion");
    let balance = *path.drift().get("energy - work").expect("a balance");
    assert!(balance.largest < 1e-9 && thrown.energy(path.end().state()) < 1e-9, "{balance:?}");
    let block = Block { m: 1.1, k: 4.0, speed: 0.2, hold: 2.0, pull: 1.0, belt: Friction::Sticks };
    let motion = block.motion(State::new([0.0], [0.2])).by(Dop853::with_tolerance(1e-12));
    let path = motion.with_contacts().to(10.0).expect("a motion");
    let balance = *path.drift().get("energy - work").expect("a balance");
    assert!(balance.largest < 1e-9 && path.transitions().len() >= 3, "{balance:?}");
    // The table has the balance in the place of the energy.
    let (said, name) = (path.drift().to_string(), "energy - work");
    assert!(
        said.lines().count() == 2 && said.lines().nth(1).is_some_and(|line| line.starts_with(name)),
        "{said}"
    );
}

/// `Taylor` is accurate to round-off in long steps. Each adds a few roundings of the energy.
#[test]
fn long_steps_are_balanced_to_round_off() {
    let driven = driven();
    let path = driven.integrate(State::new([0.8], [1.3]), 5.0, Taylor::default()).expect("a motion");
    let balance = *path.drift().get("energy - work").expect("a balance");
    let roundings = 8.0 * path.statistics().accepted as f64;
    assert!(balance.largest < roundings * f64::EPSILON * balance.start.abs(), "{balance:?}, {roundings}");
}

/// A motion with large steps has a balance that is as inaccurate.
#[test]
fn an_inaccurate_motion_shows_in_the_balance() {
    let of = |step: f64| {
        let driven = driven();
        let path = driven.integrate(State::new([0.8], [1.3]), 5.0, RungeKutta4::with_step(step));
        path.expect("a motion").drift().get("energy - work").expect("a balance").largest
    };
    let ratio = of(0.02) / of(0.01);
    assert!((8.0..32.0).contains(&ratio), "{ratio}");
}
