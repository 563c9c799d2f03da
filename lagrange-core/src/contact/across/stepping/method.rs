//! The scheme of Moreau and Jean as a [`Method`], which shares the loop over steps, the search for events and the records with the others.

use alloc::vec::Vec;
use core::fmt;

use super::stepper::ContactStepper;
use super::{ForceDerivatives, MoreauJean};
use crate::contact::Contacts;
use crate::contact::across::builder::check_times;
use crate::error::Error;
use crate::motion::run::Run;
use crate::motion::{Limits, Method, Step};
use crate::names::name;
use crate::number::{Real, Scalar};
use crate::solution::Sample;
use crate::statistics::Statistics;
use crate::system::{Solution, SolutionOf, StateOf};
use crate::trajectory::{Chord, Trajectory};

/// The scheme as a method, whose steps a [`ContactStepper`] takes. It is private: a motion takes the scheme by
/// `by_time_stepping`, since the end of a time step need not satisfy the conditions on the start of other motions.
pub(super) struct TimeSteps(pub(super) MoreauJean);

/// The steps of a motion so far.
pub(super) struct TakenSteps<L: Contacts<Scalar: Real>> {
    pub(super) stepper: ContactStepper<L>,
    /// Mean accelerations and multipliers of the first step.
    first: Option<SolutionOf<L>>,
    /// Mean accelerations and multipliers of each step whose dense output is stored.
    means: Vec<SolutionOf<L>>,
}

impl TimeSteps {
    /// Begins a motion to the time `end`.
    pub(super) fn run<L: ForceDerivatives<Scalar: Real> + Clone>(
        &self,
        system: &L,
        state: StateOf<L>,
        end: L::Scalar,
    ) -> Result<Run<L, Self>, Error> {
        let mut statistics = Statistics::default();
        let memory = self.begin(system, &state, &mut statistics)?;
        check_times(state.t, end)?;
        Ok(Run { memory, state, before: state, statistics })
    }
}

impl<L: ForceDerivatives<Scalar: Real> + Clone> Method<L> for TimeSteps {
    type Memory = TakenSteps<L>;
    type Interpolant = Chord<L::Scalar, L::N>;

    fn limits(&self) -> Limits {
        self.0.limits
    }

    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        write!(to, "{:?}", MoreauJean { limits: Limits::default(), ..self.0 })
    }

    fn check(&self) -> Result<(), Error> {
        self.0.check()
    }

    fn begin(&self, system: &L, start: &StateOf<L>, _: &mut Statistics) -> Result<TakenSteps<L>, Error> {
        let stepper = ContactStepper::new(system, start, self.0)?;
        Ok(TakenSteps { stepper, first: None, means: Vec::new() })
    }

    fn resume(
        &self,
        system: &L,
        memory: &mut TakenSteps<L>,
        _: &StateOf<L>,
        _: &mut Statistics,
    ) -> Result<(), Error> {
        memory.stepper.take(system);
        Ok(())
    }

    fn step(
        &self,
        _: &L,
        memory: &mut TakenSteps<L>,
        end: L::Scalar,
        _: &StateOf<L>,
        to: &mut StateOf<L>,
        statistics: &mut Statistics,
    ) -> Step {
        match memory.stepper.step_towards(end) {
            Ok(step) => {
                statistics.evaluations += step.iterations;
                *to = step.state;
                memory.first.get_or_insert(step.means);
                Step::Accepted
            }
            Err(ending) => Step::Failed(ending),
        }
    }

    fn interpolant(
        &self,
        _: &L,
        _: &mut TakenSteps<L>,
        [before, after]: [&StateOf<L>; 2],
        _: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        Ok(Chord([*before, *after]))
    }

    fn push_interpolant(
        &self,
        system: &L,
        memory: &mut TakenSteps<L>,
        ends: [&StateOf<L>; 2],
        statistics: &mut Statistics,
        to: &mut Vec<Self::Interpolant>,
    ) -> Result<(), Error> {
        to.push(self.interpolant(system, memory, ends, statistics)?);
        memory.means.extend(self.means(memory));
        Ok(())
    }

    fn means(&self, memory: &TakenSteps<L>) -> Option<SolutionOf<L>> {
        Some(memory.stepper.last().means)
    }
}

impl<L: ForceDerivatives<Scalar: Real> + Clone> TakenSteps<L> {
    /// Gives the trajectory of these steps their means, and the names of the contacts that push in the last one.
    pub(super) fn finish(self, mut path: Trajectory<L>) -> Trajectory<L> {
        let leg = path.kept.0.pop().map(|leg| leg.in_time_steps(self.stepper.system().clone(), self.means));
        path.kept.0.extend(leg);
        path.closed = pushing::<L>(path.end().given());
        path
    }

    /// First and last state with the means of the first and of the last step.
    pub(super) fn ends(&self, ends: [Sample<L>; 2]) -> [Sample<L>; 2] {
        let [start, end] = ends;
        let means = self.first.map(|first| [first, self.stepper.last().means]);
        let [first, last] = means.unwrap_or_else(|| [Solution::unknown(); 2]);
        [start.with(Some(first)), end.with(Some(last))]
    }
}

/// Names of the contacts that push in a step.
pub(super) fn pushing<L: Contacts<Scalar: Real>>(means: Option<SolutionOf<L>>) -> Vec<&'static str> {
    let pushes = |row: usize| means.is_some_and(|of| of.multipliers[row] > L::Scalar::constant(0.0));
    let rows = L::CONTACTS.iter().filter(|&&row| pushes(row));
    rows.map(|&row| name(L::CONSTRAINTS, row)).collect()
}
