//! Integration of a motion: the methods, and the loop that runs them from the start to the end.
//!
//! # Which method
//!
//! - [`Dop853`], an embedded pair of order 8, is the first choice, for errors of 10⁻⁵ … 10⁻⁹. A step takes 12
//!   evaluations of the accelerations. It also integrates ensembles on SIMD lanes, and motions in (q, p). Rounding
//!   limits its error to some 10⁻¹³.
//! - [`Taylor`], the Taylor series of the motion, is for errors from 10⁻⁹ down to round-off. A step takes one
//!   factorization and, for each order, one to two evaluations; the order is 13 for an error of 10⁻⁶ and 29 for
//!   round-off. Its time grows less with the required digits than the time of the other methods, and conserved
//!   quantities stay constant. It also integrates ensembles on SIMD lanes. It does not apply to (q, p), nor to
//!   equations with `abs`, `min`, `max`, `clamp`, [`WithDerivatives`](crate::function::WithDerivatives),
//!   [`Table`](crate::function::Table), [`SmoothTable`](crate::function::SmoothTable) or third derivatives of a
//!   [`Function`](crate::Function).
//! - [`Dopri5`], an embedded pair of order 5, is for errors of 10⁻³ and for forces that are not smooth. A step takes 6
//!   evaluations. It needs many steps for errors below 10⁻⁷.
//! - [`RungeKutta4`], of order 4, takes the same time for every step: control in real time. A step takes 4 evaluations.
//!   It does not estimate its error; compare with a run at half the step length.
//! - [`Radau`](crate::linearized::Radau), implicit and of order 5, 9 or 13, is for stiff systems: strong damping and steep
//!   friction. A step of order 5 takes some 7 evaluations, the derivatives of the accelerations, and two factorizations.
//!
//! Methods with steps of one length, whose map keeps the structure of mechanics, are for long motions whose energy must
//! not drift. The type of a system tells which apply; they do not estimate their error either:
//!
//! - [`Verlet`], of order 2 and [composed](Composition) up to 8, takes a constant mass matrix and forces without
//!   velocities; a step takes one evaluation of the forces. With holonomic constraints it is RATTLE.
//! - [`Gauss`], of order 2 to 8, takes every Lagrangian without constraints, and [`Lobatto`], of order 2 to 6, every one
//!   with holonomic constraints and a regular mass matrix. Their steps are implicit.
//! - [`DAlembert`], of order 2 and composed up to 8, takes constraints on velocities. It is reversible, and does not
//!   promise the energy.
//!
//! [`Radau`](crate::linearized::Radau) alone takes long steps on stiff systems. Explicit methods take steps as short as
//! the fastest decay, and the iterations of [`Gauss`], [`Lobatto`] and [`DAlembert`] do not converge for longer ones.
//!
//! A motion may end at an isolated pose where constraints become dependent, as in a linkage that folds flat.
//! [`Radau`](crate::linearized::Radau) steps across such a pose, and [`Taylor`] if it can; the other methods may continue on
//! another branch that begins there.
//!
//! The example `methods` prints the cost of an error for [`Dop853`], [`Taylor`] and [`Dopri5`] in eight systems, and
//! `long_time` draws it for all methods in six; the book shows both.

mod advance;
pub(crate) mod event;
pub(crate) use event::DynEvent;
pub(crate) mod geometric;
#[cfg(feature = "alloc")]
pub(crate) mod integration;
#[cfg(feature = "std")]
pub(crate) mod lanes;
pub(crate) mod limits;
pub(crate) mod method;
pub(crate) mod run;
pub(crate) mod simulate;
mod steered;
#[cfg(feature = "alloc")]
pub(crate) mod taylor;
#[cfg(test)]
mod tests;

pub use event::{AnyEvent, Event, EventFunction, EventValue};
pub use geometric::{
    CompensatedState, Composition, DAlembert, FixedStep, FixedStepMemory, Gauss, GaussLegendre,
    LagrangeDAlembert, Lobatto, LobattoPair, NotSettled, Scheme, StageCount, StormerVerlet, SymmetricScheme,
    Verlet,
};
#[cfg(feature = "std")]
pub use lanes::LaneMethod;
pub use method::{
    Adaptive, Dop853, Dopri5, DormandPrince54, DormandPrince853, Limits, Method, MultiplierBounds, Pair,
    RungeKutta4, Step, TableauRow, runge_kutta_step,
};
pub use simulate::Simulate;
pub use steered::Motion;
#[cfg(feature = "alloc")]
pub use {
    integration::builder::{AllSteps, EventList, HasEnding, Integrates, MotionBuilder, Start},
    integration::progress::Progress,
    integration::record::Arrival,
    integration::sampled::{Controls, Kept, SamplesAlone, Steered},
    taylor::{Taylor, TaylorPolynomial},
};

pub use crate::number::Parts;
pub use crate::solution::acceleration_field::{AccelerationField, AccelerationsAlone, Stated};
pub use crate::solution::consistent::assembly::Assembly;
pub use crate::solution::crossing::Crossing;
pub use crate::solution::energy_field::EnergyField;
pub use crate::solution::interpolant::{HermiteNode, Interpolant, Polynomial};
#[cfg(feature = "alloc")]
pub use crate::solution::many_body_field::{ManyBodyField, WithLagrangian};
pub use crate::solution::named_field::NamedField;
pub use crate::solution::system_checks::SystemChecks;
pub use crate::solution::vector_field::{
    ActiveConstraints, LagrangianVectorField, StagePoint, VectorField, VelocityField,
};
pub use crate::solution::{Adjustment, Consistent};
pub use crate::system::RightHandSides;
pub use crate::vector::PhaseVector;
