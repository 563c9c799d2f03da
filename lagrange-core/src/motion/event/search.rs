//! Steps are searched for the crossings of events, piece by piece.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use core::marker::PhantomData;

use super::chebyshev::{COARSEST, FINEST, part, places};
use super::definition::AnyEvent;
use super::dense::DenseStep;
use super::halves::{Halves, LEVELS};
use super::locate::locate;
use super::memory::{Interval, View};
use super::noise::noise;
use crate::error::{Ending, Error};
use crate::number::{Real, Scalar, larger};
use crate::solution::crossing::Crossing;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::VectorField;
use crate::system::{Lagrangian, State};
#[cfg(feature = "alloc")]
use crate::trajectory::Path;

/// Where a look at an interval leads.
enum Look {
    /// To its end.
    Passed,
    /// To a crossing.
    Crossed,
    /// To its first half.
    Halve,
}

/// So many intervals are looked at on the way to one crossing; after that, no interval is halved.
const MOST_INTERVALS: usize = 4096;

/// The events `W` that a motion is searched for.
pub(crate) struct EventSearch<'e, W, L: Lagrangian<N, M>, const N: usize, const M: usize> {
    pub(crate) events: &'e mut [W],
    /// How many subdivisions every step is looked at in, at least.
    pub(crate) subdivisions: usize,
    pub(crate) system: PhantomData<fn(&L)>,
}

impl<'e, W, L, const N: usize, const M: usize> EventSearch<'e, W, L, N, M>
where
    W: AnyEvent<L, N, M>,
    L: Lagrangian<N, M, Scalar: Real>,
{
    /// From the start of a run on.
    #[cfg(feature = "alloc")]
    pub(crate) fn begin(events: &'e mut [W], system: &L, state: &State<L::Scalar, N>) -> Result<Self, Error> {
        events.iter_mut().for_each(|event| event.memory().begin_run());
        Self::from(events, system, state, true)
    }

    /// From here on. `is_new` tells that no step led here.
    pub(crate) fn from(
        events: &'e mut [W],
        system: &L,
        state: &State<L::Scalar, N>,
        is_new: bool,
    ) -> Result<Self, Error> {
        let mut subdivisions = 1;
        for event in events.iter_mut() {
            let value = event.value(system, state)?;
            let start = if is_new { Some(noise(event, system, state)?) } else { None };
            let memory = event.memory();
            memory.begin(value, state.t, start);
            subdivisions = subdivisions.max(memory.subdivisions);
        }
        Ok(Self { events, subdivisions, system: PhantomData })
    }

    /// The first crossing after `from`, which moves there, or to the end of the step where there is none.
    ///
    /// # Errors
    /// Why the motion ends at `from`.
    pub(crate) fn next<F, I>(
        &mut self,
        step: &DenseStep<'_, L, F, I, N, M>,
        from: &mut State<L::Scalar, N>,
    ) -> Result<Option<Crossing<L::Scalar, N>>, Ending>
    where
        F: VectorField<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let (start, mut intervals) = (from.t, 0);
        for piece in 1..=self.subdivisions {
            let mut halves = Halves::of([from.t, step.mark(start, piece, self.subdivisions)]);
            while step.is_ahead(from.t, step.after.t) {
                let end = halves.end();
                if step.is_ahead(from.t, end) {
                    intervals += 1;
                    let may_halve = intervals < MOST_INTERVALS && halves.level < LEVELS;
                    match self.look(step, from, end, may_halve) {
                        Ok(Look::Passed) => {}
                        Ok(Look::Crossed) => return self.due(from),
                        Ok(Look::Halve) => {
                            halves.halve();
                            continue;
                        }
                        Err(error) => return Err(Ending::of(error, from.t.to_f64())),
                    }
                }
                if !halves.advance() {
                    break;
                }
            }
        }
        Ok(None)
    }

    /// Reports a crossing at `state` that has not been reported yet.
    pub(crate) fn due(
        &mut self,
        state: &State<L::Scalar, N>,
    ) -> Result<Option<Crossing<L::Scalar, N>>, Ending> {
        for (index, event) in self.events.iter_mut().enumerate() {
            let memory = event.memory();
            if let Some(rising) = memory.due.take() {
                memory.cross(state.t)?;
                let (event, count) = (memory.name, memory.count);
                return Ok(Some(Crossing { event, index, count, rising, state: *state }));
            }
        }
        Ok(None)
    }

    /// Writes down the crossings within a step; where and why the motion ends within it, if it does.
    #[cfg(feature = "alloc")]
    #[inline]
    pub(crate) fn record<F, I>(
        &mut self,
        step: &DenseStep<'_, L, F, I, N, M>,
        crossings: &mut Vec<Crossing<L::Scalar, N>>,
    ) -> Option<(State<L::Scalar, N>, Ending)>
    where
        F: VectorField<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let mut at = *step.before;
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

    /// Writes down the crossings within the last step of a path, between these states, and ends the path where the motion
    /// ends within it; why it does.
    // Inlined, so that the path can stay in registers.
    #[cfg(feature = "alloc")]
    #[inline(always)]
    pub(crate) fn record_in<F, I>(
        &mut self,
        path: &mut Path<L::Scalar, N, Vec<I>>,
        system: &L,
        [before, after]: [&State<L::Scalar, N>; 2],
    ) -> Option<Ending>
    where
        F: VectorField<L, N, M>,
        I: Interpolant<L::Scalar, N> + Send + Sync + 'static,
    {
        let (interpolant, crossings) = path.last_step()?;
        let step = DenseStep { system, before, after, interpolant, field: PhantomData::<F> };
        let (at, ending) = self.record(&step, crossings)?;
        path.cut(at);
        Some(ending)
    }

    /// Writes down what has not been reported yet at this state; the ending, if one of them is that.
    #[cfg(feature = "alloc")]
    pub(crate) fn record_due(
        &mut self,
        at: &State<L::Scalar, N>,
        crossings: &mut Vec<Crossing<L::Scalar, N>>,
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

    /// The ending, if the last crossing is one.
    #[cfg(feature = "alloc")]
    fn ending(&mut self, crossings: &[Crossing<L::Scalar, N>]) -> Option<Ending> {
        let Crossing { event, index, state, .. } = crossings.last()?;
        let is_terminal = self.events.get_mut(*index)?.memory().is_terminal();
        is_terminal.then(|| Ending::Event { time: state.t.to_f64(), event })
    }

    /// Goes on to `t`, or to where an event crosses before, unless some function may cross twice on the way and the interval
    /// can be halved.
    #[inline]
    fn look<F, I>(
        &mut self,
        step: &DenseStep<'_, L, F, I, N, M>,
        from: &mut State<L::Scalar, N>,
        t: L::Scalar,
        may_halve: bool,
    ) -> Result<Look, Error>
    where
        F: VectorField<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let interval = if may_halve { step.interval(from.t, t) } else { None };
        let mut are_too_wide = false;
        for event in self.events.iter_mut() {
            are_too_wide |= event.memory().open(interval.as_ref());
        }
        let within;
        let end = match t == step.after.t {
            true => Ok(step.after),
            false => {
                within = step.at(t);
                there(&within)
            }
        };
        let reached = end.and_then(|to| self.sample(step.system, to, FINEST).map(|()| to));
        if let Some(interval) = &interval {
            // What cannot be evaluated may have crossed before.
            if reached.is_err()
                || are_too_wide
                || !self.is_plain(step, [from.t, t], interval).unwrap_or(false)
            {
                return Ok(Look::Halve);
            }
        }
        let to = reached?;
        let any_crosses = self.look_at(step.system, to)?;
        match any_crosses {
            true => self.go_to_first(step, from, to)?,
            false => {
                *from = *to;
                self.events.iter_mut().for_each(|event| event.memory().go_on(t));
            }
        }
        Ok(if any_crosses { Look::Crossed } else { Look::Passed })
    }

    /// Takes samples of all functions that are not known well enough.
    #[inline]
    fn sample(&mut self, system: &L, state: &State<L::Scalar, N>, place: usize) -> Result<(), Error> {
        self.events.iter_mut().try_for_each(|event| event.sample(system, state, place))
    }

    /// Whether each function crosses zero at most once between these times, by samples of as high a degree as that takes.
    #[inline]
    fn is_plain<F, I>(
        &mut self,
        step: &DenseStep<'_, L, F, I, N, M>,
        [from, to]: [L::Scalar; 2],
        interval: &Interval<L::Scalar>,
    ) -> Result<bool, Error>
    where
        F: VectorField<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let mut degree = COARSEST;
        while degree <= interval.finest {
            for place in places(degree) {
                let state = step.at(from + (to - from) * L::Scalar::constant(part(place)));
                self.sample(step.system, there(&state)?, place)?;
            }
            let mut is_plain = true;
            for event in self.events.iter_mut() {
                match judge(event, step, (from + to) * L::Scalar::constant(0.5), interval, degree)? {
                    View::Plain => {}
                    View::Bent => return Ok(false),
                    _ => is_plain = false,
                }
            }
            if is_plain {
                return Ok(true);
            }
            degree *= 2;
        }
        Ok(false)
    }

    /// Takes note of all functions at the end of an interval; whether one crosses on the way.
    #[inline]
    fn look_at(&mut self, system: &L, end: &State<L::Scalar, N>) -> Result<bool, Error> {
        let mut any_crosses = false;
        for event in self.events.iter_mut() {
            let mut memory = event.memory();
            if let Some(left) = memory.start {
                let noise = noise(event, system, end)? + left;
                memory = event.memory();
                memory.noise = larger(memory.noise, noise);
            }
            memory.look(memory.samples[FINEST]);
            any_crosses |= memory.crosses();
        }
        Ok(any_crosses)
    }

    /// Goes to where the first event crosses. Its function is zero there or has the other sign, and so may others be.
    #[cold]
    #[inline(never)]
    fn go_to_first<F, I>(
        &mut self,
        step: &DenseStep<'_, L, F, I, N, M>,
        from: &mut State<L::Scalar, N>,
        to: &State<L::Scalar, N>,
    ) -> Result<(), Error>
    where
        F: VectorField<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let mut first = (usize::MAX, *to);
        for (index, event) in self.events.iter_mut().enumerate() {
            let memory = event.memory();
            if memory.crosses() {
                let values = [memory.value, memory.next];
                let place = locate(step, event, [from, to], values)?;
                if first.0 == usize::MAX || step.is_ahead(place.t, first.1.t) {
                    first = (index, place);
                }
            }
        }
        *from = first.1;
        for (index, event) in self.events.iter_mut().enumerate() {
            let value = event.value(step.system, from)?;
            event.memory().arrive(value, from.t, index == first.0);
        }
        Ok(())
    }
}

/// What the samples of this degree tell of an event's function; where they may be all noise, the middle says how much of it there is.
#[inline]
fn judge<L, F, I, const N: usize, const M: usize>(
    event: &mut impl AnyEvent<L, N, M>,
    step: &DenseStep<'_, L, F, I, N, M>,
    middle: L::Scalar,
    interval: &Interval<L::Scalar>,
    degree: usize,
) -> Result<View, Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: VectorField<L, N, M>,
    I: Interpolant<L::Scalar, N>,
{
    let view = event.memory().judge(degree, interval);
    if view != View::Rough {
        return Ok(view);
    }
    let noise = noise(event, step.system, &step.at(middle)?)?;
    Ok(event.memory().judge_noise(degree, noise))
}

/// The state where it is: one that is moved out of a result takes longer than a look at it.
#[inline(always)]
fn there<T, const N: usize>(found: &Result<State<T, N>, Error>) -> Result<&State<T, N>, Error> {
    found.as_ref().map_err(Error::clone)
}
