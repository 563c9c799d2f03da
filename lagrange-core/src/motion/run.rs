//! The loop from the first step to the ending, the same for every method.

use core::ops::ControlFlow;

use super::method::{Limits, Method, Step};
use crate::error::Error;
use crate::number::Real;
use crate::solution::consistent::{self, Consistent};
use crate::solution::flow::{Flow, Phase};
use crate::solution::solve::solve;
use crate::system::{Lagrangian, State};
use crate::trajectory::{Ending, Path, Statistics, Trajectory};

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

/// See [`Simulate::integrate_with`](crate::Simulate::integrate_with).
pub(crate) fn drive<'a, L, F, P, const N: usize, const M: usize>(
    system: &'a L,
    state: State<L::Scalar, N>,
    end: L::Scalar,
    method: &P,
    mut watch: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Trajectory<'a, L, N, M, F>, Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
    P: Method<L, N, M, F>,
{
    let mut statistics = Statistics::default();
    let ((start, adjustment), mut memory) = begin(system, &state, end, method, &mut statistics)?;
    let mut path = Path::from(start);
    let ending =
        run(system, start, end, method, &mut memory, &mut statistics, |state, interpolant, steps| {
            path.push(state, interpolant);
            watch(Progress { start: start.t.to_f64(), time: state.t.to_f64(), end: end.to_f64(), steps })
        });
    Ok(Trajectory::new(system, path, ending, statistics, adjustment))
}

/// Settings and start checked, the start made consistent, and what the method prepares there.
pub(crate) fn begin<L, F, P, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    end: L::Scalar,
    method: &P,
    statistics: &mut Statistics,
) -> Result<(Consistent<L::Scalar, N>, P::Memory), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
    P: Method<L, N, M, F>,
{
    method.check()?;
    let consistent = check_start(system, state, end)?;
    let memory = method.begin(system, &consistent.0, end, statistics)?;
    Ok((consistent, memory))
}

/// Steps from the start to the ending; `accept` is told each new state with its interpolant and how many there are.
pub(crate) fn run<L, F, P, const N: usize, const M: usize>(
    system: &L,
    mut state: State<L::Scalar, N>,
    end: L::Scalar,
    method: &P,
    memory: &mut P::Memory,
    statistics: &mut Statistics,
    mut accept: impl FnMut(State<L::Scalar, N>, &[Phase<L::Scalar, N>], usize) -> ControlFlow<()>,
) -> Ending
where
    L: Lagrangian<N, M, Scalar: Real>,
    F: Flow<L, N, M>,
    P: Method<L, N, M, F>,
{
    let limits = Watchdog::new(method.limits());
    loop {
        let time = state.t.to_f64();
        if state.t >= end {
            return Ending::Complete { time };
        }
        if let Some(ending) = limits.exceeded(statistics, time) {
            return ending;
        }
        match method.step(system, memory, statistics) {
            Step::Accepted { state: next, interpolant } => {
                statistics.accepted += 1;
                state = next;
                if accept(state, interpolant, statistics.accepted).is_break() {
                    return Ending::Cancelled { time: state.t.to_f64() };
                }
            }
            Step::Rejected => statistics.rejected += 1,
            Step::Failed(ending) => return ending,
        }
    }
}

/// The start made consistent to round-off, where that is all it lacks.
fn check_start<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    end: L::Scalar,
) -> Result<Consistent<L::Scalar, N>, Error> {
    check_end(end)?;
    if end < state.t {
        return Err(Error::EndTime { start: state.t.to_f64(), end: end.to_f64() });
    }
    solve(system, state)?;
    consistent::check(system, state)?;
    consistent::make_consistent(system, state, &[[false; N]; 2])
}

/// An end that can be reached.
pub(crate) fn check_end<T: Real>(end: T) -> Result<(), Error> {
    if end.is_finite() { Ok(()) } else { Err(Error::EndNotFinite { end: end.to_f64() }) }
}

pub(super) struct Watchdog {
    limits: Limits,
    #[cfg(feature = "std")]
    started: std::time::Instant,
}

impl Watchdog {
    pub(super) fn new(limits: Limits) -> Self {
        Self {
            limits,
            #[cfg(feature = "std")]
            started: std::time::Instant::now(),
        }
    }

    #[cfg(feature = "std")]
    pub(super) fn restart(&mut self) {
        self.started = std::time::Instant::now();
    }

    pub(super) fn exceeded(&self, statistics: &Statistics, time: f64) -> Option<Ending> {
        let steps = statistics.accepted + statistics.rejected;
        if steps >= self.limits.max_steps {
            return Some(Ending::StepLimit { time, steps });
        }
        #[cfg(feature = "std")]
        if self.limits.wall_time.is_some_and(|limit| self.started.elapsed() >= limit) {
            return Some(Ending::WallTimeLimit { time });
        }
        None
    }
}
