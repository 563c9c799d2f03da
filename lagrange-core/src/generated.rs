//! Functions that only generated code calls. They change with the derive macro, without notice.

use nalgebra::{ArrayStorage, Const, SMatrix, SVector};

use crate::number::Scalar;
use crate::solution::eliminate;
use crate::system::{Lagrangian, State};
use crate::vector::{StaticLength, ViewOf};

pub use crate::derivatives::MotionGradients;
pub use crate::derivatives::bodies::{Joint, JointColumn, Tree, TreeNumbers};
pub use crate::function::gradients::{along, write_gradients};
pub use crate::number::numeric::{only_where, sin_cos_of_small};
pub use crate::solution::eliminate::nan_if_ill_conditioned;
#[cfg(feature = "alloc")]
pub use crate::solution::many_constraints::{Band, BandRow, around, trust, write_constrained_accelerations};
pub use crate::solution::switched::{ConstraintRow, Switched, SwitchedFactorOf, accelerations};
pub use crate::system::defect::{Defect, asymmetry, distortion};
pub use crate::system::equations::equations;
pub use crate::system::member::FieldMember;
pub use crate::system::switch::{FrictionState, Switch, holds, keeps, slides, slip, start, sticks};
pub use crate::vector::Array;
#[cfg(feature = "alloc")]
pub use crate::vector::scratch::with_scratch;
#[cfg(feature = "alloc")]
pub use alloc::vec::Vec;

/// Factorizations computed in loops, for `N` coordinates and `M` constraints.
pub type LoopFactor<T, const N: usize, const M: usize> = eliminate::LoopFactor<T, Const<N>, Const<M>>;

/// Factorizes the completed mass matrix M + FᵀσF, given the rows of M and F and the weights σ.
#[inline]
pub fn factor<T: Scalar, const N: usize, const M: usize>(
    m: [[T; N]; N],
    f: [[T; N]; M],
    weights: [T; M],
) -> LoopFactor<T, N, M> {
    eliminate::LoopFactor::of(m.into(), f.into(), weights.into(), [T::constant(0.0); M].into())
}

/// Solves M q̈ − Fᵀλ = h, F q̈ = −γ without pivoting, given the rows of M and F.
#[inline]
pub fn eliminate<T: Scalar, const N: usize, const M: usize>(
    m: [[T; N]; N],
    h: [T; N],
    f: [[T; N]; M],
    gamma: [T; M],
) -> crate::Solution<T, N, M> {
    factor(m, f, [T::constant(0.0); M]).solve_completed(h.into(), gamma.into())
}

/// Writes the accelerations at coordinates and velocities to `a`, or NaN where the emitted elimination is not reliable.
#[inline]
pub fn write_accelerations<L: Lagrangian>(
    system: &L,
    t: L::Scalar,
    [q, v]: [&ViewOf<L::Scalar, L::N>; 2],
    a: &mut ViewOf<L::Scalar, L::N>,
) {
    let state = State { t, q: L::N::vector(*q), v: L::N::vector(*v) };
    *a = L::N::entries(system.accelerations_unchecked(&state).accelerations);
}

/// Replaces the entries of two vectors by coordinates and velocities.
#[cfg(feature = "alloc")]
#[inline]
pub fn copy<T: Scalar>(from: [&[T]; 2], to: [&mut Vec<T>; 2]) {
    for (from, to) in from.into_iter().zip(to) {
        to.clear();
        to.extend_from_slice(from);
    }
}

/// The first `count` elements of a vector of all coordinates, each of `D` numbers.
#[inline(always)]
pub fn window<T, const D: usize>(all: &[T], count: usize) -> &[[T; D]] {
    &all.as_chunks().0[..count]
}

/// Converts an array to a column vector, without a copy.
#[inline]
pub fn vector<T, const K: usize>(entries: [T; K]) -> SVector<T, K> {
    SVector::from_array_storage(ArrayStorage([entries]))
}

/// Converts an array of columns to a matrix, without a copy.
#[inline]
pub fn matrix<T, const R: usize, const C: usize>(columns: [[T; R]; C]) -> SMatrix<T, R, C> {
    SMatrix::from_array_storage(ArrayStorage(columns))
}
