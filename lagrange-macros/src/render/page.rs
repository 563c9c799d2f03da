//! The system, its equations and their readings, from which every section is written.

use rustc_hash::FxHashSet;

use super::arrays::Arrays;
use super::length::symbols;
use super::reading::{Names, Reading, constants, readings};
use crate::mechanics::Derived;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};
use crate::syntax::Declaration;

/// Equations of a system while they are typeset.
pub(super) struct Page<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) graph: &'a Graph,
    pub(super) problem: &'a Problem,
    pub(super) derived: &'a Derived,
    /// How many each node takes.
    pub(super) symbols: Vec<u64>,
    /// Where each parameter stands among the fields.
    pub(super) ranks: Vec<usize>,
    /// The definitions that neither the time nor the state changes.
    pub(super) constants: FxHashSet<Id>,
    pub(super) names: Names,
    pub(super) readings: Vec<Reading<'a>>,
    pub(super) arrays: Arrays,
}

impl<'a> Page<'a> {
    pub(super) fn new(
        declaration: &'a Declaration,
        graph: &'a Graph,
        problem: &'a Problem,
        derived: &'a Derived,
        names: Names,
    ) -> Self {
        let constants = constants(graph, problem);
        Self {
            declaration,
            graph,
            problem,
            derived,
            symbols: symbols(graph, problem),
            ranks: ranks(problem),
            names,
            readings: readings(graph, problem, derived, &constants, names),
            constants,
            arrays: Arrays::of(problem),
        }
    }
}

fn ranks(problem: &Problem) -> Vec<usize> {
    let order = problem.parameters.by_field();
    let mut ranks = vec![0; order.len()];
    order.into_iter().enumerate().for_each(|(rank, parameter)| ranks[parameter] = rank);
    ranks
}
