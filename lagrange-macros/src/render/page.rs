//! Shared state of the sections of a page: the system, its equations and their readings.

use rustc_hash::FxHashSet;

use super::arrays::Arrays;
use super::length::symbols;
use super::reading::{Names, Reading, constants, readings};
use crate::mechanics::Derived;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};
use crate::syntax::Declaration;

/// A system whose equations are rendered.
pub(super) struct Page<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) graph: &'a Graph,
    pub(super) problem: &'a Problem,
    pub(super) derived: &'a Derived,
    /// Number of symbols of each node, written out.
    pub(super) symbols: Vec<u64>,
    /// Rank of each parameter in the order of the fields.
    pub(super) ranks: Vec<usize>,
    /// Definitions that depend on neither time nor state.
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
