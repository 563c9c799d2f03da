//! Normal form of an expression with sums: Σ over loops of expressions without sums.

use crate::resolve::Problem;
use crate::resolve::many::{Range, Total, totals};
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

/// A factor times an expression, summed over nested loops. Without loops it stands alone.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    /// Ranges of the loops, outermost first; the running index of each has its depth.
    pub(crate) ranges: Vec<Range>,
    /// Derivative of a function of a sum, which is one for a sum itself. It is a number where the expression is differentiated.
    pub(crate) factor: Id,
    /// An expression whose own sums are numbers, too: patterns of their own have their derivatives.
    pub(crate) body: Id,
}

/// Writes the derivatives of an expression as those of patterns, one for each set of loops.
pub(crate) fn patterns(graph: &mut Graph, problem: &Problem, root: Id) -> Vec<Pattern> {
    within(graph, problem, &[], root)
}

/// The same of an expression in the body of loops.
pub(super) fn within(graph: &mut Graph, problem: &Problem, ranges: &[Range], body: Id) -> Vec<Pattern> {
    let mut all: Vec<Pattern> = Vec::new();
    collect(graph, problem, Pattern { ranges: ranges.to_vec(), factor: Id::ONE, body }, &mut all);
    all
}

fn collect(graph: &mut Graph, problem: &Problem, whole: Pattern, all: &mut Vec<Pattern>) {
    let inner = totals(graph, &[whole.body]);
    let symbols: Vec<Symbol> = inner.iter().map(|&k| Variable::Total(k).symbol()).collect();
    let factors = graph.gradient(whole.body, &symbols);
    let in_functions = totals(graph, &factors);
    let is_linear =
        |(k, factor): &(usize, Id)| !in_functions.contains(k) && totals(graph, &[*factor]).is_empty();
    let (linear, others): (Vec<_>, Vec<_>) = inner.into_iter().zip(factors).partition(is_linear);
    let of_linear: Vec<Symbol> = linear.iter().map(|(k, _)| Variable::Total(*k).symbol()).collect();
    let alone = graph.substituted(whole.body, |symbol| of_linear.contains(&symbol).then_some(Id::ZERO));
    push(graph, Pattern { body: alone, ..whole.clone() }, all);
    let within = |k: usize| {
        let Total { range, body, .. } = problem.many.totals[k].clone();
        (([&whole.ranges[..], &[range]]).concat(), body)
    };
    for (k, factor) in linear {
        let (ranges, body) = within(k);
        let body = graph.mul(factor, body);
        collect(graph, problem, Pattern { ranges, factor: whole.factor, body }, all);
    }
    for (k, factor) in others {
        let (ranges, body) = within(k);
        let factor = graph.mul(whole.factor, factor);
        collect(graph, problem, Pattern { ranges, factor, body }, all);
    }
}

/// True if no momentum of these patterns contains a sum: its rate of change and the mass matrix are those of each pattern alone.
pub(crate) fn have_momenta_of_their_own(graph: &mut Graph, patterns: &[Pattern]) -> bool {
    patterns.iter().all(|Pattern { factor, body, .. }| {
        let slots = super::slots(graph, *body);
        let mut momenta = super::gradient(graph, *body, &slots, Variable::Velocity);
        momenta.retain(|&momentum| momentum != Id::ZERO);
        totals(graph, &momenta).is_empty() && (momenta.is_empty() || *factor == Id::ONE)
    })
}

/// Adds a pattern to the one with the same loops and the same factor.
fn push(graph: &mut Graph, pattern: Pattern, all: &mut Vec<Pattern>) {
    let is_same = |known: &&mut Pattern| known.ranges == pattern.ranges && known.factor == pattern.factor;
    match all.iter_mut().find(is_same) {
        _ if pattern.body == Id::ZERO => {}
        Some(known) => known.body = graph.add(known.body, pattern.body),
        None => all.push(pattern),
    }
}

impl Problem {
    /// The sum of a body over nested loops, as one expression.
    pub(crate) fn summed(&mut self, graph: &mut Graph, ranges: &[Range], body: Id) -> Id {
        ranges.iter().enumerate().rfold(body, |body, (level, range)| {
            self.many.total(graph, Total { level, range: range.clone(), body })
        })
    }
}
