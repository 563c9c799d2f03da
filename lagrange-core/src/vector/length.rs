//! The trait [`Length`]: the length of a vector as a type.

use core::fmt::Debug;
use core::ops::IndexMut;

use nalgebra::{ArrayStorage, Const, DimName, IsContiguous, RawStorageMut, SVector, Storage};

use super::{Array, Constant, Length, Matrix, Vector};

/// A number, or another plain value, that can be an entry of an [`Array`], a [`Vector`] or a [`Matrix`].
pub trait Element: nalgebra::Scalar + Copy + Send + Sync {}

impl<T: nalgebra::Scalar + Copy + Send + Sync> Element for T {}

/// Number of the coordinates, constraints or parameters of a system, as a type: the length of its vectors.
///
/// Every [`Const<K>`](Const) of nalgebra is a length. Its vectors are `SVector<T, K>`, its matrices `SMatrix<T, K, C>`,
/// its arrays `[T; K]`. A function that is generic over the system computes with entries:
///
/// ```
/// # use lagrange_core::prelude::*;
/// use lagrange_core::StateOf;
/// use lagrange_core::generic::StaticLength;
///
/// /// The velocity that p·q̇ weighs most.
/// fn heaviest<L: Lagrangian<Scalar = f64>>(system: &L, state: &StateOf<L>) -> Option<usize> {
///     let p = system.momentum(state);
///     (0..<L::N>::COUNT).max_by(|&i, &j| (p[i] * state.v[i]).total_cmp(&(p[j] * state.v[j])))
/// }
/// # #[derive(Lagrangian)]
/// # #[coordinates(x, y)]
/// # #[lagrangian(m/2 * (x_dot^2 + 2*y_dot^2))]
/// # struct Pair { m: f64 }
/// assert_eq!(heaviest(&Pair { m: 1.0 }, &State::new([0.0, 0.0], [1.0, 1.0])), Some(1));
/// ```
pub trait StaticLength: DimName + Length<Kind = Constant, Static = Self> {
    /// The length as a number.
    const COUNT: usize;

    /// Storage of an [`Array`]: `[T; K]`.
    type Entries<T: Element>: Copy
        + Send
        + Sync
        + Debug
        + PartialEq
        + AsRef<[T]>
        + AsMut<[T]>
        + IndexMut<usize, Output = T>
        + IntoIterator<Item = T, IntoIter: DoubleEndedIterator + ExactSizeIterator>;
    /// Storage of a [`PhaseVector`](super::PhaseVector): `[[T; K]; 2]`.
    type Halves<T: Element>: Copy
        + Send
        + Sync
        + Debug
        + PartialEq
        + IndexMut<usize, Output = Self::Entries<T>>;
    /// Storage of a [`Matrix`] with this number of rows.
    type Storage<T: Element, C: StaticLength>: Contiguous<T, Self, C>;
    /// Storage of a [`Matrix`] with `R` rows and this number of columns.
    type Columns<T: Element, const R: usize>: Contiguous<T, Const<R>, Self>;

    /// Returns entries that all are `x`.
    fn filled<T: Element>(x: T) -> Self::Entries<T>;
    /// Returns the entries `of(0)`, `of(1)`, ….
    fn from_fn<T: Element>(of: impl FnMut(usize) -> T) -> Self::Entries<T>;
    /// Joins two arrays.
    fn join<T: Element>(halves: [Array<T, Self>; 2]) -> Self::Halves<T>;
    /// Returns the entries of two arrays, those of the first before those of the second.
    fn flat<T: Element>(halves: &Self::Halves<T>) -> &[T];
    /// Returns the entries of two arrays for writing.
    fn flat_mut<T: Element>(halves: &mut Self::Halves<T>) -> &mut [T];
    /// Converts entries to a vector.
    fn vector<T: Element>(entries: Self::Entries<T>) -> Vector<T, Self>;
    /// Returns the entries of a vector.
    fn view<T: Element>(vector: &Vector<T, Self>) -> &Self::Entries<T>;
    /// Converts a vector to its entries.
    fn entries<T: Element>(vector: Vector<T, Self>) -> Self::Entries<T>;
    /// Converts columns to a matrix.
    fn matrix<T: Element, C: StaticLength>(columns: Array<Array<T, Self>, C>) -> Matrix<T, Self, C>;
    /// Converts columns of fixed length to the storage of a matrix.
    fn columns<T: Element, const R: usize>(columns: Array<Array<T, Const<R>>, Self>) -> Self::Columns<T, R>;
}

/// Storage of a matrix in one piece, column by column.
pub trait Contiguous<T, R: DimName, C: DimName>:
    Storage<T, R, C> + RawStorageMut<T, R, C> + IsContiguous + Copy + Send + Sync + Debug + PartialEq
where
    T: nalgebra::Scalar,
{
}

impl<T, R, C, S> Contiguous<T, R, C> for S
where
    T: nalgebra::Scalar,
    R: DimName,
    C: DimName,
    S: Storage<T, R, C> + RawStorageMut<T, R, C> + IsContiguous + Copy + Send + Sync + Debug + PartialEq,
{
}

/// Returns the array without entries; K must be 0. Arrays with entries are filled in a loop instead: the compiler has one
/// function to translate for each closure, and with `core::array::from_fn` seven.
fn none<T, const K: usize>() -> [T; K] {
    core::array::from_fn(|_| unreachable!("the array has no entries"))
}

impl<const K: usize> StaticLength for Const<K> {
    const COUNT: usize = K;
    type Entries<T: Element> = [T; K];
    type Halves<T: Element> = [[T; K]; 2];
    type Storage<T: Element, C: StaticLength> = C::Columns<T, K>;
    type Columns<T: Element, const R: usize> = ArrayStorage<T, R, K>;

    #[inline]
    fn filled<T: Element>(x: T) -> [T; K] {
        [x; K]
    }

    #[inline]
    fn from_fn<T: Element>(mut of: impl FnMut(usize) -> T) -> [T; K] {
        if K == 0 {
            return none();
        }
        let mut entries = [of(0); K];
        let mut k = 1;
        while k < K {
            entries[k] = of(k);
            k += 1;
        }
        entries
    }

    #[inline]
    fn join<T: Element>([first, second]: [Array<T, Self>; 2]) -> [[T; K]; 2] {
        [first.0, second.0]
    }

    #[inline(always)]
    fn flat<T: Element>(halves: &[[T; K]; 2]) -> &[T] {
        halves.as_flattened()
    }

    #[inline(always)]
    fn flat_mut<T: Element>(halves: &mut [[T; K]; 2]) -> &mut [T] {
        halves.as_flattened_mut()
    }

    #[inline]
    fn vector<T: Element>(entries: [T; K]) -> SVector<T, K> {
        SVector::from_array_storage(ArrayStorage([entries]))
    }

    #[inline(always)]
    fn view<T: Element>(vector: &SVector<T, K>) -> &[T; K] {
        let [entries] = &vector.data.0;
        entries
    }

    #[inline]
    fn entries<T: Element>(vector: SVector<T, K>) -> [T; K] {
        let [entries] = vector.data.0;
        entries
    }

    #[inline]
    fn matrix<T: Element, C: StaticLength>(columns: Array<Array<T, Self>, C>) -> Matrix<T, Self, C> {
        nalgebra::Matrix::from_data(C::columns(columns))
    }

    #[inline]
    fn columns<T: Element, const R: usize>(
        columns: Array<Array<T, Const<R>>, Self>,
    ) -> ArrayStorage<T, R, K> {
        ArrayStorage(columns.0.map(|column| column.0))
    }
}
