//! Groups of sums of products, computed in parallel.

use super::super::limits::WIDTH;
use crate::number::Scalar;
use crate::vector::from_fn;

/// Left or right factors of a group of sums. Aligned for SIMD loads: otherwise every other load would touch two cache
/// lines.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Group<T>(pub(super) [T; WIDTH]);

/// Σ x_j y_j and Σ x_j+1 y_j, each in `PARTS` partial sums: in a single one, each product waits for the one
/// before. The first and the last term contain the factors computed last, and are added last: the other terms
/// do not wait for them.
#[inline(always)]
pub(super) fn products<T: Scalar, const PARTS: usize>(x: &[Group<T>], y: &[Group<T>]) -> [[T; WIDTH]; 2] {
    let none = [T::constant(0.0); WIDTH];
    let (mut now, mut next) = ([none; PARTS], [none; PARTS]);
    let ([first, x @ .., last], [newest, y @ .., oldest]) = (x, y) else {
        let only = x.first().zip(y.first()).map_or(none, |(x, y)| plus(&none, x, y));
        return [only, none];
    };
    let mut before = Group(none);
    let ((chunks, rest), (chunks_y, rest_y)) = (x.as_chunks::<PARTS>(), y.as_chunks::<PARTS>());
    for (x, y) in chunks.iter().zip(chunks_y) {
        for k in 0..PARTS {
            now[k] = plus(&now[k], &x[k], &y[k]);
            next[k] = plus(&next[k], &x[k], &before);
            before = y[k];
        }
    }
    for (k, (x, y)) in rest.iter().zip(rest_y).enumerate() {
        now[k] = plus(&now[k], x, y);
        next[k] = plus(&next[k], x, &before);
        before = *y;
    }
    let [mut now, mut next] = [now, next].map(sum);
    next = match x {
        [second, ..] => plus(&plus(&next, last, &before), second, newest),
        [] => plus(&next, last, newest),
    };
    now = plus(&plus(&now, last, oldest), first, newest);
    [now, next]
}

#[inline(always)]
pub(super) fn plus<T: Scalar>(sum: &[T; WIDTH], x: &Group<T>, y: &Group<T>) -> [T; WIDTH] {
    from_fn(|lane| x.0[lane].multiply_add(y.0[lane], sum[lane]))
}

/// Sums the parts pairwise, neighbours first.
#[inline(always)]
fn sum<T: Scalar, const PARTS: usize>(mut parts: [[T; WIDTH]; PARTS]) -> [T; WIDTH] {
    let mut count = PARTS;
    while count > 1 {
        count /= 2;
        for k in 0..count {
            parts[k] = from_fn(|lane| parts[2 * k][lane] + parts[2 * k + 1][lane]);
        }
    }
    parts[0]
}
