//! What kind of constraint it is, in words.

use super::READABLE;
use super::formula::derived;
use super::notation::Notation;
use super::symbols_to_read;
use crate::mechanics::{Evidence, Integrability, Kinds};
use crate::resolve::Problem;

/// The remark behind a constraint that stands for `rows`: each kind among them, once.
pub(super) fn remark(rows: impl Iterator<Item = usize>, problem: &Problem, kinds: &Kinds) -> String {
    let mut remarks: Vec<String> = Vec::new();
    for row in rows {
        let remark = of_row(row, problem, kinds);
        if !remarks.contains(&remark) {
            remarks.push(remark);
        }
    }
    remarks.join("; ")
}

fn of_row(row: usize, problem: &Problem, kinds: &Kinds) -> String {
    let class = kinds.classes[row];
    let kind = match class.integrability {
        Integrability::Holonomic => "holonomic",
        Integrability::Exact => "integrable",
        Integrability::IntegratingFactor => "integrable with a factor",
        Integrability::Together => "integrable together with the others",
        Integrability::Nonholonomic => "nonholonomic",
        Integrability::Undecided => return "on the velocities".to_owned(),
    };
    let kind = match class.evidence {
        Evidence::Proved => kind.to_owned(),
        Evidence::Held(points) => format!("{kind}, as far as {points} points show"),
    };
    match kinds.functions[row].filter(|&function| symbols_to_read(problem, function) <= READABLE) {
        Some(function) => {
            format!("{kind}: {} is constant", Notation::Unicode.write(&derived(function, problem)))
        }
        None => kind,
    }
}
