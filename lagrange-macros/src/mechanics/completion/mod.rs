//! Where M is singular and the constraints make up for it: the length of a quaternion has no inertia, nor has a
//! coordinate that only a constraint ties to others.
//!
//! With F q̈ = −γ, what FᵀσF q̈ = −Fᵀσγ adds to M q̈ − Fᵀλ = h changes neither q̈ nor λ. M + FᵀσF is definite where M is
//! along the constraints, if σ is large enough; about |M|/|F|² is best for its condition (Golub and Greif, "On solving
//! block-structured indefinite linear systems", *SIAM Journal on Scientific Computing* 24, 2003). Which rows of F that
//! takes is found at random states. Were it found wrong, the pivot would tell at run time.

mod pivots;
mod states;
mod weight;

use super::constraints::Constraints;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Rational};
use pivots::{Wanted, add_square, pivots};
use states::{Space, State};

/// What is looked for, in turn, and with how many times the natural σ: an indefinite M may take more. Parameters at
/// random may be such that nothing is definite; M is then made regular.
const ATTEMPTS: [(Wanted, i128); 3] = [(Wanted::Definite, 1), (Wanted::Definite, 16), (Wanted::Regular, 1)];

/// The fewest constraints that complete M, each with its σ; none where M needs none, or none help.
pub(super) fn completing(
    graph: &mut Graph,
    problem: &Problem,
    mass: &[Vec<Id>],
    constraints: &Constraints,
) -> Vec<(usize, Id)> {
    let is_definite = |state: &State| pivots(&state.mass, Wanted::Definite) == mass.len();
    let space = Space { graph, problem, mass, constraints };
    if constraints.kinds.is_empty() || space.anywhere().iter().any(is_definite) {
        return Vec::new();
    }
    let states = space.on_constraints();
    if states.is_empty() || states.iter().any(is_definite) {
        return Vec::new();
    }
    let mut search = Search { graph, mass, jacobian: &constraints.jacobian, states };
    let found = ATTEMPTS.iter().find_map(|&(wanted, factor)| search.rows(wanted, factor));
    found.filter(|_| graph.take_fault().is_none()).unwrap_or_default()
}

struct Search<'e> {
    graph: &'e mut Graph,
    mass: &'e [Vec<Id>],
    jacobian: &'e [Vec<Id>],
    /// States on the constraints, one at least.
    states: Vec<State>,
}

impl Search<'_> {
    /// Row after row that takes M further at the first state, if they take it all the way at every one. Of a
    /// semidefinite M these are the fewest, and those that fill in least (a greedy choice from a matroid).
    fn rows(&mut self, wanted: Wanted, factor: i128) -> Option<Vec<(usize, Id)>> {
        let n = self.mass.len();
        let mut matrix = self.states[0].mass.clone();
        let (mut reached, mut rows) = (pivots(&matrix, wanted), Vec::new());
        for a in self.by_fill() {
            if reached == n {
                break;
            }
            let natural = self.weight(a);
            let weight = self.graph.sum([(natural, Rational::from_integer(factor))]);
            let mut more = matrix.clone();
            add_square(&mut more, self.states[0].value(self.graph, weight), &self.states[0].jacobian[a]);
            let further = pivots(&more, wanted);
            if further > reached {
                (matrix, reached) = (more, further);
                rows.push((a, weight));
            }
        }
        let graph = &*self.graph;
        let complete = |state: &mut State| pivots(&state.completed(graph, &rows), wanted) == n;
        self.states.iter_mut().all(complete).then_some(rows)
    }

    /// The constraints, those first that make few entries of M that were zero, and of these those that tie few.
    fn by_fill(&self) -> Vec<usize> {
        let fill = |row: &[Id]| {
            let tied = tied(row);
            let pairs = tied.iter().flat_map(|&i| tied.iter().map(move |&j| (i, j)));
            (pairs.filter(|&(i, j)| self.mass[i][j] == Id::ZERO).count(), tied.len())
        };
        let mut order: Vec<usize> = (0..self.jacobian.len()).collect();
        order.sort_by_key(|&a| fill(&self.jacobian[a]));
        order
    }
}

/// The coordinates that a constraint ties.
fn tied(row: &[Id]) -> Vec<usize> {
    (0..row.len()).filter(|&i| row[i] != Id::ZERO).collect()
}
