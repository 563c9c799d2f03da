//! Samples that a trajectory keeps in the place of its steps.

use alloc::string::ToString;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};

use super::csv::names_of_entries;
use super::kept::KeptStates;
use super::records::Records;
use super::stored::Trajectory;
use crate::error::Error;
use crate::motion::integration::record::{Arrival, RecordPlan, quantity};
use crate::number::Real;
use crate::solution::vector_field::VectorField;
use crate::solution::{Adjustment, Sample};
use crate::system::{StateOf, System};
use crate::vector::Numbers;

/// States of a motion at chosen times, and its first and last state: what a [`SampledTrajectory`] keeps.
pub struct Samples<S: System> {
    /// The system as it is at the end.
    pub(crate) system: S,
    /// First and last state, each with the system as it is there.
    pub(crate) ends: [Sample<S>; 2],
    pub(crate) states: Vec<StateOf<S>>,
    /// Quantities of the first sample, then of the second, …
    pub(crate) values: Vec<S::Scalar>,
    /// Names of the quantities.
    pub(crate) quantities: Vec<&'static str>,
}

/// Motion of a system of which samples alone are kept, after [`every`](crate::MotionBuilder::every) or
/// [`samples_at`](crate::MotionBuilder::samples_at).
///
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(x_dot^2/2 - x^2/2)]
/// struct Spring;
///
/// let motion = Spring.motion(State::at_rest([1.0])).every(0.5);
/// let path = motion.quantity("energy", |sample| sample.energy()).to(10.0)?;
/// assert_eq!(path.samples().len(), 21);
/// assert!((path.samples()[3].q[0] - 1.5_f64.cos()).abs() < 1e-7);
/// assert!(path.quantity("energy")?.all(|energy| (energy - 0.5).abs() < 1e-7));
/// assert!((path.end().coordinate("x")? - 10.0_f64.cos()).abs() < 1e-7);
/// # Ok::<(), Error>(())
/// ```
pub type SampledTrajectory<S, F = <S as System>::Field> = Trajectory<S, F, Samples<S>>;

impl<S: System> Debug for Samples<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { ends, states, quantities, .. } = self;
        let mut text = f.debug_struct("Samples");
        text.field("ends", &ends.each_ref().map(Sample::state))
            .field("count", &states.len())
            .field("quantities", quantities);
        text.finish_non_exhaustive()
    }
}

impl<S: System<Scalar: Real>> KeptStates<S> for Samples<S> {
    fn system(&self) -> &S {
        &self.system
    }

    fn first(&self) -> Sample<&S> {
        self.ends[0].borrowed()
    }

    fn last(&self) -> Sample<&S> {
        self.ends[1].borrowed()
    }

    fn is_in_time_steps(&self) -> bool {
        self.ends[1].given().is_some()
    }
}

impl<S: System<Scalar: Real>> Samples<S> {
    /// Samples of a motion between these ends, which are taken by a plan.
    pub(crate) fn of<L>(system: S, ends: [Sample<S>; 2], plan: &RecordPlan<'_, L>) -> Self
    where
        L: System<Scalar = S::Scalar>,
    {
        let (states, values, quantities) = (Vec::new(), Vec::new(), plan.quantities().collect());
        Self { system, ends, states, values, quantities }
    }

    /// The trajectory of a motion with what was recorded of it.
    pub(crate) fn trajectory<F>(
        self,
        arrival: Arrival<S::Scalar, S::Length>,
        adjustment: Adjustment<S::Scalar, S::Length>,
    ) -> SampledTrajectory<S, F> {
        let Arrival { ending, statistics, samples: states, values, crossings, transitions, .. } = arrival;
        let kept = Self { states, values, ..self };
        Trajectory { transitions, ..Trajectory::of(kept, crossings, ending, statistics, adjustment) }
    }
}

impl<L: System + Clone, F> SampledTrajectory<&L, F> {
    /// Returns the trajectory with its own copy of the system; the original may then change or be dropped.
    pub fn into_owned(self) -> SampledTrajectory<L, F> {
        self.map(|Samples { system, ends, states, values, quantities }| Samples {
            system: system.clone(),
            ends: ends.map(Sample::into_owned),
            states,
            values,
            quantities,
        })
    }
}

impl<S: System<Scalar: Real>, F: VectorField<S>> SampledTrajectory<S, F> {
    /// Returns a table of the samples: `t`, coordinates `x`, velocities `x_dot`, and the quantities. It prints as comma-separated
    /// values.
    pub fn csv(&self) -> Records<S::Scalar> {
        let Samples { system, states, values, quantities, .. } = &self.kept;
        let mut names = names_of_entries::<_, F::Checks>(system);
        names.extend(quantities.iter().map(ToString::to_string));
        let row = |(k, state): (usize, &StateOf<S>)| {
            let values = values[k * quantities.len()..].iter().take(quantities.len());
            [state.t]
                .iter()
                .chain(state.q.entries())
                .chain(state.v.entries())
                .chain(values)
                .copied()
                .collect()
        };
        Records { names, rows: states.iter().enumerate().map(row).collect() }
    }

    /// Returns the states at the times of the samples, up to the end of the motion; at a transition, the state after it.
    pub fn samples(&self) -> &[StateOf<S>] {
        &self.kept.states
    }

    /// Returns the quantities of the samples: all of the first sample, all of the second, ….
    pub fn values(&self) -> &[S::Scalar] {
        &self.kept.values
    }

    /// Returns one quantity of each sample.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn quantity(&self, name: &str) -> Result<impl Iterator<Item = S::Scalar> + '_, Error> {
        quantity(name, &self.kept.quantities, &self.kept.values, "ask for it by `MotionBuilder::quantity`")
    }
}
