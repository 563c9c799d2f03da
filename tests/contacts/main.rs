//! Contacts: gaps that close and open.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod abuse;
mod along;
mod bounds;
mod dropped_boxes;
mod excluded;
mod friction;
mod frictionless;
mod limits;
mod openings;
mod rest;
mod restitution;
mod rubbing_sensitivities;
mod sensitivities;
mod shared;
mod slipping;
mod stepping;
mod tables;
mod toys;
