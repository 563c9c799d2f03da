//! A motion is computed: methods, and the run from the start to the ending.

#[cfg(feature = "std")]
mod batch;
pub(crate) mod event;
pub(crate) mod method;
#[cfg(feature = "std")]
mod record;
pub(crate) mod run;
#[cfg(feature = "std")]
mod seat;
pub(crate) mod simulate;
mod steered;
#[cfg(feature = "alloc")]
mod taylor;
#[cfg(test)]
mod tests;

#[cfg(feature = "std")]
pub(crate) use batch::Batch;
pub use event::{Crossing, Event, EventFunction, EventValue, Watched};
pub use method::{
    Adaptive, Combination, Dop853, Dopri5, DormandPrince54, DormandPrince853, Interpolant, Limits, Method,
    Node, Pair, Polynomial, RungeKutta4, Step, runge_kutta_step,
};
#[cfg(feature = "std")]
pub(crate) use record::{Orders, Record};
pub use run::Progress;
#[cfg(feature = "std")]
pub(crate) use seat::Seat;
pub use simulate::Simulate;
pub use steered::Motion;
#[cfg(feature = "alloc")]
pub use taylor::{Taylor, TaylorPolynomial};

pub use crate::solution::flow::{Basis, Flow, LagrangianFlow, Phase, PhasePoint};
