//! What the types of a struct must be able to do.

use std::collections::BTreeMap;

use quote::{format_ident, quote, quote_spanned};
use syn::GenericParam;
use syn::spanned::Spanned;

use super::Emitter;
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
        let quantifier = (!at_once).then(|| quote!(for<'__lagrange>));
        let mut generics = bounded_generics(self.declaration, self.style.types.scalar);
        for (&function, &order) in orders {
            let Supplied { ty, inputs, outputs, .. } = &self.problem.functions[function as usize];
            let (capability, scalar) = (format_ident!("{}", capability(order).0), self.style.types.scalar);
            let bound =
                quote_spanned!(ty.span()=> __lagrange::function::#capability<#scalar, #inputs, #outputs>);
            generics.make_where_clause().predicates.push(syn::parse_quote!(#quantifier #ty: #bound));
        }
        generics
    }
}

/// The struct's generics, where a scalar that is a type parameter is bound to be one.
pub(super) fn bounded_generics(declaration: &Declaration, scalar: &syn::Type) -> syn::Generics {
    let runtime = super::runtime(declaration);
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
