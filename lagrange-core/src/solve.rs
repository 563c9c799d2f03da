//! Accelerations and multipliers at a state, by the fast elimination where it can be trusted.

use nalgebra::ComplexField;

use crate::kkt::{self, Contradictions, Equations, Fault};
use crate::names::Row;
use crate::numeric::{larger, power_of_epsilon};
use crate::{Error, Lagrangian, Names, Real, Scalar, Solution, State};

/// See [`Simulate::solve`](crate::Simulate::solve).
#[inline]
pub(crate) fn solve<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<Solution<L::Scalar, N, M>, Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let solution = system.accelerations(state);
    if is_trustworthy(&solution) { Ok(solution) } else { solve_in_general(system, state) }
}

/// Whether the elimination lost at most a third of the digits, by its smallest pivot, and all is finite.
pub(crate) fn is_trustworthy<T: Real, const N: usize, const M: usize>(s: &Solution<T, N, M>) -> bool {
    s.pivot > power_of_epsilon(1.0 / 3.0)
        && s.accelerations.iter().all(|x| x.is_finite())
        && s.multipliers.iter().all(|x| x.is_finite())
}

#[cold]
fn solve_in_general<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<Solution<L::Scalar, N, M>, Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let equations = Equations {
        m: system.mass_matrix(state).into(),
        h: system.forcing(state).into(),
        f: system.constraint_jacobian(state).transpose().into(),
        gamma: system.constraint_bias(state).into(),
    };
    let time = state.t.to_f64();
    if let Some(row) = not_finite::<L, N, M>(&equations) {
        return Err(Error::EquationsNotFinite { row, time });
    }
    kkt::solve(&equations, Contradictions::Fault).map_err(|fault| match fault {
        Fault::Singular(share) => Error::Singular { coordinates: most_involved::<L, N, M>(&share), time },
        Fault::Contradictory(row) => Error::Contradictory { constraint: name(&L::CONSTRAINTS, row), time },
    })
}

/// The first row that is not finite.
fn not_finite<L, const N: usize, const M: usize>(e: &Equations<L::Scalar, N, M>) -> Option<Row>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let finite = |row: &[L::Scalar; N], rhs: L::Scalar| row.iter().all(|x| x.is_finite()) && rhs.is_finite();
    let coordinate = (0..N).find(|&i| !finite(&e.m[i], e.h[i])).map(|i| Row::Coordinate(L::COORDINATES[i]));
    let constraint =
        || (0..M).find(|&a| !finite(&e.f[a], e.gamma[a])).map(|a| Row::Constraint(L::CONSTRAINTS[a]));
    coordinate.or_else(constraint)
}

/// The coordinates that take part with at least a tenth of the largest share.
fn most_involved<L, const N: usize, const M: usize>(share: &[L::Scalar; N]) -> Names
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let largest = share.iter().copied().fold(L::Scalar::constant(0.0), larger);
    let least = largest * L::Scalar::constant(0.1);
    (0..N).filter(|&i| share[i] >= least).map(|i| L::COORDINATES[i]).collect()
}

/// The name of this index.
pub(crate) fn name<const K: usize>(names: &[&'static str; K], index: usize) -> &'static str {
    names.get(index).copied().unwrap_or("?")
}
