//! Accelerations and multipliers at a state, by the fast elimination if it is reliable, else by the general
//! solver.

use nalgebra::ComplexField;

use crate::error::Error;
use crate::names::{Names, Row, name};
use crate::number::{Real, Scalar, larger};
use crate::solution::consistent::{dependence, gradient};
use crate::solution::kkt::{self, Fault, KktSystem, Rank, Solved};
use crate::solution::limits::NAMED;
use crate::solution::pivot::{is_trustworthy, least_pivot};
use crate::solution::reason::reason;
use crate::system::finite::check_finite;
use crate::system::{Lagrangian, Solution, SolutionOf, StateOf};
use crate::vector::{Array, StaticLength, Vector, rows};

/// Implements [`Simulate::solve`](crate::Simulate::solve).
#[inline]
pub(crate) fn solve<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<SolutionOf<L>, Error> {
    check_finite(system, state)?;
    if const { <L::M>::COUNT > 0 } {
        gradient::check_parameters(system, state)?;
    }
    let solution = solve_near(system, state, None, |solution, _| *solution)
        .map_err(|error| reason(system, state, error))?;
    if !solution.multipliers_are_unique() {
        gradient::check(system, state)?;
    }
    let is_independent = solution.multipliers_are_unique() && solution.pivot > dependence::least_pivot();
    if const { <L::M>::COUNT > 0 } && !is_independent {
        dependence::check(system, state)?;
    }
    Ok(solution)
}

/// Passes the solution and the active constraints to `read` by reference, and returns its result: the solution
/// is not moved.
///
/// `active` marks the constraints that are independent at a nearby consistent state; the solution then uses
/// only these. Off the constraints, by the error of a stage, the others may look independent too, but they
/// demand only that error.
#[inline(always)]
pub(crate) fn solve_near<L: Lagrangian<Scalar: Real>, R>(
    system: &L,
    state: &StateOf<L>,
    active: Option<&Array<bool, L::M>>,
    read: impl FnOnce(&SolutionOf<L>, &Array<bool, L::M>) -> R,
) -> Result<R, Error> {
    let (active, rank) = match active {
        Some(active) if active.contains(&false) => (active, Rank::off_constraints()),
        _ => {
            let solution = system.accelerations_unchecked(state);
            if is_trustworthy(&solution) {
                return Ok(read(&solution, &Array::filled(true)));
            }
            (&Array::filled(true), Rank::on_constraints())
        }
    };
    let forces = (system.forcing(state), system.constraint_bias(state));
    let (solution, active) = solve_in_general(system, state, forces, active, rank)?;
    Ok(read(&solution, &active))
}

/// Solves M x = h + Fᵀλ and F x + γ = 0 with M and F of a state by the general solver. Also returns which of
/// the `active` constraints determine the solution.
#[cold]
pub(crate) fn solve_in_general<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    (h, gamma): (Vector<L::Scalar, L::N>, Vector<L::Scalar, L::M>),
    active: &Array<bool, L::M>,
    rank: Rank<L::Scalar>,
) -> Result<Solved<L::Scalar, L::N, L::M>, Error> {
    let (m, f) = (system.mass_matrix(state).into(), rows(&system.constraint_jacobian(state)));
    let mut equations = KktSystem { m, h: h.into(), f, gamma: gamma.into() };
    let time = state.t.to_f64();
    if let Some(row) = system.slides() {
        return Err(without_force::<L>(&system.accelerations_unchecked(state), row, time));
    }
    let compliance = system.compliance();
    let is_off = |a: usize| compliance[a] != L::Scalar::constant(0.0);
    for a in (0..<L::M>::COUNT).filter(|&a| is_off(a)) {
        equations.gamma[a] = L::Scalar::constant(0.0);
    }
    if let Some(row) = not_finite::<L>(&equations) {
        return Err(Error::EquationsNotFinite { row, time });
    }
    for a in (0..<L::M>::COUNT).filter(|&a| !active[a]) {
        (equations.f[a], equations.gamma[a]) =
            (Array::filled(L::Scalar::constant(0.0)), L::Scalar::constant(0.0));
    }
    let mut solved = kkt::solve(&equations, rank).map_err(|found| fault::<L>(&found, time))?;
    for a in (0..<L::M>::COUNT).filter(|&a| is_off(a)) {
        solved.0.multipliers[a] = -gamma[a];
        solved.0.rank += 1;
    }
    let Solution { accelerations, multipliers, .. } = &solved.0;
    match first_row::<L>(|i| !accelerations[i].is_finite(), |a| !multipliers[a].is_finite()) {
        None => Ok(solved),
        Some(row) => Err(Error::EquationsNotFinite { row, time }),
    }
}

/// Why the elimination is not to be trusted where friction slides that is a multiple of a multiplier.
fn without_force<L: Lagrangian<Scalar: Real>>(solution: &SolutionOf<L>, row: usize, time: f64) -> Error {
    let Solution { accelerations, multipliers, pivot, .. } = solution;
    let not_finite = first_row::<L>(|i| !accelerations[i].is_finite(), |a| !multipliers[a].is_finite());
    match not_finite.filter(|_| *pivot > least_pivot()) {
        Some(row) => Error::EquationsNotFinite { row, time },
        None => Error::FrictionJams { friction: name(L::CONSTRAINTS, row), time },
    }
}

/// Converts a fault of the general solver to an error with names.
pub(crate) fn fault<L: Lagrangian<Scalar: Real>>(fault: &Fault<L::Scalar, L::N>, time: f64) -> Error {
    match fault {
        Fault::Singular(share) => Error::Singular { coordinates: most_involved::<L>(share), time },
        Fault::Contradictory(row) => Error::Contradictory { constraint: name(L::CONSTRAINTS, *row), time },
    }
}

/// Returns the first row that is not finite.
pub(crate) fn not_finite<L: Lagrangian<Scalar: Real>>(e: &KktSystem<L::Scalar, L::N, L::M>) -> Option<Row> {
    let finite =
        |row: &Array<L::Scalar, L::N>, rhs: L::Scalar| row.iter().all(|x| x.is_finite()) && rhs.is_finite();
    first_row::<L>(|i| !finite(&e.m[i], e.h[i]), |a| !finite(&e.f[a], e.gamma[a]))
}

/// Returns the first coordinate, or else the first constraint, that satisfies its predicate.
pub(crate) fn first_row<L: Lagrangian>(
    coordinate: impl Fn(usize) -> bool,
    constraint: impl Fn(usize) -> bool,
) -> Option<Row> {
    let coordinate = (0..<L::N>::COUNT).find(|&i| coordinate(i)).map(|i| Row::Coordinate(L::COORDINATES[i]));
    let constraint =
        || (0..<L::M>::COUNT).find(|&a| constraint(a)).map(|a| Row::Constraint(L::CONSTRAINTS[a]));
    coordinate.or_else(constraint)
}

/// Returns the coordinate or constraint of row `i`: rows of the motion come first, then those of all constraints, level by
/// level.
pub(crate) fn row<L: Lagrangian>(i: usize) -> Row {
    match i.checked_sub(<L::N>::COUNT) {
        None => Row::Coordinate(L::COORDINATES[i]),
        Some(a) => Row::Constraint(L::CONSTRAINTS[a % <L::M>::COUNT]),
    }
}

/// Returns the coordinates whose share in the undetermined motions is the largest, or not much less.
fn most_involved<L: Lagrangian<Scalar: Real>>(share: &Array<L::Scalar, L::N>) -> Names {
    let largest = share.iter().copied().fold(L::Scalar::constant(0.0), larger);
    let least = largest * L::Scalar::constant(NAMED);
    (0..<L::N>::COUNT).filter(|&i| share[i] >= least).map(|i| L::COORDINATES[i]).collect()
}
