//! Emits the Jacobians: derivatives of the residual with respect to state and parameters, and access to parameters by
//! index.

use std::collections::BTreeSet;

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::bounds::FUNCTION_ORDER;
use super::emitter::{Emitter, Written};
use super::passes::Program;
use super::shape::ResultShape;
use super::signature::wide;
use super::slopes::SlopeLayout;
use crate::contract::{LINEARIZED, Method, Quantity, STATE_DERIVATIVES};
use crate::mechanics::{Changes, Linearization};
use crate::symbolic::{Graph, Id};
use crate::syntax::Property;
use crate::variables::Variable;

/// Directional derivatives of the residual, each as two programs: one computes slopes at a state, the other applies
/// them to a direction.
pub(super) struct Changing {
    /// Without the part of a tree of bodies.
    by_state: [Program; 2],
    by_parameters: [Program; 2],
    /// Derivatives of h.
    pub(super) of_forces: [Program; 2],
    /// Indices of the rates of time, coordinates and velocities with which the residual changes, and those with which h does.
    state_arguments: BTreeSet<usize>,
    pub(super) force_arguments: BTreeSet<usize>,
}

impl Changing {
    pub(super) fn new(graph: &Graph, linearization: &Linearization, forcing: &[Id]) -> Self {
        let Linearization { by_state, by_parameters, residual, split, forces } = linearization;
        let programs =
            |changes: &Changes, residual: &[Id]| Program::of_changes(graph, &changes.roots(), residual);
        let change = |symbol| match Variable::of(symbol) {
            Variable::Change(index) => Some(index),
            _ => None,
        };
        let arguments = |roots: &[Id]| graph.symbols(roots).filter_map(change).collect();
        let (state_arguments, force_arguments) = (arguments(&by_state.roots()), arguments(forces));
        let of_forces = Program::of_changes(graph, forces, forcing);
        let by_state = match split {
            Some(split) => programs(&split.by_state, &split.residual),
            None => programs(by_state, residual),
        };
        Self {
            by_state,
            by_parameters: programs(by_parameters, residual),
            of_forces,
            state_arguments,
            force_arguments,
        }
    }

    /// Number of slopes without gradients: the larger of the numbers for states and for parameters.
    pub(super) fn slopes(&self) -> usize {
        [&self.by_state, &self.by_parameters, &self.of_forces]
            .into_iter()
            .map(|[slopes, _]| slopes.results.len())
            .max()
            .unwrap_or(0)
    }
}

impl Emitter<'_> {
    /// Emits `StateDerivatives` and `Linearized`. `None` if a function is too long, or if the derivatives exceed the
    /// order that user-supplied functions have.
    pub(super) fn linearized(
        &self,
        linearization: &Linearization,
        changing: &Changing,
    ) -> Option<TokenStream> {
        let orders = self.orders(&linearization.roots());
        orders.values().all(|&order| order <= FUNCTION_ORDER).then_some(())?;
        let tree = linearization.split.as_ref().map(|split| &split.tree);
        let write = |method: &Method| match method.quantity {
            Quantity::Parameters => self.parameters(method),
            Quantity::SetParameter => self.set_parameter(method),
            Quantity::Slopes => match tree {
                Some(tree) => self.slopes_with_bodies(method, &changing.by_state[0], tree),
                None => self.slopes(method, &changing.by_state[0]),
            },
            Quantity::ParameterSlopes => self.slopes(method, &changing.by_parameters[0]),
            Quantity::ResidualChange => match tree {
                Some(_) => self.residual_change_with_bodies(method, &changing.by_state),
                None => self.residual_change(method, &changing.by_state, None),
            },
            _ => self.residual_change(method, &changing.by_parameters, None),
        };
        let Written { tokens: of_state, mut kernels } = STATE_DERIVATIVES.iter().map(write).collect();
        let Written { tokens: methods, kernels: of_parameters } = LINEARIZED.iter().map(write).collect();
        kernels.extend(of_parameters);
        kernels.iter().all(|kernel| kernel.refused.is_none()).then_some(())?;
        // Defer the bounds on user-supplied functions: a missing derivative is an error only where a Jacobian is
        // used.
        let generics = self.generics(&orders, false);
        let p = self.style.types.parameters;
        let arguments = changing.state_arguments.iter().copied();
        let scalar = self.style.types.scalar;
        let [of_state_slopes, of_parameter_slopes] = [&changing.by_state, &changing.by_parameters]
            .map(|[slopes, _]| SlopeLayout::of(self.problem, slopes).length);
        let slopes = quote!([#scalar; #of_state_slopes]);
        let slopes = match tree {
            Some(_) => quote!((#slopes, __lagrange::generated::MotionGradients<#scalar, Self::N>)),
            None => slopes,
        };
        let by_field = self.problem.parameters.by_field();
        let names = by_field.iter().map(|&k| self.problem.parameters.name(k));
        let of_state = quote! {
            type Slopes = #slopes;
            const STATE_ARGUMENTS: ::core::option::Option<&'static [usize]> = ::core::option::Option::Some(&[#(#arguments),*]);
            #of_state
        };
        let of_parameters = quote! {
            type P = __lagrange::nalgebra::Const<#p>;
            type ParameterSlopes = [#scalar; #of_parameter_slopes];
            const PARAMETERS: &'static [&'static str] = &[#(#names),*];
            #methods
        };
        let mut items = self.implementation(&quote!(StateDerivatives), &generics, &of_state);
        items.extend(self.implementation(&quote!(Linearized), &generics, &of_parameters));
        Some(self.in_scope(kernels.iter(), &generics, &items))
    }

    fn parameters(&self, method: &Method) -> Written {
        let signature = self.style.types.signature(method);
        let values = self.problem.parameters.by_field().into_iter().map(|k| self.style.parameter(k));
        let tokens = quote! {
            #signature {
                __lagrange::generated::vector([#(#values),*])
            }
        };
        Written { tokens, kernels: Vec::new() }
    }

    /// Emits the method that sets a parameter. It fails for numbers behind a reference, numbers in a type whose shape
    /// only `#[parameter(…)]` states, and entries of a rotation.
    fn set_parameter(&self, method: &Method) -> Written {
        let signature = self.style.types.signature(method);
        let parameters = &self.problem.parameters;
        let is_settable = |&(_, k): &(usize, usize)| parameters.is_settable(parameters.entries[k]);
        let arms = parameters.by_field().into_iter().enumerate().filter(is_settable).map(|(index, k)| {
            let entry = parameters.entries[k];
            let (set, mirrored) =
                (|entry| self.style.set_number(entry, &quote!(value)), parameters.mirrored(entry));
            let both = parameters.property(entry.field) == Some(Property::Symmetric) && mirrored != entry;
            let sets = [Some(entry), both.then_some(mirrored)].into_iter().flatten().map(set);
            quote!(#index => { #(#sets)* })
        });
        let tokens = quote! {
            #[allow(unused_variables, unreachable_code)]
            #signature {
                match index {
                    #(#arms)*
                    _ => return false,
                }
                true
            }
        };
        Written { tokens, kernels: Vec::new() }
    }

    /// Emits the method that computes the slopes, the coefficients of a linear function.
    pub(super) fn slopes(&self, method: &Method, slopes: &Program) -> Written {
        let kernel = self.style.write(method.name, slopes, &[ResultShape::Vector(slopes.results.len())]);
        let (statements, doc) = (&kernel.statements, &kernel.doc);
        let results = self.style.slopes(slopes, &kernel.results);
        let signature = self.style.types.signature(method);
        let tokens = quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            #signature {
                let (accelerations, multipliers) = (&solution.accelerations, &solution.multipliers);
                #statements
                #results
            }
        };
        Written { tokens, kernels: vec![kernel] }
    }

    /// Emits the method that applies the slopes, prepared by these statements, to a direction.
    pub(super) fn residual_change(
        &self,
        method: &Method,
        [slopes, changes]: &[Program; 2],
        prepared: Option<TokenStream>,
    ) -> Written {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let wide = wide();
        let style = self.style.over(&wide, SlopeLayout::of(self.problem, slopes));
        let kernel = style.write(method.name, changes, &[n, m, m, m].map(ResultShape::Vector));
        let names = ["motion", "acceleration", "rate", "position"].map(|name| format_ident!("{name}"));
        let (statements, results, doc) = (&kernel.statements, &kernel.results, &kernel.doc);
        let signature = self.style.types.signature(method);
        let tokens = quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            #signature {
                #prepared
                #statements
                __lagrange::ResidualChange { #(#names: __lagrange::generated::vector(#results)),* }
            }
        };
        Written { tokens, kernels: vec![kernel] }
    }
}
