//! A motion that has a SIMD lane, or waits for one.

use core::fmt::{self, Debug, Formatter};

use crate::error::Ending;
use crate::motion::Method;
use crate::motion::record::Record;
use crate::motion::run::Watchdog;
use crate::statistics::Statistics;
use crate::system::Lagrangian;

/// A motion that has a lane, or waits for one.
pub struct LaneMotion<'o, L, P, const N: usize, const M: usize>
where
    L: Lagrangian<N, M, Scalar = f64>,
    P: Method<L, N, M>,
{
    /// Which member of the ensemble it is.
    pub(crate) index: usize,
    /// What tells its start and parameters from others.
    pub(crate) start: u32,
    pub(crate) statistics: Statistics,
    /// What is kept of it on the way.
    pub(crate) record: Record<'o, L, N, M>,
    pub(crate) system: L,
    /// Method's memory, valid only while a step is taken outside the lanes.
    pub(crate) memory: P::Memory,
    /// Dense output of the last step, if it was taken outside the lanes and is sampled.
    pub(super) within: Option<P::Interpolant>,
    pub(super) end: f64,
    pub(super) limits: Watchdog,
    /// Why no step will do.
    pub(super) failure: Option<Ending>,
}

impl<L, P, const N: usize, const M: usize> Debug for LaneMotion<'_, L, P, N, M>
where
    L: Lagrangian<N, M, Scalar = f64>,
    P: Method<L, N, M>,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { index, statistics, end, .. } = self;
        let mut text = f.debug_struct("LaneMotion");
        text.field("index", index).field("statistics", statistics).field("end", end).finish_non_exhaustive()
    }
}

/// What became of a step in one lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneOutcome {
    /// The lane is to be moved to where it leads.
    Accepted,
    /// Taken alone: the lane is to be loaded with the result.
    AcceptedAlone,
    /// The lane stays where it is.
    Rejected,
}
