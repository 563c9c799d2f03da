//! Emits the implementation of `Lagrangian`, and the inherent methods of the struct.

use proc_macro2::TokenStream;
use quote::quote;

use super::emitter::{Emitter, Written, too_long};
use super::kernel::Kernel;
use super::markers::markers;
use super::moving::moving;
use super::observables::OBSERVABLE;
use super::pack;
use super::shape::ResultShape;
use crate::contract::{CANCELLING, COMPLETED, Gives, LAGRANGIAN, Method, Quantity, SWITCHED};
use crate::diagnostics::Diagnostics;
use crate::mechanics::{Completed, ConstraintKind};
use crate::render::Forms;
use crate::symbolic::Id;
use crate::variables::Variable;

impl Emitter<'_> {
    /// Emits the implementation. Reports functions that are too long.
    pub(super) fn lagrangian(&self, diagnostics: &mut Diagnostics) -> TokenStream {
        let problem = self.problem;
        let (ident, scalar, [n, m]) = (
            &self.declaration.ident,
            self.style.types.scalar,
            [problem.coordinates.len(), problem.constraints.len()],
        );
        let switched = self.derived.equations.switched.as_ref();
        let emitted = &self.style.factor;
        let factor =
            switched.map_or(quote!(#emitted), |_| quote!(__lagrange::generated::SwitchedFactorOf<Self>));
        let (_, type_generics, _) = self.declaration.generics.split_for_impl();
        let generics = self.generics(&self.orders(&[]), true);
        let (impl_generics, _, where_clause) = generics.split_for_impl();
        let name = ident.to_string();
        let name = name.trim_start_matches("r#");
        let coordinates = problem.coordinates.iter().map(|label| &label.text);
        let constraints = problem.constraints.iter().map(|(label, _)| &label.text);
        let kinds = self.derived.equations.kinds.iter().map(|kind| match kind {
            ConstraintKind::Holonomic => quote!(__lagrange::ConstraintKind::Holonomic),
            ConstraintKind::Velocity => quote!(__lagrange::ConstraintKind::Velocity),
        });
        let digest = self.declaration.digest;
        let supplied = self.supplied();
        let are_linear = self.derived.equations.momenta_are_linear;
        let (integrability, facts) = (self.integrability(), self.facts());
        let observables = self.observable_names();
        let completed = self.derived.equations.completed.iter().flat_map(|_| &COMPLETED);
        let compliance = SWITCHED.iter().filter(|_| switched.is_some());
        let may_cancel =
            self.derived.equations.jacobian_round_off.iter().flatten().any(|&bound| bound != Id::ZERO);
        let cancelling = CANCELLING.iter().filter(|_| may_cancel);
        let methods = LAGRANGIAN.iter().chain(completed).chain(compliance).chain(cancelling);
        let methods: Written = methods.map(|method| self.method(method)).collect();
        let inherent: Written =
            problem.observables.iter().map(|observable| self.observable(observable)).collect();
        let contacts = self.contacts();
        let switched = switched.map(|switched| self.switched(switched));
        let others = contacts.iter().chain(&switched).flat_map(|written| &written.kernels);
        let kernels = || methods.kernels.iter().chain(&inherent.kernels).chain(others.clone());
        self.report_refused(kernels(), diagnostics);
        let (methods, inherent) = (&methods.tokens, &inherent.tokens);
        let (equations, visit_parameters, visit_defects) = (
            equations(&self.declaration.visibility, &self.rendered.forms),
            self.visit_parameters(),
            self.visit_defects(),
        );
        let (pack, check_members) = (pack::pack(self.declaration, scalar), self.check_members());
        let markers = markers(self.declaration, &generics, &self.derived.markers);
        let [[_, _, doc], ..] = &self.rendered.forms;
        let (quaternions, depends_on_time) = (self.quaternions(), self.depends_on_time());
        let (slides, planar_friction) = (self.slides(), self.planar_friction());
        let has_contacts = contacts.iter().map(|_| {
            quote!(
                const HAS_CONTACTS: bool = true;
            )
        });
        let name_of_contacts = quote!(contact::Contacts);
        let contacts = contacts
            .iter()
            .map(|Written { tokens, .. }| self.implementation(&name_of_contacts, &generics, tokens));
        let name_of_switched = quote!(generated::Switched);
        let switched = switched
            .iter()
            .map(|Written { tokens, .. }| self.implementation(&name_of_switched, &generics, tokens));
        let moving = self.implementation(&quote!(System), &generics, &moving(scalar, m));
        let items = quote! {
            type Factor = #factor;
            type N = __lagrange::nalgebra::Const<#n>;
            const NAME: &'static str = #name;
            const COORDINATES: &'static [&'static str] = &[#(#coordinates),*];
            const CONSTRAINTS: &'static [&'static str] = &[#(#constraints),*];
            const CONSTRAINT_KINDS: &'static [__lagrange::ConstraintKind] = &[#(#kinds),*];
            #integrability
            const MOMENTA_ARE_LINEAR: bool = #are_linear;
            const OBSERVABLES: &'static [&'static str] = &[#(#observables),*];
            const DIGEST: u32 = #digest;
            #quaternions
            #depends_on_time
            #supplied
            #facts
            #(#has_contacts)*
            const EQUATIONS: __lagrange::facts::Equations = Self::equations();
            #methods
            #visit_parameters
            #visit_defects
            #slides
            #planar_friction
        };
        let lagrangian = self.implementation(&quote!(Lagrangian), &generics, &items);
        let items = quote! {
            #moving
            #lagrangian

            #[doc = #doc]
            #[automatically_derived]
            #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens, dead_code, non_snake_case)]
            impl #impl_generics #ident #type_generics #where_clause {
                #equations
                #inherent
            }

            #(#contacts)*
            #(#switched)*
            #markers
            #pack
            #check_members
        };
        self.in_scope(kernels(), &generics, &items)
    }

    fn method(&self, method: &Method) -> Written {
        let (problem, equations) = (self.problem, &self.derived.equations);
        let columns = |rows: &[Vec<Id>]| -> Vec<Id> {
            (0..problem.coordinates.len()).flat_map(|j| rows.iter().map(move |row| row[j])).collect()
        };
        let completed =
            |of: &dyn Fn(&Completed) -> Vec<Id>| equations.completed.iter().flat_map(of).collect();
        let entries: Vec<Id> = match method.quantity {
            Quantity::Lagrangian => vec![problem.lagrangian],
            Quantity::Energy => vec![equations.energy],
            Quantity::EnergyRate => vec![self.derived.facts.energy_rate],
            Quantity::Momentum => equations.momentum.clone(),
            Quantity::MomentumRate => equations.momentum_rate.clone(),
            Quantity::MassMatrix => columns(&equations.mass),
            Quantity::CompletedMomentum => completed(&|found| found.momentum.clone()),
            Quantity::CompletedMomentumRate => completed(&|found| found.rate.clone()),
            Quantity::CompletedMassMatrix => completed(&|found| columns(&found.mass)),
            Quantity::Compliance => equations.compliance.clone(),
            Quantity::Forcing => equations.forcing.clone(),
            Quantity::Residual => equations.residual.clone(),
            Quantity::Rate => equations.rate.clone(),
            Quantity::ResidualMagnitude => equations.magnitudes[0].clone(),
            Quantity::RateMagnitude => equations.magnitudes[1].clone(),
            Quantity::Jacobian => columns(&equations.linear.jacobian),
            Quantity::JacobianRoundOff => columns(&equations.jacobian_round_off),
            Quantity::Bias => equations.linear.bias.clone(),
            Quantity::ConstraintForce => {
                let force = |i| equations.constraint_force.get(i).copied().unwrap_or(Id::ZERO);
                (0..problem.coordinates.len()).map(force).collect()
            }
            Quantity::InverseDynamics => equations.balance.clone(),
            Quantity::Integral => return self.constraint_integral(method),
            Quantity::Accelerations => return self.accelerations(method),
            Quantity::Factor => return self.factor(method),
            Quantity::Solve => return self.solve_with(method),
            Quantity::Observable => return self.observable_by_index(method),
            Quantity::Conserved => return self.conserved_by_index(method),
            Quantity::Parameters
            | Quantity::Law
            | Quantity::SetParameter
            | Quantity::Slopes
            | Quantity::ResidualChange
            | Quantity::ParameterSlopes
            | Quantity::ResidualChangeByParameters
            | Quantity::SeriesSlopes
            | Quantity::SeriesRightHandSides
            | Quantity::SeriesFactors => Vec::new(),
        };
        // nalgebra stores matrices column-major, one column per coordinate.
        let (shape, wrapped) = match method.gives {
            Gives::Vector(_) => (ResultShape::Vector(entries.len()), Some(quote!(vector))),
            Gives::Matrix(..) => {
                let n = problem.coordinates.len();
                (ResultShape::Matrix(n, entries.len() / n), Some(quote!(matrix)))
            }
            _ => (ResultShape::Number, None),
        };
        let kernel = self.style.kernel(method.name, &entries, &[shape]);
        self.function(method, kernel, |results| match &wrapped {
            Some(wrapped) => quote!(#(__lagrange::generated::#wrapped(#results))*),
            None => quote!(#(#results)*),
        })
    }

    /// Emits the method that returns `result` of the kernel's results.
    pub(super) fn function(
        &self,
        method: &Method,
        kernel: Kernel,
        result: impl Fn(&[TokenStream]) -> TokenStream,
    ) -> Written {
        self.function_after(&TokenStream::new(), method, kernel, result)
    }

    /// Emits a method that computes its result by a kernel, unless these statements return another.
    pub(super) fn function_after(
        &self,
        before: &TokenStream,
        method: &Method,
        kernel: Kernel,
        result: impl Fn(&[TokenStream]) -> TokenStream,
    ) -> Written {
        let signature = self.style.types.signature(method);
        let (statements, doc, result) = (&kernel.statements, &kernel.doc, result(&kernel.results));
        let tokens = quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            #signature {
                #before
                #statements
                #result
            }
        };
        Written { tokens, kernels: vec![kernel] }
    }

    /// Emits a method that selects a number by its index, from the arms of a `match`.
    pub(super) fn by_index(&self, method: &Method, Written { tokens: arms, kernels }: Written) -> Written {
        let signature = self.style.types.signature(method);
        let tokens = quote! {
            #[allow(unused_variables)]
            #signature {
                match index {
                    #arms
                    _ => ::core::option::Option::None,
                }
            }
        };
        Written { tokens, kernels }
    }

    /// Reports each observable that is too long, and all other long functions in one error.
    fn report_refused<'k>(&self, kernels: impl Iterator<Item = &'k Kernel>, diagnostics: &mut Diagnostics) {
        let mut of_motion = Vec::new();
        for kernel in kernels {
            let Some(count) = kernel.refused else { continue };
            let observable = kernel.name.strip_prefix(OBSERVABLE);
            let takes = format!("`{}` takes {count}", observable.unwrap_or(&kernel.name));
            let observables = &self.problem.observables;
            match observables.iter().find(|observed| Some(observed.label.text.as_str()) == observable) {
                Some(observed) => diagnostics.error(observed.label.place, too_long(self.declaration, &takes)),
                None => of_motion.push(takes),
            }
        }
        if !of_motion.is_empty() {
            diagnostics.error(self.problem.place, too_long(self.declaration, &of_motion.join("; ")));
        }
    }

    /// Emits the names of user-supplied functions. `None` if there are none.
    fn supplied(&self) -> Option<TokenStream> {
        let names = self.problem.functions.iter().map(|function| &function.name);
        (names.len() > 0).then(|| quote!(const SUPPLIED: &'static [&'static str] = &[#(#names),*];))
    }

    /// Emits where the quaternions are that turn frames. `None` if there are none.
    fn quaternions(&self) -> Option<TokenStream> {
        let first = &self.problem.quaternions;
        (!first.is_empty()).then(|| quote!(const QUATERNIONS: &'static [usize] = &[#(#first),*];))
    }

    /// Emits that the time occurs in the equations of motion, whatever the values of parameters. `None` if it does not.
    fn depends_on_time(&self) -> Option<TokenStream> {
        let problem = self.problem;
        let mut roots = vec![problem.lagrangian];
        roots.extend(&problem.forces);
        roots.extend(problem.powers.iter().flat_map(|(force, velocity)| [force, velocity]));
        roots.extend(problem.dissipation.iter().map(|(function, _)| function));
        roots.extend(problem.constraints.iter().map(|(_, residual)| residual));
        let occurs = self.style.graph.symbols(&roots).any(|symbol| Variable::of(symbol) == Variable::Time);
        occurs.then(|| {
            quote!(
                const DEPENDS_ON_TIME: bool = true;
            )
        })
    }

    fn visit_parameters(&self) -> TokenStream {
        let scalar = self.style.types.scalar;
        let order = self.problem.parameters.by_field();
        let names = order.iter().map(|&k| self.problem.parameters.name(k));
        let values = order.iter().map(|&k| self.style.parameter(k));
        quote! {
            #[allow(unused_variables)]
            fn visit_parameters(&self, visit: &mut dyn ::core::ops::FnMut(&'static str, #scalar)) {
                #(visit(#names, #values);)*
            }
        }
    }
}

/// Emits the method that returns the equations in readable form.
pub(super) fn equations(visibility: &syn::Visibility, forms: &Forms) -> TokenStream {
    let [[text, ..], ..] = forms;
    // Use plain text: editors and terminals show doc comments without rendering.
    let doc = format!(" The system and its equations of motion, to be read.\n\n```text\n{text}```");
    let [first, others @ ..] = forms;
    let forms = match others.iter().all(|form| form == first) {
        true => quote!([[#(#first),*]; 3]),
        false => {
            let forms = forms.iter().map(|form| quote!([#(#form),*]));
            quote!([#(#forms),*])
        }
    };
    quote! {
        #[doc = #doc]
        #visibility const fn equations() -> __lagrange::facts::Equations {
            __lagrange::generated::equations(#forms)
        }
    }
}
