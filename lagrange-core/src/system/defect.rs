//! Whether matrices among the parameters are what `#[parameter(…)]` says of them.

use super::lagrangian::Lagrangian;
use crate::error::Error;
use crate::number::{Real, Scalar, exceeds, power_of_epsilon, sum};

/// How far a matrix is from being what it is said to be, beside its size.
#[derive(Clone, Copy, Debug)]
pub struct Defect<T> {
    wanted: &'static str,
    defect: T,
    size: T,
}

/// Σ |aᵢⱼ − aⱼᵢ| beside Σ |aᵢⱼ|.
pub fn asymmetry<T: Scalar, const K: usize>(a: [[T; K]; K]) -> Defect<T> {
    let defect = sum(K, |i| sum(K, |j| (a[i][j] - a[j][i]).abs()));
    Defect { wanted: "symmetric", defect, size: sum(K, |i| sum(K, |j| a[i][j].abs())) }
}

/// Σ |RᵀR − 1|; of a matrix of 2 or 3 rows also whether its last row is on the right side of the others.
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

/// Beyond what many products leave, ε^(2/3) of the size, a matrix is not what it is said to be; nor is it
/// where an entry is not finite, also one that the equations do not use.
pub(crate) fn check_parameters<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
) -> Result<(), Error> {
    let mut result = Ok(());
    system.visit_defects(&mut |name, Defect { wanted, defect, size }| {
        if result.is_ok() && exceeds(defect, size * power_of_epsilon(2.0 / 3.0)) {
            let defect = (defect / size).to_f64();
            result = Err(Error::ParameterNotAsSaid { name, wanted, defect });
        }
    });
    result
}
