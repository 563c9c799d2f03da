//! Search of steps for the crossings of events.

use core::marker::PhantomData;

use super::chebyshev::{part, places};
use super::definition::AnyEvent;
use super::dense::DenseStep;
use super::halves::{Halves, LEVELS};
use super::locate::locate;
use super::memory::{Interval, View};
use super::noise::{noise, noise_beside};
use crate::error::{Ending, Error};
use crate::motion::limits::{COARSEST, FINEST, INTERVALS};
use crate::number::{Real, Scalar};
use crate::solution::crossing::Crossing;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::VectorField;
use crate::system::{State, StateOf, System};
use crate::vector::{Element, Length};

/// Result of the search of an interval.
enum Look {
    /// No crossing: the search is at the end of the interval.
    Passed,
    /// The search is at a crossing.
    Crossed,
    /// Undecided: search the first half of the interval.
    Halve,
}

/// Search of a motion for the events `W`.
pub(crate) struct EventSearch<'e, W, L: System> {
    pub(crate) events: &'e mut [W],
    /// Minimum number of parts in which every step is searched.
    pub(crate) subdivisions: usize,
    pub(crate) system: PhantomData<fn(&L)>,
}

impl<'e, W: AnyEvent<L>, L: System<Scalar: Real>> EventSearch<'e, W, L> {
    /// Begins the search at the start of a run, and counts crossings from 1.
    pub(crate) fn begin(events: &'e mut [W], system: &L, state: &StateOf<L>) -> Result<Self, Error> {
        events.iter_mut().for_each(|event| event.memory().begin_run());
        Self::from(events, system, state, true)
    }

    /// Makes the next run of these events a leg of a motion with entries of these sizes.
    pub(crate) fn begin_leg(
        events: &mut [W],
        system: &L,
        [start, sizes]: [&StateOf<L>; 2],
        is_first: bool,
    ) -> Result<(), Error> {
        events.iter_mut().try_for_each(|event| {
            let round_off = noise_beside(event, system, start, sizes)?;
            event.memory().begin_leg(is_first, round_off);
            Ok(())
        })
    }

    /// Begins or continues the search at this state. `is_new` is true if no step led here.
    pub(crate) fn from(
        events: &'e mut [W],
        system: &L,
        state: &StateOf<L>,
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

    /// Finds the first crossing after `from`, and moves `from` there; without a crossing, to the end of the step.
    ///
    /// # Errors
    /// The reason why the motion ends at `from`.
    pub(crate) fn next<F: VectorField<L>, I: Interpolant<L::Scalar, L::Length>>(
        &mut self,
        step: &DenseStep<'_, L, F, I>,
        from: &mut StateOf<L>,
    ) -> Result<Option<Crossing<L::Scalar, L::Length>>, Ending> {
        if !self.wake(step, from).map_err(|error| Ending::of(error, from.t.to_f64()))? {
            from.clone_from(step.after);
            return Ok(None);
        }
        let (start, mut intervals) = (from.t, 0);
        for piece in 1..=self.subdivisions {
            let mut halves = Halves::of([from.t, step.mark(start, piece, self.subdivisions)]);
            while step.is_ahead(from.t, step.after.t) {
                let end = halves.end();
                if step.is_ahead(from.t, end) {
                    intervals += 1;
                    let may_halve = intervals < INTERVALS && halves.level < LEVELS;
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

    /// Passes the next step, of this width, without a search for this event, if its function has one sign there.
    #[inline]
    pub(crate) fn stay_away(&mut self, index: usize, is_away: bool, width: L::Scalar) {
        self.events[index].memory().stay_away(is_away, width);
    }

    /// True if a function may cross zero in the step. The search for it goes on from here, after steps without one.
    #[inline]
    fn wake<F, I>(&mut self, step: &DenseStep<'_, L, F, I>, from: &StateOf<L>) -> Result<bool, Error> {
        let mut any = false;
        for (_, event) in awake::<_, L>(self.events) {
            any = true;
            if event.memory().wakes() {
                let value = event.value(step.system, from)?;
                event.memory().begin(value, from.t, None);
            }
        }
        Ok(any)
    }

    /// Returns a crossing at `state` that has not been reported yet.
    pub(crate) fn due(
        &mut self,
        state: &StateOf<L>,
    ) -> Result<Option<Crossing<L::Scalar, L::Length>>, Ending> {
        for (index, event) in self.events.iter_mut().enumerate() {
            let memory = event.memory();
            if let Some(rising) = memory.due.take() {
                memory.cross(state.t)?;
                let (event, count) = (memory.name, memory.count);
                return Ok(Some(Crossing { event, index, count, rising, state: state.clone() }));
            }
        }
        Ok(None)
    }

    /// Moves `from` to `t`, or to an earlier crossing. If a function may cross twice on the way and the
    /// interval can be halved, returns [`Look::Halve`] instead.
    #[inline]
    fn look<F: VectorField<L>, I: Interpolant<L::Scalar, L::Length>>(
        &mut self,
        step: &DenseStep<'_, L, F, I>,
        from: &mut StateOf<L>,
        t: L::Scalar,
        may_halve: bool,
    ) -> Result<Look, Error> {
        let interval = if may_halve { step.interval(from.t, t) } else { None };
        let mut are_too_wide = false;
        for (_, event) in awake::<_, L>(self.events) {
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
            // An event may have crossed before the state that cannot be evaluated.
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
                from.clone_from(to);
                awake::<_, L>(self.events).for_each(|(_, event)| event.memory().go_on(t));
            }
        }
        Ok(if any_crosses { Look::Crossed } else { Look::Passed })
    }

    /// Samples all functions that are undecided on the interval.
    #[inline]
    fn sample(&mut self, system: &L, state: &StateOf<L>, place: usize) -> Result<(), Error> {
        awake::<_, L>(self.events).try_for_each(|(_, event)| event.sample(system, state, place))
    }

    /// True if each function crosses zero at most once between these times. The degree of the samples is raised as
    /// needed.
    #[inline]
    fn is_plain<F: VectorField<L>, I: Interpolant<L::Scalar, L::Length>>(
        &mut self,
        step: &DenseStep<'_, L, F, I>,
        [from, to]: [L::Scalar; 2],
        interval: &Interval<L::Scalar>,
    ) -> Result<bool, Error> {
        let mut degree = COARSEST;
        while degree <= interval.finest {
            for place in places(degree) {
                let state = step.at(from + (to - from) * L::Scalar::constant(part(place)));
                self.sample(step.system, there(&state)?, place)?;
            }
            let mut is_plain = true;
            for (_, event) in awake::<_, L>(self.events) {
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

    /// Records all functions at the end of an interval. Returns true if one crosses on the way.
    #[inline]
    fn look_at(&mut self, system: &L, end: &StateOf<L>) -> Result<bool, Error> {
        let mut any_crosses = false;
        for (_, event) in awake::<_, L>(self.events) {
            let mut memory = event.memory();
            if let Some(left) = memory.start {
                let noise = noise(event, system, end)? + left;
                memory = event.memory();
                memory.add_noise(noise);
            }
            memory.look(memory.samples[FINEST]);
            any_crosses |= memory.crosses();
        }
        Ok(any_crosses)
    }

    /// Moves `from` to the first crossing. Its function is zero there or has the opposite sign; others may cross there
    /// too. No condition is violated there.
    #[cold]
    #[inline(never)]
    fn go_to_first<F: VectorField<L>, I: Interpolant<L::Scalar, L::Length>>(
        &mut self,
        step: &DenseStep<'_, L, F, I>,
        from: &mut StateOf<L>,
        to: &StateOf<L>,
    ) -> Result<(), Error> {
        let mut first = (usize::MAX, to.clone());
        for (index, event) in awake::<_, L>(self.events) {
            let memory = event.memory();
            if memory.crosses() {
                let (values, is_condition) = ([memory.value, memory.next], memory.is_condition);
                let mut place = locate(step, event, [from, to], (values, is_condition))?;
                // Where a condition fails with the first change of the state, the motion has to go on all the same.
                if place == *from && event.memory().begins_at(from.t) {
                    place = locate(step, event, [from, to], (values, false))?;
                }
                if first.0 == usize::MAX || step.is_ahead(place.t, first.1.t) {
                    first = (index, place);
                }
            }
        }
        self.hold(step, from, &mut first)?;
        *from = first.1;
        for (index, event) in awake::<_, L>(self.events) {
            let value = event.value(step.system, from)?;
            event.memory().arrive(value, from.t, index == first.0);
        }
        Ok(())
    }

    /// Moves the first crossing back to a state at which all conditions hold. One may be violated there though its own crossing was
    /// not found before: it may lie between the same two floating-point times. At the new place another one may be violated.
    fn hold<F: VectorField<L>, I: Interpolant<L::Scalar, L::Length>>(
        &mut self,
        step: &DenseStep<'_, L, F, I>,
        from: &StateOf<L>,
        (first, place): &mut (usize, StateOf<L>),
    ) -> Result<(), Error> {
        for _ in 0..self.events.len() {
            let before = place.clone();
            for (index, event) in awake::<_, L>(self.events) {
                let (value, next) = (event.memory().value, event.value(step.system, place)?);
                if index != *first && event.memory().is_condition && next < L::Scalar::constant(0.0) {
                    *place = locate(step, event, [from, place], ([value, next], true))?;
                    *first = index;
                }
            }
            if *place == before {
                break;
            }
        }
        Ok(())
    }
}

/// Events that are searched for, with their indices.
#[inline(always)]
fn awake<W: AnyEvent<L>, L: System<Scalar: Real>>(events: &mut [W]) -> impl Iterator<Item = (usize, &mut W)> {
    let is_awake = |(index, event)| {
        let event: &mut W = event;
        (!event.memory().is_away()).then_some((index, event))
    };
    events.iter_mut().enumerate().filter_map(is_awake)
}

/// Decides on an event's function by its samples of this degree. If they may be all noise, the noise is estimated in
/// the middle.
#[inline]
fn judge<L, F, I>(
    event: &mut impl AnyEvent<L>,
    step: &DenseStep<'_, L, F, I>,
    middle: L::Scalar,
    interval: &Interval<L::Scalar>,
    degree: usize,
) -> Result<View, Error>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    I: Interpolant<L::Scalar, L::Length>,
{
    let view = event.memory().judge(degree, interval);
    if view != View::Rough {
        return Ok(view);
    }
    let noise = noise(event, step.system, &step.at(middle)?)?;
    Ok(event.memory().judge_noise(degree, noise))
}

/// Reference to the state in a result: moving the state out would take longer than using it.
#[inline(always)]
fn there<T: Element, N: Length>(found: &Result<State<T, N>, Error>) -> Result<&State<T, N>, Error> {
    found.as_ref().map_err(Error::clone)
}
