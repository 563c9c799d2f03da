//! Imports for a program that simulates a system: `use lagrange_core::prelude::*`. Other items are at the crate
//! root and in its modules.

pub use crate::derivatives::Linearized;
#[cfg(feature = "std")]
pub use crate::ensemble::Ensemble;
pub use crate::error::Error;
pub use crate::function::Function;
pub use crate::hamiltonian::Hamiltonian;
#[cfg(all(feature = "alloc", any(feature = "std", feature = "libm")))]
pub use crate::linearized::Radau;
pub use crate::motion::Simulate;
pub use crate::motion::{DAlembert, Dop853, Dopri5, Gauss, Lobatto, Motion, RungeKutta4, Verlet};
pub use crate::number::Scalar;
#[cfg(feature = "alloc")]
pub use crate::{
    linearized::MotionDerivatives, motion::Taylor, orbits::PeriodicMotion, system::ManyBodies,
    trajectory::Trajectory,
};
// Both the trait and the derive macro.
pub use crate::Lagrangian;
pub use crate::{PhaseState, State};
