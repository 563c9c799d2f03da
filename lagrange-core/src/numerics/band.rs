//! LDLᵀ factorization of symmetric band matrices of any size, without pivoting and without branches, for any scalar.
//!
//! A matrix of half-bandwidth w has entries (i, j) with |i − j| ≤ w alone. It is stored by rows, w + 1 numbers each: the entries
//! (i, i − w) … (i, i). Those that would stand left of the first column may hold anything.
//! (Golub and Van Loan, *Matrix Computations*, 4.3.6.)

use super::ldl::poison;
use crate::number::{Broadcast, Scalar};

/// Replaces a matrix by its factorization: L left of the diagonal, 1/D on it. Returns the smallest ratio of a pivot to its diagonal
/// entry, or of the entry to the pivot: 1 if there are no rows, and zero, negative or NaN if the matrix is not positive definite.
pub fn factor_band<T: Scalar>(band: &mut [T], half_width: usize) -> T {
    let width = half_width + 1;
    let rows = 0..band.len() / width;
    rows.fold(T::constant(1.0), |least, i| {
        let (above, row) = band.split_at_mut(i * width);
        let ratio = factor_row(above, &mut row[..width]);
        poison(least.min(ratio).min(T::constant(1.0) / ratio), least * ratio)
    })
}

/// Factorizes a row below others, and returns the ratio of its pivot to its diagonal entry.
fn factor_row<T: Scalar>(above: &[T], row: &mut [T]) -> T {
    let w = row.len() - 1;
    let first = w - w.min(above.len() / row.len());
    // Row of the factorization whose diagonal is in column `j` of this one.
    let other = |j: usize| &above[above.len() - (w - j) * (w + 1)..][..=w];
    for j in first..w {
        let known = row[first..j].iter().zip(&other(j)[first + w - j..]);
        row[j] = known.fold(row[j], |x, (&a, &l)| x - a * l);
    }
    let (left, diagonal) = row.split_at_mut(w);
    let mut pivot = diagonal[0];
    for j in first..w {
        let l = left[j] * other(j)[w];
        pivot = pivot - l * left[j];
        left[j] = l;
    }
    let ratio = pivot / diagonal[0];
    diagonal[0] = T::constant(1.0) / pivot;
    ratio
}

/// Solves for `x` in place, given the factorization of [`factor_band`].
pub fn solve_band<T: Scalar, S: Broadcast<T>>(band: &[T], half_width: usize, x: &mut [S]) {
    let entry = |i: usize, j: usize| S::of(band[i * (half_width + 1) + half_width - (i - j)]);
    for i in 0..x.len() {
        x[i] = (i.saturating_sub(half_width)..i).fold(x[i], |sum, j| sum - entry(i, j) * x[j]);
    }
    for j in (0..x.len()).rev() {
        let scaled = x[j] * entry(j, j);
        let last = (j + half_width).min(x.len() - 1);
        x[j] = (j + 1..=last).fold(scaled, |sum, i| sum - entry(i, j) * x[i]);
    }
}

#[cfg(test)]
mod tests {
    use lagrange_random::{Random, cases};
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::number::{Dual, FourLanes};

    /// Rows of a matrix, with NaN where nothing may be read.
    fn stored(matrix: &DMatrix<f64>, w: usize) -> Vec<f64> {
        let entry = |i: usize, k: usize| (i + k).checked_sub(w).map_or(f64::NAN, |j| matrix[(i, j)]);
        (0..matrix.nrows()).flat_map(|i| (0..=w).map(move |k| entry(i, k))).collect()
    }

    /// A positive definite matrix B Bᵀ + 1/10, whose half-bandwidth is that of B.
    fn definite(random: &mut Random, n: usize, w: usize) -> DMatrix<f64> {
        let is_near = |i: usize, j: usize| i >= j && i - j <= w;
        let b = DMatrix::from_fn(n, n, |i, j| if is_near(i, j) { random.between(-1.0, 1.0) } else { 0.0 });
        &b * b.transpose() + 0.1 * DMatrix::identity(n, n)
    }

    /// Solutions agree with LU of the dense matrix, and pivots with the squares of Cholesky's diagonal, at every size and width.
    #[test]
    fn solutions_are_those_of_dense_elimination() {
        let mut random = Random(17);
        for case in 0..cases([200, 2_000, 100_000]) {
            let (n, w) = (case % 12, case / 12 % 15);
            let matrix = definite(&mut random, n, w);
            let x = DVector::from_fn(n, |_, _| random.between(-1.0, 1.0));
            let expected = if n == 0 { x.clone() } else { matrix.clone().lu().solve(&x).unwrap() };
            let (mut band, mut solved) = (stored(&matrix, w), x);
            let pivot = factor_band(&mut band, w);
            solve_band(&band, w, solved.as_mut_slice());
            assert!((solved - expected).amax() < 1e-11, "{n} rows, half-bandwidth {w}");
            let least = cholesky_pivots(&matrix).fold(1.0, f64::min);
            assert!((pivot - least).abs() < 1e-13, "{pivot}, not {least}");
        }
    }

    /// Ratios of the pivots to the diagonal entries.
    fn cholesky_pivots(matrix: &DMatrix<f64>) -> impl Iterator<Item = f64> {
        let l = (matrix.nrows() > 0).then(|| matrix.clone().cholesky().unwrap().unpack());
        let ratio = |i: usize| l.as_ref().map_or(1.0, |l| l[(i, i)].powi(2) / matrix[(i, i)]);
        (0..matrix.nrows()).map(ratio).collect::<Vec<_>>().into_iter()
    }

    /// A row that is singular, indefinite or not a number is told by the pivot, also if no other row depends on it.
    #[test]
    fn pivots_tell_what_is_not_definite() {
        let pivot = |mut band: Vec<f64>, w: usize| factor_band(&mut band, w);
        assert_eq!(pivot(vec![0.0, 1.0, 1.0, 1.0], 1), 0.0);
        assert!(pivot(vec![0.0, 1.0, 2.0, 1.0], 1) < 0.0);
        for w in [0, 1, 3] {
            let mut identity = stored(&DMatrix::identity(5, 5), w);
            assert_eq!(pivot(identity.clone(), w), 1.0);
            for singular in [0.0, f64::NAN, f64::INFINITY] {
                identity[w] = singular;
                assert!(pivot(identity.clone(), w).is_nan(), "{singular}");
            }
        }
    }

    /// Derivatives of a solution, for a matrix that changes: A x′ = −A′x.
    #[test]
    fn solutions_have_derivatives() {
        let mut random = Random(4);
        let (n, w) = (7, 2);
        let (matrix, change) = (definite(&mut random, n, w), definite(&mut random, n, w));
        let right = DVector::from_fn(n, |_, _| random.between(-1.0, 1.0));
        let solve = |y: &DVector<f64>| matrix.clone().lu().solve(y).unwrap();
        let x = solve(&right);
        let slope = -solve(&(&change * &x));
        let rows = stored(&matrix, w).into_iter().zip(stored(&change, w));
        let mut band: Vec<_> = rows.map(|(value, slope)| Dual { value, slope }).collect();
        let mut solved: Vec<_> = right.iter().map(|&x| Dual::constant(x)).collect();
        assert!(factor_band(&mut band, w).value > 0.0);
        solve_band(&band, w, &mut solved);
        for i in 0..n {
            assert!((solved[i].value - x[i]).abs() < 1e-12);
            assert!((solved[i].slope - slope[i]).abs() < 1e-10);
        }
    }

    /// One factorization of plain numbers serves right-hand sides on lanes.
    #[test]
    fn right_hand_sides_may_be_lanes() {
        let mut band = vec![0.0, 4.0, 1.0, 3.0];
        factor_band(&mut band, 1);
        let mut x = [[5.0, 4.0, 8.0, 0.0], [4.0, 1.0, 2.0, 0.0]].map(FourLanes::from);
        solve_band(&band, 1, &mut x);
        let expected = [[1.0, 1.0, 2.0, 0.0], [1.0, 0.0, 0.0, 0.0]];
        for (x, expected) in x.iter().zip(expected) {
            for (x, expected) in x.to_array().into_iter().zip(expected) {
                assert!((x - expected).abs() < 1e-15, "{x}, not {expected}");
            }
        }
    }
}
