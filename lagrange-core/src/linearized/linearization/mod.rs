//! Linear system near a state, on the constraints if there are any.

mod display;
mod local;
mod spectrum;

use alloc::{string::String, vec::Vec};

use nalgebra::{DMatrix, DVector};

pub use local::LocalCoordinates;
pub(crate) use local::{change, changed, linearize_locally};
pub use spectrum::Stability;
pub(crate) use spectrum::eigenvalues;

use super::argument::check_parameters;
use super::{Linearized, StateDerivatives};
use crate::derivatives::tangent::{Matrices, Tangent, WideOf};
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Real, Scalar, Wide, larger, largest, norm, power_of_epsilon};
use crate::solution::consistent;
use crate::solution::kkt::{Rank, Rows};
use crate::system::finite::check_finite;
use crate::system::{Direction, Solution, SolutionOf, StateOf, entry, lookup};
use crate::vector::{Array, StaticLength, Vector, zeros};

/// The linear system ż = A z + B u near a state; u is the change of the inputs.
///
/// Without constraints, z is the change of the state (q, q̇). With constraints, δ(q, q̇) = Z z: the orthonormal columns
/// of [`basis`](Self::basis) Z span the tangent space of {Φ = 0, F q̇ + b = 0} in (q, q̇). Z has 2N columns, less two
/// for each independent holonomic constraint and one for each independent velocity constraint.
///
/// At an equilibrium, or along a steady motion in which only cyclic coordinates move, A is constant and its eigenvalues
/// decide on stability. Elsewhere A = Zᵀ ∂(q̇, q̈)/∂(q, q̇) Z holds at that moment only, and the motion itself has the
/// nonzero [`rate`](Self::rate). On curved constraints Z turns as the state moves; A is then only the component along Z
/// of the rate of δ(q, q̇).
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization<T> {
    /// System matrix: the change of ż per unit of z. Its size is the number of degrees of freedom of the state.
    pub a: DMatrix<T>,
    /// Input matrix, one column for each input: the change of ż per unit of the input. Without constraints its rows are
    /// (q̇, q̈), as [`states`](Self::states) names them; with constraints these are the rows of Z B.
    pub b: DMatrix<T>,
    /// Basis Z: one row for each coordinate, then for each velocity; one column for each entry of z. Without
    /// constraints, the identity.
    pub basis: DMatrix<T>,
    /// Rate (q̇, q̈) at the state itself: zero at an equilibrium.
    pub rate: DVector<T>,
    pub(super) states: Vec<String>,
    pub(super) inputs: Vec<String>,
}

impl<T> Linearization<T> {
    /// Names of the rows of [`basis`](Self::basis): coordinates and velocities. Without constraints, also of the rows
    /// and columns of A. In [local coordinates](Linearized::linearize_locally), names of the rows and columns of A.
    pub fn states(&self) -> &[String] {
        &self.states
    }

    /// Names of the inputs, in the order of the columns of B.
    pub fn inputs(&self) -> &[String] {
        &self.inputs
    }
}

/// See [`Linearized::linearize`].
pub(crate) fn linearize<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    names: &[&str],
) -> Result<Linearization<L::Scalar>, Error> {
    const { check_parameters::<L>() };
    let parameters = lookup::indices::<L>(L::PARAMETERS, "parameter", names)?;
    check_finite(system, state)?;
    consistent::check(system, state)?;
    let tangent = Tangent::at(system, state)?;
    let by_inputs = tangent.change_by(&parameters)?;
    let (basis, a, b) = if const { <L::M>::COUNT == 0 } {
        (DMatrix::identity(2 * <L::N>::COUNT, 2 * <L::N>::COUNT), tangent.change()?, by_inputs)
    } else {
        let basis = tangent.space()?;
        (basis.clone(), basis.tr_mul(&tangent.change_along(&basis)?), basis.tr_mul(&by_inputs))
    };
    let rate = state.v.iter().chain(&tangent.solution.accelerations).copied();
    Ok(Linearization {
        a,
        b,
        rate: DVector::from_iterator(2 * <L::N>::COUNT, rate),
        states: lookup::entries::<L>(),
        inputs: parameters.iter().map(|&k| L::PARAMETERS[k].into()).collect(),
        basis,
    })
}

impl<L: StateDerivatives<Scalar: Real>> Tangent<'_, L> {
    /// Derivatives of (q̇, q̈) by each entry of the state.
    fn change(&self) -> Result<DMatrix<L::Scalar>, Error> {
        let mut change = DMatrix::zeros(2 * <L::N>::COUNT, 2 * <L::N>::COUNT);
        change.view_mut((0, <L::N>::COUNT), (<L::N>::COUNT, <L::N>::COUNT)).fill_with_identity();
        self.by_arguments(1..1 + 2 * <L::N>::COUNT, |k, solution| {
            change.view_mut((<L::N>::COUNT, k - 1), (<L::N>::COUNT, 1)).copy_from(&solution.accelerations);
        })?;
        Ok(change)
    }

    /// Derivatives of (q̇, q̈) along each column of the basis.
    pub(super) fn change_along(&self, basis: &DMatrix<L::Scalar>) -> Result<DMatrix<L::Scalar>, Error> {
        let mut change = DMatrix::zeros(2 * <L::N>::COUNT, basis.ncols());
        let put = |j: usize, directions: &mut Direction<WideOf<L>, L::N>, lane: usize| {
            let changes = directions.q.iter_mut().chain(&mut directions.v).zip(basis.column(j));
            changes.for_each(|(wide, x)| wide.put(lane, *x));
        };
        let most = |j: usize| entry::<L>(basis.column(j).icamax());
        change
            .view_mut((0, 0), (<L::N>::COUNT, basis.ncols()))
            .copy_from(&basis.view((<L::N>::COUNT, 0), (<L::N>::COUNT, basis.ncols())));
        self.along_each(basis.ncols(), put, most, |j, solution| {
            change.view_mut((<L::N>::COUNT, j), (<L::N>::COUNT, 1)).copy_from(&solution.accelerations);
        })?;
        Ok(change)
    }

    /// Derivatives of (q̇, q̈) by each of these parameters.
    pub(super) fn change_by(&self, parameters: &[usize]) -> Result<DMatrix<L::Scalar>, Error>
    where
        L: Linearized,
    {
        let mut change = DMatrix::zeros(2 * <L::N>::COUNT, parameters.len());
        if const { <L::M>::COUNT > 0 } {
            parameters.iter().try_for_each(|&k| self.stays_on_constraints(k))?;
        }
        self.by_parameters(
            parameters.len(),
            |j| parameters[j],
            |j, solution| {
                change.view_mut((<L::N>::COUNT, j), (<L::N>::COUNT, 1)).copy_from(&solution.accelerations);
            },
        )?;
        Ok(change)
    }

    /// Orthonormal basis of the changes (δq, δv) with F δq = 0 for holonomic constraints and δ(F v + b) = 0 for all.
    pub(super) fn space(&self) -> Result<DMatrix<L::Scalar>, Error> {
        let zero = zeros();
        let mut changes: Vec<[Vector<L::Scalar, L::N>; 2]> = Vec::new();
        let holonomic = Rows::of(&self.matrices().m, &self.holonomic_rows(), Rank::off_constraints());
        for q in holonomic.null_space() {
            // A change of q changes F: the velocity must follow.
            let entry = entry::<L>(q.icamax());
            let turned = self.residual_change(&Direction { q, ..Direction::zero() }, entry)?;
            changes.push([q, self.matrices().factors.rows.least(&turned.rate.into())]);
        }
        changes.extend(self.matrices().factors.rows.null_space().map(|v| [zero, v]));
        let columns: Vec<_> = changes
            .iter()
            .map(|[q, v]| {
                let change = DVector::from_iterator(2 * <L::N>::COUNT, q.iter().chain(v).copied());
                let length = norm(change.as_slice());
                change / length
            })
            .collect();
        match columns.is_empty() {
            true => Ok(DMatrix::zeros(2 * <L::N>::COUNT, 0)),
            false => Ok(DMatrix::from_columns(&columns).qr().q()),
        }
    }

    /// Rejects an input that shifts a constraint: after the change, the given state or its acceleration violates the
    /// constraint.
    fn stays_on_constraints(&self, k: usize) -> Result<(), Error>
    where
        L: Linearized,
    {
        let (input, zero) = (L::PARAMETERS[k], L::Scalar::constant(0.0));
        let first_shifted = |solution: &SolutionOf<L>| -> Result<_, Error> {
            let change = self.change_by_parameter(solution, k)?;
            let levels = |a: usize| [change.position[a], change.rate[a], change.acceleration[a]];
            Ok((0..<L::M>::COUNT).find(|&a| levels(a) != [zero; 3]))
        };
        if first_shifted(&self.solution)?.is_none() {
            return Ok(());
        }
        match first_shifted(&self.without_round_off()?)? {
            None => Ok(()),
            Some(a) => Err(Error::InputShiftsConstraint { input, constraint: L::CONSTRAINTS[a] }),
        }
    }

    /// Accelerations and multipliers at the state. Accelerations are replaced by zero if they are mere round-off: if
    /// the forces balance to √ε of their terms, in units in which masses are 1.
    fn without_round_off(&self) -> Result<SolutionOf<L>, Error> {
        let (Tangent { state, solution, .. }, Matrices { m, f, factors }) = (self, self.matrices());
        let zero = L::Scalar::constant(0.0);
        let strongest = |force: &dyn Fn(usize) -> L::Scalar| {
            largest(&Array::<_, L::N>::from_fn(|i| force(i) * factors.rows.units.coordinates[i]))
        };
        let mut terms = (0..<L::M>::COUNT)
            .fold(zero, |most, a| larger(most, strongest(&|i| f[a][i] * solution.multipliers[a])));
        for (j, name) in L::COORDINATES.iter().enumerate() {
            let change = self.residual_change(&Direction::of_coordinate(j), Entry::Coordinate(name))?;
            terms = larger(terms, strongest(&|i| change.motion[i] * state.q[j]));
        }
        let left =
            strongest(&|i| (0..<L::N>::COUNT).fold(zero, |sum, j| sum + m[i][j] * solution.accelerations[j]));
        let rests = left <= power_of_epsilon::<L::Scalar>(0.5) * terms;
        let accelerations = if rests { zeros() } else { solution.accelerations };
        Ok(Solution { accelerations, ..*solution })
    }
}
