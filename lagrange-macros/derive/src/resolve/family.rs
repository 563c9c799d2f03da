//! Families: values keyed by indices.

use std::collections::BTreeMap;

use super::value::Value;

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

    /// Elements whose indices begin with `first`.
    fn under<'f>(&'f self, first: &'f [usize]) -> impl Iterator<Item = (&'f [usize], &'f Value)> {
        let from = self.0.range(first.to_vec()..).map(|(indices, value)| (&indices[..], value));
        from.take_while(move |(indices, _)| indices.starts_with(first))
    }

    /// Element with these indices, or nested arrays of the elements whose indices begin with them. Gaps are skipped.
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

    /// First missing indices that precede an existing element, among those that begin with `first`.
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
