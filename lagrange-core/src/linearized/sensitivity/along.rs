//! Observer that carries derivatives along a motion.

use alloc::vec::Vec;

use super::course::Course;
use super::state::StateSensitivity;
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::variation::{DifferentiableMethod, VariedRun};
use crate::motion::AnyEvent;
use crate::motion::integration::record::Recorded;
use crate::motion::integration::store::Stored;
use crate::motion::run::{Observer, Run, Watchdog};
use crate::number::Real;
use crate::system::StateOf;

/// An observer of a motion along which derivatives are carried.
pub(super) trait Keeper<L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>>:
    Observer<L, D>
{
    /// True if it needs the dense output of the last step.
    fn looks_into(&self, run: &Run<L, D>) -> bool;

    /// Takes the dense output of the last step, if there is one.
    fn take(&mut self, within: &mut Vec<D::Interpolant>);

    /// The samples so far; `None` if all steps are kept.
    fn samples(&self) -> Option<&[StateOf<L>]>;
}

impl<L, D, W> Keeper<L, D> for Stored<'_, '_, L, W, D::Interpolant, true>
where
    L: Linearized<Scalar: Real>,
    D: DifferentiableMethod<L>,
    W: AnyEvent<L>,
{
    fn looks_into(&self, _: &Run<L, D>) -> bool {
        true
    }

    fn take(&mut self, within: &mut Vec<D::Interpolant>) {
        self.interpolants().append(within);
    }

    fn samples(&self) -> Option<&[StateOf<L>]> {
        None
    }
}

/// Carries derivatives along a motion that another observer keeps.
pub(super) struct Along<'a, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>, O> {
    system: &'a L,
    pub(super) observer: O,
    pub(super) course: Course<L>,
    /// Memory of the method for the next step of the derivatives.
    memory: D::VariationMemory,
    /// State at the start of the last step.
    pub(super) before: StateOf<L>,
    /// Dense output of the last step.
    within: Vec<D::Interpolant>,
    /// Derivatives of the samples of the observer.
    pub(super) samples: Vec<StateSensitivity<L::Scalar, L::N>>,
    pub(super) driven: Result<(), Ending>,
}

impl<'a, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>, O: Keeper<L, D>> Along<'a, L, D, O> {
    /// Integrates to the end that the observer has.
    pub(super) fn drive(
        observer: O,
        system: &'a L,
        run: &mut Run<L, D>,
        start: &StateSensitivity<L::Scalar, L::N>,
        method: &D,
    ) -> Result<Self, Error> {
        let (course, memory) = Course::from(system, &run.state, start, method)?;
        let (before, within, samples, driven) = (run.state, Vec::new(), Vec::new(), Ok(()));
        let mut along = Self { system, observer, course, memory, before, within, samples, driven };
        along.sample()?;
        let limits = Watchdog::new(method.limits(), &run.statistics);
        along.driven = run.drive(method, &limits, &mut along);
        Ok(along)
    }

    /// Adds the derivatives of the samples that the observer has taken since the last call.
    fn sample(&mut self) -> Result<(), Error> {
        for state in &self.observer.samples().unwrap_or_default()[self.samples.len()..] {
            self.samples.push(self.course.at(self.system, state)?);
        }
        Ok(())
    }
}

impl<L, D, O> Observer<L, D> for Along<'_, L, D, O>
where
    L: Linearized<Scalar: Real>,
    D: DifferentiableMethod<L>,
    O: Keeper<L, D>,
{
    fn system(&self) -> &L {
        self.system
    }

    fn goal(&mut self, method: &D, run: &mut Run<L, D>) -> Result<Option<L::Scalar>, Ending> {
        let goal = self.observer.goal(method, run)?;
        if let Some(end) = goal {
            if self.observer.samples().is_some() {
                self.course.forget_steps();
            }
            let Self { system, course: Course { variations, .. }, memory, .. } = self;
            method.prepare(VariedRun { system, run, variations, memory }, end)?;
        }
        Ok(goal)
    }

    fn follow(&mut self, method: &D, run: &mut Run<L, D>) -> Result<(), Ending> {
        let Self {
            system, observer, course: Course { variations, coefficients, .. }, memory, within, ..
        } = self;
        method.follow(VariedRun { system, run, variations, memory })?;
        if observer.looks_into(run) {
            method.interpolate(VariedRun { system, run, variations, memory }, within, coefficients)?;
        }
        observer.take(within);
        Ok(())
    }

    fn keep(&mut self, method: &D, run: &mut Run<L, D>) -> Result<(), Ending> {
        self.before = run.before;
        self.course.push(run.before.t, run.state.t);
        let kept = self.observer.keep(method, run);
        self.sample().map_err(|error| Ending::of(error, run.state.t.to_f64()))?;
        kept
    }
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
