//! σ of a constraint in its own units: the inertia of what it ties, over the square of its row.

use num_traits::One;

use super::states::State;
use super::{System, tied};
use crate::symbolic::{Function, Graph, Id, Rational, Symbol};
use crate::variables::Variable;

/// Values that differ by less are those of one expression of the parameters.
const SAME: f64 = 1e-9;
/// What cancels in a trace must leave so much of it.
const LEFT: f64 = 0.1;

impl System<'_> {
    /// About the value of σ at a state.
    pub(super) fn size(&self, state: &State, a: usize) -> f64 {
        let heavy = self.heavy(a);
        let inertia =
            if heavy.is_empty() { 1.0 } else { heavy.iter().map(|&i| state.mass[i][i].abs()).sum() };
        inertia / state.jacobian[a].iter().map(|x| x * x).sum::<f64>()
    }

    /// The coordinates with a mass that a row ties. Where it ties none, those that other rows tie to these.
    fn heavy(&self, a: usize) -> Vec<usize> {
        let jacobian = &self.constraints.jacobian;
        let mut near = tied(&jacobian[a]);
        loop {
            let heavy: Vec<usize> = near.iter().copied().filter(|&i| self.mass[i][i] != Id::ZERO).collect();
            let rows = jacobian.iter().filter(|row| near.iter().any(|&i| row[i] != Id::ZERO));
            let mut wider: Vec<usize> = rows.flat_map(|row| tied(row)).collect();
            wider.sort_unstable();
            wider.dedup();
            if !heavy.is_empty() || wider.len() == near.len() {
                return heavy;
            }
            near = wider;
        }
    }
}

pub(super) struct Weights<'e> {
    pub(super) graph: &'e mut Graph,
    /// States on the constraints.
    pub(super) states: &'e mut [State],
}

impl Weights<'_> {
    /// tr M/|F|², over the coordinates that the row ties.
    pub(super) fn of(&mut self, system: &System, a: usize) -> Id {
        let diagonal: Vec<Id> = system.heavy(a).iter().map(|&i| system.mass[i][i]).collect();
        let inertia = if diagonal.is_empty() { Id::ONE } else { self.trace(&diagonal) };
        let row = &system.constraints.jacobian[a];
        let squares: Vec<Id> = row.iter().map(|&entry| self.graph.square(entry)).collect();
        let square = sum(self.graph, &squares);
        let [inertia, square] = [inertia, square].map(|part| self.at_a_fixed_state(part));
        let quotient = self.graph.div(inertia, square);
        self.at_a_fixed_state(quotient)
    }

    /// Of an indefinite M the absolute values, where else too little is left.
    fn trace(&mut self, diagonal: &[Id]) -> Id {
        let trace = sum(self.graph, diagonal);
        let sizes: Vec<Id> = diagonal.iter().map(|&mass| self.graph.function(Function::Abs, mass)).collect();
        let size = sum(self.graph, &sizes);
        let is_large = |state: &mut State| {
            let [trace, size] = [trace, size].map(|root| state.value(self.graph, root));
            trace > LEFT * size
        };
        if self.states.iter_mut().all(is_large) { trace } else { size }
    }

    /// The same where one coordinate is 1 and all else is 0, if that is its value at every state: then it is an
    /// expression of the parameters. The trace of a body's inertia is the same in all orientations.
    fn at_a_fixed_state(&mut self, root: Id) -> Id {
        let is_moving = |symbol: &Symbol| !matches!(Variable::of(*symbol), Variable::Parameter(_));
        let moving: Vec<Symbol> = self.graph.symbols(&[root]).filter(is_moving).collect();
        let candidates = moving.iter().map(|&one| {
            let number = |symbol| if symbol == one { Id::ONE } else { Id::ZERO };
            let fixed = self.graph.substituted(root, |symbol| is_moving(&symbol).then(|| number(symbol)));
            let is_sound = self.graph.take_fault().is_none();
            (is_sound && self.is_same(root, fixed)).then_some(fixed)
        });
        candidates.flatten().next().unwrap_or(root)
    }

    fn is_same(&mut self, root: Id, other: Id) -> bool {
        self.states.iter_mut().all(|state| {
            let [x, y] = [root, other].map(|root| state.value(self.graph, root));
            (x - y).abs() <= SAME * x.abs()
        })
    }
}

fn sum(graph: &mut Graph, terms: &[Id]) -> Id {
    graph.sum(terms.iter().map(|&term| (term, Rational::one())).collect::<Vec<_>>())
}
