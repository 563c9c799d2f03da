//! Events: where a function of the motion crosses zero.

mod locate;
mod memory;
mod narrow;
mod search;
mod turn;

use core::borrow::Borrow;
use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;

use memory::Memory;
#[cfg(feature = "std")]
pub(crate) use search::Grid;
pub(crate) use search::{Search, Stride};

use crate::error::Error;
use crate::number::{Dual, Real};
use crate::solution::Sample;
use crate::system::{Lagrangian, State};

/// Where a function g of a motion crosses zero; made by [`Simulate::event`](crate::Simulate::event).
///
/// A [`Motion`](crate::Motion) stops at every crossing ([`advance_to_event`](crate::Motion::advance_to_event)). A run that
/// is given events records their crossings, and ends at those that say so ([`terminal`](Self::terminal)).
///
/// # What is found
///
/// g is evaluated at both ends of each step and in the middle, on states by the continuous extension of the method, projected
/// onto the constraints. Of these values a, b, c it is evaluated at every eighth of the step as well, unless they tell
/// that it does not turn back near zero in between: that it bends by less than a quarter of what it rises or falls by,
/// |a − 2b + c| < |c − a|/4, or by less than its distance from zero, the least of |a|, |b|, |c|. Where it comes near
/// zero between two eighths and has the same sign at both, it is evaluated at the vertex of a parabola, too. So two zeros are found
/// however close they are, as long as g is much like a parabola from one eighth to the next, and a step on which it stays away from
/// zero costs one evaluation of the continuous extension. [`pieces`](Self::pieces) divides every step evenly instead, as finely
/// as is asked for. What is left of a step after a crossing is looked at like a step. From one of these times to the next,
///
/// - g crosses zero where it is not zero at the first, and zero or of the other sign at the second. So a zero belongs to
///   the piece that it ends: none is reported twice or lost where steps meet, one at the very end of the motion is
///   reported, and one at the start is not: the motion leaves it.
/// - A touch that changes no sign is reported only where it is zero to the last bit at one of these times, once. In a motion that is
///   computed a touch may well be two crossings, as far apart as the error lets g go beyond zero. Where g may
///   wiggle within an eighth of a step ask for more pieces or for shorter steps. Two crossings in one of the pieces that are asked
///   for are none.
/// - Where a motion starts at a zero of g, or goes on from a crossing after its state or its system has been
///   changed, the first piece is halved towards the start, again and again: a ball may bounce and be
///   back long before the step is over. What g is within some 16 units of round-off of the time of the start counts as zero.
///
/// The zero is located by the ITP method (Oliveira and Takahashi, *An enhancement of the bisection method average performance
/// preserving minmax optimality*, 2021), which needs no more evaluations than bisection, as a rule a quarter. First the
/// time is, to the last bit; then the state between those at two such times, so that g is zero to its round-off where the
/// time is counted from far away, too. There g is zero or on the side that it crosses to. Where it jumps, or goes
/// through infinity, that place is found.
///
/// Several events are reported in the order of their times; at one time in the order in which they are given.
///
/// # Where crossings accumulate
///
/// [`Ending::EventsAccumulate`](crate::Ending::EventsAccumulate) ends a motion where, twice in a row, a crossing follows the
/// one before of the same event within 1.5·10⁻⁸ (2⁻²⁶) of the longest interval between two of them, or up to the first, or
/// within 64 units of round-off of the time.
///
/// # One event in several motions
///
/// Each run counts the crossings from 1, also where it is one leg of a motion. What tells that crossings accumulate is kept from
/// leg to leg, and forgotten where a run starts before the last crossing. A [`Motion`](crate::Motion) that is steered counts on until
/// another one starts.
pub struct Event<L: Lagrangian<N, M>, G, const N: usize, const M: usize> {
    function: G,
    memory: Memory<L::Scalar>,
    system: PhantomData<fn(&L)>,
}

impl<L: Lagrangian<N, M, Scalar: Real>, G, const N: usize, const M: usize> Event<L, G, N, M> {
    pub(crate) fn new(name: &'static str, function: G) -> Self {
        Self { function, memory: Memory::new(name), system: PhantomData }
    }

    /// Only where g grows through zero.
    #[must_use]
    pub fn rising(mut self) -> Self {
        self.memory.direction = Direction::Rising;
        self
    }

    /// Only where g falls through zero.
    #[must_use]
    pub fn falling(mut self) -> Self {
        self.memory.direction = Direction::Falling;
        self
    }

    /// Ends a run at the first crossing.
    #[must_use]
    pub fn terminal(self) -> Self {
        self.terminal_at(1)
    }

    /// Ends a run at crossing number `count`, counted from 1 in each run.
    #[must_use]
    pub fn terminal_at(mut self, count: usize) -> Self {
        self.memory.terminal = Some(count);
        self
    }

    /// Looks at g so many times in every step, evenly spaced. Of several events the largest number counts. Each time but the last
    /// costs an evaluation of the continuous extension (and on constraints a projection): one will do where g cannot
    /// cross twice within a step, more are needed where it may wiggle within an eighth of one, or between a step's ends and middle
    /// so that nothing shows there.
    #[must_use]
    pub fn pieces(mut self, pieces: usize) -> Self {
        self.memory.pieces = Some(pieces.max(1));
        self
    }

    /// The same event before its first crossing, for another motion, with what becomes of its function.
    #[cfg(feature = "std")]
    pub(crate) fn anew<'g, H>(&'g self, function: impl FnOnce(&'g G) -> H) -> Event<L, H, N, M> {
        Event { function: function(&self.function), memory: self.memory.anew(), system: PhantomData }
    }

    /// The same event with what becomes of its function.
    #[cfg(feature = "std")]
    pub(crate) fn map<H>(self, function: impl FnOnce(G) -> H) -> Event<L, H, N, M> {
        Event { function: function(self.function), memory: self.memory, system: PhantomData }
    }

    /// How many crossings there were so far, in the run that was searched last.
    pub fn count(&self) -> usize {
        self.memory.count
    }

    #[cfg(feature = "alloc")]
    pub(crate) fn name(&self) -> &'static str {
        self.memory.name
    }

    #[cfg(feature = "alloc")]
    pub(crate) fn function(&self) -> &G {
        &self.function
    }
}

/// Which crossings an event is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    Rising,
    Falling,
    Both,
}

/// A crossing that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "T: nalgebra::Scalar + serde::Serialize")))]
pub struct Crossing<T, const N: usize> {
    /// The name of the event.
    pub event: &'static str,
    /// The place of the event among those given.
    pub index: usize,
    /// Which crossing of this event it is, counted from 1.
    pub count: usize,
    /// Whether the function grows through zero there (else it falls).
    pub rising: bool,
    /// The state there.
    pub state: State<T, N>,
}

/// The value of an event's function: a number, or a number that could not be had (`|s| s.multiplier("wall")`).
pub trait EventValue<T> {
    /// The number.
    ///
    /// # Errors
    /// Why there is none.
    fn value(self) -> Result<T, Error>;
}

impl<T: Real> EventValue<T> for T {
    #[inline]
    fn value(self) -> Result<T, Error> {
        Ok(self)
    }
}

impl<T: Real> EventValue<Self> for Dual<T> {
    #[inline]
    fn value(self) -> Result<Self, Error> {
        Ok(self)
    }
}

impl<T> EventValue<T> for Result<T, Error> {
    #[inline]
    fn value(self) -> Self {
        self
    }
}

/// The function of an event: a closure over samples, or one over dual numbers
/// (`AcrossEvents::differentiable_event`).
pub trait EventFunction<L: Lagrangian<N, M>, const N: usize, const M: usize> {
    /// Its value at a state.
    #[doc(hidden)]
    fn at(&self, system: &L, state: &State<L::Scalar, N>) -> Result<L::Scalar, Error>;
}

impl<L, G, V, const N: usize, const M: usize> EventFunction<L, N, M> for G
where
    L: Lagrangian<N, M, Scalar: Real>,
    G: Fn(&Sample<&L, N, M>) -> V,
    V: EventValue<L::Scalar>,
{
    #[inline]
    fn at(&self, system: &L, state: &State<L::Scalar, N>) -> Result<L::Scalar, Error> {
        self(&Sample { system, state: *state }).value()
    }
}

/// An event of a system: every [`Event`] of it, also where the system is behind a reference or a pointer.
///
/// Functions take events as `&mut [&mut lands, &mut slips]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an event of `{L}`",
    note = "make one by `system.event(\"name\", |sample| …)`, of the same system, and pass `&mut [&mut event]`"
)]
pub trait Watched<L: Lagrangian<N, M>, const N: usize, const M: usize>: sealed::Sealed {
    /// What its function is at this state.
    #[doc(hidden)]
    fn value(&self, system: &L, state: &State<L::Scalar, N>) -> Result<L::Scalar, Error>;

    /// What it is about, and what is known of it.
    #[doc(hidden)]
    fn memory(&mut self) -> &mut Memory<L::Scalar>;

    /// Looks at the middle and at the end of a step: in how many pieces its function is to be looked at.
    #[doc(hidden)]
    fn plan(
        &mut self,
        system: &L,
        middle: &State<L::Scalar, N>,
        end: &State<L::Scalar, N>,
    ) -> Result<usize, Error>;
}

mod sealed {
    pub trait Sealed {}
}

impl<L: Lagrangian<N, M>, G, const N: usize, const M: usize> sealed::Sealed for Event<L, G, N, M> {}

impl<L: Lagrangian<N, M>, const N: usize, const M: usize> sealed::Sealed
    for &mut (dyn Watched<L, N, M> + '_)
{
}

impl<L: Lagrangian<N, M>, const N: usize, const M: usize> Watched<L, N, M>
    for &mut (dyn Watched<L, N, M> + '_)
{
    #[inline]
    fn value(&self, system: &L, state: &State<L::Scalar, N>) -> Result<L::Scalar, Error> {
        (**self).value(system, state)
    }

    #[inline]
    fn memory(&mut self) -> &mut Memory<L::Scalar> {
        (**self).memory()
    }

    #[inline]
    fn plan(
        &mut self,
        system: &L,
        middle: &State<L::Scalar, N>,
        end: &State<L::Scalar, N>,
    ) -> Result<usize, Error> {
        (**self).plan(system, middle, end)
    }
}

impl<L, K, G, const N: usize, const M: usize> Watched<L, N, M> for Event<K, G, N, M>
where
    L: Lagrangian<N, M, Scalar: Real> + Borrow<K>,
    K: Lagrangian<N, M, Scalar = L::Scalar>,
    G: EventFunction<K, N, M>,
{
    #[inline]
    fn value(&self, system: &L, state: &State<L::Scalar, N>) -> Result<L::Scalar, Error> {
        let value = self.function.at(system.borrow(), state)?;
        match nalgebra::ComplexField::is_finite(&value) {
            true => Ok(value),
            false => Err(Error::EventNotFinite { event: self.memory.name, time: state.t.to_f64() }),
        }
    }

    fn memory(&mut self) -> &mut Memory<L::Scalar> {
        &mut self.memory
    }

    fn plan(
        &mut self,
        system: &L,
        middle: &State<L::Scalar, N>,
        end: &State<L::Scalar, N>,
    ) -> Result<usize, Error> {
        let [middle, end] = [self.value(system, middle)?, self.value(system, end)?];
        Ok(self.memory.plan(middle, end))
    }
}

impl<L: Lagrangian<N, M>, G, const N: usize, const M: usize> Debug for Event<L, G, N, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Event").field(&self.memory).finish()
    }
}
