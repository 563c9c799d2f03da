//! Settings of a motion across contacts.

use alloc::{boxed::Box, vec::Vec};

use super::driver::{Ended, Journey};
use super::legs::{Accept, AllLegs, SampledLegs};
use super::limits::TRANSITIONS;
use super::motion::ContactMotion;
use super::{Contact, Contacts};
use crate::error::Error;
use crate::motion::integration::builder::{EventList, Integrates};
use crate::motion::integration::progress::report;
use crate::motion::integration::record::{Arrival, Record, RecordPlan, Steering};
use crate::motion::run::check_end;
use crate::motion::{
    AllSteps, Controls, DynEvent, Kept, LagrangianVectorField, Method, MotionBuilder, SamplesAlone, Start,
    Steered,
};
use crate::names::name;
use crate::number::Real;
use crate::solution::Sample;
use crate::system::{Lagrangian, StateOf, System};
use crate::trajectory::{Leg, Legs, Path, SampledTrajectory, Samples, Trajectory};
use crate::vector::StaticLength;

/// Marks a motion across contacts that keeps `K`: all steps, or samples alone. It crosses them by `C`: transitions that are located, or
/// [time steps](super::MoreauJean).
#[derive(Clone, Copy, Debug)]
pub struct AcrossContacts<K = AllSteps, C = Located> {
    pub(super) kept: K,
    pub(super) crossing: C,
}

/// Marks a motion whose transitions are located.
#[derive(Clone, Copy, Debug)]
pub struct Located {
    /// Largest number of transitions.
    transitions: usize,
}

impl<'w, L: Lagrangian, K: Kept<'w, L>, C> Kept<'w, L> for AcrossContacts<K, C> {
    type Alone = AcrossContacts<K::Alone, C>;
    type Steered = AcrossContacts<K::Steered, C>;

    fn samples_alone(self, change: impl FnOnce(&mut RecordPlan<'w, L>)) -> Self::Alone {
        AcrossContacts { kept: self.kept.samples_alone(change), crossing: self.crossing }
    }

    fn steered(self, control: Steered<'w, L>) -> Self::Steered {
        AcrossContacts { kept: self.kept.steered(control), crossing: self.crossing }
    }
}

/// A start from which a motion crosses contacts: a state.
#[diagnostic::on_unimplemented(
    message = "a motion from `{Self}` does not cross contacts",
    label = "no start of a motion across contacts",
    note = "use `motion(state)`: contacts open and close by Lagrange's equations, without derivatives"
)]
pub trait CrossesContacts {}

impl<T: Real, N: StaticLength> CrossesContacts for Start<T, N, LagrangianVectorField> {}

/// Settings of a motion without events and samples, which its caller may take step by step: `()` and [`AllSteps`].
#[diagnostic::on_unimplemented(
    message = "a motion that is taken step by step has no events, samples, quantities or controller of its own",
    label = "not in such a motion",
    note = "look at the state after each step, and set inputs by `change`; `advance_to_event` of a `ContactMotion` takes events",
    note = "`motion(start).with_contacts().to(end)` and `by_time_stepping(scheme).to(end)` take them all"
)]
pub trait Stepwise {}

impl Stepwise for () {}

impl Stepwise for AllSteps {}

/// Start of a motion by Lagrange's equations.
pub(super) type StartOf<L> = Start<<L as System>::Scalar, <L as Lagrangian>::N, LagrangianVectorField>;

/// Settings of a motion from a state.
pub(super) type Builder<'a, 'w, L, P, E, K, C = Located> =
    MotionBuilder<'a, 'w, L, StartOf<L>, P, E, AcrossContacts<K, C>>;

impl<'a, 'w, L: Contacts + Clone, S, P, E, K> MotionBuilder<'a, 'w, L, S, P, E, K> {
    /// Moves across the [contacts](crate::contact) of the system: gaps close and open, and velocities jump at impacts. Events,
    /// samples, quantities, the controller and the progress callback are as without contacts, set before or after. A sample at the
    /// time of an impact is the state after it. The controller sees which contacts are closed; those that it sets are decided anew.
    ///
    /// ```
    /// use lagrange_core::contact::Contact;
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(y)]
    /// #[lagrangian(y_dot^2/2 - g*y)]
    /// #[contact(floor: y >= 0, restitution: e)]
    /// struct Ball { g: f64, e: f64, floor: Contact }
    ///
    /// let ball = Ball { g: 9.81, e: 0.5, floor: Contact::Open };
    /// let motion = ball.motion(State::at_rest([1.0])).with_contacts().every(0.1);
    /// let landed = motion.quantity("landed", |sample| f64::from(sample.system().floor == Contact::Closed)).to(2.0)?;
    /// assert_eq!((landed.samples().len(), landed.quantity("landed")?.last()), (21, Some(1.0)));
    /// assert_eq!(landed.system().floor, Contact::Closed);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn with_contacts(self) -> MotionBuilder<'a, 'w, L, S, P, E, AcrossContacts<K>>
    where
        S: CrossesContacts,
    {
        self.keeping(|kept| AcrossContacts { kept, crossing: Located { transitions: TRANSITIONS } })
    }
}

impl<L: Lagrangian, S, P, E, K> MotionBuilder<'_, '_, L, S, P, E, AcrossContacts<K>> {
    /// Sets the largest number of transitions, 100,000 if it is not set.
    pub fn max_transitions(self, count: usize) -> Self {
        self.keeping(|across| AcrossContacts { crossing: Located { transitions: count }, ..across })
    }
}

impl<L: Contacts<Scalar: Real> + Clone, P: Method<L>, E> Builder<'_, '_, L, P, E, AllSteps> {
    /// Begins a motion that its caller advances, and can steer in between. A progress callback is not called.
    ///
    /// # Errors
    /// [`Error::Setting`] for settings of the method that are not allowed, and [`Error::StateNotFinite`]. What contacts do at the start
    /// is decided when the motion is first advanced.
    pub fn begin(self) -> Result<ContactMotion<L, P>, Error>
    where
        L: 'static,
        E: Stepwise,
    {
        let Self { system, start, method, kept, .. } = self;
        method.check()?;
        Ok(ContactMotion::new(system, start.into_state()?, method, kept.crossing.transitions))
    }
}

impl<'a, 'w, L, P, E> Integrates<'a, 'w, L, StartOf<L>, P, E> for AcrossContacts
where
    L: Contacts<Scalar: Real> + Clone,
    P: Method<L>,
    E: EventList<DynEvent<'w, L>>,
{
    type Result = Trajectory<L>;

    fn run(motion: Builder<'a, 'w, L, P, E, AllSteps>, end: L::Scalar) -> Result<Trajectory<L>, Error> {
        let MotionBuilder { system, start, method, events, on_progress, kept } = motion;
        let state = start.into_state()?;
        check_times(state.t, end)?;
        let journey = Journey::new((system, method.accuracy()), state, AllLegs::none()).begin(end)?;
        let ended = journey.reporting(on_progress).run(&method, events.list(), kept.crossing.transitions)?;
        Ok(trajectory::<L, P>(ended))
    }
}

/// Names of the closed contacts.
fn closed<L: Contacts>(system: &L) -> Vec<&'static str> {
    let is_open = |k: usize| system.contact(k) == Some(Contact::Open);
    let rows = L::CONTACTS.iter().enumerate().filter(|&(k, _)| !is_open(k));
    rows.map(|(_, &row)| name(L::CONSTRAINTS, row)).collect()
}

/// The trajectory of a motion that has ended.
fn trajectory<L: Contacts<Scalar: Real> + Clone, P: Method<L>>(ended: Ended<L, AllLegs<L>>) -> Trajectory<L> {
    let Ended { kept, transitions, crossings, statistics, system, adjustment, state, ending, .. } = ended;
    let closed = closed(&system);
    let AllLegs { mut legs } = kept;
    if legs.last().is_none_or(|leg| *leg.last() != state || !leg.is_after(transitions.len())) {
        let path = Path::<_, _, Vec<P::Interpolant>>::from(state).finish();
        legs.push(Leg::new(system, path, None).after(transitions.len()));
    }
    let path = Trajectory::of(Legs(legs), crossings, ending, statistics, adjustment);
    Trajectory { transitions, closed, ..path }
}

impl<'a, 'w, L, P, E, C> Integrates<'a, 'w, L, StartOf<L>, P, E> for AcrossContacts<SamplesAlone<'w, L, C>>
where
    L: Contacts<Scalar: Real> + Clone,
    P: Method<L>,
    E: EventList<DynEvent<'w, L>>,
    C: Controls<'a, 'w, L>,
{
    type Result = SampledTrajectory<L>;

    fn run(
        motion: Builder<'a, 'w, L, P, E, SamplesAlone<'w, L, C>>,
        end: L::Scalar,
    ) -> Result<SampledTrajectory<L>, Error> {
        let MotionBuilder { system, start, method, events, mut on_progress, kept } = motion;
        let AcrossContacts { kept, crossing: Located { transitions } } = kept;
        let state = start.into_state()?;
        let (plan, steering, _) = kept.checked()?;
        let from = state.t;
        let accept = |state: &StateOf<L>, steps| report(&mut on_progress, [from, state.t, end], steps);
        let along = (&plan, events.list(), steering);
        let limit = (end, Some(transitions));
        let ended = sampled((system, state), limit, &method, along, Box::new(accept))?;
        let ends = [ended.start.clone(), Sample::of(ended.system.clone(), ended.state)];
        let samples = Samples::of(ended.system.clone(), ends, &plan);
        let (closed, adjustment) = (closed(&ended.system), ended.adjustment);
        Ok(Trajectory { closed, ..samples.trajectory(arrival(ended), adjustment) })
    }
}

/// What happens along a motion that keeps samples alone: samples, events, and the controller.
type SampledParts<'w, L> = (&'w RecordPlan<'w, L>, Vec<Box<DynEvent<'w, L>>>, Option<Steering<'w, L>>);

/// Moves a member of an ensemble across contacts to the time `end`.
pub(crate) fn arrive<'w, L: Contacts<Scalar: Real> + Clone, P: Method<L>>(
    member: (&L, StateOf<L>),
    end: L::Scalar,
    method: &P,
    along: SampledParts<'w, L>,
    accept: Accept<'w, L>,
) -> Result<Arrival<L::Scalar, L::N>, Error> {
    let arrived = arrival(sampled(member, (end, None), method, along, accept)?);
    Ok(Arrival { transitions: Vec::new(), ..arrived })
}

/// Moves across contacts to the time `end`, and keeps samples alone.
fn sampled<'w, L: Contacts<Scalar: Real> + Clone, P: Method<L>>(
    (system, state): (&L, StateOf<L>),
    (end, transitions): (L::Scalar, Option<usize>),
    method: &P,
    (plan, events, steering): SampledParts<'w, L>,
    accept: Accept<'w, L>,
) -> Result<Ended<L, SampledLegs<'w, L>>, Error> {
    check_times(state.t, end)?;
    let record = Record::before_samples(plan, Vec::new(), steering, &Sample::of(system, state), end)?;
    let journey =
        Journey::new((system, method.accuracy()), state, SampledLegs { record: Some(record) }).begin(end)?;
    journey.accepting(accept).run(method, events, transitions.unwrap_or(TRANSITIONS))
}

/// What was recorded of a motion that has ended.
fn arrival<L: Contacts<Scalar: Real>>(ended: Ended<L, SampledLegs<'_, L>>) -> Arrival<L::Scalar, L::N> {
    let Ended { kept, transitions, crossings, statistics, state, ending, .. } = ended;
    let (samples, values) = kept.record.map(Record::into_samples).unwrap_or_default();
    Arrival { state, ending, statistics, samples, values, crossings, transitions }
}

/// Checks the times of a motion, which runs forwards.
pub(super) fn check_times<T: Real>(start: T, end: T) -> Result<(), Error> {
    check_end(end)?;
    if end < start {
        let [start, end] = [start, end].map(Real::to_f64);
        return Err(Error::MotionBackwards { start, end });
    }
    Ok(())
}
