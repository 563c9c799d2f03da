//! One step of Taylor's method: sum of the series, and checks of the result.

use nalgebra::ComplexField;

use super::defect::CandidateStep;
use super::expansion::SolvedState;
use super::limits::COLLAPSE;
use super::memory::{Before, TaylorMemory};
use super::sampling::{Sampling, few, samples_of_steep};
use super::settings::Taylor;
use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::solution::consistent::{BOTH, project_by};
use crate::solution::near::{Corrections, compensated};
use crate::solution::solve::first_row;
use crate::statistics::Statistics;
use crate::system::{State, TaylorSeries};
use crate::vector::{Array, Element, FixedArray, StaticLength, array, vector};

impl<S: FixedArray<T>, T: Real, N: StaticLength, M: StaticLength> TaylorMemory<S, T, N, M> {
    /// End of a step of this length, before its projection.
    #[inline]
    fn sum(&self, h: T) -> Sum<T, N> {
        let Self { state, rest, series, .. } = self;
        let [dq, dv, accelerations] = series.change(h);
        let (q, rest_q) = compensated(&array(state.q), &dq, &rest[0]);
        let (v, rest_v) = compensated(&array(state.v), &dv, &rest[1]);
        Sum { phase: [q, v], rest: [rest_q, rest_v], accelerations }
    }
}

/// Result of an attempted step.
pub(super) enum Attempt<T: Element, N: StaticLength> {
    Reached(State<T, N>),
    /// Rejected; index of the coordinate whose acceleration or state is most inaccurate.
    Inaccurate(usize),
}

impl Taylor {
    /// Plans another step after one of length `h` was rejected. Returns false if it would not advance the time.
    pub(super) fn can_be_shorter<S: FixedArray<T>, T: Real, N: StaticLength, M: StaticLength>(
        &self,
        memory: &mut TaylorMemory<S, T, N, M>,
        h: T,
    ) -> bool {
        memory.planned = self.limited(Scalar::abs(h) * T::constant(0.5));
        memory.clock.advances_by(memory.planned)
    }

    /// Sets the end; before the first step, also plans the longest allowed first step.
    pub(crate) fn aim<S, T: Real, N: StaticLength, M: StaticLength>(
        &self,
        memory: &mut TaylorMemory<S, T, N, M>,
        end: T,
    ) {
        memory.clock.aim(end);
        if memory.planned == T::constant(0.0) {
            memory.planned = self.first(&memory.state, &memory.solved, memory.clock.left());
            memory.sampling = Sampling::of_first(memory.planned);
        }
    }

    /// Expands the motion about the state, and chooses the step length, unless this has been done.
    pub(crate) fn expand<L: TaylorSeries<Scalar: Real>>(
        &self,
        system: &L,
        memory: &mut TaylorMemory<L::Sums, L::Scalar, L::N, L::M>,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        if memory.is_expanded {
            return Ok(());
        }
        let TaylorMemory { clock, state, solved, series, planned, sampling, .. } = memory;
        // The unit is the step length: a constant unit would round alike in every step, and the energy would drift.
        let unit = clock.directed(*planned);
        let slack = L::Scalar::constant(self.slack::<L::Scalar>());
        let last = series.about(system, state, solved, [unit, slack])?;
        statistics.evaluations += series.order();
        let row =
            |i: usize| series.v[series.order()][i].is_finite() && series.q[series.order()][i].is_finite();
        if let Some(row) = first_row::<L>(|i| !row(i), |_| false) {
            return Err(Error::EquationsNotFinite { row, time: state.t.to_f64() });
        }
        let before = if sampling.step > L::Scalar::constant(0.0) { *planned } else { sampling.step };
        *planned = self.choose(last.allowed(), sampling.longest::<L>(*planned), clock);
        if L::M::COUNT > 0 && *planned < before * L::Scalar::constant(COLLAPSE) {
            *planned = self.limited(self.truncate(series, *planned));
        }
        memory.is_expanded = true;
        Ok(())
    }

    /// Attempts a step of length `h`, to the time `time`.
    pub(super) fn attempt<L: TaylorSeries<Scalar: Real>>(
        &self,
        system: &L,
        memory: &mut TaylorMemory<L::Sums, L::Scalar, L::N, L::M>,
        (h, time): (L::Scalar, L::Scalar),
        statistics: &mut Statistics,
    ) -> Result<Attempt<L::Scalar, L::N>, Error> {
        let count = self.samples::<L>(memory, h);
        let Sum { phase: [q, v], rest, accelerations } = &mut memory.sum(h);
        let TaylorMemory { state, series, .. } = memory;
        let mut next = State { t: time, q: vector(*q), v: vector(*v) };
        if let Some(row) = first_row::<L>(|i| !(q[i].is_finite() && v[i].is_finite()), |_| false) {
            return Err(Error::EquationsNotFinite { row, time: state.t.to_f64() });
        }
        project_by(Corrections::OnceAfter(h), system, &BOTH, &mut next, rest)?;
        let solved = SolvedState::at(system, &next)?;
        if memory.solved.avoids(&solved) {
            return Ok(Attempt::Inaccurate(0));
        }
        let projected = [&array(next.q), &array(next.v)];
        if let Some(worst) = self.moved([(q, projected[0]), (v, projected[1])]) {
            return Ok(Attempt::Inaccurate(worst));
        }
        let tried = CandidateStep {
            series,
            start: state,
            end: &next,
            solved: &solved,
            length: h,
            accelerations,
            count,
        };
        if let Some(worst) = tried.inaccurate(system, self, statistics)? {
            return Ok(Attempt::Inaccurate(worst));
        }
        memory.before = Some(Before {
            solved: core::mem::replace(&mut memory.solved, solved),
            rest: core::mem::replace(&mut memory.rest, *rest),
            sampling: core::mem::replace(&mut memory.sampling, Sampling::after(Scalar::abs(h), count)),
        });
        (memory.state, memory.is_expanded) = (next, false);
        memory.clock.now = time;
        Ok(Attempt::Reached(next))
    }

    /// Number of samples within a step of this length. A step across a pose where constraints become dependent is
    /// checked at its ends.
    fn samples<L: TaylorSeries<Scalar: Real>>(
        &self,
        memory: &TaylorMemory<L::Sums, L::Scalar, L::N, L::M>,
        h: L::Scalar,
    ) -> usize {
        let TaylorMemory { sampling, series, .. } = memory;
        let (few, count) = (few::<L>(), sampling.count::<L>(Scalar::abs(h)));
        let measures = [self.tolerance::<L::Scalar>(), self.slack::<L::Scalar>()];
        if series.is_truncated() {
            return few;
        }
        let steep = series
            .steep::<L>(h)
            .map(|([value, change], exponent)| samples_of_steep([value.to_f64(), change.to_f64()], exponent));
        let least = steep.fold(few, usize::max);
        if count > least && !series.has_middle_terms(h, measures) { count } else { least }
    }
}

/// End of a step before its projection.
struct Sum<T: Element, N: StaticLength> {
    phase: [Array<T, N>; 2],
    /// Compensation terms of `phase`: its rounding errors.
    rest: [Array<T, N>; 2],
    /// Accelerations of the series at this end.
    accelerations: Array<T, N>,
}
