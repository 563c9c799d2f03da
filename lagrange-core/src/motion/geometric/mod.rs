//! Methods that keep the structure of mechanics, with steps of one length.
//!
//! Their step is a symplectic or a reversible map. The energy of such a map swings about that of the motion, but does
//! not drift, for times that grow exponentially with 1/h (Hairer, Lubich and Wanner, *Geometric Numerical Integration*,
//! IX.8). Momenta of symmetries are kept to round-off.

mod composition;
mod dense;
mod fixed_step;
mod partitioned;
mod scheme;
mod settle;
mod stage_memory;
mod stages;
mod tableau;
mod verlet;

pub use composition::Composition;
pub use fixed_step::{FixedStep, FixedStepMemory};
pub use scheme::{CompensatedState, Scheme, SymmetricScheme};
pub use settle::NotSettled;
pub use stages::{DAlembert, Gauss, GaussLegendre, LagrangeDAlembert, Lobatto, LobattoPair, StageCount};
pub use verlet::{StormerVerlet, Verlet};
