//! Random states, and what M and F are there.

use super::pivots::{Matrix, add_square};
use crate::mechanics::ConstraintKind;
use crate::mechanics::constraints::Constraints;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Sample, Symbol};
use crate::variables::{Variable, has_velocity, symbols};

/// So many states are looked at, and so many draws made to find them.
const STATES: usize = 4;
const DRAWS: u64 = 32;

pub(super) struct State {
    sample: Sample,
    pub(super) mass: Matrix,
    /// F
    pub(super) jacobian: Matrix,
}

/// Where M and F are looked at.
pub(super) struct Space<'e> {
    pub(super) graph: &'e Graph,
    pub(super) problem: &'e Problem,
    pub(super) mass: &'e [Vec<Id>],
    pub(super) constraints: &'e Constraints,
}

impl Space<'_> {
    /// States that no constraint restricts.
    pub(super) fn anywhere(&self) -> Vec<State> {
        self.drawn(|_| Some(()))
    }

    /// States with Φ = 0 and, where M depends on velocities, F q̇ + b = 0.
    pub(super) fn on_constraints(&self) -> Vec<State> {
        let Constraints { kinds, residual, rate, jacobian, .. } = self.constraints;
        let holonomic: Vec<usize> =
            (0..kinds.len()).filter(|&a| kinds[a] == ConstraintKind::Holonomic).collect();
        let residual: Vec<Id> = holonomic.iter().map(|&a| residual[a]).collect();
        let slopes: Vec<&[Id]> = holonomic.iter().map(|&a| &jacobian[a][..]).collect();
        let rows: Vec<&[Id]> = jacobian.iter().map(Vec::as_slice).collect();
        let is_moving = has_velocity(self.graph, &self.mass.concat());
        self.drawn(|sample| {
            sample.project(self.graph, &residual, &slopes, &self.symbols(Variable::Coordinate))?;
            if is_moving {
                sample.project(self.graph, rate, &rows, &self.symbols(Variable::Velocity))?;
            }
            Some(())
        })
    }

    fn drawn(&self, settle: impl Fn(&mut Sample) -> Option<()>) -> Vec<State> {
        let Constraints { residual, rate, jacobian, .. } = self.constraints;
        let roots = [&self.mass.concat(), &jacobian.concat(), residual, rate].map(Vec::as_slice).concat();
        let symbols: Vec<Symbol> =
            self.graph.symbols(&roots).chain(self.symbols(Variable::Coordinate)).collect();
        let states = (0..DRAWS).filter_map(|draw| {
            let mut sample = Sample::new(symbols.iter().copied(), draw, |symbol| self.problem.range(symbol));
            settle(&mut sample)?;
            State::new(self, sample)
        });
        states.take(STATES).collect()
    }

    fn symbols(&self, variable: fn(usize) -> Variable) -> Vec<Symbol> {
        symbols(self.mass.len(), variable)
    }
}

impl State {
    /// `None` where an entry is no number.
    fn new(space: &Space, mut sample: Sample) -> Option<Self> {
        let mut matrix = |rows: &[Vec<Id>]| {
            let values = |row: &Vec<Id>| sample.values(space.graph, row).iter().map(|x| x.value).collect();
            let matrix: Matrix = rows.iter().map(values).collect();
            matrix.iter().flatten().all(|x| x.is_finite()).then_some(matrix)
        };
        let (mass, jacobian) = (matrix(space.mass)?, matrix(&space.constraints.jacobian)?);
        Some(Self { sample, mass, jacobian })
    }

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
