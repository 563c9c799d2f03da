//! The one function that integrators call: accelerations and multipliers.

use proc_macro2::TokenStream;
use quote::quote;

use super::Emitter;
use super::eliminate::{Solved, eliminate};
use super::kernel::Kernel;
use super::passes::Program;
use super::schedule::Schedule;
use crate::mechanics::{Equations, Form};
use crate::resolve::Problem;
use crate::symbolic::Id;

/// M, h, F and γ in one schedule, so that they share what they have in common, and solved where that is short.
pub(super) struct Fused {
    pub(super) kernel: Kernel,
    is_solved: bool,
}

/// M, h, F and γ, matrices row by row.
fn loop_entries(equations: &Equations) -> Vec<Id> {
    let matrices = [equations.mass.concat(), equations.forcing.clone(), equations.jacobian.concat()];
    [matrices.concat(), equations.bias.clone()].concat()
}

/// The entries of the form, F and γ.
fn entries(form: &Form, equations: &Equations) -> Vec<Id> {
    let definitions = form.definitions.iter().flatten().map(|(_, entry)| entry);
    let of_form = form.matrix.iter().flatten().chain(&form.linear).chain(definitions);
    let of_form = of_form.chain(form.alone.iter().flatten());
    of_form.chain(equations.jacobian.iter().flatten()).chain(&equations.bias).copied().collect()
}

/// The equations of motion solved, by the form that takes the least time; `None` where every one is long.
fn cheapest(problem: &Problem, equations: &Equations) -> Option<Program> {
    let forms = equations.forms.iter();
    forms.filter_map(|form| solve(problem, form, equations)).min_by_key(|program| program.time().total())
}

/// The equations of motion solved by one form: accelerations, multipliers and the pivot.
pub(super) fn solve(problem: &Problem, form: &Form, equations: &Equations) -> Option<Program> {
    let mut schedule = Schedule::new(&problem.graph, &entries(form, equations));
    let Solved { accelerations, multipliers, pivot } = eliminate(&mut schedule, form, equations)?;
    Some(Program::new(schedule, [accelerations, multipliers, vec![pivot]].concat()))
}

impl Emitter<'_> {
    pub(super) fn fused(&self) -> Fused {
        if let Some(program) = cheapest(self.problem, self.equations) {
            return Fused { kernel: self.style.write(&program), is_solved: true };
        }
        Fused { kernel: self.style.kernel(&loop_entries(self.equations)), is_solved: false }
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
