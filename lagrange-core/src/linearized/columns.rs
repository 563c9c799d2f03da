//! Jacobian by selected arguments, chosen by name.

use alloc::{format, string::String, vec::Vec};

use nalgebra::DMatrix;

use super::Linearized;
use super::argument::Argument;
use super::tangent::{Tangent, WideOf};
use crate::error::Error;
use crate::number::{Real, Scalar, Wide};
use crate::system::{Direction, Solution, State};

/// Accelerations and multipliers at a state, with their partial derivatives by selected arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct SelectedJacobian<T, const N: usize, const M: usize> {
    /// Accelerations and multipliers.
    pub solution: Solution<T, N, M>,
    /// Derivatives of the accelerations q̈: one row per coordinate, one column per argument.
    pub accelerations: DMatrix<T>,
    /// Derivatives of the multipliers λ: one row per constraint, one column per argument. If constraints are dependent,
    /// the change of least norm.
    pub multipliers: DMatrix<T>,
    arguments: Vec<String>,
}

impl<T, const N: usize, const M: usize> SelectedJacobian<T, N, M> {
    /// Names of the arguments, in the order of the columns.
    pub fn arguments(&self) -> &[String] {
        &self.arguments
    }
}

/// See [`Linearized::jacobian_by`].
pub(super) fn jacobian_by<L, const N: usize, const M: usize, const P: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    names: &[&str],
) -> Result<SelectedJacobian<L::Scalar, N, M>, Error>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    let arguments = Argument::named::<L, N, M, P>(names)?;
    let tangent = Tangent::at(system, state)?;
    let mut accelerations = DMatrix::zeros(N, arguments.len());
    let mut multipliers = DMatrix::zeros(M, arguments.len());
    let mut set = |column: usize, change: &Solution<L::Scalar, N, M>| {
        accelerations.set_column(column, &change.accelerations);
        multipliers.set_column(column, &change.multipliers);
    };
    let (of_state, parameters): (Vec<_>, Vec<_>) =
        arguments.iter().enumerate().partition(|(_, argument)| !matches!(argument, Argument::Parameter(_)));
    let one = L::Scalar::constant(1.0);
    let put = |j: usize, directions: &mut Direction<WideOf<L, N, M>, N>, lane: usize| match *of_state[j].1 {
        Argument::Coordinate(i) => directions.q[i].put(lane, one),
        Argument::Velocity(i) => directions.v[i].put(lane, one),
        Argument::Parameter(_) => {}
    };
    let entry = |j: usize| of_state[j].1.entry::<L, N, M, P>();
    tangent.along_each(of_state.len(), put, entry, |j, change| set(of_state[j].0, change))?;
    let parameter = |j: usize| match *parameters[j].1 {
        Argument::Parameter(k) => k,
        _ => 0,
    };
    tangent.by_parameters(parameters.len(), parameter, |j, change| set(parameters[j].0, change))?;
    let names = arguments.iter().map(|argument| format!("{}", argument.entry::<L, N, M, P>())).collect();
    Ok(SelectedJacobian { solution: tangent.solution, accelerations, multipliers, arguments: names })
}
