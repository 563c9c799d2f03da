//! Steps are searched for the crossings of events, piece by piece.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use core::marker::PhantomData;

use nalgebra::ComplexField;

use super::locate::{locate, turned};
use super::memory::FINE;
use super::{Crossing, Watched};
use crate::ending::Ending;
use crate::error::Error;
use crate::motion::Interpolant;
use crate::number::{Real, Scalar, larger};
use crate::solution::flow::Flow;
use crate::system::{Lagrangian, State};
#[cfg(feature = "alloc")]
use crate::trajectory::Path;

/// A step that was taken, with what lies within.
pub(crate) struct Stride<'a, L: Lagrangian<N, M>, F, I, const N: usize, const M: usize> {
    pub(crate) system: &'a L,
    pub(crate) before: &'a State<L::Scalar, N>,
    pub(crate) after: &'a State<L::Scalar, N>,
    pub(crate) interpolant: &'a I,
    pub(crate) flow: PhantomData<F>,
}

impl<L, F, I, const N: usize, const M: usize> Stride<'_, L, F, I, N, M>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
    I: Interpolant<L::Scalar, N>,
{
    /// The state at a time within, on the constraints.
    #[inline]
    pub(crate) fn at(&self, t: L::Scalar) -> Result<State<L::Scalar, N>, Error> {
        match t == self.after.t {
            true => Ok(*self.after),
            false => F::project(self.system, &self.interpolant.at(t)),
        }
    }

    fn length(&self) -> L::Scalar {
        self.after.t - self.before.t
    }

    /// The end of this piece of what is left of the step from there.
    fn mark(&self, from: L::Scalar, piece: usize, of: usize) -> L::Scalar {
        let part = L::Scalar::constant(piece as f64 / of as f64);
        if piece == of { self.after.t } else { from + (self.after.t - from) * part }
    }

    /// Whether `later` comes after `t` in the motion.
    fn is_ahead(&self, t: L::Scalar, later: L::Scalar) -> bool {
        let zero = L::Scalar::constant(0.0);
        if self.length() < zero { later < t } else { later > t }
    }
}

/// The events `W` that a motion is searched for.
pub(crate) struct Search<'e, W, L: Lagrangian<N, M>, const N: usize, const M: usize> {
    pub(crate) events: &'e mut [W],
    pub(crate) grid: Grid<L::Scalar>,
}

/// Where steps are looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid<T> {
    /// Where the motion starts at a zero: pieces are short near there.
    start: Option<T>,
    /// How many pieces every step is looked at in, none where no event asks for any.
    pieces: usize,
    /// Whether some event leaves it to what its function does.
    is_free: bool,
}

impl<'e, W, L, const N: usize, const M: usize> Search<'e, W, L, N, M>
where
    W: Watched<L, N, M>,
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
        let (mut start, mut pieces, mut is_free) = (None, 0, false);
        for event in events.iter_mut() {
            let value = event.value(system, state)?;
            let memory = event.memory();
            if memory.begin(value, state.t, is_new) {
                start = Some(state.t);
            }
            pieces = pieces.max(memory.pieces.unwrap_or(0));
            is_free |= memory.pieces.is_none();
        }
        Ok(Self { events, grid: Grid { start, pieces, is_free } })
    }

    /// The first crossing after `from`, which moves there, or to the end of the step where there is none.
    ///
    /// # Errors
    /// Why the motion ends at `from`.
    pub(crate) fn next<F, I>(
        &mut self,
        stride: &Stride<'_, L, F, I, N, M>,
        from: &mut State<L::Scalar, N>,
    ) -> Result<Option<Crossing<L::Scalar, N>>, Ending>
    where
        F: Flow<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let (start, pieces) = (from.t, self.plan(stride, from.t));
        if pieces == 0 {
            *from = *stride.after;
        }
        for piece in 1..=pieces {
            let mark = stride.mark(start, piece, pieces);
            while stride.is_ahead(from.t, mark) {
                let t = self.near_start(stride, from.t).filter(|t| stride.is_ahead(*t, mark)).unwrap_or(mark);
                match self.look(stride, from, t) {
                    Ok(false) => {}
                    Ok(true) => return self.due(from),
                    Err(error) => return Err(Ending::of(error, from.t.to_f64())),
                }
            }
        }
        Ok(None)
    }

    /// In how many pieces to look at what is left of a step: none where every function keeps away from zero, and is known at
    /// the end of the step then.
    #[inline]
    fn plan<F, I>(&mut self, stride: &Stride<'_, L, F, I, N, M>, from: L::Scalar) -> usize
    where
        F: Flow<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        if !self.grid.is_free || from == stride.after.t {
            return self.grid.pieces;
        }
        // What cannot be evaluated there may have crossed before.
        let Ok(middle) = stride.at(stride.mark(from, 1, 2)) else { return FINE };
        let plans = self.events.iter_mut().map(|event| event.plan(stride.system, &middle, stride.after));
        let pieces = plans.fold(self.grid.pieces, |most, pieces| most.max(pieces.unwrap_or(FINE)));
        if pieces == 0 {
            self.events.iter_mut().for_each(|event| event.memory().skip_step());
        }
        pieces
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
        stride: &Stride<'_, L, F, I, N, M>,
        crossings: &mut Vec<Crossing<L::Scalar, N>>,
    ) -> Option<(State<L::Scalar, N>, Ending)>
    where
        F: Flow<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let mut at = *stride.before;
        loop {
            match self.next(stride, &mut at) {
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
        F: Flow<L, N, M>,
        I: Interpolant<L::Scalar, N> + Send + Sync + 'static,
    {
        let (interpolant, crossings) = path.last_step()?;
        let stride = Stride { system, before, after, interpolant, flow: PhantomData::<F> };
        let (at, ending) = self.record(&stride, crossings)?;
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

    /// Where to look next near a start at a zero: twice as far from there as the last time.
    fn near_start<F, I>(&self, stride: &Stride<'_, L, F, I, N, M>, t: L::Scalar) -> Option<L::Scalar>
    where
        F: Flow<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let (start, length) = (self.grid.start?, stride.length());
        let epsilon = L::Scalar::constant(L::Scalar::EPSILON);
        let size = larger(Scalar::abs(start), epsilon * Scalar::abs(length));
        let least = L::Scalar::constant(16.0) * epsilon * size;
        let distance = larger(Scalar::abs(t - start) * L::Scalar::constant(2.0), least);
        Some(start + distance * length.signum())
    }

    /// Goes on to `t`, or to where an event crosses before; whether one does.
    #[inline]
    fn look<F, I>(
        &mut self,
        stride: &Stride<'_, L, F, I, N, M>,
        from: &mut State<L::Scalar, N>,
        t: L::Scalar,
    ) -> Result<bool, Error>
    where
        F: Flow<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let mut to = stride.at(t)?;
        self.events.iter_mut().for_each(|event| event.memory().go_on());
        self.look_at(stride.system, &to)?;
        if let Some(turn) = self.turn(stride, [from, &to])? {
            to = turn;
            self.look_at(stride.system, &to)?;
        }
        let any_crosses = self.events.iter_mut().any(|event| event.memory().crosses());
        match any_crosses {
            true => self.go_to_first(stride, from, &to)?,
            false => *from = to,
        }
        Ok(any_crosses)
    }

    /// Takes note of all functions at the next place.
    fn look_at(&mut self, system: &L, next: &State<L::Scalar, N>) -> Result<(), Error> {
        self.events.iter_mut().try_for_each(|event| {
            let value = event.value(system, next)?;
            event.memory().look(value);
            Ok(())
        })
    }

    /// The first place between these two at which an event has turned back and is beyond zero.
    fn turn<F, I>(
        &mut self,
        stride: &Stride<'_, L, F, I, N, M>,
        between: [&State<L::Scalar, N>; 2],
    ) -> Result<Option<State<L::Scalar, N>>, Error>
    where
        F: Flow<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let mut first: Option<State<L::Scalar, N>> = None;
        for event in self.events.iter_mut() {
            let memory = event.memory();
            if memory.may_turn_back() {
                let values = [memory.value, memory.next];
                let place = turned(stride, event, between, values)?;
                first = place
                    .filter(|place| first.is_none_or(|first| stride.is_ahead(place.t, first.t)))
                    .or(first);
            }
        }
        Ok(first)
    }

    /// Goes to where the first event crosses. Its function is zero there or has the other sign, and so may others be.
    fn go_to_first<F, I>(
        &mut self,
        stride: &Stride<'_, L, F, I, N, M>,
        from: &mut State<L::Scalar, N>,
        to: &State<L::Scalar, N>,
    ) -> Result<(), Error>
    where
        F: Flow<L, N, M>,
        I: Interpolant<L::Scalar, N>,
    {
        let mut first = (usize::MAX, *to);
        for (index, event) in self.events.iter_mut().enumerate() {
            let memory = event.memory();
            if memory.crosses() {
                let values = [memory.value, memory.next];
                let place = locate(stride, event, [from, to], values)?;
                if first.0 == usize::MAX || stride.is_ahead(place.t, first.1.t) {
                    first = (index, place);
                }
            }
        }
        *from = first.1;
        for (index, event) in self.events.iter_mut().enumerate() {
            let value = event.value(stride.system, from)?;
            event.memory().arrive(value, index == first.0);
        }
        Ok(())
    }
}
