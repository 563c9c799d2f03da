//! Functions that the user supplies, as formulas.

use super::Page;
use super::formula::Formula;
use crate::resolve::Supplied;
use crate::symbolic::External;

impl Page<'_> {
    /// `A[0](r)`, `U′(s)`, `∂U/∂r[0]`
    pub(super) fn supplied(&self, external: &External, flat: Vec<Formula>) -> Formula {
        let function = &self.problem.functions[external.function as usize];
        let name = match function.outputs {
            1 => function.name.clone(),
            _ => format!("{}[{}]", function.name, external.output),
        };
        let order = external.derivatives.len();
        if order == 0 {
            return Formula::Call(name, grouped(&flat, function));
        }
        let name = Box::new(Formula::labelled(&name, 0));
        if let [argument] = &flat[..] {
            return Formula::Derivative { function: name, order, argument: Box::new(argument.clone()) };
        }
        let formals = formal_entries(function);
        let by = external.derivatives.iter().map(|&i| formals[i as usize].clone()).collect();
        let is_clear = flat == formals;
        let arguments = if is_clear { Vec::new() } else { grouped(&flat, function) };
        Formula::Partial { function: name, by, arguments }
    }
}

/// Every number that a function takes, by the names in its declaration.
fn formal_entries(function: &Supplied) -> Vec<Formula> {
    let entries = |(name, length): &(String, Option<usize>)| match length {
        None => vec![Formula::labelled(name, 0)],
        Some(length) => (0..*length).map(|i| Formula::labelled(&format!("{name}[{i}]"), 0)).collect(),
    };
    function.formals.iter().flat_map(entries).collect()
}

/// Numbers put together into the arguments that the function takes: all entries of a vector are the vector.
fn grouped(flat: &[Formula], function: &Supplied) -> Vec<Formula> {
    let mut rest = flat;
    let mut arguments = Vec::new();
    for (_, length) in &function.formals {
        let (entries, others) = rest.split_at(length.unwrap_or(1));
        rest = others;
        let argument = match (length, &entries[0]) {
            (None, entry) => entry.clone(),
            (Some(_), Formula::Name { base, dots, .. }) if are_all_entries(base, *dots, entries) => {
                Formula::Name { base: base.clone(), dots: *dots, indices: Vec::new() }
            }
            _ => Formula::Vector(entries.to_vec()),
        };
        arguments.push(argument);
    }
    arguments
}

fn are_all_entries(base: &str, dots: usize, entries: &[Formula]) -> bool {
    let is_entry = |(i, entry): (usize, &Formula)| *entry == Formula::labelled(&format!("{base}[{i}]"), dots);
    entries.iter().enumerate().all(is_entry)
}
