//! The one function that integrators call: accelerations and multipliers.

use proc_macro2::TokenStream;
use quote::quote;

use super::Emitter;
use super::eliminate::{Solved, eliminate};
use super::kernel::Kernel;
use super::schedule::{Register, Schedule};
use super::shape::Shape;
use crate::mechanics::Equations;
use crate::symbolic::Id;

/// M, h, F and γ in one schedule, so that they share what they have in common, and solved where that is short.
struct Fused {
    kernel: Kernel,
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
    fn fused(&self) -> Fused {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let roots = kkt_entries(self.equations);
        let mut schedule = Schedule::new(&self.problem.graph, &roots);
        let mut solving = schedule.clone();
        if let Some(Solved { accelerations, multipliers, pivot }) = eliminate(&mut solving, self.equations) {
            let results = [accelerations, multipliers, vec![pivot]].concat();
            let shapes = [Shape::Vector(n), Shape::Vector(m), Shape::Number];
            let kernel = self.style.write("accelerations", &solving, &results, &shapes);
            return Fused { kernel, is_solved: true };
        }
        let mut results: Vec<Register> = roots.iter().map(|&root| schedule.register(root)).collect();
        // Of M the lower triangle is read.
        let zero = schedule.constant(0.0);
        (0..n).for_each(|i| results[i * n + i + 1..(i + 1) * n].fill(zero));
        let shapes = [Shape::Matrix(n, n), Shape::Vector(n), Shape::Matrix(m, n), Shape::Vector(m)];
        Fused { kernel: self.style.write("accelerations", &schedule, &results, &shapes), is_solved: false }
    }

    pub(super) fn accelerations(&self) -> TokenStream {
        let fused = self.fused();
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let scalar = self.style.scalar;
        let returns = quote!(__lagrange::Solution<#scalar, #n, #m>);
        self.function("accelerations", &returns, &fused.kernel, |results| match (results, fused.is_solved) {
            ([accelerations, multipliers, pivot], true) => quote! {
                __lagrange::Solution {
                    accelerations: __lagrange::eliminate::vector(#accelerations),
                    multipliers: __lagrange::eliminate::vector(#multipliers),
                    pivot: #pivot,
                    rank: #m,
                }
            },
            _ => quote!(__lagrange::eliminate::eliminate(#(#results),*)),
        })
    }
}
