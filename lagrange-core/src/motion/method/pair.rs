//! Coefficients of embedded Runge–Kutta pairs, and weighted sums of their slopes.

use core::array;

use crate::number::Scalar;
use crate::vector::{Array, Length, PhaseVector, is_constant};

/// A row of the Butcher tableau: pairs (index of a slope, its coefficient).
pub type TableauRow = &'static [(usize, f64)];

/// The coefficients of an explicit embedded pair with dense output.
///
/// Slopes have indices: 0 for the start, then the stages, then the slope at the end of the step, then the stages of the
/// interpolant. There is room for 16. A row of coefficients may only use slopes before its own. The coefficients of a
/// stage add up to its node, the weights to 1, and those of errors and of the interpolant to 0. A pair that violates
/// this does not compile in a program that integrates with it:
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
///     type Coefficients<X: Clone + Send + Sync + 'static> = [X; 4];
///     fn coefficients<X: Clone + Send + Sync + 'static>(all: X) -> [X; 4] {
///         core::array::from_fn(|_| all.clone())
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
    /// Time of each slope, as a fraction of the step.
    const NODES: &'static [f64];
    /// Rows of all stages but the first.
    const STAGES: &'static [TableauRow];
    /// Weights of the new state.
    const WEIGHTS: TableauRow;
    /// Weights of the error estimate e, which accepts or rejects a step.
    const ERROR: TableauRow;
    /// Weights of a second error estimate e′ of lower order, or an empty row. With e′, the error is |e|²/√(|e|² + 0.01
    /// |e′|²) instead of |e|.
    const LOWER_ERROR: TableauRow;
    /// Stages that only the interpolant needs.
    const INTERPOLATION_STAGES: &'static [TableauRow];
    /// Rows for the coefficients of the interpolant beyond the four of its cubic Hermite part.
    const INTERPOLATION: &'static [TableauRow];
    /// Order of the error estimate: it is proportional to this power of the step length.
    const ORDER: f64;
    /// Weight of the previous error in the choice of the step (β of the PI controller).
    const DAMPING: f64;
    /// Lower limit of the ratio of the new step to the old one.
    const SHRINK: f64;
    /// Upper limit of the ratio of the new step to the old one.
    const GROWTH: f64;

    /// All coefficients of the interpolant: an array of 4 more elements than [`INTERPOLATION`](Self::INTERPOLATION) has
    /// rows.
    type Coefficients<X: Clone + Send + Sync + 'static>: AsRef<[X]>
        + AsMut<[X]>
        + Clone
        + Send
        + Sync
        + 'static;

    /// Creates the array of coefficients with `all` in every element.
    fn coefficients<X: Clone + Send + Sync + 'static>(all: X) -> Self::Coefficients<X>;
}

/// Index of the slope at the end of the step.
pub(crate) const fn last<P: Pair>() -> usize {
    P::STAGES.len() + 1
}

/// True if the error estimate uses the slope at the end of the step.
#[inline]
pub(crate) fn error_needs_last<P: Pair>() -> bool {
    P::ERROR.iter().any(|(slope, _)| *slope == last::<P>())
}

/// Largest number of slopes of a step.
pub(crate) const SLOPES: usize = 16;

/// Stops the compilation if the tables of a pair are inconsistent.
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

/// Slopes (q̇, q̈) of a step, by their index.
pub(crate) type Slopes<T, N> = [PhaseVector<T, N>; SLOPES];

/// Multipliers of each slope, by its index.
pub(crate) type StageMultipliers<T, M> = [Array<T, M>; SLOPES];

/// Sets `end` to start + h Σ cᵢ slopeᵢ.
#[inline(always)]
pub(crate) fn advance<T: Scalar, N: Length>(
    start: &PhaseVector<T, N>,
    h: T,
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    end: &mut PhaseVector<T, N>,
) {
    let start = start.flat();
    match const { is_constant::<N>() } {
        true => sums(slopes, row, |i, sum| start[i] + h * sum, end),
        false => long_sums(Some(start), h, slopes, row, end),
    }
}

/// Sets `end` to h Σ cᵢ slopeᵢ.
#[inline]
pub(crate) fn advance_by<T: Scalar, N: Length>(
    h: T,
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    end: &mut PhaseVector<T, N>,
) {
    match const { is_constant::<N>() } {
        // Adds zero, so that no coefficient is −0.
        true => sums(slopes, row, |_, sum| T::constant(0.0) + h * sum, end),
        false => long_sums(None, h, slopes, row, end),
    }
}

/// True if slopes are short enough to stay in registers from stage to stage. Numbers written to memory one by one
/// cannot be loaded as a vector before they reach the cache: every stage would wait for the last slope.
pub(crate) const fn is_carried<N: Length>() -> bool {
    match N::CONSTANT {
        Some(count) => 2 * count <= BLOCK,
        None => false,
    }
}

/// Like [`advance`], with the slope `number`, evaluated last, also in `newest`. If slopes are carried in registers,
/// `newest` replaces the copy in memory.
#[inline(always)]
pub(crate) fn advance_from<T: Scalar, N: Length>(
    (number, newest): (usize, &PhaseVector<T, N>),
    start: &PhaseVector<T, N>,
    h: T,
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    end: &mut PhaseVector<T, N>,
) {
    match row.split_last() {
        Some(((slope, coefficient), earlier)) if is_carried::<N>() && *slope == number => {
            let (start, newest) = (start.flat(), newest.flat());
            let coefficient = T::constant(*coefficient);
            sums(slopes, earlier, |i, sum| start[i] + h * coefficient.multiply_add(newest[i], sum), end);
        }
        _ => advance(start, h, slopes, row, end),
    }
}

/// Sets `to` to Σ cᵢ slopeᵢ.
#[inline(always)]
pub(crate) fn combine<T: Scalar, N: Length>(
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    to: &mut PhaseVector<T, N>,
) {
    match const { is_constant::<N>() } {
        true => sums(slopes, row, |_, sum| sum, to),
        false => long_sums(None, T::constant(1.0), slopes, row, to),
    }
}

/// Sets `results` to start + h Σ cᵢ slopeᵢ, or without a start to h Σ cᵢ slopeᵢ, for vectors of a run-time length.
fn long_sums<T: Scalar, N: Length>(
    start: Option<&[T]>,
    h: T,
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    results: &mut PhaseVector<T, N>,
) {
    macro_rules! by_number_of_terms {
        ($($count:literal)*) => {
            match row.len() {
                $($count => {
                    let terms = array::from_fn::<_, $count, _>(|k| slopes[row[k].0].flat());
                    let coefficients = array::from_fn(|k| T::constant(row[k].1));
                    long_sum(start, h, terms, coefficients, results.flat_mut());
                })*
                _ => unreachable!("a row has at most as many terms as there are slopes"),
            }
        };
    }
    by_number_of_terms!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16);
}

/// The loop of [`long_sums`]. Not inlined: from its arguments the compiler knows that the results do not overlap the terms.
#[inline(never)]
fn long_sum<T: Scalar, const S: usize>(
    start: Option<&[T]>,
    h: T,
    terms: [&[T]; S],
    coefficients: [T; S],
    results: &mut [T],
) {
    let count = results.len();
    let terms = terms.map(|term| &term[..count]);
    let sum = |i: usize| {
        let terms = coefficients.iter().zip(&terms);
        terms.fold(T::constant(0.0), |sum, (coefficient, term)| coefficient.multiply_add(term[i], sum))
    };
    match start {
        Some(start) => {
            let start = &start[..count];
            (0..count).for_each(|i| results[i] = start[i] + h * sum(i));
        }
        None => (0..count).for_each(|i| results[i] = T::constant(0.0) + h * sum(i)),
    }
}

/// Number of sums accumulated in registers at a time.
const BLOCK: usize = 8;

/// Maps each Σ cᵢ slopeᵢ by `what_becomes`, which takes its index and its value, and stores the results.
#[inline(always)]
fn sums<T: Scalar, N: Length>(
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    what_becomes: impl Fn(usize, T) -> T,
    results: &mut PhaseVector<T, N>,
) {
    let (blocks, rest) = results.flat_mut().as_chunks_mut::<BLOCK>();
    let count = blocks.len();
    for (k, block) in blocks.iter_mut().enumerate() {
        sum_block(slopes, row, &what_becomes, BLOCK * k, block);
    }
    sum_block(slopes, row, &what_becomes, BLOCK * count, rest);
}

/// One block of [`sums`], starting at index `at`. The block length is known at compile time, so loops over entries are
/// unrolled.
#[inline(always)]
fn sum_block<T: Scalar, N: Length>(
    slopes: &Slopes<T, N>,
    row: &[(usize, f64)],
    what_becomes: &impl Fn(usize, T) -> T,
    at: usize,
    results: &mut [T],
) {
    let mut sums = [T::constant(0.0); BLOCK];
    for (slope, coefficient) in row {
        let slope = &slopes[*slope].flat()[at..at + results.len()];
        for (sum, x) in sums.iter_mut().zip(slope) {
            *sum = T::constant(*coefficient).multiply_add(*x, *sum);
        }
    }
    for (k, (result, sum)) in results.iter_mut().zip(sums).enumerate() {
        *result = what_becomes(at + k, sum);
    }
}
