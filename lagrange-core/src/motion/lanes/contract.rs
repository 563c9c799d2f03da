//! What is asked of a method on lanes.

use super::motion::{LaneMotion, LaneOutcome};
use crate::error::Error;
use crate::motion::{Interpolant, Method};
use crate::number::Lanes;
use crate::solution::vector_field::PhaseVector;
use crate::statistics::Statistics;
use crate::system::Lagrangian;

/// A method that integrates several members of an ensemble at once: [`Dop853`](crate::Dop853), [`Dopri5`](crate::Dopri5) and every
/// other [`Pair`](crate::motion::Pair), and [`Taylor`](crate::Taylor) where the system has a Taylor series.
///
/// [`Ensemble::integrate_on_lanes`](crate::Ensemble::integrate_on_lanes) takes it. What it consists of belongs to this crate.
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not integrate `{L}` on SIMD lanes",
    note = "`Dop853` and `Dopri5` do, and `Taylor` where the equations of motion have a Taylor series",
    note = "`Ensemble::integrate` takes every method, and integrates one member at a time"
)]
pub trait LaneMethod<L, const N: usize, const M: usize>: Method<L, N, M> + Sized
where
    L: Lagrangian<N, M, Scalar = f64>,
{
    /// Systems with their states, and what a step of them takes.
    #[doc(hidden)]
    type LaneMemory;

    /// The time that a motion has reached.
    #[doc(hidden)]
    fn now(memory: &Self::Memory) -> f64;

    /// Whether a motion has no way left.
    #[doc(hidden)]
    fn is_at_end(memory: &Self::Memory) -> bool;

    /// Finds out what a step towards the end starts with, unless that is known.
    #[doc(hidden)]
    fn prepare(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: f64,
        statistics: &mut Statistics,
    ) -> Result<(), Error>;

    /// This motion in all lanes. Free ones compute what the first does, to no purpose and no harm.
    #[doc(hidden)]
    fn lane_memory(&self, system: &L, memory: &Self::Memory) -> Self::LaneMemory;

    /// Puts the parameters into a lane; `false`, and nothing done, where a field that all lanes share differs.
    #[doc(hidden)]
    fn place(lane_memory: &mut Self::LaneMemory, lane: usize, system: &L) -> bool;

    /// Puts where a motion is into a lane.
    #[doc(hidden)]
    fn load(lane_memory: &mut Self::LaneMemory, lane: usize, memory: &Self::Memory);

    /// Gives the motion what its lane holds.
    #[doc(hidden)]
    fn unload(lane_memory: &Self::LaneMemory, lane: usize, memory: &mut Self::Memory);

    /// Coordinates and velocities in a lane.
    #[doc(hidden)]
    fn phase(lane_memory: &Self::LaneMemory, lane: usize) -> PhaseVector<f64, N>;

    /// Where the step tried last leads in a lane. After it is taken this is the same, and need not wait for the numbers to be
    /// written there.
    #[doc(hidden)]
    fn reached(lane_memory: &Self::LaneMemory, lane: usize) -> PhaseVector<f64, N>;

    /// Tries a step in all lanes and moves the clocks of those where it is accepted; `None` for one that is to be taken alone.
    /// Of no step is it known where it leads within, where `HAS_DENSE_OUTPUT` is false.
    #[doc(hidden)]
    fn attempt<const HAS_DENSE_OUTPUT: bool>(
        &self,
        lane_memory: &mut Self::LaneMemory,
        motions: &mut LaneMotions<'_, L, Self, N, M>,
    ) -> [Option<LaneOutcome>; Lanes::COUNT];

    /// Moves the lanes chosen to where their steps lead.
    #[doc(hidden)]
    fn commit(lane_memory: &mut Self::LaneMemory, chosen: Lanes);

    /// What lies within the step of a lane that was tried last.
    #[doc(hidden)]
    fn within(lane_memory: &Self::LaneMemory, lane: usize) -> impl Interpolant<f64, N>;
}

/// Who is in which lane.
pub(crate) type LaneMotions<'o, L, P, const N: usize, const M: usize> =
    [Option<LaneMotion<'o, L, P, N, M>>; Lanes::COUNT];

/// What lies in one lane.
#[inline(always)]
pub(crate) fn unpacked<const R: usize, const N: usize>(
    packed: &[[Lanes; N]; R],
    lane: usize,
) -> [[f64; N]; R] {
    // Not by `map`, which the compiler leaves a function of its own, whose result is waited for.
    let mut phase = [[0.0; N]; R];
    for (half, packed) in phase.iter_mut().zip(packed) {
        for (x, packed) in half.iter_mut().zip(packed) {
            *x = packed.to_array()[lane];
        }
    }
    phase
}
