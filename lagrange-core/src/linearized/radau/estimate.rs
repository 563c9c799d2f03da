//! Error estimate of a step: the defect of the collocation polynomial at its start, filtered by the derivatives.

use nalgebra::Const;

use super::iteration::{NoSolution, zip};
use super::memory::RadauMemory;
use super::step::rates_at;
use super::tableau::RadauStages;
use crate::linearized::StateDerivatives;
use crate::motion::method::control::Tolerance;
use crate::names::Entry;
use crate::number::{Real, Scalar};
use crate::statistics::Statistics;
use crate::system::{Lagrangian, entry};
use crate::vector::{Array, PhaseVector, StaticLength};

/// Estimated error of a step.
pub(super) struct Estimate<L: Lagrangian> {
    /// In units of the tolerance.
    pub(super) size: f64,
    entries: PhaseVector<L::Scalar, L::N>,
}

impl<L: Lagrangian<Scalar: Real>> Estimate<L> {
    pub(super) fn is_too_large(&self) -> bool {
        is_too_large(self.size)
    }

    /// The entry whose error is the largest part of its tolerance.
    pub(super) fn worst(&self, y: &PhaseVector<L::Scalar, L::N>, tolerance: Tolerance) -> Entry {
        let part = |k: usize| {
            let allowed = tolerance.absolute + tolerance.relative * Scalar::abs(y.flat()[k]).to_f64();
            Scalar::abs(self.entries.flat()[k]).to_f64() / allowed
        };
        entry::<L>((0..2 * <L::N>::COUNT).fold(0, |most, k| if part(k) > part(most) { k } else { most }))
    }
}

/// Slopes of the polynomial at the start, times the length of the step.
pub(super) struct StartSlopes<L: Lagrangian> {
    pub(super) tangent: PhaseVector<L::Scalar, L::N>,
    pub(super) all: PhaseVector<L::Scalar, L::N>,
}

impl<L: StateDerivatives<Scalar: Real>, const S: usize> RadauMemory<L, S>
where
    Const<S>: RadauStages,
{
    /// Estimates the error of the state.
    pub(super) fn estimate(
        &self,
        system: &L,
        slopes: &StartSlopes<L>,
        tolerance: Tolerance,
        statistics: &mut Statistics,
    ) -> Result<Estimate<L>, NoSolution> {
        let tangent = self.chart.tangents(system, &self.at.rates, self.at.t)?;
        let part = |entries: &_| self.part(tolerance, entries);
        self.estimate_of([&self.at.rates, &tangent], slopes, part, |errors| {
            let moved = self.at.moved(L::Scalar::constant(0.0), errors);
            let state = self.chart.onto(system, moved, (tolerance, &self.at.y))?;
            Ok(rates_at(system, &self.chart, &state, &self.at.active, statistics)?)
        })
    }

    /// Estimates the error in the tangent plane, where a damping acts on all of it, and along the normals that of the
    /// coordinates: velocities along the normals follow from those in the plane. `rates` are those at the start, all and in the
    /// plane; `part` is the size of an error in units of the tolerance, and `rates_with` gives the rates in the plane at the start
    /// moved by an error.
    pub(super) fn estimate_of<E>(
        &self,
        [all, tangent]: [&PhaseVector<L::Scalar, L::N>; 2],
        slopes: &StartSlopes<L>,
        part: impl Fn(&PhaseVector<L::Scalar, L::N>) -> f64,
        rates_with: impl FnOnce(&PhaseVector<L::Scalar, L::N>) -> Result<PhaseVector<L::Scalar, L::N>, E>,
    ) -> Result<Estimate<L>, E> {
        let (h, gamma) = (self.factorizations.h, L::Scalar::constant(<Const<S>>::REAL));
        let defect =
            |rates: &_, slopes| zip(rates, slopes, |rate: L::Scalar, slope: L::Scalar| rate - slope / h);
        let (all, along) = (defect(all, &slopes.all), defect(tangent, &slopes.tangent));
        let of = |rates: &_| {
            let defect = defect(rates, &slopes.tangent);
            let mut entries = self.factorizations.real(&self.derivatives, &defect);
            for i in 0..<L::N>::COUNT {
                entries[0][i] += (all[0][i] - along[0][i]) * h / gamma;
            }
            Estimate { size: part(&entries), entries }
        };
        let first = of(tangent);
        let none = Array::filled(L::Scalar::constant(0.0));
        let velocities = PhaseVector::new([none, first.entries.half(1)]);
        if !first.is_too_large() || is_too_large(part(&velocities)) {
            return Ok(first);
        }
        // The start is off the slow motion by an error δ of the velocities that is allowed. A damping c makes its rates off
        // by c δ, and the estimate of the coordinates by h δ. At the start moved by the estimate, this is gone.
        Ok(of(&rates_with(&first.entries)?))
    }

    fn part(&self, tolerance: Tolerance, entries: &PhaseVector<L::Scalar, L::N>) -> f64 {
        tolerance.part(L::Scalar::constant(1.0), entries, &self.at.y).to_f64()
    }
}

/// True if an error, in units of the tolerance, rejects a step.
fn is_too_large(error: f64) -> bool {
    error.is_nan() || error > 1.0
}
