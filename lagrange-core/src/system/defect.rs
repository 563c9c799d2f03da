//! Deviation of parameter matrices from the properties that `#[parameter(…)]` declares.

use crate::number::{Scalar, sum};

/// Deviation of a matrix from its declared property, with the size to which it is relative.
#[derive(Clone, Copy, Debug)]
pub struct Defect<T> {
    pub(super) wanted: &'static str,
    pub(super) defect: T,
    pub(super) size: T,
}

/// Returns Σ |aᵢⱼ − aⱼᵢ| as the deviation and Σ |aᵢⱼ| as the size.
pub fn asymmetry<T: Scalar, const K: usize>(a: [[T; K]; K]) -> Defect<T> {
    let defect = sum(K, |i| sum(K, |j| (a[i][j] - a[j][i]).abs()));
    Defect { wanted: "symmetric", defect, size: sum(K, |i| sum(K, |j| a[i][j].abs())) }
}

/// Returns Σ |RᵀR − 1| as the deviation. For 2 or 3 rows a term for the orientation is added: a reflection is
/// no rotation.
pub fn distortion<T: Scalar, const K: usize>(r: [[T; K]; K]) -> Defect<T> {
    let one = |is_one: bool| T::constant(if is_one { 1.0 } else { 0.0 });
    let lengths = sum(K, |i| sum(K, |j| (sum(K, |k| r[k][i] * r[k][j]) - one(i == j)).abs()));
    let side = match K {
        2 => (r[0][0] - r[1][1]).abs() + (r[0][1] + r[1][0]).abs(),
        3 => sum(3, |i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            (r[0][j] * r[1][k] - r[0][k] * r[1][j] - r[2][i]).abs()
        }),
        _ => T::constant(0.0),
    };
    Defect { wanted: "a rotation", defect: lengths + side, size: one(true) }
}
