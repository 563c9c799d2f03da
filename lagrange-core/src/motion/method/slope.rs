//! Evaluates and counts the rates at a stage of a step, and names an entry that is not finite.

use nalgebra::ComplexField;

use crate::error::Error;
use crate::number::{Real, are_finite};
use crate::solution::named_field::NamedField;
use crate::solution::vector_field::{ActiveConstraints, StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::System;
use crate::vector::{Array, PhaseVector};

/// Evaluates the rates at a phase point into `rates`, and counts the evaluation. Returns the constraints that determine
/// them, and their multipliers. Not inlined: several callers would each compile the equations again.
#[inline(never)]
pub(super) fn slope<L: System<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    point: &StagePoint<L::Scalar, L::Length>,
    active: Option<&Array<bool, L::M>>,
    rates: &mut PhaseVector<L::Scalar, L::Length>,
    statistics: &mut Statistics,
) -> Result<ActiveConstraints<L::Scalar, L::M>, Error> {
    inlined_slope::<L, F>(system, point, active, rates, statistics)
}

/// Inlined variant of [`slope`], for the loop over the stages, where a call would take time.
#[inline(always)]
pub(super) fn inlined_slope<L: System<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    point: &StagePoint<L::Scalar, L::Length>,
    active: Option<&Array<bool, L::M>>,
    rates: &mut PhaseVector<L::Scalar, L::Length>,
    statistics: &mut Statistics,
) -> Result<ActiveConstraints<L::Scalar, L::M>, Error> {
    statistics.evaluations += 1;
    let constraints = F::evaluate(system, point, active, rates)?;
    statistics.multipliers_are_unique &= constraints.multipliers_are_unique;
    Ok(constraints)
}

pub(super) fn check_finite<L: System<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    t: L::Scalar,
    y: &PhaseVector<L::Scalar, L::Length>,
) -> Result<(), Error> {
    if are_finite(y.flat()) {
        return Ok(());
    }
    match (0..y[0].len()).find(|&i| !(y[0][i].is_finite() && y[1][i].is_finite())) {
        None => Ok(()),
        Some(i) => Err(Error::EquationsNotFinite { row: F::Checks::row(system, i), time: t.to_f64() }),
    }
}
