//! Do the constraints say different things, and can all of them hold?
//!
//! Φ = 0 and, from it, dΦ/dt = 0 are linear equations in the products and functions that they are sums of. Eliminating
//! those with a coordinate or a velocity in them, by exact arithmetic, may leave an equation without any. If it holds, a
//! constraint follows from others; if it cannot hold, they contradict each other.

use num_traits::One;
use rustc_hash::FxHashMap;

use super::constraints::{ConstraintKind, Constraints};
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Node, Rational, Sample};
use crate::variables::Variable;

/// So many random points are tried before an expression is taken to be zero.
const DRAWS: u64 = 8;

/// Reports every constraint that repeats or contradicts others.
pub(super) fn check(
    graph: &Graph,
    problem: &Problem,
    constraints: &Constraints,
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    let count = constraints.kinds.len();
    let written = (0..count).map(|index| (index, problem.constraints[index].1));
    let holonomic = (0..count).filter(|&index| constraints.kinds[index] == ConstraintKind::Holonomic);
    let rates = holonomic.map(|index| (index, constraints.rate[index]));
    let (owners, equations): (Vec<usize>, Vec<Id>) = written.chain(rates).unzip();
    // In a graph of its own, without the boundaries of definitions.
    let mut scratch = Graph::default();
    let equations = scratch.copied(graph, &equations);
    let (mut solved, mut wrong) = (Solved::default(), vec![false; count]);
    for (number, (&index, equation)) in owners.iter().zip(equations).enumerate() {
        let Some((rest, combined)) = solved.eliminate(&mut scratch, number, equation) else { continue };
        let mut others: Vec<usize> = combined.into_iter().map(|number| owners[number]).collect();
        others.sort_unstable();
        others.dedup();
        others.retain(|&other| other != index);
        if let Some(message) = fault(&scratch, problem, index, &others, rest, number < count)
            && !std::mem::replace(&mut wrong[index], true)
        {
            let mut error = problem.constraints[index].0.place.error(message);
            for other in others {
                error.combine(problem.constraints[other].0.place.error("the other one is here"));
            }
            diagnostics.push(error);
        }
    }
    diagnostics.is_empty().then_some(())
}

/// What is wrong if the constraint and others come to `rest` = 0. A parameter may have any value when the program runs:
/// what is left of two constraints is then zero, and they say the same, or it is not, and they contradict each other.
fn fault(
    graph: &Graph,
    problem: &Problem,
    index: usize,
    others: &[usize],
    rest: Id,
    is_written: bool,
) -> Option<String> {
    let name = |index: usize| format!("`{}`", problem.constraints[index].0.text);
    let (this, those) = (name(index), others.iter().map(|&other| name(other)).collect::<Vec<_>>().join(", "));
    if rest == Id::ZERO {
        let is_repeated = is_written && others.len() == 1;
        return is_repeated.then(|| format!("{this} says the same as {those}: leave one of them out"));
    }
    if others.is_empty() || !is_surely_something(graph, problem, rest) {
        return None;
    }
    if let Some(number) = graph.as_number(rest) {
        return Some(format!("{this} contradicts {those}: together they say {number} = 0"));
    }
    let names = unknown(graph, problem, rest);
    match (names.len(), others.len()) {
        (0, _) => Some(format!(
            "{this} contradicts {those}: together they leave an equation without a coordinate that does not hold at all times"
        )),
        (_, 1) => Some(format!(
            "{this} contradicts {those}, or says the same: together they leave an equation in {} without a coordinate. Leave one of them out",
            names.join(", ")
        )),
        _ => None,
    }
}

/// The parameters and supplied functions in an expression.
fn unknown(graph: &Graph, problem: &Problem, root: Id) -> Vec<String> {
    let named = |id: &Id| match graph.node(*id) {
        Node::Symbol(symbol) => match Variable::of(*symbol) {
            Variable::Parameter(k) => Some(format!("`{}`", problem.parameters.name(k))),
            _ => None,
        },
        Node::External(external) => Some(format!("`{}`", problem.functions[external.function as usize].name)),
        _ => None,
    };
    graph.reachable(&[root]).iter().filter_map(named).collect()
}

/// Whether a value of it has an error bound that excludes 0.
fn is_surely_something(graph: &Graph, problem: &Problem, root: Id) -> bool {
    (0..DRAWS).any(|draw| {
        let mut sample =
            Sample::new(graph.symbols(&[root]), draw, |symbol, draw| problem.drawn(symbol, draw));
        sample.values(graph, &[root])[0].excludes_zero()
    })
}

/// Equations solved for a term each.
#[derive(Default)]
struct Solved(FxHashMap<Id, Id>);

impl Solved {
    /// What is left of an equation, and of which it is then a combination, if no coordinate is left in it. Each
    /// equation bears a symbol of its own, which goes with it through all sums.
    fn eliminate(&mut self, graph: &mut Graph, number: usize, equation: Id) -> Option<(Id, Vec<usize>)> {
        let mark = graph.symbol(Variable::Multiplier(number).symbol());
        let mut rest = graph.add(equation, mark);
        while let Some((solved, c)) =
            terms(graph, rest).into_iter().find_map(|(term, c)| Some((*self.0.get(&term)?, c)))
        {
            rest = graph.sum([(rest, Rational::one()), (solved, -c)]);
        }
        // What has no value, or cannot be written, is reported elsewhere.
        graph.take_fault().is_none().then_some(())?;
        let moving = terms(graph, rest).into_iter().find(|&(term, _)| is_moving(graph, term));
        if let Some((term, c)) = moving {
            let row = graph.sum([(rest, c.recip())]);
            self.0.insert(term, row);
            return None;
        }
        let (marks, left): (Vec<_>, Vec<_>) =
            terms(graph, rest).into_iter().partition(|&(term, _)| equation_of(graph, term).is_some());
        let marks = marks.into_iter().filter_map(|(mark, _)| equation_of(graph, mark)).collect();
        Some((graph.sum(left), marks))
    }
}

/// Σ coefficient · term
fn terms(graph: &Graph, root: Id) -> Vec<(Id, Rational)> {
    match graph.node(root) {
        Node::Sum(terms) => terms.to_vec(),
        _ => vec![(root, Rational::one())],
    }
}

fn is_moving(graph: &Graph, term: Id) -> bool {
    graph
        .symbols(&[term])
        .any(|symbol| matches!(Variable::of(symbol), Variable::Coordinate(_) | Variable::Velocity(_)))
}

fn equation_of(graph: &Graph, term: Id) -> Option<usize> {
    match graph.node(term) {
        Node::Symbol(symbol) => match Variable::of(*symbol) {
            Variable::Multiplier(number) => Some(number),
            _ => None,
        },
        _ => None,
    }
}
