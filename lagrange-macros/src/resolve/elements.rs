//! Elements that the indices of a target stand for.

use std::ops::Range;

use super::lowering::Lowering;
use super::value::Value;
use crate::syntax::{Expression, TargetIndex};

/// Maximum length of a range, and number of elements of a family: each is written out.
const RANGE_LIMIT: i128 = 10_000;

impl Lowering<'_> {
    /// The indices that stand for a target's, in order: one of none without brackets, nothing where they are wrong.
    pub(super) fn elements(&mut self, indices: &[TargetIndex]) -> Vec<Vec<usize>> {
        let mut elements = vec![Vec::new()];
        for (level, index) in indices.iter().enumerate() {
            let (before, mut longer) = (&indices[..level], Vec::new());
            for element in elements {
                let range =
                    self.with_indices(before, &element, |lowering| lowering.index_range(index, before));
                let Some(range) = range else { return Vec::new() };
                longer.extend(range.map(|i| [&element[..], &[i]].concat()));
                if longer.len() > RANGE_LIMIT as usize {
                    return self.too_many_elements(index).unwrap_or_default();
                }
            }
            elements = longer;
        }
        elements
    }

    fn too_many_elements<T>(&mut self, index: &TargetIndex) -> Option<T> {
        let (TargetIndex::Element(Expression { place, .. })
        | TargetIndex::Family { to: Expression { place, .. }, .. }) = index;
        self.report(*place, format!(
            "these are more than {RANGE_LIMIT} elements: leave so many parts to a function, `#[function(U(x))]`, that loops over them"
        ))
    }

    /// What an index stands for, behind others.
    fn index_range(&mut self, index: &TargetIndex, before: &[TargetIndex]) -> Option<Range<usize>> {
        match index {
            TargetIndex::Element(index) => match usize::try_from(self.integer(index)?) {
                Ok(i) => Some(i..i + 1),
                Err(_) => self.report(index.place, "an index is not negative"),
            },
            TargetIndex::Family { index, from, to } => {
                self.declare_local(index)?;
                let is_it = |known: &TargetIndex| matches!(known, TargetIndex::Family { index: known, .. } if known.text == index.text);
                if before.iter().any(is_it) {
                    return self.report(index.place, format!("the index `{}` is given twice", index.text));
                }
                // The first row of a triangle, `j in 0..i` where i = 0, has nothing in it.
                let (low, high) = (self.integer(from)?, self.integer(to)?);
                if low == high && low >= 0 && !before.is_empty() { Some(0..0) } else { self.range(from, to) }
            }
        }
    }

    /// Runs `f` with a target's running indices bound to these values.
    pub(super) fn with_indices<T>(
        &mut self,
        indices: &[TargetIndex],
        values: &[usize],
        f: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let outer = self.locals.len();
        for (index, &value) in indices.iter().zip(values) {
            if let TargetIndex::Family { index, .. } = index {
                let value = Value::Scalar(self.graph.integer(value as i128));
                self.locals.push((index.text.clone(), value));
            }
        }
        let result = f(self);
        self.locals.truncate(outer);
        result
    }

    /// `from..to` with its ends in numbers; an empty one is an error.
    pub(super) fn range(&mut self, from: &Expression, to: &Expression) -> Option<Range<usize>> {
        let (low, high) = (self.integer(from), self.integer(to));
        let (low, high) = (low?, high?);
        let place = from.place.to(to.place);
        if low < 0 {
            return self.report(from.place, "an index is not negative");
        }
        if high <= low {
            return self.report(place, format!("the range {low}..{high} is empty"));
        }
        if high > RANGE_LIMIT {
            return self.report(place, format!(
                "the range ends beyond {RANGE_LIMIT}: leave so many parts to a function, `#[function(U(x))]`, that loops over them"
            ));
        }
        Some(low as usize..high as usize)
    }
}
