//! Contacts: gaps that close and open.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod abuse;
mod along;
mod coefficients;
mod friction;
mod frictionless;
mod going_on;
mod gripping;
mod rest;
mod restitution;
mod sensitivities;
mod shaken;
mod stepping;
mod switched;

// Costly to compile or to run: more systems and methods for what the modules above test.
#[cfg(feature = "thorough")]
mod differences;
#[cfg(feature = "thorough")]
mod excluded;
#[cfg(feature = "thorough")]
mod limits;
#[cfg(feature = "thorough")]
mod openings;
#[cfg(feature = "thorough")]
mod poisson;
#[cfg(feature = "thorough")]
mod rubbing_sensitivities;
#[cfg(feature = "thorough")]
mod shared;
#[cfg(feature = "thorough")]
mod spatial;
#[cfg(feature = "thorough")]
mod tables;
#[cfg(feature = "thorough")]
mod toys;
#[cfg(feature = "thorough")]
mod undetermined;

use lagrange_core::contact::Transition;
use lagrange_core::prelude::*;

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-13)
}

/// Times of the impacts.
fn impacts(transitions: &[Transition<f64>]) -> Vec<f64> {
    let is_impact = |of: &&Transition<f64>| matches!(of, Transition::Impact { .. });
    transitions.iter().filter(is_impact).map(Transition::time).collect()
}

/// Kinds of transitions, with what they are of.
#[cfg(feature = "thorough")]
fn kinds<L: Lagrangian>(path: &lagrange_core::Trajectory<L>) -> Vec<String> {
    let kind = |transition: &Transition<L::Scalar>| match transition {
        Transition::Impact { impulses, .. } => {
            format!("impact {:?}", impulses.iter().map(|(name, _)| *name).collect::<Vec<_>>())
        }
        Transition::Rests { contact, .. } => format!("rests {contact}"),
        Transition::Closes { contact, .. } => format!("closes {contact}"),
        Transition::Opens { contact, .. } => format!("opens {contact}"),
        Transition::Sticks { friction, .. } => format!("sticks {friction}"),
        Transition::Slips { friction, .. } => format!("slips {friction}"),
        Transition::Reverses { friction, .. } => format!("reverses {friction}"),
    };
    path.transitions().iter().map(kind).collect()
}

/// Random numbers by a linear congruence: the tests know motions of its numbers that once failed.
struct Congruence(u64);

impl Congruence {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Gap and force of a contact, velocity and force of its friction.
#[derive(Debug)]
struct Touch {
    gap: f64,
    press: f64,
    slip: [f64; 2],
    drag: [f64; 2],
}

impl Touch {
    /// Fails if the gap is negative, the contact pulls or acts at a distance, or friction leaves its cone or does not
    /// dissipate the most, by more than the four bounds: of gaps, of forces, of their product and of powers.
    #[track_caller]
    fn obeys(&self, at: &str, mu: f64, [gap, force, product, power]: [f64; 4]) {
        let [drag, speed] = [self.drag, self.slip].map(|[x, y]| x.hypot(y));
        let most = mu * self.press * speed;
        let is_lawful = self.gap > -gap
            && self.press > -force
            && self.press * self.gap < product
            && drag <= mu * self.press + force
            && -self.drag[0] * self.slip[0] - self.drag[1] * self.slip[1] > most - power;
        assert!(is_lawful, "{at}: {self:?}, mu = {mu}");
    }

    /// The same up to the errors of a motion by a tolerance of 10⁻⁹ or less.
    #[cfg(feature = "thorough")]
    #[track_caller]
    fn obeys_for_weight(&self, at: &str, mu: f64, weight: f64) {
        let force = 1e-6 * (weight + self.press.abs());
        let power = force * self.slip[0].hypot(self.slip[1]) + 1e-8;
        self.obeys(at, mu, [1e-9, force, 1e-8 * weight, power]);
    }
}
