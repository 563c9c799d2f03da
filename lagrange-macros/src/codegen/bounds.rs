//! What the types of a struct must be able to do.

use std::collections::BTreeMap;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use syn::GenericParam;
use syn::spanned::Spanned;

use super::emitter::{Emitter, runtime};
use super::operation::Call;
use crate::resolve::Supplied;
use crate::symbolic::{Id, Node};
use crate::syntax::Declaration;

/// How often a function that the user supplies can be differentiated.
pub(super) const FUNCTION_ORDER: usize = 3;

/// The trait that gives the derivatives of an order, and its method.
pub(super) fn capability(order: usize) -> (&'static str, &'static str) {
    match order {
        0 => ("Value", "value"),
        1 => ("First", "first"),
        2 => ("Second", "second"),
        _ => ("Third", "third"),
    }
}

impl Emitter<'_> {
    /// Of each function that the user supplies, the highest derivative that the system needs, with `more` expressions.
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

    /// The struct's generics with what the fields must be able to do, asked for at the fields' types: at once, or only
    /// where somebody uses it. (A bound on a concrete type is checked at once, unless it is of a higher rank.)
    pub(super) fn generics(&self, orders: &BTreeMap<u32, usize>, at_once: bool) -> syn::Generics {
        let scalar = self.style.types.scalar;
        let mut generics = bounded_generics(self.declaration, scalar);
        self.ask_for(&mut generics, orders, &quote!(#scalar), at_once);
        generics
    }

    /// Bounds of functions over a scalar.
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

/// The highest derivative of each function among calls, and of those known.
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

/// A call of a function on numbers of this type.
pub(super) fn call_of<X>(
    supplied: &Supplied,
    call: &Call<X>,
    scalar: &TokenStream,
    argument: impl FnMut(&X) -> TokenStream,
) -> TokenStream {
    let Supplied { field, is_reference, inputs, outputs, .. } = supplied;
    let field = if *is_reference { quote!(self.#field) } else { quote!(&self.#field) };
    let arguments = call.arguments.iter().map(argument);
    let by = call.derivatives.iter().map(|&i| Literal::u32_unsuffixed(i));
    let by = (!call.derivatives.is_empty()).then(|| quote!(, [#(#by),*]));
    let (capability, method) = capability(call.derivatives.len());
    let (capability, method) = (format_ident!("{capability}"), format_ident!("{method}"));
    quote!(__lagrange::function::#capability::<#scalar, #inputs, #outputs>::#method(#field, [#(#arguments),*] #by))
}

/// The struct's generics, where a scalar that is a type parameter is bound to be one.
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
