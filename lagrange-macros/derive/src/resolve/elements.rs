//! Elements of a family: the ranges of its indices written out.

use std::ops::Range;

use super::lowering::Lowering;
use super::value::Value;
use crate::syntax::{Expression, TargetIndex};

/// Maximum end of a range and maximum number of elements of a family, because each element is written out.
const RANGE_LIMIT: i128 = 10_000;

impl Lowering<'_> {
    /// Element indices that a target stands for, in order. A target without brackets has one element without indices;
    /// after an error there are none.
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

    /// Range of one index of a target, whose earlier indices `before` are bound.
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
                // An inner range `j in 0..i` is empty at i = 0, the first row of a triangle.
                let (low, high) = (self.integer(from)?, self.integer(to)?);
                if low == high && low >= 0 && !before.is_empty() { Some(0..0) } else { self.range(from, to) }
            }
        }
    }

    /// Runs `f` with the running indices of a target bound to these values.
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

    /// Evaluates the range `from..to`. Reports an empty range.
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
