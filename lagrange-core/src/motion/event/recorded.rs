//! Events whose crossings are recorded, and events on the heap.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::marker::PhantomData;

use super::definition::{AnyEvent, DynEvent, sealed, watched_behind};
use super::dense::DenseStep;
use super::memory::EventState;
use super::noise::noise_beside;
use super::search::EventSearch;
use crate::error::{Ending, Error};
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::crossing::Crossing;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::VectorField;
use crate::system::{Solution, StateOf, System};
use crate::trajectory::Path;

impl<'e, W: AnyEvent<L>, L: System<Scalar: Real>> EventSearch<'e, W, L> {
    /// Records a crossing of each function that arrives at zero, but for round-off, where a leg ends; entries have these sizes.
    /// Returns the ending if one of them is terminal.
    pub(crate) fn record_at_end(
        events: &'e mut [W],
        system: &L,
        [end, sizes]: [&StateOf<L>; 2],
        crossings: &mut Vec<Crossing<L::Scalar, L::Length>>,
    ) -> Result<Option<Ending>, Error> {
        for event in events.iter_mut() {
            let (value, noise) = (event.value(system, end)?, noise_beside(event, system, end, sizes)?);
            event.memory().arrive_at_end(value, noise);
        }
        Ok(Self { events, subdivisions: 1, system: PhantomData }.record_due(end, crossings))
    }

    /// Records the crossings within a step. If the motion ends within it, returns the state there and the ending.
    #[inline]
    pub(crate) fn record<F: VectorField<L>, I: Interpolant<L::Scalar, L::Length>>(
        &mut self,
        step: &DenseStep<'_, L, F, I>,
        crossings: &mut Vec<Crossing<L::Scalar, L::Length>>,
    ) -> Option<(StateOf<L>, Ending)> {
        let mut at = step.before.clone();
        loop {
            match self.next(step, &mut at) {
                Ok(None) => return None,
                Ok(Some(crossing)) => crossings.push(crossing),
                Err(ending) => return Some((at, ending)),
            }
            if let Some(ending) = self.ending(crossings).or_else(|| self.record_due(&at, crossings)) {
                return Some((at, ending));
            }
        }
    }

    /// Records the crossings within the last step of a path, between these states. If the motion ends within the step,
    /// cuts the path there and returns the ending.
    // Inlined, so that the path stays in registers.
    #[inline(always)]
    pub(crate) fn record_in<F, I>(
        &mut self,
        path: &mut Path<L::Scalar, L::Length, Vec<I>>,
        crossings: &mut Vec<Crossing<L::Scalar, L::Length>>,
        system: &L,
        [before, after]: [&StateOf<L>; 2],
    ) -> Option<Ending>
    where
        F: VectorField<L>,
        I: Interpolant<L::Scalar, L::Length> + Send + Sync + 'static,
    {
        let interpolant = path.last_step()?;
        let step = DenseStep { system, before, after, interpolant, field: PhantomData::<F> };
        let (at, ending) = self.record(&step, crossings)?;
        path.cut(at);
        Some(ending)
    }

    /// Records the crossings at this state that have not been reported yet. Returns the ending if one of them is
    /// terminal.
    pub(crate) fn record_due(
        &mut self,
        at: &StateOf<L>,
        crossings: &mut Vec<Crossing<L::Scalar, L::Length>>,
    ) -> Option<Ending> {
        loop {
            match self.due(at) {
                Ok(None) => return None,
                Ok(Some(crossing)) => crossings.push(crossing),
                Err(ending) => return Some(ending),
            }
            if let Some(ending) = self.ending(crossings) {
                return Some(ending);
            }
        }
    }

    /// Returns the ending if the last crossing is terminal.
    fn ending(&mut self, crossings: &[Crossing<L::Scalar, L::Length>]) -> Option<Ending> {
        let Crossing { event, index, state, .. } = crossings.last()?;
        let is_terminal = self.events.get_mut(*index)?.memory().is_terminal();
        is_terminal.then(|| Ending::Event { time: state.t.to_f64(), event })
    }
}

impl<W: sealed::Sealed + ?Sized> sealed::Sealed for Box<W> {}

watched_behind!(Box<W>);

/// An event in a motion by time steps. Its function does not know accelerations and multipliers, which are means over a step.
pub(crate) struct EventInSteps<'e, L: System>(pub(crate) Box<DynEvent<'e, L>>);

impl<L: System> sealed::Sealed for EventInSteps<'_, L> {}

impl<L: System<Scalar: Real>> AnyEvent<L> for EventInSteps<'_, L> {
    fn value_of(&self, sample: &Sample<&L>) -> Result<L::Scalar, Error> {
        let value = self.0.value_of(&sample.clone().with(Some(Solution::unknown())));
        value.map_err(|error| match error {
            Error::EventNotFinite { event, time } => Error::EventInTimeSteps { event, time },
            error => error,
        })
    }

    fn memory(&mut self) -> &mut EventState<L::Scalar> {
        self.0.memory()
    }
}
