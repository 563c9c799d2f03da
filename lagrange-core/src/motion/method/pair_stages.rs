//! Stages of a step of an embedded pair, and its dense output.

use super::pair::{Pair, Slopes, StageMultipliers, TableauRow, advance_by, advance_from, is_carried, last};
use super::pair_memory::{PairMemory, StepStart, Taken};
use super::slope::inlined_slope;
use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::solution::interpolant::hermite;
use crate::solution::vector_field::{StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::System;
use crate::vector::{Length, PhaseVector, SpareVectors, StaticLength};

/// Evaluates the remaining slopes for the dense output of the last accepted step. Returns the start and the length of
/// the step.
#[inline(always)]
pub(super) fn look_within<P, L, F>(
    system: &L,
    memory: &mut PairMemory<L::Scalar, L::Length, L::M>,
    statistics: &mut Statistics,
) -> Result<(L::Scalar, L::Scalar), Error>
where
    P: Pair,
    L: System<Scalar: Real>,
    F: VectorField<L>,
{
    memory.ensure_slope::<L, F>(system, statistics)?;
    memory.slopes[last::<P>()].copy_from(&memory.slope);
    memory.stage_multipliers[last::<P>()] = memory.multipliers;
    let now = memory.clock.now.to_f64();
    let no_step = Error::OutsideTrajectory { time: now, start: now, end: now };
    let Taken { from, h, .. } = memory.taken.as_ref().ok_or(no_step)?;
    let more = (last::<P>() + 1, P::INTERPOLATION_STAGES);
    let stage_memory = (&mut *memory.slopes, &mut *memory.stage_multipliers, &mut memory.spare);
    stages::<P, L, F>(system, from, *h, stage_memory, more, statistics)?;
    Ok((from.t, *h))
}

/// Computes the coefficients of the dense output of the last accepted step from its slopes.
#[inline(always)]
pub(super) fn interpolate<P: Pair, T: Real, N: Length, M: StaticLength>(
    memory: &PairMemory<T, N, M>,
    coefficients: &mut [PhaseVector<T, N>],
) {
    let slopes = &*memory.slopes;
    let Some(Taken { from, h, .. }) = &memory.taken else { return };
    let (start, end) = ((&from.y, &slopes[0]), (&memory.y, &slopes[last::<P>()]));
    let (cubic, beyond) = coefficients.split_at_mut(4);
    hermite(*h, start, end, cubic);
    for (coefficient, row) in beyond.iter_mut().zip(P::INTERPOLATION) {
        advance_by(*h, slopes, row, coefficient);
    }
}

/// Slopes and multipliers of the stages of a step, and memory for their states.
pub(super) type StageBuffers<'a, T, N, M> =
    (&'a mut Slopes<T, N>, &'a mut StageMultipliers<T, M>, &'a mut SpareVectors<T, N>);

/// Evaluates the rates and multipliers of consecutive stages, beginning with stage `first`.
pub(super) fn stages<P, L, F>(
    system: &L,
    from: &StepStart<L::Scalar, L::Length, L::M>,
    h: L::Scalar,
    (slopes, multipliers, spare): StageBuffers<'_, L::Scalar, L::Length, L::M>,
    (first, rows): (usize, &[TableauRow]),
    statistics: &mut Statistics,
) -> Result<(), Error>
where
    P: Pair,
    L: System<Scalar: Real>,
    F: VectorField<L>,
{
    let velocity = slopes[0].half_if_constant(0);
    let mut point = StagePoint { t: from.t, y: spare.lend(&from.y), velocity };
    let stage_memory = (slopes, multipliers);
    let found = stages_at::<P, L, F>(system, from, h, stage_memory, (first, rows), &mut point, statistics);
    spare.give_back(point.y);
    found
}

/// Evaluates stages at `point`, which moves from each to the next.
#[inline(always)]
fn stages_at<P, L, F>(
    system: &L,
    from: &StepStart<L::Scalar, L::Length, L::M>,
    h: L::Scalar,
    (slopes, multipliers): (&mut Slopes<L::Scalar, L::Length>, &mut StageMultipliers<L::Scalar, L::M>),
    (first, rows): (usize, &[TableauRow]),
    point: &mut StagePoint<L::Scalar, L::Length>,
    statistics: &mut Statistics,
) -> Result<(), Error>
where
    P: Pair,
    L: System<Scalar: Real>,
    F: VectorField<L>,
{
    let is_carried = const { is_carried::<L::Length>() };
    let mut newest = if is_carried { slopes[first - 1].clone() } else { PhaseVector::placeholder(h) };
    for (number, row) in rows.iter().enumerate().map(|(i, row)| (first + i, row)) {
        advance_from((number - 1, &newest), &from.y, h, slopes, row, &mut point.y);
        point.t = from.t + h * L::Scalar::constant(P::NODES[number]);
        let rates = if is_carried { &mut newest } else { &mut slopes[number] };
        let found = inlined_slope::<L, F>(system, point, Some(&from.active), rates, statistics)?;
        multipliers[number] = found.multipliers;
        if is_carried {
            slopes[number].copy_from(&newest);
        }
    }
    Ok(())
}
