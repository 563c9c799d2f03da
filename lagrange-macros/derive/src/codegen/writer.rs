//! Writes the bodies of functions in Rust.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::body::{Chunk, Local, Operand, SineAndCosine, Slot, SlotSequence, Statement};
use super::operation::{Call, Operation};
use super::rounds::waiting;
use super::shape::ResultArrays;
use super::style::FunctionContext;

/// Maximum number of locals with a `let` each. More locals are declared in batches of this size, as tuples,
/// and assigned later: one `let` each overflows the stack of rustc near 3,000 in a build with debug
/// information.
const BATCH: usize = 256;

/// Minimum number of angles for which sines and cosines of several at once are function calls instead of
/// inline code. The calls halve the code of ten links and its compile time. 8 to 20 links run 2 to 20 %
/// faster; the time of robots changes by 2 % either way.
const MANY_ANGLES: usize = 8;

impl FunctionContext<'_> {
    /// Emits all statements, with the declarations of inputs and locals.
    pub(super) fn statements(&self, part: Chunk, arrays: &ResultArrays) -> TokenStream {
        let inputs = self.inputs(&part.inputs);
        let is_short = part.locals.len() <= BATCH;
        let batches = if is_short { &[] } else { &part.locals[..] }.chunks(BATCH);
        let declarations = batches.map(|batch| {
            let (names, types) =
                (batch.iter().map(|&local| self.local(local)), batch.iter().map(|_| self.types.scalar));
            quote! { let (#(#names,)*): (#(#types,)*); }
        });
        let word = is_short.then(|| quote!(let));
        let together = together(&part.statements);
        let written = part.statements.into_iter().map(|statement| match statement {
            Statement::Let(local, value) => {
                let (name, value) = (self.local(local), self.expression(value));
                quote!(#word #name = #value;)
            }
            Statement::Small(angles) => {
                let (names, angles): (Vec<_>, Vec<_>) =
                    angles.into_iter().map(|(local, angle)| (self.local(local), self.operand(angle))).unzip();
                quote!(#word [#(#names),*] = __lagrange::Scalar::small_angles([#(#angles),*]);)
            }
            Statement::Turns(turns) => {
                let turns = self.turns(turns, &together);
                quote!(#word #turns;)
            }
            Statement::Call(call, calls) => {
                let patterns = calls.iter().map(|(_, results)| self.pattern(&call, results));
                let pattern = match calls.len() {
                    1 => quote!(#(#patterns)*),
                    _ => quote!([#(#patterns),*]),
                };
                let by: Vec<&[u32]> = calls.iter().map(|(derivatives, _)| &derivatives[..]).collect();
                let scalar = self.types.scalar;
                let call =
                    self.calls_on(&quote!(#scalar), &call, &by, |argument| self.operand(argument.clone()));
                quote!(#word #pattern = #call;)
            }
            Statement::Store(place, value) => {
                let (place, value) = (stored(place, arrays), self.operand(value));
                quote!(#place = #value;)
            }
        });
        let statements = quote! { #(#declarations)* #(#written)* };
        match part.rounds {
            None => quote! { #inputs #statements },
            Some(rounds) => {
                let rounds = self.rounds(&rounds, &statements);
                quote! { #inputs #rounds }
            }
        }
    }

    /// Emits `(r1, r2) = sin_cos(x)`, or the same for several angles.
    fn turns(&self, turns: Vec<SineAndCosine>, together: &TokenStream) -> TokenStream {
        let name = |local: Option<Local>| match local {
            Some(local) => self.local(local).into_token_stream(),
            None => quote!(_),
        };
        let sines: Vec<TokenStream> = turns.iter().map(|turn| name(turn.sine)).collect();
        let cosines: Vec<TokenStream> = turns.iter().map(|turn| name(turn.cosine)).collect();
        let angles: Vec<TokenStream> = turns.into_iter().map(|turn| self.operand(turn.angle)).collect();
        match &angles[..] {
            [angle] => quote!((#(#sines)*, #(#cosines)*) = __lagrange::Scalar::sin_cos(#angle)),
            _ => quote!(([#(#sines),*], [#(#cosines),*]) = #together([#(#angles),*])),
        }
    }

    /// Emits an expression without parentheses.
    fn expression(&self, expression: Operand) -> TokenStream {
        match expression {
            Operand::Local(local) => {
                let name = self.local(local);
                quote!(#name)
            }
            Operand::SpillSlots(place) => waiting(SlotSequence::constant(place)),
            Operand::Of(operation) => self.operation(*operation),
        }
    }

    /// Emits an expression as an operand, in parentheses if it is composed.
    pub(super) fn operand(&self, expression: Operand) -> TokenStream {
        let is_composed = match &expression {
            Operand::Of(operation) => !matches!(**operation, Operation::Constant(_) | Operation::Input(_)),
            Operand::Local(_) | Operand::SpillSlots(_) => false,
        };
        let tokens = self.expression(expression);
        if is_composed { quote!((#tokens)) } else { tokens }
    }

    fn operation(&self, operation: Operation<Operand>) -> TokenStream {
        match operation.with_operands(|operand| self.operand(operand)) {
            Operation::Constant(bits) => self.constant(f64::from_bits(bits)),
            Operation::Input(symbol) => {
                let name = self.input(symbol);
                quote!(#name)
            }
            Operation::Negate(x) => quote!(-#x),
            Operation::Add(x, y) => quote!(#x + #y),
            Operation::Subtract(x, y) => quote!(#x - #y),
            Operation::Multiply(x, y) => quote!(#x * #y),
            Operation::Divide(x, y) => quote!(#x / #y),
            Operation::MultiplyAdd(x, y, z) => scalar("multiply_add", &[x, y, z]),
            Operation::SubtractProduct(x, y, z) => scalar("subtract_product", &[x, y, z]),
            Operation::Minimum(x, y) => scalar("min", &[x, y]),
            Operation::Maximum(x, y) => scalar("max", &[x, y]),
            Operation::Where(x, y) => quote!(__lagrange::generated::only_where(#x, #y)),
            Operation::NanIfIllConditioned(x, y) => {
                quote!(__lagrange::generated::nan_if_ill_conditioned(#x, #y))
            }
            Operation::SquareRoot(x) => scalar("sqrt", &[x]),
            Operation::Function(function, x) => scalar(function.name(), &[x]),
            Operation::Atan2(y, x) => scalar("atan2", &[y, x]),
            Operation::Power(x, y) => scalar("powf", &[x, y]),
            // Calls are statements, not expressions.
            Operation::Result { .. } => TokenStream::new(),
        }
    }

    /// Emits a pattern such as `[call0_0, _, call0_2]`.
    fn pattern(&self, call: &Call<Operand>, results: &[(u32, Local)]) -> TokenStream {
        let outputs = self.problem.functions[call.function as usize].outputs as u32;
        let names = (0..outputs).map(|output| match results.iter().find(|(known, _)| *known == output) {
            Some((_, local)) => {
                let name = self.local(*local);
                quote!(#name)
            }
            None => quote!(_),
        });
        quote!([#(#names),*])
    }

    /// Name of a local: that of its definition, else `r12`, `angle4` or `call3_0`.
    fn local(&self, local: Local) -> Ident {
        match local {
            Local::Definition(id) => self.definition_names[&id].clone(),
            Local::Operation(index) => format_ident!("r{index}", span = Span::mixed_site()),
            Local::Angle(index) => format_ident!("angle{index}", span = Span::mixed_site()),
            Local::Result { call, output } => format_ident!("call{call}_{output}", span = Span::mixed_site()),
        }
    }
}

/// Function that computes the sines and cosines of several angles at once.
fn together(statements: &[Statement]) -> TokenStream {
    let angles =
        |statement: &Statement| if let Statement::Turns(turns) = statement { turns.len() } else { 0 };
    match statements.iter().map(angles).sum() {
        0..MANY_ANGLES => quote!(__lagrange::Scalar::sin_cos_of_small),
        _ => quote!(__lagrange::generated::sin_cos_of_small),
    }
}

fn stored(place: Slot, arrays: &ResultArrays) -> TokenStream {
    match place {
        Slot::Result(index) => arrays.place(index),
        Slot::SpillSlots(series) => waiting(series),
    }
}

fn scalar(name: &str, arguments: &[TokenStream]) -> TokenStream {
    let name = Ident::new(name, Span::mixed_site());
    quote!(__lagrange::Scalar::#name(#(#arguments),*))
}
