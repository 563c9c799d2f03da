//! Normal form of an expression with sums: Σ over loops of expressions without sums.

use crate::resolve::Problem;
use crate::resolve::many::{Range, Total, totals};
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

/// An expression without sums, summed over nested loops. Without loops it stands alone.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    /// Ranges of the loops, outermost first; the running index of each has its depth.
    pub(crate) ranges: Vec<Range>,
    pub(crate) body: Id,
}

/// Writes an expression as a sum of patterns, one for each set of loops; `None` if a sum is in a function or is multiplied by
/// another one.
pub(crate) fn patterns(graph: &mut Graph, problem: &Problem, root: Id) -> Option<Vec<Pattern>> {
    let mut all: Vec<Pattern> = Vec::new();
    collect(graph, problem, (Vec::new(), root), &mut all)?;
    Some(all)
}

fn collect(
    graph: &mut Graph,
    problem: &Problem,
    (ranges, root): (Vec<Range>, Id),
    all: &mut Vec<Pattern>,
) -> Option<()> {
    let inner = totals(graph, &[root]);
    let symbols: Vec<Symbol> = inner.iter().map(|&k| Variable::Total(k).symbol()).collect();
    let factors = graph.gradient(root, &symbols);
    totals(graph, &factors).is_empty().then_some(())?;
    let alone = graph.substituted(root, |symbol| symbols.contains(&symbol).then_some(Id::ZERO));
    push(graph, Pattern { ranges: ranges.clone(), body: alone }, all);
    for (k, factor) in inner.into_iter().zip(factors) {
        let Total { range, body, .. } = problem.many.totals[k].clone();
        let body = graph.mul(factor, body);
        let ranges = [&ranges[..], &[range]].concat();
        collect(graph, problem, (ranges, body), all)?;
    }
    Some(())
}

/// Adds a pattern to the one with the same loops.
fn push(graph: &mut Graph, pattern: Pattern, all: &mut Vec<Pattern>) {
    match all.iter_mut().find(|known| known.ranges == pattern.ranges) {
        _ if pattern.body == Id::ZERO => {}
        Some(known) => known.body = graph.add(known.body, pattern.body),
        None => all.push(pattern),
    }
}

impl Problem {
    /// The sum of a body over nested loops, as one expression.
    pub(crate) fn summed(&mut self, graph: &mut Graph, ranges: &[Range], body: Id) -> Id {
        ranges.iter().enumerate().rfold(body, |body, (level, range)| {
            let (k, _) = self.many.totals.insert_full(Total { level, range: range.clone(), body });
            graph.symbol(Variable::Total(k).symbol())
        })
    }
}
