//! Terms of the equations of motion that plain coordinates and frames derive in different ways.

use super::form::Form;
use crate::symbolic::{Forward, Graph, Id};

pub(super) trait Formulation {
    /// M and h, with the accelerations as the only variables.
    fn mass_and_forcing(&self, graph: &mut Graph) -> (Vec<Vec<Id>>, Vec<Id>);

    /// dp/dt − ∂L/∂q − Q, with accelerations as symbols. It is derived without the entries of M, so that its cost is
    /// that of the Lagrangian.
    fn balance(&self, graph: &mut Graph) -> Vec<Id>;

    /// Time derivative at q̈ = 0
    fn drift(&self, graph: &mut Graph) -> Forward;

    /// Row of the constraint Jacobian F that belongs to a constraint
    fn jacobian_row(&self, graph: &mut Graph, constraint: Id) -> Vec<Id>;

    /// Equivalent quadratic forms with more variables than the accelerations.
    fn forms(&self, graph: &mut Graph) -> Vec<Form>;
}
