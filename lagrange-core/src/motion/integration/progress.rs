//! Progress of a motion, and its report to the closure of [`on_progress`](crate::MotionBuilder::on_progress).

use alloc::boxed::Box;
use core::ops::ControlFlow;

use crate::error::Ending;
use crate::number::Real;

/// Progress of an integration, for a progress callback.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Time at the start.
    pub start: f64,
    /// Current time.
    pub time: f64,
    /// Time at the end.
    pub end: f64,
    /// Number of accepted steps.
    pub steps: usize,
}

/// Progress callback, which may cancel the motion.
pub(crate) type OnProgress<'a> = Box<dyn FnMut(Progress) -> ControlFlow<()> + 'a>;

/// Calls the progress callback, if there is one, with the times of start, present and end. Fails if it cancels the motion.
#[inline(always)]
pub(crate) fn report<T: Real>(
    on_progress: &mut Option<OnProgress<'_>>,
    times: [T; 3],
    steps: usize,
) -> Result<(), Ending> {
    let Some(look) = on_progress else { return Ok(()) };
    let [start, time, end] = times.map(Real::to_f64);
    unless_broken(look(Progress { start, time, end, steps }), time)
}

/// Turns a break at this time into [`Ending::Cancelled`].
#[inline(always)]
pub(crate) fn unless_broken(flow: ControlFlow<()>, time: f64) -> Result<(), Ending> {
    match flow {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(Ending::Cancelled { time }),
    }
}
