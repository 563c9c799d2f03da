//! [`Event`]: a function of a motion, and the choice of its zero crossings.

use core::borrow::Borrow;
use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;

use super::memory::{CrossingDirection, EventState};
use crate::error::Error;
use crate::number::{Dual, Real};
use crate::solution::Sample;
use crate::system::{StateOf, System};

/// A zero crossing of a function g of a motion, made by [`Simulate::event`](crate::Simulate::event).
///
/// A [`Motion`](crate::Motion) stops at every crossing ([`advance_to_event`](crate::Motion::advance_to_event)). A run
/// with events records their crossings, and ends at those of [`terminal`](Self::terminal) events.
///
/// # Which crossings are found
///
/// On each step, g is expanded in Chebyshev polynomials, Σ cₖ Tₖ, from samples at 5, 9, 17 or 33 times. These are the
/// points of Clenshaw and Curtis; those of each degree are among those of the next. The states there come from the
/// dense output of the method, projected onto the constraints. The search of a step ends in two cases. If |c₀| exceeds
/// the sum of all other |cₖ| and of the truncation error, g stays away from zero. If the same holds for the derivative,
/// g crosses zero at most once. Otherwise the degree is doubled, and then the step is halved. Both tests require that
/// the last coefficients have fallen to a 16th of the sum of all. The truncation error is bounded by 2n times the
/// largest of the last coefficients of degree n, and 2n³ times in the derivative.
///
/// So **every crossing is found, once, of a function whose coefficients fall at least like k⁻²** (k⁻⁴ in the
/// derivative) from the last sampled ones on. The coefficients of an analytic function do so once they are resolved,
/// however close to each other its zeros are, down to its round-off. A dip between the samples cannot be found if g is
/// far from zero elsewhere, and if a low degree was enough for g on the steps before. Dips 1 − a exp(−(t/w)²) with a >
/// 1 were all found from w = 0.15 steps on. For narrower ones, [`subdivide`](Self::subdivide) divides every step. After
/// 4,096 parts on the way to one crossing, no part is divided further.
///
/// - g crosses zero between two times if it is nonzero at the first, and zero or of opposite sign at the second. So no
///   crossing is reported twice or lost where steps meet. A zero at the very end of the motion is reported, and a zero
///   at the start is not, because the motion leaves it.
/// - A touch without a change of sign is reported, once, only if g is zero to the last bit at one of these times. In a
///   computed motion a touch may become two crossings, as far apart as the error lets g pass beyond zero.
/// - If a motion starts at a zero of g, or continues from a crossing after a change of its state or system, g has no
///   sign at first. It gets one when |g| exceeds its round-off: 16 times the largest change of g at states whose
///   entries and time are off by one unit. So a ball may bounce and land again long before the step ends.
/// - An infinite value counts by its sign; NaN ends the motion. Between samples that are all the same infinity the
///   function counts as infinite.
///
/// The zero is located by the ITP method (Oliveira and Takahashi, *An enhancement of the bisection method average
/// performance preserving minmax optimality*, 2021), which needs no more evaluations than bisection, and usually a
/// quarter. First the time is located to the last bit, then the state between those at two adjacent times. So g is zero
/// to its round-off even at times far from zero. At the located state, g is zero or has the sign after the crossing. A
/// jump through zero is located as well, and a pole to some hundred units of round-off of the time.
///
/// Several events are reported in the order of their times; at equal times, in the order in which they are given.
///
/// # Accumulating crossings
///
/// [`Ending::EventsAccumulate`](crate::Ending::EventsAccumulate) ends a motion after six short intervals in a row
/// between crossings of one event. After a change of the state or of the system at each crossing, two suffice. An
/// interval is short if it is below 1.5·10⁻⁸ (2⁻²⁶) of the longest interval between two crossings, or up to the first,
/// or below 64 units of round-off of the time.
///
/// # One event in several motions
///
/// Each run counts its crossings from 1, even if it is one leg of a motion. The history for accumulating crossings is
/// kept from leg to leg, and dropped when a run starts before the last crossing. A steered [`Motion`](crate::Motion)
/// continues to count until another motion starts.
pub struct Event<L: System, G> {
    function: G,
    memory: EventState<L::Scalar>,
    system: PhantomData<fn(&L)>,
}

impl<L: System<Scalar: Real>, G> Event<L, G> {
    pub(crate) fn new(name: &'static str, function: G) -> Self {
        Self { function, memory: EventState::new(name), system: PhantomData }
    }

    /// Selects crossings where g increases.
    #[must_use]
    pub fn rising(mut self) -> Self {
        self.memory.direction = CrossingDirection::Rising;
        self
    }

    /// Selects crossings where g decreases.
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

    /// Makes g ≥ 0 a condition: it holds at the start of a run, and crossings are the last states at which it does.
    #[must_use]
    pub(crate) fn condition(mut self) -> Self {
        (self.memory.is_condition, self.memory.direction) = (true, CrossingDirection::Falling);
        self
    }

    /// Divides every step into this number of equal parts before the search, for dips that are narrower than a step and
    /// not visible elsewhere. With several events, the largest number applies. Each part costs four evaluations of the
    /// dense output and, with constraints, as many projections.
    #[must_use]
    pub fn subdivide(mut self, subdivisions: usize) -> Self {
        self.memory.subdivisions = subdivisions.max(1);
        self
    }

    /// Copy of the event for another motion, without its history, and with its function mapped.
    pub(crate) fn anew<'g, H>(&'g self, function: impl FnOnce(&'g G) -> H) -> Event<L, H> {
        Event { function: function(&self.function), memory: self.memory.anew(), system: PhantomData }
    }

    /// The event with its function mapped.
    pub(crate) fn map<H>(self, function: impl FnOnce(G) -> H) -> Event<L, H> {
        Event { function: function(self.function), memory: self.memory, system: PhantomData }
    }

    /// Number of crossings so far, in the run that was searched last.
    pub fn count(&self) -> usize {
        self.memory.count
    }

    pub(crate) fn name(&self) -> &'static str {
        self.memory.name
    }

    pub(crate) fn function(&self) -> &G {
        &self.function
    }
}

/// Result of an event's function: a number, or a `Result` (`|s| s.multiplier("wall")`).
#[diagnostic::on_unimplemented(
    message = "the function of an event gives a number, not `{Self}`",
    label = "no number",
    note = "an event is where a number crosses zero: for `y < h` give `y - h`, and choose `.falling()`"
)]
pub trait EventValue<T> {
    /// Returns the number.
    ///
    /// # Errors
    /// The reason why the function has no value.
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

/// Function of an event: a closure over samples, or one over dual numbers (`MotionDerivatives::differentiable_event`).
pub trait EventFunction<L: System> {
    /// Value of the function at a state.
    #[doc(hidden)]
    fn at(&self, sample: &Sample<&L>) -> Result<L::Scalar, Error>;
}

impl<L, G, V> EventFunction<L> for G
where
    L: System<Scalar: Real>,
    G: Fn(&Sample<&L>) -> V,
    V: EventValue<L::Scalar>,
{
    #[inline]
    fn at(&self, sample: &Sample<&L>) -> Result<L::Scalar, Error> {
        self(sample).value()
    }
}

/// An event of a system, or of a reference or pointer to it: implemented by [`Event`].
///
/// A [`Motion`](crate::Motion) takes events as `&mut [&mut lands, &mut slips]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an event of `{L}`",
    note = "make one by `system.event(\"name\", |sample| …)`, of the same system; a `Motion` takes `&mut [&mut event]`"
)]
pub trait AnyEvent<L: System>: sealed::Sealed {
    /// Value of the event's function for this sample.
    #[doc(hidden)]
    fn value_of(&self, sample: &Sample<&L>) -> Result<L::Scalar, Error>;

    /// Value of the event's function at this state.
    #[doc(hidden)]
    #[inline]
    fn value(&self, system: &L, state: &StateOf<L>) -> Result<L::Scalar, Error> {
        self.value_of(&Sample::of(system, state.clone()))
    }

    /// Settings of the event, and the state of its search.
    #[doc(hidden)]
    fn memory(&mut self) -> &mut EventState<L::Scalar>;

    /// Stores the value of the function as sample `place` of the interval, unless the interval is already decided.
    #[doc(hidden)]
    #[inline]
    fn sample(&mut self, system: &L, state: &StateOf<L>, place: usize) -> Result<(), Error> {
        if !self.memory().is_known() {
            self.memory().samples[place] = self.value(system, state)?;
        }
        Ok(())
    }
}

/// A type-erased event.
pub(crate) type DynEvent<'a, L> = dyn AnyEvent<L> + 'a;

pub(super) mod sealed {
    pub trait Sealed {}
}

impl<L: System, G> sealed::Sealed for Event<L, G> {}

impl<W: sealed::Sealed + ?Sized> sealed::Sealed for &mut W {}

/// Implements [`AnyEvent`] for a pointer to an event.
macro_rules! watched_behind {
    ($pointer:ty) => {
        impl<L: System, W: AnyEvent<L> + ?Sized> AnyEvent<L> for $pointer {
            #[inline]
            fn value_of(&self, sample: &Sample<&L>) -> Result<L::Scalar, Error> {
                (**self).value_of(sample)
            }

            #[inline]
            fn value(&self, system: &L, state: &StateOf<L>) -> Result<L::Scalar, Error> {
                (**self).value(system, state)
            }

            #[inline]
            fn memory(&mut self) -> &mut EventState<L::Scalar> {
                AnyEvent::<L>::memory(&mut **self)
            }

            #[inline]
            fn sample(&mut self, system: &L, state: &StateOf<L>, place: usize) -> Result<(), Error> {
                (**self).sample(system, state, place)
            }
        }
    };
}

watched_behind!(&mut W);

pub(super) use watched_behind;

impl<L: System<Scalar: Real>, G: EventFunction<L>> Event<L, G> {
    #[inline]
    fn evaluate(&self, sample: &Sample<&L>) -> Result<L::Scalar, Error> {
        let value = self.function.at(sample)?;
        // An infinite value has a sign, as at a pole.
        match value.to_f64().is_nan() {
            false => Ok(value),
            true => Err(Error::EventNotFinite { event: self.memory.name, time: sample.time().to_f64() }),
        }
    }
}

impl<L, K, G> AnyEvent<L> for Event<K, G>
where
    L: System<Scalar: Real> + Borrow<K>,
    K: System<Length = L::Length, M = L::M, Scalar = L::Scalar>,
    G: EventFunction<K>,
{
    #[inline]
    fn value_of(&self, sample: &Sample<&L>) -> Result<L::Scalar, Error> {
        self.evaluate(&sample.behind())
    }

    #[inline]
    fn value(&self, system: &L, state: &StateOf<L>) -> Result<L::Scalar, Error> {
        self.evaluate(&Sample::of(system.borrow(), state.clone()))
    }

    #[inline]
    fn memory(&mut self) -> &mut EventState<L::Scalar> {
        &mut self.memory
    }
}

impl<L: System, G> Debug for Event<L, G> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Event").field(&self.memory).finish()
    }
}
