//! A motion of an ensemble that has a SIMD lane, or waits for one.

use core::fmt::{self, Debug, Formatter};

use crate::error::Ending;
use crate::motion::Method;
use crate::motion::integration::record::Record;
use crate::motion::run::Watchdog;
use crate::statistics::Statistics;
use crate::system::Lagrangian;

/// A motion of an ensemble that has a lane, or waits for one.
pub struct LaneMotion<'o, L: Lagrangian<Scalar = f64>, P: Method<L>> {
    /// Index of the member in the ensemble.
    pub(crate) index: usize,
    /// Identifies the start and the parameters of the member.
    pub(crate) start: u32,
    pub(crate) statistics: Statistics,
    /// Samples, quantities and crossings recorded so far.
    pub(crate) record: Record<'o, L>,
    pub(crate) system: L,
    /// Method's memory, valid only while a step is taken outside the lanes.
    pub(crate) memory: P::Memory,
    /// Dense output of the last step, if it was taken outside the lanes and is sampled.
    pub(super) within: Option<P::Interpolant>,
    pub(super) end: f64,
    pub(super) limits: Watchdog,
    /// Ending, once no further step can be taken.
    pub(super) failure: Option<Ending>,
}

impl<L: Lagrangian<Scalar = f64>, P: Method<L>> Debug for LaneMotion<'_, L, P> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { index, statistics, end, .. } = self;
        let mut text = f.debug_struct("LaneMotion");
        text.field("index", index).field("statistics", statistics).field("end", end).finish_non_exhaustive()
    }
}

/// Result of a step in one lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneOutcome {
    /// Accepted: the lane moves to the end of the step.
    Accepted,
    /// Accepted, computed by the scalar method: the lane must be loaded with the result.
    AcceptedAlone,
    /// Rejected: the lane keeps its state.
    Rejected,
}
