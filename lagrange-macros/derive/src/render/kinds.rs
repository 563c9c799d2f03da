//! Describes the kind of a constraint in words.

use super::page::Page;
use super::remark::{Fragment, Remark};
use crate::mechanics::{Evidence, Integrability, Integrals};
use crate::symbolic::Node;
use crate::variables::Variable;

impl Page<'_> {
    /// Remark on a constraint with these rows. Each kind among them is named once.
    pub(super) fn kinds(&self, rows: impl Iterator<Item = usize>) -> Remark {
        let mut remark = Remark::default();
        for row in rows {
            remark.and(self.kind(row));
        }
        remark
    }

    fn kind(&self, row: usize) -> Vec<Fragment> {
        let kinds = &self.derived.equations.integrability;
        let class = kinds.classes[row];
        let kind = match class.integrability {
            Integrability::Holonomic => "holonomic",
            Integrability::Exact => "integrable",
            Integrability::IntegratingFactor => "integrable with a factor",
            Integrability::Together => "integrable together with the others",
            Integrability::Nonholonomic => "nonholonomic",
            Integrability::Undecided => {
                return vec![Fragment::words(
                    "on the velocities; whether it can be integrated is not decided",
                )];
            }
        };
        let kind = if self.is_rheonomic(row) { format!("{kind}, rheonomic") } else { kind.to_owned() };
        let kind = qualified(&kind, class.evidence);
        match kinds.functions[row].map(|function| self.expression(function)) {
            Some(Ok(function)) => {
                vec![
                    Fragment::words(kind + ": "),
                    Fragment::Formula(function),
                    Fragment::words(" is constant"),
                ]
            }
            _ => vec![Fragment::words(kind)],
        }
    }

    /// Returns whether the constraint depends on time explicitly.
    fn is_rheonomic(&self, row: usize) -> bool {
        let nodes = self.graph.reachable(&[self.problem.constraints[row].1]);
        let is_time = |node: &Node| *node == Node::Symbol(Variable::Time.symbol());
        nodes.into_iter().any(|id| is_time(self.graph.node(id)))
    }
}

/// Note on integrable combinations of velocity constraints, which the remarks on single constraints do not mention.
pub(super) fn note(integrals: Integrals) -> Option<String> {
    let Integrals { count, of, evidence } = integrals;
    let is = if count == 1 { "is" } else { "are" };
    let text = format!("{count} of {of} velocity constraints, or of their combinations, {is} integrable");
    (count > 0 && count < of).then(|| qualified(&text, evidence))
}

fn qualified(text: &str, evidence: Evidence) -> String {
    match evidence {
        Evidence::Proved => text.to_owned(),
        Evidence::Held(points) => format!("{text}, as far as {points} points show"),
    }
}
