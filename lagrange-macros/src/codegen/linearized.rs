//! The capability of Jacobians: the residual's derivative along a direction, and the parameters by index.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::kernel::Kernel;
use super::passes::Program;
use super::shape::Shape;
use super::style::{Style, identifier};
use super::{FUNCTION_ORDER, bounded_generics, function_bound, orders, runtime};
use crate::mechanics::{Equations, Linearization, arguments};
use crate::resolve::Problem;
use crate::symbolic::Graph;
use crate::syntax::Declaration;
use crate::variables::Variable;

/// The implementation of `Linearized`; nothing where it would be too long, or take derivatives of a higher order
/// than functions have.
pub(super) fn linearized(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    equations: &Equations,
    linearization: &Linearization,
) -> TokenStream {
    let scalar = &problem.scalar;
    let orders = orders(graph, problem, equations, &linearization.roots());
    if orders.values().any(|&order| order > FUNCTION_ORDER) {
        return TokenStream::new();
    }
    let mut style = Style::new(graph, problem);
    name_changes(&mut style);
    let emitter = Emitter { problem, style: &style, parameters: problem.parameters.by_field() };
    let change = emitter.residual_change(linearization);
    if !style.refused.borrow().is_empty() {
        return TokenStream::new();
    }
    let (values, setter) = (emitter.values(), emitter.setter());
    let mut generics = bounded_generics(declaration, scalar);
    for (&function, &order) in &orders {
        let mut bound = function_bound(&problem.functions[function as usize], order, scalar);
        // A bound on a concrete type is checked at once, unless it is of a higher rank: a function without these
        // derivatives is an error only where a Jacobian is asked for.
        if let syn::WherePredicate::Type(bound) = &mut bound {
            bound.lifetimes = Some(syn::parse_quote!(for<'__lagrange>));
        }
        generics.make_where_clause().predicates.push(bound);
    }
    let (impl_generics, _, where_clause) = generics.split_for_impl();
    let (_, type_generics, _) = declaration.generics.split_for_impl();
    let (runtime, ident) = (runtime(declaration), &declaration.ident);
    let [n, m, p] = emitter.dimensions();
    let parts = style.parts.borrow();
    let parts = (!parts.is_empty()).then(|| {
        quote! {
            #[automatically_derived]
            #[allow(clippy::all, unused_parens)]
            impl #impl_generics #ident #type_generics #where_clause {
                #(#parts)*
            }
        }
    });
    let names = emitter.parameters.iter().map(|&k| problem.parameters.name(k));
    quote! {
        const _: () = {
            use #runtime as __lagrange;

            #[automatically_derived]
            #[allow(clippy::all, unused_parens)]
            impl #impl_generics __lagrange::Linearized<#n, #m, #p> for #ident #type_generics #where_clause {
                const PARAMETERS: [&'static str; #p] = [#(#names),*];
                #values
                #setter
                #change
            }

            #parts
        };
    }
}

/// Gives the rates of change names, `d_x` that of `x`.
fn name_changes(style: &mut Style<'_>) {
    for (i, argument) in arguments(style.problem).into_iter().enumerate() {
        let name = identifier(&format!("d_{}", style.names[&argument]), &mut style.taken);
        style.names.insert(Variable::Change(i).symbol(), name);
    }
}

struct Emitter<'a> {
    problem: &'a Problem,
    style: &'a Style<'a>,
    /// Which entry each public parameter is.
    parameters: Vec<usize>,
}

impl Emitter<'_> {
    fn dimensions(&self) -> [usize; 3] {
        [self.problem.coordinates.len(), self.problem.constraints.len(), self.parameters.len()]
    }

    fn values(&self) -> TokenStream {
        let (scalar, p) = (self.style.scalar, self.parameters.len());
        let values = self.parameters.iter().map(|&k| self.style.parameter(k));
        quote! {
            fn parameters(&self) -> __lagrange::nalgebra::SVector<#scalar, #p> {
                __lagrange::generated::vector([#(#values),*])
            }
        }
    }

    /// What is behind a reference, or in a type that only `#[parameter(…)]` gives a shape, cannot be set.
    fn setter(&self) -> TokenStream {
        let scalar = self.style.scalar;
        let arms = self.parameters.iter().enumerate().filter_map(|(index, &k)| {
            let field = &self.problem.parameters.fields[self.problem.parameters.entries[k].field];
            let shape = field.shape.as_ref().ok()?;
            let settable = !shape.is_reference && shape.scalar.is_some();
            let place = self.style.parameter(k);
            settable.then(|| quote!(#index => #place = value,))
        });
        quote! {
            #[allow(unused_variables, unreachable_code)]
            fn set_parameter(&mut self, index: usize, value: #scalar) -> bool {
                match index {
                    #(#arms)*
                    _ => return false,
                }
                true
            }
        }
    }

    fn residual_change(&self, linearization: &Linearization) -> TokenStream {
        let [n, m, p] = self.dimensions();
        let program = Program::of_changes(self.style.graph, &linearization.roots());
        let shapes = [n, m, m, m].map(Shape::Vector);
        let Kernel { statements, results, doc } = self.style.write("residual_change", &program, &shapes);
        let scalar = self.style.scalar;
        let names = ["motion", "acceleration", "rate", "position"].map(|name| format_ident!("{name}"));
        quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            fn residual_change(
                &self,
                state: &__lagrange::State<#scalar, #n>,
                solution: &__lagrange::Solution<#scalar, #n, #m>,
                direction: &__lagrange::Direction<#scalar, #n, #p>,
            ) -> __lagrange::ResidualChange<#scalar, #n, #m> {
                let multipliers = &solution.multipliers;
                #statements
                __lagrange::ResidualChange { #(#names: __lagrange::generated::vector(#results)),* }
            }
        }
    }
}
