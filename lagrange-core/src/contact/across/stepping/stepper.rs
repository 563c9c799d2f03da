//! Steps across contacts, one at a time.

use core::fmt::{self, Debug, Formatter};

use super::MoreauJean;
use super::middle::Middle;
use super::step::Steps;
use super::time_step::TimeStep;
use crate::contact::across::bodies::Bodies;
use crate::contact::across::builder::{Builder, Stepwise};
use crate::contact::across::limits::INSTANT;
use crate::contact::{Contacts, ForceDerivatives, ImpactLaw};
use crate::error::{Ending, Error};
use crate::names::{Row, name};
use crate::number::limits::CANCELLED;
use crate::number::{Real, Scalar};
use crate::solution::Sample;
use crate::solution::solve::solve;
use crate::system::StateOf;
use crate::vector::StaticLength;

/// A motion across contacts that is taken step by step, for games and controllers. It remembers what stuck and slid: its steps equal those of
/// [`to`](crate::MotionBuilder::to) to the last bit, and those of a controlled motion if it [steps to](Self::step_to) the times of the calls.
///
/// ```
/// use lagrange_core::contact::{Contact, MoreauJean};
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
/// let cart = Cart { m: 2.0, g: 9.81, mu: 0.5, motor: 0.0, floor: Contact::Closed };
/// let motion = cart.motion(State::at_rest([0.0, 0.0])).by_time_stepping(MoreauJean::with_step(1.0 / 60.0));
/// let mut stepper = motion.stepper()?;
/// for frame in 0..120 {
///     // The motor pulls harder and harder: the cart holds up to μ m g.
///     stepper.change(|cart| cart.motor = f64::from(frame) / 10.0);
///     let step = stepper.step()?;
///     assert_eq!(step.state.v[0] > 1e-12, f64::from(frame) / 10.0 > 0.5 * 2.0 * 9.81);
///     assert!((stepper.sample().multiplier("floor")? - 2.0 * 9.81).abs() < 1e-9);
/// }
/// # Ok::<(), Error>(())
/// ```
pub struct ContactStepper<L: Contacts<Scalar: Real>> {
    steps: Steps<L>,
    last: TimeStep<L>,
    /// From where steps of the length of the scheme are counted, and their number.
    from: L::Scalar,
    done: usize,
}

impl<L: ForceDerivatives<Scalar: Real> + Clone, P, E, K> Builder<'_, '_, L, P, E, K, MoreauJean> {
    /// Begins a motion that is taken step by step. A progress callback is not called, and limits do not count.
    ///
    /// # Errors
    /// [`Error::Setting`] and [`Error::Theta`] for settings that are not allowed; [`Error::ImpactLaw`] if a contact has Poisson's
    /// law of impact; those of [`solve`](crate::Simulate::solve) at the start; [`Error::Penetration`] if a gap is negative there,
    /// [`Error::NotProjected`] and [`Error::Inconsistent`] if a constraint does not hold, by more than what a step leaves.
    pub fn stepper(self) -> Result<ContactStepper<L>, Error>
    where
        E: Stepwise,
        K: Stepwise,
    {
        let Self { system, start, kept, .. } = self;
        ContactStepper::new(system, &start.into_state()?, kept.crossing)
    }
}

impl<L: ForceDerivatives<Scalar: Real> + Clone> ContactStepper<L> {
    pub(super) fn new(system: &L, state: &StateOf<L>, scheme: MoreauJean) -> Result<Self, Error> {
        scheme.check()?;
        let mut bodies = Bodies::new(system, 0.0);
        if let Some(k) = L::IMPACT_LAWS.iter().position(|&law| law == ImpactLaw::Poisson) {
            return Err(Error::ImpactLaw { contact: bodies.name(k) });
        }
        solve(&bodies.open, state)?;
        bodies.passes(state);
        bodies.reaches(state, L::Scalar::constant(scheme.step))?;
        check_start(&bodies, state, &scheme)?;
        let steps = Steps::new(bodies, scheme, state);
        Ok(Self { steps, last: TimeStep::start(*state), from: state.t, done: 0 })
    }

    /// Takes a step of the length of the scheme.
    ///
    /// # Errors
    /// [`Error::StepTooLong`], [`Error::ImpulsesNotFound`], [`Error::ContactsContradict`]; [`Error::EquationsNotFinite`];
    /// [`Ending::TimeTooCoarse`] in [`Error::Unfinished`]. The stepper stays at the end of the last step.
    pub fn step(&mut self) -> Result<&TimeStep<L>, Error> {
        let next = self.next_time()?;
        self.advance(next)
    }

    /// Takes a step of the length of the scheme, or one to the time `end` if that comes before, or after it by no more than an [`INSTANT`].
    pub(super) fn step_towards(&mut self, end: L::Scalar) -> Result<&TimeStep<L>, Ending> {
        let (time, next) = (self.last.state.t.to_f64(), self.next_time()?);
        let longer = L::Scalar::constant(self.steps.settings.step * INSTANT);
        let taken = if next + longer < end { self.advance(next) } else { self.step_to(end) };
        taken.map_err(|error| Ending::of(error, time))
    }

    /// Takes a step to this time, and counts those that follow from there.
    ///
    /// # Errors
    /// Those of [`step`](Self::step); [`Error::MotionBackwards`] if the time is not after that of the state.
    pub fn step_to(&mut self, time: L::Scalar) -> Result<&TimeStep<L>, Error> {
        let now = self.last.state.t;
        let is_after = time > now;
        if !is_after {
            return Err(Error::MotionBackwards { start: now.to_f64(), end: time.to_f64() });
        }
        self.advance(time)?;
        (self.from, self.done) = (time, 0);
        Ok(&self.last)
    }

    /// Takes a step to this time, and counts it.
    fn advance(&mut self, time: L::Scalar) -> Result<&TimeStep<L>, Error> {
        self.last = self.steps.step(&self.last.state, time)?;
        self.done += 1;
        Ok(&self.last)
    }

    /// The end of the next step of the length of the scheme, after the present time.
    fn next_time(&self) -> Result<L::Scalar, Ending> {
        let (now, step) = (self.last.state.t, self.steps.settings.step);
        let next = self.from + L::Scalar::constant(step * (self.done + 1) as f64);
        if next > now { Ok(next) } else { Err(Ending::TimeTooCoarse { time: now.to_f64(), step }) }
    }

    /// Returns the last step. Before the first, it has the start and no impulses.
    pub fn last(&self) -> &TimeStep<L> {
        &self.last
    }

    /// Returns the state at the end of the last step.
    pub fn state(&self) -> &StateOf<L> {
        &self.last.state
    }

    /// Returns the sample at the end of the last step, for queries by name: accelerations and multipliers are the means over the step, and
    /// NaN before the first. Its system has all contacts closed, so that their forces count.
    pub fn sample(&self) -> Sample<&L> {
        Sample::of(self.closed(), self.last.state).with(Some(self.last.means))
    }

    /// Returns the system, with all contacts open.
    pub fn system(&self) -> &L {
        &self.steps.bodies.open
    }

    /// Changes parameters, as inputs of a controller, from the next step on. What makes a gap negative is [`Error::Penetration`] there.
    pub fn change(&mut self, change: impl FnOnce(&mut L)) {
        let mut system = self.system().clone();
        change(&mut system);
        self.take(&system);
    }

    /// Takes the parameters of this system from the next step on.
    pub(super) fn take(&mut self, system: &L) {
        self.steps.bodies.take(system);
        self.steps.is_changed = true;
    }

    /// The system with all contacts closed.
    pub(super) fn closed(&self) -> &L {
        &self.steps.bodies.closed
    }
}

impl<L: Contacts<Scalar: Real>> Debug for ContactStepper<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("ContactStepper")
            .field("system", &L::NAME)
            .field("last", &self.last)
            .finish_non_exhaustive()
    }
}

/// Checks a start as what a step may leave.
fn check_start<L: ForceDerivatives<Scalar: Real> + Clone>(
    bodies: &Bodies<L>,
    state: &StateOf<L>,
    scheme: &MoreauJean,
) -> Result<(), Error> {
    let middle = Middle::of(bodies, state, L::Scalar::constant(scheme.step), scheme.theta)?;
    middle.check(bodies, state)?;
    let (rates, sizes) = (bodies.open.constraint_rate(state), bodies.open.rate_magnitude(state));
    let turns = bodies.open.constraint_bias(state);
    for a in 0..<L::M>::COUNT {
        // Velocities that satisfy a constraint in the middle of a step leave it by what it turns until its end.
        let allowed =
            L::Scalar::EPSILON * CANCELLED * sizes[a].to_f64() + 2.0 * scheme.step * turns[a].to_f64().abs();
        if Scalar::abs(rates[a]).to_f64() > allowed + middle.touching[a] / scheme.step {
            let (constraint, time) = (Row::Constraint(name(L::CONSTRAINTS, a)), state.t.to_f64());
            return Err(Error::Inconsistent { constraint, rate: true, residual: rates[a].to_f64(), time });
        }
    }
    Ok(())
}
