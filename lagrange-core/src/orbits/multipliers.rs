//! Floquet multipliers: eigenvalues of a product of matrices that is never formed.
//!
//! Cycles of orthogonal iteration turn every factor into a triangle, in the manner of the periodic Schur form (Bojanczyk, Golub and
//! Van Dooren 1992): Φ_k Q_k−1 = Q_k R_k. Where the frame after a cycle spans the same leading subspace as before it, the product
//! falls apart into blocks. Treating the frames as equal there changes the last factor by a few round-offs of itself, so a multiplier
//! of 1 beside one of 10⁸ keeps its digits.

use alloc::vec::Vec;

use nalgebra::{Complex, DMatrix};

use crate::error::Error;
use crate::linearized::eigenvalues;
use crate::number::limits::CANCELLED;
use crate::number::{Real, Scalar, norm, order};

/// Eigenvalues of Φ_m … Φ_1, in descending order of the modulus.
pub(super) fn of_product<T: Real>(factors: &[DMatrix<T>]) -> Result<Vec<Complex<T>>, Error> {
    let n = factors.first().map_or(0, DMatrix::ncols);
    if n == 0 {
        return Ok(Vec::new());
    }
    let mut frame = DMatrix::identity(n, n);
    let (mut turn, mut triangles) = (DMatrix::identity(n, n), Vec::new());
    for _ in 0..decimal_digits::<T>() {
        let before = frame.clone();
        triangles.clear();
        for factor in factors {
            let (q, r) = (factor * &frame).qr().unpack();
            triangles.push(r);
            frame = q;
        }
        turn = before.tr_mul(&frame);
    }
    let mut found = Vec::with_capacity(n);
    for (start, end) in blocks(&turn) {
        let size = end - start;
        let part = |a: &DMatrix<T>| a.view((start, start), (size, size)).into_owned();
        let product = triangles.iter().fold(DMatrix::identity(size, size), |product, r| part(r) * product);
        found.extend(eigenvalues(&(part(&turn) * product))?);
    }
    found.sort_by(|x, y| order(modulus(*y), modulus(*x)));
    Ok(found)
}

/// Decimal digits of a number: cycles after which multipliers are separated whose moduli differ by a factor of 10. Nearer ones stay in
/// one block, where they cannot bury one another.
fn decimal_digits<T: Real>() -> usize {
    core::iter::successors(Some(1.0), |place| Some(place * 0.1))
        .take_while(|place| *place > T::EPSILON)
        .count()
}

/// First rows and ends of the blocks of a matrix that is block triangular to round-off.
fn blocks<T: Real>(turn: &DMatrix<T>) -> Vec<(usize, usize)> {
    let n = turn.nrows();
    let negligible = T::constant(CANCELLED * n as f64 * T::EPSILON);
    let parts = |j: usize| turn.view((j, 0), (n - j, j)).amax() <= negligible;
    let mut starts: Vec<usize> = (1..n).filter(|&j| parts(j)).collect();
    starts.insert(0, 0);
    let ends: Vec<usize> = starts.iter().skip(1).copied().chain([n]).collect();
    starts.into_iter().zip(ends).collect()
}

/// Pairs (λ, 1/λ) of the multipliers of a symplectic matrix, each with the larger modulus first: exact reciprocals.
///
/// A multiplier whose reciprocal is best matched by its own conjugate is one of a pair on the unit circle, and is put there. Else the
/// smaller one, of which a product of matrices keeps fewer digits, is replaced by the reciprocal of the larger.
pub(super) fn paired<T: Real>(mut multipliers: Vec<Complex<T>>) -> Vec<Complex<T>> {
    let mut pairs = Vec::with_capacity(multipliers.len());
    while let Some(first) = (!multipliers.is_empty()).then(|| multipliers.remove(0)) {
        let inverse = reciprocal(first);
        let distance = |x: &Complex<T>| modulus(Complex::new(x.re - inverse.re, x.im - inverse.im));
        let nearest = (0..multipliers.len())
            .min_by(|&j, &k| order(distance(&multipliers[j]), distance(&multipliers[k])));
        let Some(nearest) = nearest else {
            pairs.push(first);
            continue;
        };
        let partner = multipliers.remove(nearest);
        let zero = T::constant(0.0);
        if first.im != zero && partner.re == first.re && partner.im == -first.im {
            let length = modulus(first);
            let first = Complex::new(first.re / length, first.im / length);
            pairs.extend([first, Complex::new(first.re, -first.im)]);
        } else {
            pairs.extend([first, inverse]);
        }
    }
    pairs
}

/// 1/λ.
pub(super) fn reciprocal<T: Real>(x: Complex<T>) -> Complex<T> {
    let length = modulus(x);
    Complex::new(x.re / length / length, -x.im / length / length)
}

/// x/y.
pub(super) fn ratio<T: Real>(x: Complex<T>, y: Complex<T>) -> Complex<T> {
    let inverse = reciprocal(y);
    Complex::new(x.re * inverse.re - x.im * inverse.im, x.re * inverse.im + x.im * inverse.re)
}

/// |λ|.
pub(super) fn modulus<T: Real>(x: Complex<T>) -> T {
    norm(&[x.re, x.im])
}

/// Π (1 + shift·λ) over all multipliers, which is real.
pub(super) fn product_of<T: Real>(multipliers: &[Complex<T>], shift: T) -> T {
    let factor = |x: &Complex<T>| Complex::new(T::constant(1.0) + shift * x.re, shift * x.im);
    product(&multipliers.iter().map(factor).collect::<Vec<_>>())
}

/// Product of factors that are real or come in conjugate pairs.
pub(super) fn product<T: Real>(factors: &[Complex<T>]) -> T {
    let one = Complex::new(T::constant(1.0), T::constant(0.0));
    let times =
        |x: Complex<T>, y: &Complex<T>| Complex::new(x.re * y.re - x.im * y.im, x.re * y.im + x.im * y.re);
    factors.iter().fold(one, times).re
}

/// ln λ, with an imaginary part between −π and π.
pub(super) fn logarithm<T: Real>(x: Complex<T>) -> Complex<T> {
    Complex::new(Scalar::ln(modulus(x)), Scalar::atan2(x.im, x.re))
}

#[cfg(test)]
mod tests;
