//! Bounds of rounding errors as expressions.

use num_traits::Signed;
use rustc_hash::FxHashMap;

use super::graph::{Function, Graph, Id, Node};

/// First-order bounds of the rounding errors of expressions, in units of the round-off unit of their scalar: each
/// operation adds its own result, and passes on the errors of its operands by its derivatives (running error analysis:
/// Higham, *Accuracy and Stability of Numerical Algorithms*, 3.3). Symbols are rounded numbers; rational numbers and
/// supplied functions count as exact.
#[derive(Debug, Default)]
pub struct RoundOff {
    known: FxHashMap<Id, Id>,
}

impl RoundOff {
    /// The bound of `root`, a node of the graph.
    pub fn of(&mut self, graph: &mut Graph, root: Id) -> Id {
        for id in graph.reachable(&[root]) {
            if !self.known.contains_key(&id) {
                let bound = self.step(graph, id);
                self.known.insert(id, bound);
            }
        }
        self.known[&root]
    }

    /// Bound of a node, from the known bounds of its operands.
    fn step(&self, graph: &mut Graph, id: Id) -> Id {
        match graph.node(id) {
            Node::Number(_) => Id::ZERO,
            Node::Defined(inner) => self.known[inner],
            Node::Sum(terms) => {
                let terms: Vec<_> = terms.iter().map(|&(term, c)| (self.known[&term], c.abs())).collect();
                let passed_on = graph.sum(terms);
                self.with_own(graph, id, passed_on)
            }
            Node::External(_) => self.with_own(graph, id, Id::ZERO),
            _ => {
                let passed_on = self.passed_on(graph, id);
                self.with_own(graph, id, passed_on)
            }
        }
    }

    /// Σ |∂/∂operand| · bound of operand
    fn passed_on(&self, graph: &mut Graph, id: Id) -> Id {
        let mut terms = Vec::new();
        for operand in graph.distinct_operands(id) {
            let slope = graph.partial(id, operand, Id::ONE);
            let size = graph.function(Function::Abs, slope);
            terms.push(graph.mul(size, self.known[&operand]));
        }
        graph.total(terms)
    }

    fn with_own(&self, graph: &mut Graph, id: Id, passed_on: Id) -> Id {
        let own = graph.function(Function::Abs, id);
        graph.add(own, passed_on)
    }
}
