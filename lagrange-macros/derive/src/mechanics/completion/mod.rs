//! Completion of a singular M by constraints. Examples: the length of a quaternion has no inertia, nor has a
//! coordinate that only a constraint couples to others.
//!
//! Because F q̈ = −γ, adding FᵀσF q̈ = −Fᵀσγ to M q̈ − Fᵀλ = h changes neither q̈ nor λ. If M is definite along the
//! constraints, M + FᵀσF is definite for large enough σ. About |M|/|F|² is best for its condition number (Golub and
//! Greif, "On solving block-structured indefinite linear systems", *SIAM Journal on Scientific Computing* 24, 2003).
//! The rows of F that are needed are found at random states. If that choice is wrong, a bad pivot reveals it at run
//! time.

mod completed;
mod pivots;
mod positive;
mod states;
mod system;
mod weight;

use super::constraints::Constraints;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Rational};
pub(crate) use completed::Completed;
use pivots::{Wanted, add_square, pivots};
use states::State;
use system::System;
use weight::Weights;

/// Property that the completed M must have, and factor on the natural σ, in the order tried. An indefinite M may need
/// a larger σ. At random parameters M may not become definite at all; a regular matrix is then enough.
const ATTEMPTS: [(Wanted, i32); 3] = [(Wanted::Definite, 1), (Wanted::Definite, 16), (Wanted::Regular, 1)];

/// Returns the fewest constraints that complete M, each with its σ. Returns none if M is definite, or if no
/// constraints help.
pub(super) fn completing(
    graph: &mut Graph,
    problem: &Problem,
    mass: &[Vec<Id>],
    constraints: &Constraints,
) -> Vec<(usize, Id)> {
    let system = System { problem, mass, constraints };
    let found = system.completing(graph).unwrap_or_default();
    if graph.take_fault().is_none() { found } else { Vec::new() }
}

/// Number of states at which a completion is tested if M is singular at the first state.
const FEW: usize = 3;
/// Number of states if M is indefinite but regular at the first state. More tests are needed, as constraints may make
/// such an M definite for some parameters only.
const MANY: usize = 12;

impl System<'_> {
    fn completing(&self, graph: &mut Graph) -> Option<Vec<(usize, Id)>> {
        if self.constraints.kinds.is_empty() {
            return None;
        }
        let (first, count) = self.first(graph)?;
        ATTEMPTS.iter().find_map(|&(wanted, factor)| {
            let rows = self.rows(&first, wanted, factor)?;
            let states = self.states(graph, &rows).take(count).collect();
            self.weighted(graph, states, &rows, wanted, factor)
        })
    }

    /// Returns a state at which M is not definite, and the number of states for the test; `None` if M needs no
    /// completion.
    fn first(&self, graph: &Graph) -> Option<(State, usize)> {
        let is = |state: &State, wanted| pivots(&state.mass, wanted) == self.mass.len();
        let is_definite = |state: &State| is(state, Wanted::Definite);
        let mut states = self.states(graph, &[]);
        let first = states.next()?;
        let is_singular = !is(&first, Wanted::Regular);
        let is_left_alone =
            is_definite(&first) || !is_singular && states.take(FEW).any(|state| is_definite(&state));
        (!is_left_alone).then_some((first, if is_singular { FEW } else { MANY }))
    }

    /// Adds row after row that increases the number of pivots. Returns the rows if they complete M. For a semidefinite
    /// M these are the fewest rows, with the least fill-in (greedy choice from a matroid).
    fn rows(&self, state: &State, wanted: Wanted, factor: i32) -> Option<Vec<usize>> {
        let n = self.mass.len();
        let (mut matrix, mut rows) = (state.mass.clone(), Vec::new());
        let mut reached = pivots(&matrix, wanted);
        for a in self.by_fill() {
            if reached == n {
                break;
            }
            let mut more = matrix.clone();
            add_square(&mut more, f64::from(factor) * self.size(state, a), &state.jacobian[a]);
            let further = pivots(&more, wanted);
            if further > reached {
                (matrix, reached) = (more, further);
                rows.push(a);
            }
        }
        (reached == n).then_some(rows)
    }

    /// Returns the rows with their σ, if they complete M at all of `states`, which satisfy these constraints.
    fn weighted(
        &self,
        graph: &mut Graph,
        mut states: Vec<State>,
        rows: &[usize],
        wanted: Wanted,
        factor: i32,
    ) -> Option<Vec<(usize, Id)>> {
        let mut weights = Weights { graph, states: &mut states };
        let rows = rows.iter().map(|&a| {
            let natural = weights.of(self, a);
            (a, weights.graph.sum([(natural, Rational::from_integer(factor.into()))]))
        });
        let rows: Vec<(usize, Id)> = rows.collect();
        let is_complete =
            |state: &mut State| pivots(&state.completed(graph, &rows), wanted) == self.mass.len();
        (!states.is_empty() && states.iter_mut().all(is_complete)).then_some(rows)
    }
}
