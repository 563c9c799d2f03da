//! From a schedule to the body of a function, and to the functions that are parts of it where it is long.

use std::ops::Range;

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use rustc_hash::FxHashMap;

use super::chunks;
use super::count::Count;
use super::operation::{Operation, Register};
use super::order_of_evaluation::Order;
use super::passes::Program;
use super::shape::{Arrays, Shape};
use super::style::Style;
use super::writer::{Writer, Written};
use crate::symbolic::{Id, Symbol};
use crate::variables::Variable;

/// Longer functions are refused.
pub(super) const OPERATION_LIMIT: usize = 50_000;
/// So many results, most of them zero, are not written out.
const MANY: usize = 256;

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
        let Program { schedule, results: roots, .. } = program;
        let count = program.count();
        if count.total() > OPERATION_LIMIT {
            self.refused.borrow_mut().push(Refused { name: name.to_owned(), count });
            return Kernel::default();
        }
        let uses = schedule.uses(roots);
        let order = Order::new(schedule, roots, &uses);
        let parts = chunks::parts(&order);
        let doc = doc(program, &order, parts.len());
        let writer = Writer::new(self, schedule, uses, &order.sequence, &parts);
        let zero = schedule.find(Operation::Constant(0.0_f64.to_bits()));
        let zeros = roots.iter().filter(|&&root| Some(root) == zero).count();
        let is_sparse = roots.len() >= MANY && zeros > roots.len() / 2;
        let (statements, results) = if parts.len() == 1 && !is_sparse {
            self.in_place(writer, &order, roots, shapes)
        } else {
            let arrays = Arrays::new(shapes);
            let roots = roots.iter().copied().enumerate().filter(|(_, root)| Some(*root) != zero);
            let roots: Vec<_> = roots.map(|(k, root)| (root, arrays.place(k))).collect();
            (self.in_arrays(name, writer, &order, &parts, &roots, &arrays), arrays.results())
        };
        Kernel { statements, results, doc }
    }

    /// The results are expressions.
    fn in_place(
        &self,
        mut writer: Writer,
        order: &Order,
        roots: &[Register],
        shapes: &[Shape],
    ) -> (TokenStream, Vec<TokenStream>) {
        order.sequence.iter().for_each(|&index| writer.write(index));
        let values: Vec<_> = roots.iter().map(|&root| writer.value(root)).collect();
        let mut values = values.into_iter();
        let results = shapes.iter().map(|shape| shape.literal(&mut values)).collect();
        (self.body(&writer.finish()), results)
    }

    /// The results are put into arrays, as soon as they are there.
    fn in_arrays(
        &self,
        name: &str,
        mut writer: Writer,
        order: &Order,
        parts: &[Range<usize>],
        roots: &[(Register, TokenStream)],
        arrays: &Arrays,
    ) -> TokenStream {
        let mut places = FxHashMap::<usize, Vec<&TokenStream>>::default();
        for (root, place) in roots {
            if writer.is_at_hand(*root) {
                writer.place(*root, place);
            } else {
                places.entry(root.index()).or_default().push(place);
            }
        }
        let mut part = |range: &Range<usize>| {
            for &index in &order.sequence[range.clone()] {
                writer.write(index);
                let places = places.get(&index).into_iter().flatten();
                places.for_each(|place| writer.place(Register::at(index), place));
            }
            writer.finish()
        };
        let written: Vec<Written> = parts.iter().map(&mut part).collect();
        let zero = self.constant(0.0);
        let declarations = arrays.declarations(&zero);
        if let [whole] = &written[..] {
            let body = self.body(whole);
            return quote! { #declarations #body };
        }
        let length = writer.waiting.length;
        let calls = written.iter().enumerate().map(|(k, part)| {
            let doc = format!("Part {} of {} of `{name}`.", k + 1, written.len());
            self.part(name, &doc, part, length, arrays)
        });
        quote! { #declarations let mut waiting = [#zero; #length]; #(#calls)* }
    }

    fn body(&self, Written { inputs, statements }: &Written) -> TokenStream {
        let inputs = self.inputs(inputs);
        quote! { #inputs #statements }
    }

    /// Makes a method of a part; what is returned calls it.
    fn part(&self, name: &str, doc: &str, part: &Written, waiting: usize, arrays: &Arrays) -> TokenStream {
        let method = format_ident!("__{name}_{}", self.parts.borrow().len());
        let (scalar, n, m) = (self.scalar, self.problem.coordinates.len(), self.problem.constraints.len());
        let is_any = |kind: fn(Variable) -> bool| {
            part.inputs.iter().any(|&symbol: &Symbol| kind(Variable::of(symbol)))
        };
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
        let (body, array_names, array_types) = (self.body(part), &arrays.names, arrays.types(scalar));
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
fn doc(program: &Program, order: &Order, parts: usize) -> String {
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
    if order.peak() != order.peak_before {
        let (peak, before) = (order.peak(), order.peak_before);
        doc += &format!(" Reordered: at most {peak} results wait for their last use, before {before}.");
    }
    if parts > 1 {
        doc += &format!(" In {parts} parts.");
    }
    doc
}
