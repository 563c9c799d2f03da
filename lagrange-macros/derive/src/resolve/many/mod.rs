//! Arrays with lengths that are known at run time, and the elements and sums that expressions read.
//!
//! Expressions stay scalars of the graph. An element such as `r[i+1]` becomes a variable of its own, a coordinate slot or an
//! entry of a virtual field, and a sum over such elements becomes a variable, too, with its range and its body. Equal elements
//! and equal sums are one variable: running indices are named by the depth of their loop.

mod affine;
mod element;
mod lengths;
mod recursion;
mod shift;
mod statements;
mod sum;

use indexmap::IndexSet;

use super::label::{Label, entry_names};
use super::parameters::Parameters;
use crate::diagnostics::Place;
use crate::symbolic::Id;
use crate::syntax::{Field, FieldShape, Name, numbers};
pub(crate) use affine::{Affine, Unknown};
pub(crate) use lengths::{Length, LengthSource, loops_instead};
pub(crate) use recursion::OpenRecursion;
pub(crate) use shift::NewIndices;
pub(crate) use sum::totals;

/// Arrays with lengths that are known at run time: their elements, sums and index checks.
#[derive(Default)]
pub(crate) struct Many {
    pub(crate) lengths: Vec<Length>,
    /// Coordinates as declared, and behind them an array for each recursion.
    pub(crate) arrays: Vec<Array>,
    pub(crate) recursions: Vec<OpenRecursion>,
    /// The constraints that state each recursion, of its element 0 and of the others.
    pub(crate) stated_recursions: Vec<[OpenConstraint; 2]>,
    pub(crate) fields: Vec<OpenField>,
    /// Elements of coordinates in use; `Variable::Coordinate(k)` is slot k.
    pub(crate) slots: IndexSet<Slot>,
    /// Elements of fields in use, each with its virtual field among the parameters.
    pub(crate) elements: Vec<(FieldElement, usize)>,
    pub(crate) totals: IndexSet<Total>,
    /// Forces on elements, with the loops over them.
    pub(crate) forces: Vec<OpenForce>,
    pub(crate) constraints: Vec<OpenConstraint>,
    /// Multipliers, an array for each constraint. Their slots count arrays from `arrays.len()` on.
    pub(crate) multipliers: Vec<Array>,
    /// Index checks at the start of a motion.
    pub(crate) demands: IndexSet<Demand>,
    /// Name of the running index at each depth.
    pub(crate) level_names: Vec<String>,
    /// Names of fields, coordinates and definitions. Printed running indices get other names.
    pub(super) taken: Vec<String>,
    /// True if all lengths are literals. Loops are then tried to state the equations once for all elements; anything else is
    /// written out.
    pub(super) is_attempt: bool,
    /// Loops around the current expression, outermost first.
    pub(in crate::resolve) ranges: Vec<Range>,
}

/// An entry of `#[coordinates(…)]`.
pub(crate) struct Array {
    pub(crate) name: String,
    pub(crate) open: Vec<Affine>,
    /// Lengths of one element.
    pub(crate) lengths: Vec<usize>,
    pub(crate) place: Place,
}

/// A field that is a `Vec` or a slice.
pub(crate) struct OpenField {
    /// Index of the field among the parameters.
    pub(crate) field: usize,
    pub(crate) length: Affine,
    /// Shape of an element: numbers, or indices of a table.
    pub(crate) element: Result<FieldShape, String>,
    pub(crate) is_table: bool,
}

/// An index into an array.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) enum Index {
    Affine(Affine),
    /// Entry of a table: index among the open fields, and the indices of the entry.
    Entry(usize, Vec<Affine>),
}

/// One number of an element of a coordinate.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Slot {
    pub(crate) array: usize,
    pub(crate) indices: Vec<Index>,
    /// Number in the element, in row-major order.
    pub(crate) number: usize,
}

/// An element of a field.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct FieldElement {
    /// Index among the open fields.
    pub(crate) field: usize,
    pub(crate) index: Index,
}

/// Half-open range of a running index.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Range {
    pub(crate) from: Affine,
    pub(crate) to: Affine,
}

/// A sum over a range. Its running index has the depth of the sum.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Total {
    pub(crate) level: usize,
    pub(crate) range: Range,
    pub(crate) body: Id,
}

/// Forces on an element of a coordinate.
pub(crate) struct OpenForce {
    pub(crate) ranges: Vec<Range>,
    /// Slots, and the force on each.
    pub(crate) values: Vec<(usize, Id)>,
}

/// Constraints of the elements of some loops: one for each component of an expression.
pub(crate) struct OpenConstraint {
    pub(crate) ranges: Vec<Range>,
    pub(crate) place: Place,
    /// Numbers in each bracket behind its name.
    pub(super) brackets: Vec<Range>,
    /// For each component the slot of its multiplier, and the residual as written, left − right.
    pub(crate) rows: Vec<(usize, Id)>,
}

/// Index that must stay in a range during all iterations of some loops.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Demand {
    /// Name of the array.
    pub(crate) name: String,
    pub(crate) ranges: Vec<Range>,
    pub(crate) index: Index,
    pub(crate) within: Range,
}

impl Range {
    /// Indices of an array.
    pub(crate) fn up_to(length: &Affine) -> Self {
        Self { from: Affine::number(0), to: length.clone() }
    }
}

impl Range {
    /// True if no number is in both, known without the values of lengths.
    pub(crate) fn is_apart(&self, other: &Self) -> bool {
        self.is_before(other, |gap| gap.as_number().is_some_and(|gap| gap >= 0))
    }

    /// True if no number is in both once lengths are large enough.
    pub(crate) fn is_apart_at_last(&self, other: &Self) -> bool {
        let grows = |gap: &Affine| !gap.terms.is_empty() && gap.terms.iter().all(|(_, factor)| *factor > 0);
        self.is_before(other, |gap| grows(gap) || gap.as_number().is_some_and(|gap| gap >= 0))
    }

    /// True if one of two ranges ends before the other begins, as judged by the gap between them.
    fn is_before(&self, other: &Self, is_gap: impl Fn(&Affine) -> bool) -> bool {
        is_gap(&other.from.plus(&self.to, -1)) || is_gap(&self.from.plus(&other.to, -1))
    }
}

impl Many {
    /// True if the number of coordinates is known at run time.
    pub(crate) fn is_open(&self) -> bool {
        !self.arrays.is_empty()
    }

    /// The array of coordinates or of multipliers that a slot is an element of.
    pub(crate) fn array(&self, array: usize) -> &Array {
        self.arrays.get(array).unwrap_or_else(|| &self.multipliers[array - self.arrays.len()])
    }

    /// Index of a slot. The slots of all components of an element follow one another.
    pub(crate) fn slot(&mut self, slot: Slot) -> usize {
        if let Some(k) = self.slots.get_index_of(&slot) {
            return k;
        }
        let first = self.slots.len();
        for number in 0..numbers(&self.array(slot.array).lengths) {
            self.slots.insert(Slot { number, ..slot.clone() });
        }
        first + slot.number
    }

    /// True if a name with this number of indices is an element of an open field, and not one of its components.
    pub(crate) fn is_element(&self, name: &str, indices: usize, parameters: &Parameters) -> bool {
        let is_it = |field: &OpenField| parameters.fields[field.field].name.text == name;
        indices <= 1 && self.fields.iter().any(is_it)
    }

    /// Name of a running index, from its depth, or of a length.
    pub(crate) fn name(&self, unknown: Unknown) -> String {
        match unknown {
            Unknown::Level(level) => self.level_name(level),
            Unknown::Length(length) => self.lengths[length].name.clone(),
        }
    }

    /// Name of the running index at a depth: that of the first loop there, else one of i, j, k, l, i4, i5, ….
    pub(crate) fn level_name(&self, level: usize) -> String {
        if let Some(name) = self.level_names.get(level) {
            return name.clone();
        }
        let numbered = (4..).map(|number| format!("i{number}"));
        let all = ["i", "j", "k", "l"].into_iter().map(str::to_owned).chain(numbered);
        all.filter(|name| !self.is_taken(name)).nth(level - self.level_names.len()).unwrap_or_default()
    }

    /// Records the index name of a loop before its body is lowered.
    fn name_level(&mut self, name: &str) {
        if self.level_names.len() == self.ranges.len() {
            let name = match self.is_taken(name) {
                true => self.level_name(self.ranges.len()),
                false => name.to_owned(),
            };
            self.level_names.push(name);
        }
    }

    fn is_taken(&self, name: &str) -> bool {
        self.level_names.iter().chain(&self.taken).any(|known| known == name)
    }

    /// Text of an index: `i + 1`, `bond[i][0]`.
    pub(crate) fn index_text(&self, index: &Index, parameters: &Parameters) -> String {
        match index {
            Index::Affine(affine) => affine.text(|unknown| self.name(unknown)),
            Index::Entry(field, path) => {
                let name = parameters.fields[self.fields[*field].field].name.text.clone();
                path.iter()
                    .fold(name, |text, at| format!("{text}[{}]", at.text(|unknown| self.name(unknown))))
            }
        }
    }

    /// Names of the slots: `r[i + 1][0]`.
    pub(crate) fn labels(&self, parameters: &Parameters) -> Vec<Label> {
        let label = |Slot { array, indices, number }: &Slot| {
            let Array { name, lengths, place, .. } = self.array(*array);
            let open = indices
                .iter()
                .fold(name.clone(), |text, index| format!("{text}[{}]", self.index_text(index, parameters)));
            Label { text: entry_names(&open, lengths)[*number].clone(), place: *place }
        };
        self.slots.iter().map(label).collect()
    }

    /// Adds the field that stands for an element of a field; returns its index among the parameters.
    pub(super) fn virtual_field(&mut self, parameters: &mut Parameters, element: FieldElement) -> usize {
        let open = &self.fields[element.field];
        let whole = &parameters.fields[open.field];
        let text = format!("{}[{}]", whole.name.text, self.index_text(&element.index, parameters));
        let name = Name { text, place: whole.name.place };
        let added = Field { name, shape: open.element.clone(), ..whole.clone() };
        let index = parameters.add_virtual(added, open.field);
        self.elements.push((element, index));
        index
    }
}

impl Index {
    /// Depths of the loops whose indices it contains.
    pub(crate) fn levels(&self) -> Vec<usize> {
        match self {
            Self::Affine(affine) => affine.levels().collect(),
            Self::Entry(_, path) => path.iter().flat_map(Affine::levels).collect(),
        }
    }
}
