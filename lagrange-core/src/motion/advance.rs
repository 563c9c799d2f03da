//! Observers of a [`Motion`](super::Motion): advance to a time, or to the next crossing of an event.

use core::marker::PhantomData;

use super::Method;
use super::event::{AnyEvent, DenseStep, EventSearch};
use super::run::{Observer, Run, is_between};
use crate::error::Ending;
use crate::number::Real;
use crate::room::Within;
use crate::solution::crossing::Crossing;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::VectorField;
use crate::system::{StateOf, System};

/// State of the last step of a motion: its dense output, and whether it is still valid.
pub(super) struct LastStep<I> {
    /// Interpolant of the step, once it has been evaluated.
    pub(super) within: Within<I>,
    /// True if a step has led to the current state of the current system.
    pub(super) is_there: bool,
    /// True if the method knows the current system and state.
    pub(super) is_current: bool,
}

impl<I> LastStep<I> {
    /// Returns the value before the first step.
    pub(super) fn none() -> Self {
        Self { within: Within::default(), is_there: false, is_current: true }
    }

    pub(super) fn interpolant(&self) -> Option<&I> {
        self.within.first()
    }

    /// Invalidates the last step: after a change of the system or the state, and before a new step is tried.
    #[inline]
    pub(super) fn forget(&mut self) {
        self.within.clear();
        (self.is_there, self.is_current) = (false, false);
    }

    #[inline]
    fn is_taken(&mut self) {
        (self.is_there, self.is_current) = (true, true);
    }
}

/// Observer that steps towards `end` until a step reaches or passes `t`.
pub(super) struct GoPast<'m, L, I, T> {
    pub(super) system: &'m L,
    pub(super) last_step: &'m mut LastStep<I>,
    pub(super) t: T,
    pub(super) end: T,
}

impl<L, F, P> Observer<L, P, F> for GoPast<'_, L, P::Interpolant, L::Scalar>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
{
    fn system(&self) -> &L {
        self.system
    }

    #[inline]
    fn goal(&mut self, _: &P, run: &mut Run<L, P, F>) -> Result<Option<L::Scalar>, Ending> {
        let now = run.state.t;
        let goes_on = now != self.t && is_between(now, self.t, self.end);
        if goes_on {
            self.last_step.forget();
        }
        Ok(goes_on.then_some(self.end))
    }

    #[inline]
    fn keep(&mut self, _: &P, _: &mut Run<L, P, F>) -> Result<(), Ending> {
        self.last_step.is_taken();
        Ok(())
    }
}

/// Observer that steps to the first crossing, or to `end`.
pub(super) struct FindCrossing<'m, 'e, L: System, I> {
    pub(super) system: &'m L,
    pub(super) last_step: &'m mut LastStep<I>,
    pub(super) end: L::Scalar,
    pub(super) search: EventSearch<'m, &'e mut dyn AnyEvent<L>, L>,
    /// State up to which the events have been searched.
    pub(super) at: &'m mut StateOf<L>,
    pub(super) found: Option<Crossing<L::Scalar, L::Length>>,
}

impl<L: System<Scalar: Real>, I: Interpolant<L::Scalar, L::Length>> FindCrossing<'_, '_, L, I> {
    /// Searches the rest of the last step for a crossing.
    pub(super) fn look<F: VectorField<L>>(
        &mut self,
        before: &StateOf<L>,
        after: &StateOf<L>,
    ) -> Result<(), Ending> {
        if let Some(interpolant) = self.last_step.interpolant() {
            let step = DenseStep { system: self.system, before, after, interpolant, field: PhantomData::<F> };
            self.found = self.search.next(&step, self.at)?;
        }
        Ok(())
    }
}

impl<L, F, P> Observer<L, P, F> for FindCrossing<'_, '_, L, P::Interpolant>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
{
    fn system(&self) -> &L {
        self.system
    }

    fn goal(&mut self, _: &P, run: &mut Run<L, P, F>) -> Result<Option<L::Scalar>, Ending> {
        let goes_on = self.found.is_none() && run.state.t != self.end;
        if goes_on {
            self.last_step.forget();
        }
        Ok(goes_on.then_some(self.end))
    }

    fn follow(&mut self, method: &P, run: &mut Run<L, P, F>) -> Result<(), Ending> {
        run.look_within(self.system, method, &mut self.last_step.within)
    }

    fn keep(&mut self, _: &P, run: &mut Run<L, P, F>) -> Result<(), Ending> {
        self.last_step.is_taken();
        self.look::<F>(&run.before, &run.state)
    }
}
