//! What kind of constraint it is, in words.

use super::derived::derived;
use super::lines::{READABLE, symbols_to_read};
use super::symbols::Notation;
use crate::mechanics::{Evidence, Integrability, Integrals, Kinds};
use crate::resolve::Problem;
use crate::symbolic::Graph;

/// The remark behind a constraint that stands for `rows`: each kind among them, once.
pub(super) fn remark(
    rows: impl Iterator<Item = usize>,
    graph: &Graph,
    problem: &Problem,
    kinds: &Kinds,
) -> String {
    let mut remarks: Vec<String> = Vec::new();
    for row in rows {
        let remark = of_row(row, graph, problem, kinds);
        if !remarks.contains(&remark) {
            remarks.push(remark);
        }
    }
    remarks.join("; ")
}

/// What the verdicts on the single constraints do not say: that some combinations are integrable.
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

fn of_row(row: usize, graph: &Graph, problem: &Problem, kinds: &Kinds) -> String {
    let class = kinds.classes[row];
    let kind = match class.integrability {
        Integrability::Holonomic => "holonomic",
        Integrability::Exact => "integrable",
        Integrability::IntegratingFactor => "integrable with a factor",
        Integrability::Together => "integrable together with the others",
        Integrability::Nonholonomic => "nonholonomic",
        Integrability::Undecided => return "on the velocities".to_owned(),
    };
    let kind = qualified(kind, class.evidence);
    match kinds.functions[row]
        .filter(|&function| symbols_to_read(graph, problem, &[function])[&function] <= READABLE)
    {
        Some(function) => {
            format!("{kind}: {} is constant", Notation::Unicode.write(&derived(function, graph, problem)))
        }
        None => kind,
    }
}
