//! Motions with derivatives that keep samples instead of steps.

use alloc::{boxed::Box, vec::Vec};
use core::fmt::{self, Debug, Formatter};
use core::ops::Deref;

use super::state::StateSensitivity;
use super::trajectory::{Along, DynDifferentiableEvent, Keeper};
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::variation::DifferentiableMethod;
use crate::motion::integration::builder::EventList;
use crate::motion::integration::progress::{OnProgress, report};
use crate::motion::integration::record::{Moving, Record, RecordPlan, Recorded};
use crate::motion::run::{Run, check_end};
use crate::motion::{DynEvent, HasEnding, Integrates, MotionBuilder, SamplesAlone};
use crate::names::Entry;
use crate::number::Real;
use crate::solution::Sample;
use crate::system::StateOf;
use crate::system::finite::check_finite;
use crate::trajectory::{SampledTrajectory, Samples};

/// A [motion of which samples alone are kept](crate::trajectory::SampledTrajectory), with its derivatives by entries of the initial state
/// and by parameters. It is read like the motion alone.
///
/// ```
/// # use lagrange_core::prelude::*;
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(x_dot^2/2 - k/2 * x^2)]
/// struct Spring { k: f64 }
///
/// let spring = Spring { k: 1.0 };
/// let motion = spring.motion(State::at_rest([1.0])).derivatives(&["x"])?.every(0.5).to(10.0)?;
/// for sample in motion.derivatives() {
///     // x = x₀ cos t
///     assert!((sample.q[(0, 0)] - sample.state.t.cos()).abs() < 1e-7);
/// }
/// # Ok::<(), Error>(())
/// ```
pub struct SampledSensitivity<'a, L: Linearized<Scalar: Real>> {
    trajectory: SampledTrajectory<&'a L>,
    arguments: Vec<Entry>,
    samples: Vec<StateSensitivity<L::Scalar, L::N>>,
    end: Result<StateSensitivity<L::Scalar, L::N>, Error>,
}

impl<'a, L: Linearized<Scalar: Real>> Deref for SampledSensitivity<'a, L> {
    type Target = SampledTrajectory<&'a L>;

    fn deref(&self) -> &SampledTrajectory<&'a L> {
        &self.trajectory
    }
}

impl<L: Linearized<Scalar: Real>> SampledSensitivity<'_, L> {
    /// The arguments, in the order of the columns.
    pub fn arguments(&self) -> &[Entry] {
        &self.arguments
    }

    /// The samples with their derivatives at fixed time.
    pub fn derivatives(&self) -> &[StateSensitivity<L::Scalar, L::N>] {
        &self.samples
    }

    /// The last state with its derivatives, like
    /// [`TrajectorySensitivity`](crate::linearized::TrajectorySensitivity::derivatives_at_end).
    ///
    /// # Errors
    /// Those of `TrajectorySensitivity::derivatives_at_end`.
    pub fn derivatives_at_end(&self) -> Result<&StateSensitivity<L::Scalar, L::N>, Error> {
        self.end.as_ref().map_err(Error::clone)
    }
}

impl<L: Linearized<Scalar: Real>> Debug for SampledSensitivity<'_, L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("SampledSensitivity");
        text.field("trajectory", &self.trajectory).field("arguments", &self.arguments).finish()
    }
}

impl<L: Linearized<Scalar: Real>> HasEnding for SampledSensitivity<'_, L> {
    fn ending(&self) -> &Ending {
        self.trajectory.ending()
    }
}

impl<'a, 'w, L, P, E> Integrates<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E> for SamplesAlone<'w, L>
where
    L: Linearized<Scalar: Real> + 'a,
    P: DifferentiableMethod<L>,
    E: EventList<DynDifferentiableEvent<'w, L>>,
{
    type Result = SampledSensitivity<'a, L>;

    fn run(
        motion: MotionBuilder<'a, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E, Self>,
        end: L::Scalar,
    ) -> Result<SampledSensitivity<'a, L>, Error> {
        let MotionBuilder { system, start, method, events, on_progress, kept } = motion;
        let (plan, ..) = kept.checked()?;
        integrate(system, &start, end, &method, &mut events.list(), &plan, on_progress)
    }
}

/// Integrates a motion together with its derivatives, and samples both.
fn integrate<'a, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>>(
    system: &'a L,
    start: &StateSensitivity<L::Scalar, L::N>,
    end: L::Scalar,
    method: &D,
    events: &mut [Box<DynDifferentiableEvent<'_, L>>],
    plan: &RecordPlan<'_, L>,
    mut on_progress: Option<OnProgress<'_>>,
) -> Result<SampledSensitivity<'a, L>, Error> {
    check_finite(system, &start.state)?;
    check_end(end)?;
    let mut begun = Run::<L, D>::begin(system, &start.state, method);
    let (run, adjustment) = begun.as_mut().map_err(|error| error.clone())?;
    let first = run.state;
    let accept = |state: &StateOf<L>, steps: usize| report(&mut on_progress, [first.t, state.t, end], steps);
    let lent = events.iter_mut().map(|event| -> Box<DynEvent<'_, L>> { Box::new(event) });
    let record = Record::begin(plan, lent.collect(), None, &Sample::of(system, first), end)?;
    let recorded = Recorded::<_, _, _, true>::new(Moving::Fixed(system), record, accept);
    let Along { observer, driven, course, before, samples, .. } =
        Along::drive(recorded, system, run, start, method)?;
    let arrival = observer.finish(driven, run.state, run.statistics);
    let kept = Samples::of(system, [first, arrival.state], plan);
    let trajectory = kept.trajectory(arrival, *adjustment);
    let (last, ending, crossings) = (run.state, trajectory.ending(), trajectory.crossings());
    let end = course.end(system, &last, ending, crossings, events, &before);
    let arguments = course.variations.arguments().to_vec();
    Ok(SampledSensitivity { trajectory, arguments, samples, end })
}

impl<L, D, A> Keeper<L, D> for Recorded<'_, '_, L, D::Interpolant, A, true>
where
    L: Linearized<Scalar: Real>,
    D: DifferentiableMethod<L>,
    A: FnMut(&StateOf<L>, usize) -> Result<(), Ending>,
{
    fn looks_into(&self, run: &Run<L, D>) -> bool {
        self.record.looks_into(run.before.t, run.state.t)
    }

    fn take(&mut self, within: &mut Vec<D::Interpolant>) {
        self.within = within.pop();
    }

    fn samples(&self) -> Option<&[StateOf<L>]> {
        Some(self.record.samples())
    }
}
