//! Motions with many contacts in steps of one length: impacts and other transitions are not located, and contacts act by impulses.

mod acceleration;
mod correction;
mod forces;
mod method;
mod middle;
mod step;
mod stepper;
mod time_step;

use alloc::boxed::Box;
use alloc::vec::Vec;

use super::bodies::set_all;
use super::builder::{AcrossContacts, Builder, CrossesContacts, StartOf};
use super::{Contact, Contacts, ForceDerivatives, Friction};
use crate::error::Error;
use crate::motion::event::recorded::EventInSteps;
use crate::motion::integration::record::Steering;
use crate::motion::integration::sampled::record;
use crate::motion::integration::store::Stored;
use crate::motion::method::contract::{check_settings, limit_setters};
use crate::motion::run::Watchdog;
use crate::motion::{
    AllSteps, Controls, DynEvent, EventList, Integrates, Limits, Method, MotionBuilder, SamplesAlone,
};
use crate::number::Real;
use crate::solution::{Adjustment, Sample};
use crate::system::{Solution, StateOf};
use crate::trajectory::{SampledTrajectory, Samples, Trajectory};
use method::{TimeSteps, pushing};
pub use stepper::ContactStepper;
pub use time_step::TimeStep;

/// Time stepping of contacts by the scheme of Moreau and Jean: [`by_time_stepping`](MotionBuilder::by_time_stepping).
///
/// Stacks and heaps have too many impacts to be located one after another. Games take
/// [one step at a time](ContactStepper). A step of the length h (Moreau 1988; Jean, *Computer Methods in Applied Mechanics and
/// Engineering* 177, 1999; Acary and Brogliato, *Numerical Methods for Nonsmooth Dynamical Systems*, 2008, chapter 10)
///
/// 1. drifts: q = q⁻ + (1 − θ) h v⁻;
/// 2. kicks: M(q)(v⁺ − v⁻) = h f + Fᵀλ + Wᵀp, with the impulses λ of constraints and p of contacts and friction, and the forces f at
///    the velocities v = v⁻ + θ (v⁺ − v⁻) and the coordinates q⁻ + θ h v: they are those of the θ-method;
/// 3. drifts on: q⁺ = q + θ h v⁺, and is projected to where no gap is negative and the constraints hold, in the metric of M and
///    without a change of velocities.
///
/// Contacts act if their gaps are closed after the first drift, or would be negative in the middle of the next step. Their rates u then satisfy
/// Newton's law, u⁺ ≥ −e u⁻, p ≥ 0 and p = 0 unless they are equal, and the velocities of friction Coulomb's. Without
/// restitution, and if the contact is approached no faster than free bodies fall in a step, they close without a bounce, to be zero in the
/// middle of the next step. Where restitution with friction would give energy, it is reduced, as it is in impacts that are located. A contact with Poisson's law is an error. The
/// fields of contacts are ignored: gaps and velocities of the start say which contacts are closed.
/// ```
/// use lagrange_core::contact::{Contact, MoreauJean};
/// use lagrange_core::prelude::*;
///
/// /// A block with two corners on a slope of 20°.
/// #[derive(Clone, Lagrangian)]
/// #[coordinates(x, y, theta)]
/// #[define(corner(s) = [x + s*b*cos(theta) + h*sin(theta), y + s*b*sin(theta) - h*cos(theta)])]
/// #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*(b^2 + h^2)/6 * theta_dot^2 + m*g*(x*sin(alpha) - y*cos(alpha)))]
/// #[contact(slope[i in 0..2]: corner(2*i - 1)[1] >= 0, friction(mu): der(corner(2*i - 1))[0])]
/// struct Block { m: f64, b: f64, h: f64, g: f64, alpha: f64, mu: f64, slope: [Contact; 2] }
///
/// let block = Block {
///     m: 2.0, b: 0.2, h: 0.1, g: 9.81, alpha: 20_f64.to_radians(), mu: 0.5, slope: [Contact::Open; 2],
/// };
/// let thrown = State::new([0.0, 0.1, 0.0], [1.0, 0.0, 0.0]);
/// let path = block.motion(thrown).by_time_stepping(MoreauJean::with_step(1e-3)).to(2.0)?;
///
/// // It slides by v²/(2 g (μ cos α − sin α)), and rests.
/// let distance = 0.5 / (9.81 * (0.5 * block.alpha.cos() - block.alpha.sin()));
/// assert!((path.end().coordinate("x")? - distance).abs() < 1e-3);
/// // The lower corner carries more of the weight.
/// let [upper, lower] = [path.end().multiplier("slope[0]")?, path.end().multiplier("slope[1]")?];
/// assert!(lower > upper && (upper + lower - 2.0 * 9.81 * block.alpha.cos()).abs() < 1e-6);
/// # Ok::<(), Error>(())
/// ```
///
/// # Forces and impulses, and by what bound they are found
///
/// Forces that are linear in coordinates and velocities, as of springs and dampers, act with the whole mass matrix M + θ h C + θ² h² K, where
/// C = −∂f/∂v and K = −∂f/∂q are symmetric: a wheel of 20 kg below a spring of 40 kN/m and a damper of 4 kN s/m rests and rolls with steps of 1/60 s.
/// Of other forces, this is done with the symmetric part of the derivatives at the start of the step, and repeated until the balance of
/// momentum is off by no more than the tolerance times its largest term. What it is off by, as a part of that term, is the
/// [residual](TimeStep::residual) of the step. A step that does not reach the tolerance ends the motion with [`Error::StepTooLong`].
///
/// The iteration is accelerated (Anderson 1965; Walker and Ni, *SIAM Journal on Numerical Analysis* 49, 2011). Magnetic and gyroscopic forces, which
/// are linear in the velocities and do no work, take some five iterations, and two or three more for each further rate at which they turn
/// bodies, however far that is in a step. Beside contacts with friction, a step in which they turn a velocity by more than a right angle may be too long.
///
/// Each time, the impulses satisfy the law of contacts to round-off, as from impact to impact. Those of a step begin with what
/// stuck and slid in the one before. If none are found, [`Error::ImpulsesNotFound`] or [`Error::ContactsContradict`] ends the motion, and
/// what was computed until then is kept.
///
/// # Errors and energy
///
/// - The order is 1: an impact acts up to a step too early or late. Between impacts the order is 2 with θ = ½ and without
///   constraints, whose velocities are projected onto them within a step and do not satisfy them at its end.
/// - The impulses of constraints and of contacts that curve turn the velocities from within the step before to within this one. In a step of the
///   length h after one of the length h⁻, they have (1 + h⁻/h)/2 times the force of this turn as a mean: take multipliers from steps of one length.
/// - What rests is at rest exactly, with any step: the forces of a body that does not move are those of its place.
/// - Gaps are never below zero at the end of a step, but for round-off and a millionth of what the free bodies fall in a
///   step; up to that size they count as closed. What ends a step can start another motion.
/// - With θ = ½ and forces that do not change within a step, the energy changes by p (u⁻ + u⁺)/2 in all, which is never
///   positive: it falls, and an elastic impact keeps it. The projection may lift bodies by what the path of a contact leaves
///   its tangent in a step, of the order h², and constraints that turn take some energy, of the order h.
/// - With friction whose limit exceeds the force of sliding, the bodies stick in a step up to the limit if they stuck in the
///   one before, were at rest, or stop in it.
/// - Contacts of bodies that touch one another, directly or by others, are one problem, with the cube of their number as work; others cost
///   what they cost alone.
///
/// # Events, samples and controllers
///
/// - Between the ends of a step, coordinates and velocities are linear in the time. Samples are on these chords, and [events](crate::Event)
///   are located on them to round-off. A chord of a flight is up to g h²/8 below its parabola, and its velocity is exact with θ = ½.
/// - A velocity that an impact reverses crosses zero within the step of the impact. The gap need not reach zero there.
/// - Accelerations and multipliers of a sample are the means over its step, and NaN at the start. An event cannot depend on them:
///   [`Error::EventInTimeSteps`].
/// - A call of the controller ends a step. If its interval is no multiple of the step length, the step before each call is shorter, and
///   the next ones are counted from the call. Samples and events do not shorten steps.
/// - In the system of a sample and of a controller all contacts are closed, whether they push or not; what a controller sets them to is ignored.
/// - A terminal event ends the motion on the chord, where constraints and gaps that curve are violated by the order h².
///   [`make_consistent`](crate::Simulate::make_consistent) gives a start that satisfies the constraints.
///
/// ```
/// use lagrange_core::contact::{Contact, MoreauJean};
/// use lagrange_core::prelude::*;
///
/// /// A crate on a floor, which a winch pulls.
/// #[derive(Clone, Lagrangian)]
/// #[coordinates(x, y)]
/// #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
/// #[force(x: rope)]
/// #[contact(floor: y >= 0, friction(mu): x_dot)]
/// struct Hauled { m: f64, g: f64, mu: f64, rope: f64, floor: Contact }
///
/// let hauled = Hauled { m: 30.0, g: 9.81, mu: 0.4, rope: 0.0, floor: Contact::Closed };
/// let there = hauled.event("there", |sample| sample.state().q[0] - 1.0).terminal();
/// let motion = hauled.motion(State::at_rest([0.0, 0.0])).by_time_stepping(MoreauJean::with_step(1e-3)).event(there);
/// let motion = motion.every(0.5).quantity("friction", |sample| sample.multiplier("floor_friction"));
/// // The winch pulls by 60 N more every two seconds. The crate moves once that is more than μ m g = 117.72 N.
/// let motion = motion.controlled(2.0, |hauled, _| {
///     hauled.rope += 60.0;
///     Ok::<_, Error>(())
/// });
/// let path = motion.to(20.0)?;
/// // For two seconds with the acceleration a, and then with b.
/// let [a, b] = [120.0, 180.0].map(|rope| (rope - 117.72) / 30.0);
/// let (x, v) = (2.0 * a, 2.0 * a);
/// let end = 4.0 + ((v * v + 2.0 * b * (1.0 - x)).sqrt() - v) / b;
/// assert!((path.end().time() - end).abs() < 1e-6);
/// let friction: Vec<f64> = path.quantity("friction")?.collect();
/// assert!((friction[3] + 60.0).abs() < 1e-9 && (friction[7] + 117.72).abs() < 1e-9);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct MoreauJean {
    step: f64,
    theta: f64,
    tolerance: f64,
    max_iterations: usize,
    limits: Limits,
}

impl MoreauJean {
    /// Sets the step length, in units of time. θ is ½, the tolerance 10⁻⁸, and the limits are 50 iterations in a step and
    /// 100,000 steps.
    pub fn with_step(step: f64) -> Self {
        Self { step, theta: 0.5, tolerance: 1e-8, max_iterations: 50, limits: Limits::default() }
    }

    /// Sets the part θ of a step for which the bodies move with the velocities after it, from ½ to 1. Vibrations keep their energy
    /// with ½, to the second order, and with 1 to the first.
    pub fn theta(self, theta: f64) -> Self {
        Self { theta, ..self }
    }

    /// Sets the tolerance of the [residual](TimeStep::residual) of a step.
    pub fn tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Sets how often the impulses of a step are found anew, as forces change with the velocities.
    pub fn max_iterations(self, max_iterations: usize) -> Self {
        Self { max_iterations, ..self }
    }

    limit_setters! {
        /// Sets the largest number of steps.
    }

    fn check(&self) -> Result<(), Error> {
        let iterations = self.max_iterations as f64;
        check_settings([
            ("step", Some(self.step)),
            ("tolerance", Some(self.tolerance)),
            ("largest number of iterations", Some(iterations)),
        ])?;
        let is_right = self.theta >= 0.5 && self.theta <= 1.0;
        if is_right { Ok(()) } else { Err(Error::Theta { value: self.theta }) }
    }
}

impl<'a, 'w, L: Contacts + Clone, S, P, E, K> MotionBuilder<'a, 'w, L, S, P, E, K> {
    /// Moves across the [contacts](crate::contact) of the system in steps of one length, by the [scheme of Moreau and Jean](MoreauJean).
    /// Transitions are not located. Events, samples, quantities, the controller and the progress callback are set as without contacts,
    /// before or after; [they see](MoreauJean#events-samples-and-controllers) steps as chords.
    pub fn by_time_stepping(
        self,
        scheme: MoreauJean,
    ) -> MotionBuilder<'a, 'w, L, S, P, E, AcrossContacts<K, MoreauJean>>
    where
        S: CrossesContacts,
    {
        self.keeping(|kept| AcrossContacts { kept, crossing: scheme })
    }
}

impl<'a, 'w, L, P, E> Integrates<'a, 'w, L, StartOf<L>, P, E> for AcrossContacts<AllSteps, MoreauJean>
where
    L: ForceDerivatives<Scalar: Real> + Clone,
    E: EventList<DynEvent<'w, L>>,
{
    type Result = Trajectory<L>;

    fn run(
        motion: Builder<'a, 'w, L, P, E, AllSteps, MoreauJean>,
        end: L::Scalar,
    ) -> Result<Trajectory<L>, Error> {
        let MotionBuilder { system, start, events, on_progress, kept, .. } = motion;
        let method = TimeSteps(kept.crossing);
        let mut run = method.run(system, start.into_state()?, end)?;
        let closed = run.memory.stepper.closed().clone();
        let mut events: Vec<_> = events.list().into_iter().map(EventInSteps).collect();
        let mut stored = Stored::<_, _, _, true>::begin(&closed, &run.state, end, &mut events, on_progress)?;
        let limits = Watchdog::new(Method::<L>::limits(&method), &run.statistics);
        let driven = run.drive(&method, &limits, &mut stored);
        let path = stored.finish(driven, run.statistics, Adjustment::none(system.length()));
        Ok(run.memory.finish(path.into_owned()))
    }
}

impl<'a, 'w, L, P, E, C> Integrates<'a, 'w, L, StartOf<L>, P, E>
    for AcrossContacts<SamplesAlone<'w, L, C>, MoreauJean>
where
    L: ForceDerivatives<Scalar: Real> + Clone,
    E: EventList<DynEvent<'w, L>>,
    C: Controls<'a, 'w, L>,
{
    type Result = SampledTrajectory<L>;

    fn run(
        motion: Builder<'a, 'w, L, P, E, SamplesAlone<'w, L, C>, MoreauJean>,
        end: L::Scalar,
    ) -> Result<SampledTrajectory<L>, Error> {
        let MotionBuilder { system, start, events, on_progress, kept, .. } = motion;
        let AcrossContacts { kept, crossing } = kept;
        let (plan, steering, _) = kept.checked()?;
        let method = TimeSteps(crossing);
        let mut run = method.run(system, start.into_state()?, end)?;
        let closed = run.memory.stepper.closed().clone();
        let events = events.list().into_iter().map(|event| Box::new(EventInSteps(event)) as Box<_>).collect();
        let start = Sample::of(&closed, run.state).with(Some(Solution::unknown()));
        let steering = steering.map(keeping_contacts_closed);
        let (along, watched) = ((&plan, steering), (events, on_progress));
        let mut own = closed.clone();
        let arrival = record(&mut run, &method, (&start, Some(&mut own)), along, watched, end)?;
        let ends = run.memory.ends([start.into_owned(), Sample::of(own, arrival.state)]);
        let (open, pushing) = (run.memory.stepper.system().clone(), pushing::<L>(ends[1].given()));
        let path = Samples::of(open, ends, &plan).trajectory(arrival, Adjustment::none(system.length()));
        Ok(Trajectory { closed: pushing, ..path })
    }
}

/// The controller, followed by the closing of all contacts, as they are in the system of a sample.
fn keeping_contacts_closed<'w, L: Contacts + 'w>(steering: Steering<'w, L>) -> Steering<'w, L> {
    let Steering { interval, mut controller } = steering;
    let controller = Box::new(move |system: &mut L, state: &StateOf<L>| {
        controller(system, state)?;
        set_all(system, Contact::Closed, Friction::Sticks);
        Ok(())
    });
    Steering { interval, controller }
}
