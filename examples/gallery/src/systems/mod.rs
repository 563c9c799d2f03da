//! The systems that are shown, a file each.

mod bead;
mod bouncing_ball;
mod carriage;
mod cart_pole;
mod chain;
mod chaplygin_sleigh;
mod double_pendulum;
mod flipping_body;
mod foucault_pendulum;
mod heavy_top;
mod henon_heiles;
mod ions;
mod polar_pendulum;
mod race;
mod robot_arm;
mod rocking_block;
mod rolling_ball;
mod rolling_coin;
mod rolling_cylinder;
mod spherical_pendulum;
mod stewart_platform;
mod three_bodies;
mod turntable;
mod woodpecker;

use lagrange_core::{Method, facts::Equations, prelude::*};

use crate::exhibit::{Exhibit, Knob};
use crate::running::{self, Opened};

/// A system that can be shown.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its name in links.
    pub key: &'static str,
    /// What it is called.
    pub title: &'static str,
    /// What to look at.
    pub about: &'static str,
    /// Its sliders.
    pub knobs: &'static [Knob],
    /// How much of its time passes in a second of watching.
    pub pace: f64,
    /// What the derive writes of it.
    pub equations: Equations,
    /// Whether its numbers have units.
    pub has_units: bool,
    /// Whether the derive found that the energy is conserved, and no contact takes of it.
    pub conserves_energy: bool,
    /// The names of its coordinates.
    pub coordinates: &'static [&'static str],
    pub(crate) open: fn(&[f64]) -> Opened,
}

/// The entry of an exhibit.
const fn entry<E, const K: usize>(key: &'static str) -> Entry
where
    E: Exhibit<K>,
    Dop853: Method<E>,
{
    Entry {
        key,
        title: E::TITLE,
        about: E::ABOUT,
        knobs: E::KNOBS,
        pace: E::PACE,
        equations: E::EQUATIONS,
        has_units: E::UNITS.is_some(),
        conserves_energy: E::FACTS.energy_is_conserved.is_some() && !E::HAS_CONTACTS,
        coordinates: E::COORDINATES,
        open: running::open::<E, K>,
    }
}

/// All of them, from pendulums to machines.
pub fn all() -> Vec<Entry> {
    vec![
        entry::<bead::Bead, _>("bead"),
        entry::<double_pendulum::DoublePendulum, _>("double-pendulum"),
        entry::<chain::Chain, _>("chain"),
        entry::<spherical_pendulum::SphericalPendulum, _>("spherical-pendulum"),
        entry::<polar_pendulum::PolarPendulum, _>("polar-pendulum"),
        entry::<foucault_pendulum::FoucaultPendulum, _>("foucault-pendulum"),
        entry::<race::Race, _>("race"),
        entry::<rolling_cylinder::RollingCylinder, _>("rolling-cylinder"),
        entry::<rolling_ball::RollingBall, _>("rolling-ball"),
        entry::<rolling_coin::RollingCoin, _>("rolling-coin"),
        entry::<chaplygin_sleigh::ChaplyginSleigh, _>("chaplygin-sleigh"),
        entry::<carriage::Carriage, _>("carriage"),
        entry::<turntable::Turntable, _>("turntable"),
        entry::<ions::StirredIons, _>("ions"),
        entry::<bouncing_ball::BouncingBall, _>("bouncing-ball"),
        entry::<rocking_block::RockingBlock, _>("rocking-block"),
        entry::<woodpecker::Woodpecker, _>("woodpecker"),
        entry::<heavy_top::HeavyTop, _>("heavy-top"),
        entry::<flipping_body::FlippingBody, _>("flipping-body"),
        entry::<stewart_platform::StewartPlatform, _>("stewart-platform"),
        entry::<robot_arm::RobotArm, _>("robot-arm"),
        entry::<cart_pole::CartPole, _>("cart-pole"),
        entry::<henon_heiles::HenonHeiles, _>("henon-heiles"),
        entry::<three_bodies::ThreeBodies, _>("three-bodies"),
    ]
}
