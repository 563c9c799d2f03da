//! From a schedule to the body of a function, and to the functions that are parts of it where it is long.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::body::{Body, Part};
use super::count::Count;
use super::passes::Program;
use super::shape::{Arrays, Shape};
use super::style::Style;
use crate::symbolic::Id;
use crate::variables::Variable;

/// Longer functions are refused.
pub(super) const OPERATION_LIMIT: usize = 50_000;

/// The body of one emitted function.
#[derive(Default)]
pub(super) struct Kernel {
    /// Reads the inputs and computes the results.
    pub(super) statements: TokenStream,
    /// One expression for each shape.
    pub(super) results: Vec<TokenStream>,
    /// What it takes, to be read.
    pub(super) doc: String,
}

/// A function that takes more than [`OPERATION_LIMIT`].
pub(super) struct Refused {
    pub(super) name: String,
    pub(super) count: Count,
}

impl Style<'_> {
    /// Computes `roots` for the function of this name.
    pub(super) fn kernel(&self, name: &str, roots: &[Id], shapes: &[Shape]) -> Kernel {
        self.write(name, &Program::of(self.graph, roots), shapes)
    }

    /// The program as statements, and where its results are.
    pub(super) fn write(&self, name: &str, program: &Program, shapes: &[Shape]) -> Kernel {
        let count = program.count();
        if count.total() > OPERATION_LIMIT {
            self.refused.borrow_mut().push(Refused { name: name.to_owned(), count });
            return Kernel::default();
        }
        let body = Body::new(program, &self.problem.names);
        let (doc, arrays) = (doc(program, &body), Arrays::new(shapes));
        let Body { parts, waiting, results, .. } = body;
        let (declarations, results) = match results {
            Some(values) => {
                let mut values = values.into_iter().map(|value| self.operand(value));
                (None, shapes.iter().map(|shape| shape.literal(&mut values)).collect())
            }
            None => (Some(arrays.declarations(&self.constant(0.0))), arrays.results()),
        };
        let statements = self.parts(name, parts, waiting, &arrays);
        Kernel { statements: quote! { #declarations #statements }, results, doc }
    }

    /// The only part, or calls of the methods that become of several.
    fn parts(&self, name: &str, mut parts: Vec<Part>, waiting: usize, arrays: &Arrays) -> TokenStream {
        if parts.len() == 1 {
            return parts.drain(..).map(|part| self.statements(part, arrays)).collect();
        }
        let (zero, count) = (self.constant(0.0), parts.len());
        let calls = parts.into_iter().enumerate().map(|(k, part)| {
            let doc = format!("Part {} of {count} of `{name}`.", k + 1);
            self.part(name, &doc, part, waiting, arrays)
        });
        quote! { let mut waiting = [#zero; #waiting]; #(#calls)* }
    }

    /// Makes a method of a part; what is returned calls it.
    fn part(&self, name: &str, doc: &str, part: Part, waiting: usize, arrays: &Arrays) -> TokenStream {
        let method = format_ident!("__{name}_{}", self.parts.borrow().len());
        let (scalar, n, m) = (self.scalar, self.problem.coordinates.len(), self.problem.constraints.len());
        let is_any =
            |kind: fn(Variable) -> bool| part.inputs.iter().any(|&symbol| kind(Variable::of(symbol)));
        let (mut names, mut types) = (Vec::new(), Vec::new());
        if is_any(|variable| matches!(variable, Variable::Acceleration(_))) {
            names.push(quote!(solution));
            types.push(quote!(&__lagrange::Solution<#scalar, #n, #m>));
        }
        if is_any(|variable| matches!(variable, Variable::Multiplier(_))) {
            names.push(quote!(multipliers));
            types.push(quote!(&__lagrange::nalgebra::SVector<#scalar, #m>));
        }
        if is_any(|variable| matches!(variable, Variable::Change(_))) {
            let p = self.problem.parameters.entries.len();
            names.push(quote!(direction));
            types.push(quote!(&__lagrange::Direction<#scalar, #n, #p>));
        }
        let (body, array_names, array_types) =
            (self.statements(part, arrays), &arrays.names, arrays.types(scalar));
        self.parts.borrow_mut().push(quote! {
            #[doc = #doc]
            #[inline(never)]
            #[allow(unused_variables)]
            fn #method(&self, state: &__lagrange::State<#scalar, #n>, #(#names: #types,)* waiting: &mut [#scalar; #waiting], #(#array_names: &mut #array_types),*) {
                #body
            }
        });
        quote! { self.#method(state, #(#names,)* &mut waiting, #(&mut #array_names),*); }
    }
}

/// What a function takes, and what each pass that gained something left of it.
fn doc(program: &Program, body: &Body) -> String {
    let mut doc = format!("{}.", program.count());
    let mut steps = program.counts.clone();
    steps.dedup_by_key(|(_, count)| *count);
    if steps.len() > 1 {
        let steps: Vec<_> = steps.iter().map(|(name, count)| format!("{} {name}", count.total())).collect();
        doc += &format!(" Of every kind: {}.", steps.join(", then "));
    }
    match program.fusions() {
        0 => {}
        1 => doc += " One product fused with a sum.",
        fusions => doc += &format!(" {fusions} products fused with sums."),
    }
    let [before, peak] = body.peaks;
    if peak != before {
        doc += &format!(" Reordered: at most {peak} results wait for their last use, before {before}.");
    }
    if body.parts.len() > 1 {
        doc += &format!(" In {} parts.", body.parts.len());
    }
    doc
}
