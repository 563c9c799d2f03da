//! Replaces running indices in expressions: the same expression for another element.

use rustc_hash::FxHashMap;

use super::{Affine, FieldElement, Index, Range, Slot, Total, Unknown};
use crate::resolve::Problem;
use crate::resolve::parameters::Entry;
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

/// Number of depths that indices of equations have at most: that of the element, and that of a sum over others.
const AWAY: usize = 2;

/// New value of each running index, by its depth.
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

impl Problem {
    /// Depths of the loops whose indices occur in these expressions, without those of sums in them.
    pub(crate) fn levels(&self, graph: &Graph, roots: &[Id]) -> Vec<usize> {
        let of_field = |k: usize| {
            let field = self.parameters.entries[k].field;
            let element = self.many.elements.iter().find(|(_, place)| *place == field);
            element.map_or(Vec::new(), |(element, _)| element.index.levels())
        };
        let of_slot = |k: usize| self.many.slots[k].indices.iter().flat_map(Index::levels).collect();
        let levels = graph.symbols(roots).flat_map(|symbol| match Variable::of(symbol) {
            Variable::Level(level) => vec![level],
            Variable::Coordinate(k) | Variable::Velocity(k) => of_slot(k),
            Variable::Parameter(k) => of_field(k),
            _ => Vec::new(),
        });
        levels.collect()
    }

    /// An expression with all running indices replaced. Those of sums in it move out of the way of the new ones.
    pub(crate) fn shifted(&mut self, graph: &mut Graph, root: Id, new: &NewIndices) -> Id {
        if new.is_empty() {
            return root;
        }
        let symbols: Vec<Symbol> = graph.symbols(&[root]).collect();
        let replaced: FxHashMap<Symbol, Id> = symbols
            .into_iter()
            .filter_map(|symbol| Some((symbol, self.replacement(graph, symbol, new)?)))
            .collect();
        graph.substituted(root, |symbol| replaced.get(&symbol).copied())
    }

    fn replacement(&mut self, graph: &mut Graph, symbol: Symbol, new: &NewIndices) -> Option<Id> {
        let variable = match Variable::of(symbol) {
            Variable::Level(level) => return Some(new.get(&level)?.node(graph)),
            Variable::Coordinate(k) => Variable::Coordinate(self.shifted_slot(k, new)),
            Variable::Velocity(k) => Variable::Velocity(self.shifted_slot(k, new)),
            Variable::Momentum(k) => Variable::Momentum(self.shifted_slot(k, new)),
            Variable::Parameter(k) => Variable::Parameter(self.shifted_parameter(k, new)?),
            Variable::Total(k) => Variable::Total(self.shifted_sum(graph, k, new)),
            _ => return None,
        };
        Some(graph.symbol(variable.symbol()))
    }

    fn shifted_sum(&mut self, graph: &mut Graph, k: usize, new: &NewIndices) -> usize {
        let Total { level, range, body } = self.many.totals[k].clone();
        let deeper = level + AWAY;
        let mut new = new.clone();
        new.insert(level, Affine::of(Unknown::Level(deeper)));
        let body = self.shifted(graph, body, &new);
        let range = Range { from: range.from.shifted(&new), to: range.to.shifted(&new) };
        self.many.totals.insert_full(Total { level: deeper, range, body }).0
    }

    /// Index of the slot with all running indices replaced.
    pub(crate) fn shifted_slot(&mut self, k: usize, new: &NewIndices) -> usize {
        let Slot { array, indices, number } = self.many.slots[k].clone();
        let indices = indices.iter().map(|index| index.shifted(new)).collect();
        self.many.slot(Slot { array, indices, number })
    }

    fn shifted_parameter(&mut self, k: usize, new: &NewIndices) -> Option<usize> {
        let Entry { field, number } = self.parameters.entries[k];
        let (element, _) = self.many.elements.iter().find(|(_, place)| *place == field)?;
        let element = FieldElement { field: element.field, index: element.index.shifted(new) };
        let known = self.many.elements.iter().find(|(known, _)| *known == element).map(|(_, place)| *place);
        let field = known.unwrap_or_else(|| self.many.virtual_field(&mut self.parameters, element));
        Some(self.parameters.entries.insert_full(Entry { field, number }).0)
    }
}
