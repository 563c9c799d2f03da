//! Expands nodes of the graph into polynomials.

use std::cell::RefCell;

use num_traits::One;
use rustc_hash::{FxHashMap, FxHashSet};

use super::super::axes::NamedAxes;
use super::super::letters::Letters;
use super::super::roots::NamedRoot;
use super::atoms::{Atoms, Meaning};
use crate::mechanics::Derived;
use crate::resolve::Problem;
use crate::symbolic::{Atom, External, Graph, Id, Monomial, Node, Polynomial, Rational};
use crate::variables::Variable;

/// Maximum total number of terms in all expanded polynomials. Nodes beyond it are not expanded.
const WORK: usize = 10_000;

/// Polynomials of nodes, in which some definitions keep their names and the others are written out.
pub(super) struct Expansion<'a> {
    pub(super) graph: &'a Graph,
    /// Definitions that keep their names.
    pub(super) names: FxHashSet<Id>,
    pub(super) atoms: Atoms,
    /// Sums whose square roots have names, with the place of the name in the list of the page.
    pub(super) roots: FxHashMap<Atom, usize>,
    /// Entries of the mass matrix: unnamed definitions whose sines and cosines are merged by trigonometric identities.
    entries: FxHashSet<Id>,
    /// Nodes equal to one that has a name, each with that one: entries of rotation matrices, and definitions.
    pub(super) same: FxHashMap<Id, Id>,
    done: FxHashMap<Id, Option<Polynomial>>,
    powers: FxHashMap<(Id, Rational), Option<Polynomial>>,
    work: usize,
    /// What [`Page::polynomial`](super::super::page::Page) has read.
    pub(super) read: FxHashMap<Vec<(Id, i128)>, Option<Polynomial>>,
}

impl<'a> Expansion<'a> {
    pub(super) fn new(graph: &'a Graph, problem: &Problem, derived: &Derived, names: FxHashSet<Id>) -> Self {
        let entries = derived.hamilton.iter().flat_map(|hamilton| &hamilton.entries).copied().collect();
        let (atoms, done) = (Atoms::default(), FxHashMap::default());
        let roots = FxHashMap::default();
        let same = FxHashMap::default();
        let (powers, read) = (FxHashMap::default(), FxHashMap::default());
        let mut expansion =
            Self { graph, names, atoms, roots, entries, same, done, powers, work: WORK, read };
        // Registration order decides the sign taken out of a sum: φ₁ − φ₂ instead of φ₂ − φ₁.
        let n = problem.coordinates.len() + 3 * derived.turnings.all.len();
        let parameters = problem.parameters.by_field().into_iter().map(Variable::Parameter);
        let kinds = [Variable::Coordinate, Variable::Velocity, Variable::Acceleration, Variable::Momentum];
        for variable in kinds.into_iter().flat_map(|kind| (0..n).map(kind)).chain(parameters) {
            expansion.atoms.atom(Meaning::Variable(variable));
        }
        expansion
    }

    /// Names the roots of all sums but those of definitions that are written out.
    fn name(&mut self, roots: &[NamedRoot]) {
        for (place, root) in roots.iter().enumerate() {
            let is_kept = root.definition.is_none_or(|definition| self.names.contains(&definition));
            let Some(atom) = is_kept.then(|| self.under_root(root.base)).flatten() else { continue };
            self.roots.entry(atom).or_insert(place);
            if let Some(definition) = root.definition {
                self.atoms.kept.insert(atom);
                let exponent = Rational::new_raw(if root.is_below { -1 } else { 1 }, 2);
                let root = Polynomial::term(Monomial::of(atom, exponent), Rational::one());
                self.done.insert(definition, Some(root));
            }
        }
    }

    /// Atom of a sum under a square root, if nothing is taken out of the root.
    fn under_root(&mut self, base: Id) -> Option<Atom> {
        let polynomial = self.of(base)?;
        let root = self.atoms.power(&polynomial, Rational::new_raw(1, 2), base)?;
        let (monomial, number) = root.single()?;
        let [(atom, _)] = monomial.factors()[..] else { return None };
        (number.is_one() && matches!(self.atoms.meaning(atom), Meaning::Sum(_))).then_some(atom)
    }

    /// Polynomial of a node; `None` if it takes too many terms.
    pub(super) fn of(&mut self, root: Id) -> Option<Polynomial> {
        let mut pending = vec![root];
        while let Some(&id) = pending.last() {
            let before = pending.len();
            if !self.done.contains_key(&id) && !self.names.contains(&id) && !self.same.contains_key(&id) {
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

    /// Polynomial of a node whose operands are expanded.
    fn polynomial(&mut self, id: Id) -> Option<Polynomial> {
        let meaning = match self.graph.node(id) {
            Node::Number(value) => return Some(Polynomial::number(*value)),
            Node::Sum(terms) => {
                let mut sum = Polynomial::default();
                terms.iter().try_for_each(|(term, c)| sum.add(&self.known(*term)?, *c))?;
                return self.atoms.turned(sum);
            }
            Node::Product(factors) => return self.product(factors),
            Node::Function(function, x) => return Some(self.atoms.function(*function, &self.known(*x)?)),
            Node::Defined(_) if self.names.contains(&id) => Meaning::Definition(id),
            Node::Defined(_) if self.same.contains_key(&id) => Meaning::Definition(self.same[&id]),
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
            let power = self.power(factor, exponent)?;
            product = self.atoms.product(&product, &power)?;
        }
        Some(product)
    }

    fn power(&mut self, base: Id, exponent: Rational) -> Option<Polynomial> {
        if self.graph.is_power_of_ten((base, exponent)) {
            // Its digits do not fit into a coefficient.
            return Some(self.atoms.power_of_ten(exponent));
        }
        if let Some(power) = self.powers.get(&(base, exponent)) {
            return power.clone();
        }
        let power = self.atoms.power(&self.known(base)?, exponent, base);
        self.powers.insert((base, exponent), power.clone());
        power
    }
}

/// Expansion in which a certain set of definitions keeps its names.
pub(crate) struct Reading<'a>(pub(super) RefCell<Expansion<'a>>);

/// Readings with all definitions by name, with only constant ones by name, and with none, without repetitions.
pub(in crate::render) fn readings<'a>(
    (graph, problem, derived): (&'a Graph, &Problem, &Derived),
    constants: &FxHashSet<Id>,
    (roots, axes, letters): (&[NamedRoot], &[NamedAxes], &Letters),
    names: Names,
) -> Vec<Reading<'a>> {
    // The values of `min`, `max` and `clamp` are written by their calls everywhere.
    let unnamed =
        derived.limits(problem).map(|limit| limit.value).filter(|id| !problem.names.contains_key(id));
    let none: FxHashSet<Id> = unnamed.collect();
    let with = |names: &FxHashSet<Id>| names.union(&none).copied().collect::<FxHashSet<Id>>();
    let all = with(&problem.names.keys().copied().collect());
    let mut kept = match names {
        Names::Shortest => vec![all, with(constants), none],
        Names::Kept => vec![all],
        Names::WrittenOut => vec![none],
    };
    kept.dedup();
    let reading = |kept: FxHashSet<Id>, axes: &[NamedAxes]| {
        let mut expansion = Expansion::new(graph, problem, derived, kept);
        if !axes.is_empty() {
            expansion.name_tensors((problem, derived, letters), axes);
        }
        expansion.name(roots);
        Reading(RefCell::new(expansion))
    };
    let turned = if axes.is_empty() { Vec::new() } else { kept.clone() };
    let plain = kept.into_iter().map(|kept| reading(kept, &[]));
    plain.chain(turned.into_iter().map(|kept| reading(kept, axes))).collect()
}

/// Form in which definitions appear: by name or written out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Names {
    /// Whichever is shorter.
    Shortest,
    Kept,
    WrittenOut,
}

/// Definitions that depend on neither time nor state.
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
