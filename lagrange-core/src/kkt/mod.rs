//! The general solve of the equations of motion, for systems that the elimination cannot solve: a mass matrix that
//! is singular (unit quaternions, massless coordinates) or indefinite, constraints that depend on one another.
//!
//! The null-space method of Nocedal and Wright, *Numerical Optimization*, 16.2: a pivoted QR factorization of Fᵀ
//! splits the accelerations into a part that the constraints fix and a part Z y that they leave free, and
//! ZᵀMZ y follows from the equations of motion along the constraints. It stores N×N and M×N only.

mod qr;
mod symmetric;
#[cfg(test)]
mod tests;

use core::array::from_fn;

use crate::eliminate::vector;
use crate::numeric::{larger, power_of_epsilon, smaller};
use crate::{Real, Scalar, Solution};
use qr::Qr;
use symmetric::Symmetric;

/// M q̈ − Fᵀλ = h, F q̈ + γ = 0, rows as arrays.
pub(crate) struct Equations<T, const N: usize, const M: usize> {
    pub(crate) m: [[T; N]; N],
    pub(crate) h: [T; N],
    pub(crate) f: [[T; N]; M],
    pub(crate) gamma: [T; M],
}

/// Why equations have no solution, or many.
#[derive(Debug)]
pub(crate) enum Fault<T, const N: usize> {
    /// Accelerations in proportion to these are undetermined (each in its own natural unit).
    Singular([T; N]),
    /// The constraint of this index contradicts those it depends on.
    Contradictory(usize),
}

/// How the rank of the constraints is decided.
#[derive(Clone, Copy)]
pub(crate) struct Rank<T> {
    /// A row counts as dependent where less than this of its length is left.
    tolerance: T,
    /// Whether dependent constraints must agree with the others; else they are left out.
    must_agree: bool,
}

impl<T: Real> Rank<T> {
    /// At a state on the constraints: to ε^(2/3), and contradictions are a fault.
    pub(crate) fn on_constraints() -> Self {
        Self { tolerance: power_of_epsilon(2.0 / 3.0), must_agree: true }
    }

    /// At a state off the constraints, where constraints that depend on one another where they hold may not.
    pub(crate) fn off_constraints() -> Self {
        Self { must_agree: false, ..Self::on_constraints() }
    }

    /// For a step towards the constraints: as the last, but to ε^(1/3).
    pub(crate) fn towards_constraints() -> Self {
        Self { tolerance: power_of_epsilon(1.0 / 3.0), ..Self::off_constraints() }
    }
}

/// A solution, and which constraints it rests on: as many as are independent.
pub(crate) type Solved<T, const N: usize, const M: usize> = (Solution<T, N, M>, [bool; M]);

/// Solves the equations in the units in which masses are about 1 and constraint rows have length 1.
///
/// In these units a direction has no inertia where less than ε^(3/4) of the largest is left (ε: the round-off unit
/// of `T`).
pub(crate) fn solve<T: Real, const N: usize, const M: usize>(
    equations: &Equations<T, N, M>,
    rank: Rank<T>,
) -> Result<Solved<T, N, M>, Fault<T, N>> {
    let unit = natural_units(equations);
    let scaled = Scaled::of(equations, &unit);
    let split = Qr::of(scaled.rows, rank.tolerance);

    let fixed = split.solve_transposed(&scaled.bias);
    if rank.must_agree {
        check_agreement(&split, &scaled, &fixed)?;
    }
    let mut h = scaled.h;
    split.enter_basis(&mut h);
    let m = in_range_basis(&split, scaled.m);
    let (free, pivot) = free_accelerations(&split, &m, &h, &fixed)?;

    let mut q = from_fn(|i| fixed[i] + free[i]);
    let force = from_fn(|i| if i < split.rank { dot(&m[i], &q) - h[i] } else { T::constant(0.0) });
    let lambda = multipliers(&split, &scaled.length, &force);
    split.leave_basis(&mut q);
    let solution = Solution {
        accelerations: vector(from_fn(|i| q[i] * unit[i])),
        multipliers: vector(lambda),
        pivot: smaller(pivot, smallest_diagonal(&split)),
        rank: split.rank,
    };
    Ok((solution, from_fn(|a| split.order.iter().take(split.rank).any(|&row| row == a))))
}

/// For each coordinate the unit in which its mass is ±1; where it has none, that in which its strongest coupling is 1.
pub(crate) fn natural_units<T: Real, const N: usize, const M: usize>(e: &Equations<T, N, M>) -> [T; N] {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let mut unit: [T; N] = from_fn(|i| {
        let mass = Scalar::abs(e.m[i][i]);
        if mass > zero { one / Scalar::sqrt(mass) } else { zero }
    });
    let length: [T; M] = from_fn(|a| row_length(&e.f[a], &unit));
    for i in 0..N {
        if unit[i] > zero {
            continue;
        }
        let inertia = (0..N).map(|j| Scalar::abs(e.m[i][j]) * if unit[j] > zero { unit[j] } else { one });
        let couplings =
            (0..M).map(|a| Scalar::abs(e.f[a][i]) / if length[a] > zero { length[a] } else { one });
        let strongest = inertia.chain(couplings).fold(zero, larger);
        unit[i] = if strongest > zero { one / strongest } else { one };
    }
    unit
}

/// The equations in natural units, constraint rows of length 1 (or zero).
struct Scaled<T, const N: usize, const M: usize> {
    m: [[T; N]; N],
    h: [T; N],
    rows: [[T; N]; M],
    /// What `rows` times the accelerations must be.
    bias: [T; M],
    /// The length of each row before it became 1; 1 for a row of zeros.
    length: [T; M],
}

impl<T: Real, const N: usize, const M: usize> Scaled<T, N, M> {
    fn of(e: &Equations<T, N, M>, unit: &[T; N]) -> Self {
        let length: [T; M] = from_fn(|a| {
            let length = row_length(&e.f[a], unit);
            if length > T::constant(0.0) { length } else { T::constant(1.0) }
        });
        Self {
            m: from_fn(|i| from_fn(|j| e.m[i][j] * unit[i] * unit[j])),
            h: from_fn(|i| e.h[i] * unit[i]),
            rows: from_fn(|a| from_fn(|i| e.f[a][i] * unit[i] / length[a])),
            bias: from_fn(|a| -e.gamma[a] / length[a]),
            length,
        }
    }
}

/// Every dependent constraint must agree with the accelerations that the independent ones fix, to ε^(1/3).
fn check_agreement<T: Real, const N: usize, const M: usize>(
    split: &Qr<T, N, M>,
    scaled: &Scaled<T, N, M>,
    fixed: &[T; N],
) -> Result<(), Fault<T, N>> {
    let size = norm(fixed) + norm(&scaled.h);
    for (j, &row) in split.order.iter().enumerate().skip(split.rank) {
        let demanded = scaled.bias[row];
        let given = (0..split.rank).fold(T::constant(0.0), |sum, i| sum + split.entry(i, j) * fixed[i]);
        let mismatch = Scalar::abs(demanded - given);
        if mismatch > power_of_epsilon::<T>(1.0 / 3.0) * (size + Scalar::abs(demanded)) {
            return Err(Fault::Contradictory(row));
        }
    }
    Ok(())
}

/// QᵀMQ.
fn in_range_basis<T: Real, const N: usize, const M: usize>(
    split: &Qr<T, N, M>,
    mut m: [[T; N]; N],
) -> [[T; N]; N] {
    for row in &mut m {
        split.enter_basis(row);
    }
    let mut transposed = from_fn(|i| from_fn(|j| m[j][i]));
    for row in &mut transposed {
        split.enter_basis(row);
    }
    transposed
}

/// The accelerations that the constraints leave free, ZᵀMZ y = Zᵀ(h − M x), and the smallest pivot of ZᵀMZ.
fn free_accelerations<T: Real, const N: usize, const M: usize>(
    split: &Qr<T, N, M>,
    m: &[[T; N]; N],
    h: &[T; N],
    fixed: &[T; N],
) -> Result<([T; N], T), Fault<T, N>> {
    let zero = T::constant(0.0);
    let (rank, size) = (split.rank, N - split.rank);
    let largest = m.iter().flatten().fold(zero, |largest, x| larger(largest, Scalar::abs(*x)));
    let along = from_fn(|i| from_fn(|j| if i < size && j < size { m[rank + i][rank + j] } else { zero }));
    let factors = Symmetric::of(along, size, power_of_epsilon::<T>(0.75) * largest);
    if factors.rank < size {
        return Err(Fault::Singular(undetermined(split, &factors, size)));
    }
    let force = from_fn(|i| if i < size { h[rank + i] - dot(&m[rank + i], fixed) } else { zero });
    let y = factors.solve(&force);
    let pivot = if size > 0 { factors.smallest / largest } else { T::constant(1.0) };
    Ok((from_fn(|i| if i < rank { zero } else { y[i - rank] }), pivot))
}

/// How much each coordinate takes part in the motions that nothing determines.
fn undetermined<T: Real, const N: usize, const M: usize>(
    split: &Qr<T, N, M>,
    factors: &Symmetric<T, N>,
    size: usize,
) -> [T; N] {
    let zero = T::constant(0.0);
    let mut share = [zero; N];
    for index in 0..size - factors.rank {
        let y = factors.null_vector(index);
        let mut x = from_fn(|i| if i < split.rank { zero } else { y[i - split.rank] });
        split.leave_basis(&mut x);
        share = from_fn(|i| larger(share[i], Scalar::abs(x[i])));
    }
    share
}

/// λ with Fᵀλ = M q̈ − h (given in the range basis); of all solutions the one of least Euclidean norm.
fn multipliers<T: Real, const N: usize, const M: usize>(
    split: &Qr<T, N, M>,
    length: &[T; M],
    force: &[T; N],
) -> [T; M] {
    if split.rank == M {
        let scaled = split.solve(force);
        return from_fn(|a| scaled[a] / length[a]);
    }
    // C λ = force with C = R times the row lengths, as wide as there are constraints: λ = Q R⁻ᵀ force of Cᵀ.
    let zero = T::constant(0.0);
    let mut transposed = [[zero; M]; N];
    for (i, column) in transposed.iter_mut().enumerate().take(split.rank) {
        for (j, &row) in split.order.iter().enumerate().skip(i) {
            column[row] = split.entry(i, j) * length[row];
        }
    }
    let wide = Qr::of(transposed, zero);
    let mut lambda = wide.solve_transposed(force);
    wide.leave_basis(&mut lambda);
    lambda
}

fn smallest_diagonal<T: Real, const N: usize, const M: usize>(split: &Qr<T, N, M>) -> T {
    (0..split.rank).fold(T::constant(1.0), |least, i| smaller(least, Scalar::abs(split.entry(i, i))))
}

/// The length of a constraint row in these units.
pub(crate) fn row_length<T: Real, const N: usize>(row: &[T; N], unit: &[T; N]) -> T {
    norm(&from_fn::<T, N, _>(|i| row[i] * unit[i]))
}

fn norm<T: Real, const N: usize>(x: &[T; N]) -> T {
    Scalar::sqrt(dot(x, x))
}

fn dot<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    a.iter().zip(b).fold(T::constant(0.0), |sum, (a, b)| sum + *a * *b)
}
