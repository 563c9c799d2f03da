//! From [`Equations`] to Rust. Nothing else writes any.

mod accelerations;
mod body;
mod count;
mod eliminate;
mod facts;
mod integrability;
#[cfg(test)]
mod interpret;
mod kernel;
mod linearized;
mod observables;
mod operation;
mod pack;
mod passes;
mod schedule;
mod shape;
mod stub;
mod style;
mod time;
mod writer;

use std::collections::BTreeMap;

use proc_macro2::TokenStream;
use quote::{format_ident, quote, quote_spanned};
use syn::GenericParam;
use syn::spanned::Spanned;

use crate::diagnostics::Diagnostics;
use crate::mechanics::{ConstraintKind, Derived, Equations, Facts};
use crate::render::Rendered;
use crate::resolve::{Problem, Supplied};
use crate::symbolic::{Graph, Id, Node};
use crate::syntax::Declaration;
#[cfg(test)]
pub(crate) use count::Count;
use kernel::{Kernel, OPERATION_LIMIT, Refused};
use linearized::linearized;
use observables::method_name;
use shape::Shape;
pub(crate) use stub::stub;
use style::Style;

/// How often a function that the user supplies can be differentiated.
const FUNCTION_ORDER: usize = 3;

/// The implementation of the traits, and a method for each observable; `None` where a function would be too long,
/// which is then reported.
pub(crate) fn implementation(
    declaration: &Declaration,
    graph: &Graph,
    problem: &Problem,
    derived: &Derived,
    rendered: &Rendered,
    diagnostics: &mut Diagnostics,
) -> Option<TokenStream> {
    let Derived { equations, facts, .. } = derived;
    let style = Style::new(graph, problem);
    let emitter = Emitter { declaration, problem, equations, facts, rendered, style: &style };
    let orders = orders(graph, problem, equations, &[]);
    for (&function, order) in orders.iter().filter(|(_, order)| **order > FUNCTION_ORDER) {
        let Supplied { name, place, .. } = &problem.functions[function as usize];
        diagnostics.error(*place, format!(
            "the equations need the {order}th derivatives of `{name}`, and functions are differentiated {FUNCTION_ORDER} times at most"
        ));
    }
    let mut tokens = emitter.block(&orders);
    emitter.report_refused(diagnostics);
    diagnostics.is_empty().then_some(())?;
    if let Some(linearization) = &derived.linearization {
        tokens.extend(linearized(declaration, graph, problem, equations, linearization));
    }
    Some(tokens)
}

/// Reports a Lagrangian that is too long for any function, before it is differentiated.
pub(crate) fn refuse_hopeless(graph: &Graph, problem: &Problem, diagnostics: &mut Diagnostics) -> Option<()> {
    let Some(count) = passes::hopeless(graph, problem.lagrangian) else { return Some(()) };
    diagnostics.error(problem.place, too_long(&format!("the Lagrangian takes {count}")));
    None
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
pub(crate) fn operations(graph: &Graph, roots: &[Id]) -> Count {
    passes::Program::of(graph, roots).count()
}

/// What the accelerations take, before the passes and after each, solved by each form of the equations; `None` where
/// that is left to loops.
#[cfg(test)]
pub(crate) fn solving(graph: &Graph, equations: &Equations) -> Vec<Option<Vec<(&'static str, Count)>>> {
    let counts = |form| Some(accelerations::solve(graph, form, equations)?.counts);
    equations.forms.iter().map(counts).collect()
}

/// Accelerations, multipliers and pivot by each form of the equations.
#[cfg(test)]
pub(crate) fn solutions(
    graph: &Graph,
    equations: &Equations,
    input: impl Fn(crate::symbolic::Symbol) -> f64,
) -> Vec<Option<Vec<f64>>> {
    let values = |form| {
        let program = accelerations::solve(graph, form, equations)?.fused();
        Some(
            body::Body::new(&program, &Default::default())
                .values(program.results.len(), &input, |_, _| f64::NAN),
        )
    };
    equations.forms.iter().map(values).collect()
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

    fn block(&self, orders: &BTreeMap<u32, usize>) -> TokenStream {
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
        let functions = self.functions();
        let inherent = self.observable_methods();
        // All kernels are written by now.
        let parts = self.style.parts.borrow();
        let equations = self.equations();
        let pack = pack::pack(self.declaration, scalar);
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
                    #(#parts)*
                }

                #pack
            };
        }
    }

    fn functions(&self) -> TokenStream {
        let scalar = self.style.scalar;
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let equations = self.equations;
        let lagrangian = self.number("lagrangian", self.problem.lagrangian);
        let energy = self.number("energy", equations.energy);
        let of_coordinates = quote!(__lagrange::nalgebra::SVector<#scalar, #n>);
        let of_constraints = quote!(__lagrange::nalgebra::SVector<#scalar, #m>);
        let momentum = self.vector("momentum", &of_coordinates, &equations.momentum);
        let momentum_rate = self.vector("momentum_rate", &of_coordinates, &equations.momentum_rate);
        let forcing = self.vector("forcing", &of_coordinates, &equations.forcing);
        let residual = self.vector("constraint_residual", &of_constraints, &equations.residual);
        let rate = self.vector("constraint_rate", &of_constraints, &equations.rate);
        let bias = self.vector("constraint_bias", &of_constraints, &equations.bias);
        let mass = self.matrix("mass_matrix", &equations.mass);
        let jacobian = self.matrix("constraint_jacobian", &equations.jacobian);
        let force = self.constraint_force();
        let integral = self.constraint_integral();
        let accelerations = self.accelerations();
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
        let (statements, doc, result) = (&kernel.statements, &kernel.doc, result(&kernel.results));
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

    fn number(&self, name: &str, root: Id) -> TokenStream {
        let kernel = self.style.kernel(name, &[root], &[Shape::Number]);
        let scalar = self.style.scalar;
        self.function(name, &quote!(#scalar), &kernel, |results| quote!(#(#results)*))
    }

    fn vector(&self, name: &str, returns: &TokenStream, roots: &[Id]) -> TokenStream {
        let kernel = self.style.kernel(name, roots, &[Shape::Vector(roots.len())]);
        self.function(name, returns, &kernel, |results| quote!(#(__lagrange::generated::vector(#results))*))
    }

    /// nalgebra's matrices are stored by columns, of which there is one a coordinate.
    fn matrix(&self, name: &str, rows: &[Vec<Id>]) -> TokenStream {
        let (n, scalar) = (self.problem.coordinates.len(), self.style.scalar);
        let roots: Vec<Id> = (0..n).flat_map(|j| rows.iter().map(move |row| row[j])).collect();
        let height = rows.len();
        let kernel = self.style.kernel(name, &roots, &[Shape::Matrix(n, height)]);
        let returns = quote!(__lagrange::nalgebra::SMatrix<#scalar, #height, #n>);
        self.function(name, &returns, &kernel, |results| quote!(#(__lagrange::generated::matrix(#results))*))
    }

    fn constraint_force(&self) -> TokenStream {
        let (n, m, scalar) =
            (self.problem.coordinates.len(), self.problem.constraints.len(), self.style.scalar);
        let force = &self.equations.constraint_force;
        let roots: Vec<Id> = (0..n).map(|i| force.get(i).copied().unwrap_or(Id::ZERO)).collect();
        let Kernel { statements, results, doc } =
            self.style.kernel("constraint_force", &roots, &[Shape::Vector(n)]);
        quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            fn constraint_force(&self, state: &__lagrange::State<#scalar, #n>, multipliers: &__lagrange::nalgebra::SVector<#scalar, #m>) -> __lagrange::nalgebra::SVector<#scalar, #n> {
                #statements
                #(__lagrange::generated::vector(#results))*
            }
        }
    }

    /// An error for each observable that is too long, and one for all other functions.
    fn report_refused(&self, diagnostics: &mut Diagnostics) {
        let mut of_motion = Vec::new();
        for Refused { name, count } in self.style.refused.borrow().iter() {
            let takes = format!("`{name}` takes {count}");
            match self.problem.observables.iter().find(|(label, _)| label.text == *name) {
                Some((label, _)) => diagnostics.error(label.place, too_long(&takes)),
                None => of_motion.push(takes),
            }
        }
        if !of_motion.is_empty() {
            diagnostics.error(self.problem.place, too_long(&of_motion.join("; ")));
        }
    }

    fn equations(&self) -> TokenStream {
        let visibility = &self.declaration.visibility;
        let Rendered { text, latex, .. } = self.rendered;
        quote! {
            /// The system and its equations of motion, to be read.
            #visibility const fn equations() -> __lagrange::Equations {
                __lagrange::generated::equations(#text, #latex)
            }
        }
    }
}

/// Of each function that the user supplies, the highest derivative that the system needs, with `more` expressions.
fn orders(graph: &Graph, problem: &Problem, equations: &Equations, more: &[Id]) -> BTreeMap<u32, usize> {
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

fn too_long(what: &str) -> String {
    format!(
        "{what}: more than the {OPERATION_LIMIT} that one function may have. Name what recurs with `#[define(…)]`, recursively along chains, so that it is shared, or take coordinates with constraints between them"
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
