//! σ of a constraint in its own units: the inertia of what it ties, over the square of its row.

use num_traits::One;

use super::positive::positive_terms;
use super::states::State;
use super::system::{System, tied};
use crate::symbolic::{Function, Graph, Id, Rational, Symbol};
use crate::variables::Variable;

/// Values that differ by less are those of one expression of the parameters.
const SAME: f64 = 1e-9;
/// A weight may be so many times another, or as small a part: either completes M as well.
const ABOUT: f64 = 8.0;
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
    /// What makes M diagonal over the coordinates that the row ties, as for a sphere, or about as much.
    pub(super) fn of(&mut self, system: &System, a: usize) -> Id {
        self.separating(system, a).unwrap_or_else(|| self.natural(system, a))
    }

    /// −M_ij/(F_i F_j), if that is the same expression of the parameters for all i ≠ j.
    fn separating(&mut self, system: &System, a: usize) -> Option<Id> {
        let row = &system.constraints.jacobian[a];
        let tied = tied(row);
        let pairs = || tied.iter().flat_map(|&i| tied.iter().map(move |&j| (i, j))).filter(|(i, j)| i < j);
        let ratio = |state: &State, (i, j): (usize, usize)| {
            -state.mass[i][j] / (state.jacobian[a][i] * state.jacobian[a][j])
        };
        let is_one = |state: &State| {
            let (first, mut ratios) = (ratio(state, pairs().next()?), pairs().map(|pair| ratio(state, pair)));
            (first > 0.0 && ratios.all(|ratio| (ratio - first).abs() <= SAME * first)).then_some(())
        };
        self.states.iter().try_for_each(is_one)?;
        let (i, j) = pairs().next()?;
        let coupling = self.graph.looked_through(system.mass[i][j]);
        let square = self.graph.mul(row[i], row[j]);
        let quotient = self.graph.div(coupling, square);
        let weight = self.graph.neg(quotient);
        self.graph.symbols(&[weight]).all(|symbol| !is_moving(&symbol)).then_some(weight)
    }

    /// tr M/|F|², over the coordinates that the row ties.
    fn natural(&mut self, system: &System, a: usize) -> Id {
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

    /// The same where one coordinate is 1 and all else is 0, if that is its value at every state, or about: then it is an
    /// expression of the parameters. The trace of a body's inertia is the same in all orientations.
    fn at_a_fixed_state(&mut self, root: Id) -> Id {
        let moving: Vec<Symbol> = self.graph.symbols(&[root]).filter(is_moving).collect();
        let candidates = moving.iter().filter_map(|&one| {
            let number = |symbol| if symbol == one { Id::ONE } else { Id::ZERO };
            let fixed = self.graph.substituted(root, |symbol| is_moving(&symbol).then(|| number(symbol)));
            self.graph.take_fault().is_none().then_some(fixed)
        });
        let candidates: Vec<Id> = candidates.collect();
        let same = |x: f64, y: f64| (x - y).abs() <= SAME * x.abs();
        let about = |x: f64, y: f64| (1.0 / ABOUT..ABOUT).contains(&(y / x));
        let exact = self.with(root, &candidates, same);
        exact.or_else(|| candidates.into_iter().find_map(|sum| self.part(root, sum, about))).unwrap_or(root)
    }

    /// As many terms of a sum as it takes, the largest ones: of those that are positive at other parameters as well, or
    /// else all.
    fn part(&mut self, root: Id, sum: Id, goes: impl Fn(f64, f64) -> bool) -> Option<Id> {
        let terms = positive_terms(self.graph, sum);
        let first = self.states.first_mut()?;
        let sized = terms.into_iter().map(|term| (first.value(self.graph, term), term));
        let mut terms: Vec<(f64, Id)> = sized.collect();
        terms.sort_by(|(x, _), (y, _)| y.total_cmp(x));
        let parts =
            (1..=terms.len()).map(|count| self.graph.total(terms[..count].iter().map(|(_, term)| *term)));
        let parts: Vec<Id> = parts.chain([sum]).collect();
        self.with(root, &parts, goes)
    }

    /// The first of these whose value goes with that of the root at every state.
    fn with(&mut self, root: Id, candidates: &[Id], goes: impl Fn(f64, f64) -> bool) -> Option<Id> {
        candidates.iter().copied().find(|&candidate| {
            self.states.iter_mut().all(|state| {
                let [x, y] = [root, candidate].map(|root| state.value(self.graph, root));
                goes(x, y)
            })
        })
    }
}

fn is_moving(symbol: &Symbol) -> bool {
    !matches!(Variable::of(*symbol), Variable::Parameter(_))
}

fn sum(graph: &mut Graph, terms: &[Id]) -> Id {
    graph.sum(terms.iter().map(|&term| (term, Rational::one())).collect::<Vec<_>>())
}
