//! Derivatives of long functions along directions, from arrays of partial derivatives.

use core::array::from_fn;

use crate::number::numeric::only_where;
use crate::number::{Broadcast, Scalar};

/// Writes the gradients of a function of `inputs` arguments, or of its partial derivatives `by`, row by row: for each of these a row for
/// each result. `slopes` computes one more derivative of the results, by the argument of an index.
pub fn write_gradients<T, const K: usize, const O: usize>(
    inputs: usize,
    by: &[[usize; K]],
    slopes: impl Fn([usize; K], usize) -> [T; O],
    gradients: &mut [T],
) {
    for (rows, &by) in gradients.chunks_exact_mut(O * inputs).zip(by) {
        for i in 0..inputs {
            for (row, slope) in rows.chunks_exact_mut(inputs).zip(slopes(by, i)) {
                row[i] = slope;
            }
        }
    }
}

/// Returns the derivatives of `O` results along a direction, by their gradients. Where the direction has a zero, an infinite slope does
/// not count.
#[inline]
pub fn along<T: Scalar, S: Broadcast<T>, const I: usize, const O: usize>(
    gradients: &[T],
    direction: [S; I],
) -> [S; O] {
    from_fn(|k| {
        let product = |i| only_where(direction[i], S::of(gradients[k * I + i]) * direction[i]);
        (0..I).map(product).fold(S::constant(0.0), |sum, product| sum + product)
    })
}
