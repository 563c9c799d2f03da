//! A system over another number type: over SIMD lanes, with the parameters of another member in each lane, or
//! over dual numbers.

use core::fmt::Debug;

use nalgebra::{Isometry, Quaternion, Rotation, SMatrix, Translation, Unit};

use crate::number::{Dual, Scalar};
use crate::vector::{Array, Element, PhaseVector, StaticLength};

/// A system that can share SIMD lanes of type `V` with other systems of its type.
///
/// `#[derive(Lagrangian)]` implements it for a struct whose number type is a type parameter. Each lane holds
/// the numbers of one member. A field without that type parameter (a function, a label) is shared by all lanes,
/// so members must agree in it to share a vector. An [`Ensemble`](crate::Ensemble) fills its lanes only with
/// consecutive members that agree in such fields.
///
/// ```
/// use lagrange_core::prelude::*;
/// use lagrange_core::{Lanes, Pack};
///
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
/// struct Spring<T> { m: T, k: T }
///
/// let mut packed: Spring<Lanes> = Spring { m: 1.0, k: 4.0 }.pack();
/// assert!(Spring { m: 2.0, k: 3.0 }.place(&mut packed, 3));
/// let accelerations = packed.accelerations_unchecked(&State::at_rest([Lanes::constant(2.0)])).accelerations;
/// assert_eq!(accelerations[0].to_array()[2..4], [-8.0, -3.0]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be computed with other numbers, as SIMD lanes require, and derivatives of motions by methods other than `Dop853`, `Dopri5`, `RungeKutta4` and `Radau`",
    label = "its number type is fixed",
    note = "make the number type a parameter, `struct X<T> {{ m: T, l: [T; 2] }}`, and derive `Lagrangian` for that; of its fields the expressions must name one",
    note = "of any system, `Ensemble::integrate` integrates one member at a time, and `Dop853` differentiates motions"
)]
pub trait Pack<V>: Sized {
    /// The system over lanes.
    type Packed;

    /// Returns a system with these parameters in every lane.
    fn pack(&self) -> Self::Packed;

    /// Stores these parameters in one lane and leaves the other lanes unchanged. Returns `false` and changes
    /// nothing if a shared field differs.
    fn place(&self, packed: &mut Self::Packed, lane: usize) -> bool;
}

/// A field over lanes, whose counterpart in a single system is a field of type `X`.
#[diagnostic::on_unimplemented(
    message = "a field of type `{X}` cannot be put on SIMD lanes",
    note = "numbers, arrays, and vectors, matrices, rotations, quaternions and isometries of nalgebra can, where the field owns them",
    note = "implement `Packed` for a struct of your own, member by member"
)]
pub trait Packed<X> {
    /// Returns a field with `field` in every lane.
    fn splat(field: &X) -> Self;

    /// Stores `field` in one lane.
    fn place(&mut self, lane: usize, field: &X);
}

/// Values are packed as without derivatives, with slope zero.
impl<W: Packed<X> + Scalar, X> Packed<X> for Dual<W> {
    #[inline]
    fn splat(x: &X) -> Self {
        Self { value: W::splat(x), slope: W::constant(0.0) }
    }

    #[inline]
    fn place(&mut self, lane: usize, x: &X) {
        self.value.place(lane, x);
    }
}

impl<P: Packed<X>, X, const K: usize> Packed<[X; K]> for [P; K] {
    #[inline]
    fn splat(field: &[X; K]) -> Self {
        field.each_ref().map(P::splat)
    }

    #[inline]
    fn place(&mut self, lane: usize, field: &[X; K]) {
        self.iter_mut().zip(field).for_each(|(packed, x)| packed.place(lane, x));
    }
}

impl<P: Packed<X> + Element, X: Element, N: StaticLength> Packed<Array<X, N>> for Array<P, N> {
    #[inline]
    fn splat(field: &Array<X, N>) -> Self {
        Self::from_fn(|i| P::splat(&field[i]))
    }

    #[inline]
    fn place(&mut self, lane: usize, field: &Array<X, N>) {
        self.iter_mut().zip(field).for_each(|(packed, x)| packed.place(lane, x));
    }
}

impl<P: Packed<X> + Element, X: Element, N: StaticLength> Packed<PhaseVector<X, N>> for PhaseVector<P, N> {
    #[inline]
    fn splat(field: &PhaseVector<X, N>) -> Self {
        Self::new(field.arrays().each_ref().map(Packed::splat))
    }

    #[inline]
    fn place(&mut self, lane: usize, field: &PhaseVector<X, N>) {
        self.flat_mut().iter_mut().zip(field.flat()).for_each(|(packed, x)| packed.place(lane, x));
    }
}

impl<P, X, const R: usize, const C: usize> Packed<SMatrix<X, R, C>> for SMatrix<P, R, C>
where
    P: Packed<X> + Clone + PartialEq + Debug + 'static,
    X: Clone + PartialEq + Debug + 'static,
{
    #[inline]
    fn splat(field: &SMatrix<X, R, C>) -> Self {
        Self::from_fn(|i, j| P::splat(&field[(i, j)]))
    }

    #[inline]
    fn place(&mut self, lane: usize, field: &SMatrix<X, R, C>) {
        self.iter_mut().zip(field.iter()).for_each(|(packed, x)| packed.place(lane, x));
    }
}

impl<P, X, const D: usize> Packed<Rotation<X, D>> for Rotation<P, D>
where
    P: nalgebra::Scalar,
    X: nalgebra::Scalar,
    SMatrix<P, D, D>: Packed<SMatrix<X, D, D>>,
{
    #[inline]
    fn splat(field: &Rotation<X, D>) -> Self {
        Self::from_matrix_unchecked(Packed::splat(field.matrix()))
    }

    #[inline]
    fn place(&mut self, lane: usize, field: &Rotation<X, D>) {
        self.matrix_mut_unchecked().place(lane, field.matrix());
    }
}

impl<P, X> Packed<Quaternion<X>> for Quaternion<P>
where
    SMatrix<P, 4, 1>: Packed<SMatrix<X, 4, 1>>,
{
    #[inline]
    fn splat(field: &Quaternion<X>) -> Self {
        Self { coords: Packed::splat(&field.coords) }
    }

    #[inline]
    fn place(&mut self, lane: usize, field: &Quaternion<X>) {
        self.coords.place(lane, &field.coords);
    }
}

impl<P: Packed<X>, X> Packed<Unit<X>> for Unit<P> {
    #[inline]
    fn splat(field: &Unit<X>) -> Self {
        Self::new_unchecked(P::splat(field))
    }

    #[inline]
    fn place(&mut self, lane: usize, field: &Unit<X>) {
        self.as_mut_unchecked().place(lane, field);
    }
}

impl<P: Packed<X>, X, const D: usize> Packed<Translation<X, D>> for Translation<P, D>
where
    SMatrix<P, D, 1>: Packed<SMatrix<X, D, 1>>,
{
    #[inline]
    fn splat(field: &Translation<X, D>) -> Self {
        Self { vector: Packed::splat(&field.vector) }
    }

    #[inline]
    fn place(&mut self, lane: usize, field: &Translation<X, D>) {
        self.vector.place(lane, &field.vector);
    }
}

impl<P, X, R, Q, const D: usize> Packed<Isometry<X, Q, D>> for Isometry<P, R, D>
where
    R: Packed<Q>,
    Translation<P, D>: Packed<Translation<X, D>>,
{
    #[inline]
    fn splat(field: &Isometry<X, Q, D>) -> Self {
        let (rotation, translation) = (R::splat(&field.rotation), Packed::splat(&field.translation));
        Self { rotation, translation }
    }

    #[inline]
    fn place(&mut self, lane: usize, field: &Isometry<X, Q, D>) {
        self.rotation.place(lane, &field.rotation);
        self.translation.place(lane, &field.translation);
    }
}

/// A field that all lanes share: it can be cloned and compared.
#[diagnostic::on_unimplemented(
    message = "a field of type `{Self}` cannot be shared by SIMD lanes",
    note = "derive `Clone` and `PartialEq` for it: members share lanes where such fields are equal"
)]
pub trait Shared: Clone + PartialEq {}

impl<F: Clone + PartialEq> Shared for F {}
