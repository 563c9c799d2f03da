//! Loops over the entries of vectors.

use super::{Element, Length};

/// True for a constant length, for which loops over entries are inlined and unrolled. For a run-time length such a loop is a function of
/// its own: from the arguments of a function the compiler knows that what it writes does not overlap what it reads.
pub(crate) const fn is_constant<N: Length>() -> bool {
    N::CONSTANT.is_some()
}

/// Replaces each entry of `to`, given it and the same entry of the vectors `from`.
#[inline(always)]
pub(crate) fn each<T: Element, N: Length, const K: usize>(
    from: [&[T]; K],
    to: &mut [T],
    what_becomes: impl Fn(T, [T; K]) -> T,
) {
    match const { is_constant::<N>() } {
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
