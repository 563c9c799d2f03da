//! What an event is: a function of a motion, and which of its crossings are meant.

#[cfg(feature = "alloc")]
use alloc::boxed::Box;
use core::borrow::Borrow;
use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;

use super::memory::{CrossingDirection, EventState};
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
/// On each step g is taken as a sum of Chebyshev polynomials, Σ cₖ Tₖ, from its values at 5, 9, 17 or 33 times, on states by the
/// continuous extension of the method, projected onto the constraints (the points of Clenshaw and Curtis, of which those of
/// each degree are among those of the next). A step is done where |c₀| is larger than all others together and what is left out, so that
/// g keeps away from zero, or where the same holds for the derivative, so that g crosses once at most; else the
/// degree is doubled, and then the step halved. The coefficients tell that only
/// where the last ones have fallen to a 16th of all. What is left out is bounded by 2n times the largest of the last coefficients of degree n,
/// 2n³ times in the derivative. So **every crossing is found, once, of a function whose coefficients from the last ones looked at on fall
/// at least like k⁻²** (k⁻⁴ in the derivative), as those of an analytic one do once they are resolved, however close to each other its
/// zeros are, down to its round-off. What no value shows nobody can see: a dip far from zero elsewhere and narrower than the
/// samples are apart, in a step on whose predecessors g took a low degree. Dips 1 − a exp(−(t/w)²) with a > 1 were all found from
/// w = 0.15 steps on: [`subdivide`](Self::subdivide) divides every step. After 4,096 parts
/// on the way to one crossing none is divided further.
///
/// - g crosses zero from one time to a later one where it is not zero at the first, and zero or of the other sign at the second. So
///   none is reported twice or lost where steps meet, one at the very end of the motion is reported, and one at the
///   start is not: the motion leaves it.
/// - A touch that changes no sign is reported only where it is zero to the last bit at one of these times, once. In a motion that is
///   computed a touch may well be two crossings, as far apart as the error lets g go beyond zero.
/// - Where a motion starts at a zero of g, or goes on from a crossing after its state or its system has been changed, g is on no side
///   until it is larger than its round-off: 16 times what it differs by at states whose entries and time are off by one unit. A ball
///   may bounce and be back long before the step is over.
/// - What is infinite is on the side of its sign; what is not a number ends the motion.
///
/// The zero is located by the ITP method (Oliveira and Takahashi, *An enhancement of the bisection method average performance
/// preserving minmax optimality*, 2021), which needs no more evaluations than bisection, as a rule a quarter. First the
/// time is, to the last bit; then the state between those at two such times, so that g is zero to its round-off where the
/// time is counted from far away, too. There g is zero or on the side that it crosses to. Where it jumps that place is found, and a
/// pole to some hundred units of round-off of the time.
///
/// Several events are reported in the order of their times; at one time in the order in which they are given.
///
/// # Where crossings accumulate
///
/// [`Ending::EventsAccumulate`](crate::Ending::EventsAccumulate) ends a motion where, six times in a row, or twice where the state or the
/// system was changed at each, a crossing follows the one before of the same event within 1.5·10⁻⁸ (2⁻²⁶) of the longest interval between two of them, or up to the first, or
/// within 64 units of round-off of the time.
///
/// # One event in several motions
///
/// Each run counts the crossings from 1, also where it is one leg of a motion. What tells that crossings accumulate is kept from
/// leg to leg, and forgotten where a run starts before the last crossing. A [`Motion`](crate::Motion) that is steered counts on until
/// another one starts.
pub struct Event<L: Lagrangian<N, M>, G, const N: usize, const M: usize> {
    function: G,
    memory: EventState<L::Scalar>,
    system: PhantomData<fn(&L)>,
}

impl<L: Lagrangian<N, M, Scalar: Real>, G, const N: usize, const M: usize> Event<L, G, N, M> {
    pub(crate) fn new(name: &'static str, function: G) -> Self {
        Self { function, memory: EventState::new(name), system: PhantomData }
    }

    /// Only where g grows through zero.
    #[must_use]
    pub fn rising(mut self) -> Self {
        self.memory.direction = CrossingDirection::Rising;
        self
    }

    /// Only where g falls through zero.
    #[must_use]
    pub fn falling(mut self) -> Self {
        self.memory.direction = CrossingDirection::Falling;
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

    /// Divides every step into so many parts, evenly spaced, before any is looked at: for dips that are narrower than a step and do
    /// not show elsewhere. Of several events the largest number counts. Each part costs four evaluations of the continuous extension (and on
    /// constraints as many projections).
    #[must_use]
    pub fn subdivide(mut self, subdivisions: usize) -> Self {
        self.memory.subdivisions = subdivisions.max(1);
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

/// The value of an event's function: a number, or a number that could not be had (`|s| s.multiplier("wall")`).
#[diagnostic::on_unimplemented(
    message = "the function of an event gives a number, not `{Self}`",
    label = "no number",
    note = "an event is where a number crosses zero: for `y < h` give `y - h`, and choose `.falling()`"
)]
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
/// (`MotionDerivatives::differentiable_event`).
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
/// A [`Motion`](crate::Motion) takes events as `&mut [&mut lands, &mut slips]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an event of `{L}`",
    note = "make one by `system.event(\"name\", |sample| …)`, of the same system; a `Motion` takes `&mut [&mut event]`"
)]
pub trait AnyEvent<L: Lagrangian<N, M>, const N: usize, const M: usize>: sealed::Sealed {
    /// What its function is at this state.
    #[doc(hidden)]
    fn value(&self, system: &L, state: &State<L::Scalar, N>) -> Result<L::Scalar, Error>;

    /// What it is about, and what is known of it.
    #[doc(hidden)]
    fn memory(&mut self) -> &mut EventState<L::Scalar>;

    /// Takes a sample of its function, unless it is known well enough.
    #[doc(hidden)]
    fn sample(&mut self, system: &L, state: &State<L::Scalar, N>, place: usize) -> Result<(), Error>;
}

/// An event of any kind.
#[cfg(feature = "alloc")]
pub(crate) type DynEvent<'a, L, const N: usize, const M: usize> = dyn AnyEvent<L, N, M> + 'a;

mod sealed {
    pub trait Sealed {}
}

impl<L: Lagrangian<N, M>, G, const N: usize, const M: usize> sealed::Sealed for Event<L, G, N, M> {}

impl<W: sealed::Sealed + ?Sized> sealed::Sealed for &mut W {}

#[cfg(feature = "alloc")]
impl<W: sealed::Sealed + ?Sized> sealed::Sealed for Box<W> {}

/// What points to an event is one.
macro_rules! watched_behind {
    ($pointer:ty) => {
        impl<L, W, const N: usize, const M: usize> AnyEvent<L, N, M> for $pointer
        where
            L: Lagrangian<N, M>,
            W: AnyEvent<L, N, M> + ?Sized,
        {
            #[inline]
            fn value(&self, system: &L, state: &State<L::Scalar, N>) -> Result<L::Scalar, Error> {
                (**self).value(system, state)
            }

            #[inline]
            fn memory(&mut self) -> &mut EventState<L::Scalar> {
                AnyEvent::<L, N, M>::memory(&mut **self)
            }

            #[inline]
            fn sample(&mut self, system: &L, state: &State<L::Scalar, N>, place: usize) -> Result<(), Error> {
                (**self).sample(system, state, place)
            }
        }
    };
}

watched_behind!(&mut W);
#[cfg(feature = "alloc")]
watched_behind!(Box<W>);

impl<L, K, G, const N: usize, const M: usize> AnyEvent<L, N, M> for Event<K, G, N, M>
where
    L: Lagrangian<N, M, Scalar: Real> + Borrow<K>,
    K: Lagrangian<N, M, Scalar = L::Scalar>,
    G: EventFunction<K, N, M>,
{
    #[inline]
    fn value(&self, system: &L, state: &State<L::Scalar, N>) -> Result<L::Scalar, Error> {
        let value = self.function.at(system.borrow(), state)?;
        // An infinite value has a sign, as at a pole.
        match value.to_f64().is_nan() {
            false => Ok(value),
            true => Err(Error::EventNotFinite { event: self.memory.name, time: state.t.to_f64() }),
        }
    }

    #[inline]
    fn memory(&mut self) -> &mut EventState<L::Scalar> {
        &mut self.memory
    }

    #[inline]
    fn sample(&mut self, system: &L, state: &State<L::Scalar, N>, place: usize) -> Result<(), Error> {
        if !self.memory.is_known() {
            self.memory.samples[place] = AnyEvent::<L, N, M>::value(self, system, state)?;
        }
        Ok(())
    }
}

impl<L: Lagrangian<N, M>, G, const N: usize, const M: usize> Debug for Event<L, G, N, M> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Event").field(&self.memory).finish()
    }
}
