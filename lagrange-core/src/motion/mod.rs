//! A motion is computed: methods, and the run from the start to the ending.
//!
//! # Which method
//!
//! - [`Dop853`], a pair of order 8, for errors of 10⁻⁵ … 10⁻⁹: the first choice. 12 evaluations of the accelerations a step; for
//!   ensembles on lanes and motion in (q, p) too. Rounding stops it at some 10⁻¹³.
//! - [`Taylor`], the series of the motion itself, for errors below 10⁻⁹ down to round-off: one factorisation a step and, for each
//!   order, 13 for 10⁻⁶ and 29 for round-off, one to two evaluations. Its time grows less with the digits asked for than that of the
//!   others, and what is conserved stays; for ensembles on lanes too. Not for equations with `abs`, `min`, `max`, `clamp`,
//!   [`WithDerivatives`](crate::function::WithDerivatives), [`Table`](crate::function::Table), [`SmoothTable`](crate::function::SmoothTable) or third derivatives of a [`Function`](crate::Function), nor for (q, p).
//! - [`Dopri5`], a pair of order 5, for errors of 10⁻³ and forces that are not smooth. 6 evaluations a step, of which it needs many
//!   below 10⁻⁷.
//! - [`RungeKutta4`], of order 4, where each step is to take as long as any other: control in real time. 4 evaluations; it does not know
//!   its error, which half the step tells.
//!
//! None is for stiff systems. Where constraints become dependent at one pose alone, as in a linkage that folds flat, a motion by
//! any of them may end; [`Taylor`] steps across where it can, the others may go on along another branch that begins there. The example `methods` prints what an error costs by
//! the first three in eight systems; the book has its table.

mod advance;
#[cfg(feature = "alloc")]
pub(crate) mod builder;
pub(crate) mod event;
#[cfg(feature = "std")]
mod lanes;
pub(crate) mod method;
#[cfg(feature = "alloc")]
pub(crate) mod record;
pub(crate) mod run;
#[cfg(feature = "alloc")]
mod sampled;
pub(crate) mod simulate;
mod steered;
#[cfg(feature = "alloc")]
pub(crate) mod store;
#[cfg(feature = "alloc")]
pub(crate) mod taylor;
#[cfg(test)]
mod tests;

#[cfg(feature = "alloc")]
pub use builder::{AllSteps, EventList, MotionBuilder, Start};
pub use event::{AnyEvent, Event, EventFunction, EventValue};
#[cfg(feature = "std")]
pub use lanes::LaneMethod;
#[cfg(feature = "std")]
pub(crate) use lanes::{Batch, LaneMotion};
pub use method::{
    Adaptive, Dop853, Dopri5, DormandPrince54, DormandPrince853, Limits, Method, Pair, RungeKutta4, Step,
    TableauRow, runge_kutta_step,
};
#[cfg(feature = "alloc")]
pub use record::Arrival;
pub use run::Progress;
#[cfg(feature = "alloc")]
pub use sampled::{Kept, SamplesAlone};
pub use simulate::Simulate;
pub use steered::Motion;
#[cfg(feature = "alloc")]
pub use taylor::{Taylor, TaylorPolynomial};

pub use crate::solution::crossing::Crossing;
pub use crate::solution::interpolant::{HermiteNode, Interpolant, Polynomial};
pub use crate::solution::vector_field::{
    ActiveConstraints, LagrangianVectorField, PhaseVector, StagePoint, VectorField,
};
pub use crate::solution::{Adjustment, Consistent};
pub use crate::system::RightHandSides;
