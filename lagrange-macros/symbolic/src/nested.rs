//! Nests sums that have terms in common: each is written as a shared prefix and its remaining terms.
//!
//! In a, a + b, a + b + c, … each sum is the one before plus one term. Nested, these sums are differentiated and
//! solved at a cost linear in their number; expanded, the cost is quadratic. Terms are sorted by the number of sums
//! that contain them, and each sum is a path from the root of a prefix tree (Han, Pei and Yin, *Mining frequent
//! patterns without candidate generation*, 2000). A tree node where paths diverge, or where one path ends and others
//! continue, is a prefix shared by all of them.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use num_traits::One;
use rustc_hash::FxHashMap;

use super::combined::Term;
use super::graph::{Graph, Id, Node};
use super::rational::Rational;

/// Sums as paths in a prefix tree.
#[derive(Default)]
struct Ways {
    /// Tree nodes; the first is the root.
    places: Vec<Nesting>,
    /// Child of a tree node by its term.
    next: FxHashMap<(usize, Term), usize>,
    /// Tree node at which the path of a sum ends.
    ends: FxHashMap<Id, usize>,
}

#[derive(Default)]
struct Nesting {
    before: usize,
    /// Last term of the prefix; `None` for the root.
    term: Option<Term>,
    depth: usize,
    /// Number of paths that continue from this node or end at it.
    ways: usize,
    is_named: bool,
    /// The prefix as a node of the new graph.
    value: Option<Id>,
}

impl Graph {
    /// Builds a graph in which the sums of `from` share prefixes, each prefix a definition. Also returns the new node
    /// of every node below `roots`; `None` if there are no shared prefixes.
    pub fn nested(&self, from: Id, roots: &[Id]) -> Option<(Self, FxHashMap<Id, Id>)> {
        let mut ways = Ways::of(self, from);
        (0..ways.places.len()).any(|place| ways.is_shared(place)).then_some(())?;
        let (mut graph, mut new) = (Self::default(), FxHashMap::default());
        for id in self.reachable(roots) {
            let written = match (self.node(id), ways.ends.get(&id)) {
                (Node::Sum(_), Some(&end)) => ways.written(&mut graph, end, &new),
                (Node::Defined(inner), _) => graph.defined(new[inner]),
                (node, _) => graph.rebuilt(node, |operand| new[&operand]),
            };
            new.insert(id, written);
        }
        graph.take_fault().is_none().then_some((graph, new))
    }
}

impl Ways {
    fn of(graph: &Graph, from: Id) -> Self {
        let sums = sums(graph, from);
        let mut users: FxHashMap<Term, usize> = FxHashMap::default();
        sums.iter().flat_map(|(.., terms)| terms).for_each(|term| *users.entry(*term).or_default() += 1);
        let mut ways = Self { places: vec![Nesting::default()], ..Self::default() };
        for (sum, is_named, mut terms) in sums {
            terms.sort_unstable_by_key(|term| (Reverse(users[term]), *term));
            ways.add(sum, is_named, &terms);
        }
        ways
    }

    fn add(&mut self, sum: Id, is_named: bool, terms: &[Term]) {
        let mut at = 0;
        for &term in terms {
            let count = self.places.len();
            let next = *self.next.entry((at, term)).or_insert(count);
            if next == count {
                self.places[at].ways += 1;
                let depth = self.places[at].depth + 1;
                self.places.push(Nesting { before: at, term: Some(term), depth, ..Nesting::default() });
            }
            at = next;
        }
        self.places[at].ways += 1;
        self.places[at].is_named = is_named;
        self.ends.insert(sum, at);
    }

    /// True if several sums share a prefix that is named or saves more than one addition.
    fn is_shared(&self, place: usize) -> bool {
        let Nesting { depth, ways, is_named, .. } = self.places[place];
        ways > 1 && depth > 0 && (is_named || (ways - 1) * (depth - 1) > 1)
    }

    /// Builds the sum of the terms on the path to a tree node.
    fn written(&mut self, graph: &mut Graph, end: usize, new: &FxHashMap<Id, Id>) -> Id {
        let mut way = vec![end];
        while let Some(&at) = way.last().filter(|at| self.places[**at].before != 0) {
            way.push(self.places[at].before);
        }
        let mut sum = Vec::new();
        for &at in way.iter().rev() {
            sum.extend(self.places[at].term.map(|(term, coefficient)| (new[&term], coefficient)));
            if self.is_shared(at) {
                let value = self.places[at].value.unwrap_or_else(|| {
                    let value = graph.sum(sum.iter().copied());
                    graph.defined(value)
                });
                self.places[at].value = Some(value);
                sum = vec![(value, Rational::one())];
            }
        }
        graph.sum(sum)
    }
}

/// All sums in an expression that are definitions or factors: node, whether it is a definition, and its terms.
fn sums(graph: &Graph, from: Id) -> Vec<(Id, bool, Vec<Term>)> {
    let mut found: BTreeMap<Id, bool> = BTreeMap::new();
    for id in graph.reachable(&[from]) {
        match graph.node(id) {
            Node::Defined(inner) => *found.entry(*inner).or_default() = true,
            Node::Product(factors) => {
                let sums = factors.iter().filter(|(factor, _)| matches!(graph.node(*factor), Node::Sum(_)));
                sums.for_each(|(sum, _)| *found.entry(*sum).or_default() |= false);
            }
            _ => {}
        }
    }
    let terms = |id: Id| match graph.node(id) {
        Node::Sum(terms) => terms.to_vec(),
        _ => vec![(id, Rational::one())],
    };
    found.into_iter().map(|(id, is_named)| (id, is_named, terms(id))).collect()
}
