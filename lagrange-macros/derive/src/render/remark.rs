//! Remarks on equations.

use super::formula::Formula;
use super::notation::Notation;

/// Parts of a remark, each of words with formulas between them.
#[derive(Clone, Default)]
pub(super) struct Remark(Vec<Vec<Fragment>>);

#[derive(Clone, PartialEq)]
pub(super) enum Fragment {
    Words(String),
    Formula(Formula),
}

impl Fragment {
    pub(super) fn words(words: impl Into<String>) -> Self {
        Self::Words(words.into())
    }
}

impl Remark {
    pub(super) fn of(parts: Vec<Fragment>) -> Self {
        let mut remark = Self::default();
        remark.and(parts);
        remark
    }

    /// Adds a part, unless it is empty or already present.
    pub(super) fn and(&mut self, parts: Vec<Fragment>) {
        if !parts.is_empty() && !self.0.contains(&parts) {
            self.0.push(parts);
        }
    }

    pub(super) fn any(&self, is_it: impl Fn(&Formula) -> bool) -> bool {
        self.0.iter().flatten().any(|part| matches!(part, Fragment::Formula(inner) if is_it(inner)))
    }

    pub(super) fn formulas(&mut self) -> impl Iterator<Item = &mut Formula> {
        self.0.iter_mut().flatten().filter_map(|part| match part {
            Fragment::Formula(formula) => Some(formula),
            Fragment::Words(_) => None,
        })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All parts in sequence between the bounds, with adjacent words joined.
    fn parts(&self, bounds: [&str; 2]) -> Vec<Fragment> {
        let mut all: Vec<Fragment> = Vec::new();
        let [open, close] = bounds.map(Fragment::words);
        for part in [vec![open], self.0.join(&Fragment::words("; ")), vec![close]].concat() {
            match (all.last_mut(), part) {
                (Some(Fragment::Words(before)), Fragment::Words(words)) => *before += &words,
                (_, part) => all.push(part),
            }
        }
        all
    }

    /// The remark in parentheses; nothing if it is empty.
    pub(super) fn in_parentheses(&self) -> Vec<Fragment> {
        if self.is_empty() { Vec::new() } else { self.parts(["(", ")"]) }
    }

    /// Spells the remark, with functions that write words and formulas.
    pub(super) fn spelled(
        &self,
        notation: Notation,
        words: impl Fn(&str) -> String,
        formula: impl Fn(String) -> String,
    ) -> String {
        let spelled = self.in_parentheses().into_iter().map(|part| match part {
            Fragment::Words(text) => words(&text),
            Fragment::Formula(inner) => formula(notation.write(&inner)),
        });
        spelled.collect()
    }
}
