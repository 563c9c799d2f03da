//! Steps of one length across contacts, for many of them: neither impacts nor transitions are located, and impulses take the
//! place of forces.

mod correction;
mod forces;
mod middle;
mod step;
mod stepper;
mod trajectory;

use super::builder::{CrossesContacts, Stepwise, check_times};
use super::{Contacts, ForceDerivatives};
use crate::error::{Ending, Error, Pace};
use crate::motion::method::contract::check_settings;
use crate::motion::progress::report;
use crate::motion::{LagrangianVectorField, MotionBuilder, Start};
use crate::number::Real;
use crate::system::Lagrangian;
use crate::trajectory::Trajectory;
pub use stepper::ContactStepper;
use trajectory::TakenSteps;
pub use trajectory::TimeStep;

/// Largest number of steps unless [`max_steps`](MoreauJean::max_steps) sets another.
const STEPS: usize = 100_000;

/// Part of a step by which the last one may be longer than the others, instead of one more.
const LONGER: f64 = 1e-6;

/// Largest number of states for which memory is reserved before the first step.
const RESERVED: usize = 1 << 16;

/// Time stepping of contacts by the scheme of Moreau and Jean: [`by_time_stepping`](MotionBuilder::by_time_stepping).
///
/// Stacks and heaps have too many impacts to be located one after another; games and controllers take
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
#[cfg_attr(
    feature = "std",
    doc = r#"
```
use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

/// A block with two corners on a slope of 20°.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(corner(s) = [x + s*b*cos(theta) + h*sin(theta), y + s*b*sin(theta) - h*cos(theta)])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*(b^2 + h^2)/6 * theta_dot^2 + m*g*(x*sin(alpha) - y*cos(alpha)))]
#[contact(slope[i in 0..2]: corner(2*i - 1)[1] >= 0, friction(mu): der(corner(2*i - 1))[0])]
struct Block { m: f64, b: f64, h: f64, g: f64, alpha: f64, mu: f64, slope: [Contact; 2] }

let block = Block {
    m: 2.0, b: 0.2, h: 0.1, g: 9.81, alpha: 20_f64.to_radians(), mu: 0.5, slope: [Contact::Open; 2],
};
let thrown = State::new([0.0, 0.1, 0.0], [1.0, 0.0, 0.0]);
let path = block.motion(thrown).by_time_stepping(MoreauJean::with_step(1e-3)).to(2.0)?;

// It slides by v²/(2 g (μ cos α − sin α)), and rests.
let distance = 0.5 / (9.81 * (0.5 * block.alpha.cos() - block.alpha.sin()));
assert!((path.end().coordinate("x")? - distance).abs() < 1e-3);
// The lower corner carries more of the weight.
let [upper, lower] = [path.end().multiplier("slope[0]")?, path.end().multiplier("slope[1]")?];
assert!(lower > upper && (upper + lower - 2.0 * 9.81 * block.alpha.cos()).abs() < 1e-6);
# Ok::<(), Error>(())
```
"#
)]
///
/// # Forces and impulses, and by what bound they are found
///
/// Forces that are linear in coordinates and velocities, as of springs and dampers, act with the whole mass matrix M + θ h C + θ² h² K, where
/// C = −∂f/∂v and K = −∂f/∂q: a wheel of 20 kg below a spring of 40 kN/m and a damper of 4 kN s/m rests and rolls with steps of 1/60 s. Of
/// other forces, this is done with the symmetric part of the derivatives at the start of the step, and repeated until the balance of
/// momentum is off by no more than the tolerance times its largest term. What it is off by, as a part of that term, is the
/// [residual](TimeStep::residual) of the step. A step that does not reach the tolerance ends the motion with [`Error::StepTooLong`].
///
/// Each time, the impulses satisfy the law of contacts to round-off, as from impact to impact. Those of a step begin with what
/// stuck and slid in the one before. If none are found, [`Error::ImpulsesNotFound`] or [`Error::ContactsContradict`] ends the motion, and
/// what was computed until then is kept.
///
/// # Errors and energy
///
/// - The order is 1: an impact acts up to a step too early or late. Between impacts the order is 2 with θ = ½ and without
///   constraints, whose velocities are projected onto them within a step and do not satisfy them at its end.
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
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct MoreauJean {
    step: f64,
    theta: f64,
    tolerance: f64,
    max_iterations: usize,
    max_steps: usize,
}

impl MoreauJean {
    /// Sets the step length, in units of time. θ is ½, the tolerance 10⁻⁸, and the limits are 50 iterations in a step and
    /// 100,000 steps.
    pub fn with_step(step: f64) -> Self {
        Self { step, theta: 0.5, tolerance: 1e-8, max_iterations: 50, max_steps: STEPS }
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

    /// Sets the largest number of steps.
    pub fn max_steps(self, max_steps: usize) -> Self {
        Self { max_steps, ..self }
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

/// Marks a motion in steps of one length across contacts.
#[derive(Clone, Copy, Debug)]
pub struct TimeStepping {
    scheme: MoreauJean,
}

impl<'a, 'w, L: Contacts + Clone, S, P, E, K> MotionBuilder<'a, 'w, L, S, P, E, K> {
    /// Moves across the [contacts](crate::contact) of the system in steps of one length, without events, by the
    /// [scheme of Moreau and Jean](MoreauJean).
    pub fn by_time_stepping(self, scheme: MoreauJean) -> MotionBuilder<'a, 'w, L, S, P, (), TimeStepping>
    where
        S: CrossesContacts,
        E: Stepwise,
        K: Stepwise,
    {
        self.with_events(|_| ()).keeping(|_| TimeStepping { scheme })
    }
}

/// Settings of a motion from a state.
type Builder<'a, 'w, L, P, E> = MotionBuilder<
    'a,
    'w,
    L,
    Start<<L as Lagrangian>::Scalar, <L as Lagrangian>::N, LagrangianVectorField>,
    P,
    E,
    TimeStepping,
>;

impl<L: ForceDerivatives<Scalar: Real> + Clone, P, E> Builder<'_, '_, L, P, E> {
    /// Moves to the time `end`.
    ///
    /// # Errors
    /// Those of [`towards`](Self::towards), and [`Error::Unfinished`] if the motion stops before.
    pub fn to(self, end: L::Scalar) -> Result<Trajectory<L>, Error>
    where
        E: Stepwise,
    {
        self.towards(end)?.finished()
    }

    /// Moves towards the time `end`. If the motion fails on the way, the result holds what was computed until then, and its
    /// [`ending`](Trajectory::ending) the reason: [`Error::StepTooLong`], [`Error::ImpulsesNotFound`] or
    /// [`Error::ContactsContradict`].
    ///
    /// # Errors
    /// Those of [`stepper`](Self::stepper); [`Error::MotionBackwards`] if `end` lies before the start.
    pub fn towards(mut self, end: L::Scalar) -> Result<Trajectory<L>, Error>
    where
        E: Stepwise,
    {
        let mut on_progress = core::mem::take(&mut self.on_progress);
        let (scheme, mut stepper) = (self.kept.scheme, self.stepper()?);
        let from = stepper.state().t;
        check_times(from, end)?;
        let count = count(&scheme, (end - from).to_f64());
        let mut steps = TakenSteps::from(*stepper.state(), count.min(scheme.max_steps).min(RESERVED));
        let ending = loop {
            let done = steps.count();
            let (last, next) = (stepper.state().t, if done + 1 == count { end } else { stepper.next_time() });
            let time = last.to_f64();
            if done == count {
                break Ending::Complete { time };
            }
            if done >= scheme.max_steps {
                break Ending::StepLimit { time, steps: done, pace: Pace::default() };
            }
            if next <= last {
                break Ending::TimeTooCoarse { time, step: scheme.step };
            }
            match stepper.advance(next) {
                Ok(step) => steps.push(step),
                Err(error) => break Ending::of(error, time),
            }
            if let Err(ending) = report(&mut on_progress, [from, next, end], done + 1) {
                break ending;
            }
        };
        Ok(steps.finish(stepper.into_systems(), ending))
    }
}

/// Number of steps over a span of time, the last of which may be shorter.
fn count(scheme: &MoreauJean, span: f64) -> usize {
    let steps = f64::max(span / scheme.step - LONGER, 0.0);
    // Rounded up; `ceil` needs the standard library.
    (steps as usize).saturating_add(usize::from(steps > steps as usize as f64))
}
