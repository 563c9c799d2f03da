//! A motion across contacts that its caller advances.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};

use super::builder::check_times;
use super::driver::Journey;
use super::legs::SampledLegs;
use super::{Contacts, Transition};
use crate::error::{Ending, Error};
use crate::motion::{AnyEvent, DynEvent, Method};
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::crossing::Crossing;
use crate::statistics::Statistics;
use crate::system::StateOf;
use crate::system::finite::check_finite;

/// A motion across contacts that its caller advances to a time or to an event, and can steer in between: what [`Motion`](crate::Motion)
/// is without contacts. [`begin`](crate::MotionBuilder::begin) makes one.
///
/// Impacts, openings, stick and slip are located as by [`with_contacts`](crate::MotionBuilder::with_contacts), to which it is
/// equal but for the lengths of steps: each advance begins with a new one. Nothing is stored but the transitions of the last advance.
///
/// ```
/// use lagrange_core::contact::{Contact, Transition};
/// use lagrange_core::prelude::*;
///
/// /// A cart on a floor, which a motor drives against dry friction.
/// #[derive(Clone, Lagrangian)]
/// #[coordinates(x, y)]
/// #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
/// #[force(x: motor)]
/// #[contact(floor: y >= 0, friction(mu): x_dot)]
/// struct Cart { m: f64, g: f64, mu: f64, motor: f64, floor: Contact }
///
/// let cart = Cart { m: 2.0, g: 9.81, mu: 0.5, motor: 0.0, floor: Contact::Open };
/// let mut motion = cart.motion(State::at_rest([0.0, 0.0])).with_contacts().begin()?;
/// for frame in 1..=120 {
///     // The motor pulls harder and harder: the cart holds up to μ m g = 9.81 N.
///     motion.change(|cart| cart.motor = f64::from(frame) / 10.0);
///     motion.advance_to(f64::from(frame) / 60.0)?;
///     let slips = motion.transitions().iter().any(|change| matches!(change, Transition::Slips { .. }));
///     assert_eq!(slips, frame == 99);
/// }
/// assert!((motion.sample().multiplier("floor_friction")? + 0.5 * 2.0 * 9.81).abs() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
pub struct ContactMotion<L: Contacts<Scalar: Real> + 'static, P> {
    journey: Journey<'static, L, SampledLegs<'static, L>>,
    method: P,
    /// Largest number of transitions of an advance.
    limit: usize,
    /// The system with its contacts as they are now.
    system: L,
    /// Contacts are to be decided anew: at the start, and after a change.
    is_changed: bool,
}

impl<L: Contacts<Scalar: Real> + Clone + 'static, P: Method<L>> ContactMotion<L, P> {
    pub(super) fn new(system: &L, state: StateOf<L>, method: P, limit: usize) -> Self {
        let journey = Journey::new((system, method.accuracy()), state, SampledLegs { record: None });
        Self { journey, method, limit, system: system.clone(), is_changed: true }
    }

    /// Returns the current state.
    pub fn state(&self) -> &StateOf<L> {
        &self.journey.state
    }

    /// Returns the system, with its contacts as they are now; before the first advance and after a change as its fields say.
    pub fn system(&self) -> &L {
        &self.system
    }

    /// Returns the current state with its [`system`](Self::system), for queries by name. An advance to the current time decides its contacts
    /// after a start or a change.
    pub fn sample(&self) -> Sample<&L> {
        Sample::of(&self.system, self.journey.state)
    }

    /// Returns the transitions of the last advance, in the order in which they were decided.
    pub fn transitions(&self) -> &[Transition<L::Scalar>] {
        &self.journey.transitions
    }

    /// Returns the numbers of steps and evaluations since the start.
    pub fn statistics(&self) -> &Statistics {
        &self.journey.statistics
    }

    /// Changes parameters, as inputs of a controller, from the current time on. Which contacts are closed is then decided anew. What
    /// makes a gap negative, or parts a contact that is closed, is an error of the next advance.
    pub fn change(&mut self, change: impl FnOnce(&mut L)) {
        change(&mut self.system);
        self.is_changed = true;
    }

    /// Goes on from another state, which may be of an earlier time.
    ///
    /// # Errors
    /// [`Error::StateNotFinite`]; what does not satisfy gaps and constraints is an error of the next advance.
    pub fn set_state(&mut self, state: StateOf<L>) -> Result<(), Error> {
        check_finite(&self.system, &state)?;
        self.journey.restart(state);
        self.is_changed = true;
        Ok(())
    }

    /// Advances to the time `end`, which is reached exactly.
    ///
    /// # Errors
    /// The reason why the motion stops before `end`, from where it was. [`Ending::Unsolved`] with [`Error::MotionBackwards`] for an earlier
    /// time, and with [`Error::Penetration`] or [`Error::ClosedApart`] for a start or a change that gaps do not allow.
    pub fn advance_to(&mut self, end: L::Scalar) -> Result<(), Ending> {
        self.advance(end, &mut []).map(drop)
    }

    /// Advances by this length of time; many equal lengths add up with the rounding error of each sum.
    ///
    /// # Errors
    /// Those of [`advance_to`](Self::advance_to).
    pub fn advance_by(&mut self, length: L::Scalar) -> Result<(), Ending> {
        self.advance_to(self.state().t + length)
    }

    /// Advances to the first crossing of a [terminal](crate::Event::terminal) one of these events, or to the time `end` if there is none
    /// on the way. At an impact, the state is that before it, and the impact follows with the next advance.
    ///
    /// # Errors
    /// Those of [`advance_to`](Self::advance_to), and those of the functions of events.
    pub fn advance_to_event(
        &mut self,
        end: L::Scalar,
        events: &mut [&mut dyn AnyEvent<L>],
    ) -> Result<Option<Crossing<L::Scalar, L::N>>, Ending> {
        let mut events: Vec<_> =
            events.iter_mut().map(|event| Box::new(&mut **event) as Box<DynEvent<'_, L>>).collect();
        let ending = self.advance(end, &mut events)?;
        let last = self.journey.crossings.last().filter(|_| matches!(ending, Ending::Event { .. }));
        Ok(last.copied())
    }

    fn advance(&mut self, end: L::Scalar, events: &mut [Box<DynEvent<'_, L>>]) -> Result<Ending, Ending> {
        let time = self.state().t.to_f64();
        self.journey.forget();
        check_times(self.state().t, end).map_err(|error| Ending::of(error, time))?;
        let ending = self.moved(end, events).unwrap_or_else(|error| Ending::of(error, time));
        self.system = self.journey.system();
        // What happens at an event follows with the next advance.
        self.is_changed |= !matches!(ending, Ending::Complete { .. });
        if ending.is_failure() { Err(ending) } else { Ok(ending) }
    }

    /// Advances to an end that is not before the state.
    fn moved(&mut self, end: L::Scalar, events: &mut [Box<DynEvent<'_, L>>]) -> Result<Ending, Error> {
        if self.is_changed {
            self.journey.bodies.take(&self.system);
        }
        self.journey.head_for(end)?;
        if self.is_changed {
            self.journey.settle_anew()?;
            self.is_changed = false;
        }
        self.journey.go_on(&self.method, events, self.limit)
    }
}

impl<L: Contacts<Scalar: Real> + 'static, P: Debug> Debug for ContactMotion<L, P> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("ContactMotion");
        text.field("system", &L::NAME)
            .field("state", &self.journey.state)
            .field("method", &self.method)
            .finish_non_exhaustive()
    }
}
