//! Evaluates and counts the rates at a stage of a step, and names an entry that is not finite.

use nalgebra::ComplexField;

use super::control::StateEntry;
use crate::error::Error;
use crate::names::{Entry, Row, name};
use crate::number::Real;
use crate::solution::vector_field::{ActiveConstraints, StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::Lagrangian;
use crate::vector::{Array, Length, PhaseVector};

/// Evaluates the rates at a phase point into `rates`, and counts the evaluation. Returns the constraints that determine
/// them, and their multipliers. Not inlined: several callers would each compile the equations again.
#[inline(never)]
pub(super) fn slope<L: Lagrangian<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    point: &StagePoint<L::Scalar, L::N>,
    active: Option<&Array<bool, L::M>>,
    rates: &mut PhaseVector<L::Scalar, L::N>,
    statistics: &mut Statistics,
) -> Result<ActiveConstraints<L::Scalar, L::M>, Error> {
    inlined_slope::<L, F>(system, point, active, rates, statistics)
}

/// Inlined variant of [`slope`], for the loop over the stages, where a call would take time.
#[inline(always)]
pub(super) fn inlined_slope<L: Lagrangian<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    point: &StagePoint<L::Scalar, L::N>,
    active: Option<&Array<bool, L::M>>,
    rates: &mut PhaseVector<L::Scalar, L::N>,
    statistics: &mut Statistics,
) -> Result<ActiveConstraints<L::Scalar, L::M>, Error> {
    statistics.evaluations += 1;
    let constraints = F::evaluate(system, point, active, rates)?;
    statistics.multipliers_are_unique &= constraints.multipliers_are_unique;
    Ok(constraints)
}

pub(super) fn check_finite<L: Lagrangian<Scalar: Real>>(
    t: L::Scalar,
    y: &PhaseVector<L::Scalar, L::N>,
) -> Result<(), Error> {
    let row = |i: usize| Row::Coordinate(name(L::COORDINATES, i));
    match (0..<L::N>::COUNT).find(|&i| !(y[0][i].is_finite() && y[1][i].is_finite())) {
        None => Ok(()),
        Some(i) => Err(Error::EquationsNotFinite { row: row(i), time: t.to_f64() }),
    }
}

pub(super) fn entry<L: Lagrangian<Scalar: Real>, F: VectorField<L>>((half, index): StateEntry) -> Entry {
    let name = name(L::COORDINATES, index);
    if half == 0 { Entry::Coordinate(name) } else { F::entry(name) }
}
