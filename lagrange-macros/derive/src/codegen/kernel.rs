//! Turns a schedule into the body of a function. A long function is split into several methods.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::body::{Chunk, FunctionBody};
use super::count::{Count, OPERATION_LIMIT};
use super::passes::Program;
use super::shape::{ResultArrays, ResultShape};
use super::style::FunctionContext;
use crate::contract::Argument;
use crate::symbolic::{Id, Symbol};
use crate::variables::Variable;

/// Body of one emitted function.
#[derive(Default)]
pub(super) struct Kernel {
    pub(super) name: String,
    /// Reads the inputs and computes the results.
    pub(super) statements: TokenStream,
    /// Expressions of the results, one per shape.
    pub(super) results: Vec<TokenStream>,
    /// Doc comment that states the operation count.
    pub(super) doc: String,
    /// What the statements of a long function call.
    pub(super) parts: Vec<Part>,
    /// Operation count of a function that exceeds [`OPERATION_LIMIT`]. The other fields are then empty.
    pub(super) refused: Option<Count>,
}

/// Function that computes one chunk of a long function.
pub(super) struct Part {
    /// Name of the module of its type.
    pub(super) module: Ident,
    pub(super) name: Ident,
    pub(super) doc: String,
    pub(super) generics: Option<TokenStream>,
    /// Arguments beside the system.
    pub(super) arguments: TokenStream,
    pub(super) body: TokenStream,
}

impl FunctionContext<'_> {
    /// Compiles `roots` for the function of this name.
    pub(super) fn kernel(&self, name: &str, roots: &[Id], shapes: &[ResultShape]) -> Kernel {
        self.write(name, &Program::of(self.graph, roots), shapes)
    }

    /// Compiles a program to statements and result expressions.
    pub(super) fn write(&self, name: &str, program: &Program, shapes: &[ResultShape]) -> Kernel {
        let count = program.count();
        if count.total() > OPERATION_LIMIT {
            return Kernel { name: name.to_owned(), refused: Some(count), ..Kernel::default() };
        }
        let body = FunctionBody::new(program, &self.problem.names);
        let (doc, arrays) = (doc(program, &body), ResultArrays::new(shapes));
        let FunctionBody { parts, waiting, results, .. } = body;
        let (declarations, results) = match results {
            Some(values) => {
                let mut values = values.into_iter().map(|value| self.operand(value));
                (None, shapes.iter().map(|shape| shape.literal(&mut values)).collect())
            }
            None => (Some(arrays.declarations(&self.constant(0.0))), arrays.results()),
        };
        let (statements, parts) = self.parts(name, parts, waiting, &arrays);
        let statements = quote! { #declarations #statements };
        Kernel { name: name.to_owned(), statements, results, doc, parts, refused: None }
    }

    /// Emits the statements of a single chunk; for several chunks, their calls and the called parts.
    fn parts(
        &self,
        name: &str,
        mut parts: Vec<Chunk>,
        waiting: usize,
        arrays: &ResultArrays,
    ) -> (TokenStream, Vec<Part>) {
        if parts.len() == 1 {
            return (parts.drain(..).map(|part| self.statements(part, arrays)).collect(), Vec::new());
        }
        let (zero, count, context) = (self.constant(0.0), parts.len(), self.of_parts());
        let parts = parts.into_iter().enumerate().map(|(k, part)| {
            let rounds =
                part.rounds.as_ref().map_or_else(String::new, |rounds| format!(", {} rounds", rounds.count));
            let doc = format!("Chunk {} of {count} of `{name}`{rounds}.", k + 1);
            context.part(&self.system, (format_ident!("__{name}_{k}"), doc), part, waiting, arrays)
        });
        let (calls, parts): (Vec<_>, Vec<_>) = parts.unzip();
        (quote! { let mut waiting = [#zero; #waiting]; #(#calls)* }, parts)
    }

    /// Name of the module of a part. The length of the struct's name keeps modules of structs apart whose names continue one another.
    pub(super) fn module_of(&self, part: &Ident) -> Ident {
        let ident = self.ident.to_string();
        let name = ident.trim_start_matches("r#");
        format_ident!("__{}_{name}{part}", name.len())
    }

    /// Emits one chunk of a long function: its call for a system, and the called part.
    fn part(
        &self,
        system: &TokenStream,
        (name, doc): (Ident, String),
        part: Chunk,
        waiting: usize,
        arrays: &ResultArrays,
    ) -> (TokenStream, Part) {
        let is_read = |argument: &Argument| {
            part.reads().any(|symbol| source(symbol) == *argument)
                || (*argument == Argument::Slopes && part.reads_gradients())
        };
        let read = [
            Argument::State,
            Argument::Accelerations,
            Argument::Multipliers,
            Argument::Direction,
            Argument::Rates,
            Argument::Factor,
            Argument::Slopes,
            Argument::Sums,
            Argument::Terms,
            Argument::Order,
            Argument::Forcing,
            Argument::Bias,
        ];
        let (arguments, types): (Vec<_>, Vec<_>) = read
            .into_iter()
            .filter(is_read)
            .map(|argument| (format_ident!("{}", argument.name()), self.argument(argument)))
            .unzip();
        let (scalar, module) = (self.types.scalar, self.module_of(&name));
        let (names, array_types) = (&arrays.names, arrays.types(scalar));
        let call = quote! {
            #module::Part::<Self>::#name(#system, #(#arguments,)* &mut waiting, #(&mut #names),*);
        };
        let arguments = quote!(#(#types,)* waiting: &mut [#scalar; #waiting], #(#names: &mut #array_types),*);
        let (generics, body) = (self.generics(), self.statements(part, arrays));
        (call, Part { module, name, doc, generics, arguments, body })
    }
}

impl FunctionContext<'_> {
    /// Declares an argument of a part.
    fn argument(&self, argument: Argument) -> TokenStream {
        let factor = &self.factor;
        match argument {
            Argument::Factor => quote!(factor: &#factor),
            Argument::Slopes => {
                let slopes = self.slopes_type();
                quote!(slopes: &#slopes)
            }
            Argument::Sums => {
                let (scalar, sums) = (self.types.scalar, self.sums);
                quote!(sums: &[#scalar; #sums])
            }
            Argument::Terms => {
                let (scalar, terms) = (self.types.scalar, self.terms);
                quote!(terms: &[#scalar; #terms])
            }
            _ => self.types.argument(argument),
        }
    }
}

/// Argument from which an input is read. Parameters are read from `self`.
fn source(symbol: Symbol) -> Argument {
    match Variable::of(symbol) {
        // Momenta are not inputs of any function.
        Variable::Time | Variable::Coordinate(_) | Variable::Velocity(_) | Variable::Momentum(_) => {
            Argument::State
        }
        Variable::Acceleration(_) | Variable::AccelerationChange(_) => Argument::Accelerations,
        Variable::Multiplier(_) | Variable::MultiplierChange(_) => Argument::Multipliers,
        // Inputs of a loop iteration are locals of the loop.
        Variable::Parameter(_)
        | Variable::Switch(_)
        | Variable::Given(_)
        | Variable::Level(_)
        | Variable::Length(_)
        | Variable::Total(_) => Argument::System,
        Variable::Change(_) => Argument::Direction,
        Variable::Factor(_) => Argument::Factor,
        Variable::Forcing(_) => Argument::Forcing,
        Variable::Bias(_) => Argument::Bias,
        Variable::ParameterChange(_) => Argument::Rates,
        Variable::Slope(_) => Argument::Slopes,
        Variable::Sum(_) => Argument::Sums,
        Variable::Term(_) => Argument::Terms,
        Variable::Order | Variable::OrderReciprocal | Variable::NextWeight | Variable::WeightsReciprocal => {
            Argument::Order
        }
    }
}

/// Doc text: the operation count, and the count after each pass that reduced it.
fn doc(program: &Program, body: &FunctionBody) -> String {
    let mut doc = format!("{}.", program.count());
    let mut steps = program.counts.clone();
    steps.dedup_by_key(|(_, count)| *count);
    if steps.len() > 1 {
        let steps: Vec<_> = steps.iter().map(|(name, count)| format!("{} {name}", count.total())).collect();
        doc += &format!(" Of every kind: {}.", steps.join(", then "));
    }
    match program.fusions() {
        0 => {}
        1 => doc += " One product fused with a sum.",
        fusions => doc += &format!(" {fusions} products fused with sums."),
    }
    let [before, peak] = body.peaks;
    if peak != before {
        doc += &format!(" Reordered: at most {peak} results wait for their last use, before {before}.");
    }
    if body.parts.len() > 1 {
        doc += &format!(" In {} parts.", body.parts.len());
    }
    doc
}
