//! A motion with its derivatives by initial values and parameters.

use alloc::{boxed::Box, string::String, string::ToString, vec::Vec};
use core::fmt::{self, Debug, Formatter};
use core::ops::Deref;

use super::across::MotionDerivatives;
use super::events::DifferentiableEvent;
use super::state::{StateSensitivity, at_event};
use crate::derivatives::tangent::{Tangent, WideOf};
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::variation::{DifferentiableMethod, Variations, VariedRun};
use crate::motion::integration::builder::EventList;
use crate::motion::integration::progress::OnProgress;
use crate::motion::integration::store::Stored;
use crate::motion::run::{Observer, Run, Watchdog, check_end};
use crate::motion::{AllSteps, AnyEvent, HasEnding, Integrates, LagrangianVectorField, MotionBuilder, Start};
use crate::names::Entry;
use crate::number::{Broadcast, Real, Scalar, Wide};
use crate::solution::crossing::Crossing;
use crate::system::finite::check_finite;
use crate::system::{Direction, Lagrangian, StateOf, check_contacts, lookup};
use crate::trajectory::Trajectory;
use crate::vector::{Entrywise, PhaseVector, StaticLength};

/// A motion with its derivatives by entries of the initial state and by parameters.
///
/// It is read like the motion alone, a [`Trajectory`]: `motion.end()`, `motion.at(t)`, `motion.crossings()`. The call that integrates names
/// the arguments. With constraints, derivatives lie in the tangent space at every time.
pub struct TrajectorySensitivity<'a, L: Linearized<Scalar: Real>> {
    trajectory: Trajectory<&'a L>,
    course: Course<L>,
    end: Result<StateSensitivity<L::Scalar, L::N>, Error>,
}

/// Derivatives along a motion.
pub(super) struct Course<L: Linearized<Scalar: Real>> {
    /// Variations at the end of the last step.
    pub(super) variations: Variations<L>,
    /// Time at the end of the last step; the motion may have ended within this step.
    end: L::Scalar,
    /// Start and length of each step.
    steps: Vec<[L::Scalar; 2]>,
    /// Coefficients of the interpolants of the variations, step by step and block by block, the same number for each.
    pub(super) coefficients: Vec<PhaseVector<WideOf<L>, L::N>>,
    /// Evaluates an interpolant from its coefficients.
    between: Between<WideOf<L>, L::N>,
}

/// Variations of a block at a fraction of a step, from the coefficients of the interpolant.
type Between<W, N> = fn(&[PhaseVector<W, N>], W) -> PhaseVector<W, N>;

/// An event of a motion with derivatives.
pub(super) type DynDifferentiableEvent<'a, L> = dyn DifferentiableEvent<L> + 'a;

impl<'a, 'w, L, P, E, J> MotionBuilder<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E, J>
where
    L: Lagrangian<Scalar: Real>,
{
    /// Adds an event made by [`differentiable_event`](crate::MotionDerivatives::differentiable_event), by value or as `&mut event`.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its list of events")]
    pub fn event(
        self,
        event: impl DifferentiableEvent<L> + 'w,
    ) -> MotionBuilder<
        'a,
        'w,
        L,
        StateSensitivity<L::Scalar, L::N>,
        P,
        Vec<Box<DynDifferentiableEvent<'w, L>>>,
        J,
    >
    where
        L: Linearized,
        E: EventList<DynDifferentiableEvent<'w, L>>,
    {
        self.with_events(|events| {
            let mut events = events.list();
            events.push(Box::new(event));
            events
        })
    }
}

impl<'a, 'w, L, P, K> MotionBuilder<'a, 'w, L, Start<L::Scalar, L::N, LagrangianVectorField>, P, (), K>
where
    L: Linearized<Scalar: Real>,
{
    /// Integrates the derivatives of the motion too, by entries of the initial state and by parameters, named as in
    /// [`jacobian_by`](Linearized::jacobian_by). Events are added after this call.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
    /// struct Spring { m: f64, k: f64 }
    ///
    /// let spring = Spring { m: 1.0, k: 4.0 };
    /// let motion = spring.motion(State::at_rest([0.5])).derivatives(&["k"])?.to(3.0)?;
    /// // x = ½ cos(√k t)
    /// assert!((motion.end().coordinate("x")? - 0.5 * 6.0_f64.cos()).abs() < 1e-7);
    /// assert!((motion.derivative(3.0, "x", "k")? + 0.5 * 3.0 / 4.0 * 6.0_f64.sin()).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::UnknownName`] and [`Error::RepeatedName`]; the error of the start, if it is none.
    #[allow(clippy::type_complexity, reason = "the type of the builder itself, with its start")]
    pub fn derivatives(
        self,
        arguments: &[&str],
    ) -> Result<MotionBuilder<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, (), K>, Error> {
        const { check_contacts(L::HAS_CONTACTS) };
        let Self { system, start, method, events, on_progress, kept } = self;
        let start = system.sensitivity(&start.into_state()?, arguments)?;
        Ok(MotionBuilder { system, start, method, events, on_progress, kept })
    }
}

impl<'a, 'w, L, P, E> Integrates<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E> for AllSteps
where
    L: Linearized<Scalar: Real> + 'a,
    P: DifferentiableMethod<L>,
    E: EventList<DynDifferentiableEvent<'w, L>>,
{
    type Result = TrajectorySensitivity<'a, L>;

    fn run(
        motion: MotionBuilder<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E>,
        end: L::Scalar,
    ) -> Result<TrajectorySensitivity<'a, L>, Error> {
        let MotionBuilder { system, start, method, events, on_progress, .. } = motion;
        integrate(system, &start, end, &method, &mut events.list(), on_progress)
    }
}

impl<'a, L: Linearized<Scalar: Real>> Deref for TrajectorySensitivity<'a, L> {
    type Target = Trajectory<&'a L>;

    fn deref(&self) -> &Trajectory<&'a L> {
        &self.trajectory
    }
}

impl<L: Linearized<Scalar: Real>> HasEnding for TrajectorySensitivity<'_, L> {
    fn ending(&self) -> &Ending {
        self.trajectory.ending()
    }
}

/// Integrates a motion together with its derivatives.
pub(super) fn integrate<'a, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>>(
    system: &'a L,
    start: &StateSensitivity<L::Scalar, L::N>,
    end: L::Scalar,
    method: &D,
    events: &mut [Box<DynDifferentiableEvent<'_, L>>],
    on_progress: Option<OnProgress<'_>>,
) -> Result<TrajectorySensitivity<'a, L>, Error> {
    check_finite(system, &start.state)?;
    check_end(end)?;
    let mut begun = Run::<L, D>::begin(system, &start.state, method);
    let (run, adjustment) = begun.as_mut().map_err(|error| error.clone())?;
    let stored = Stored::<_, _, _, true>::begin(system, &run.state, end, events, on_progress)?;
    let Along { observer, driven, course, before, .. } = Along::drive(stored, system, run, start, method)?;
    let trajectory = observer.finish(driven, run.statistics, *adjustment);
    let (ending, crossings) = (trajectory.ending(), trajectory.crossings());
    let end = course.end(system, trajectory.end().state(), ending, crossings, events, &before);
    Ok(TrajectorySensitivity { trajectory, course, end })
}

/// An observer of a motion along which derivatives are carried.
pub(super) trait Keeper<L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>>:
    Observer<L, D>
{
    /// True if it needs the dense output of the last step.
    fn looks_into(&self, run: &Run<L, D>) -> bool;

    /// Takes the dense output of the last step, if there is one.
    fn take(&mut self, within: &mut Vec<D::Interpolant>);

    /// The samples so far; `None` if all steps are kept.
    fn samples(&self) -> Option<&[StateOf<L>]>;
}

impl<L, D, W> Keeper<L, D> for Stored<'_, '_, L, W, D::Interpolant, true>
where
    L: Linearized<Scalar: Real>,
    D: DifferentiableMethod<L>,
    W: AnyEvent<L>,
{
    fn looks_into(&self, _: &Run<L, D>) -> bool {
        true
    }

    fn take(&mut self, within: &mut Vec<D::Interpolant>) {
        self.interpolants().append(within);
    }

    fn samples(&self) -> Option<&[StateOf<L>]> {
        None
    }
}

/// Carries derivatives along a motion that another observer keeps.
pub(super) struct Along<'a, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>, O> {
    system: &'a L,
    pub(super) observer: O,
    pub(super) course: Course<L>,
    /// Memory of the method for the next step of the derivatives.
    memory: D::VariationMemory,
    /// State at the start of the last step.
    pub(super) before: StateOf<L>,
    /// Dense output of the last step.
    within: Vec<D::Interpolant>,
    /// Derivatives of the samples of the observer.
    pub(super) samples: Vec<StateSensitivity<L::Scalar, L::N>>,
    pub(super) driven: Result<(), Ending>,
}

impl<'a, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>, O: Keeper<L, D>> Along<'a, L, D, O> {
    /// Integrates to the end that the observer has.
    pub(super) fn drive(
        observer: O,
        system: &'a L,
        run: &mut Run<L, D>,
        start: &StateSensitivity<L::Scalar, L::N>,
        method: &D,
    ) -> Result<Self, Error> {
        let (course, memory) = Course::from(system, &run.state, start, method)?;
        let (before, within, samples, driven) = (run.state, Vec::new(), Vec::new(), Ok(()));
        let mut along = Self { system, observer, course, memory, before, within, samples, driven };
        along.sample()?;
        let limits = Watchdog::new(method.limits(), &run.statistics);
        along.driven = run.drive(method, &limits, &mut along);
        Ok(along)
    }

    /// Adds the derivatives of the samples that the observer has taken since the last call.
    fn sample(&mut self) -> Result<(), Error> {
        for state in &self.observer.samples().unwrap_or_default()[self.samples.len()..] {
            self.samples.push(self.course.at(self.system, state)?);
        }
        Ok(())
    }
}

impl<L, D, O> Observer<L, D> for Along<'_, L, D, O>
where
    L: Linearized<Scalar: Real>,
    D: DifferentiableMethod<L>,
    O: Keeper<L, D>,
{
    fn system(&self) -> &L {
        self.system
    }

    fn goal(&mut self, method: &D, run: &mut Run<L, D>) -> Result<Option<L::Scalar>, Ending> {
        let goal = self.observer.goal(method, run)?;
        if let Some(end) = goal {
            if self.observer.samples().is_some() {
                self.course.forget_steps();
            }
            let Self { system, course: Course { variations, .. }, memory, .. } = self;
            method.prepare(VariedRun { system, run, variations, memory }, end)?;
        }
        Ok(goal)
    }

    fn follow(&mut self, method: &D, run: &mut Run<L, D>) -> Result<(), Ending> {
        let Self {
            system, observer, course: Course { variations, coefficients, .. }, memory, within, ..
        } = self;
        method.follow(VariedRun { system, run, variations, memory })?;
        if observer.looks_into(run) {
            method.interpolate(VariedRun { system, run, variations, memory }, within, coefficients)?;
        }
        observer.take(within);
        Ok(())
    }

    fn keep(&mut self, method: &D, run: &mut Run<L, D>) -> Result<(), Ending> {
        self.before = run.before;
        self.course.push(run.before.t, run.state.t);
        let kept = self.observer.keep(method, run);
        self.sample().map_err(|error| Ending::of(error, run.state.t.to_f64()))?;
        kept
    }
}

impl<L: Linearized<Scalar: Real>> Course<L> {
    /// Derivatives at the start of a motion, and the method's memory for them.
    pub(super) fn from<D: DifferentiableMethod<L>>(
        system: &L,
        state: &StateOf<L>,
        start: &StateSensitivity<L::Scalar, L::N>,
        method: &D,
    ) -> Result<(Self, D::VariationMemory), Error> {
        let tangent = Tangent::at(system, state)?;
        // Convert to derivatives at fixed time: if the start is an event, subtract the change of its time.
        let column = |j| {
            let Direction { t, q, v } = start.direction(j);
            let back = |x: L::Scalar, rate| x - rate * t;
            [q.each_with(&state.v, back), v.each_with(&tangent.solution.accelerations, back)]
        };
        let variations = Variations::begin(&tangent, start.arguments().to_vec(), column)?;
        let memory = method.companion(system, state, &variations)?;
        let (steps, coefficients) = (Vec::new(), Vec::new());
        Ok((Self { variations, end: state.t, steps, coefficients, between: D::between }, memory))
    }

    /// Records a step that the variations have followed.
    pub(super) fn push(&mut self, start: L::Scalar, end: L::Scalar) {
        self.steps.push([start, end - start]);
        self.end = end;
    }

    /// Derivatives of a state of the motion.
    pub(super) fn at(
        &self,
        system: &L,
        state: &StateOf<L>,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        let blocks = &self.variations.blocks;
        let mut at = StateSensitivity::of(*state, self.variations.arguments().to_vec());
        let found = if state.t == self.end { None } else { self.step(state.t) };
        let tangent = if const { <L::M>::COUNT > 0 } { Some(Tangent::at(system, state)?) } else { None };
        let equations = tangent.as_ref().map(|tangent| self.variations.equations(tangent));
        for (k, block) in blocks.iter().enumerate() {
            let mut y = match found {
                None => block.y,
                Some((step, part)) => {
                    let each = self.coefficients.len() / (self.steps.len() * blocks.len());
                    let first = each * (step * blocks.len() + k);
                    (self.between)(&self.coefficients[first..first + each], WideOf::<L>::of(part))
                }
            };
            if let Some(equations) = &equations {
                y = equations.projected(block, y)?;
            }
            for lane in 0..block.lanes {
                let [q, v] = y.arrays().map(|half| half.map(|x| x.lane(lane)));
                at.set(block.first + lane, [&q, &v]);
            }
        }
        Ok(at)
    }

    /// Returns the derivatives at the end of the motion; at an event they include those of its time. `before` is an earlier state.
    pub(super) fn end(
        &self,
        system: &L,
        state: &StateOf<L>,
        ending: &Ending,
        crossings: &[Crossing<L::Scalar, L::N>],
        events: &[Box<DynDifferentiableEvent<'_, L>>],
        before: &StateOf<L>,
    ) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        if ending.is_failure() {
            return Err(ending.clone().into());
        }
        let at = self.at(system, state)?;
        let last = crossings.last().filter(|_| matches!(ending, Ending::Event { .. }));
        match last.and_then(|crossing| events.get(crossing.index)) {
            None => Ok(at),
            Some(event) => at_event(system, at, (event.called(), &|at: &_| event.change(system, at)), before),
        }
    }

    /// Discards the steps, and keeps the derivatives at the end of the last.
    pub(super) fn forget_steps(&mut self) {
        self.steps.clear();
        self.coefficients.clear();
    }

    /// Index of the step that contains this time, and the fraction of it that has passed.
    fn step(&self, t: L::Scalar) -> Option<(usize, L::Scalar)> {
        let is_past = |[start, length]: &[L::Scalar; 2]| (t - *start) / *length >= L::Scalar::constant(0.0);
        let step = self.steps.partition_point(is_past).checked_sub(1)?;
        let [start, length] = self.steps[step];
        Some((step, (t - start) / length))
    }
}

impl<L: Linearized<Scalar: Real>> Debug for TrajectorySensitivity<'_, L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut sensitivities = f.debug_struct("TrajectorySensitivity");
        sensitivities.field("trajectory", &self.trajectory).field("arguments", &self.arguments()).finish()
    }
}

impl<'a, L: Linearized<Scalar: Real>> TrajectorySensitivity<'a, L> {
    /// Returns the motion if it reached its end or a terminal event.
    ///
    /// # Errors
    /// [`Error::Unfinished`] with the ending.
    pub fn finished(self) -> Result<Self, Error> {
        self.trajectory.check_finished()?;
        Ok(self)
    }

    /// Takes the motion without its derivatives, for a leg of a [`HybridTrajectory`](crate::HybridTrajectory) for
    /// example.
    pub fn into_trajectory(self) -> Trajectory<&'a L> {
        self.trajectory
    }

    /// The arguments, in the order of the columns.
    pub fn arguments(&self) -> &[Entry] {
        self.course.variations.arguments()
    }

    /// The state at this time, with its derivatives.
    ///
    /// # Errors
    /// The errors of [`Trajectory::at`] and of [`Linearized::jacobian`].
    pub fn derivatives_at(&self, t: L::Scalar) -> Result<StateSensitivity<L::Scalar, L::N>, Error> {
        self.course.at(self.trajectory.system(), self.trajectory.at(t)?.state())
    }

    /// The last state with its derivatives. If an event ended the motion, they include the derivative of its time;
    /// otherwise they are those at the requested end.
    ///
    /// # Errors
    /// [`Error::Unfinished`] if the motion reached neither; [`Error::Grazing`], and [`Error::EventNotFinite`] if the
    /// function of the event has no derivative; the errors of [`derivatives_at`](Self::derivatives_at).
    pub fn derivatives_at_end(&self) -> Result<&StateSensitivity<L::Scalar, L::N>, Error> {
        self.end.as_ref().map_err(Error::clone)
    }

    /// Derivative of coordinate `coordinate` by `argument` at this time.
    ///
    /// # Errors
    /// The errors of [`derivatives_at`](Self::derivatives_at); [`Error::UnknownName`].
    pub fn derivative(&self, t: L::Scalar, coordinate: &str, argument: &str) -> Result<L::Scalar, Error> {
        let row = lookup::index::<L>(L::COORDINATES, "coordinate", coordinate)?;
        let names: Vec<String> = self.arguments().iter().map(Entry::to_string).collect();
        let column = lookup::index::<L>(&names, "argument of these derivatives", argument)?;
        Ok(self.derivatives_at(t)?.q[(row, column)])
    }
}
