//! Shared state of the sections of a page: the system, its equations and their readings.

use num_traits::Signed;
use rustc_hash::{FxHashMap, FxHashSet};

use super::arrays::Arrays;
use super::axes::{NamedAxes, named_axes};
use super::formula::Formula;
use super::length::{length, symbols};
use super::letters::{Letters, PageQuantity};
use super::links::NamedBodies;
use super::many::FamilyLines;
use super::notation::Notation;
use super::reading::{Names, Reading, constants, readings};
use super::roots::{NamedRoot, bases, named_roots};
use crate::mechanics::Derived;
use crate::resolve::{Problem, vector};
use crate::symbolic::{Graph, Id, Node, Rational};
use crate::syntax::{Declaration, Expression, Kind, Operator};
use crate::variables::Variable;

/// A system whose equations are rendered.
pub(super) struct Page<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) graph: &'a Graph,
    pub(super) problem: &'a Problem,
    pub(super) derived: &'a Derived,
    /// Number of symbols of each node, written out.
    pub(super) symbols: Vec<u64>,
    /// Place of each node in a sum, by the variable in it that comes first.
    pub(super) leads: Vec<(u8, u32, u32, u32)>,
    /// Rank of each parameter: in a product, that of the lower rank comes first, as in m g l.
    pub(super) ranks: Vec<usize>,
    /// The same by the names of the parameters.
    pub(super) ranks_by_name: FxHashMap<Formula, usize>,
    /// Definitions that depend on neither time nor state.
    pub(super) constants: FxHashSet<Id>,
    pub(super) names: Names,
    pub(super) readings: Vec<Reading<'a>>,
    /// Letters of the quantities that the page names.
    pub(super) letters: Letters,
    pub(super) arrays: Arrays,
    pub(super) roots: Vec<NamedRoot>,
    /// Norms of vectors in L that have no name, by the sums of which they are the square roots.
    pub(super) norms: FxHashMap<Id, Formula>,
    pub(super) axes: Vec<NamedAxes>,
    /// Names of bodies, once an equation of motion by coordinates is too long to be read.
    pub(super) bodies: Option<NamedBodies>,
    /// Index of the chain rule by which the forces beside the bodies are stated.
    pub(super) chain: usize,
    /// Length of the definition of each of these matrices.
    pub(super) axes_lengths: Vec<usize>,
    /// Definitions that are vectors, with the numbers of their components.
    pub(super) vectors: Vec<(Formula, usize)>,
    /// Definitions that depend on the velocities, and the vectors that they are components of.
    pub(super) moving: Vec<Formula>,
    /// Nodes without names that are written as these formulas: entries of rotation matrices, and entries of the mass matrix where
    /// a reading is shorter than the computed form.
    pub(super) entries: FxHashMap<Id, Formula>,
    /// Equations stated once for all elements of an array.
    pub(super) families: Option<FamilyLines>,
    /// Sums over ranges that are known at run time.
    pub(super) totals: Vec<Formula>,
    /// True if the equations of motion are those of all elements.
    pub(super) is_by_families: bool,
    /// Terms of the sums in the declaration.
    pub(super) sums: Vec<Vec<Formula>>,
}

impl<'a> Page<'a> {
    pub(super) fn new(
        declaration: &'a Declaration,
        graph: &'a Graph,
        problem: &'a Problem,
        derived: &'a Derived,
        names: Names,
    ) -> Self {
        let constants = constants(graph, problem);
        let letters = Letters::of(declaration, problem, derived);
        let roots = named_roots(graph, problem);
        let axes = named_axes(problem, &derived.turnings);
        let leads = leads(graph);
        let mut page = Self {
            declaration,
            graph,
            problem,
            derived,
            symbols: symbols(graph, problem),
            moving: moving(problem, &leads),
            leads,
            ranks: ranks(declaration, problem),
            ranks_by_name: FxHashMap::default(),
            names,
            readings: readings((graph, problem, derived), &constants, (&roots, &axes, &letters), names),
            constants,
            arrays: Arrays::of(problem, derived, &letters),
            letters,
            roots,
            norms: FxHashMap::default(),
            entries: named_entries(&axes, problem, derived),
            bodies: None,
            chain: 0,
            axes_lengths: Vec::new(),
            axes,
            vectors: problem.vectors.iter().map(|(name, n)| (Formula::labelled(name, 0), *n)).collect(),
            families: None,
            totals: Vec::new(),
            is_by_families: false,
            sums: Vec::new(),
        };
        page.write_sums_and_limits();
        let norms = bases(graph, problem.lagrangian).into_iter();
        page.norms = norms.filter_map(|base| Some((base, page.norm(base)?))).collect();
        let by_name =
            page.ranks.iter().enumerate().map(|(k, &rank)| (page.variable(Variable::Parameter(k)), rank));
        page.ranks_by_name = by_name.collect();
        page.sums = page.written_sums();
        let lengths = |axes: &NamedAxes| page.definition(axes).map_or(usize::MAX, |formula| length(&formula));
        page.axes_lengths = page.axes.iter().map(lengths).collect();
        page.entries.extend(page.short_entries());
        page
    }

    /// A notation with the arrays and letters of the page.
    pub(super) fn notation(&self, notation: Notation<'static>) -> Notation<'_> {
        notation.with(&self.arrays, &self.letters)
    }

    /// Lines of all elements of arrays, if the equations of motion are theirs.
    pub(super) fn families(&self) -> Option<&FamilyLines> {
        self.families.as_ref().filter(|_| self.is_by_families)
    }

    /// Momentum of a coordinate, with dots.
    pub(super) fn momentum_name(&self, text: &str, dots: usize) -> Formula {
        self.letters.name_of(PageQuantity::Momentum, text, dots)
    }
}

/// Entries of rotation matrices, and definitions as they stand in equations in angular velocities, by their nodes.
fn named_entries(axes: &[NamedAxes], problem: &Problem, derived: &Derived) -> FxHashMap<Id, Formula> {
    let of = |axes: &NamedAxes| {
        let entries = axes.nodes.iter().map(|&(node, place)| (node, axes.entry(place)));
        entries.collect::<Vec<_>>()
    };
    let renamed = derived.turnings.renamed.iter();
    let renamed = renamed.map(|(node, definition)| (*node, Formula::labelled(&problem.names[definition], 0)));
    axes.iter().flat_map(of).chain(renamed).collect()
}

/// Definitions that depend on the velocities, and the vectors that they are components of.
fn moving(problem: &Problem, leads: &[(u8, u32, u32, u32)]) -> Vec<Formula> {
    let names = problem.names.iter().filter(|(id, _)| leads[id.index()].0 == 0).map(|(_, name)| name);
    let mut all: Vec<&str> = names.flat_map(|name| [Some(name.as_str()), vector(name)]).flatten().collect();
    all.sort_unstable();
    all.dedup();
    all.into_iter().map(|name| Formula::labelled(name, 0)).collect()
}

/// Most names in a definition that stand in its place where the order of factors is found.
const FEW: usize = 4;

/// Rank of each parameter: in products, parameters stand in the order in which the Lagrangian and the definitions multiply
/// them, and else in that of the fields.
fn ranks(declaration: &Declaration, problem: &Problem) -> Vec<usize> {
    let order = problem.parameters.by_field();
    let field = |k: usize| {
        let name = problem.parameters.name(k);
        name.split(['[', '.']).next().unwrap_or_default().to_owned()
    };
    let mut fields: Vec<String> = order.iter().map(|&k| field(k)).collect();
    fields.dedup();
    let sorted = in_order_of(&fields, &products(declaration));
    let place = |k: usize| sorted.iter().position(|name| *name == field(k));
    let mut ranks = vec![0; order.len()];
    let mut order = order;
    order.sort_by_key(|&k| place(k));
    order.into_iter().enumerate().for_each(|(rank, parameter)| ranks[parameter] = rank);
    ranks
}

/// The fields, each right after those that the products demand to come before it; a cycle is cut where it is entered.
fn in_order_of(fields: &[String], products: &[[String; 2]]) -> Vec<String> {
    let is_before = |one: &str, other: &str| {
        let count = |one, other| products.iter().filter(|[a, b]| a == one && b == other).count();
        count(one, other) > count(other, one)
    };
    let (mut sorted, mut pending): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    for field in fields {
        pending.push(field.clone());
        while let Some(next) = pending.last().cloned() {
            let is_free = |other: &&String| !sorted.contains(other) && !pending.contains(other);
            match fields.iter().find(|other| is_free(other) && is_before(other, &next)) {
                Some(other) => pending.push(other.clone()),
                None => sorted.extend(pending.pop().filter(|name| !sorted.contains(name))),
            }
        }
    }
    sorted
}

/// Pairs of names of which the first comes before the second in a product.
fn products(declaration: &Declaration) -> Vec<[String; 2]> {
    let mut pending: Vec<&Expression> = declaration.lagrangian.iter().collect();
    pending.extend(declaration.defines.iter().map(|define| &define.body));
    let definitions = definitions(declaration);
    let mut pairs = Vec::new();
    while let Some(expression) = pending.pop() {
        if let Kind::Product(factors) = &expression.kind {
            let above = factors.iter().filter(|(operator, _)| *operator == Operator::Times);
            let factors: Vec<Vec<&str>> = above.map(|(_, factor)| named(factor, &definitions)).collect();
            for (i, factor) in factors.iter().enumerate() {
                for one in factor {
                    let behind = factors[i + 1..].iter().flatten().filter(|other| *other != one);
                    pairs.extend(behind.map(|other| [one, other].map(|name| (*name).to_owned())));
                }
            }
        }
        pending.extend(expression.parts());
    }
    pairs
}

/// Names in each definition, for those with few.
type Definitions<'d> = FxHashMap<&'d str, Vec<&'d str>>;

fn definitions(declaration: &Declaration) -> Definitions<'_> {
    let mut known = Definitions::default();
    for define in declaration.defines.iter().filter(|define| define.formals.is_none()) {
        let mut names = named(&define.body, &known);
        names.dedup();
        if names.len() <= FEW {
            known.insert(&define.target.name.text, names);
        }
    }
    known
}

/// Names that a factor is, or is a power or an entry of, or a sum of products of. In the place of a definition stand the names
/// in it: m g y with y = l cos θ has them in the order m, g, l.
fn named<'e>(expression: &'e Expression, definitions: &Definitions<'e>) -> Vec<&'e str> {
    let all = |parts: &mut dyn Iterator<Item = &'e Expression>| {
        parts.flat_map(|part| named(part, definitions)).collect()
    };
    match &expression.kind {
        Kind::Name(name) => definitions.get(name.text.as_str()).cloned().unwrap_or_else(|| vec![&name.text]),
        Kind::Index(base, _) | Kind::Power(base, _) => named(base, definitions),
        Kind::Sum(terms) => all(&mut terms.iter().map(|(_, term)| term)),
        Kind::Product(factors) => all(&mut factors.iter().map(|(_, factor)| factor)),
        _ => Vec::new(),
    }
}

/// Place of each node in a sum: nodes with momenta and velocities come first, then those with coordinates, with
/// parameters alone, and with time, as in a + b t. Of one kind, nodes of one variable come before those of several, in the
/// order of the variables.
/// A sum as a factor has the place of its first term.
fn leads(graph: &Graph) -> Vec<(u8, u32, u32, u32)> {
    let mut places: Vec<TermPlace> = Vec::with_capacity(graph.len());
    for id in graph.ids() {
        let mut place = match graph.node(id) {
            Node::Symbol(symbol) => match Variable::of(*symbol) {
                Variable::Momentum(i) | Variable::Velocity(i) => TermPlace::of(0, [bit(i), 0]),
                Variable::Coordinate(i) => TermPlace::of(1, [0, bit(i)]),
                Variable::Time => TermPlace::of(2, [0; 2]),
                Variable::Parameter(_) => TermPlace::of(3, [0; 2]),
                _ => TermPlace::of(4, [0; 2]),
            },
            _ => TermPlace::of(5, [0; 2]),
        };
        let is_sum = matches!(graph.node(id), Node::Sum(_));
        let is_natural = |exponent: Rational| exponent.is_integer() && exponent.is_positive();
        graph.operands(id, |operand| {
            let is_whole = match graph.node(id) {
                Node::Sum(_) | Node::Defined(_) => false,
                Node::Product(factors) => {
                    factors.iter().any(|&(factor, e)| factor == operand && !is_natural(e))
                }
                _ => true,
            };
            let inner = places[operand.index()];
            place = place.with(if is_whole { TermPlace::of(inner.kind, inner.all) } else { inner }, is_sum);
        });
        places.push(place);
    }
    places.into_iter().map(TermPlace::key).collect()
}

/// Kind of a term, and the velocities and coordinates in it: those of the first term if it is a sum, and all.
#[derive(Clone, Copy)]
struct TermPlace {
    kind: u8,
    first: [u128; 2],
    all: [u128; 2],
}

impl TermPlace {
    const fn of(kind: u8, variables: [u128; 2]) -> Self {
        Self { kind, first: variables, all: variables }
    }

    /// Place of a node to which an operand is added.
    fn with(self, operand: Self, is_sum: bool) -> Self {
        let both = |one: [u128; 2], other: [u128; 2]| [one[0] | other[0], one[1] | other[1]];
        let first = match is_sum {
            true if self.key() <= operand.key() => self.first,
            true => operand.first,
            false => both(self.first, operand.first),
        };
        Self { kind: self.kind.min(operand.kind), first, all: both(self.all, operand.all) }
    }

    /// Kind, number and first of the velocities if there are any, else of the coordinates; number in the other terms of a sum.
    fn key(self) -> (u8, u32, u32, u32) {
        let of_kind =
            |[velocities, coordinates]: [u128; 2]| if self.kind == 0 { velocities } else { coordinates };
        let [first, all] = [self.first, self.all].map(of_kind);
        let kind = match self.kind {
            2 => 3,
            3 => 2,
            kind => kind,
        };
        (kind, first.count_ones(), first.trailing_zeros(), all.count_ones())
    }
}

/// One bit for each of the first 127 coordinates, and one for all others.
fn bit(i: usize) -> u128 {
    1 << i.min(127)
}
