//! Jacobian by selected arguments, chosen by name.

use alloc::{format, string::String, vec::Vec};

use nalgebra::DMatrix;

use crate::derivatives::tangent::Tangent;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::argument::Argument;
use crate::number::Real;
use crate::system::{Solution, SolutionOf, StateOf};
use crate::vector::{Element, StaticLength};

/// Accelerations and multipliers at a state, with their partial derivatives by selected arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct SelectedJacobian<T: Element, N: StaticLength, M: StaticLength> {
    /// Accelerations and multipliers.
    pub solution: Solution<T, N, M>,
    /// Derivatives of the accelerations q̈: one row per coordinate, one column per argument.
    pub accelerations: DMatrix<T>,
    /// Derivatives of the multipliers λ: one row per constraint, one column per argument. If constraints are dependent,
    /// the change of least norm in units in which the rows of F have length 1.
    pub multipliers: DMatrix<T>,
    arguments: Vec<String>,
}

impl<T: Element, N: StaticLength, M: StaticLength> SelectedJacobian<T, N, M> {
    /// Names of the arguments, in the order of the columns.
    pub fn arguments(&self) -> &[String] {
        &self.arguments
    }
}

/// See [`Linearized::jacobian_by`].
pub(crate) fn jacobian_by<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    names: &[&str],
) -> Result<SelectedJacobian<L::Scalar, L::N, L::M>, Error> {
    let arguments = Argument::named::<L>(names)?;
    let tangent = Tangent::at(system, state)?;
    let mut accelerations = DMatrix::zeros(<L::N>::COUNT, arguments.len());
    let mut multipliers = DMatrix::zeros(<L::M>::COUNT, arguments.len());
    let mut set = |column: usize, change: &SolutionOf<L>| {
        accelerations.set_column(column, &change.accelerations);
        multipliers.set_column(column, &change.multipliers);
    };
    let (mut of_state, mut parameters) = (Vec::new(), Vec::new());
    for (column, argument) in arguments.iter().enumerate() {
        match *argument {
            Argument::Coordinate(i) => of_state.push((column, 1 + i)),
            Argument::Velocity(i) => of_state.push((column, 1 + <L::N>::COUNT + i)),
            Argument::Parameter(k) => parameters.push((column, k)),
        }
    }
    tangent.by_each(of_state.len(), |j| of_state[j].1, |j, change| set(of_state[j].0, change))?;
    tangent.by_parameters(parameters.len(), |j| parameters[j].1, |j, change| set(parameters[j].0, change))?;
    let names = arguments.iter().map(|argument| format!("{}", argument.entry::<L>())).collect();
    Ok(SelectedJacobian { solution: tangent.solution, accelerations, multipliers, arguments: names })
}
