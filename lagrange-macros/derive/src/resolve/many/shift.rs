//! Replaces running indices in expressions: the same expression for another element.

use rustc_hash::FxHashMap;

use super::{Affine, FieldElement, Index, Many, Range, Slot, Total, Unknown, totals};
use crate::resolve::Problem;
use crate::resolve::lowering::Lowering;
use crate::resolve::parameters::{Entry, Parameters};
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

/// Largest depth of indices in printed equations: the element has depth 0, a sum over other elements depth 1.
const AWAY: usize = 2;

/// Substitution of running indices: maps the depth of a loop to the number that replaces its index.
pub(crate) type NewIndices = FxHashMap<usize, Affine>;

impl Affine {
    /// The number with all running indices replaced at once.
    pub(crate) fn shifted(&self, new: &NewIndices) -> Self {
        self.terms.iter().fold(Self::number(self.constant), |sum, &(unknown, factor)| match unknown {
            Unknown::Level(level) if let Some(by) = new.get(&level) => sum.plus(by, factor),
            _ => sum.plus(&Self::of(unknown), factor),
        })
    }
}

impl Index {
    pub(crate) fn shifted(&self, new: &NewIndices) -> Self {
        match self {
            Self::Affine(affine) => Self::Affine(affine.shifted(new)),
            Self::Entry(field, path) => {
                Self::Entry(*field, path.iter().map(|index| index.shifted(new)).collect())
            }
        }
    }
}

impl Range {
    pub(crate) fn shifted(&self, new: &NewIndices) -> Self {
        Self { from: self.from.shifted(new), to: self.to.shifted(new) }
    }
}

impl Problem {
    /// Substitutes all running indices of an expression. Indices of its sums are renumbered to avoid the new ones.
    pub(crate) fn shifted(&mut self, graph: &mut Graph, root: Id, new: &NewIndices) -> Id {
        match new.is_empty() {
            true => root,
            false => self.many.shifted((graph, &mut self.parameters), root, (new, AWAY)),
        }
    }

    /// Depths of the loops whose indices occur free in these expressions.
    pub(crate) fn levels(&self, graph: &Graph, roots: &[Id]) -> Vec<usize> {
        let of_field = |k: usize| {
            let field = self.parameters.entries[k].field;
            let element = self.many.elements.iter().find(|(_, place)| *place == field);
            element.map_or(Vec::new(), |(element, _)| element.index.levels())
        };
        let of_slot = |k: usize| self.many.slots[k].indices.iter().flat_map(Index::levels).collect();
        let levels = graph.symbols(roots).flat_map(|symbol| match Variable::of(symbol) {
            Variable::Level(level) => vec![level],
            Variable::Coordinate(k) | Variable::Velocity(k) | Variable::Multiplier(k) => of_slot(k),
            Variable::Parameter(k) => of_field(k),
            _ => Vec::new(),
        });
        levels.collect()
    }
}

impl Many {
    /// Substitutes running indices of an expression, and moves its sums deeper by an offset.
    fn shifted(
        &mut self,
        (graph, parameters): (&mut Graph, &mut Parameters),
        root: Id,
        (new, by): (&NewIndices, usize),
    ) -> Id {
        let symbols: Vec<Symbol> = graph.symbols(&[root]).collect();
        let replaced: FxHashMap<Symbol, Id> = symbols
            .into_iter()
            .filter_map(|symbol| Some((symbol, self.replacement((graph, parameters), symbol, (new, by))?)))
            .collect();
        graph.substituted(root, |symbol| replaced.get(&symbol).copied())
    }

    fn replacement(
        &mut self,
        (graph, parameters): (&mut Graph, &mut Parameters),
        symbol: Symbol,
        (new, by): (&NewIndices, usize),
    ) -> Option<Id> {
        let variable = match Variable::of(symbol) {
            Variable::Level(level) => return Some(new.get(&level)?.node(graph)),
            Variable::Coordinate(k) => Variable::Coordinate(self.shifted_slot(k, new)),
            Variable::Velocity(k) => Variable::Velocity(self.shifted_slot(k, new)),
            Variable::Momentum(k) => Variable::Momentum(self.shifted_slot(k, new)),
            Variable::Multiplier(k) => Variable::Multiplier(self.shifted_slot(k, new)),
            Variable::Parameter(k) => Variable::Parameter(self.shifted_parameter(parameters, k, new)?),
            Variable::Total(k) => return Some(self.shifted_sum((graph, parameters), k, (new, by))),
            _ => return None,
        };
        Some(graph.symbol(variable.symbol()))
    }

    fn shifted_sum(
        &mut self,
        (graph, parameters): (&mut Graph, &mut Parameters),
        k: usize,
        (new, by): (&NewIndices, usize),
    ) -> Id {
        let Total { level, range, body } = self.totals[k].clone();
        let mut new = new.clone();
        new.insert(level, Affine::of(Unknown::Level(level + by)));
        let body = self.shifted((graph, parameters), body, (&new, by));
        self.total(graph, Total { level: level + by, range: range.shifted(&new), body })
    }

    fn shifted_slot(&mut self, k: usize, new: &NewIndices) -> usize {
        let Slot { array, indices, number } = self.slots[k].clone();
        let indices = indices.iter().map(|index| index.shifted(new)).collect();
        self.slot(Slot { array, indices, number })
    }

    fn shifted_parameter(
        &mut self,
        parameters: &mut Parameters,
        k: usize,
        new: &NewIndices,
    ) -> Option<usize> {
        let Entry { field, number } = parameters.entries[k];
        let (element, _) = self.elements.iter().find(|(_, place)| *place == field)?;
        let element = FieldElement { field: element.field, index: element.index.shifted(new) };
        let known = self.elements.iter().find(|(known, _)| *known == element).map(|(_, place)| *place);
        let field = known.unwrap_or_else(|| self.virtual_field(parameters, element));
        Some(parameters.entries.insert_full(Entry { field, number }).0)
    }
}

impl Lowering<'_> {
    /// Renumbers the sums of a value for use in the current loops. Definitions and arguments are lowered outside of these, so their
    /// sums may have the depth of a current loop.
    pub(super) fn within_loops(&mut self, id: Id) -> Id {
        let depth = self.many.ranges.len();
        let outside = totals(&self.graph, &[id]).into_iter().find(|&k| self.many.totals[k].level < depth);
        let Some(k) = outside else { return id };
        let by = depth - self.many.totals[k].level;
        let own = Variable::Total(k).symbol();
        let known = self.many.slots.len();
        let context = (&mut self.graph, &mut self.parameters);
        let inside = self.many.shifted_sum(context, k, (&NewIndices::default(), by));
        self.follow_slots(known);
        let id = self.graph.substituted(id, |symbol| (symbol == own).then_some(inside));
        self.within_loops(id)
    }
}
