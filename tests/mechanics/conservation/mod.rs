//! What the derive finds conserved, and that the motion does conserve it.

mod balance;
mod drift;
mod energy;
mod gauge;
mod integrability;
mod said;
mod structure;
mod symmetries;

// Motions by other methods, and forces that are zero at all random states.
#[cfg(feature = "thorough")]
mod balanced;
#[cfg(feature = "thorough")]
mod unseen;
