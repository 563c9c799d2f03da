//! The loop from the first step to the ending, the same for every method.

#[cfg(feature = "alloc")]
use alloc::{boxed::Box, vec::Vec};
#[cfg(feature = "alloc")]
use core::ops::ControlFlow;

#[cfg(feature = "alloc")]
use super::event::{AnyEvent, EventSearch};
use super::method::{Limits, Method, Step};
use crate::error::{Ending, Error, Pace};
use crate::number::Real;
use crate::solution::Adjustment;
use crate::solution::consistent::{self, Consistent};
use crate::solution::solve::solve;
use crate::solution::vector_field::VectorField;
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State};
#[cfg(feature = "alloc")]
use crate::trajectory::{Path, Trajectory};

/// How far an integration has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The time of the start.
    pub start: f64,
    /// The time reached.
    pub time: f64,
    /// The time of the end.
    pub end: f64,
    /// Steps taken.
    pub steps: usize,
}

/// What looks at the progress, and may cancel.
#[cfg(feature = "alloc")]
pub(crate) type OnProgress<'a> = Box<dyn FnMut(Progress) -> ControlFlow<()> + 'a>;

/// A motion on its way: where it is, what its method carries and what it took so far.
#[derive(Debug)]
#[cfg_attr(not(feature = "alloc"), allow(unreachable_pub, reason = "what differentiates motions allocates"))]
pub struct Run<X, T, const N: usize> {
    pub(crate) memory: X,
    pub(crate) state: State<T, N>,
    /// Where the last step started.
    pub(crate) before: State<T, N>,
    pub(crate) statistics: Statistics,
}

impl<X, T: Real, const N: usize> Run<X, T, N> {
    /// Before the first step: settings and start checked, the start made consistent, which moves it by the adjustment.
    pub(crate) fn begin<L, F, P, const M: usize>(
        system: &L,
        state: &State<T, N>,
        method: &P,
    ) -> Result<(Self, Adjustment<T, N>), Error>
    where
        L: Lagrangian<N, M, Scalar = T>,
        F: VectorField<L, N, M>,
        P: Method<L, N, M, F, Memory = X>,
    {
        method.check()?;
        let started = check_start(system, state);
        let &(state, adjustment) = started.as_ref().map_err(Error::clone)?;
        let mut statistics = Statistics::default();
        let begun = method.begin(system, &state, &mut statistics);
        begun.map(|memory| (Self { memory, state, before: state, statistics }, adjustment))
    }

    /// One accepted step towards the end.
    #[inline]
    pub(crate) fn step<L, F, P, const M: usize>(
        &mut self,
        system: &L,
        method: &P,
        end: T,
        limits: &Watchdog,
    ) -> Result<(), Ending>
    where
        L: Lagrangian<N, M, Scalar = T>,
        F: VectorField<L, N, M>,
        P: Method<L, N, M, F, Memory = X>,
    {
        let now = self.state.t;
        loop {
            let pace = || method.pace(system, &self.memory, end);
            if let Some(ending) = limits.exceeded(&self.statistics, now.to_f64(), pace) {
                return Err(ending);
            }
            match method.step(system, &mut self.memory, end, &mut self.statistics) {
                Step::Accepted(next) if !is_towards(now, next.t, end) => {
                    let reason = "its step does not lead towards the end";
                    return Err(Ending::MethodFailed { time: now.to_f64(), reason });
                }
                Step::Accepted(next) => {
                    self.statistics.accepted += 1;
                    (self.before, self.state) = (self.state, next);
                    return Ok(());
                }
                Step::Rejected => self.statistics.rejected += 1,
                Step::Failed(ending) => return Err(ending),
            }
        }
    }

    /// One accepted step with what lies within.
    #[inline(always)]
    pub(crate) fn step_with_interpolant<L, F, P, const M: usize>(
        &mut self,
        system: &L,
        method: &P,
        end: T,
        limits: &Watchdog,
        within: &mut Within<P::Interpolant>,
    ) -> Result<(), Ending>
    where
        L: Lagrangian<N, M, Scalar = T>,
        F: VectorField<L, N, M>,
        P: Method<L, N, M, F, Memory = X>,
    {
        self.step_with::<L, F, P, _, M>(system, method, end, limits, |run| {
            run.look_within::<L, F, P, M>(system, method, within)
        })
    }

    /// Puts what lies within the last step there.
    #[inline(always)]
    pub(crate) fn look_within<L, F, P, const M: usize>(
        &mut self,
        system: &L,
        method: &P,
        within: &mut Within<P::Interpolant>,
    ) -> Result<(), Ending>
    where
        L: Lagrangian<N, M, Scalar = T>,
        F: VectorField<L, N, M>,
        P: Method<L, N, M, F, Memory = X>,
    {
        let Self { memory, statistics, before, .. } = self;
        let found = put_interpolant(system, method, memory, statistics, within);
        found.map_err(|error| Ending::of(error, before.t.to_f64()))
    }

    /// Takes one accepted step with its samples and events; a failure of these undoes the step and tries a shorter one.
    #[inline(always)]
    pub(crate) fn step_with<L, F, P, R, const M: usize>(
        &mut self,
        system: &L,
        method: &P,
        end: T,
        limits: &Watchdog,
        mut along: impl FnMut(&mut Self) -> Result<R, Ending>,
    ) -> Result<R, Ending>
    where
        L: Lagrangian<N, M, Scalar = T>,
        F: VectorField<L, N, M>,
        P: Method<L, N, M, F, Memory = X>,
    {
        loop {
            self.step(system, method, end, limits)?;
            let ending = match along(self) {
                Ok(result) => return Ok(result),
                Err(ending) => ending,
            };
            self.state = self.before;
            self.statistics.accepted -= 1;
            self.statistics.rejected += 1;
            if !method.undo(&mut self.memory) {
                return Err(ending);
            }
        }
    }
}

/// What lies within steps; without the feature `alloc` within one.
#[cfg(feature = "alloc")]
pub(crate) type Within<I> = Vec<I>;
#[cfg(not(feature = "alloc"))]
pub(crate) type Within<I> = Option<I>;

/// Forgets it, and keeps the room.
#[inline]
pub(super) fn clear<I>(within: &mut Within<I>) {
    #[cfg(feature = "alloc")]
    within.clear();
    #[cfg(not(feature = "alloc"))]
    {
        *within = None;
    }
}

/// Puts what lies within the step accepted last there, behind others or, without the feature `alloc`, in their place.
#[inline(always)]
pub(super) fn put_interpolant<L, F, P, const N: usize, const M: usize>(
    system: &L,
    method: &P,
    memory: &mut P::Memory,
    statistics: &mut Statistics,
    within: &mut Within<P::Interpolant>,
) -> Result<(), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: VectorField<L, N, M>,
    P: Method<L, N, M, F>,
{
    #[cfg(feature = "alloc")]
    return method.push_interpolant(system, memory, statistics, within);
    #[cfg(not(feature = "alloc"))]
    return method.interpolant(system, memory, statistics).map(|interpolant| *within = Some(interpolant));
}

/// What is integrated along with a motion, step by step: its derivatives, say.
#[cfg(feature = "alloc")]
pub(crate) trait Companion<L, F, P, const N: usize, const M: usize>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: VectorField<L, N, M>,
    P: Method<L, N, M, F>,
{
    /// Called before each step towards `end`.
    #[allow(unused_variables)]
    #[inline(always)]
    fn prepare(
        &mut self,
        system: &L,
        method: &P,
        run: &mut Run<P::Memory, L::Scalar, N>,
        end: L::Scalar,
    ) -> Result<(), Ending> {
        Ok(())
    }

    /// Called after each step of the motion: adds the interpolant of the step to `within`. An error undoes the step, and a shorter
    /// one is tried.
    fn follow(
        &mut self,
        system: &L,
        method: &P,
        run: &mut Run<P::Memory, L::Scalar, N>,
        within: &mut Vec<P::Interpolant>,
    ) -> Result<(), Ending>;

    /// Called once a step from one of these states to the other is final.
    #[allow(unused_variables)]
    #[inline(always)]
    fn keep(&mut self, from: &State<L::Scalar, N>, to: &State<L::Scalar, N>) {}
}

/// The motion alone: its interpolants are those of the method.
#[cfg(feature = "alloc")]
pub(crate) struct NoCompanion;

#[cfg(feature = "alloc")]
impl<L, F, P, const N: usize, const M: usize> Companion<L, F, P, N, M> for NoCompanion
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: VectorField<L, N, M>,
    P: Method<L, N, M, F>,
{
    #[inline(always)]
    fn follow(
        &mut self,
        system: &L,
        method: &P,
        run: &mut Run<P::Memory, L::Scalar, N>,
        within: &mut Vec<P::Interpolant>,
    ) -> Result<(), Ending> {
        run.look_within::<L, F, P, M>(system, method, within)
    }
}

/// Integrates a motion and its companion, which `companion` makes at the consistent start; called by
/// [`MotionBuilder`](super::MotionBuilder). Where there are no events, `HAS_EVENTS` is false, and their search is not compiled.
#[cfg(feature = "alloc")]
pub(crate) fn drive<'a, L, F, P, W, C, const N: usize, const M: usize, const HAS_EVENTS: bool>(
    system: &'a L,
    state: &State<L::Scalar, N>,
    end: L::Scalar,
    method: &P,
    events: &mut [W],
    mut on_progress: Option<OnProgress<'_>>,
    companion: impl FnOnce(&State<L::Scalar, N>) -> Result<C, Error>,
) -> Result<(Trajectory<&'a L, N, M, F>, C), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: VectorField<L, N, M>,
    P: Method<L, N, M, F>,
    W: AnyEvent<L, N, M>,
    C: Companion<L, F, P, N, M>,
{
    check_end(end)?;
    // Not moved to where it is used: unless that is optimized away, there would be several of it.
    let mut begun = Run::begin(system, state, method);
    let (run, adjustment) = begun.as_mut().map_err(|error| error.clone())?;
    let start = run.state.t.to_f64();
    let mut companion = companion(&run.state)?;
    let mut path = Path::from(run.state);
    let mut search = EventSearch::begin(events, system, &run.state)?;
    let limits = Watchdog::new(method.limits(), &run.statistics);
    let mut stopped = search.record_due(&run.state, &mut path.crossings);
    let ending = loop {
        let time = run.state.t.to_f64();
        if let Some(ending) = stopped {
            break ending;
        }
        if run.state.t == end {
            break Ending::Complete { time };
        }
        if let Err(ending) = companion.prepare(system, method, run, end) {
            break ending;
        }
        let within = path.interpolants();
        let along = |run: &mut Run<_, _, N>| companion.follow(system, method, run, within);
        if let Err(ending) = run.step_with::<L, F, P, _, M>(system, method, end, &limits, along) {
            break ending;
        }
        companion.keep(&run.before, &run.state);
        path.push(run.state);
        if const { HAS_EVENTS } {
            stopped = search.record_in::<F, _>(&mut path, system, [&run.before, &run.state]);
        }
        let (time, steps) = (run.state.t.to_f64(), run.statistics.accepted);
        let progress = Progress { start, time, end: end.to_f64(), steps };
        if stopped.is_none()
            && let Some(look) = &mut on_progress
            && look(progress).is_break()
        {
            break Ending::Cancelled { time };
        }
    };
    Ok((Trajectory::new(system, path.finish(), ending, run.statistics, *adjustment), companion))
}

/// Tells the method of a system that has been changed, or of another state.
#[inline]
pub(super) fn resume<L, F, P, const N: usize, const M: usize>(
    system: &L,
    method: &P,
    memory: &mut P::Memory,
    state: &State<L::Scalar, N>,
    statistics: &mut Statistics,
) -> Result<(), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: VectorField<L, N, M>,
    P: Method<L, N, M, F>,
{
    if M > 0 {
        consistent::check(system, state)?;
    }
    method.resume(system, memory, state, statistics)
}

/// Whether `t` lies between the other two, which may be in any order.
pub(super) fn is_between<T: Real>(a: T, t: T, b: T) -> bool {
    a <= t && t <= b || b <= t && t <= a
}

/// Whether a step from `now` to `next` leads towards the end, and not past it.
fn is_towards<T: Real>(now: T, next: T, end: T) -> bool {
    next > now && next <= end || next < now && next >= end
}

/// The start made consistent to round-off, where that is all it lacks.
fn check_start<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<Consistent<L::Scalar, N>, Error> {
    solve(system, state)?;
    consistent::check(system, state)?;
    consistent::project_to_round_off(system, state)
}

/// An end that can be reached.
pub(crate) fn check_end<T: Real>(end: T) -> Result<(), Error> {
    if end.is_finite() { Ok(()) } else { Err(Error::EndNotFinite { end: end.to_f64() }) }
}

/// Watches over the limits, from where it is made.
pub(crate) struct Watchdog {
    limits: Limits,
    /// Steps tried before.
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
