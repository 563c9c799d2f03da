//! Mechanical systems for tests and benches, each derived once.

#![allow(missing_docs, reason = "the documentation of a system says what its fields are")]

mod balls;
mod blocks;
mod bobs;
mod chains;
mod floors;
mod oscillators;
mod pendulums;
mod planets;
mod rods;
mod rolling;
mod tops;

pub use balls::{Ball, Shaken, Slot, Walled};
pub use blocks::{Belt, Block, Puck, Stack};
pub use bobs::{DoubledRod, ShakenPendulum, TwoBobs};
pub use chains::{Chain, ChainOf, ChainOfFive};
pub use floors::{Flying, LeaningRod, SlidingRod, Thrown, Touching};
pub use oscillators::{DrivenSpring, HenonHeiles, PushedSpring, Spring, Sticking};
pub use pendulums::{BeadOnHoop, DoublePendulum, Foucault, Pendulum, PolarPendulum, SphericalPendulum};
pub use planets::{OuterSolarSystem, Planet, ThreeBodies};
pub use rods::{PoissonRod, Rod, Sphere};
pub use rolling::{BallInAngles, ChaplyginSleigh, KnifeEdge, TiedParticle};
pub use tops::HeavyTop;

use lagrange_core::State;
use lagrange_random::Random;

/// Returns a random state: coordinates and velocities of either sign, up to 1.5, and a time from 0 to 3.
pub fn random_state<const N: usize>(random: &mut Random) -> State<f64, N> {
    let (q, v) = (random.array(Random::signed), random.array(Random::signed));
    State::new(q, v).at_time(random.between(0.0, 3.0))
}
