//! Contacts: gaps that close and open.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod abuse;
mod along;
mod bounds;
mod excluded;
mod friction;
mod frictionless;
mod limits;
mod openings;
mod poisson;
mod rest;
mod rubbing_sensitivities;
mod sensitivities;
mod shared;
mod slipping;
mod tables;
mod toys;

/// A number that an environment variable states, for the long checks.
fn count(variable: &str, default: usize) -> usize {
    std::env::var(variable).map_or(default, |text| text.parse().unwrap())
}
