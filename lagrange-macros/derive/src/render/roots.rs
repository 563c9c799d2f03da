//! Roots that have a name: distances r = √(x² + y²), and Lorentz factors γ = 1/√(1 − v²/c²).
//!
//! A root that a definition equals has the name of the definition. Of all others, those of sums of squares of coordinates and
//! those that are 1 at rest are given one, on a line of their own.

use num_traits::{One, Signed};
use rustc_hash::FxHashSet;

use super::formula::Formula;
use super::lines::{Equation, Line};
use super::notation::Notation;
use super::page::Page;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Node, Rational};
use crate::variables::{Variable, has_velocity};

/// The name of √X, or of 1/√X.
#[derive(Clone)]
pub(super) struct NamedRoot {
    pub(super) name: Formula,
    /// The sum X.
    pub(super) base: Id,
    /// True for a name of 1/√X.
    pub(super) is_below: bool,
    /// The definition that gives the name, if there is one.
    pub(super) definition: Option<Id>,
}

/// All named roots of a system.
pub(super) fn named_roots(graph: &Graph, problem: &Problem) -> Vec<NamedRoot> {
    let mut roots = defined(graph, problem);
    let known: FxHashSet<Id> = roots.iter().map(|root| root.base).collect();
    let found = || bases(graph, problem.lagrangian).into_iter().filter(|base| !known.contains(base));
    let mut distances: Vec<Id> = found().filter(|&base| is_distance(graph, base)).collect();
    // The norm |a − b| reads well, unless there are several.
    distances.retain(|&base| !is_norm(graph, problem, base) || is_difference(graph, base));
    if let [single] = distances[..]
        && is_norm(graph, problem, single)
    {
        distances.clear();
    }
    let factors: Vec<Id> = found().filter(|&base| is_one_at_rest(graph, base)).collect();
    let taken = taken(problem);
    let is_free = |name: &Formula| !taken.contains(&Notation::UNICODE.write(name));
    for (bases, letters, is_below) in
        [(distances, &["r", "d", "rho"][..], false), (factors, &["gamma", "Gamma"][..], true)]
    {
        let pairs = pairs(graph, problem, &bases);
        let names = letters.iter().find_map(|letter| names(bases.len(), pairs.as_deref(), letter, is_free));
        let named = bases.iter().zip(names.into_iter().flatten());
        roots.extend(named.map(|(&base, name)| NamedRoot { name, base, is_below, definition: None }));
    }
    roots
}

/// Definitions that are roots.
fn defined(graph: &Graph, problem: &Problem) -> Vec<NamedRoot> {
    let mut names: Vec<(&Id, &String)> = problem.names.iter().collect();
    names.sort();
    let root = |(&id, name): (&Id, &String)| {
        let Node::Defined(inner) = graph.node(id) else { return None };
        let Node::Product(factors) = graph.node(*inner) else { return None };
        let [(base, exponent)] = factors[..] else { return None };
        let is_root = exponent.abs() == Rational::new_raw(1, 2) && is_sum(graph, base);
        let (name, definition) = (Formula::labelled(name, 0), Some(id));
        is_root.then(|| NamedRoot { name, base, is_below: exponent.is_negative(), definition })
    };
    names.into_iter().filter_map(root).collect()
}

/// Sums under square roots below a node, in the order of the nodes.
pub(super) fn bases(graph: &Graph, root: Id) -> Vec<Id> {
    let mut bases = Vec::new();
    for id in graph.reachable(&[root]) {
        let Node::Product(factors) = graph.node(id) else { continue };
        for &(base, exponent) in factors {
            if *exponent.denom() == 2 && is_sum(graph, base) && !bases.contains(&base) {
                bases.push(base);
            }
        }
    }
    bases
}

fn is_sum(graph: &Graph, id: Id) -> bool {
    matches!(graph.node(id), Node::Sum(terms) if terms.len() > 1)
}

/// True for a sum of squares, each of coordinates, and of constants beside them.
fn is_distance(graph: &Graph, base: Id) -> bool {
    let Node::Sum(terms) = graph.node(base) else { return false };
    let is_square = |&(term, coefficient): &(Id, Rational)| {
        let is_even = |exponent: Rational| exponent == Rational::from_integer(2);
        coefficient.is_one()
            && matches!(graph.node(term), Node::Product(factors) if matches!(factors[..], [(_, e)] if is_even(e)))
    };
    let variables: Vec<Variable> = graph.symbols(&[base]).map(Variable::of).collect();
    terms.iter().all(is_square)
        && variables.iter().any(|variable| matches!(variable, Variable::Coordinate(_)))
        && variables
            .iter()
            .all(|variable| matches!(variable, Variable::Coordinate(_) | Variable::Parameter(_)))
}

/// True if only components of vectors occur.
fn is_norm(graph: &Graph, problem: &Problem, base: Id) -> bool {
    graph.symbols(&[base]).map(Variable::of).all(|variable| match variable {
        Variable::Coordinate(i) => problem.coordinates[i].text.ends_with(']'),
        Variable::Parameter(k) => problem.parameters.name(k).ends_with(']'),
        _ => false,
    })
}

/// True if one of the squares is that of a sum.
fn is_difference(graph: &Graph, base: Id) -> bool {
    let squares = graph.reachable(&[base]).into_iter().filter(|&id| id != base);
    squares.into_iter().any(|id| is_sum(graph, id))
}

/// True for 1 − …, where all other terms are powers of velocities.
fn is_one_at_rest(graph: &Graph, base: Id) -> bool {
    let Node::Sum(terms) = graph.node(base) else { return false };
    terms.iter().all(|&(term, c)| match term == Id::ONE {
        true => c.is_one(),
        false => c.is_negative() && has_velocity(graph, &[term]),
    }) && terms.iter().any(|&(term, _)| term == Id::ONE)
}

/// Names r, or r₁₂ of two bodies and r₁ of one, or r₁, r₂, …; `None` if one of them is not free. Beside a vector r, r₁ would be read as its
/// component.
fn names(
    count: usize,
    pairs: Option<&[String]>,
    letter: &str,
    is_free: impl Fn(&Formula) -> bool,
) -> Option<Vec<Formula>> {
    let name = |text: &str| Formula::labelled(text, 0);
    let names: Vec<Formula> = match (count, pairs) {
        (1, _) => vec![name(letter)],
        (_, Some(pairs)) => pairs.iter().map(|pair| name(&format!("{letter}_{pair}"))).collect(),
        _ => (1..=count).map(|number| name(&format!("{letter}_{number}"))).collect(),
    };
    let is_clear = pairs.is_some() || is_free(&name(letter));
    (is_clear && names.iter().all(is_free)).then_some(names)
}

/// The bodies of each distance, one or two, if these are all different.
fn pairs(graph: &Graph, problem: &Problem, bases: &[Id]) -> Option<Vec<String>> {
    let pairs: Vec<String> = bases.iter().map(|&base| pair(graph, problem, base)).collect::<Option<_>>()?;
    let are_different = (1..pairs.len()).all(|place| !pairs[..place].contains(&pairs[place]));
    are_different.then_some(pairs)
}

/// What tells apart the one or two bodies whose coordinates a distance contains: numbers as in x1, x2, or letters as in a, b.
fn pair(graph: &Graph, problem: &Problem, base: Id) -> Option<String> {
    let roots = [base];
    let coordinates = graph.symbols(&roots).filter_map(|symbol| match Variable::of(symbol) {
        Variable::Coordinate(i) => Some(&*problem.coordinates[i].text),
        _ => None,
    });
    let mut bodies: Vec<String> = coordinates.map(body).collect::<Option<_>>()?;
    bodies.sort();
    bodies.dedup();
    let is_pair = bodies.len() <= 2 && bodies.iter().all(|body| body.chars().count() == 1);
    is_pair.then(|| bodies.concat())
}

/// Number of a body: `1` for `x1`, `y_1` and `r[1][0]`; `a` for `a[0]`.
fn body(coordinate: &str) -> Option<String> {
    let mut parts = coordinate.split('[').map(|part| part.trim_end_matches(']'));
    let base = parts.next().unwrap_or_default();
    let indices: Vec<&str> = parts.collect();
    let number = base.trim_start_matches(|sign: char| !sign.is_ascii_digit());
    match (number, &indices[..]) {
        ("", []) => None,
        ("", [_]) => Some(base.to_owned()),
        ("", [body, ..]) => Some((*body).to_owned()),
        (number, _) => Some(number.to_owned()),
    }
}

/// All names of a system, as they are written.
pub(super) fn taken(problem: &Problem) -> FxHashSet<String> {
    let observables = problem.observables.iter().map(|observed| observed.label.text.clone());
    names_of(problem).chain(observables).map(|name| written_base(&name)).collect()
}

/// Names of coordinates, parameters, functions and definitions.
pub(super) fn names_of(problem: &Problem) -> impl Iterator<Item = String> {
    let coordinates = problem.coordinates.iter().map(|label| label.text.clone());
    let parameters = (0..problem.parameters.entries.len()).map(|k| problem.parameters.name(k));
    let functions = problem.functions.iter().flat_map(|function| function.names.clone());
    coordinates.chain(parameters).chain(functions).chain(problem.names.values().cloned())
}

/// True if a name, without its indices, is one of those that are [`taken`].
pub(super) fn is_taken(taken: &FxHashSet<String>, name: &str) -> bool {
    taken.contains(&written_base(name))
}

pub(super) fn written_base(name: &str) -> String {
    let base = name.split(['[', '.']).next().unwrap_or_default();
    Notation::UNICODE.write(&Formula::labelled(base, 0))
}

impl Page<'_> {
    /// Lines of the named roots that these lines mention.
    pub(super) fn root_lines<'l>(&self, lines: impl Iterator<Item = &'l Line> + Clone) -> Vec<Line> {
        let own = self.roots.iter().filter(|root| root.definition.is_none());
        let mentioned = own.filter(|root| lines.clone().any(|line| line.has_name(&root.name)));
        let line = |root: &NamedRoot| {
            let right = self.root(root)?;
            Some(Line::of(Equation::Known(root.name.clone(), right)))
        };
        mentioned.filter_map(line).collect()
    }
}
