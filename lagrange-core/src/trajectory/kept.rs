//! What a trajectory keeps of its motion.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};

use super::leg::Leg;
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::vector_field::VectorField;
use crate::system::System;

/// States that a [`Trajectory`](crate::Trajectory) keeps of its motion: those of [all steps](Legs), or [samples](super::Samples) alone.
pub trait KeptStates<S: System> {
    /// Returns the system as it is at the end.
    fn system(&self) -> &S;

    /// Returns the first state.
    fn first(&self) -> Sample<&S>;

    /// Returns the last state.
    fn last(&self) -> Sample<&S>;

    /// True for a motion by [time steps](crate::contact::MoreauJean).
    fn is_in_time_steps(&self) -> bool;
}

/// All steps of a motion, with dense output: its legs between transitions, at least one. Transitions at the end of the motion are
/// followed by a leg without steps.
pub struct Legs<S: System, F>(pub(crate) Vec<Leg<S, F>>);

impl<S: System<Scalar: Real>, F: VectorField<S>> Debug for Legs<S, F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Legs").field(&self.0).finish()
    }
}

impl<S: System, F> Legs<S, F> {
    pub(super) fn leg_at_start(&self) -> &Leg<S, F> {
        &self.0[0]
    }

    pub(super) fn leg_at_end(&self) -> &Leg<S, F> {
        &self.0[self.0.len() - 1]
    }
}

impl<S: System<Scalar: Real>, F: VectorField<S>> KeptStates<S> for Legs<S, F> {
    fn system(&self) -> &S {
        self.leg_at_end().system()
    }

    fn first(&self) -> Sample<&S> {
        self.leg_at_start().first_sample()
    }

    fn last(&self) -> Sample<&S> {
        self.leg_at_end().last_sample()
    }

    fn is_in_time_steps(&self) -> bool {
        self.leg_at_start().is_in_time_steps()
    }
}
