//! From a schedule to statements.

use std::collections::HashSet;

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};
use rustc_hash::FxHashMap;

use super::schedule::{Call, Count, Operation, Register, Schedule};
use super::style::Style;
use crate::symbolic::{Function, Id, Symbol};

/// Up to this many locals each have a `let`. Beyond, they are declared in batches of as many, as tuples, and
/// then assigned: one `let` each overflows rustc's stack near 3,000 in a build with debug information.
const BATCH: usize = 256;
/// Single-use results are nested into what uses them to this depth.
const NESTING: usize = 6;

/// The body of one emitted function.
pub(super) struct Kernel {
    /// Reads the inputs and computes the results.
    pub(super) statements: TokenStream,
    /// One expression for each root.
    pub(super) results: Vec<TokenStream>,
    pub(super) count: Count,
}

impl Style<'_> {
    /// Computes `roots`.
    pub(super) fn kernel(&self, roots: &[Id]) -> Kernel {
        let schedule = Schedule::new(&self.problem.graph, roots);
        let results: Vec<Register> = roots.iter().map(|&root| schedule.register(root)).collect();
        self.write(&schedule, &results)
    }

    /// The schedule as statements, and where its results are.
    pub(super) fn write(&self, schedule: &Schedule, roots: &[Register]) -> Kernel {
        let mut writer = Writer {
            style: self,
            uses: schedule.uses(roots),
            values: Vec::new(),
            locals: Vec::new(),
            assignments: Vec::new(),
            names: FxHashMap::default(),
            written_calls: HashSet::new(),
        };
        for &(register, id) in &schedule.definitions {
            if let Some(name) = self.definition_names.get(&id) {
                writer.names.entry(register).or_insert(name);
            }
        }
        for (index, &operation) in schedule.operations.iter().enumerate() {
            writer.write(index, operation, schedule);
        }
        let results: Vec<_> = roots.iter().map(|&root| writer.value(root)).collect();
        let used: Vec<Symbol> = schedule
            .operations
            .iter()
            .filter_map(|operation| match operation {
                Operation::Input(symbol) => Some(*symbol),
                _ => None,
            })
            .collect();
        let inputs = self.inputs(&used);
        let computation = writer.finish();
        Kernel { statements: quote! { #inputs #computation }, results, count: schedule.count(roots) }
    }
}

/// Statements under construction.
struct Writer<'s, 'a> {
    style: &'s Style<'a>,
    uses: Vec<usize>,
    /// For each register the tokens that stand for it, and how deep they nest.
    values: Vec<(TokenStream, usize)>,
    locals: Vec<Ident>,
    assignments: Vec<TokenStream>,
    names: FxHashMap<Register, &'s Ident>,
    /// The calls that have been written already.
    written_calls: HashSet<u32>,
}

impl Writer<'_, '_> {
    fn value(&self, register: Register) -> TokenStream {
        self.values[register.index()].0.clone()
    }

    fn write(&mut self, index: usize, operation: Operation, schedule: &Schedule) {
        let entry = match operation {
            _ if self.uses[index] == 0 => (TokenStream::new(), 0),
            Operation::Constant(bits) => (self.style.constant(f64::from_bits(bits)), 0),
            Operation::Input(symbol) => {
                let name = &self.style.names[&symbol];
                (quote!(#name), 0)
            }
            Operation::Result { call, output } => {
                self.write_call(call, output, schedule);
                return;
            }
            Operation::Function(function @ (Function::Sin | Function::Cos), x) => {
                self.write_sine_or_cosine(index, function, x, schedule);
                return;
            }
            _ => {
                let depth = 1 + schedule
                    .operands(operation)
                    .map(|operand| self.values[operand.index()].1)
                    .max()
                    .unwrap_or(0);
                let tokens = self.operation(operation);
                if self.uses[index] == 1 && depth < NESTING {
                    (quote!((#tokens)), depth)
                } else {
                    (self.assign(index, &tokens), 0)
                }
            }
        };
        self.values.push(entry);
    }

    fn operation(&self, operation: Operation) -> TokenStream {
        let value = |register| self.value(register);
        match operation {
            Operation::Negate(x) => {
                let x = value(x);
                quote!(-#x)
            }
            Operation::Add(x, y) => infix(value(x), quote!(+), value(y)),
            Operation::Subtract(x, y) => infix(value(x), quote!(-), value(y)),
            Operation::Multiply(x, y) => infix(value(x), quote!(*), value(y)),
            Operation::Divide(x, y) => infix(value(x), quote!(/), value(y)),
            Operation::Minimum(x, y) => call("min", &[value(x), value(y)]),
            Operation::Maximum(x, y) => call("max", &[value(x), value(y)]),
            Operation::Where(x, y) => {
                let (x, y) = (value(x), value(y));
                quote!(__lagrange::linearized::only_where(#x, #y))
            }
            Operation::SquareRoot(x) => call("sqrt", &[value(x)]),
            Operation::Function(function, x) => call(function.name(), &[value(x)]),
            Operation::Atan2(y, x) => call("atan2", &[value(y), value(x)]),
            Operation::Power(x, y) => call("powf", &[value(x), value(y)]),
            Operation::Constant(_) | Operation::Input(_) | Operation::Result { .. } => TokenStream::new(),
        }
    }

    /// All results of a call are computed together, when the first of them is met.
    fn write_call(&mut self, call: u32, output: u32, schedule: &Schedule) {
        let Call { function, derivatives, arguments } = &schedule.calls[call as usize];
        let function = &self.style.problem.functions[*function as usize];
        let name = |output: u32| format_ident!("call{call}_{output}", span = Span::mixed_site());
        let result = name(output);
        self.values.push((quote!(#result), 0));
        if !self.written_calls.insert(call) {
            return;
        }
        let used = |output: u32| {
            schedule
                .find(Operation::Result { call, output })
                .is_some_and(|register| self.uses[register.index()] > 0)
        };
        let outputs: Vec<u32> = (0..function.outputs as u32).filter(|&output| used(output)).collect();
        let pattern = (0..function.outputs as u32).map(|output| match outputs.contains(&output) {
            true => {
                let name = name(output);
                quote!(#name)
            }
            false => quote!(_),
        });
        let field = &function.field;
        let field = if function.is_reference { quote!(self.#field) } else { quote!(&self.#field) };
        let arguments = arguments.iter().map(|&argument| self.value(argument));
        let by = derivatives.iter().map(|&i| Literal::u32_unsuffixed(i));
        let (capability, method) = super::capability(derivatives.len());
        let (capability, method) = (format_ident!("{capability}"), format_ident!("{method}"));
        let (scalar, inputs, results) = (self.style.scalar, function.inputs, function.outputs);
        let by = if derivatives.is_empty() { quote!() } else { quote!(, [#(#by),*]) };
        self.assignments.push(quote! { [#(#pattern),*] = __lagrange::function::#capability::<#scalar, #inputs, #results>::#method(#field, [#(#arguments),*] #by); });
        self.locals.extend(outputs.into_iter().map(name));
    }

    /// The sine and the cosine of one argument are computed together, when the first of them is met.
    fn write_sine_or_cosine(&mut self, index: usize, function: Function, x: Register, schedule: &Schedule) {
        let other = if function == Function::Sin { Function::Cos } else { Function::Sin };
        let partner =
            schedule.find(Operation::Function(other, x)).filter(|partner| self.uses[partner.index()] > 0);
        let Some(partner) = partner else {
            let tokens = call(function.name(), &[self.value(x)]);
            let value = self.assign(index, &tokens);
            return self.values.push((value, 0));
        };
        if partner.index() < index {
            let name = self.register_name(index);
            return self.values.push((quote!(#name), 0));
        }
        let (mine, theirs) = (self.register_name(index), self.register_name(partner.index()));
        let (sine, cosine) = if function == Function::Sin { (&mine, &theirs) } else { (&theirs, &mine) };
        let x = self.value(x);
        self.assignments.push(quote! { (#sine, #cosine) = __lagrange::Scalar::sin_cos(#x); });
        self.locals.extend([mine.clone(), theirs]);
        self.values.push((quote!(#mine), 0));
    }

    /// `r12`, unless the user has something of that name.
    fn register_name(&self, index: usize) -> Ident {
        let name = format!("r{index}");
        let suffix = if self.style.taken.contains(&name) { "_" } else { "" };
        format_ident!("{name}{suffix}", span = Span::mixed_site())
    }

    /// Puts a result into a local: under its definition's name where it has one.
    fn assign(&mut self, index: usize, tokens: &TokenStream) -> TokenStream {
        let register = Register::at(index);
        let name = match self.names.get(&register) {
            Some(name) => (*name).clone(),
            None => self.register_name(index),
        };
        self.assignments.push(quote! { #name = #tokens; });
        self.locals.push(name.clone());
        quote!(#name)
    }

    /// All assignments, with the declarations of what they assign to.
    fn finish(self) -> TokenStream {
        let assignments = &self.assignments;
        if self.locals.len() <= BATCH {
            return quote! { #(let #assignments)* };
        }
        let declarations = self.locals.chunks(BATCH).map(|batch| {
            let types = batch.iter().map(|_| self.style.scalar);
            quote! { let (#(#batch,)*): (#(#types,)*); }
        });
        quote! { #(#declarations)* #(#assignments)* }
    }
}

fn infix(x: TokenStream, operator: TokenStream, y: TokenStream) -> TokenStream {
    quote!(#x #operator #y)
}

fn call(name: &str, arguments: &[TokenStream]) -> TokenStream {
    let name = Ident::new(name, Span::mixed_site());
    quote!(__lagrange::Scalar::#name(#(#arguments),*))
}
