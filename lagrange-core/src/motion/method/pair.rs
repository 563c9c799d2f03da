//! What distinguishes one embedded Runge–Kutta pair from another: coefficients.

use crate::number::Scalar;
use crate::solution::vector_field::PhaseVector;

/// The coefficients of a sum of slopes: (index of the slope, coefficient).
pub type TableauRow = &'static [(usize, f64)];

/// The coefficients of an explicit embedded pair with a continuous extension.
///
/// Slopes are numbered 0 at the start, then the stages, then one at the end of the step, then the stages of the
/// interpolant; there is room for 16. Each row of coefficients names slopes before its own only; those of a stage add
/// up to its node, the weights to 1, and those of errors and of the interpolant to 0. Where that is not so, a program
/// that integrates with the pair does not compile:
///
/// ```compile_fail,E0080
/// use lagrange_core::motion::{Adaptive, TableauRow, Pair};
/// use lagrange_core::prelude::*;
///
/// #[derive(Clone, Copy)]
/// struct Heun;
///
/// impl Pair for Heun {
///     const NODES: &'static [f64] = &[0.0, 1.0, 1.0];
///     const STAGES: &'static [TableauRow] = &[&[(0, 0.5)]]; // which is not its node
///     const WEIGHTS: TableauRow = &[(0, 0.5), (1, 0.5)];
///     const ERROR: TableauRow = &[(0, 0.5), (1, -0.5)];
///     const LOWER_ERROR: TableauRow = &[];
///     const INTERPOLATION_STAGES: &'static [TableauRow] = &[];
///     const INTERPOLATION: &'static [TableauRow] = &[];
///     const ORDER: f64 = 2.0;
///     const DAMPING: f64 = 0.0;
///     const SHRINK: f64 = 0.2;
///     const GROWTH: f64 = 5.0;
///     type Coefficients<X: Copy + Send + Sync + 'static> = [X; 4];
///     fn coefficients<X: Copy + Send + Sync + 'static>(all: X) -> [X; 4] {
///         [all; 4]
///     }
/// }
///
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(x_dot^2/2)]
/// struct Free;
///
/// Free.integrate(State::at_rest([0.0]), 1.0, Adaptive::<Heun>::default())?;
/// # Ok::<(), Error>(())
/// ```
pub trait Pair {
    /// The time of each slope as a fraction of the step.
    const NODES: &'static [f64];
    /// Each stage but the first as a sum of the slopes before it.
    const STAGES: &'static [TableauRow];
    /// The new state.
    const WEIGHTS: TableauRow;
    /// The error e that decides.
    const ERROR: TableauRow;
    /// A second error e′ of lower order, or nothing: the estimate is then |e|²/√(|e|² + 0.01 |e′|²) instead of |e|.
    const LOWER_ERROR: TableauRow;
    /// Stages that only the interpolant needs.
    const INTERPOLATION_STAGES: &'static [TableauRow];
    /// Coefficients of the interpolant beyond the fourth.
    const INTERPOLATION: &'static [TableauRow];
    /// Order of the error estimate: the power of the step length that it is proportional to.
    const ORDER: f64;
    /// Weight of the previous error in the choice of the step (β of the PI controller).
    const DAMPING: f64;
    /// The new step is at least this times the old one …
    const SHRINK: f64;
    /// … and at most this times.
    const GROWTH: f64;

    /// All coefficients of the interpolant: an array of 4 and as many as [`INTERPOLATION`](Self::INTERPOLATION) has.
    type Coefficients<X: Copy + Send + Sync + 'static>: AsRef<[X]> + AsMut<[X]> + Copy + Send + Sync + 'static;

    /// That array with `all` in every place.
    fn coefficients<X: Copy + Send + Sync + 'static>(all: X) -> Self::Coefficients<X>;
}

/// The slope at the end of the step.
pub(crate) const fn last<P: Pair>() -> usize {
    P::STAGES.len() + 1
}

/// Whether the error can be had only with the slope at the end of the step.
#[inline]
pub(crate) fn error_needs_last<P: Pair>() -> bool {
    P::ERROR.iter().any(|(slope, _)| *slope == last::<P>())
}

/// Room for the slopes of a step.
pub(crate) const SLOPES: usize = 16;

/// Fails to compile where the tables of a pair do not belong together.
pub(crate) const fn check<P: Pair>() {
    let slopes = last::<P>() + 1 + P::INTERPOLATION_STAGES.len();
    assert!(slopes <= SLOPES, "a pair has at most 16 slopes");
    assert!(P::NODES.len() == slopes, "a pair has one node for each slope");
    assert!(
        size_of::<P::Coefficients<u8>>() == 4 + P::INTERPOLATION.len(),
        "room for the interpolant's coefficients"
    );
    assert!(
        P::ORDER > 0.0 && P::SHRINK > 0.0 && P::SHRINK < 1.0 && P::GROWTH > 1.0,
        "a step changes by these"
    );
    check_stages(P::STAGES, P::NODES, 1);
    check_stages(P::INTERPOLATION_STAGES, P::NODES, last::<P>() + 1);
    check_row(P::WEIGHTS, last::<P>(), 1.0);
    check_row(P::ERROR, last::<P>() + 1, 0.0);
    check_row(P::LOWER_ERROR, last::<P>() + 1, 0.0);
    let mut row = 0;
    while row < P::INTERPOLATION.len() {
        check_row(P::INTERPOLATION[row], slopes, 0.0);
        row += 1;
    }
}

const fn check_stages(rows: &[TableauRow], nodes: &[f64], first: usize) {
    let mut row = 0;
    while row < rows.len() {
        check_row(rows[row], first + row, nodes[first + row]);
        row += 1;
    }
}

const fn check_row(row: TableauRow, slopes: usize, expected: f64) {
    let (mut sum, mut size, mut k) = (0.0, 1.0, 0);
    while k < row.len() {
        assert!(row[k].0 < slopes, "a row of coefficients names a slope that is not there yet");
        sum += row[k].1;
        size += row[k].1.abs();
        k += 1;
    }
    assert!((sum - expected).abs() <= 1e-12 * size, "the coefficients of a row do not add up");
}

/// The slopes (q̇, q̈) of a step.
pub(crate) type Slopes<T, const N: usize> = [PhaseVector<T, N>; SLOPES];

/// Puts start + h Σ cᵢ slopeᵢ into `end`.
#[inline]
pub(crate) fn advance<T: Scalar, const N: usize>(
    start: &PhaseVector<T, N>,
    h: T,
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    end: &mut PhaseVector<T, N>,
) {
    let start = start.as_flattened();
    sums(slopes, row, |i, sum| start[i] + h * sum, end);
}

/// Whether slopes are short enough to be carried from stage to stage in registers. Numbers written to memory one by one
/// cannot be read several at a time before they have reached the cache: every stage would wait for the last slope.
pub(crate) const fn is_carried<const N: usize>() -> bool {
    2 * N <= BLOCK
}

/// As [`advance`], with the slope of this number, evaluated last, at hand as well: where slopes are carried, it is taken
/// instead of the one in memory.
#[inline(always)]
pub(crate) fn advance_from<T: Scalar, const N: usize>(
    (number, newest): (usize, &PhaseVector<T, N>),
    start: &PhaseVector<T, N>,
    h: T,
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    end: &mut PhaseVector<T, N>,
) {
    match row.split_last() {
        Some(((slope, coefficient), earlier)) if is_carried::<N>() && *slope == number => {
            let (start, newest) = (start.as_flattened(), newest.as_flattened());
            let coefficient = T::constant(*coefficient);
            sums(slopes, earlier, |i, sum| start[i] + h * coefficient.multiply_add(newest[i], sum), end);
        }
        _ => advance(start, h, slopes, row, end),
    }
}

#[inline]
pub(crate) fn combine<T: Scalar, const N: usize>(
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
) -> PhaseVector<T, N> {
    let mut combined = [[T::constant(0.0); N]; 2];
    sums(slopes, row, |_, sum| sum, &mut combined);
    combined
}

/// So many sums at a time wait in registers.
const BLOCK: usize = 8;

/// Puts what becomes of each Σ cᵢ slopeᵢ, given its place and its value, into `results`.
#[inline(always)]
fn sums<T: Scalar, const N: usize>(
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    what_becomes: impl Fn(usize, T) -> T,
    results: &mut PhaseVector<T, N>,
) {
    let (blocks, rest) = results.as_flattened_mut().as_chunks_mut::<BLOCK>();
    let count = blocks.len();
    for (k, block) in blocks.iter_mut().enumerate() {
        sum_block(slopes, row, &what_becomes, BLOCK * k, block);
    }
    sum_block(slopes, row, &what_becomes, BLOCK * count, rest);
}

/// A block of the sums from this place on; its length is known at compile time, so that no loop over entries remains.
#[inline(always)]
fn sum_block<T: Scalar, const N: usize>(
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    what_becomes: &impl Fn(usize, T) -> T,
    at: usize,
    results: &mut [T],
) {
    let mut sums = [T::constant(0.0); BLOCK];
    for (slope, coefficient) in row {
        let slope = &slopes[*slope].as_flattened()[at..at + results.len()];
        for (sum, x) in sums.iter_mut().zip(slope) {
            *sum = T::constant(*coefficient).multiply_add(*x, *sum);
        }
    }
    for (k, (result, sum)) in results.iter_mut().zip(sums).enumerate() {
        *result = what_becomes(at + k, sum);
    }
}
