//! Rows of the constraint Jacobian that parameters may cancel, and the rounding errors of their entries.
//!
//! Where the plane of a linkage is turned by the angle a + b at one base and by c at the other, a + b = c leaves nothing
//! of the constraint across the plane but round-off, at every pose. The runtime compares such a row with its rounding
//! errors. A row that vanishes at isolated poses only is no such row.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::symbolic::{Graph, Id, Node, RoundOff, Symbol};
use crate::variables::Variable;

/// For each row that parameters may cancel, the bounds of the rounding errors of its entries, in units of the round-off
/// unit; zeros for the other rows.
pub(super) fn round_off(graph: &mut Graph, jacobian: &[Vec<Id>]) -> Vec<Vec<Id>> {
    let mut bounds = RoundOff::default();
    let rows = jacobian.iter().map(|row| match may_cancel(graph, row) {
        true => row.iter().map(|&entry| bounds.of(graph, entry)).collect(),
        false => vec![Id::ZERO; row.len()],
    });
    rows.collect()
}

/// True unless an entry of the row vanishes at isolated poses only, whatever the parameters that are not zero.
fn may_cancel(graph: &Graph, row: &[Id]) -> bool {
    let moved_by = MovedBy::of(graph, row);
    !row.iter().any(|&entry| entry != Id::ZERO && moved_by.lasts(graph, entry))
}

/// For each node, whether it depends on a coordinate or on time: one bit each.
struct MovedBy(FxHashMap<Id, Vec<u64>>);

impl MovedBy {
    fn of(graph: &Graph, roots: &[Id]) -> Self {
        let mut found: FxHashMap<Id, Vec<u64>> = FxHashMap::default();
        for id in graph.reachable(roots) {
            let mut bits = Vec::new();
            match graph.node(id) {
                Node::Symbol(symbol) => mark(*symbol, &mut bits),
                _ => graph.operands(id, |operand| unite(&mut bits, &found[&operand])),
            }
            found.insert(id, bits);
        }
        Self(found)
    }

    /// True if the expression cannot vanish at every pose, whatever the parameters that are not zero.
    fn lasts(&self, graph: &Graph, root: Id) -> bool {
        let (mut pending, mut seen) = (vec![root], FxHashSet::default());
        while let Some(id) = pending.pop() {
            if !seen.insert(id) {
                continue;
            }
            match graph.node(id) {
                Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::External(_) => {}
                Node::Defined(inner) => pending.push(*inner),
                Node::Product(factors) => pending.extend(factors.iter().map(|(factor, _)| *factor)),
                Node::Sum(terms) => match self.with_motion_of_its_own(terms) {
                    Some(term) => pending.push(term),
                    None => return false,
                },
                // Parameters that cancel in an argument leave a constant, as in sin((a - b) q).
                Node::Function(..) | Node::Atan2(..) | Node::Power(..) => {
                    if self.0[&id].iter().all(|&word| word == 0) {
                        return false;
                    }
                    graph.operands(id, |operand| pending.push(operand));
                }
            }
        }
        true
    }

    /// The only term, or one that depends on a coordinate on which no other term depends.
    fn with_motion_of_its_own<C>(&self, terms: &[(Id, C)]) -> Option<Id> {
        let is_alone = |&at: &usize| {
            let mut others = Vec::new();
            let rest = terms.iter().enumerate().filter(|(k, _)| *k != at);
            rest.for_each(|(_, (term, _))| unite(&mut others, &self.0[term]));
            let own = self.0[&terms[at].0].iter().enumerate();
            own.into_iter().any(|(word, bits)| bits & !others.get(word).copied().unwrap_or(0) != 0)
        };
        let found = if terms.len() == 1 { Some(0) } else { (0..terms.len()).find(is_alone) };
        found.map(|at| terms[at].0)
    }
}

fn mark(symbol: Symbol, bits: &mut Vec<u64>) {
    let place = match Variable::of(symbol) {
        Variable::Time => 0,
        Variable::Coordinate(i) => i + 1,
        _ => return,
    };
    bits.resize(place / 64 + 1, 0);
    bits[place / 64] |= 1 << (place % 64);
}

fn unite(bits: &mut Vec<u64>, more: &[u64]) {
    bits.resize(bits.len().max(more.len()), 0);
    bits.iter_mut().zip(more).for_each(|(bits, more)| *bits |= more);
}
