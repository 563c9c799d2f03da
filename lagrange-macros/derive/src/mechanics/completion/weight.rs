//! Weight σ of a constraint in its own units: the inertia of the coordinates that it couples, over the square of its
//! row of F.

use num_traits::One;

use super::positive::positive_terms;
use super::states::State;
use super::system::{System, tied};
use crate::symbolic::{Function, Graph, Id, Rational, Symbol};
use crate::variables::Variable;

/// Relative tolerance at which values of two expressions of the parameters count as the same.
const SAME: f64 = 1e-9;
/// Largest ratio, either way, between σ and a simpler expression that replaces it. Only the order of magnitude of σ
/// matters.
const ABOUT: f64 = 8.0;
/// Smallest trace that is used, relative to the sum of magnitudes of its terms.
const LEFT: f64 = 0.1;

impl System<'_> {
    /// Order of magnitude of σ at a state.
    pub(super) fn size(&self, state: &State, a: usize) -> f64 {
        let heavy = self.heavy(a);
        let inertia =
            if heavy.is_empty() { 1.0 } else { heavy.iter().map(|&i| state.mass[i][i].abs()).sum() };
        inertia / state.jacobian[a].iter().map(|x| x * x).sum::<f64>()
    }

    /// The coordinates with inertia that a row couples. If there are none, the search continues with the coordinates
    /// that other rows couple to these.
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
    /// States that satisfy the constraints.
    pub(super) states: &'e mut [State],
}

impl Weights<'_> {
    /// Returns the σ that makes M diagonal over the coordinates of the row, as for a sphere. If there is none, returns
    /// the natural σ.
    pub(super) fn of(&mut self, system: &System, a: usize) -> Id {
        self.separating(system, a).unwrap_or_else(|| self.natural(system, a))
    }

    /// −M_ij/(F_i F_j), if it is the same expression of the parameters for all i ≠ j.
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

    /// tr M/|F|², over the coordinates that the row couples.
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

    /// Trace of M, or the sum of magnitudes if much of the trace of an indefinite M cancels.
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

    /// Replaces an expression by its value at a fixed state, with one coordinate 1 and all others 0. Valid if both
    /// agree, at least in order of magnitude, at every state: the result depends on the parameters only. An example is
    /// the trace of the inertia of a body, which is the same in all orientations.
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

    /// Returns the sum of the fewest, largest terms whose value agrees with `root`. Terms that are positive for all
    /// parameters are tried first, then the whole sum.
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

    /// Returns the first candidate whose value agrees with that of `root`, by `goes`, at every state.
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
