//! General solver of the equations of motion, for systems on which the elimination fails: a singular or
//! indefinite mass matrix, or constraints that depend on one another.
//!
//! Null-space method of Nocedal and Wright, *Numerical Optimization*, 16.2. A pivoted QR factorization of Fᵀ
//! splits the accelerations into a part that the constraints fix and a free part Z y. ZᵀMZ y follows from the
//! equations of motion along the constraints. The method stores N×N and M×N matrices only.

#[cfg(test)]
mod tests;
mod units;

use crate::number::{Real, Scalar, dot, larger, largest, norm, power_of_epsilon, smaller};

use crate::numerics::qr::Qr;
use crate::numerics::symmetric::Symmetric;
use crate::solution::limits::REFINEMENTS;
use crate::system::Solution;
use crate::vector::{Array, Element, StaticLength, Vector, from_fn, vector};
pub(crate) use units::Units;

/// Coefficients of M q̈ − Fᵀλ = h, F q̈ + γ = 0; matrices as arrays of rows.
pub(crate) struct KktSystem<T: Element, N: StaticLength, M: StaticLength> {
    pub(crate) m: Array<Array<T, N>, N>,
    pub(crate) h: Array<T, N>,
    pub(crate) f: Array<Array<T, N>, M>,
    pub(crate) gamma: Array<T, M>,
}

/// Reason why the equations have no solution, or more than one.
#[derive(Debug)]
pub(crate) enum Fault<T: Element, N: StaticLength> {
    /// Undetermined accelerations: share of each coordinate in them, in its natural unit.
    Singular(Array<T, N>),
    /// Index of a constraint that contradicts those on which it depends.
    Contradictory(usize),
}

/// Criterion for the rank of the constraints.
#[derive(Clone, Copy)]
pub(crate) struct Rank<T> {
    /// Largest remainder of a dependent row, relative to its length.
    tolerance: T,
    /// True if dependent constraints must agree with the others; false to ignore them.
    must_agree: bool,
}

impl<T: Real> Rank<T> {
    /// For a state on the constraints: tolerance ε^(2/3), and contradictions are errors.
    pub(crate) fn on_constraints() -> Self {
        Self { tolerance: power_of_epsilon(2.0 / 3.0), must_agree: true }
    }

    /// For a state off the constraints, where constraints that are dependent on the manifold may disagree.
    pub(crate) fn off_constraints() -> Self {
        Self { must_agree: false, ..Self::on_constraints() }
    }

    /// For a step towards the constraints: like [`off_constraints`](Self::off_constraints) with tolerance
    /// ε^(1/3).
    pub(crate) fn towards_constraints() -> Self {
        Self { tolerance: power_of_epsilon(1.0 / 3.0), ..Self::off_constraints() }
    }

    /// For rows that may be dependent nearby: like [`off_constraints`](Self::off_constraints) with this
    /// tolerance.
    pub(crate) fn near_dependence(tolerance: T) -> Self {
        Self { tolerance, ..Self::off_constraints() }
    }
}

/// A solution, and for each constraint whether it belongs to the independent ones that determine it.
pub(crate) type Solved<T, N, M> = (Solution<T, N, M>, Array<bool, M>);

/// Solves the equations; see [`Factors`].
pub(crate) fn solve<T: Real, N: StaticLength, M: StaticLength>(
    equations: &KktSystem<T, N, M>,
    rank: Rank<T>,
) -> Result<Solved<T, N, M>, Fault<T, N>> {
    let factors = Factors::of(&equations.m, &equations.f, rank);
    let first = factors.solve(&equations.h, &equations.gamma)?;
    let solution = (0..REFINEMENTS).fold(first, |solution, _| refined(equations, &factors, solution));
    Ok((solution, factors.rows.independent()))
}

/// Solves the equations for the residuals of a solution, and adds the result to it (iterative refinement: Higham, *Accuracy
/// and Stability of Numerical Algorithms*, 12.2). In natural units, a multiplier may be tiny beside the others, and has the
/// round-off of the others; each refinement reduces this error.
fn refined<T: Real, N: StaticLength, M: StaticLength>(
    equations: &KktSystem<T, N, M>,
    factors: &Factors<T, N, M>,
    solution: Solution<T, N, M>,
) -> Solution<T, N, M> {
    let KktSystem { m, h, f, gamma } = equations;
    let (a, lambda) = (&solution.accelerations, &solution.multipliers);
    let pull = |i: usize| (0..M::COUNT).fold(h[i], |sum, k| sum + f[k][i] * lambda[k]);
    let force = Array::from_fn(|i| (0..N::COUNT).fold(pull(i), |sum, j| sum - m[i][j] * a[j]));
    let bias = Array::from_fn(|k| (0..N::COUNT).fold(gamma[k], |sum, j| sum + f[k][j] * a[j]));
    let Ok(correction) = factors.solve_as_given(&force, &bias) else { return solution };
    let accelerations = vector(Array::<T, N>::from_fn(|i| a[i] + correction.accelerations[i]));
    let multipliers = vector(Array::<T, M>::from_fn(|k| lambda[k] + correction.multipliers[k]));
    let is_finite = |x: &T| x.is_finite();
    match accelerations.as_slice().iter().chain(multipliers.as_slice()).all(is_finite) {
        true => Solution { accelerations, multipliers, ..solution },
        false => solution,
    }
}

/// Factorization of the left-hand sides M and F for any number of right-hand sides, in units in which masses
/// are about 1 and constraint rows have length 1.
///
/// In these units a direction counts as massless if its pivot is less than ε^(3/4) of the largest entry of M
/// (ε: the round-off unit of `T`).
pub(crate) struct Factors<T: Element, N: StaticLength, M: StaticLength> {
    pub(crate) rows: Rows<T, N, M>,
    /// QᵀMQ.
    m: Array<Array<T, N>, N>,
    /// Factorization of ZᵀMZ, and its smallest pivot relative to the largest entry of M.
    along: Symmetric<T, N>,
    pivot: T,
    /// For dependent constraints, the QR factorization that gives the multipliers of least norm.
    wide: Option<Qr<T, M, N>>,
    must_agree: bool,
}

impl<T: Real, N: StaticLength, M: StaticLength> Factors<T, N, M> {
    pub(crate) fn of(m: &Array<Array<T, N>, N>, f: &Array<Array<T, N>, M>, rank: Rank<T>) -> Self {
        let rows = Rows::of(m, f, rank);
        let mut m = *m;
        for i in 0..N::COUNT {
            for j in 0..N::COUNT {
                m[i][j] *= rows.units.coordinates[i] * rows.units.coordinates[j];
            }
        }
        to_range_basis(&rows.split, &mut m);
        let largest = m.iter().fold(T::constant(0.0), |most, row| larger(most, largest(row)));
        let along = along_constraints(&m, rows.split.rank, largest);
        let pivot = if rows.split.rank < N::COUNT { along.smallest / largest } else { T::constant(1.0) };
        // Rows of zeros, as of constraints that are switched off, have no share in the forces.
        let wide = rows.has_dependent_rows(f).then(|| least_norm(&rows.split));
        Self { rows, m, along, pivot, wide, must_agree: rank.must_agree }
    }

    /// True if every direction that F leaves free has mass.
    pub(crate) fn are_regular(&self) -> bool {
        self.along.rank == N::COUNT - self.rows.split.rank
    }

    /// True if no direction that F leaves free has negative mass.
    pub(crate) fn is_semidefinite(&self) -> bool {
        self.along.negative().is_none()
    }

    /// Returns a direction of negative mass that F leaves free.
    pub(crate) fn downhill(&self) -> Option<Vector<T, N>> {
        let (rank, y) = (self.rows.split.rank, self.along.negative()?);
        Some(
            self.rows.out_of_basis(Array::from_fn(|i| if i < rank { T::constant(0.0) } else { y[i - rank] })),
        )
    }

    /// Solves M q̈ − Fᵀλ = h, F q̈ + γ = 0.
    pub(crate) fn solve(
        &self,
        h: &Array<T, N>,
        gamma: &Array<T, M>,
    ) -> Result<Solution<T, N, M>, Fault<T, N>> {
        if self.must_agree {
            let scaled = Array::from_fn(|i| h[i] * self.rows.units.coordinates[i]);
            self.rows.check_agreement(gamma, &scaled, &self.rows.fixed(gamma))?;
        }
        self.solve_as_given(h, gamma)
    }

    /// Solves them by the independent constraints, whether the others agree or not.
    fn solve_as_given(&self, h: &Array<T, N>, gamma: &Array<T, M>) -> Result<Solution<T, N, M>, Fault<T, N>> {
        let Rows { units, split } = &self.rows;
        let mut h = Array::from_fn(|i| h[i] * units.coordinates[i]);
        let fixed = self.rows.fixed(gamma);
        split.enter_basis(&mut h);
        let free = self.free_accelerations(&h, &fixed)?;
        let q = Array::from_fn(|i| fixed[i] + free[i]);
        let force =
            Array::from_fn(|i| if i < split.rank { dot(&self.m[i], &q) - h[i] } else { T::constant(0.0) });
        Ok(Solution {
            accelerations: self.rows.out_of_basis(q),
            multipliers: vector(self.multipliers(&force)),
            pivot: smaller(self.pivot, smallest_diagonal(split)),
            rank: split.rank,
        })
    }

    /// Returns the free accelerations from ZᵀMZ y = Zᵀ(h − M x), where x is `fixed`.
    fn free_accelerations(&self, h: &Array<T, N>, fixed: &Array<T, N>) -> Result<Array<T, N>, Fault<T, N>> {
        let zero = T::constant(0.0);
        let (rank, size) = (self.rows.split.rank, N::COUNT - self.rows.split.rank);
        if !self.are_regular() {
            return Err(Fault::Singular(undetermined(&self.rows.split, &self.along, size)));
        }
        let force =
            Array::from_fn(|i| if i < size { h[rank + i] - dot(&self.m[rank + i], fixed) } else { zero });
        let y = self.along.solve(&force);
        Ok(Array::from_fn(|i| if i < rank { zero } else { y[i - rank] }))
    }

    /// Returns λ with Fᵀλ = M q̈ − h (given in the range basis): if there are several, the one of least norm in the units of
    /// the rows.
    fn multipliers(&self, force: &Array<T, N>) -> Array<T, M> {
        let scaled = match &self.wide {
            None => self.rows.split.solve(force),
            Some(wide) => {
                let mut least = wide.solve_transposed(force);
                wide.leave_basis(&mut least);
                least
            }
        };
        Array::from_fn(|a| self.rows.units.of_row(a, scaled[a]))
    }
}

/// QR factorization of the constraint rows in natural units, each row of length 1 (or zero).
pub(crate) struct Rows<T: Element, N: StaticLength, M: StaticLength> {
    pub(crate) units: Units<T, N, M>,
    split: Qr<T, N, M>,
}

impl<T: Real, N: StaticLength, M: StaticLength> Rows<T, N, M> {
    pub(crate) fn of(m: &Array<Array<T, N>, N>, f: &Array<Array<T, N>, M>, rank: Rank<T>) -> Self {
        let units = Units::of(m, f);
        let rows = from_fn(|a| units.unit_row(a, &f[a]));
        Self { units, split: Qr::of(rows, rank.tolerance) }
    }

    /// True if the forces may be shared among rows of F in several ways.
    fn has_dependent_rows(&self, f: &Array<Array<T, N>, M>) -> bool {
        let is_zero = |row: &Array<T, N>| row.iter().all(|&entry| entry == T::constant(0.0));
        self.split.order.iter().skip(self.split.rank).any(|&row| !is_zero(&f[row]))
    }

    /// Returns true for each constraint that belongs to a largest independent set.
    pub(crate) fn independent(&self) -> Array<bool, M> {
        let Qr { order, rank, .. } = &self.split;
        from_fn(|a| order.iter().take(*rank).any(|&row| row == a))
    }

    /// Returns a basis of the null space F x = 0.
    pub(crate) fn null_space(&self) -> impl Iterator<Item = Vector<T, N>> {
        (self.split.rank..N::COUNT)
            .map(|k| self.out_of_basis(Array::from_fn(|i| T::constant(if i == k { 1.0 } else { 0.0 }))))
    }

    /// Returns the least x with F x + γ = 0 in natural units, ignoring dependent constraints.
    pub(crate) fn least(&self, gamma: &Array<T, M>) -> Vector<T, N> {
        self.out_of_basis(self.fixed(gamma))
    }

    /// Transforms from the range basis and natural units to the coordinates.
    fn out_of_basis(&self, mut x: Array<T, N>) -> Vector<T, N> {
        self.split.leave_basis(&mut x);
        vector(Array::from_fn(|i| x[i] * self.units.coordinates[i]))
    }

    /// Returns the least x with F x + γ = 0, in the range basis.
    fn fixed(&self, gamma: &Array<T, M>) -> Array<T, N> {
        self.split.solve_transposed(&self.demands(gamma))
    }

    /// Right-hand sides of the rows, −γ in natural units.
    fn demands(&self, gamma: &Array<T, M>) -> Array<T, M> {
        Array::from_fn(|a| -self.units.of_row(a, gamma[a]))
    }

    /// Returns the direction with F x = 0, of length 1 in natural units, with these weights of the basis
    /// vectors of the null space. `None` if the null space is empty.
    pub(crate) fn free_direction(&self, weight: impl Fn(usize) -> T) -> Option<Vector<T, N>> {
        let rank = self.split.rank;
        let x = Array::from_fn(|i| if i < rank { T::constant(0.0) } else { weight(i - rank) });
        let length = norm::<T>(&x);
        (rank < N::COUNT).then(|| self.out_of_basis(x.map(|x| x / length)))
    }

    /// Returns, for each dependent row, the direction of its remainder, the part that the independent rows do
    /// not span; NaN for a remainder of zero.
    pub(crate) fn remainders(&self) -> impl Iterator<Item = Vector<T, N>> {
        let split = &self.split;
        (split.rank..M::COUNT).filter_map(move |j| self.free_direction(|k| split.entry(split.rank + k, j)))
    }

    /// Returns the coefficients of a combination of rows that is dependent to first order only. The second
    /// derivative of a dependent row along a free direction differs by h from that of the independent rows. The
    /// remainder s of the row must be small: s²/(2h), the change of the combination until the remainder
    /// vanishes, must not exceed `round_off` of the constraints.
    pub(crate) fn first_order_dependence(
        &self,
        second: &Array<T, M>,
        round_off: &Array<T, M>,
    ) -> Option<Array<T, M>> {
        let (split, two) = (&self.split, T::constant(2.0));
        let (fixed, demands) = (self.fixed(second), self.demands(second));
        let size = norm(&fixed);
        (split.rank..M::COUNT).find_map(|j| {
            let bend = self.mismatch(j, &demands, &fixed, size)?;
            let (left, parts) = (split.remainder(j), split.combination(j));
            let known = |a: usize| Scalar::abs(parts[a] * self.units.of_row(a, round_off[a]));
            let known = (0..M::COUNT).fold(T::constant(0.0), |sum, a| sum + known(a));
            (left * left <= two * bend * known).then_some(parts)
        })
    }

    /// Checks that every dependent constraint agrees with the accelerations that the independent ones fix.
    fn check_agreement(
        &self,
        gamma: &Array<T, M>,
        h: &Array<T, N>,
        fixed: &Array<T, N>,
    ) -> Result<(), Fault<T, N>> {
        let (demands, size) = (self.demands(gamma), norm(fixed) + norm(h));
        let disagrees = |j: &usize| self.mismatch(*j, &demands, fixed, size).is_some();
        let at_fault = (self.split.rank..M::COUNT).find(disagrees);
        at_fault.map_or(Ok(()), |j| Err(Fault::Contradictory(self.split.order[j])))
    }

    /// Returns the disagreement of dependent row `j` with the accelerations that the independent rows fix, if
    /// it exceeds ε^(1/3) of their size.
    fn mismatch(&self, j: usize, demands: &Array<T, M>, fixed: &Array<T, N>, size: T) -> Option<T> {
        let (split, demanded) = (&self.split, demands[self.split.order[j]]);
        let given = (0..split.rank).fold(T::constant(0.0), |sum, i| sum + split.entry(i, j) * fixed[i]);
        let mismatch = Scalar::abs(demanded - given);
        (mismatch > power_of_epsilon::<T>(1.0 / 3.0) * (size + Scalar::abs(demanded))).then_some(mismatch)
    }
}

/// Replaces symmetric m by Qᵀ m Q in place: large arrays are not copied.
fn to_range_basis<T: Real, N: StaticLength, M: StaticLength>(
    split: &Qr<T, N, M>,
    m: &mut Array<Array<T, N>, N>,
) {
    for _ in 0..2 {
        for row in m.iter_mut() {
            split.enter_basis(row);
        }
        for i in 0..N::COUNT {
            for j in 0..i {
                (m[i][j], m[j][i]) = (m[j][i], m[i][j]);
            }
        }
    }
}

/// Factorizes ZᵀMZ, given QᵀMQ and its largest entry.
fn along_constraints<T: Real, N: StaticLength>(
    m: &Array<Array<T, N>, N>,
    rank: usize,
    largest: T,
) -> Symmetric<T, N> {
    let size = N::COUNT - rank;
    let mut along = Array::filled(Array::filled(T::constant(0.0)));
    for i in 0..size {
        along[i][..size].copy_from_slice(&m[rank + i][rank..]);
    }
    Symmetric::of(along, size, power_of_epsilon::<T>(0.75) * largest)
}

/// Returns the share of each coordinate in the undetermined motions.
fn undetermined<T: Real, N: StaticLength, M: StaticLength>(
    split: &Qr<T, N, M>,
    factors: &Symmetric<T, N>,
    size: usize,
) -> Array<T, N> {
    let zero = T::constant(0.0);
    let mut share = Array::filled(zero);
    for index in 0..size - factors.rank {
        let y = factors.null_vector(index);
        let mut x = Array::from_fn(|i| if i < split.rank { zero } else { y[i - split.rank] });
        split.leave_basis(&mut x);
        share = Array::from_fn(|i| larger(share[i], Scalar::abs(x[i])));
    }
    share
}

/// Returns the QR factorization of Rᵀ, with one column per constraint, for the least-norm solution of R λ = force, λ = Q R⁻ᵀ force.
fn least_norm<T: Real, N: StaticLength, M: StaticLength>(split: &Qr<T, N, M>) -> Qr<T, M, N> {
    let zero = T::constant(0.0);
    let mut transposed = Array::filled(Array::filled(zero));
    for (i, column) in transposed.iter_mut().enumerate().take(split.rank) {
        for (j, &row) in split.order.iter().enumerate().skip(i) {
            column[row] = split.entry(i, j);
        }
    }
    Qr::of(transposed, zero)
}

fn smallest_diagonal<T: Real, N: StaticLength, M: StaticLength>(split: &Qr<T, N, M>) -> T {
    (0..split.rank).fold(T::constant(1.0), |least, i| smaller(least, Scalar::abs(split.entry(i, i))))
}
