//! Sums with terms in common, each written as what it begins with and the rest.
//!
//! Of a, a + b, a + b + c, … each is the one before and a term more: so it is differentiated, and solved, at a cost linear in
//! their number, where it costs the square written out. Terms are ordered by how many sums they are in, and the sums are ways
//! from the root of a tree by their terms in that order (Han, Pei and Yin, *Mining frequent patterns without candidate
//! generation*, 2000). A place where ways part, or at which one ends and others go on, is a sum that all of those begin with.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use num_traits::One;
use rustc_hash::FxHashMap;

use super::combined::Term;
use super::graph::{Graph, Id, Node};
use super::rational::Rational;

/// Sums as ways through a tree.
#[derive(Default)]
struct Ways {
    /// The first is the root.
    places: Vec<Nesting>,
    /// By a place and the term after it.
    next: FxHashMap<(usize, Term), usize>,
    /// Where the way of a sum ends.
    ends: FxHashMap<Id, usize>,
}

#[derive(Default)]
struct Nesting {
    before: usize,
    /// The last term on the way to it.
    term: Option<Term>,
    depth: usize,
    /// How many ways lead on from it, or end.
    ways: usize,
    is_named: bool,
    /// The sum of all terms on the way to it, written anew.
    value: Option<Id>,
}

impl Graph {
    /// A graph in which the sums that are in `from` are written by what they have in common, with a boundary around each such
    /// part, and what the nodes that `roots` are made of are there; `None` where nothing is in common.
    pub(crate) fn nested(&self, from: Id, roots: &[Id]) -> Option<(Self, FxHashMap<Id, Id>)> {
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

    /// Whether several sums begin with one that has a name, or with what saves more than one addition.
    fn is_shared(&self, place: usize) -> bool {
        let Nesting { depth, ways, is_named, .. } = self.places[place];
        ways > 1 && depth > 0 && (is_named || (ways - 1) * (depth - 1) > 1)
    }

    /// The sum of the terms on the way to a place.
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

/// The sums in an expression that have a name, or are factors: each once, whether it has one, and its terms.
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
