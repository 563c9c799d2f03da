//! Where M is singular and the constraints make up for it: the length of a quaternion has no inertia, nor has a
//! coordinate that only a constraint ties to others.
//!
//! With F q̈ = −γ, what FᵀσF q̈ = −Fᵀσγ adds to M q̈ − Fᵀλ = h changes neither q̈ nor λ. M + FᵀσF is definite where M is
//! along the constraints, if σ is large enough; about |M|/|F|² is best for its condition (Golub and Greif, "On solving
//! block-structured indefinite linear systems", *SIAM Journal on Scientific Computing* 24, 2003). Which rows of F that
//! takes is found at random states. Were it found wrong, the pivot would tell at run time.

mod pivots;
mod positive;
mod states;
mod system;
mod weight;

use super::constraints::Constraints;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Rational};
use pivots::{Wanted, add_square, pivots};
use states::State;
use system::System;
use weight::Weights;

/// What is looked for, in turn, and with how many times the natural σ: an indefinite M may take more. Parameters at
/// random may be such that nothing is definite; M is then made regular.
const ATTEMPTS: [(Wanted, i32); 3] = [(Wanted::Definite, 1), (Wanted::Definite, 16), (Wanted::Regular, 1)];

/// The fewest constraints that complete M, each with its σ; none where M needs none, or none help.
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

/// So many states are looked at where M is singular at the first; …
const FEW: usize = 3;
/// … and where it is not, but indefinite: there it must be no whim of the parameters that constraints make it definite.
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

    /// A state at which M is not definite, and how many others are to be looked at; `None` where M needs nothing.
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

    /// Row after row that takes M further, if they take it all the way. Of a semidefinite M these are the fewest, and
    /// those that fill in least (a greedy choice from a matroid).
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

    /// The rows with their σ, if they complete M at other states on these constraints.
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
