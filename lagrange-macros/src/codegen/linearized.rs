//! The capability of Jacobians: the residual's derivative along a direction, and the parameters by index.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::guard::guarded;
use super::schedule::Schedule;
use super::style::{Style, identifier};
use super::{
    Count, FUNCTION_ORDER, OPERATION_LIMIT, bounded_generics, count_doc, function_bound, orders, runtime,
};
use crate::mechanics::{Equations, Linearization, arguments};
use crate::resolve::Problem;
use crate::symbolic::Id;
use crate::syntax::Declaration;
use crate::variables::Variable;

/// The implementation of `Linearized`; nothing where it would be too long, or take derivatives of a higher order
/// than functions have.
pub(crate) fn linearized(
    declaration: &Declaration,
    problem: &Problem,
    equations: &Equations,
    linearization: &Linearization,
    scalar: &syn::Type,
) -> TokenStream {
    let orders = orders(problem, equations, &linearization.roots());
    if orders.values().any(|&order| order > FUNCTION_ORDER) {
        return TokenStream::new();
    }
    let mut style = Style::new(problem, scalar);
    let changes = name_changes(&mut style);
    let emitter = Emitter { problem, style: &style, parameters: by_field(problem) };
    let Some(change) = emitter.residual_change(linearization, &changes) else { return TokenStream::new() };
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
        };
    }
}

/// The parameters in the order of the fields and not in that of their first use.
fn by_field(problem: &Problem) -> Vec<usize> {
    let mut order: Vec<usize> = (0..problem.parameters.entries.len()).collect();
    order.sort_by_key(|&k| problem.parameters.entries[k].field);
    order
}

/// Gives the rates of change names, `d_x` that of `x`.
fn name_changes(style: &mut Style<'_>) -> Vec<Ident> {
    let arguments = arguments(style.problem);
    let name = |(i, argument)| {
        let name = identifier(&format!("d_{}", style.names[&argument]), &mut style.taken);
        style.names.insert(Variable::Change(i).symbol(), name.clone());
        name
    };
    arguments.into_iter().enumerate().map(name).collect()
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
                __lagrange::eliminate::vector([#(#values),*])
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

    fn residual_change(&self, linearization: &Linearization, changes: &[Ident]) -> Option<TokenStream> {
        let roots = linearization.roots();
        let (schedule, results) = guarded(&Schedule::new(&self.problem.graph, &roots), &roots);
        let kernel = self.style.write(&schedule, &results);
        let Count { arithmetic, functions, .. } = kernel.count;
        if arithmetic + functions > OPERATION_LIMIT {
            return None;
        }
        let [n, m, p] = self.dimensions();
        let (scalar, doc, statements) = (self.style.scalar, count_doc(kernel.count), &kernel.statements);
        let directions = self.directions(changes);
        let mut results = kernel.results.iter();
        let mut vector = |entries: &[Id]| {
            let entries = results.by_ref().take(entries.len());
            quote!(__lagrange::eliminate::vector([#(#entries),*]))
        };
        let Linearization { motion, acceleration, rate, position } = linearization;
        let [motion, acceleration, rate, position] =
            [motion, acceleration, rate, position].map(|x| vector(x));
        Some(quote! {
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
                #directions
                #statements
                __lagrange::ResidualChange {
                    motion: #motion,
                    acceleration: #acceleration,
                    rate: #rate,
                    position: #position,
                }
            }
        })
    }

    /// Brings the rates of change into scope.
    fn directions(&self, changes: &[Ident]) -> TokenStream {
        let n = self.problem.coordinates.len();
        let (time, rest) = (&changes[0], &changes[1..]);
        let (coordinates, rest) = rest.split_at(n);
        let (velocities, entries) = rest.split_at(n);
        let parameters = self.parameters.iter().map(|&k| &entries[k]);
        quote! {
            let #time = direction.t;
            let [#(#coordinates),*] = direction.q.data.0[0];
            let [#(#velocities),*] = direction.v.data.0[0];
            let [#(#parameters),*] = direction.parameters.data.0[0];
        }
    }
}
