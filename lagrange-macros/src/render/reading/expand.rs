//! Expansion of nodes of the graph into polynomials.

use std::cell::RefCell;

use num_traits::One;
use rustc_hash::{FxHashMap, FxHashSet};

use super::atoms::{Atoms, Meaning};
use super::polynomial::Polynomial;
use crate::mechanics::Derived;
use crate::resolve::Problem;
use crate::symbolic::{External, Graph, Id, Node, Rational};
use crate::variables::Variable;

/// How many polynomials of nodes are worked out in all, counted in terms: what is beyond stays as it is.
const WORK: usize = 10_000;

/// Expressions as polynomials, of which definitions are parts by their names, or what these stand for.
pub(super) struct Expansion<'a> {
    graph: &'a Graph,
    /// The definitions that keep their names.
    pub(super) names: FxHashSet<Id>,
    pub(super) atoms: Atoms,
    /// Definitions without a name whose sines and cosines are put together.
    entries: FxHashSet<Id>,
    done: FxHashMap<Id, Option<Polynomial>>,
    work: usize,
}

impl<'a> Expansion<'a> {
    pub(super) fn new(graph: &'a Graph, problem: &Problem, derived: &Derived, names: FxHashSet<Id>) -> Self {
        let entries = derived.hamilton.iter().flat_map(|hamilton| &hamilton.entries).copied().collect();
        let (atoms, done) = (Atoms::default(), FxHashMap::default());
        let mut expansion = Self { graph, names, atoms, entries, done, work: WORK };
        // The order in which signs are taken out: φ₁ − φ₂, and not the other way about.
        let n = problem.coordinates.len();
        let parameters = problem.parameters.by_field().into_iter().map(Variable::Parameter);
        let kinds = [Variable::Coordinate, Variable::Velocity, Variable::Acceleration, Variable::Momentum];
        for variable in kinds.into_iter().flat_map(|kind| (0..n).map(kind)).chain(parameters) {
            expansion.atoms.atom(Meaning::Variable(variable));
        }
        expansion
    }

    /// A node as a polynomial; `None` where that takes too many terms.
    pub(super) fn of(&mut self, root: Id) -> Option<Polynomial> {
        let mut pending = vec![root];
        while let Some(&id) = pending.last() {
            let before = pending.len();
            if !self.done.contains_key(&id) && !self.names.contains(&id) {
                self.graph.operands(id, |operand| {
                    if !self.done.contains_key(&operand) {
                        pending.push(operand);
                    }
                });
            }
            if pending.len() == before {
                pending.pop();
                if !self.done.contains_key(&id) {
                    let polynomial = self.polynomial(id).filter(|polynomial| self.pay(polynomial));
                    self.done.insert(id, polynomial);
                }
            }
        }
        self.known(root)
    }

    fn pay(&mut self, polynomial: &Polynomial) -> bool {
        let is_paid = polynomial.len() < self.work;
        self.work -= if is_paid { polynomial.len() + 1 } else { 0 };
        is_paid
    }

    fn known(&self, id: Id) -> Option<Polynomial> {
        self.done.get(&id).cloned().flatten()
    }

    fn all(&self, ids: &[Id]) -> Option<Vec<Polynomial>> {
        ids.iter().map(|&id| self.known(id)).collect()
    }

    /// A node whose operands are done.
    fn polynomial(&mut self, id: Id) -> Option<Polynomial> {
        let meaning = match self.graph.node(id) {
            Node::Number(value) => return Some(Polynomial::number(*value)),
            Node::Sum(terms) => {
                let mut sum = Polynomial::default();
                terms.iter().try_for_each(|(term, c)| sum.add(&self.known(*term)?, *c))?;
                return Some(sum);
            }
            Node::Product(factors) => return self.product(factors),
            Node::Function(function, x) => return Some(self.atoms.function(*function, &self.known(*x)?)),
            Node::Defined(_) if self.names.contains(&id) => Meaning::Definition(id),
            Node::Defined(inner) if self.entries.contains(&id) => {
                let inner = self.known(*inner)?;
                return self.atoms.merged(inner);
            }
            Node::Defined(inner) => return self.known(*inner),
            Node::Pi => Meaning::Pi,
            Node::Symbol(symbol) => Meaning::Variable(Variable::of(*symbol)),
            Node::Atan2(y, x) => Meaning::Atan2(self.known(*y)?, self.known(*x)?),
            Node::Power(base, exponent) => Meaning::Power(self.known(*base)?, self.known(*exponent)?),
            Node::External(external) => {
                let function = External { arguments: Box::default(), ..(**external).clone() };
                Meaning::External(function, self.all(&external.arguments)?)
            }
        };
        Some(Polynomial::atom(self.atoms.atom(meaning)))
    }

    fn product(&mut self, factors: &[(Id, Rational)]) -> Option<Polynomial> {
        let mut product = Polynomial::number(Rational::one());
        for &(factor, exponent) in factors {
            let power = match self.graph.is_power_of_ten((factor, exponent)) {
                // Its digits do not fit into a coefficient.
                true => self.atoms.power_of_ten(exponent),
                false => self.atoms.power(&self.known(factor)?, exponent, factor)?,
            };
            product = self.atoms.product(&product, &power)?;
        }
        Some(product)
    }
}

/// The same expressions with some of the definitions by their names.
pub(crate) struct Reading<'a>(pub(super) RefCell<Expansion<'a>>);

/// With all definitions by their names, with those that are constant, and with none: as far as these differ.
pub(crate) fn readings<'a>(
    graph: &'a Graph,
    problem: &Problem,
    derived: &Derived,
    constants: &FxHashSet<Id>,
    names: Names,
) -> Vec<Reading<'a>> {
    let all: FxHashSet<Id> = problem.names.keys().copied().collect();
    let none = FxHashSet::default();
    let mut kept = match names {
        Names::Shortest => vec![all, constants.clone(), none],
        Names::Kept => vec![all],
        Names::WrittenOut => vec![none],
    };
    kept.dedup();
    kept.into_iter()
        .map(|kept| Reading(RefCell::new(Expansion::new(graph, problem, derived, kept))))
        .collect()
}

/// Whether definitions appear by their names.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Names {
    /// By whichever is shorter.
    Shortest,
    Kept,
    WrittenOut,
}

/// The definitions that neither the time nor the state changes.
pub(crate) fn constants(graph: &Graph, problem: &Problem) -> FxHashSet<Id> {
    let mut is_constant = Vec::with_capacity(graph.len());
    for id in graph.ids() {
        let mut is = match graph.node(id) {
            Node::Symbol(symbol) => matches!(Variable::of(*symbol), Variable::Parameter(_)),
            _ => true,
        };
        graph.operands(id, |operand| is &= is_constant[operand.index()]);
        is_constant.push(is);
    }
    problem.names.keys().copied().filter(|id| is_constant[id.index()]).collect()
}
