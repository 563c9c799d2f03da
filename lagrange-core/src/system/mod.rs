//! Systems: the trait that generated code implements, states, and compile-time facts.

pub(crate) mod defect;
mod direction;
mod entries;
pub(crate) mod equations;
mod evidence;
mod facts;
pub(crate) mod finite;
mod integrability;
mod lagrangian;
#[cfg(feature = "alloc")]
pub(crate) mod lookup;
#[cfg(feature = "alloc")]
mod many_bodies;
pub(crate) mod member;
mod moving;
mod pack;
pub(crate) mod pointers;
#[cfg(feature = "serde")]
pub(crate) mod serial;
mod state;
mod structure;
pub(crate) mod switch;
mod taylor_series;

pub(crate) use direction::unit;
pub use direction::{Direction, ResidualChange};
pub use entries::Entries;
pub use equations::{Equations, Excerpt};
pub use evidence::Evidence;
pub use facts::{Conserved, EnergyForm, Facts, LinearPart, TotalDerivative};
pub use integrability::{Classification, Extent, Integrability, Integrals};
pub use lagrangian::{ConstraintKind, Lagrangian};
pub(crate) use lagrangian::{check_contacts, check_friction, check_names, entry, has_velocity_constraints};
#[cfg(feature = "alloc")]
pub use many_bodies::ManyBodies;
pub use moving::System;
pub use pack::{Pack, Packed, Shared};
pub(crate) use state::write_state;
pub use state::{Solution, SolutionOf, State, StateOf};
pub use structure::{ConstantMassMatrix, HolonomicConstraints, Unconstrained, VelocityFreeForces};
pub use taylor_series::{RightHandSides, TaylorSeries};
