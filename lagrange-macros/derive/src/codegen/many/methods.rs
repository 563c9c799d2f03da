//! Methods of the traits, and of the struct.

use proc_macro2::TokenStream;
use quote::quote;

use super::ManyEmitter;
use crate::codegen::observables::method_name;
use crate::mechanics::Symmetry;
use crate::resolve::Observed;
use crate::symbolic::Id;

impl ManyEmitter<'_> {
    pub(super) fn system(&self) -> TokenStream {
        let scalar = self.style.types.scalar;
        let (lengths, count) = (self.style.lengths(), self.style.count_of_all());
        let accelerations = match (&self.equations.recursion, self.equations.constraints.is_empty()) {
            (Some(recursion), _) => self.eliminated(recursion),
            (None, true) => self.free_accelerations(),
            (None, false) => {
                quote!(__lagrange::generated::write_constrained_accelerations(self, t, [q, v], a))
            }
        };
        quote! {
            type Scalar = #scalar;
            type Length = __lagrange::nalgebra::Dyn;
            type M = __lagrange::nalgebra::Const<0>;
            type Field = __lagrange::motion::ManyBodyField;

            fn length(&self) -> __lagrange::nalgebra::Dyn {
                #lengths
                __lagrange::nalgebra::Dyn(#count)
            }

            fn accelerations(&self, t: #scalar, q: &[#scalar], v: &[#scalar], a: &mut [#scalar]) {
                #accelerations
            }
        }
    }

    /// Statements that write the accelerations without constraints to `a`.
    fn free_accelerations(&self) -> TokenStream {
        let lengths = self.style.lengths();
        let forces = self.scatters(&self.equations.forcing);
        let solved = self.equations.inertia.iter().map(|block| self.solve(block));
        quote! {
            #lengths
            let cells = ::core::cell::Cell::from_mut(a).as_slice_of_cells();
            #forces
            #(#solved)*
        }
    }

    pub(super) fn many_bodies(&self) -> TokenStream {
        let (scalar, digest) = (self.style.types.scalar, self.declaration.digest);
        let state = quote!(&__lagrange::generic::State<#scalar, __lagrange::nalgebra::Dyn>);
        let (lengths, count) = (self.style.lengths(), self.style.count_of_all());
        let lagrangian = self.at_state(&self.number(self.problem.lagrangian));
        let energy = self.energy();
        let (momenta, of_recursion) = (self.scatters(&self.equations.momentum), self.momenta_of_recursion());
        let (write_name, check, visit) = (self.write_name(), self.check(), self.visit_numbers());
        let zero = self.style.constant(0.0);
        let momenta = self.at_state(&quote! {
            let mut p = __lagrange::nalgebra::DVector::from_element(q.len(), #zero);
            let cells = ::core::cell::Cell::from_mut(p.as_mut_slice()).as_slice_of_cells();
            #momenta
            #of_recursion
            p.resize_vertically(#count, #zero)
        });
        let is_conserved = self.equations.energy_is_conserved;
        let has_constraints = !self.equations.constraints.is_empty();
        let constrained = self.constrained(&self.free_accelerations());
        quote! {
            const ENERGY_IS_CONSERVED: bool = #is_conserved;
            const HAS_CONSTRAINTS: bool = #has_constraints;
            const DIGEST: u32 = #digest;

            #write_name
            #check
            #visit
            #constrained

            fn lagrangian(&self, state: #state) -> #scalar {
                #lengths
                #lagrangian
            }

            fn energy(&self, state: #state) -> #scalar {
                #lengths
                #energy
            }

            fn momenta(&self, state: #state) -> __lagrange::nalgebra::DVector<#scalar> {
                #lengths
                #momenta
            }
        }
    }

    /// The energy of a state. Recursions may depend on the time, so that p·q̇ is not what the velocities of all arrays give.
    fn energy(&self) -> TokenStream {
        match self.equations.recursion {
            Some(_) => {
                let zero = self.style.constant(0.0);
                quote! {
                    let momenta = __lagrange::ManyBodies::momenta(self, state);
                    let product = momenta.iter().zip(&state.v).fold(#zero, |sum, (p, v)| sum + *p * *v);
                    product - __lagrange::ManyBodies::lagrangian(self, state)
                }
            }
            None => self.at_state(&self.number(self.equations.energy)),
        }
    }

    fn number(&self, root: Id) -> TokenStream {
        let (statements, results) = self.values(&[root]);
        quote! { #statements #(#results)* }
    }

    /// A method for each observable and for each vector that is conserved.
    pub(super) fn inherent(&self) -> TokenStream {
        let visibility = &self.declaration.visibility;
        let observables = self.problem.observables.iter().map(|Observed { label, lengths, values }| {
            let doc = format!("The observable `{}`.", label.text);
            let name = method_name(&label.text, label.place.start());
            self.method(&doc, &quote!(#visibility fn #name), lengths, values)
        });
        let names: Vec<&str> =
            self.problem.observables.iter().map(|known| known.label.text.as_str()).collect();
        let conserved = self.equations.conserved.iter().filter_map(|conserved| {
            let (name, doc) = match conserved.symmetry {
                Symmetry::Translation => {
                    ("total_momentum", "Σ p of all elements, which the motion conserves.")
                }
                Symmetry::Rotation => {
                    ("total_angular_momentum", "Σ r × p of all elements, which the motion conserves.")
                }
            };
            let ident = quote::format_ident!("{name}");
            let lengths = match conserved.values.len() {
                1 => vec![],
                length => vec![length],
            };
            let method = self.method(doc, &quote!(#visibility fn #ident), &lengths, &conserved.values);
            (!names.contains(&name)).then_some(method)
        });
        quote! { #(#observables)* #(#conserved)* }
    }

    fn method(&self, doc: &str, name: &TokenStream, lengths: &[usize], values: &[Id]) -> TokenStream {
        let (scalar, starts) = (self.style.types.scalar, self.style.lengths());
        let (statements, results) = self.values(values);
        let (returns, result) = match lengths {
            [] => (quote!(#scalar), quote!(#(#results)*)),
            [length] => (
                quote!(__lagrange::nalgebra::SVector<#scalar, #length>),
                quote!(__lagrange::generated::vector([#(#results),*])),
            ),
            [rows, ..] => {
                let columns = values.len() / rows;
                let column = |j: usize| {
                    let entries = results.iter().skip(j).step_by(columns);
                    quote!([#(#entries),*])
                };
                let all = (0..columns).map(column);
                (
                    quote!(__lagrange::nalgebra::SMatrix<#scalar, #rows, #columns>),
                    quote!(__lagrange::generated::matrix([#(#all),*])),
                )
            }
        };
        let body = self.at_state(&quote! { #statements #result });
        quote! {
            #[doc = #doc]
            #name(&self, state: &__lagrange::generic::State<#scalar, __lagrange::nalgebra::Dyn>) -> #returns {
                #starts
                #body
            }
        }
    }
}
