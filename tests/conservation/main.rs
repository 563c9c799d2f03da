//! What the derive finds conserved, and that the motion does conserve it.

mod drift;
mod gauge;
mod said;
mod symmetries;
