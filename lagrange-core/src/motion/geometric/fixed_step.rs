//! Methods with steps of one length: the loop over the steps of a composition, and the interface of a method.

use core::fmt::{self, Debug};

use super::composition::Composition;
use super::dense::{Coefficients, cubic, septic};
use super::scheme::{CompensatedState, Scheme, SymmetricScheme};
use super::settle::NotSettled;
use crate::error::{Ending, Error};
use crate::motion::method::clock::Clock;
use crate::motion::method::contract::{Limits, Method, Step, check_settings, limit_setters};
use crate::number::{Parts, Real, Scalar, are_finite};
use crate::solution::interpolant::Polynomial;
use crate::solution::named_field::NamedField;
use crate::solution::system_checks::SystemChecks;
use crate::solution::vector_field::{StagePoint, VectorField, VelocityField};
use crate::statistics::Statistics;
use crate::system::{State, StateOf, System, check_friction};
use crate::vector::{Element, Length, Numbers, PhaseVector, StaticLength, VectorOf};

/// A method whose steps all have one length, but for the last before an end, which may be shorter.
///
/// The scheme `S` is one step: [`Verlet`](super::Verlet), [`Gauss`](super::Gauss), [`Lobatto`](super::Lobatto) and
/// [`DAlembert`](super::DAlembert) are methods of this type, and so is a [`Scheme`] of your own. Such a method keeps the structure of mechanics because
/// its steps do not adapt; it does not estimate its error, so compare with a run at half the step length.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct FixedStep<S> {
    step: f64,
    scheme: S,
    composition: Option<Composition>,
    limits: Limits,
}

impl<S: Default> FixedStep<S> {
    /// Sets the step length, in units of time. The limit is 100 000 steps.
    pub fn with_step(step: f64) -> Self {
        Self { step, scheme: S::default(), composition: None, limits: Limits::default() }
    }

    limit_setters! {
        /// Sets the limit on the number of steps.
    }

    /// Composes steps of a symmetric scheme of order 2 to a method of higher order.
    pub fn composed(self, composition: Composition) -> Self
    where
        S: SymmetricScheme,
    {
        Self { composition: Some(composition), ..self }
    }

    /// Lengths of the steps of the scheme within one step, in units of it.
    fn lengths(&self) -> &'static [f64] {
        self.composition.map_or(&[1.0], Composition::lengths)
    }

    /// Moves a point by a step of length `h` to the time `to`. Returns the number of evaluations of the forces.
    pub(crate) fn advance<L: System<Scalar: Parts>>(
        &self,
        system: &L,
        point: &mut CompensatedState<L::Scalar, L::Length>,
        carried: &mut S::Carried,
        (h, to): (L::Scalar, L::Scalar),
    ) -> Result<usize, NotSettled>
    where
        S: Scheme<L>,
    {
        let (start, lengths) = (point.state.t, self.lengths());
        let (mut sum, mut evaluations) = (0.0, 0);
        for (k, length) in lengths.iter().enumerate() {
            sum += length;
            let time = if k + 1 == lengths.len() { to } else { start + L::Scalar::constant(sum) * h };
            // Far from zero, differences of the times would not have the ratios of a composition.
            evaluations += S::advance(system, point, carried, (L::Scalar::constant(*length) * h, time))?;
        }
        Ok(evaluations)
    }

    /// Order of the method.
    fn order<L: System<Scalar: Parts>>(&self) -> usize
    where
        S: Scheme<L>,
    {
        self.composition.map_or(S::ORDER, Composition::order)
    }

    /// Coefficients of the dense output of a step, from the accelerations at its ends and, for orders above 4, `between`.
    ///
    /// # Errors
    /// Those of `between`.
    pub(crate) fn coefficients<L: System<Scalar: Parts>, E>(
        &self,
        ends: [&StateOf<L>; 2],
        accelerations: &PhaseVector<L::Scalar, L::Length>,
        between: impl FnMut(&StateOf<L>) -> Result<VectorOf<L::Scalar, L::Length>, E>,
    ) -> Result<Coefficients<L::Scalar, L::Length>, E>
    where
        S: Scheme<L>,
    {
        match self.order::<L>() {
            ..=4 => Ok(cubic(ends, accelerations)),
            _ => septic(ends, accelerations, between),
        }
    }
}

/// More than one step since the last dense output.
const NO_STEP: usize = usize::MAX;

/// State that the method carries from step to step.
#[derive(Clone, Debug)]
pub struct FixedStepMemory<T: Element, N: Length, C> {
    clock: Clock<T>,
    /// Length of the next step.
    planned: T,
    /// Current state. The method has its own: a step would wait for the copies that the loop makes of its states.
    point: CompensatedState<T, N>,
    carried: C,
    /// Accelerations at the ends of the last step with dense output, and the number of steps since.
    accelerations: PhaseVector<T, N>,
    steps_since: usize,
}

impl<L, F, S> Method<L, F> for FixedStep<S>
where
    L: System<Scalar: Real>,
    F: VelocityField<L>,
    S: Scheme<L> + Default,
{
    type Memory = FixedStepMemory<L::Scalar, L::Length, S::Carried>;
    type Interpolant = Polynomial<L::Scalar, Coefficients<L::Scalar, L::Length>>;

    fn limits(&self) -> Limits {
        self.limits
    }

    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        S::identify(to)?;
        write!(to, " {:?} {:?}", self.step, self.lengths())
    }

    fn check(&self) -> Result<(), Error> {
        check_settings([("fixed step", Some(self.step))])
    }

    fn begin(
        &self,
        system: &L,
        start: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        const { check_friction(F::Checks::HAS_FRICTION) };
        statistics.evaluations += 1;
        let planned = L::Scalar::constant(self.step);
        Ok(FixedStepMemory {
            clock: Clock::new(start.t, Some(planned)),
            planned,
            point: CompensatedState::at(start),
            carried: S::start(system, start),
            accelerations: PhaseVector::joined(&start.q, &start.v),
            steps_since: NO_STEP,
        })
    }

    fn resume(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        state: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        statistics.evaluations += 1;
        memory.clock.set(state.t);
        memory.point = CompensatedState::at(state);
        (memory.carried, memory.steps_since) = (S::start(system, state), NO_STEP);
        Ok(())
    }

    #[inline]
    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        from: &StateOf<L>,
        to: &mut StateOf<L>,
        statistics: &mut Statistics,
    ) -> Step {
        let FixedStepMemory { clock, planned, point, carried, steps_since, .. } = memory;
        clock.aim(end);
        let (h, time) = clock.next(*planned);
        *steps_since = steps_since.saturating_add(1);
        if !clock.is_ahead(time) {
            return Step::Failed(Ending::TimeTooCoarse { time: from.t.to_f64(), step: self.step });
        }
        let moved = self.advance(system, point, carried, (h, time));
        match moved {
            Ok(evaluations) if is_finite(&point.state) => {
                statistics.evaluations += evaluations;
                *planned = clock.tick((h, time), *planned, L::Scalar::constant(self.step));
                to.clone_from(&point.state);
                Step::Accepted
            }
            _ => Step::Failed(failure::<L, F>(system, (from, h), moved.map(|_| &point.state))),
        }
    }

    fn interpolant(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        [from, to]: [&StateOf<L>; 2],
        statistics: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let FixedStepMemory { carried, accelerations, steps_since, .. } = memory;
        let mut evaluate = |state: &StateOf<L>| {
            statistics.evaluations += 1;
            checked_accelerations::<L, F>(system, state)
        };
        match *steps_since {
            1 => accelerations.flat_mut().rotate_left(to.q.entries().len()),
            _ => accelerations[0].copy_from_slice(evaluate(from)?.entries()),
        }
        let last = match S::accelerations(system, to, carried) {
            Some(accelerations) => accelerations,
            None => evaluate(to)?,
        };
        accelerations[1].copy_from_slice(last.entries());
        *steps_since = 0;
        let coefficients = self.coefficients::<L, Error>([from, to], accelerations, evaluate)?;
        Ok(Polynomial::new(from.t, to.t - from.t, coefficients))
    }
}

#[inline(never)]
fn checked_accelerations<L: System<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<VectorOf<L::Scalar, L::Length>, Error> {
    let point = StagePoint::of(state);
    let mut rates = point.y.clone();
    F::evaluate(system, &point, None, &mut rates)?;
    Ok(VectorOf::<_, L::Length>::from_entries(&rates[1]))
}

fn is_finite<T: Real, N: Length>(state: &State<T, N>) -> bool {
    are_finite(state.q.entries()) & are_finite(state.v.entries())
}

/// The reason why no step from `start` leads to a state: the equations have no solution there, the end is not finite,
/// or the iteration does not converge.
#[cold]
fn failure<L: System<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    (start, h): (&StateOf<L>, L::Scalar),
    end: Result<&StateOf<L>, NotSettled>,
) -> Ending {
    let time = start.t.to_f64();
    // Where the equations end within the step, they have no solution beyond it either.
    let mut beyond = start.clone();
    beyond.t = start.t + h;
    for (q, v) in beyond.q.entries_mut().iter_mut().zip(start.v.entries()) {
        *q += *v * h;
    }
    for state in [start, &beyond] {
        match F::Checks::check_solution(system, state) {
            Err(error) if state.t == start.t => return Ending::of(error, time),
            Err(error @ Error::EquationsNotFinite { .. }) => return Ending::of(error, time),
            _ => {}
        }
    }
    let momenta = F::Checks::momenta(system, start);
    let end = end.unwrap_or(start);
    let is_finite = |i: usize| [momenta[i], end.q[i], end.v[i]].into_iter().all(Parts::is_finite);
    match (0..end.q.entries().len()).find(|&i| !is_finite(i)) {
        Some(i) => Ending::NotFinite { time, row: F::Checks::row(system, i) },
        None => Ending::MethodFailed {
            time,
            reason: match <L::M as StaticLength>::COUNT {
                0 => {
                    "the iteration of a step does not converge; take shorter steps, or with strong damping or stiff springs `Radau`"
                }
                _ => {
                    "the iteration of a step does not converge; take shorter steps, or with strong damping or stiff springs `Radau`, or, if constraints depend on one another, `Dop853`, `Taylor` or `Radau`"
                }
            },
        },
    }
}
