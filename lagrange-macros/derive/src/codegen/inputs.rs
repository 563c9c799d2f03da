//! Expressions that read inputs of emitted functions: fields, states and other arguments.

use std::collections::BTreeSet;

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};

use super::style::FunctionContext;
use crate::resolve::{Entry, Switch, SwitchReading};
use crate::symbolic::Symbol;
use crate::syntax::FieldShape;
use crate::variables::Variable;

/// Variable of each coordinate or constraint, by index.
type VariableFamily = fn(usize) -> Variable;

impl FunctionContext<'_> {
    /// Converts an input to the number type of the function, if the types differ.
    pub(super) fn widened(&self, symbol: Symbol, number: &TokenStream) -> TokenStream {
        let (is_narrow, wide) =
            (matches!(Variable::of(symbol), Variable::Factor(_) | Variable::Slope(_)), self.types.scalar);
        match self.narrow {
            Some(_) if is_narrow => quote!(#wide::of(#number)),
            _ => number.clone(),
        }
    }

    /// Reads a parameter from its field.
    pub(super) fn parameter(&self, k: usize) -> TokenStream {
        self.number(self.problem.parameters.entries[k])
    }

    /// Reads a switch from its field, as a number.
    fn switch(&self, k: usize) -> TokenStream {
        let Switch { entry, reading } = self.problem.parameters.switches[k];
        let (scalar, place) = (self.types.scalar, self.place_of_state(entry));
        match reading {
            SwitchReading::Holds => quote!(__lagrange::generated::holds::<#scalar>(&#place)),
            SwitchReading::Sticks(component) => {
                quote!(__lagrange::generated::sticks::<#scalar>(&#place, #component))
            }
            SwitchReading::Slides => quote!(__lagrange::generated::slides::<#scalar>(&#place)),
            SwitchReading::Start(component) => {
                quote!(__lagrange::generated::start::<#scalar>(&#place, #component))
            }
            SwitchReading::Slip(component) => {
                quote!(__lagrange::generated::slip::<#scalar>(&#place, #component))
            }
        }
    }

    /// Place expression of the state of a constraint.
    pub(super) fn place_of_state(&self, entry: Entry) -> TokenStream {
        self.place(entry, None)
    }

    /// Reads a number of a field.
    pub(super) fn number(&self, entry: Entry) -> TokenStream {
        self.number_of_rounds(entry, None)
    }

    /// Reads a number of a field. In a loop, `varying` is the index that depends on the iteration.
    pub(super) fn number_of_rounds(&self, entry: Entry, varying: Option<&Varying>) -> TokenStream {
        let of_member = self.number_of_member(&self.system, entry, varying);
        of_member.unwrap_or_else(|| self.place(entry, varying))
    }

    /// Emits the assignment of a number of a field, for a function that returns false if the assignment fails.
    pub(super) fn set_number(&self, entry: Entry, value: &TokenStream) -> TokenStream {
        self.set_number_of_member(entry, value).unwrap_or_else(|| {
            let place = self.place(entry, None);
            quote!(#place = #value;)
        })
    }

    /// Place expression of a number of a field without members.
    fn place(&self, Entry { field, number }: Entry, varying: Option<&Varying>) -> TokenStream {
        let field = &self.problem.parameters.fields[field];
        let (system, ident) = (&self.system, &field.ident);
        let Ok(FieldShape { layout, is_reference, .. }) = &field.shape else { return quote!(#system.#ident) };
        let indices = layout.indices(number);
        let (arrays, inside) = indices.split_at(layout.arrays());
        let literal = |k: &usize| Literal::usize_unsuffixed(*k);
        let arrays = Varying::indices(varying, arrays);
        let place = quote!(#system.#ident #([#arrays])*);
        match inside {
            [k] => {
                let k = literal(&((k + 3) % 4));
                quote!(#place.coords[#k])
            }
            [i, j] => {
                let (i, j) = (literal(i), literal(j));
                quote!(#place[(#i, #j)])
            }
            _ if arrays.is_empty() && *is_reference => quote!(*#place),
            _ => place,
        }
    }

    /// Emits the bindings of all used inputs, as whole arrays or one by one.
    pub(super) fn inputs(&self, used: &BTreeSet<Symbol>) -> TokenStream {
        if self.problem.many.is_open() {
            return self.inputs_of_loops(used);
        }
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let whole: [(usize, VariableFamily); 8] = [
            (n, Variable::Coordinate),
            (n, Variable::Velocity),
            (n, Variable::Acceleration),
            (m, Variable::Multiplier),
            (n, Variable::AccelerationChange),
            (m, Variable::MultiplierChange),
            (n, Variable::Forcing),
            (m, Variable::Bias),
        ];
        let whole =
            whole.map(|(count, variable)| (0..count).map(|k| variable(k).symbol()).collect::<Vec<_>>());
        let patterns = whole.iter().filter_map(|symbols| self.taken_apart(symbols, used));
        let families: Vec<u8> = whole.iter().filter_map(|symbols| Some(symbols.first()?.family)).collect();
        let one_by_one = |symbol: &&Symbol| !families.contains(&symbol.family);
        let (time, others): (Vec<_>, Vec<_>) =
            used.iter().filter(one_by_one).partition(|symbol| **symbol == Variable::Time.symbol());
        let [time, others] = [time, others].map(|symbols| {
            let lets = symbols.into_iter().map(|symbol| {
                let (name, value) = (&self.names[symbol], self.read(*symbol));
                quote! { let #name = #value; }
            });
            lets.collect::<TokenStream>()
        });
        quote! { #time #(#patterns)* #others }
    }

    /// Destructures the array that holds these symbols, if one of them is used.
    fn taken_apart(&self, symbols: &[Symbol], used: &BTreeSet<Symbol>) -> Option<TokenStream> {
        let (array, _) = self.array(*symbols.first()?)?;
        let names = symbols.iter().map(|symbol| match used.contains(symbol) {
            true => self.names[symbol].to_token_stream(),
            false => quote!(_),
        });
        let is_used = symbols.iter().any(|symbol| used.contains(symbol));
        is_used.then(|| quote! { let [#(#names),*] = #array; })
    }

    /// Reads an input.
    pub(super) fn read(&self, symbol: Symbol) -> TokenStream {
        match (Variable::of(symbol), self.array(symbol)) {
            (_, Some((array, place))) => {
                let place = Literal::usize_unsuffixed(place);
                self.widened(symbol, &quote!(#array[#place]))
            }
            (Variable::Parameter(k), None) => self.parameter(k),
            (Variable::Switch(k), None) => self.switch(k),
            (Variable::Change(_), None) => quote!(direction.t),
            _ => quote!(state.t),
        }
    }

    /// Array that contains an input, and its index there.
    pub(super) fn array(&self, symbol: Symbol) -> Option<(TokenStream, usize)> {
        let n = self.problem.coordinates.len();
        Some(match Variable::of(symbol) {
            Variable::Coordinate(i) => (quote!(state.q.data.0[0]), i),
            Variable::Velocity(i) => (quote!(state.v.data.0[0]), i),
            Variable::Acceleration(i) | Variable::AccelerationChange(i) => {
                (quote!(accelerations.data.0[0]), i)
            }
            Variable::Multiplier(a) | Variable::MultiplierChange(a) => (quote!(multipliers.data.0[0]), a),
            Variable::Forcing(i) => (quote!(forcing.data.0[0]), i),
            Variable::Bias(a) => (quote!(bias.data.0[0]), a),
            Variable::Change(i @ 1..) if i <= n => (quote!(direction.q.data.0[0]), i - 1),
            Variable::Change(i @ 1..) => (quote!(direction.v.data.0[0]), i - 1 - n),
            Variable::ParameterChange(k) => (quote!(rates.data.0[0]), k),
            Variable::Factor(k) => (quote!(factor), k),
            Variable::Slope(k) => (quote!(slopes), k),
            Variable::Sum(k) => (quote!(sums), k),
            Variable::Term(k) => (quote!(terms), k),
            Variable::Order => (quote!(order), 0),
            Variable::OrderReciprocal => (quote!(order), 1),
            Variable::NextWeight => (quote!(order), 2),
            Variable::WeightsReciprocal => (quote!(order), 3),
            Variable::Time
            | Variable::Change(0)
            | Variable::Parameter(_)
            | Variable::Switch(_)
            | Variable::Momentum(_)
            | Variable::Given(_)
            | Variable::Level(_)
            | Variable::Length(_)
            | Variable::Total(_) => return None,
        })
    }
}

/// Array index that depends on the iteration of a loop: its position among the indices, and its expression.
pub(super) struct Varying {
    pub(super) place: usize,
    pub(super) index: TokenStream,
}

impl Varying {
    /// Index expressions, where the varying index replaces the literal at its position.
    pub(super) fn indices(varying: Option<&Self>, indices: &[usize]) -> Vec<TokenStream> {
        let index = |(place, k): (usize, &usize)| match varying {
            Some(varying) if varying.place == place => varying.index.clone(),
            _ => Literal::usize_unsuffixed(*k).into_token_stream(),
        };
        indices.iter().enumerate().map(index).collect()
    }
}
