//! Rebuilds expressions: with definitions inlined, with symbols replaced, or in another graph.

use rustc_hash::FxHashMap;

use super::graph::{External, Graph, Id, Node, Symbol};

impl Graph {
    /// The expression with definitions inlined. Returned unchanged if inlining causes a fault: a definition may hide a
    /// zero that is a divisor.
    pub fn looked_through(&mut self, root: Id) -> Id {
        let fault_before = self.take_fault();
        let rebuilt = self.substituted(root, |_| None);
        let faulty = self.take_fault().is_some();
        if let Some(fault) = fault_before {
            self.fail(fault);
        }
        if faulty { root } else { rebuilt }
    }

    /// Copies the expressions `roots` of `source` into this graph, with definitions inlined.
    pub fn copied(&mut self, source: &Self, roots: &[Id]) -> Vec<Id> {
        self.roundings.extend(&source.roundings);
        let mut new: FxHashMap<Id, Id> = FxHashMap::default();
        for id in source.reachable(roots) {
            let copy = self.rebuilt(source.node(id), |operand| new[&operand]);
            new.insert(id, copy);
        }
        roots.iter().map(|root| new[root]).collect()
    }

    /// Replaces symbols by other expressions and inlines definitions.
    pub fn substituted(&mut self, root: Id, replacement: impl Fn(Symbol) -> Option<Id>) -> Id {
        let mut new: FxHashMap<Id, Id> = FxHashMap::default();
        for id in self.reachable(&[root]) {
            let node = self.node(id).clone();
            let replaced = match node {
                Node::Symbol(symbol) => replacement(symbol),
                _ => None,
            };
            let rebuilt = replaced.unwrap_or_else(|| self.rebuilt(&node, |operand| new[&operand]));
            new.insert(id, rebuilt);
        }
        new[&root]
    }

    /// Replaces the nodes `zeros` by zero and keeps definitions.
    pub fn without(&mut self, root: Id, zeros: &[Id]) -> Id {
        self.replaced(root, &zeros.iter().map(|&node| (node, Id::ZERO)).collect())
    }

    /// Replaces nodes by others and keeps definitions.
    pub fn replaced(&mut self, root: Id, replacements: &FxHashMap<Id, Id>) -> Id {
        self.all_replaced(&[root], replacements)[&root]
    }

    /// Replaces nodes by others in all `roots` and keeps definitions. Returns the new nodes by the old ones.
    pub fn all_replaced(&mut self, roots: &[Id], replacements: &FxHashMap<Id, Id>) -> FxHashMap<Id, Id> {
        let mut new: FxHashMap<Id, Id> = FxHashMap::default();
        let leaves: Vec<Id> = replacements.keys().copied().collect();
        for id in self.reachable_to(roots, &leaves) {
            let node = self.node(id).clone();
            let rebuilt = match node {
                _ if replacements.contains_key(&id) => replacements[&id],
                Node::Defined(inner) => self.defined(new[&inner]),
                _ => self.rebuilt(&node, |operand| new[&operand]),
            };
            new.insert(id, rebuilt);
        }
        new
    }

    pub(super) fn rebuilt(&mut self, node: &Node, new: impl Fn(Id) -> Id) -> Id {
        match *node {
            Node::Sum(ref terms) => {
                let terms: Vec<_> = terms.iter().map(|&(term, c)| (new(term), c)).collect();
                self.sum(terms)
            }
            Node::Product(ref factors) => {
                let factors: Vec<_> = factors.iter().map(|&(factor, e)| (new(factor), e)).collect();
                self.product(factors)
            }
            Node::Function(function, x) => self.function(function, new(x)),
            Node::Atan2(y, x) => self.atan2(new(y), new(x)),
            Node::Power(base, exponent) => self.power(new(base), new(exponent)),
            Node::Defined(inner) => new(inner),
            Node::External(ref external) => {
                let arguments = external.arguments.iter().map(|&x| new(x)).collect();
                let external = External { arguments, ..(**external).clone() };
                self.external(external)
            }
            Node::Number(_) | Node::Pi | Node::Symbol(_) => self.intern(node.clone()),
        }
    }
}
