//! Methods that solve the equations of motion for accelerations and multipliers: in one function, or as a
//! factorization and a solve.

use proc_macro2::TokenStream;
use quote::quote;

use super::emitter::{Emitter, Written};
use super::kernel::Kernel;
use super::shape::ResultShape;
use super::signature::wide;
use super::slopes::SlopeLayout;
use crate::contract::Method;
use crate::mechanics::{Equations, Form, LinearEquations};
use crate::symbolic::Id;

impl Emitter<'_> {
    /// Emits the fused function that solves for accelerations and multipliers. Integrators call it most often.
    pub(super) fn accelerations(&self, method: &Method) -> Written {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let fused = self.solving.accelerations.as_ref().map(|program| {
            let shapes = [ResultShape::Vector(n), ResultShape::Vector(m), ResultShape::Number];
            self.style.write(method.name, program, &shapes)
        });
        let is_switched = self.derived.equations.switched.is_some();
        match fused {
            None if is_switched => self.function(method, Kernel::default(), |_| self.put_together()),
            Some(kernel) if is_switched => {
                let (any_holds, together) = (self.any_holds(), self.put_together());
                let before = quote!(if #any_holds { return #together; });
                self.function_after(&before, method, kernel, |results| solved(results, m))
            }
            Some(kernel) => self.function(method, kernel, |results| solved(results, m)),
            None => {
                let [mass, forcing, jacobian, bias] = self.equations_by_rows();
                let (kernel, result) =
                    self.in_loops(method.name, [mass, forcing, jacobian, bias], None, &quote!(eliminate));
                self.function(method, kernel, |_| result.clone())
            }
        }
    }

    /// The solution by those constraints that hold.
    fn put_together(&self) -> TokenStream {
        quote!(__lagrange::generated::accelerations(self, state))
    }

    /// Emits the method that factorizes the KKT matrix.
    pub(super) fn factor(&self, method: &Method) -> Written {
        if self.derived.equations.switched.is_some() {
            let together = quote!(__lagrange::generated::SwitchedFactorOf::<Self>::of(self, state));
            return self.function(method, Kernel::default(), |_| together.clone());
        }
        let (kernel, result) = self.factorization(method.name);
        self.function(method, kernel, |_| result.clone())
    }

    /// Emits the method that solves with a factorization.
    pub(super) fn solve_with(&self, method: &Method) -> Written {
        if self.derived.equations.switched.is_some() {
            return self.function(method, Kernel::default(), |_| quote!(factor.solve(self, forcing, bias)));
        }
        let (kernel, result) = self.solution(method.name, &quote!(bias));
        self.function(method, kernel, |_| result.clone())
    }

    /// Factorizes the equations of motion. If constraints can be switched off, it factorizes the mass matrix and computes h.
    pub(super) fn factorization(&self, name: &str) -> (Kernel, TokenStream) {
        let Equations { switched, forcing, .. } = &self.derived.equations;
        let more = switched.as_ref().map(|_| (forcing.clone(), ResultShape::Vector(forcing.len())));
        let shape_of_more = more.as_ref().map(|(_, shape)| *shape);
        let (kernel, factor) = match &self.solving.factoring {
            Some([factor, _]) => {
                let numbers = factor.results.len() - shape_of_more.map_or(0, ResultShape::length);
                let shapes: Vec<_> =
                    [ResultShape::Vector(numbers)].into_iter().chain(shape_of_more).collect();
                let kernel = self.style.write(name, factor, &shapes);
                let numbers = kernel.results.first().cloned().unwrap_or_default();
                (kernel, numbers)
            }
            None => {
                let [mass, _, jacobian, _] = self.equations_by_rows();
                self.in_loops(name, [mass, jacobian, self.weights()], more, &quote!(factor))
            }
        };
        let forcing = kernel.results.last().filter(|_| shape_of_more.is_some());
        let result = match forcing {
            Some(forcing) => quote!((#factor, __lagrange::generated::vector(#forcing))),
            None => factor,
        };
        (kernel, result)
    }

    /// Solves with the [factorization](Self::factorization), on any numbers.
    pub(super) fn solution(&self, name: &str, bias: &TokenStream) -> (Kernel, TokenStream) {
        let (n, m) = (self.problem.coordinates.len(), self.factorized().bias.len());
        let Some([_, solve]) = &self.solving.factoring else {
            return (Kernel::default(), quote!(factor.solve(forcing, &#bias)));
        };
        let (wide, shapes) = (wide(), [ResultShape::Vector(n), ResultShape::Vector(m), ResultShape::Number]);
        let kernel = self.style.over(&wide, SlopeLayout::default()).write(name, solve, &shapes);
        let result = solved(&kernel.results, m);
        (kernel, result)
    }

    /// The equations whose factorization is emitted: those of the mass matrix if constraints can be switched off.
    fn factorized(&self) -> &LinearEquations {
        let equations = &self.derived.equations;
        equations.switched.as_ref().map_or(&equations.linear, |switched| &switched.inertia)
    }

    /// M, h, F and γ for the solver in the runtime; M is completed if it is singular. Matrices are row-major.
    /// The runtime reads the lower triangle of M only.
    fn equations_by_rows(&self) -> [(Vec<Id>, ResultShape); 4] {
        let LinearEquations { forms, jacobian, bias, .. } = self.factorized();
        let (n, m) = (self.problem.coordinates.len(), bias.len());
        let Form { matrix, linear, .. } = &forms[0];
        let row = |(i, row): (usize, &Vec<Id>)| {
            row.iter()
                .enumerate()
                .map(|(j, &entry)| if j <= i { entry } else { Id::ZERO })
                .collect::<Vec<_>>()
        };
        let mass = matrix.iter().enumerate().flat_map(row).collect();
        [
            (mass, ResultShape::Matrix(n, n)),
            (linear.clone(), ResultShape::Vector(n)),
            (jacobian.concat(), ResultShape::Matrix(m, n)),
            (bias.clone(), ResultShape::Vector(m)),
        ]
    }

    /// Weight σ of each constraint in the completion of M; zero for constraints that do not complete it.
    fn weights(&self) -> (Vec<Id>, ResultShape) {
        let LinearEquations { forms, bias, .. } = self.factorized();
        let mut weights = vec![Id::ZERO; bias.len()];
        forms[0].completing.iter().for_each(|&(a, weight)| weights[a] = weight);
        (weights, ResultShape::Vector(bias.len()))
    }

    /// Calls a runtime function. Its arguments, and `more`, are computed by one kernel, so that they share subexpressions.
    fn in_loops<const K: usize>(
        &self,
        name: &str,
        arguments: [(Vec<Id>, ResultShape); K],
        more: Option<(Vec<Id>, ResultShape)>,
        function: &TokenStream,
    ) -> (Kernel, TokenStream) {
        let (entries, shapes): (Vec<_>, Vec<_>) = arguments.into_iter().chain(more).unzip();
        let kernel = self.style.kernel(name, &entries.concat(), &shapes);
        let results = kernel.results.iter().take(K);
        let call = quote!(__lagrange::generated::#function(#(#results),*));
        (kernel, call)
    }
}

/// A solution with these results, and so many multipliers.
fn solved(results: &[TokenStream], m: usize) -> TokenStream {
    let [accelerations, multipliers, pivot] = results else { return TokenStream::new() };
    quote! {
        __lagrange::Solution {
            accelerations: __lagrange::generated::vector(#accelerations),
            multipliers: __lagrange::generated::vector(#multipliers),
            pivot: #pivot,
            rank: #m,
        }
    }
}
