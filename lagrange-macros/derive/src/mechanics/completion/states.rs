//! Random states, with the values of M and F.

use super::pivots::{Matrix, add_square};
use super::system::System;
use crate::mechanics::ConstraintKind;
use crate::symbolic::{Graph, Id, Sample, Symbol};
use crate::variables::{Variable, has_velocity, symbols};

/// Largest number of random draws in the search for states.
const DRAWS: u64 = 32;

pub(super) struct State {
    sample: Sample,
    pub(super) mass: Matrix,
    /// Value of F, row by row
    pub(super) jacobian: Matrix,
}

impl System<'_> {
    /// Random states with Φ = 0 and, if M depends on velocities, F q̇ + b = 0, for the constraints `rows` only. The
    /// constraints that do not complete M are ignored, because a long chain of joints is hard to close.
    pub(super) fn states<'a>(
        &'a self,
        graph: &'a Graph,
        rows: &[usize],
    ) -> impl Iterator<Item = State> + use<'a> {
        let constraints = self.constraints;
        let is_holonomic = |a: &usize| constraints.kinds[*a] == ConstraintKind::Holonomic;
        let places: Vec<usize> = rows.iter().copied().filter(is_holonomic).collect();
        let is_moving = has_velocity(graph, &self.mass.concat());
        let rates = if is_moving { rows.to_vec() } else { Vec::new() };
        let symbols: Vec<Symbol> = self.symbols(graph);
        (0..DRAWS).filter_map(move |draw| {
            let mut sample =
                Sample::new(symbols.iter().copied(), draw, |symbol, draw| self.problem.drawn(symbol, draw));
            self.settle(graph, &mut sample, &constraints.residual, &places, Variable::Coordinate)?;
            self.settle(graph, &mut sample, &constraints.rate, &rates, Variable::Velocity)?;
            self.state(graph, sample)
        })
    }

    /// All symbols that M, F and the constraints depend on.
    fn symbols(&self, graph: &Graph) -> Vec<Symbol> {
        let (n, constraints) = (self.mass.len(), self.constraints);
        let matrices = self.mass.iter().chain(&constraints.jacobian).flatten();
        let roots: Vec<Id> =
            matrices.chain(&constraints.residual).chain(&constraints.rate).copied().collect();
        graph.symbols(&roots).chain(symbols(n, Variable::Coordinate)).collect()
    }

    /// Projects the sample onto the states where `rows` of `equations` hold.
    fn settle(
        &self,
        graph: &Graph,
        sample: &mut Sample,
        equations: &[Id],
        rows: &[usize],
        unknown: fn(usize) -> Variable,
    ) -> Option<()> {
        let equations: Vec<Id> = rows.iter().map(|&a| equations[a]).collect();
        let slopes: Vec<&[Id]> = rows.iter().map(|&a| &self.constraints.jacobian[a][..]).collect();
        sample.project(graph, &equations, &slopes, &symbols(self.mass.len(), unknown))
    }

    /// Evaluates M and F; `None` if an entry is not finite.
    fn state(&self, graph: &Graph, mut sample: Sample) -> Option<State> {
        let mut matrix = |rows: &[Vec<Id>]| {
            let values = |row: &Vec<Id>| sample.values(graph, row).iter().map(|x| x.value).collect();
            let matrix: Matrix = rows.iter().map(values).collect();
            matrix.iter().flatten().all(|x| x.is_finite()).then_some(matrix)
        };
        let (mass, jacobian) = (matrix(self.mass)?, matrix(&self.constraints.jacobian)?);
        Some(State { sample, mass, jacobian })
    }
}

impl State {
    pub(super) fn value(&mut self, graph: &Graph, root: Id) -> f64 {
        self.sample.values(graph, &[root])[0].value
    }

    /// M + FᵀσF
    pub(super) fn completed(&mut self, graph: &Graph, rows: &[(usize, Id)]) -> Matrix {
        let mut matrix = self.mass.clone();
        for &(a, weight) in rows {
            let weight = self.value(graph, weight);
            add_square(&mut matrix, weight, &self.jacobian[a]);
        }
        matrix
    }
}
