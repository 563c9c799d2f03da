//! Access to numbers inside fields that are structs, whose types the derive macro cannot see.

use nalgebra::{Quaternion, Rotation, SMatrix, Translation, UnitQuaternion};

use crate::number::Scalar;

/// Access to the numbers `T` of a member with a declared shape: a number, `[T; 3]`, rows `[[T; 3]; 3]`, a
/// rotation or a unit quaternion.
#[diagnostic::on_unimplemented(
    message = "the type of this member is `{Self}`, but it is declared as `{Shape}`",
    label = "declared as `{Shape}`",
    note = "`m` is a number; `c: [3]` an array or a vector; `A: [3, 3]` and `I: symmetric` an array of arrays or a matrix; \
            `R: rotation` such a matrix, or a `Rotation3`; `q: quaternion` a `UnitQuaternion`; `place: pose` an `Isometry3`"
)]
pub trait FieldMember<T, Shape> {
    /// Returns number `k`, counted row by row; for a quaternion in the order (w, x, y, z).
    fn number(&self, k: usize) -> T;

    /// Sets number `k`. Returns `false` for a rotation, whose entries cannot be set one by one.
    fn set(&mut self, k: usize, value: T) -> bool;
}

/// For each shape and type, the expression of number `k`.
macro_rules! members {
    ($({$($length:ident),*} $shape:ty = $ty:ty, |$member:ident, $k:ident| $place:expr;)+) => {$(
        #[diagnostic::do_not_recommend]
        impl<T: Scalar $(, const $length: usize)*> FieldMember<T, $shape> for $ty {
            #[inline(always)]
            fn number(&self, $k: usize) -> T {
                let $member = self;
                $place
            }

            #[inline(always)]
            fn set(&mut self, $k: usize, value: T) -> bool {
                let $member = self;
                $place = value;
                true
            }
        }
    )+};
}

members! {
    {} T = T, |member, _k| *member;
    {N} [T; N] = [T; N], |member, k| member[k];
    {N} [T; N] = SMatrix<T, N, 1>, |member, k| member[k];
    {N} [T; N] = Translation<T, N>, |member, k| member.vector[k];
    {} [T; 4] = Quaternion<T>, |member, k| member.coords[(k + 3) % 4];
    {R, C} [[T; C]; R] = [[T; C]; R], |member, k| member[k / C][k % C];
    {R, C} [[T; C]; R] = SMatrix<T, R, C>, |member, k| member[(k / C, k % C)];
}

/// For each type of rotation, the expression of number `k`.
macro_rules! turns {
    ($({$($length:ident)?} $shape:ty = $ty:ty, |$member:ident, $k:ident| $place:expr;)+) => {$(
        #[diagnostic::do_not_recommend]
        impl<T: Scalar $(, const $length: usize)?> FieldMember<T, $shape> for $ty {
            #[inline(always)]
            fn number(&self, $k: usize) -> T {
                let $member = self;
                $place
            }

            fn set(&mut self, _: usize, _: T) -> bool {
                false
            }
        }
    )+};
}

turns! {
    {N} Rotation<T, N> = Rotation<T, N>, |member, k| member[(k / N, k % N)];
    {N} Rotation<T, N> = SMatrix<T, N, N>, |member, k| member[(k / N, k % N)];
    {N} Rotation<T, N> = [[T; N]; N], |member, k| member[k / N][k % N];
    {} UnitQuaternion<T> = UnitQuaternion<T>, |member, k| member.coords[(k + 3) % 4];
}
