//! σ of a constraint in its own units: the inertia of what it ties, over the square of its row.

use num_traits::One;

use super::{Search, tied};
use crate::symbolic::{Function, Id, Rational, Symbol};
use crate::variables::Variable;

/// Values that differ by less are those of one expression of the parameters.
const SAME: f64 = 1e-9;
/// What cancels in a trace must leave so much of it.
const LEFT: f64 = 0.1;

impl Search<'_> {
    /// tr M/|F|², over the coordinates that the row ties.
    pub(super) fn weight(&mut self, a: usize) -> Id {
        let inertia = match &self.inertia(a)[..] {
            [] => Id::ONE,
            diagonal => self.trace(diagonal),
        };
        let squares: Vec<_> =
            self.jacobian[a].iter().map(|&entry| (self.graph.square(entry), Rational::one())).collect();
        let square = self.graph.sum(squares);
        let [inertia, square] = [inertia, square].map(|part| self.at_a_fixed_state(part));
        let quotient = self.graph.div(inertia, square);
        self.at_a_fixed_state(quotient)
    }

    /// The diagonal of M over the coordinates that a row ties. Where these have no mass, over those that other rows tie
    /// to them.
    fn inertia(&self, a: usize) -> Vec<Id> {
        let mut near = tied(&self.jacobian[a]);
        loop {
            let diagonal = near.iter().map(|&i| self.mass[i][i]).filter(|&mass| mass != Id::ZERO);
            let diagonal: Vec<Id> = diagonal.collect();
            let rows = self.jacobian.iter().filter(|row| near.iter().any(|&i| row[i] != Id::ZERO));
            let mut wider: Vec<usize> = rows.flat_map(|row| tied(row)).collect();
            wider.sort_unstable();
            wider.dedup();
            if !diagonal.is_empty() || wider.len() == near.len() {
                return diagonal;
            }
            near = wider;
        }
    }

    /// Of an indefinite M the absolute values, where too little is left else.
    fn trace(&mut self, diagonal: &[Id]) -> Id {
        let graph = &mut *self.graph;
        let mut sum =
            |terms: &[Id]| graph.sum(terms.iter().map(|&term| (term, Rational::one())).collect::<Vec<_>>());
        let trace = sum(diagonal);
        let absolute: Vec<Id> = diagonal.iter().map(|&mass| graph.function(Function::Abs, mass)).collect();
        let sizes = graph.sum(absolute.iter().map(|&size| (size, Rational::one())).collect::<Vec<_>>());
        let graph = &*self.graph;
        let is_large =
            self.states.iter_mut().all(|state| state.value(graph, trace) > LEFT * state.value(graph, sizes));
        if is_large { trace } else { sizes }
    }

    /// The same at a state of zeros and ones or halves, if at every state the value is that one's: then it is an
    /// expression of the parameters. The trace of a body's inertia is the same in all orientations.
    fn at_a_fixed_state(&mut self, root: Id) -> Id {
        let is_moving = |symbol: &Symbol| !matches!(Variable::of(*symbol), Variable::Parameter(_));
        let moving: Vec<Symbol> = self.graph.symbols(&[root]).filter(is_moving).collect();
        let ones = moving.iter().map(|&one| move |symbol| symbol == one);
        for one in ones {
            let number = |symbol: Symbol| if one(symbol) { Id::ONE } else { Id::ZERO };
            let fixed = self.graph.substituted(root, |symbol| is_moving(&symbol).then(|| number(symbol)));
            if self.graph.take_fault().is_none() && self.is_same(root, fixed) {
                return fixed;
            }
        }
        root
    }

    fn is_same(&mut self, root: Id, other: Id) -> bool {
        let graph = &*self.graph;
        self.states.iter_mut().all(|state| {
            let [x, y] = [root, other].map(|root| state.value(graph, root));
            (x - y).abs() <= SAME * x.abs()
        })
    }
}
