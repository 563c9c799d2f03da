//! Contacts in steps of one length.

mod abuse;
mod along;
mod frames;
mod grips;
mod holds;
mod landing;
mod law;

#[cfg(feature = "thorough")]
mod convergence;
#[cfg(feature = "thorough")]
mod law_between_bodies;
mod stiff;
#[cfg(feature = "thorough")]
mod tower;

use lagrange_core::contact::{ContactStepper, ForceDerivatives, TimeStep};

/// The start, and the steps until this time.
fn steps<L>(mut stepper: ContactStepper<L>, end: f64) -> Vec<TimeStep<L>>
where
    L: ForceDerivatives<Scalar = f64> + Clone,
{
    let mut steps = vec![*stepper.last()];
    while stepper.state().t < end {
        steps.push(*stepper.step().unwrap());
        assert!(stepper.last().residual <= 1e-8);
    }
    steps
}
