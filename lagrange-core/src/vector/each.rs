//! Loops over the entries of vectors.

use super::{Element, Length};

/// Largest number of the coordinates for which loops over entries are inlined, and unrolled.
const SHORT: usize = 16;

/// True if loops over entries are inlined. Others are functions of their own, which know from their arguments that what they write
/// does not overlap what they read.
pub(crate) const fn is_short<N: Length>() -> bool {
    matches!(N::CONSTANT, Some(count) if count <= SHORT)
}

/// Maps each entry of `to`, with those of other vectors as long.
#[inline(always)]
pub(crate) fn each<T: Element, N: Length, const K: usize>(
    from: [&[T]; K],
    to: &mut [T],
    what_becomes: impl Fn(T, [T; K]) -> T,
) {
    match const { is_short::<N>() } {
        true => each_here(from, to, what_becomes),
        false => each_apart(from, to, what_becomes),
    }
}

#[inline(never)]
fn each_apart<T: Element, const K: usize>(
    from: [&[T]; K],
    to: &mut [T],
    what_becomes: impl Fn(T, [T; K]) -> T,
) {
    each_here(from, to, what_becomes);
}

#[inline(always)]
fn each_here<T: Element, const K: usize>(
    from: [&[T]; K],
    to: &mut [T],
    what_becomes: impl Fn(T, [T; K]) -> T,
) {
    let from = from.map(|from| &from[..to.len()]);
    for (i, to) in to.iter_mut().enumerate() {
        *to = what_becomes(*to, from.map(|from| from[i]));
    }
}
