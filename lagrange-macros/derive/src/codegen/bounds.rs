//! Trait bounds on the types of the fields.

use std::collections::BTreeMap;

use proc_macro2::TokenStream;
use quote::{format_ident, quote, quote_spanned};
use syn::GenericParam;
use syn::spanned::Spanned;

use super::emitter::{Emitter, runtime};
use super::operation::{Call, CallKind};
use super::slopes::literals;
use super::style::FunctionContext;
use crate::resolve::Supplied;
use crate::symbolic::{Id, Node};
use crate::syntax::Declaration;

/// Highest order to which a user-supplied function can be differentiated.
pub(super) const FUNCTION_ORDER: usize = 3;

/// Trait and method for the derivatives of an order.
pub(super) fn capability(order: usize) -> (&'static str, &'static str) {
    match order {
        0 => ("Value", "value"),
        1 => ("First", "first"),
        2 => ("Second", "second"),
        _ => ("Third", "third"),
    }
}

impl Emitter<'_> {
    /// Highest order of the derivatives of each user-supplied function in the equations of motion, the observables
    /// and `more`.
    pub(super) fn orders(&self, more: &[Id]) -> BTreeMap<u32, usize> {
        let (graph, problem) = (self.style.graph, self.problem);
        let mut roots = self.derived.equations.roots();
        roots.push(problem.lagrangian);
        roots.extend(problem.observables.iter().flat_map(|observed| &observed.values));
        roots.extend(more);
        let functions = graph.reachable(&roots).into_iter().filter_map(|id| match graph.node(id) {
            Node::External(external) => Some((external.function, external.order())),
            _ => None,
        });
        orders_of(BTreeMap::new(), functions)
    }

    /// Generics of the struct with bounds on the types of the fields. The compiler checks a bound on a concrete type
    /// at the definition. If `at_once` is false, the bounds are higher-ranked, so it checks them where the
    /// implementation is used.
    pub(super) fn generics(&self, orders: &BTreeMap<u32, usize>, at_once: bool) -> syn::Generics {
        let scalar = self.style.types.scalar;
        let mut generics = bounded_generics(self.declaration, scalar);
        self.ask_for(&mut generics, orders, &quote!(#scalar), at_once);
        generics
    }

    /// Adds a trait bound on each user-supplied function to the `where` clause: it can be evaluated on numbers of
    /// type `scalar`, with derivatives up to its order in `orders`.
    pub(super) fn ask_for(
        &self,
        generics: &mut syn::Generics,
        orders: &BTreeMap<u32, usize>,
        scalar: &TokenStream,
        at_once: bool,
    ) {
        let quantifier = (!at_once).then(|| quote!(for<'__lagrange>));
        for (&function, &order) in orders {
            let Supplied { ty, inputs, outputs, .. } = &self.problem.functions[function as usize];
            let capability = format_ident!("{}", capability(order).0);
            let bound =
                quote_spanned!(ty.span()=> __lagrange::function::#capability<#scalar, #inputs, #outputs>);
            generics.make_where_clause().predicates.push(syn::parse_quote!(#quantifier #ty: #bound));
        }
    }
}

/// Highest order of the derivatives of each function, in `known` and among these functions with an order.
pub(super) fn orders_of(
    known: BTreeMap<u32, usize>,
    more: impl Iterator<Item = (u32, usize)>,
) -> BTreeMap<u32, usize> {
    more.fold(known, |mut orders, (function, order)| {
        let known = orders.entry(function).or_default();
        *known = order.max(*known);
        orders
    })
}

impl FunctionContext<'_> {
    /// Emits the calls of a user-supplied function, or of its partial derivatives `by`, on numbers of type `scalar`. Several
    /// of them are an array.
    pub(super) fn calls_on<X>(
        &self,
        scalar: &TokenStream,
        call: &Call<X>,
        by: &[&[u32]],
        argument: impl FnMut(&X) -> TokenStream,
    ) -> TokenStream {
        let arguments = call.arguments.iter().map(argument);
        let which = by.iter().map(|derivatives| self.which(call, derivatives));
        match by.len() {
            1 => self.call_on(scalar, call, &quote!([#(#arguments),*]), &quote!(#(#which)*)),
            _ => {
                let call = self.call_on(scalar, call, &quote!(x), &quote!(which));
                quote!({ let x = [#(#arguments),*]; [#(#which),*].map(|which| #call) })
            }
        }
    }

    /// Emits the arguments of differentiation, or where gradients begin among the slopes.
    fn which<X>(&self, call: &Call<X>, derivatives: &[u32]) -> TokenStream {
        match call.kind {
            CallKind::Slopes(block) => self.start_of_gradients(block, derivatives),
            _ => literals(derivatives),
        }
    }

    fn call_on<X>(
        &self,
        scalar: &TokenStream,
        call: &Call<X>,
        x: &TokenStream,
        which: &TokenStream,
    ) -> TokenStream {
        let Supplied { inputs, outputs, .. } = &self.problem.functions[call.function as usize];
        if let CallKind::Slopes(_) = call.kind {
            return quote!(__lagrange::generated::along::<_, _, #inputs, #outputs>(&slopes[#which..], #x));
        }
        let field = self.supplied_field(call.function);
        let which = (!call.derivatives.is_empty()).then(|| quote!(, #which));
        let (capability, method) = capability(call.derivatives.len());
        let (capability, method) = (format_ident!("{capability}"), format_ident!("{method}"));
        quote!(__lagrange::function::#capability::<#scalar, #inputs, #outputs>::#method(#field, #x #which))
    }

    /// Reference to the field that holds a function.
    pub(super) fn supplied_field(&self, function: u32) -> TokenStream {
        let Supplied { field, is_reference, .. } = &self.problem.functions[function as usize];
        let system = &self.system;
        if *is_reference { quote!(#system.#field) } else { quote!(&#system.#field) }
    }
}

/// Generics of the struct. A scalar that is a type parameter gets the bound `Scalar`.
pub(super) fn bounded_generics(declaration: &Declaration, scalar: &syn::Type) -> syn::Generics {
    let runtime = runtime(declaration);
    let mut generics = declaration.generics.clone();
    let scalar = quote!(#scalar).to_string();
    for parameter in &mut generics.params {
        if let GenericParam::Type(parameter) = parameter
            && parameter.ident == scalar
        {
            parameter.bounds.push(syn::parse_quote!(#runtime::Scalar));
        }
    }
    generics
}
