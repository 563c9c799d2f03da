//! From [`Equations`] to Rust. Nothing else writes any.

mod accelerations;
mod eliminate;
mod facts;
mod guard;
mod integrability;
mod kernel;
mod linearized;
mod observables;
mod schedule;
mod stub;
mod style;

use std::collections::BTreeMap;

use proc_macro2::TokenStream;
use quote::{format_ident, quote, quote_spanned};
use syn::GenericParam;
use syn::spanned::Spanned;

use crate::diagnostics::Diagnostics;
use crate::mechanics::{ConstraintKind, Equations, Facts};
use crate::render::Rendered;
use crate::resolve::{Problem, Supplied};
use crate::symbolic::{Id, Node};
use crate::syntax::Declaration;
use accelerations::Fused;
use kernel::Kernel;
pub(crate) use linearized::linearized;
use observables::method_name;
pub(crate) use schedule::Count;
pub(crate) use stub::stub;
use style::Style;

/// rustc takes a function of this many operations in seconds; beyond, the system belongs apart.
const OPERATION_LIMIT: usize = 30_000;

/// How often a function that the user supplies can be differentiated.
const FUNCTION_ORDER: usize = 3;

/// The implementation of the trait, and a method for each observable.
pub(crate) fn implementation(
    declaration: &Declaration,
    problem: &Problem,
    equations: &Equations,
    facts: &Facts,
    rendered: &Rendered,
    scalar: &syn::Type,
    diagnostics: &mut Diagnostics,
) -> TokenStream {
    let style = Style::new(problem, scalar);
    let emitter = Emitter { declaration, problem, equations, facts, rendered, style: &style };
    let fused = emitter.fused();
    let Count { arithmetic, functions, .. } = fused.kernel.count;
    if arithmetic + functions > OPERATION_LIMIT {
        diagnostics.error(problem.place, format!(
            "the equations of motion take {arithmetic} operations and {functions} elementary functions, beyond what rustc compiles in one function ({OPERATION_LIMIT}): name what recurs with `#[define(…)]`, recursively along chains, so that it is shared"
        ));
        return TokenStream::new();
    }
    let orders = emitter.orders();
    for (&function, order) in orders.iter().filter(|(_, order)| **order > FUNCTION_ORDER) {
        let Supplied { name, place, .. } = &problem.functions[function as usize];
        diagnostics.error(*place, format!(
            "the equations need the {order}th derivatives of `{name}`, and functions are differentiated {FUNCTION_ORDER} times at most"
        ));
    }
    emitter.block(fused, &orders)
}

/// The trait that gives the derivatives of an order, and its method.
fn capability(order: usize) -> (&'static str, &'static str) {
    match order {
        0 => ("Value", "value"),
        1 => ("First", "first"),
        2 => ("Second", "second"),
        _ => ("Third", "third"),
    }
}

/// What computing `roots` together takes.
#[cfg(test)]
pub(crate) fn operations(graph: &crate::symbolic::Graph, roots: &[Id]) -> Count {
    let schedule = schedule::Schedule::new(graph, roots);
    let registers: Vec<_> = roots.iter().map(|&root| schedule.register(root)).collect();
    schedule.count(&registers)
}

/// What the accelerations take, solved; `None` where that is left to loops.
#[cfg(test)]
pub(crate) fn solving(problem: &Problem, equations: &Equations) -> Option<Count> {
    let mut schedule = schedule::Schedule::new(&problem.graph, &accelerations::kkt_entries(equations));
    let eliminate::Solved { accelerations, multipliers, pivot } =
        eliminate::eliminate(&mut schedule, equations)?;
    Some(schedule.count(&[accelerations, multipliers, vec![pivot]].concat()))
}

struct Emitter<'a> {
    declaration: &'a Declaration,
    problem: &'a Problem,
    equations: &'a Equations,
    facts: &'a Facts,
    rendered: &'a Rendered,
    style: &'a Style<'a>,
}

impl Emitter<'_> {
    /// Everything that is emitted, but for the Jacobians.
    fn orders(&self) -> BTreeMap<u32, usize> {
        orders(self.problem, self.equations, &[])
    }

    /// The struct's generics with what the fields must be able to do, asked for at the fields' types.
    fn generics(&self, orders: &BTreeMap<u32, usize>) -> syn::Generics {
        let scalar = self.style.scalar;
        let mut generics = bounded_generics(self.declaration, scalar);
        for (&function, &order) in orders {
            let bound = function_bound(&self.problem.functions[function as usize], order, scalar);
            generics.make_where_clause().predicates.push(bound);
        }
        generics
    }

    fn block(&self, fused: Fused, orders: &BTreeMap<u32, usize>) -> TokenStream {
        let runtime = runtime(self.declaration);
        let (ident, scalar) = (&self.declaration.ident, self.style.scalar);
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let (_, type_generics, _) = self.declaration.generics.split_for_impl();
        let generics = self.generics(orders);
        let (impl_generics, _, where_clause) = generics.split_for_impl();
        let name = ident.to_string();
        let name = name.trim_start_matches("r#");
        let coordinates = self.problem.coordinates.iter().map(|label| &label.text);
        let constraints = self.problem.constraints.iter().map(|(label, _)| &label.text);
        let kinds = self.equations.kinds.iter().map(|kind| match kind {
            ConstraintKind::Holonomic => quote!(__lagrange::ConstraintKind::Holonomic),
            ConstraintKind::Velocity => quote!(__lagrange::ConstraintKind::Velocity),
        });
        let integrability = self.integrability();
        let observables = self.observable_names();
        let facts = self.facts();
        let functions = self.functions(fused);
        let inherent = self.observable_methods();
        let equations = self.equations();
        let Rendered { text, .. } = self.rendered;
        let doc = format!("```text\n{text}```");
        quote! {
            const _: () = {
                // One name is imported, and none that a user would give.
                use #runtime as __lagrange;

                #[automatically_derived]
                #[allow(clippy::all, unused_parens)]
                impl #impl_generics __lagrange::Lagrangian<#n, #m> for #ident #type_generics #where_clause {
                    type Scalar = #scalar;
                    const NAME: &'static str = #name;
                    const COORDINATES: [&'static str; #n] = [#(#coordinates),*];
                    const CONSTRAINTS: [&'static str; #m] = [#(#constraints),*];
                    const CONSTRAINT_KINDS: [__lagrange::ConstraintKind; #m] = [#(#kinds),*];
                    #integrability
                    const OBSERVABLES: &'static [&'static str] = &[#(#observables),*];
                    #facts
                    #functions
                }

                #[doc = #doc]
                #[automatically_derived]
                #[allow(clippy::all, unused_parens, dead_code)]
                impl #impl_generics #ident #type_generics #where_clause {
                    #equations
                    #inherent
                }
            };
        }
    }

    fn functions(&self, fused: Fused) -> TokenStream {
        let scalar = self.style.scalar;
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let equations = self.equations;
        let lagrangian = self.style.kernel(&[self.problem.lagrangian]);
        let lagrangian =
            self.function("lagrangian", &quote!(#scalar), &lagrangian, |results| quote!(#(#results)*));
        let of_coordinates = quote!(__lagrange::nalgebra::SVector<#scalar, #n>);
        let of_constraints = quote!(__lagrange::nalgebra::SVector<#scalar, #m>);
        let energy = self.style.kernel(&[equations.energy]);
        let energy = self.function("energy", &quote!(#scalar), &energy, |results| quote!(#(#results)*));
        let momentum = self.vector("momentum", &of_coordinates, &equations.momentum);
        let momentum_rate = self.vector("momentum_rate", &of_coordinates, &equations.momentum_rate);
        let forcing = self.vector("forcing", &of_coordinates, &equations.forcing);
        let residual = self.vector("constraint_residual", &of_constraints, &equations.residual);
        let rate = self.vector("constraint_rate", &of_constraints, &equations.rate);
        let bias = self.vector("constraint_bias", &of_constraints, &equations.bias);
        let mass = self.matrix(
            "mass_matrix",
            &quote!(__lagrange::nalgebra::SMatrix<#scalar, #n, #n>),
            &equations.mass,
            n,
        );
        let jacobian = self.matrix(
            "constraint_jacobian",
            &quote!(__lagrange::nalgebra::SMatrix<#scalar, #m, #n>),
            &equations.jacobian,
            n,
        );
        let force = self.constraint_force();
        let integral = self.constraint_integral();
        let accelerations = self.accelerations(&fused);
        let observable = self.observable_by_index();
        let conserved = self.conserved_by_index();
        quote! { #lagrangian #energy #momentum #momentum_rate #mass #forcing #residual #rate #jacobian #bias #integral #force #accelerations #observable #conserved }
    }

    /// One method of the state that returns what `result` makes of the kernel's results.
    fn function(
        &self,
        name: &str,
        returns: &TokenStream,
        kernel: &Kernel,
        result: impl Fn(&[TokenStream]) -> TokenStream,
    ) -> TokenStream {
        let name = format_ident!("{name}");
        let (n, scalar) = (self.problem.coordinates.len(), self.style.scalar);
        let (statements, doc, result) =
            (&kernel.statements, count_doc(kernel.count), result(&kernel.results));
        quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            fn #name(&self, state: &__lagrange::State<#scalar, #n>) -> #returns {
                #statements
                #result
            }
        }
    }

    fn vector(&self, name: &str, returns: &TokenStream, roots: &[Id]) -> TokenStream {
        self.function(
            name,
            returns,
            &self.style.kernel(roots),
            |results| quote!(__lagrange::eliminate::vector([#(#results),*])),
        )
    }

    /// nalgebra's matrices are stored by columns.
    fn matrix(&self, name: &str, returns: &TokenStream, rows: &[Vec<Id>], columns: usize) -> TokenStream {
        let roots: Vec<Id> = (0..columns).flat_map(|j| rows.iter().map(move |row| row[j])).collect();
        let kernel = self.style.kernel(&roots);
        let height = rows.len();
        self.function(name, returns, &kernel, |results| {
            let columns = (0..columns).map(|j| {
                let column = &results[j * height..(j + 1) * height];
                quote!([#(#column),*])
            });
            quote!(__lagrange::eliminate::matrix([#(#columns),*]))
        })
    }

    fn constraint_force(&self) -> TokenStream {
        let (n, m, scalar) =
            (self.problem.coordinates.len(), self.problem.constraints.len(), self.style.scalar);
        let kernel = self.style.kernel(&self.equations.constraint_force);
        let (statements, doc) = (&kernel.statements, count_doc(kernel.count));
        let results = if m == 0 {
            (0..n).map(|_| quote!(__lagrange::Scalar::constant(0.0))).collect()
        } else {
            kernel.results
        };
        quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            fn constraint_force(&self, state: &__lagrange::State<#scalar, #n>, multipliers: &__lagrange::nalgebra::SVector<#scalar, #m>) -> __lagrange::nalgebra::SVector<#scalar, #n> {
                #statements
                __lagrange::eliminate::vector([#(#results),*])
            }
        }
    }

    fn equations(&self) -> TokenStream {
        let visibility = &self.declaration.visibility;
        let Rendered { text, latex, .. } = self.rendered;
        quote! {
            /// The system and its equations of motion, to be read.
            #visibility const fn equations() -> __lagrange::Equations {
                __lagrange::Equations::new(#text, #latex)
            }
        }
    }
}

/// Of each function that the user supplies, the highest derivative that the system needs, with `more` expressions.
fn orders(problem: &Problem, equations: &Equations, more: &[Id]) -> BTreeMap<u32, usize> {
    let graph = &problem.graph;
    let mut roots = equations.roots();
    roots.push(problem.lagrangian);
    roots.extend(problem.observables.iter().flat_map(|(_, values)| values));
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

/// A function's field gives derivatives up to this order.
fn function_bound(function: &Supplied, order: usize, scalar: &syn::Type) -> syn::WherePredicate {
    let Supplied { ty, inputs, outputs, .. } = function;
    let capability = format_ident!("{}", capability(order).0);
    let bound = quote_spanned!(ty.span()=> __lagrange::function::#capability<#scalar, #inputs, #outputs>);
    syn::parse_quote!(#ty: #bound)
}

fn count_doc(count: Count) -> String {
    let Count { arithmetic, functions, calls } = count;
    let plural = |count| if count == 1 { "" } else { "s" };
    let calls = match calls {
        0 => String::new(),
        calls => format!(", {calls} result{} of supplied functions", plural(calls)),
    };
    format!(
        "{arithmetic} operation{} (+ − × ÷ √), {functions} elementary function{}{calls}.",
        plural(arithmetic),
        plural(functions)
    )
}

/// The path of the runtime crate.
fn runtime(declaration: &Declaration) -> TokenStream {
    declaration.options.runtime.clone().unwrap_or_else(|| quote!(::lagrange_core))
}

/// The struct's generics, where a scalar that is a type parameter is bound to be one.
fn bounded_generics(declaration: &Declaration, scalar: &syn::Type) -> syn::Generics {
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
