//! Trait bounds on the types of the fields.

use std::collections::BTreeMap;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use syn::GenericParam;
use syn::spanned::Spanned;

use super::emitter::{Emitter, runtime};
use super::operation::Call;
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
        let mut orders = BTreeMap::new();
        for id in graph.reachable(&roots) {
            if let Node::External(external) = graph.node(id) {
                let order = orders.entry(external.function).or_default();
                *order = external.derivatives.len().max(*order);
            }
        }
        orders
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

/// Highest order of the derivatives of each function, in `known` and in the calls.
pub(super) fn orders_of<'c, X: 'c>(
    known: BTreeMap<u32, usize>,
    calls: impl Iterator<Item = &'c Call<X>>,
) -> BTreeMap<u32, usize> {
    calls.fold(known, |mut orders, call| {
        let order = orders.entry(call.function).or_default();
        *order = call.derivatives.len().max(*order);
        orders
    })
}

impl FunctionContext<'_> {
    /// Emits a call of a user-supplied function on numbers of type `scalar`.
    pub(super) fn call_on<X>(
        &self,
        scalar: &TokenStream,
        call: &Call<X>,
        argument: impl FnMut(&X) -> TokenStream,
    ) -> TokenStream {
        let Supplied { field, is_reference, inputs, outputs, .. } =
            &self.problem.functions[call.function as usize];
        let system = &self.system;
        let field = if *is_reference { quote!(#system.#field) } else { quote!(&#system.#field) };
        let arguments = call.arguments.iter().map(argument);
        let by = call.derivatives.iter().map(|&i| Literal::u32_unsuffixed(i));
        let by = (!call.derivatives.is_empty()).then(|| quote!(, [#(#by),*]));
        let (capability, method) = capability(call.derivatives.len());
        let (capability, method) = (format_ident!("{capability}"), format_ident!("{method}"));
        quote!(__lagrange::function::#capability::<#scalar, #inputs, #outputs>::#method(#field, [#(#arguments),*] #by))
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
