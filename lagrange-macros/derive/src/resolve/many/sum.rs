//! Sums and families over ranges that are known at run time.

use super::{Affine, Many, Range, Total, Unknown};
use crate::resolve::lowering::Lowering;
use crate::resolve::value::Value;
use crate::symbolic::{Forward, Graph, Id, Node};
use crate::syntax::{Expression, Name, SumOver, TargetIndex};
use crate::variables::Variable;

impl Many {
    /// A sum as a node of the graph.
    pub(crate) fn total(&mut self, graph: &mut Graph, total: Total) -> Id {
        if total.body == Id::ZERO {
            return Id::ZERO;
        }
        let (k, _) = self.totals.insert_full(total);
        graph.symbol(Variable::Total(k).symbol())
    }

    /// Largest number of nested loops.
    pub(crate) fn deepest(&self, graph: &Graph) -> usize {
        let levels = graph.ids().filter_map(|id| match graph.node(id) {
            Node::Symbol(symbol) => match Variable::of(*symbol) {
                Variable::Level(level) => Some(level + 1),
                _ => None,
            },
            _ => None,
        });
        levels.max().unwrap_or(0)
    }

    /// Adds the rates of the sums in these nodes to a total time derivative: sums of the rates.
    pub(crate) fn follow_totals(&mut self, graph: &mut Graph, rate: &mut Forward, roots: &[Id]) {
        for k in totals(graph, roots) {
            let Total { level, range, body } = self.totals[k].clone();
            self.follow_totals(graph, rate, &[body]);
            let body = rate.of(graph, body);
            let of_sum = self.total(graph, Total { level, range, body });
            rate.also([(Variable::Total(k).symbol(), of_sum)]);
        }
    }

    /// These nodes, and the bodies of all sums in them.
    pub(crate) fn with_bodies(&self, graph: &Graph, roots: &[Id]) -> Vec<Id> {
        self.with_bodies_from(graph, roots, 0)
    }

    /// These nodes, and the bodies of sums in them that have at least this depth. In shallower sums the index means another loop.
    pub(crate) fn with_bodies_from(&self, graph: &Graph, roots: &[Id], depth: usize) -> Vec<Id> {
        let (mut all, mut pending) = (roots.to_vec(), roots.to_vec());
        while let Some(root) = pending.pop() {
            for total in totals(graph, &[root]) {
                let Total { level, body, .. } = self.totals[total];
                if level >= depth && !all.contains(&body) {
                    all.push(body);
                    pending.push(body);
                }
            }
        }
        all
    }

    /// Minimum and maximum of a number over the iterations of the current loops, none of which is empty.
    pub(in crate::resolve) fn bounds(&self, number: &Affine) -> [Affine; 2] {
        let bound = |is_most: bool| {
            let mut bound = number.clone();
            for (level, range) in self.ranges.iter().enumerate().rev() {
                let index = Unknown::Level(level);
                let grows = bound.factor(index) > 0;
                let by = if grows == is_most { range.to.plus_number(-1) } else { range.from.clone() };
                bound = bound.with(index, &by);
            }
            bound
        };
        [bound(false), bound(true)]
    }
}

/// Sums over ranges that occur in these nodes, but not those within their bodies.
pub(crate) fn totals(graph: &Graph, roots: &[Id]) -> Vec<usize> {
    let mut found: Vec<usize> = graph
        .symbols(roots)
        .filter_map(|symbol| match Variable::of(symbol) {
            Variable::Total(k) => Some(k),
            _ => None,
        })
        .collect();
    found.sort_unstable();
    found
}

impl Lowering<'_> {
    /// Lowers a sum over a range that is known at run time. Returns an outer `None` for a constant range.
    pub(in crate::resolve) fn open_sum(&mut self, sum: &SumOver) -> Option<Option<Value>> {
        let errors = self.diagnostics.count();
        let range = self.open_range(&sum.from, &sum.to)?;
        let value = range.and_then(|range| self.sum_in(range, sum));
        if value.is_none() && self.many.is_attempt {
            self.diagnostics.forget_after(errors);
            return None;
        }
        Some(value)
    }

    fn sum_in(&mut self, range: Range, sum: &SumOver) -> Option<Value> {
        self.declare_local(&sum.index)?;
        let level = self.many.ranges.len();
        let value = self.inside(range.clone(), &sum.index, |lowering| {
            let value = lowering.lower(&sum.body)?;
            Some(value.map(&mut |id| lowering.within_loops(id)))
        })?;
        Some(
            value.map(&mut |body| {
                self.many.total(&mut self.graph, Total { level, range: range.clone(), body })
            }),
        )
    }

    /// Bounds of a range; `None` if both are constants.
    pub(in crate::resolve) fn open_range(
        &mut self,
        from: &Expression,
        to: &Expression,
    ) -> Option<Option<Range>> {
        if !self.many.is_open() {
            return None;
        }
        let (low, high) = (self.affine(from), self.affine(to));
        let (Some(from_bound), Some(to_bound)) = (low, high) else { return Some(None) };
        if from_bound.as_number().is_some() && to_bound.as_number().is_some() && !self.many.is_attempt {
            return None;
        }
        let [least, _] = self.many.bounds(&from_bound);
        if least.as_number().is_some_and(|least| least < 0) {
            return Some(self.report(from.place, "an index is not negative"));
        }
        let length = to_bound.plus(&from_bound, -1).as_number();
        if length.is_some_and(|length| length <= 0) {
            return Some(self.report(from.place.to(to.place), "this range is empty"));
        }
        Some(Some(Range { from: from_bound, to: to_bound }))
    }

    /// Runs `f` in a loop with this index.
    pub(in crate::resolve) fn inside<T>(
        &mut self,
        range: Range,
        index: &Name,
        f: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        let level = self.many.ranges.len();
        let symbol = self.graph.symbol(Variable::Level(level).symbol());
        self.locals.push((index.text.clone(), Value::Scalar(symbol)));
        self.many.name_level(&index.text);
        self.many.ranges.push(range);
        let result = f(self);
        self.many.ranges.pop();
        self.locals.pop();
        result
    }

    /// Runs `f` in the loops of a target, with the index of each bracket: an element's own index, or a family's running index.
    pub(in crate::resolve) fn inside_all<T>(
        &mut self,
        indices: &[TargetIndex],
        f: &mut dyn FnMut(&mut Self, &[Affine]) -> Option<T>,
    ) -> Option<T> {
        self.nested(indices, &mut Vec::new(), f)
    }

    fn nested<T>(
        &mut self,
        indices: &[TargetIndex],
        before: &mut Vec<Affine>,
        f: &mut dyn FnMut(&mut Self, &[Affine]) -> Option<T>,
    ) -> Option<T> {
        let Some((first, rest)) = indices.split_first() else { return f(self, before) };
        match first {
            TargetIndex::Element(index) => {
                before.push(self.affine(index)?);
                self.nested(rest, before, f)
            }
            TargetIndex::Family { index, from, to } => {
                self.declare_local(index)?;
                let (low, high) = (self.affine(from), self.affine(to));
                let range = Range { from: low?, to: high? };
                before.push(Affine::of(Unknown::Level(self.many.ranges.len())));
                self.inside(range, index, |lowering| lowering.nested(rest, before, f))
            }
        }
    }

    /// True if a bound of one of these indices is known only at run time. Reports no errors.
    pub(in crate::resolve) fn is_open_family(&mut self, indices: &[TargetIndex]) -> bool {
        if self.many.is_attempt {
            return indices.iter().any(|index| matches!(index, TargetIndex::Family { .. }));
        }
        let names_open = |expression: &Expression, many: &Many| {
            let mut is_open = false;
            expression.names(&mut |name| is_open |= many.lengths.iter().any(|known| known.name == name.text));
            is_open
        };
        indices.iter().any(|index| match index {
            TargetIndex::Element(at) => names_open(at, &self.many),
            TargetIndex::Family { from, to, .. } => {
                names_open(from, &self.many) || names_open(to, &self.many)
            }
        })
    }
}
