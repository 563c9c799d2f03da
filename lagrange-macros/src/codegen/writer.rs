//! Statements that compute the operations of a schedule, part by part.

use std::collections::BTreeSet;
use std::ops::Range;

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};
use rustc_hash::{FxHashMap, FxHashSet};

use super::chunks::Waiting;
use super::operation::{Call, Operation, Register};
use super::schedule::Schedule;
use super::style::Style;
use crate::symbolic::{Function, Symbol};

/// Up to this many locals each have a `let`. Beyond, they are declared in batches of as many, as tuples, and
/// then assigned: one `let` each overflows rustc's stack near 3,000 in a build with debug information.
const BATCH: usize = 256;
/// Single-use results are nested into what uses them to this depth.
const NESTING: usize = 6;

/// Statements under construction.
pub(super) struct Writer<'s, 'a> {
    style: &'s Style<'a>,
    schedule: &'s Schedule,
    uses: Vec<usize>,
    /// For each register the last part that uses it.
    reach: Vec<usize>,
    /// For each register that is computed: the tokens that stand for it, how deep they nest, and the part.
    values: Vec<Option<Value>>,
    names: FxHashMap<Register, &'s Ident>,
    /// The calls that have been written already.
    written_calls: FxHashSet<u32>,
    pub(super) waiting: Waiting,
    part: Part,
}

struct Value {
    tokens: TokenStream,
    depth: usize,
    part: usize,
}

/// The part that is being written.
#[derive(Default)]
struct Part {
    index: usize,
    inputs: BTreeSet<Symbol>,
    locals: Vec<Ident>,
    statements: Vec<Statement>,
    /// What earlier parts computed and this one has in a local.
    fetched: BTreeSet<Register>,
    /// What is in a local and which a later part uses.
    kept: Vec<Register>,
}

enum Statement {
    /// Of locals, which it may declare.
    Assignment(TokenStream),
    /// Of a place in an array.
    Placing(TokenStream),
}

/// What a part reads, and its statements.
pub(super) struct Written {
    pub(super) inputs: BTreeSet<Symbol>,
    pub(super) statements: TokenStream,
}

impl<'s, 'a> Writer<'s, 'a> {
    /// To write `parts` of the sequence, one after the other.
    pub(super) fn new(
        style: &'s Style<'a>,
        schedule: &'s Schedule,
        uses: Vec<usize>,
        sequence: &[usize],
        parts: &[Range<usize>],
    ) -> Self {
        let mut names = FxHashMap::default();
        for &(register, id) in &schedule.definitions {
            if let Some(name) = style.definition_names.get(&id) {
                names.entry(register).or_insert(name);
            }
        }
        let mut reach = vec![0; schedule.operations.len()];
        for (part, range) in parts.iter().enumerate() {
            for &index in &sequence[range.clone()] {
                reach[index] = part;
                schedule.operands(schedule.operations[index]).for_each(|x| reach[x.index()] = part);
            }
        }
        let values = schedule.operations.iter().map(|_| None).collect();
        let (written_calls, waiting, part) = Default::default();
        Self { style, schedule, uses, reach, values, names, written_calls, waiting, part }
    }

    /// The tokens that stand for a result, here.
    pub(super) fn value(&mut self, register: Register) -> TokenStream {
        match self.schedule.operations[register.index()] {
            Operation::Constant(bits) => self.style.constant(f64::from_bits(bits)),
            Operation::Input(symbol) => {
                self.part.inputs.insert(symbol);
                let name = &self.style.names[&symbol];
                quote!(#name)
            }
            _ => {
                self.fetch(register);
                let value = self.values[register.index()].as_ref();
                value.map(|value| value.tokens.clone()).unwrap_or_default()
            }
        }
    }

    /// Brings what an earlier part computed into a local.
    fn fetch(&mut self, register: Register) {
        let Some(value) = &self.values[register.index()] else { return };
        let Some(place) = self.waiting.place(register).filter(|_| value.part < self.part.index) else {
            return;
        };
        if self.part.fetched.insert(register) {
            let name = self.name(register.index());
            let place = Literal::usize_unsuffixed(place);
            self.assign(std::slice::from_ref(&name), &quote!(#name = waiting[#place]));
        }
    }

    fn depth(&self, register: Register) -> usize {
        self.values[register.index()].as_ref().map_or(0, |value| value.depth)
    }

    /// Computes one operation, if it has not come with another.
    pub(super) fn write(&mut self, index: usize) {
        match self.schedule.operations[index] {
            _ if self.values[index].is_some() => {}
            Operation::Result { call, .. } => self.write_call(call),
            Operation::Function(function @ (Function::Sin | Function::Cos), x) => {
                self.write_sine_or_cosine(index, function, x);
            }
            operation => {
                let operands = self.schedule.operands(operation);
                let depth = 1 + operands.map(|operand| self.depth(operand)).max().unwrap_or(0);
                let tokens = self.operation(operation);
                if self.uses[index] == 1 && depth < NESTING && self.reach[index] == self.part.index {
                    self.values[index] =
                        Some(Value { tokens: quote!((#tokens)), depth, part: self.part.index });
                } else {
                    self.define(index, &tokens);
                }
            }
        }
    }

    fn operation(&mut self, operation: Operation) -> TokenStream {
        let mut value = |register| self.value(register);
        match operation {
            Operation::Negate(x) => {
                let x = value(x);
                quote!(-#x)
            }
            Operation::Add(x, y) => infix(value(x), quote!(+), value(y)),
            Operation::Subtract(x, y) => infix(value(x), quote!(-), value(y)),
            Operation::Multiply(x, y) => infix(value(x), quote!(*), value(y)),
            Operation::Divide(x, y) => infix(value(x), quote!(/), value(y)),
            Operation::MultiplyAdd(x, y, z) => call("multiply_add", &[value(x), value(y), value(z)]),
            Operation::SubtractProduct(x, y, z) => call("subtract_product", &[value(x), value(y), value(z)]),
            Operation::Minimum(x, y) => call("min", &[value(x), value(y)]),
            Operation::Maximum(x, y) => call("max", &[value(x), value(y)]),
            Operation::Where(x, y) => {
                let (x, y) = (value(x), value(y));
                quote!(__lagrange::generated::only_where(#x, #y))
            }
            Operation::SquareRoot(x) => call("sqrt", &[value(x)]),
            Operation::Function(function, x) => call(function.name(), &[value(x)]),
            Operation::Atan2(y, x) => call("atan2", &[value(y), value(x)]),
            Operation::Power(x, y) => call("powf", &[value(x), value(y)]),
            Operation::Constant(_) | Operation::Input(_) | Operation::Result { .. } => TokenStream::new(),
        }
    }

    /// All results of a call are computed together, when the first of them is met.
    fn write_call(&mut self, call: u32) {
        if !self.written_calls.insert(call) {
            return;
        }
        let Call { function, derivatives, arguments } = &self.schedule.calls[call as usize];
        let function = &self.style.problem.functions[*function as usize];
        let mut names = Vec::new();
        let pattern: Vec<TokenStream> = (0..function.outputs as u32)
            .map(|output| {
                let register = self.used(Operation::Result { call, output })?;
                let name = format_ident!("call{call}_{output}", span = Span::mixed_site());
                self.keep(register, quote!(#name));
                names.push(name.clone());
                Some(quote!(#name))
            })
            .map(|name| name.unwrap_or_else(|| quote!(_)))
            .collect();
        let field = &function.field;
        let field = if function.is_reference { quote!(self.#field) } else { quote!(&self.#field) };
        let arguments: Vec<_> = arguments.iter().map(|&argument| self.value(argument)).collect();
        let by = derivatives.iter().map(|&i| Literal::u32_unsuffixed(i));
        let (capability, method) = super::capability(derivatives.len());
        let (capability, method) = (format_ident!("{capability}"), format_ident!("{method}"));
        let (scalar, inputs, results) = (self.style.scalar, function.inputs, function.outputs);
        let by = if derivatives.is_empty() { quote!() } else { quote!(, [#(#by),*]) };
        self.assign(&names, &quote! { [#(#pattern),*] = __lagrange::function::#capability::<#scalar, #inputs, #results>::#method(#field, [#(#arguments),*] #by) });
    }

    /// The sine and the cosine of one argument are computed together, when the first of them is met.
    fn write_sine_or_cosine(&mut self, index: usize, function: Function, x: Register) {
        let other = if function == Function::Sin { Function::Cos } else { Function::Sin };
        let argument = self.value(x);
        let Some(partner) = self.used(Operation::Function(other, x)) else {
            return self.define(index, &call(function.name(), &[argument]));
        };
        let (mine, theirs) = (self.name(index), self.name(partner.index()));
        let (sine, cosine) = if function == Function::Sin { (&mine, &theirs) } else { (&theirs, &mine) };
        self.assign(
            &[mine.clone(), theirs.clone()],
            &quote! { (#sine, #cosine) = __lagrange::Scalar::sin_cos(#argument) },
        );
        self.keep(Register::at(index), quote!(#mine));
        self.keep(partner, quote!(#theirs));
    }

    /// The result of an operation, if it is computed at all.
    fn used(&self, operation: Operation) -> Option<Register> {
        self.schedule.find(operation).filter(|register| self.uses[register.index()] > 0)
    }

    /// Its definition's name, or `r12`, unless the user has something of that name.
    fn name(&self, index: usize) -> Ident {
        if let Some(name) = self.names.get(&Register::at(index)) {
            return (*name).clone();
        }
        format_ident!("r{index}", span = Span::mixed_site())
    }

    /// Puts a result into a local.
    fn define(&mut self, index: usize, tokens: &TokenStream) {
        let name = self.name(index);
        self.assign(std::slice::from_ref(&name), &quote!(#name = #tokens));
        self.keep(Register::at(index), quote!(#name));
    }

    fn assign(&mut self, locals: &[Ident], assignment: &TokenStream) {
        self.part.locals.extend_from_slice(locals);
        self.part.statements.push(Statement::Assignment(quote!(#assignment;)));
    }

    /// Notes in which local a result is.
    fn keep(&mut self, register: Register, tokens: TokenStream) {
        if self.reach[register.index()] > self.part.index {
            self.part.kept.push(register);
        }
        self.values[register.index()] = Some(Value { tokens, depth: 0, part: self.part.index });
    }

    /// Whether a value is not computed, but a constant or an input.
    pub(super) fn is_at_hand(&self, register: Register) -> bool {
        matches!(self.schedule.operations[register.index()], Operation::Constant(_) | Operation::Input(_))
    }

    /// Puts a result into an array.
    pub(super) fn place(&mut self, register: Register, place: &TokenStream) {
        let value = self.value(register);
        self.part.statements.push(Statement::Placing(quote!(#place = #value;)));
    }

    /// The part as it stands; the next one begins.
    pub(super) fn finish(&mut self) -> Written {
        let index = self.part.index;
        let ended = self.part.fetched.iter().filter(|register| self.reach[register.index()] == index);
        ended.for_each(|&register| self.waiting.remove(register));
        for register in std::mem::take(&mut self.part.kept) {
            let place = Literal::usize_unsuffixed(self.waiting.add(register));
            self.place(register, &quote!(waiting[#place]));
        }
        let part = std::mem::replace(&mut self.part, Part { index: index + 1, ..Part::default() });
        Written { statements: part.statements(self.style.scalar), inputs: part.inputs }
    }
}

impl Part {
    /// All statements, with the declarations of what they assign to.
    fn statements(&self, scalar: &syn::Type) -> TokenStream {
        let is_short = self.locals.len() <= BATCH;
        let statements = self.statements.iter().map(|statement| match statement {
            Statement::Assignment(tokens) if is_short => quote!(let #tokens),
            Statement::Assignment(tokens) | Statement::Placing(tokens) => tokens.clone(),
        });
        let batches = if is_short { &[] } else { &self.locals[..] }.chunks(BATCH);
        let declarations = batches.map(|batch| {
            let types = batch.iter().map(|_| scalar);
            quote! { let (#(#batch,)*): (#(#types,)*); }
        });
        quote! { #(#declarations)* #(#statements)* }
    }
}

fn infix(x: TokenStream, operator: TokenStream, y: TokenStream) -> TokenStream {
    quote!(#x #operator #y)
}

fn call(name: &str, arguments: &[TokenStream]) -> TokenStream {
    let name = Ident::new(name, Span::mixed_site());
    quote!(__lagrange::Scalar::#name(#(#arguments),*))
}
