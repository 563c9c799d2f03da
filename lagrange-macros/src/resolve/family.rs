//! Families: what has indices, and the values that it is made of.

use std::collections::BTreeMap;
use std::ops::Range;

use super::lower::Lowering;
use super::value::Value;
use crate::syntax::{Expression, TargetIndex};

/// Maximum length of a range, and number of elements of a family: each is written out.
const RANGE_LIMIT: i128 = 10_000;

/// Values keyed by their indices; all keys have the same number of indices.
#[derive(Debug, Default)]
pub(super) struct Family(BTreeMap<Vec<usize>, Value>);

impl Family {
    /// Inserts an element; false if the family has these indices already.
    pub(super) fn insert(&mut self, indices: Vec<usize>, value: Value) -> bool {
        self.0.insert(indices, value).is_none()
    }

    /// Number of indices of an element.
    pub(super) fn rank(&self) -> usize {
        self.0.keys().next().map_or(0, Vec::len)
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (&[usize], &Value)> {
        self.0.iter().map(|(indices, value)| (&indices[..], value))
    }

    /// The elements whose indices begin so.
    fn under<'f>(&'f self, first: &'f [usize]) -> impl Iterator<Item = (&'f [usize], &'f Value)> {
        let from = self.0.range(first.to_vec()..).map(|(indices, value)| (&indices[..], value));
        from.take_while(move |(indices, _)| indices.starts_with(first))
    }

    /// The element of these indices, or arrays of those whose indices begin so, whatever is missing between them.
    pub(super) fn part(&self, first: &[usize]) -> Option<Value> {
        if let Some(value) = self.0.get(first) {
            return Some(value.clone());
        }
        let mut next: Vec<usize> =
            self.under(first).filter_map(|(indices, _)| indices.get(first.len()).copied()).collect();
        next.dedup();
        let part = |i: usize| self.part(&[first, &[i]].concat());
        next.into_iter()
            .map(part)
            .collect::<Option<Vec<Value>>>()
            .filter(|parts| !parts.is_empty())
            .map(Value::Vector)
    }

    /// The first indices that are missing before those of another element whose indices begin so.
    pub(super) fn gap(&self, first: &[usize]) -> Option<Vec<usize>> {
        let mut before: &[usize] = first;
        for (indices, _) in self.under(first) {
            let shared = before.iter().zip(indices).take_while(|(one, other)| one == other).count();
            for level in shared..indices.len() {
                let next = if level == shared { before.get(level).map_or(0, |i| i + 1) } else { 0 };
                if indices[level] != next {
                    return Some([&indices[..level], &[next]].concat());
                }
            }
            before = indices;
        }
        None
    }
}

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
