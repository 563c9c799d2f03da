//! Context shared by all emitted functions of a system: names, types, constants.

use std::cell::RefCell;
use std::collections::HashSet;

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use rustc_hash::FxHashMap;

use super::many::Window;
use super::signature::Types;
use super::slopes::SlopeLayout;
use crate::mechanics::changes;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

/// Context shared by all emitted functions of a system.
#[derive(Clone)]
pub(super) struct FunctionContext<'a> {
    pub(super) graph: &'a Graph,
    pub(super) problem: &'a Problem,
    /// Name of the struct.
    pub(super) ident: &'a Ident,
    /// Expression for the system: `self`, or the argument of a [part](super::kernel::Part).
    pub(super) system: TokenStream,
    pub(super) types: Types<'a>,
    /// Type that holds the emitted factorization.
    pub(super) factor: TokenStream,
    /// Number type of the system, for functions that are generic over a wider type; else `None`.
    pub(super) narrow: Option<&'a syn::Type>,
    /// [Slopes](Variable::Slope) that the functions read: coefficients that all directional derivatives at one state
    /// share.
    pub(super) slopes: SlopeLayout,
    /// Number of convolution sums of Taylor coefficients that the functions read.
    pub(super) sums: usize,
    /// Number of inputs of the kind [`Variable::Term`], the known parts of Taylor coefficients.
    pub(super) terms: usize,
    /// True if the scalar is `f64`. Constants are then plain literals.
    is_f64: bool,
    /// Names of inputs, valid as identifiers and unique.
    pub(super) names: FxHashMap<Symbol, Ident>,
    pub(super) definition_names: FxHashMap<Id, Ident>,
    /// Windows on arrays of the loops around what is written.
    pub(super) windows: RefCell<Vec<Window>>,
}

impl<'a> FunctionContext<'a> {
    /// `numbers` is the length of the factorization; `None` selects the factorization type of the runtime, with so many
    /// `constraints`. `slopes`, `sums` and `terms` are upper bounds on the numbers of these inputs.
    pub(super) fn new(
        graph: &'a Graph,
        (ident, problem): (&'a Ident, &'a Problem),
        (numbers, constraints): (Option<usize>, usize),
        slopes: usize,
        [sums, terms]: [usize; 2],
    ) -> Self {
        let scalar = &problem.scalar;
        let is_f64 = quote!(#scalar).to_string() == "f64";
        let mut taken = HashSet::from(
            [
                "state",
                "solution",
                "accelerations",
                "multipliers",
                "direction",
                "gradients",
                "rates",
                "factor",
                "slopes",
                "sums",
                "terms",
                "order",
                "forcing",
                "bias",
                "index",
                "self",
                "waiting",
                "round",
            ]
            .map(String::from),
        );
        // Arguments of the loops over elements.
        taken.extend(
            ["q", "v", "a", "p"].iter().filter(|_| problem.many.is_open()).map(|name| (*name).to_owned()),
        );
        taken.extend((0..6).map(|k| format!("entries{k}")));
        let mut unique = |text: String| identifier(&text, &mut taken);
        let mut names = FxHashMap::default();
        names.insert(Variable::Time.symbol(), unique("t".to_owned()));
        for (i, label) in problem.coordinates.iter().enumerate() {
            let [base, index] = split(&label.text);
            names.insert(Variable::Coordinate(i).symbol(), unique(format!("{base}{index}")));
            names.insert(Variable::Velocity(i).symbol(), unique(format!("{base}_dot{index}")));
            names.insert(Variable::Acceleration(i).symbol(), unique(format!("{base}_ddot{index}")));
            names.insert(Variable::AccelerationChange(i).symbol(), unique(format!("d_{base}_ddot{index}")));
            names.insert(Variable::Forcing(i).symbol(), unique(format!("forcing_{base}{index}")));
        }
        for (a, (label, _)) in problem.constraints.iter().enumerate() {
            names.insert(Variable::Multiplier(a).symbol(), unique(format!("lambda_{}", label.text)));
            names.insert(Variable::MultiplierChange(a).symbol(), unique(format!("d_lambda_{}", label.text)));
            names.insert(Variable::Bias(a).symbol(), unique(format!("bias_{}", label.text)));
        }
        for k in 0..problem.parameters.entries.len() {
            names.insert(Variable::Parameter(k).symbol(), unique(problem.parameters.name(k)));
        }
        for k in 0..problem.parameters.switches.len() {
            names.insert(Variable::Switch(k).symbol(), unique(problem.parameters.name_of_switch(k)));
        }
        let mut definitions: Vec<_> = problem.names.iter().collect();
        definitions.sort_unstable();
        let definition_names =
            definitions.into_iter().map(|(id, text)| (*id, unique(text.clone()))).collect();
        for (argument, change) in changes(problem) {
            let name = unique(format!("d_{}", names[&argument]));
            names.insert(change, name);
        }
        for k in 0..numbers.unwrap_or(0) {
            names.insert(Variable::Factor(k).symbol(), unique(format!("factor_{k}")));
        }
        for k in 0..slopes {
            names.insert(Variable::Slope(k).symbol(), unique(format!("s{k}")));
        }
        for k in 0..sums {
            names.insert(Variable::Sum(k).symbol(), unique(format!("sum{k}")));
        }
        for k in 0..terms {
            names.insert(Variable::Term(k).symbol(), unique(format!("term{k}")));
        }
        for k in 0..problem.many.totals.len() {
            names.insert(Variable::Total(k).symbol(), unique(format!("total{k}")));
        }
        for k in 0..problem.many.lengths.len() {
            names.insert(Variable::Length(k).symbol(), unique(format!("number_of_{k}")));
        }
        for level in 0..problem.many.deepest(graph) {
            names.insert(Variable::Level(level).symbol(), unique(format!("number_{level}")));
        }
        names.insert(Variable::Order.symbol(), unique("k".to_owned()));
        names.insert(Variable::OrderReciprocal.symbol(), unique("reciprocal_k".to_owned()));
        names.insert(Variable::NextWeight.symbol(), unique("weight_next".to_owned()));
        names.insert(Variable::WeightsReciprocal.symbol(), unique("reciprocal_weights".to_owned()));
        let (n, m) = (problem.coordinates.len(), problem.constraints.len());
        let types = Types {
            scalar,
            coordinates: Some(n),
            constraints: m,
            parameters: problem.parameters.entries.len(),
        };
        let factor = match numbers {
            Some(numbers) => quote!([#scalar; #numbers]),
            None => quote!(__lagrange::generated::LoopFactor<#scalar, #n, #constraints>),
        };
        Self {
            graph,
            problem,
            ident,
            system: quote!(self),
            types,
            factor,
            narrow: None,
            slopes: SlopeLayout::default(),
            sums,
            terms,
            is_f64,
            names,
            definition_names,
            windows: RefCell::default(),
        }
    }

    /// Context of functions that are generic over the number type `wide`, with [`Variable::Slope`]s as inputs.
    pub(super) fn over<'w>(&'w self, wide: &'w syn::Type, slopes: SlopeLayout) -> FunctionContext<'w> {
        let types = Types { scalar: wide, ..self.types };
        FunctionContext { types, narrow: Some(self.types.scalar), slopes, is_f64: false, ..self.clone() }
    }

    /// Context of functions with [`Variable::Slope`]s as inputs.
    pub(super) fn reading(&self, slopes: SlopeLayout) -> Self {
        FunctionContext { slopes, ..self.clone() }
    }

    /// Context of the parts of a long function, which have the system as an argument.
    pub(super) fn of_parts(&self) -> Self {
        FunctionContext { system: quote!(__system), ..self.clone() }
    }

    /// Generic parameters of a part.
    pub(super) fn generics(&self) -> Option<TokenStream> {
        self.narrow.map(|scalar| Types { scalar, ..self.types }.over())
    }

    /// Type of the array of [slopes](Variable::Slope).
    pub(super) fn slopes_type(&self) -> TokenStream {
        let (number, slopes) = (self.narrow.unwrap_or(self.types.scalar), self.slopes.length);
        quote!([#number; #slopes])
    }

    pub(super) fn constant(&self, value: f64) -> TokenStream {
        // Avoid a negative literal, which is two tokens.
        let magnitude = Literal::f64_unsuffixed(value.abs());
        let literal = if value.is_sign_negative() { quote!((-#magnitude)) } else { quote!(#magnitude) };
        let scalar = self.types.scalar;
        match self.narrow {
            _ if self.is_f64 => literal,
            Some(_) => quote!(#scalar::constant(#literal)),
            None => quote!(<#scalar as __lagrange::Scalar>::constant(#literal)),
        }
    }
}

/// Splits `r[2]` into `r` and `_2`.
fn split(text: &str) -> [String; 2] {
    match text.split_once('[') {
        Some((base, index)) => [base.to_owned(), format!("_{}", index.trim_end_matches(']'))],
        None => [text.to_owned(), String::new()],
    }
}

/// True if the writer uses such names for locals: `r12`, `angle4`, `given7`, `call3_0`.
fn is_local(name: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let call = name.strip_prefix("call").and_then(|rest| rest.split_once('_'));
    ["r", "angle", "given"].iter().any(|start| name.strip_prefix(start).is_some_and(is_number))
        || call.is_some_and(|(call, output)| is_number(call) && is_number(output))
}

/// Creates an identifier similar to `text` that is not taken. It begins with a small letter: as a pattern, `G` would be a constant of
/// this name, where the user's program has one.
fn identifier(text: &str, taken: &mut HashSet<String>) -> Ident {
    let mut name = text.replace("][", "_").replace("].", "_").replace(['[', '.'], "_").replace(']', "");
    name = name
        .replace(" + ", "_plus_")
        .replace(" - ", "_minus_")
        .replace('*', "_times_")
        .replace(['-', ' '], "_");
    if name.starts_with(char::is_uppercase) {
        name = name.to_lowercase();
    }
    if is_local(&name) || syn::parse_str::<Ident>(&name).is_err() || !taken.insert(name.clone()) {
        let is_free = |candidate: &String| !taken.contains(candidate);
        name = (1..).map(|k| format!("{name}__{k}")).find(is_free).unwrap_or(name);
        taken.insert(name.clone());
    }
    Ident::new(&name, Span::mixed_site())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_of_the_users_is_called_as_locals_are() {
        for name in ["r12", "angle4", "given7", "call3_0"] {
            assert_ne!(identifier(name, &mut HashSet::new()), name);
        }
        assert_eq!(identifier("x[2*i + 1][n - 1]", &mut HashSet::new()), "x_2_times_i_plus_1_n_minus_1");
        for name in ["r", "r_1", "angle", "angle_4", "call3"] {
            assert_eq!(identifier(name, &mut HashSet::new()), name);
        }
    }
}
