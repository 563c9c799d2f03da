//! Integration loop from the first step to the ending, shared by every method and every observer.

use super::method::{Limits, Method, Step};
use crate::error::{Ending, Error, Pace};
use crate::number::Real;
use crate::room::Within;
use crate::solution::Adjustment;
use crate::solution::interpolant::Interpolant;
use crate::solution::system_checks::SystemChecks;
use crate::solution::vector_field::VectorField;
use crate::statistics::Statistics;
use crate::system::{StateOf, System};
use crate::vector::Length;

/// A motion during its integration: state, working memory of the method, and statistics.
pub(crate) struct Run<L, P, F = <L as System>::Field>
where
    L: System<Scalar: Real>,
    P: Method<L, F>,
    F: VectorField<L>,
{
    pub(crate) memory: P::Memory,
    pub(crate) state: StateOf<L>,
    /// State at the start of the last step.
    pub(crate) before: StateOf<L>,
    pub(crate) statistics: Statistics,
}

impl<L, P, F> Run<L, P, F>
where
    L: System<Scalar: Real>,
    P: Method<L, F>,
    F: VectorField<L>,
{
    /// Checks settings and start, makes the start consistent, and prepares the first step. The adjustment is the change
    /// of the start.
    pub(crate) fn begin(
        system: &L,
        state: &StateOf<L>,
        method: &P,
    ) -> Result<(Self, Adjustment<L::Scalar, L::Length>), Error> {
        method.check()?;
        F::Checks::check_solution(system, state)?;
        F::Checks::check_constraints(system, state)?;
        let started = F::Checks::adjust(system, state);
        let (state, adjustment) = started.as_ref().map_err(Error::clone)?;
        let mut statistics = Statistics::default();
        let begun = method.begin(system, state, &mut statistics);
        let run = |memory| Self { memory, state: state.clone(), before: state.clone(), statistics };
        begun.map(|memory| (run(memory), adjustment.clone()))
    }

    /// Takes one accepted step towards `end`.
    #[inline]
    pub(crate) fn step(
        &mut self,
        system: &L,
        method: &P,
        end: L::Scalar,
        limits: &Watchdog,
    ) -> Result<(), Ending> {
        let now = self.state.t;
        loop {
            let pace = || method.pace(system, &self.memory, end);
            if let Some(ending) = limits.exceeded(&self.statistics, now.to_f64(), pace) {
                return Err(ending);
            }
            self.before.clone_from(&self.state);
            let Self { memory, state, before, statistics } = self;
            match method.step(system, memory, end, before, state, statistics) {
                Step::Accepted if is_towards(now, state.t, end) => {
                    statistics.accepted += 1;
                    return Ok(());
                }
                Step::Accepted => {
                    state.clone_from(before);
                    let reason = "its step does not lead towards the end";
                    return Err(Ending::MethodFailed { time: now.to_f64(), reason });
                }
                Step::Rejected => {
                    state.clone_from(before);
                    statistics.rejected += 1;
                }
                Step::Failed(ending) => {
                    state.clone_from(before);
                    return Err(ending);
                }
            }
        }
    }

    /// Appends the dense output of the last step to `within`.
    #[inline(always)]
    pub(crate) fn look_within(
        &mut self,
        system: &L,
        method: &P,
        within: &mut Within<P::Interpolant>,
    ) -> Result<(), Ending> {
        let Self { memory, state, before, statistics } = self;
        let found = method.push_interpolant(system, memory, [before, state], statistics, within);
        found.map_err(|error| Ending::of(error, before.t.to_f64()))
    }

    /// Integrates until the observer has no further goal. The error says why the motion ends before.
    #[inline(always)]
    pub(crate) fn drive<O: Observer<L, P, F>>(
        &mut self,
        method: &P,
        limits: &Watchdog,
        observer: &mut O,
    ) -> Result<(), Ending> {
        while let Some(goal) = observer.goal(method, self)? {
            self.step_with(method, goal, limits, observer)?;
            observer.keep(method, self)?;
        }
        Ok(())
    }

    /// Takes one accepted step. If the observer cannot follow it, undoes the step and tries a shorter one.
    // A function of its own: in an unoptimized build, the stack space of `follow` is free again before events
    // are searched.
    #[inline]
    fn step_with<O: Observer<L, P, F>>(
        &mut self,
        method: &P,
        end: L::Scalar,
        limits: &Watchdog,
        observer: &mut O,
    ) -> Result<(), Ending> {
        loop {
            self.step(observer.system(), method, end, limits)?;
            let Err(ending) = observer.follow(method, self) else { return Ok(()) };
            self.state.clone_from(&self.before);
            self.statistics.accepted -= 1;
            self.statistics.rejected += 1;
            if !method.undo(&mut self.memory) {
                return Err(ending);
            }
        }
    }
}

/// An observer of a motion: sets its goal, evaluates the dense output of its steps, records them, and may end the
/// motion.
pub(crate) trait Observer<L, P, F = <L as System>::Field>
where
    L: System<Scalar: Real>,
    P: Method<L, F>,
    F: VectorField<L>,
{
    /// The system in motion.
    fn system(&self) -> &L;

    /// Called before each step. Returns the time to integrate towards, different from the current time, or `None` to
    /// stop here.
    ///
    /// # Errors
    /// The reason why the motion cannot continue.
    fn goal(&mut self, method: &P, run: &mut Run<L, P, F>) -> Result<Option<L::Scalar>, Ending>;

    /// Called after each step.
    ///
    /// # Errors
    /// The reason to undo the step and to try a shorter one. It becomes the ending if no shorter step exists.
    #[allow(unused_variables)]
    #[inline(always)]
    fn follow(&mut self, method: &P, run: &mut Run<L, P, F>) -> Result<(), Ending> {
        Ok(())
    }

    /// Called once a step is final. It may move the state back to a state within the step, to end the motion there.
    ///
    /// # Errors
    /// The reason why the motion ends there.
    #[allow(unused_variables)]
    #[inline(always)]
    fn keep(&mut self, method: &P, run: &mut Run<L, P, F>) -> Result<(), Ending> {
        Ok(())
    }
}

/// Resumes the method after a change of the system or of the state.
#[inline]
pub(super) fn resume<L, F, P>(
    system: &L,
    method: &P,
    memory: &mut P::Memory,
    state: &StateOf<L>,
    statistics: &mut Statistics,
) -> Result<(), Error>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    P: Method<L, F>,
{
    if <L::Length as Length>::CONSTANT.is_none() {
        F::Checks::check_entries(system, state)?;
    }
    if F::HAS_CONSTRAINTS && <P::Interpolant as Interpolant<_, _>>::IS_PROJECTED {
        F::Checks::check_constraints(system, state)?;
    }
    method.resume(system, memory, state, statistics)
}

/// True if `t` lies between `a` and `b`, in either order.
pub(super) fn is_between<T: Real>(a: T, t: T, b: T) -> bool {
    a <= t && t <= b || b <= t && t <= a
}

/// True if a step from `now` to `next` leads towards `end`, and not past it.
fn is_towards<T: Real>(now: T, next: T, end: T) -> bool {
    next > now && next <= end || next < now && next >= end
}

/// Checks that the end is finite.
pub(crate) fn check_end<T: Real>(end: T) -> Result<(), Error> {
    if end.is_finite() { Ok(()) } else { Err(Error::EndNotFinite { end: end.to_f64() }) }
}

/// Watches the limits on steps and wall-clock time, counted from its creation.
pub(crate) struct Watchdog {
    limits: Limits,
    /// Number of steps tried before this watchdog was created; they do not count towards the limit.
    before: usize,
    #[cfg(feature = "std")]
    started: Option<std::time::Instant>,
}

impl Watchdog {
    #[inline]
    pub(crate) fn new(limits: Limits, statistics: &Statistics) -> Self {
        Self {
            limits,
            before: statistics.accepted + statistics.rejected,
            #[cfg(feature = "std")]
            started: limits.wall_time.map(|_| std::time::Instant::now()),
        }
    }

    pub(super) fn exceeded(
        &self,
        statistics: &Statistics,
        time: f64,
        pace: impl FnOnce() -> Pace,
    ) -> Option<Ending> {
        let steps = statistics.accepted + statistics.rejected - self.before;
        if steps >= self.limits.max_steps {
            return Some(Ending::StepLimit { time, steps, pace: pace() });
        }
        #[cfg(feature = "std")]
        if let Some((limit, started)) = self.limits.wall_time.zip(self.started)
            && started.elapsed() >= limit
        {
            return Some(Ending::WallTimeLimit { time });
        }
        None
    }
}
