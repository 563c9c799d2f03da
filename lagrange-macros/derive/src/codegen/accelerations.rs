//! Methods that solve the equations of motion for accelerations and multipliers: in one function, or as a
//! factorization and a solve.

use proc_macro2::TokenStream;
use quote::quote;

use super::emitter::{Emitter, Written};
use super::kernel::Kernel;
use super::passes::Program;
use super::shape::ResultShape;
use super::signature::wide;
use super::solving::Solving;
use crate::contract::Method;
use crate::mechanics::{Form, LinearEquations};
use crate::symbolic::Id;

impl Emitter<'_> {
    /// Emits the fused function that solves for accelerations and multipliers. Integrators call it most often.
    pub(super) fn accelerations(&self, method: &Method) -> Written {
        let open = self.open_contacts();
        let mut written = match &self.solving {
            Some(solving) => self.solution(method, &solving.accelerations, &open.tokens),
            None => {
                let [mass, forcing, jacobian, bias] = self.equations_by_rows();
                let arguments = [mass, forcing, jacobian, bias, self.compliance()];
                self.in_loops(method, arguments, &quote!(eliminate), &open.tokens)
            }
        };
        written.kernels.extend(open.kernels);
        written
    }

    /// Statements that solve without the rows of contacts, and return, while all contacts are open.
    fn open_contacts(&self) -> Written {
        let Some(open) = &self.open else {
            return Written { tokens: TokenStream::new(), kernels: Vec::new() };
        };
        let places = self.problem.contacts.iter().map(|contact| self.style.place_of_state(contact.entry));
        let kernel = self.style.write("accelerations_of_open_contacts", open, &self.shapes_of_solution());
        let (statements, solution) = (&kernel.statements, self.solved(&kernel.results));
        let tokens = quote! {
            if !(#(__lagrange::generated::Switch::is_on(&#places))||*) {
                #statements
                return #solution;
            }
        };
        Written { tokens, kernels: vec![kernel] }
    }

    /// Emits the method that factorizes the KKT matrix.
    pub(super) fn factor(&self, method: &Method) -> Written {
        let Some(Solving { factor, .. }) = &self.solving else {
            let [mass, _, jacobian, _] = self.equations_by_rows();
            let arguments = [mass, jacobian, self.weights(), self.compliance()];
            return self.in_loops(method, arguments, &quote!(factor), &TokenStream::new());
        };
        let kernel = self.style.write(method.name, factor, &[ResultShape::Vector(factor.results.len())]);
        self.function(method, kernel, |results| quote!(#(#results)*))
    }

    /// Emits the method that solves with a factorization.
    pub(super) fn solve_with(&self, method: &Method) -> Written {
        match &self.solving {
            Some(solving) => self.solution(method, &solving.solve, &TokenStream::new()),
            None => self.function(method, Kernel::default(), |_| quote!(factor.solve(forcing, bias))),
        }
    }

    fn solution(&self, method: &Method, program: &Program, before: &TokenStream) -> Written {
        let wide = wide();
        let over = method.is_wide.then(|| self.style.over(&wide, 0));
        let kernel =
            over.as_ref().unwrap_or(&self.style).write(method.name, program, &self.shapes_of_solution());
        self.function_after(before, method, kernel, |results| self.solved(results))
    }

    fn shapes_of_solution(&self) -> [ResultShape; 3] {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        [ResultShape::Vector(n), ResultShape::Vector(m), ResultShape::Number]
    }

    /// A solution with these results.
    fn solved(&self, results: &[TokenStream]) -> TokenStream {
        let [accelerations, multipliers, pivot] = results else { return TokenStream::new() };
        let m = self.problem.constraints.len();
        quote! {
            __lagrange::Solution {
                accelerations: __lagrange::generated::vector(#accelerations),
                multipliers: __lagrange::generated::vector(#multipliers),
                pivot: #pivot,
                rank: #m,
            }
        }
    }

    /// M, h, F and γ for the solver in the runtime; M is completed if it is singular. Matrices are row-major.
    /// The runtime reads the lower triangle of M only.
    fn equations_by_rows(&self) -> [(Vec<Id>, ResultShape); 4] {
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let LinearEquations { forms, jacobian, bias, .. } = &self.derived.equations.linear;
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
        let LinearEquations { forms, bias, .. } = &self.derived.equations.linear;
        let mut weights = vec![Id::ZERO; bias.len()];
        forms[0].completing.iter().for_each(|&(a, weight)| weights[a] = weight);
        (weights, ResultShape::Vector(bias.len()))
    }

    /// Compliance c of each constraint.
    fn compliance(&self) -> (Vec<Id>, ResultShape) {
        let compliance = &self.derived.equations.linear.compliance;
        (compliance.clone(), ResultShape::Vector(compliance.len()))
    }

    /// Emits a call of a runtime function. Its arguments are computed by one kernel, so that they share
    /// subexpressions.
    fn in_loops<const K: usize>(
        &self,
        method: &Method,
        arguments: [(Vec<Id>, ResultShape); K],
        function: &TokenStream,
        before: &TokenStream,
    ) -> Written {
        let shapes = arguments.each_ref().map(|(_, shape)| *shape);
        let entries: Vec<Id> = arguments.into_iter().flat_map(|(entries, _)| entries).collect();
        let kernel = self.style.kernel(method.name, &entries, &shapes);
        let call = |results: &[TokenStream]| quote!(__lagrange::generated::#function(#(#results),*));
        self.function_after(before, method, kernel, call)
    }
}
