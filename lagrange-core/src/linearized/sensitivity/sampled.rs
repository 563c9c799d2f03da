//! Motions with derivatives that keep samples instead of steps.

use alloc::{boxed::Box, vec::Vec};
use core::marker::PhantomData;

use super::state::StateSensitivity;
use super::trajectory::{Course, DynDifferentiableEvent};
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::variation::{DifferentiableMethod, VariedRun};
use crate::motion::event::DenseStep;
use crate::motion::run::{Observer, Run, Watchdog, check_end};
use crate::motion::whole::builder::EventList;
use crate::motion::whole::progress::{OnProgress, report};
use crate::motion::whole::record::{Arrival, Record, RecordPlan};
use crate::motion::{DynEvent, MotionBuilder, SamplesAlone};
use crate::number::Real;
use crate::solution::Sample;
use crate::solution::vector_field::LagrangianVectorField;
use crate::system::finite::check_finite;
use crate::system::{Lagrangian, StateOf};
use crate::vector::{Element, StaticLength};

/// End and samples of a motion, and their derivatives by entries of the start and by parameters.
#[derive(Clone, Debug)]
pub struct SampledSensitivity<T: Element, N: StaticLength> {
    /// End, samples and crossings of the motion, without derivatives.
    pub arrival: Arrival<T, N>,
    /// Samples of [`arrival`](Self::arrival) with their derivatives at fixed time.
    pub samples: Vec<StateSensitivity<T, N>>,
    end: Result<StateSensitivity<T, N>, Error>,
}

impl<T: Real, N: StaticLength> SampledSensitivity<T, N> {
    /// Returns the last state and its derivatives, like [`TrajectorySensitivity::end`](crate::linearized::TrajectorySensitivity::end).
    ///
    /// # Errors
    /// The errors of `TrajectorySensitivity::end`.
    pub fn end(&self) -> Result<&StateSensitivity<T, N>, Error> {
        self.end.as_ref().map_err(Error::clone)
    }
}

impl<'w, L, P, E> MotionBuilder<'_, 'w, L, StateSensitivity<L::Scalar, L::N>, P, E, SamplesAlone<'w, L>>
where
    L: Lagrangian<Scalar: Real>,
{
    /// Integrates the motion and its derivatives to the time `end`, or to the first
    /// [terminal](crate::Event::terminal) event, without storing the steps.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(x_dot^2/2 - k/2 * x^2)]
    /// struct Spring { k: f64 }
    ///
    /// let spring = Spring { k: 1.0 };
    /// let start = spring.sensitivity(&State::at_rest([1.0]), &["x"])?;
    /// let motion = spring.motion_with_derivatives(&start).every(0.5).to(10.0)?;
    /// for sample in &motion.samples {
    ///     // x = x₀ cos t
    ///     assert!((sample.q[(0, 0)] - sample.state.t.cos()).abs() < 1e-7);
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`Linearized::integrate_sensitivities`], and those of samples that cannot be taken, as for a motion alone.
    pub fn to(self, end: L::Scalar) -> Result<SampledSensitivity<L::Scalar, L::N>, Error>
    where
        L: Linearized,
        P: DifferentiableMethod<L>,
        E: EventList<DynDifferentiableEvent<'w, L>>,
    {
        let motion = self.towards(end)?;
        let ending = &motion.arrival.ending;
        if ending.is_failure() { Err(ending.clone().into()) } else { Ok(motion) }
    }

    /// Integrates the motion and its derivatives towards the time `end`. If the motion fails, the samples up to the
    /// failure are returned, and the ending says why.
    ///
    /// # Errors
    /// The errors of [`to`](Self::to) that are found before the first step.
    pub fn towards(self, end: L::Scalar) -> Result<SampledSensitivity<L::Scalar, L::N>, Error>
    where
        L: Linearized,
        P: DifferentiableMethod<L>,
        E: EventList<DynDifferentiableEvent<'w, L>>,
    {
        let Self { system, start, method, events, on_progress, kept } = self;
        integrate(system, &start, end, &method, &mut events.list(), &kept.plan, on_progress)
    }
}

/// Integrates a motion together with its derivatives, and samples both.
fn integrate<L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>>(
    system: &L,
    start: &StateSensitivity<L::Scalar, L::N>,
    end: L::Scalar,
    method: &D,
    events: &mut [Box<DynDifferentiableEvent<'_, L>>],
    plan: &RecordPlan<'_, L>,
    on_progress: Option<OnProgress<'_>>,
) -> Result<SampledSensitivity<L::Scalar, L::N>, Error> {
    check_finite(system, &start.state)?;
    check_end(end)?;
    plan.check()?;
    let mut begun = Run::<L, D>::begin(system, &start.state, method);
    let (run, _) = begun.as_mut().map_err(|error| error.clone())?;
    let (course, memory) = Course::from(system, &run.state, start, method)?;
    let (arrival, course, before, samples) = {
        let lent = events.iter_mut().map(|event| -> Box<DynEvent<'_, L>> { Box::new(event) });
        let record = Record::begin(plan, lent.collect(), None, &Sample::of(system, run.state), end)?;
        let mut sampled = SampledAlong::<_, D> {
            system,
            ends: [run.state.t, end],
            record,
            course,
            memory,
            before: run.state,
            samples: Vec::new(),
            within: Vec::new(),
            on_progress,
        };
        sampled.sample()?;
        let limits = Watchdog::new(method.limits(), &run.statistics);
        let driven = run.drive(method, &limits, &mut sampled);
        let ending = driven.err().unwrap_or(Ending::Complete { time: end.to_f64() });
        let arrival = sampled.record.arrive(run.state, ending, run.statistics);
        (arrival, sampled.course, sampled.before, sampled.samples)
    };
    let end = course.end(system, &arrival.state, &arrival.ending, &arrival.crossings, events, &before);
    Ok(SampledSensitivity { arrival, samples, end })
}

/// Observer that carries derivatives along a motion and samples both.
struct SampledAlong<'a, 'o, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>> {
    system: &'a L,
    /// Times of the start and of the end.
    ends: [L::Scalar; 2],
    record: Record<'o, L>,
    /// Derivatives along the last step.
    course: Course<L>,
    /// Memory of the method for the derivatives.
    memory: D::VariationMemory,
    /// State at the start of the last step.
    before: StateOf<L>,
    samples: Vec<StateSensitivity<L::Scalar, L::N>>,
    /// Interpolant of the last step, if events or samples need it; else empty.
    within: Vec<D::Interpolant>,
    on_progress: Option<OnProgress<'o>>,
}

impl<'o, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>> SampledAlong<'_, 'o, L, D> {
    /// Adds the derivatives of the samples that the record has taken since the last call.
    fn sample(&mut self) -> Result<(), Error> {
        for state in &self.record.samples()[self.samples.len()..] {
            self.samples.push(self.course.at(self.system, state)?);
        }
        Ok(())
    }
}

impl<L, D> Observer<L, D> for SampledAlong<'_, '_, L, D>
where
    L: Linearized<Scalar: Real>,
    D: DifferentiableMethod<L>,
{
    fn system(&self) -> &L {
        self.system
    }

    fn goal(&mut self, method: &D, run: &mut Run<L, D>) -> Result<Option<L::Scalar>, Ending> {
        if let Some(ending) = self.record.stopped() {
            return Err(ending);
        }
        let [_, end] = self.ends;
        if run.state.t == end {
            return Ok(None);
        }
        self.course.forget_steps();
        self.within.clear();
        let Self { system, course: Course { variations, .. }, memory, .. } = self;
        method.prepare(VariedRun { system, run, variations, memory }, end)?;
        Ok(Some(end))
    }

    fn follow(&mut self, method: &D, run: &mut Run<L, D>) -> Result<(), Ending> {
        let Self { system, course: Course { variations, coefficients, .. }, memory, within, .. } = self;
        method.follow(VariedRun { system, run, variations, memory })?;
        match self.record.looks_into(run.before.t, run.state.t) {
            true => method.interpolate(VariedRun { system, run, variations, memory }, within, coefficients),
            false => Ok(()),
        }
    }

    fn keep(&mut self, _: &D, run: &mut Run<L, D>) -> Result<(), Ending> {
        self.before = run.before;
        self.course.push(run.before.t, run.state.t);
        if let Some(interpolant) = self.within.first() {
            let (system, before, after) = (self.system, &run.before, &{ run.state });
            let step =
                DenseStep { system, before, after, interpolant, field: PhantomData::<LagrangianVectorField> };
            let ending = self.record.keep(&step, &mut run.state);
            self.sample().map_err(|error| Ending::of(error, run.state.t.to_f64()))?;
            ending.map_or(Ok(()), Err)?;
        }
        let [start, end] = self.ends;
        report(&mut self.on_progress, [start, run.state.t, end], run.statistics.accepted)
    }
}
