//! The one function that integrators call: accelerations and multipliers.

use proc_macro2::TokenStream;
use quote::quote;

use super::eliminate::{Solved, eliminate};
use super::kernel::OPERATION_LIMIT;
use super::passes::Program;
use super::schedule::Schedule;
use super::shape::Shape;
use super::{Emitter, Written};
use crate::contract::Method;
use crate::mechanics::{Equations, Form};
use crate::symbolic::{Graph, Id};

/// M, h, F and γ, completed as the form over the accelerations is, matrices row by row. Of M the lower triangle is read.
fn loop_entries(equations: &Equations) -> Vec<Id> {
    let Form { matrix, linear, .. } = &equations.forms[0];
    let row = |(i, row): (usize, &Vec<Id>)| {
        row.iter().enumerate().map(|(j, &entry)| if j <= i { entry } else { Id::ZERO }).collect::<Vec<_>>()
    };
    let mass = matrix.iter().enumerate().flat_map(row);
    let others = [linear, &equations.jacobian.concat(), &equations.bias].map(|entries| entries.clone());
    mass.chain(others.concat()).collect()
}

/// The entries of the form, F and γ.
fn entries(form: &Form, equations: &Equations) -> Vec<Id> {
    let definitions = form.definitions.iter().flatten().map(|(_, entry)| entry);
    let of_form = form.matrix.iter().flatten().chain(&form.linear).chain(definitions);
    let of_form = of_form.chain(form.alone.iter().flatten());
    of_form.chain(equations.jacobian.iter().flatten()).chain(&equations.bias).copied().collect()
}

/// The equations of motion solved, by the form that takes the least time; `None` where every one is long.
fn cheapest(graph: &Graph, equations: &Equations) -> Option<Program> {
    let forms = equations.forms.iter();
    let programs = forms.filter_map(|form| solve(graph, form, equations));
    let programs = programs.filter(|program| program.count().total() <= OPERATION_LIMIT);
    programs.min_by_key(|program| program.time().total()).map(Program::fused)
}

/// The equations of motion solved by one form: accelerations, multipliers and the pivot.
pub(super) fn solve(graph: &Graph, form: &Form, equations: &Equations) -> Option<Program> {
    let mut schedule = Schedule::new(graph, &entries(form, equations));
    let Solved { accelerations, multipliers, pivot } = eliminate(&mut schedule, form, equations)?;
    Some(Program::new(schedule, [accelerations, multipliers, vec![pivot]].concat()))
}

impl Emitter<'_> {
    /// M, h, F and γ in one schedule, so that they share what they have in common, and solved where that is short.
    pub(super) fn accelerations(&self, method: &Method) -> Written {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let equations = &self.derived.equations;
        let Some(program) = cheapest(self.style.graph, equations) else {
            let shapes = [Shape::Matrix(n, n), Shape::Vector(n), Shape::Matrix(m, n), Shape::Vector(m)];
            let kernel = self.style.kernel(method.name, &loop_entries(equations), &shapes);
            return self.function(
                method,
                kernel,
                |results| quote!(__lagrange::generated::eliminate(#(#results),*)),
            );
        };
        let kernel =
            self.style.write(method.name, &program, &[Shape::Vector(n), Shape::Vector(m), Shape::Number]);
        self.function(method, kernel, |results| {
            let [accelerations, multipliers, pivot] = results else { return TokenStream::new() };
            quote! {
                __lagrange::Solution {
                    accelerations: __lagrange::generated::vector(#accelerations),
                    multipliers: __lagrange::generated::vector(#multipliers),
                    pivot: #pivot,
                    rank: #m,
                }
            }
        })
    }
}
