//! Eigenvalues of a real matrix by Francis's implicit double-shift QR iteration (Golub and Van Loan, *Matrix Computations*,
//! 4th edition, algorithm 7.5.1).
//!
//! A subdiagonal entry counts as zero below the round-off of its neighbours on the diagonal, so each eigenvalue is one of a
//! matrix A + E with ‖E‖ of a few round-offs of ‖A‖. Exceptional shifts break the cycles into which the ordinary ones fall: the
//! eigenvalues of a conservative system lie symmetrically about both axes, four of them equally far from any shift.

use alloc::vec::Vec;

use nalgebra::{Complex, DMatrix, Hessenberg};

use super::limits::PATIENCE;
use crate::number::limits::ITERATIONS;
use crate::number::{Real, Scalar, larger, norm};

/// Eigenvalues of `a`; `None` if the iteration does not converge, or if an entry is not finite.
pub(crate) fn eigenvalues<T: Real>(a: DMatrix<T>) -> Option<Vec<Complex<T>>> {
    if !a.iter().all(|x| Scalar::abs(*x).is_finite()) {
        return None;
    }
    let mut left = ITERATIONS * a.nrows();
    let mut iteration = Francis { h: hessenberg(a) };
    let (mut found, mut end, mut tries) = (Vec::with_capacity(iteration.h.nrows()), iteration.h.nrows(), 0);
    while end > 0 {
        let start = iteration.block(end);
        match end - start {
            1 => found.push(Complex::new(iteration.h[(start, start)], T::constant(0.0))),
            2 => found.extend(iteration.pair(start)),
            _ => {
                left = left.checked_sub(1)?;
                tries += 1;
                let shifts = iteration.shifts(start, end, tries);
                iteration.sweep(start, end, shifts);
                continue;
            }
        }
        (end, tries) = (start, 0);
    }
    Some(found)
}

fn hessenberg<T: Real>(a: DMatrix<T>) -> DMatrix<T> {
    if a.nrows() < 3 { a } else { Hessenberg::new(a).h() }
}

/// Two shifts, both real or complex conjugates. They are stored separately rather than as sum and product: near a
/// multiple eigenvalue the differences between shifts and diagonal are of the size of round-off, and would be lost in
/// the product.
type Shifts<T> = [Complex<T>; 2];

struct Francis<T> {
    /// Upper Hessenberg matrix, orthogonally similar to the given one.
    h: DMatrix<T>,
}

impl<T: Real> Francis<T> {
    /// First row of the unreduced block that ends before row `end`. The subdiagonal entry to its left counts as zero,
    /// and is set to zero.
    fn block(&mut self, end: usize) -> usize {
        for k in (1..end).rev() {
            if self.is_negligible(k, end) {
                self.h[(k, k - 1)] = T::constant(0.0);
                return k;
            }
        }
        0
    }

    /// True if the subdiagonal entry of row `k` is round-off of its neighbours.
    fn is_negligible(&self, k: usize, end: usize) -> bool {
        let at = |i: usize, j: usize| Scalar::abs(self.h[(i, j)]);
        let mut size = at(k - 1, k - 1) + at(k, k);
        if size == T::constant(0.0) {
            let left = if k >= 2 { at(k - 1, k - 2) } else { size };
            size = left + if k + 1 < end { at(k + 1, k) } else { size };
        }
        at(k, k - 1) <= larger(T::constant(T::SMALLEST), T::constant(T::EPSILON) * size)
    }

    /// Eigenvalues of the 2×2 diagonal block that starts at row `k`.
    fn pair(&self, k: usize) -> [Complex<T>; 2] {
        let (h, zero) = (&self.h, T::constant(0.0));
        let product = h[(k, k + 1)] * h[(k + 1, k)];
        let (half, d) = ((h[(k, k)] - h[(k + 1, k + 1)]) * T::constant(0.5), h[(k + 1, k + 1)]);
        let discriminant = half * half + product;
        if discriminant < zero {
            let (re, im) = (d + half, Scalar::sqrt(-discriminant));
            return [Complex::new(re, im), Complex::new(re, -im)];
        }
        let root = Scalar::sqrt(discriminant);
        let far = half + if half < zero { -root } else { root };
        let near = if far == zero { zero } else { product / far };
        [d + far, d - near].map(|re| Complex::new(re, zero))
    }

    /// Shifts: the eigenvalues of the last 2×2 block. If they are real, twice the one nearer to the last entry. After
    /// many iterations on one block, the exceptional shifts of LAPACK's `dlahqr`.
    fn shifts(&self, start: usize, end: usize, tries: usize) -> Shifts<T> {
        let at = |i: usize, j: usize| Scalar::abs(self.h[(i, j)]);
        let exceptional = |corner: T, size: T| {
            let (re, im) = (corner + T::constant(0.75) * size, Scalar::sqrt(T::constant(0.4375)) * size);
            [Complex::new(re, im), Complex::new(re, -im)]
        };
        match tries {
            t if t % (2 * PATIENCE) == 0 => {
                exceptional(self.h[(end - 1, end - 1)], at(end - 1, end - 2) + at(end - 2, end - 3))
            }
            t if t % PATIENCE == 0 => {
                exceptional(self.h[(start, start)], at(start + 1, start) + at(start + 2, start + 1))
            }
            _ => {
                let [first, second] = self.pair(end - 2);
                if first.im != T::constant(0.0) {
                    return [first, second];
                }
                let last = self.h[(end - 1, end - 1)];
                let is_first = Scalar::abs(first.re - last) < Scalar::abs(second.re - last);
                [if is_first { first } else { second }; 2]
            }
        }
    }

    /// One implicit double-shift step on the rows and columns `start..end`: reflectors chase a bulge down the diagonal.
    fn sweep(&mut self, start: usize, end: usize, shifts: Shifts<T>) {
        let zero = T::constant(0.0);
        let mut bulge = self.first_column(start, shifts);
        for k in start..end - 1 {
            let size = (end - k).min(3);
            if k > start {
                bulge = core::array::from_fn(|i| if i < size { self.h[(k + i, k - 1)] } else { zero });
            }
            let Some((reflector, pivot)) = reflector(bulge) else { continue };
            if k > start {
                self.h[(k, k - 1)] = pivot;
                (1..size).for_each(|i| self.h[(k + i, k - 1)] = zero);
            }
            self.reflect(&reflector[..size], k, start..end);
        }
    }

    /// First column of (H − s₁)(H − s₂) of the block, up to a factor.
    fn first_column(&self, start: usize, [first, second]: Shifts<T>) -> [T; 3] {
        let h = |i: usize, j: usize| self.h[(start + i, start + j)];
        let product = (h(0, 0) - first.re) * (h(0, 0) - second.re) - first.im * second.im;
        [
            product + h(0, 1) * h(1, 0),
            h(1, 0) * ((h(0, 0) - first.re) + (h(1, 1) - second.re)),
            h(1, 0) * h(2, 1),
        ]
    }

    /// Applies 1 − v vᵀ to rows and columns from `k` on, within the block.
    fn reflect(&mut self, v: &[T], k: usize, block: core::ops::Range<usize>) {
        let zero = T::constant(0.0);
        for j in k..block.end {
            let along = (0..v.len()).fold(zero, |sum, i| sum + v[i] * self.h[(k + i, j)]);
            (0..v.len()).for_each(|i| self.h[(k + i, j)] -= v[i] * along);
        }
        for i in block.start..block.end.min(k + v.len() + 1) {
            let along = (0..v.len()).fold(zero, |sum, j| sum + v[j] * self.h[(i, k + j)]);
            (0..v.len()).for_each(|j| self.h[(i, k + j)] -= v[j] * along);
        }
    }
}

/// Householder vector v for which 1 − v vᵀ maps x to a multiple of the first unit vector, and that multiple. `None` if
/// x is such a multiple already.
fn reflector<T: Real>(x: [T; 3]) -> Option<([T; 3], T)> {
    let zero = T::constant(0.0);
    let length = norm(&x);
    if length == zero || (x[1] == zero && x[2] == zero) {
        return None;
    }
    let pivot = if x[0] > zero { -length } else { length };
    let v = [(x[0] - pivot) / length, x[1] / length, x[2] / length];
    // vᵀv/2 = 1 + |x₀|/‖x‖, without cancellation.
    let half_square = T::constant(1.0) + Scalar::abs(x[0]) / length;
    let unit = Scalar::sqrt(half_square);
    Some((v.map(|x| x / unit), pivot))
}

#[cfg(test)]
mod tests;
