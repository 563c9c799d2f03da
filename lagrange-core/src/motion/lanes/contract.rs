//! The trait [`LaneMethod`]: interface of the methods on SIMD lanes.

use super::motion::{LaneMotion, LaneOutcome};
use crate::error::Error;
use crate::motion::{Interpolant, Method};
use crate::number::Lanes;
use crate::solution::vector_field::LagrangianVectorField;
use crate::statistics::Statistics;
use crate::system::{Lagrangian, StateOf};
use crate::vector::{Array, PhaseVector, StaticLength};

/// A method that integrates several members of an ensemble at once: [`Dop853`](crate::Dop853),
/// [`Dopri5`](crate::Dopri5) and every other [`Pair`](crate::motion::Pair), and [`Taylor`](crate::Taylor) if the system
/// has a Taylor series.
///
/// [`Ensemble::integrate_on_lanes`](crate::Ensemble::integrate_on_lanes) uses it. Its items are internal to this crate.
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not integrate `{L}` on SIMD lanes",
    note = "`Dop853` and `Dopri5` do, and `Taylor` where the equations of motion have a Taylor series",
    note = "`Ensemble::integrate` takes every method, and integrates one member at a time"
)]
pub trait LaneMethod<L: Lagrangian<Scalar = f64>>: Method<L, LagrangianVectorField> + Sized {
    /// Systems and states of all lanes, with the working arrays of a step.
    #[doc(hidden)]
    type LaneMemory;

    /// Current time of a motion.
    #[doc(hidden)]
    fn now(memory: &Self::Memory) -> f64;

    /// Current state of a motion.
    #[doc(hidden)]
    fn state(memory: &Self::Memory) -> StateOf<L>;

    /// True if a motion has reached its end.
    #[doc(hidden)]
    fn is_at_end(memory: &Self::Memory) -> bool;

    /// Computes what a step towards the end needs at its start, such as the rates, unless it is known.
    #[doc(hidden)]
    fn prepare(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: f64,
        statistics: &mut Statistics,
    ) -> Result<(), Error>;

    /// Creates the lanes with this motion in all of them. Free lanes repeat the first one, which is harmless.
    #[doc(hidden)]
    fn lane_memory(&self, system: &L, memory: &Self::Memory) -> Self::LaneMemory;

    /// Copies the parameters into a lane. Returns false, without a change, if a field that all lanes share differs.
    #[doc(hidden)]
    fn place(lane_memory: &mut Self::LaneMemory, lane: usize, system: &L) -> bool;

    /// Copies the current state of a motion into a lane.
    #[doc(hidden)]
    fn load(lane_memory: &mut Self::LaneMemory, lane: usize, memory: &Self::Memory);

    /// Copies the data of a lane back into the memory of its motion.
    #[doc(hidden)]
    fn unload(lane_memory: &Self::LaneMemory, lane: usize, memory: &mut Self::Memory);

    /// Current coordinates and velocities of a lane.
    #[doc(hidden)]
    fn phase(lane_memory: &Self::LaneMemory, lane: usize) -> PhaseVector<f64, L::N>;

    /// End of the last step tried in a lane. After the step is accepted, [`phase`](Self::phase) returns the
    /// same numbers, but its loads wait for recent stores.
    #[doc(hidden)]
    fn reached(lane_memory: &Self::LaneMemory, lane: usize) -> PhaseVector<f64, L::N>;

    /// Tries a step in all lanes, and advances the clocks of those that accept it. `None` for a lane whose step must be
    /// taken by the scalar method. If `HAS_DENSE_OUTPUT` is false, no dense output is available.
    #[doc(hidden)]
    fn attempt<const HAS_DENSE_OUTPUT: bool>(
        &self,
        lane_memory: &mut Self::LaneMemory,
        motions: &mut LaneMotions<'_, L, Self>,
    ) -> [Option<LaneOutcome>; Lanes::COUNT];

    /// Moves the chosen lanes to the ends of their steps.
    #[doc(hidden)]
    fn commit(lane_memory: &mut Self::LaneMemory, chosen: Lanes);

    /// Dense output of the last step tried in a lane.
    #[doc(hidden)]
    fn within(lane_memory: &Self::LaneMemory, lane: usize) -> impl Interpolant<f64, L::N>;
}

/// Motion of each lane, or `None` for a free lane.
pub(crate) type LaneMotions<'o, L, P> = [Option<LaneMotion<'o, L, P>>; Lanes::COUNT];

/// Extracts the numbers of one lane.
#[inline(always)]
pub(crate) fn unpacked<N: StaticLength>(packed: &Array<Lanes, N>, lane: usize) -> Array<f64, N> {
    // Not by `map`: the compiler does not inline it, and the caller would wait for its result.
    let mut numbers = Array::filled(0.0);
    for (x, packed) in numbers.iter_mut().zip(packed) {
        *x = packed.to_array()[lane];
    }
    numbers
}

/// Extracts the phase of one lane.
#[inline(always)]
pub(crate) fn unpacked_phase<N: StaticLength>(
    packed: &PhaseVector<Lanes, N>,
    lane: usize,
) -> PhaseVector<f64, N> {
    let mut phase = PhaseVector::filled(0.0);
    for (x, packed) in phase.flat_mut().iter_mut().zip(packed.flat()) {
        *x = packed.to_array()[lane];
    }
    phase
}
