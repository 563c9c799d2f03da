//! Terms of the equations of motion that plain coordinates and frames derive in different ways.

use super::form::Form;
use crate::symbolic::{Forward, Graph, Id};

pub(super) trait Formulation {
    /// M and h, over the accelerations alone.
    fn mass_and_forcing(&self, graph: &mut Graph) -> (Vec<Vec<Id>>, Vec<Id>);

    /// dp/dt − ∂L/∂q − Q, with accelerations as symbols: not by the entries of M, so that it costs as much as the Lagrangian.
    fn balance(&self, graph: &mut Graph) -> Vec<Id>;

    /// d/dt where q̈ = 0
    fn drift(&self, graph: &mut Graph) -> Forward;

    /// F of a constraint
    fn jacobian_row(&self, graph: &mut Graph, constraint: Id) -> Vec<Id>;

    /// The forms over more variables than the accelerations.
    fn forms(&self, graph: &mut Graph) -> Vec<Form>;
}
