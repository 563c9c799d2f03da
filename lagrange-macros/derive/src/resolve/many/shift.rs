//! Replaces running indices in expressions: the same expression for another element.

use rustc_hash::FxHashMap;

use super::{Affine, FieldElement, Index, Slot, Unknown};
use crate::resolve::Problem;
use crate::resolve::parameters::Entry;
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

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
    /// An expression, without sums, with all running indices replaced.
    pub(crate) fn shifted(&mut self, graph: &mut Graph, root: Id, new: &NewIndices) -> Id {
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
            _ => return None,
        };
        Some(graph.symbol(variable.symbol()))
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
