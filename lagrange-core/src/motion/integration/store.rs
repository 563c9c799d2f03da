//! Observer that stores all steps of a motion.

use alloc::vec::Vec;

use super::progress::{OnProgress, report};
use crate::error::{Ending, Error};
use crate::motion::event::{AnyEvent, EventSearch};
use crate::motion::method::Method;
use crate::motion::run::{Observer, Run};
use crate::number::Real;
use crate::solution::Adjustment;
use crate::solution::crossing::Crossing;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::VectorField;
use crate::statistics::Statistics;
use crate::system::{StateOf, System};
use crate::trajectory::{Leg, Legs, Path, Trajectory};

/// Observer that stores the steps, their dense output and the crossings of the events `W`. Without events `HAS_EVENTS`
/// is false, and the search is not compiled.
pub(crate) struct Stored<'a, 'e, L: System, W, I, const HAS_EVENTS: bool> {
    system: &'a L,
    end: L::Scalar,
    path: Path<L::Scalar, L::Length, Vec<I>>,
    crossings: Vec<Crossing<L::Scalar, L::Length>>,
    pub(crate) search: EventSearch<'e, W, L>,
    /// Ending at the start, if an event that is due there ends the motion.
    stopped: Option<Ending>,
    on_progress: Option<OnProgress<'e>>,
}

impl<'a, 'e, L, W, I, const HAS_EVENTS: bool> Stored<'a, 'e, L, W, I, HAS_EVENTS>
where
    L: System<Scalar: Real>,
    W: AnyEvent<L>,
    I: Interpolant<L::Scalar, L::Length> + Send + Sync + 'static,
{
    pub(crate) fn begin(
        system: &'a L,
        start: &StateOf<L>,
        end: L::Scalar,
        events: &'e mut [W],
        on_progress: Option<OnProgress<'e>>,
    ) -> Result<Self, Error> {
        let (path, mut crossings) = (Path::from(start.clone()), Vec::new());
        let mut search = EventSearch::begin(events, system, start)?;
        let stopped = search.record_due(start, &mut crossings);
        Ok(Self { system, end, path, crossings, search, stopped, on_progress })
    }

    /// Interpolants of the steps, to append one.
    #[inline(always)]
    pub(crate) fn interpolants(&mut self) -> &mut Vec<I> {
        self.path.interpolants()
    }

    pub(crate) fn finish<F>(
        self,
        driven: Result<(), Ending>,
        statistics: Statistics,
        adjustment: Adjustment<L::Scalar, L::Length>,
    ) -> Trajectory<&'a L, F> {
        let time = self.end.to_f64();
        let (leg, crossings) = self.into_leg(driven.as_ref().err());
        let ending = driven.err().unwrap_or(Ending::Complete { time });
        Trajectory::of(Legs(Vec::from([leg])), crossings, ending, statistics, adjustment)
    }

    /// The steps and the crossings of a motion, or of a leg, which ends so before its goal.
    pub(crate) fn into_leg<F>(
        self,
        ending: Option<&Ending>,
    ) -> (Leg<&'a L, F>, Vec<Crossing<L::Scalar, L::Length>>) {
        let boundary = match ending {
            Some(Ending::Event { event, .. }) => Some(*event),
            _ => None,
        };
        (Leg::new(self.system, self.path.finish(), boundary), self.crossings)
    }
}

impl<L, F, P, W, const HAS_EVENTS: bool> Observer<L, P, F>
    for Stored<'_, '_, L, W, P::Interpolant, HAS_EVENTS>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
    W: AnyEvent<L>,
{
    fn system(&self) -> &L {
        self.system
    }

    #[inline(always)]
    fn goal(&mut self, _: &P, run: &mut Run<L, P, F>) -> Result<Option<L::Scalar>, Ending> {
        match self.stopped.take() {
            Some(ending) => Err(ending),
            None => Ok((run.state.t != self.end).then_some(self.end)),
        }
    }

    #[inline(always)]
    fn follow(&mut self, method: &P, run: &mut Run<L, P, F>) -> Result<(), Ending> {
        run.look_within(self.system, method, self.path.interpolants())
    }

    #[inline(always)]
    fn keep(&mut self, _: &P, run: &mut Run<L, P, F>) -> Result<(), Ending> {
        self.path.push(run.state.clone());
        if const { HAS_EVENTS } {
            let ends = [&run.before, &run.state];
            let Self { search, path, crossings, system, .. } = self;
            search.record_in::<F, _>(path, crossings, system, ends).map_or(Ok(()), Err)?;
        }
        let times = [self.path.start(), run.state.t, self.end];
        report(&mut self.on_progress, times, run.statistics.accepted)
    }
}
