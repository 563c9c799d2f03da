//! Converts calls of user-supplied functions to formulas.

use super::formula::Formula;
use super::page::Page;
use crate::resolve::{Supplied, entry_names};
use crate::symbolic::{External, Rational};
use crate::syntax::{Layout, numbers};

impl Page<'_> {
    /// A call or a derivative: `A[0](r)`, `U′(s)`, `∂U/∂r[0]`.
    pub(super) fn supplied(&self, external: &External, flat: Vec<Formula>) -> Formula {
        let function = &self.problem.functions[external.function as usize];
        let name = match function.outputs {
            1 => function.name.clone(),
            _ => function.names[external.output as usize].clone(),
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

/// Entries of all formal arguments, by their declared names.
fn formal_entries(function: &Supplied) -> Vec<Formula> {
    let names = function.formals.iter().flat_map(|(name, lengths)| entry_names(name, lengths));
    names.map(|name| Formula::labelled(&name, 0)).collect()
}

/// Groups flat entries into the arguments of the function: all entries of a vector become the vector.
fn grouped(flat: &[Formula], function: &Supplied) -> Vec<Formula> {
    let mut rest = flat;
    let mut arguments = Vec::new();
    for (_, lengths) in &function.formals {
        let (entries, others) = rest.split_at(numbers(lengths));
        rest = others;
        arguments.push(array(entries, lengths));
    }
    arguments
}

/// Nested arrays of these lengths. A name replaces an array if its entries are exactly those of the name.
fn array(entries: &[Formula], lengths: &[usize]) -> Formula {
    let [length, inner @ ..] = lengths else { return entries[0].clone() };
    whole(entries, lengths).unwrap_or_else(|| {
        let parts = entries.chunks(entries.len() / length);
        Formula::Vector(parts.map(|part| array(part, inner)).collect())
    })
}

/// Name of the array that has exactly these entries, if there is one.
fn whole(entries: &[Formula], lengths: &[usize]) -> Option<Formula> {
    let Formula::Name { base, dots, indices } = &entries[0] else { return None };
    let outer = &indices[..indices.len().checked_sub(lengths.len())?];
    let named = |inner: Vec<usize>| {
        let inner = inner.into_iter().map(|i| Formula::Number(Rational::from_integer(i as i128)));
        Formula::Name {
            base: base.clone(),
            dots: *dots,
            indices: outer.iter().cloned().chain(inner).collect(),
        }
    };
    let layout = Layout::array(lengths);
    let mut numbered = entries.iter().enumerate();
    numbered.all(|(k, entry)| *entry == named(layout.indices(k))).then(|| named(Vec::new()))
}
