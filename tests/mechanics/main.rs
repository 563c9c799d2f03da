//! Every derivative that `derive(Lagrangian)` emits, against automatic differentiation.
//!
//! Each system states its Lagrangian, constraints and forces twice: in the attributes, and by hand as plain
//! functions of any dual number. The second route shares nothing with the macro. Jacobians of the accelerations are
//! compared with differences of the accelerations, and with dual numbers put through them.

mod by_hand;
mod conservation;
mod constants;
mod constrained;
mod expressions;
mod functions;
mod jacobian;
mod matrices;
mod particles;
mod vectors;

// Chains of bodies, and trees over five types of numbers, which take long to compile.
#[cfg(feature = "thorough")]
mod pendulums;
#[cfg(feature = "thorough")]
mod trees;
