//! Shared state of the sections of a page: the system, its equations and their readings.

use rustc_hash::{FxHashMap, FxHashSet};

use super::arrays::Arrays;
use super::formula::Formula;
use super::length::symbols;
use super::motion::vector;
use super::reading::{Names, Reading, constants, readings};
use super::roots::{NamedRoot, named_roots};
use crate::mechanics::Derived;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Node};
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
    pub(super) leads: Vec<(u8, u32, u32)>,
    /// Rank of each parameter in the order of the fields.
    pub(super) ranks: Vec<usize>,
    /// Definitions that depend on neither time nor state.
    pub(super) constants: FxHashSet<Id>,
    pub(super) names: Names,
    pub(super) readings: Vec<Reading<'a>>,
    pub(super) arrays: Arrays,
    pub(super) roots: Vec<NamedRoot>,
    /// Definitions that are vectors, with the numbers of their components.
    pub(super) vectors: Vec<(Formula, usize)>,
    /// Definitions that depend on the velocities, and the vectors that they are components of.
    pub(super) moving: Vec<Formula>,
    /// Entries of the mass matrix, which have no names, where a reading is shorter than the computed form.
    pub(super) entries: FxHashMap<Id, Formula>,
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
        let roots = named_roots(graph, problem);
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
            names,
            readings: readings((graph, problem, derived), &constants, &roots, names),
            constants,
            arrays: Arrays::of(problem, &derived.turnings),
            roots,
            vectors: problem.vectors.iter().map(|(name, n)| (Formula::labelled(name, 0), *n)).collect(),
            entries: FxHashMap::default(),
        };
        page.entries = page.short_entries();
        page
    }
}

/// Definitions that depend on the velocities, and the vectors that they are components of.
fn moving(problem: &Problem, leads: &[(u8, u32, u32)]) -> Vec<Formula> {
    let names = problem.names.iter().filter(|(id, _)| leads[id.index()].0 == 0).map(|(_, name)| name);
    let mut all: Vec<&str> = names.flat_map(|name| [Some(name.as_str()), vector(name)]).flatten().collect();
    all.sort_unstable();
    all.dedup();
    all.into_iter().map(|name| Formula::labelled(name, 0)).collect()
}

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
    let products = products(declaration);
    let mut sorted: Vec<String> = Vec::new();
    while !fields.is_empty() {
        // Number of fields left that products have before this one more often than behind it.
        let behind = |name: &String| {
            let count = |one: &String, other: &String| {
                products.iter().filter(|[a, b]| a == one && b == other).count()
            };
            fields.iter().filter(|other| count(other, name) > count(name, other)).count()
        };
        let first = (0..fields.len()).min_by_key(|&place| behind(&fields[place])).unwrap_or_default();
        sorted.push(fields.remove(first));
    }
    let place = |k: usize| sorted.iter().position(|name| *name == field(k));
    let mut ranks = vec![0; order.len()];
    let mut order = order;
    order.sort_by_key(|&k| place(k));
    order.into_iter().enumerate().for_each(|(rank, parameter)| ranks[parameter] = rank);
    ranks
}

/// Pairs of names of which the first comes before the second in a product.
fn products(declaration: &Declaration) -> Vec<[String; 2]> {
    let mut pending: Vec<&Expression> = declaration.lagrangian.iter().collect();
    pending.extend(declaration.defines.iter().map(|define| &define.body));
    let mut pairs = Vec::new();
    while let Some(expression) = pending.pop() {
        if let Kind::Product(factors) = &expression.kind {
            let above = factors.iter().filter(|(operator, _)| *operator == Operator::Times);
            let names: Vec<&str> = above.filter_map(|(_, factor)| named(factor)).collect();
            let pair = |(i, one): (usize, &&str)| {
                let one = (*one).to_owned();
                names[i + 1..].iter().map(|other| [one.clone(), (*other).to_owned()]).collect::<Vec<_>>()
            };
            pairs.extend(names.iter().enumerate().flat_map(pair).filter(|[one, other]| one != other));
        }
        pending.extend(expression.parts());
    }
    pairs
}

/// Name that an expression is, or is a power or an entry of.
fn named(expression: &Expression) -> Option<&str> {
    match &expression.kind {
        Kind::Name(name) => Some(&name.text),
        Kind::Index(base, _) | Kind::Power(base, _) => named(base),
        _ => None,
    }
}

/// Place of each node in a sum: those with momenta and velocities come first, then those with coordinates, with parameters
/// alone, and with time, as in a + b t. Among them, those of one variable come before those of several, in the order of the variables.
fn leads(graph: &Graph) -> Vec<(u8, u32, u32)> {
    let mut masks: Vec<[u128; 2]> = Vec::with_capacity(graph.len());
    let mut kinds: Vec<u8> = Vec::with_capacity(graph.len());
    for id in graph.ids() {
        let (mut kind, mut mask) = match graph.node(id) {
            Node::Symbol(symbol) => match Variable::of(*symbol) {
                Variable::Momentum(i) | Variable::Velocity(i) => (0, [bit(i), 0]),
                Variable::Coordinate(i) => (1, [0, bit(i)]),
                Variable::Time => (2, [0; 2]),
                Variable::Parameter(_) => (3, [0; 2]),
                _ => (4, [0; 2]),
            },
            _ => (5, [0; 2]),
        };
        graph.operands(id, |operand| {
            kind = kind.min(kinds[operand.index()]);
            let inner = masks[operand.index()];
            mask = [mask[0] | inner[0], mask[1] | inner[1]];
        });
        kinds.push(kind);
        masks.push(mask);
    }
    let place = |(kind, [velocities, coordinates]): (u8, [u128; 2])| {
        let mask = if kind == 0 { velocities } else { coordinates };
        let kind = match kind {
            2 => 3,
            3 => 2,
            kind => kind,
        };
        (kind, mask.count_ones(), mask.trailing_zeros())
    };
    kinds.into_iter().zip(masks).map(place).collect()
}

/// One bit for each of the first 127 coordinates, and one for all others.
fn bit(i: usize) -> u128 {
    1 << i.min(127)
}
