//! Multipliers of constraints between neighbours, along an array.
//!
//! Constraints are taken position by position. Those at position p contain elements p, …, p + O − 1 alone, so that F M⁻¹ Fᵀ is a band, which
//! is factorized as its rows are computed (Golub and Van Loan, *Matrix Computations*, 4.3.6). The generated code knows the lengths, so that
//! the compiler unrolls all loops but that along the array.

use alloc::vec::Vec;
use core::array::from_fn;
use core::ops::Range;

use super::Correction;
use super::rows::StatedRow;
use crate::number::Scalar;
use crate::numerics::ldl::poison;
use crate::vector::scratch::with_scratch;

/// Coefficients of `O` elements with `D` coordinates each.
type Window<T, const O: usize, const D: usize> = [[T; D]; O];

/// Smallest range with all of these, of which those that are empty do not count.
pub fn around<const C: usize>(ranges: [Range<usize>; C]) -> Range<usize> {
    let ranges = ranges.into_iter().filter(|range| !range.is_empty());
    ranges.reduce(|one, other| one.start.min(other.start)..one.end.max(other.end)).unwrap_or(0..0)
}

/// A constraint at a position: its index among all, and its row F.
#[derive(Clone, Copy, Debug)]
pub struct BandRow<T, const O: usize, const D: usize> {
    index: usize,
    row: StatedRow<T>,
    slopes: Window<T, O, D>,
}

impl<T: Scalar, const O: usize, const D: usize> BandRow<T, O, D> {
    /// Returns the constraint of this index, with Φ if it is holonomic, F q̇ + b, its rate of change at q̈ = 0, and F.
    #[inline(always)]
    pub fn new(index: usize, residual: Option<T>, rate: T, bias: T, slopes: [[T; D]; O]) -> Self {
        Self { index, row: StatedRow { residual, rate, bias }, slopes }
    }
}

/// Inverse masses of one element.
pub trait InverseMasses<T, const D: usize>: Copy {
    /// Accelerations by these forces on the element.
    fn times(&self, forces: &[T; D]) -> [T; D];
}

/// Of coordinates whose velocities do not multiply one another.
impl<T: Scalar, const D: usize> InverseMasses<T, D> for [T; D] {
    #[inline(always)]
    fn times(&self, forces: &[T; D]) -> [T; D] {
        from_fn(|i| self[i] * forces[i])
    }
}

/// By columns of the inverse mass matrix.
impl<T: Scalar, const D: usize> InverseMasses<T, D> for [[T; D]; D] {
    #[inline(always)]
    fn times(&self, forces: &[T; D]) -> [T; D] {
        from_fn(|i| (0..D).fold(T::constant(0.0), |sum, j| sum + self[j][i] * forces[j]))
    }
}

/// Sum over a window.
#[inline(always)]
fn sum<T: Scalar, const O: usize, const D: usize>(term: impl Fn(usize, usize) -> T) -> T {
    let mut sum = T::constant(0.0);
    for j in 0..O {
        for d in 0..D {
            sum = sum + term(j, d);
        }
    }
    sum
}

/// A row of L, and what is needed of it on the way back.
#[derive(Clone, Copy)]
struct Eliminated<T, const O: usize, const D: usize, const W: usize> {
    /// Entries left of the diagonal, nearest last.
    left: [T; W],
    /// 1/D
    inverse: T,
    /// Right-hand side, multiplied by L⁻¹.
    right: T,
    /// M⁻¹ Fᵀ
    moved: Window<T, O, D>,
    /// `None` where there is no constraint.
    index: Option<usize>,
}

/// The band of `K` constraints at each position, of half-width `W` = K O − 1.
#[derive(Debug)]
pub struct Band<const K: usize, const O: usize, const D: usize, const W: usize>;

impl<const K: usize, const O: usize, const D: usize, const W: usize> Band<K, O, D, W> {
    /// Implements [`ManyBodies::correct`](crate::ManyBodies::correct) for `count` constraints at these positions. `place` returns the
    /// indices of the coordinates of an element, `rows` the constraints at a position, and `masses` the inverse masses of an element, anything
    /// for one that does not exist.
    #[inline(always)]
    pub fn correct<T: Scalar, I: InverseMasses<T, D>>(
        (positions, count): (Range<usize>, usize),
        place: impl Fn(usize) -> [usize; D],
        rows: impl Fn(usize) -> [Option<BandRow<T, O, D>>; K],
        masses: impl Fn(usize) -> I,
        (target, x, multipliers): (Correction, &mut [T], &mut Vec<T>),
    ) -> T {
        multipliers.clear();
        multipliers.resize(count, T::constant(0.0));
        with_scratch(|done: &mut Vec<Eliminated<T, O, D, W>>| {
            done.clear();
            let (one, mut least) = (T::constant(1.0), T::constant(1.0));
            let read = |element| place(element).map(|at| x.get(at).copied().unwrap_or(T::constant(0.0)));
            let mut inverse: [I; O] = from_fn(|j| masses(positions.start + j));
            let mut own: Window<T, O, D> = from_fn(|j| read(positions.start + j));
            for position in positions.clone() {
                let rows = rows(position);
                for k in 0..K {
                    let (row, ratio) = match &rows[k] {
                        Some(row) if target.concerns(&row.row) => {
                            Eliminated::of(done, (k, row), &inverse, (target, &own))
                        }
                        _ => (Eliminated::none(), one),
                    };
                    least = poison(least.min(ratio), least * ratio);
                    done.push(row);
                }
                inverse = from_fn(|j| if j + 1 < O { inverse[j + 1] } else { masses(position + O) });
                own = from_fn(|j| if j + 1 < O { own[j + 1] } else { read(position + O) });
            }
            Self::go_back(done, positions, place, (x, multipliers));
            least
        })
    }

    /// Multipliers from the last to the first, each with its M⁻¹ Fᵀ λ.
    #[inline(always)]
    fn go_back<T: Scalar>(
        done: &[Eliminated<T, O, D, W>],
        positions: Range<usize>,
        place: impl Fn(usize) -> [usize; D],
        (x, multipliers): (&mut [T], &mut [T]),
    ) {
        let zero = T::constant(0.0);
        // Σ L λ of later rows, for this row and those before it.
        let mut later = [zero; W];
        // M⁻¹ Fᵀ λ of later rows on the elements of this position.
        let mut moved: Window<T, O, D> = [[zero; D]; O];
        let mut add = |element: usize, moved: [T; D]| {
            let at = place(element);
            for d in 0..D {
                if let Some(x) = x.get_mut(at[d]) {
                    *x = *x + moved[d];
                }
            }
        };
        for (position, rows) in positions.clone().zip(done.chunks_exact(K)).rev() {
            for k in (0..K).rev() {
                let row = &rows[k];
                let known = if W > 0 { later[0] } else { zero };
                let multiplier = row.right * row.inverse - known;
                later = from_fn(|i| {
                    let next = if i + 1 < W { later[i + 1] } else { zero };
                    next + row.left[W - 1 - i] * multiplier
                });
                if let Some(index) = row.index {
                    multipliers[index] = multiplier;
                }
                moved = from_fn(|j| from_fn(|d| moved[j][d] + row.moved[j][d] * multiplier));
            }
            add(position + O - 1, moved[O - 1]);
            moved = from_fn(|j| if j > 0 { moved[j - 1] } else { [zero; D] });
        }
        (1..O).for_each(|j| add(positions.start + j - 1, moved[j]));
    }
}

impl<T: Scalar, const O: usize, const D: usize, const W: usize> Eliminated<T, O, D, W> {
    /// A row where there is no constraint.
    fn none() -> Self {
        let [zero, one] = [0.0, 1.0].map(T::constant);
        Self { left: [zero; W], inverse: one, right: zero, moved: [[zero; D]; O], index: None }
    }

    /// Eliminates the `k`-th constraint at a position. Also returns the ratio of its pivot to its diagonal entry.
    #[inline(always)]
    fn of<I: InverseMasses<T, D>>(
        done: &[Self],
        (k, own): (usize, &BandRow<T, O, D>),
        masses: &[I; O],
        (target, x): (Correction, &Window<T, O, D>),
    ) -> (Self, T) {
        let rows_at_position = (W + 1) / O;
        let moved: Window<T, O, D> = from_fn(|j| masses[j].times(&own.slopes[j]));
        let along = || sum::<T, O, D>(|j, d| own.slopes[j][d] * x[j][d]);
        let product = |other: &Window<T, O, D>, lag: usize| {
            let later = |j: usize, d: usize| other.get(j + lag).map(|other| other[d]);
            sum::<T, O, D>(|j, d| later(j, d).map_or(T::constant(0.0), |other| own.slopes[j][d] * other))
        };
        let diagonal = product(&moved, 0);
        let (mut left, mut right, mut pivot) =
            ([T::constant(0.0); W], target.right(&own.row, along), diagonal);
        for i in 0..W {
            let Some(other) = done.len().checked_sub(W - i).map(|at| &done[at]) else { continue };
            let lag = (W - i).saturating_sub(k).div_ceil(rows_at_position);
            let known = (0..i).map(|m| left[m] * other.left[W + m - i]);
            left[i] = known.fold(product(&other.moved, lag), |sum, known| sum - known);
        }
        for i in 0..W {
            let Some(other) = done.len().checked_sub(W - i).map(|at| &done[at]) else { continue };
            let entry = left[i] * other.inverse;
            pivot = pivot - entry * left[i];
            right = right - entry * other.right;
            left[i] = entry;
        }
        let row = Self { left, inverse: T::constant(1.0) / pivot, right, moved, index: Some(own.index) };
        (row, pivot / diagonal)
    }
}
