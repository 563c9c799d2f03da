//! The one function that integrators call: accelerations and multipliers.

use proc_macro2::TokenStream;
use quote::quote;

use super::Emitter;
use super::eliminate::{Solved, eliminate};
use super::kernel::Kernel;
use super::schedule::{Register, Schedule};
use crate::mechanics::Equations;
use crate::symbolic::Id;

/// M, h, F and γ in one schedule, so that they share what they have in common, and solved where that is short.
pub(super) struct Fused {
    pub(super) kernel: Kernel,
    is_solved: bool,
}

/// M, h, F, γ, matrices row by row.
pub(super) fn kkt_entries(equations: &Equations) -> Vec<Id> {
    let mut roots: Vec<Id> = equations.mass.concat();
    roots.extend(&equations.forcing);
    roots.extend(equations.jacobian.concat());
    roots.extend(&equations.bias);
    roots
}

impl Emitter<'_> {
    pub(super) fn fused(&self) -> Fused {
        let roots = kkt_entries(self.equations);
        let schedule = Schedule::new(&self.problem.graph, &roots);
        let mut solving = schedule.clone();
        if let Some(Solved { accelerations, multipliers, pivot }) = eliminate(&mut solving, self.equations) {
            let results = [accelerations, multipliers, vec![pivot]].concat();
            return Fused { kernel: self.style.write(&solving, &results), is_solved: true };
        }
        let results: Vec<Register> = roots.iter().map(|&root| schedule.register(root)).collect();
        Fused { kernel: self.style.write(&schedule, &results), is_solved: false }
    }

    pub(super) fn accelerations(&self, fused: &Fused) -> TokenStream {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let scalar = self.style.scalar;
        let returns = quote!(__lagrange::Solution<#scalar, #n, #m>);
        self.function("accelerations", &returns, &fused.kernel, |results| match fused.is_solved {
            true => self.solved(results),
            false => self.unsolved(results),
        })
    }

    fn solved(&self, results: &[TokenStream]) -> TokenStream {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let (accelerations, rest) = results.split_at(n);
        let (multipliers, pivot) = rest.split_at(m);
        quote! {
            __lagrange::Solution {
                accelerations: __lagrange::eliminate::vector([#(#accelerations),*]),
                multipliers: __lagrange::eliminate::vector([#(#multipliers),*]),
                pivot: #(#pivot)*,
                rank: #m,
            }
        }
    }

    fn unsolved(&self, results: &[TokenStream]) -> TokenStream {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let (mass, rest) = results.split_at(n * n);
        let (forcing, rest) = rest.split_at(n);
        let (jacobian, bias) = rest.split_at(n * m);
        let mass = mass.chunks(n).map(|row| quote!([#(#row),*]));
        let jacobian = jacobian.chunks(n).map(|row| quote!([#(#row),*]));
        quote! {
            __lagrange::eliminate::eliminate([#(#mass),*], [#(#forcing),*], [#(#jacobian),*], [#(#bias),*])
        }
    }
}
