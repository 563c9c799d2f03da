//! The trait [`Length`]: a length that is known when a program is compiled, or when it runs.

use core::fmt::Debug;
use core::ops::IndexMut;

use nalgebra::Const;

use super::{Array, Element, StaticLength, Vector, vector};

/// Number of the coordinates of a system, as a value: a *constant* length [`Const<K>`](Const), known when the program is compiled, or a
/// *run-time* length [`Dyn`](nalgebra::Dyn), known when it runs.
pub trait Length: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// Whether the length is a constant.
    type Kind: Kind;
    /// The length itself if it is a constant, else a type without meaning.
    type Static: StaticLength;

    /// The length if it is a constant.
    const CONSTANT: Option<usize>;

    /// The length as a number.
    fn count(self) -> usize;
}

/// Kind of a length: constant lengths are of the kind [`Constant`], run-time lengths of the kind [`RunTime`](crate::generic::RunTime). It
/// chooses the types of vectors.
pub trait Kind {
    /// Column vector: `SVector<T, K>` or `DVector<T>`.
    type Vector<T: Element, S: StaticLength>: Numbers<T>;
    /// Entries of a vector, borrowed: `[T; K]` or `[T]`.
    type View<T: Element, S: StaticLength>: ?Sized + AsRef<[T]> + AsMut<[T]> + IndexMut<usize, Output = T>;
    /// Two vectors: `[[T; K]; 2]`, or [`TwoParts`](crate::generic::TwoParts).
    type Halves<T: Element, S: StaticLength>: Clone
        + Debug
        + PartialEq
        + Send
        + Sync
        + IndexMut<usize, Output = Self::View<T, S>>;

    /// Unused vectors, whose memory a step borrows. Vectors of constant lengths are on the stack, and need none.
    type Spare<T: Element>: Clone + Debug + Default + Send + Sync;

    /// Returns a vector of `count` entries `x`.
    fn filled<T: Element, S: StaticLength>(count: usize, x: T) -> Self::Vector<T, S>;
    /// Returns the entries of a vector.
    fn view<T: Element, S: StaticLength>(vector: &Self::Vector<T, S>) -> &Self::View<T, S>;
    /// Returns two vectors of `count` entries `x`.
    fn halves<T: Element, S: StaticLength>(count: usize, x: T) -> Self::Halves<T, S>;
    /// Joins two vectors of one length. Uses the memory of spare vectors, if there are any.
    fn join<T: Element, S: StaticLength>(
        spare: &mut Self::Spare<T>,
        first: &Self::Vector<T, S>,
        second: &Self::Vector<T, S>,
    ) -> Self::Halves<T, S>;
    /// Returns two vectors of the length of `like`, to write to. Uses the memory of spare vectors, if there are any.
    fn lend<T: Element, S: StaticLength>(
        spare: &mut Self::Spare<T>,
        like: &Self::Halves<T, S>,
    ) -> Self::Halves<T, S>;
    /// Copies two vectors to two others of the same length.
    fn copy<T: Element, S: StaticLength>(to: &mut Self::Halves<T, S>, from: &Self::Halves<T, S>);
    /// Adds two vectors to the spare ones.
    fn give_back<T: Element, S: StaticLength>(spare: &mut Self::Spare<T>, lent: Self::Halves<T, S>);
    /// Returns a half, 0 or 1, of two vectors. For a run-time length it returns a vector without entries.
    fn half_if_constant<T: Element, S: StaticLength>(
        halves: &Self::Halves<T, S>,
        half: usize,
    ) -> Self::Vector<T, S>;
    /// Returns the entries of two vectors, those of the first before those of the second.
    fn flat<T: Element, S: StaticLength>(halves: &Self::Halves<T, S>) -> &[T];
    /// Returns the entries of two vectors for writing.
    fn flat_mut<T: Element, S: StaticLength>(halves: &mut Self::Halves<T, S>) -> &mut [T];
}

/// A column vector, as the sequence of its entries.
pub trait Numbers<T>: Clone + Debug + PartialEq + Send + Sync + IndexMut<usize, Output = T> {
    /// Number of the entries; `None` for a run-time length.
    const COUNT: Option<usize>;

    /// Returns the entries.
    fn entries(&self) -> &[T];
    /// Returns the entries for writing.
    fn entries_mut(&mut self) -> &mut [T];
    /// Copies another vector. Reuses the memory if the lengths are equal.
    fn copy_from(&mut self, other: &Self);
    /// Returns the vector of these entries, as many as [`COUNT`](Self::COUNT) says.
    fn from_entries(entries: &[T]) -> Self;
}

/// Column vector with as many entries as the length says: `SVector<T, K>` for [`Const<K>`](Const), `DVector<T>` for [`Dyn`](nalgebra::Dyn).
pub type VectorOf<T, N> = <<N as Length>::Kind as Kind>::Vector<T, <N as Length>::Static>;

/// Entries of a vector of a length, borrowed: `[T; K]` for [`Const<K>`](Const), `[T]` for [`Dyn`](nalgebra::Dyn).
pub type ViewOf<T, N> = <<N as Length>::Kind as Kind>::View<T, <N as Length>::Static>;

/// Two vectors of a length.
pub(super) type HalvesOf<T, N> = <<N as Length>::Kind as Kind>::Halves<T, <N as Length>::Static>;

/// Returns a vector of `count` entries `x`; a constant length has as many as it says.
#[inline]
pub(crate) fn vector_of<T: Element, N: Length>(count: usize, x: T) -> VectorOf<T, N> {
    N::Kind::filled(count, x)
}

/// Returns the entries of a vector.
#[inline(always)]
pub(crate) fn view_of<T: Element, N: Length>(vector: &VectorOf<T, N>) -> &ViewOf<T, N> {
    N::Kind::view(vector)
}

/// Kind of the lengths that are known when a program is compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Constant;

impl<const K: usize> Length for Const<K> {
    type Kind = Constant;
    type Static = Self;
    const CONSTANT: Option<usize> = Some(K);

    #[inline(always)]
    fn count(self) -> usize {
        K
    }
}

impl Kind for Constant {
    type Vector<T: Element, S: StaticLength> = Vector<T, S>;
    type View<T: Element, S: StaticLength> = S::Entries<T>;
    type Halves<T: Element, S: StaticLength> = S::Halves<T>;
    type Spare<T: Element> = ();

    #[inline]
    fn filled<T: Element, S: StaticLength>(_: usize, x: T) -> Vector<T, S> {
        vector(Array::filled(x))
    }

    #[inline(always)]
    fn view<T: Element, S: StaticLength>(vector: &Vector<T, S>) -> &S::Entries<T> {
        S::view(vector)
    }

    #[inline]
    fn halves<T: Element, S: StaticLength>(_: usize, x: T) -> S::Halves<T> {
        S::join([Array::filled(x); 2])
    }

    #[inline(always)]
    fn join<T: Element, S: StaticLength>(
        (): &mut (),
        first: &Vector<T, S>,
        second: &Vector<T, S>,
    ) -> S::Halves<T> {
        S::join([(*first).into(), (*second).into()])
    }

    #[inline(always)]
    fn lend<T: Element, S: StaticLength>((): &mut (), like: &S::Halves<T>) -> S::Halves<T> {
        *like
    }

    #[inline(always)]
    fn copy<T: Element, S: StaticLength>(to: &mut S::Halves<T>, from: &S::Halves<T>) {
        *to = *from;
    }

    #[inline(always)]
    fn give_back<T: Element, S: StaticLength>((): &mut (), _: S::Halves<T>) {}

    #[inline(always)]
    fn half_if_constant<T: Element, S: StaticLength>(halves: &S::Halves<T>, half: usize) -> Vector<T, S> {
        S::vector(halves[half])
    }

    #[inline(always)]
    fn flat<T: Element, S: StaticLength>(halves: &S::Halves<T>) -> &[T] {
        S::flat(halves)
    }

    #[inline(always)]
    fn flat_mut<T: Element, S: StaticLength>(halves: &mut S::Halves<T>) -> &mut [T] {
        S::flat_mut(halves)
    }
}

impl<T: Element, S: StaticLength> Numbers<T> for Vector<T, S> {
    const COUNT: Option<usize> = Some(<S as StaticLength>::COUNT);

    #[inline(always)]
    fn entries(&self) -> &[T] {
        self.as_slice()
    }

    #[inline(always)]
    fn entries_mut(&mut self) -> &mut [T] {
        self.as_mut_slice()
    }

    #[inline(always)]
    fn copy_from(&mut self, other: &Self) {
        *self = *other;
    }

    fn from_entries(entries: &[T]) -> Self {
        vector(Array::from_fn(|i| entries[i]))
    }
}
