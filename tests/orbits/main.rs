//! Orbits that close: monodromy matrices, periodic orbits, and families of them.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod bifurcations;
mod messages;
mod monodromy;
mod printing;
mod shooting;
mod systems;

// Further systems, of which each takes the compiler seconds.
#[cfg(feature = "thorough")]
mod families;
#[cfg(feature = "thorough")]
mod stars;
