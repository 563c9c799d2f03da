//! Parts of an expression by their degree in the velocities: L = L₀ + L₁ + L₂.

use num_traits::{CheckedAdd, CheckedMul, CheckedSub, One, Zero};

use crate::resolve::Problem;
use crate::symbolic::{Forward, Graph, Id, Node, Rational};
use crate::variables::{Variable, directions};

/// A term of a sum, with its coefficient and its degree in the velocities.
#[derive(Clone, Copy, Debug)]
pub(super) struct GradedTerm {
    pub(super) coefficient: Rational,
    pub(super) term: Id,
    pub(super) degree: Rational,
}

impl GradedTerm {
    /// Coefficient of the term in the energy, (degree − 1) times its own; `None` if the exact number overflows.
    pub(super) fn energy(&self) -> Option<Rational> {
        self.degree.checked_sub(&Rational::one())?.checked_mul(&self.coefficient)
    }
}

/// Largest number of terms of a sum: nested definitions can multiply them.
const LIMIT: usize = 1 << 14;

/// The terms of `root` by degree; `None` if a term is not visibly homogeneous, or beyond [`LIMIT`] terms.
pub(super) fn parts(graph: &Graph, root: Id) -> Option<Vec<GradedTerm>> {
    let degrees = degrees(graph, root);
    let mut parts = Vec::new();
    let mut pending = vec![(root, Rational::one())];
    while let Some((term, coefficient)) = pending.pop() {
        if parts.len() + pending.len() > LIMIT {
            return None;
        }
        match (degrees[term.index()], graph.node(term)) {
            (Some(degree), _) => parts.push(GradedTerm { coefficient, term, degree }),
            (None, Node::Sum(terms)) => {
                for (term, c) in terms {
                    pending.push((*term, c.checked_mul(&coefficient)?));
                }
            }
            (None, Node::Defined(inner)) => pending.push((*inner, coefficient)),
            (None, _) => return None,
        }
    }
    Some(parts)
}

/// Degree of homogeneity in the velocities of each node below `root`, by index; `None` for nodes that are not visibly
/// homogeneous.
fn degrees(graph: &Graph, root: Id) -> Vec<Option<Rational>> {
    let order = graph.reachable(&[root]);
    let mut degrees: Vec<Option<Rational>> = vec![None; root.index() + 1];
    for id in order {
        let of = |id: Id| degrees[id.index()];
        degrees[id.index()] = match graph.node(id) {
            Node::Number(_) | Node::Pi => Some(Rational::zero()),
            Node::Symbol(symbol) => {
                let is_velocity = matches!(Variable::of(*symbol), Variable::Velocity(_));
                Some(Rational::from_integer(i128::from(is_velocity)))
            }
            Node::Sum(terms) => {
                let first = of(terms[0].0);
                first.filter(|_| terms.iter().all(|&(term, _)| of(term) == first))
            }
            Node::Product(factors) => factors.iter().try_fold(Rational::zero(), |sum, &(factor, e)| {
                sum.checked_add(&of(factor)?.checked_mul(&e)?)
            }),
            Node::Defined(inner) => of(*inner),
            Node::Function(..) | Node::Atan2(..) | Node::Power(..) | Node::External(_) => {
                let mut free = true;
                graph.operands(id, |operand| free &= of(operand) == Some(Rational::zero()));
                free.then(Rational::zero)
            }
        };
    }
    degrees
}

/// Σ q̇ ∂/∂q̇ of an expression: multiplies each term by its degree in the velocities (Euler's theorem).
pub(super) fn by_degree(graph: &mut Graph, problem: &Problem, expression: Id) -> Id {
    let n = problem.coordinates.len();
    let rates = directions(graph, n, &[(Variable::Velocity, Variable::Velocity)]);
    Forward::along(rates).of(graph, expression)
}
