//! Gradients of long user-supplied functions among the slopes. The runtime fills and multiplies them in loops, so the emitted code
//! does not grow with their number.

use indexmap::IndexSet;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::bounds::capability;
use super::operation::{Call, CallArgument};
use super::passes::Program;
use super::style::FunctionContext;
use crate::resolve::{Problem, Supplied};

/// Gradients of a function, or of some of its partial derivatives, at one place.
#[derive(Clone, Debug)]
pub(super) struct SlopeBlock {
    /// The function, with arguments that are constants or slopes.
    pub(super) call: Call<CallArgument>,
    /// Partial derivatives whose gradients the block holds: a row for each of their results.
    pub(super) by: IndexSet<Box<[u32]>>,
}

impl SlopeBlock {
    /// The function, and the order of its derivatives.
    pub(super) fn order(&self) -> (u32, usize) {
        (self.call.function, self.by.iter().map(|by| by.len() + 1).max().unwrap_or(0))
    }
}

/// Layout of an array of slopes: single numbers first, then blocks.
#[derive(Clone, Default)]
pub(super) struct SlopeLayout {
    pub(super) length: usize,
    blocks: Vec<SlopeBlock>,
    starts: Vec<usize>,
}

impl SlopeLayout {
    pub(super) fn of(problem: &Problem, slopes: &Program) -> Self {
        let mut layout =
            Self { length: slopes.results.len(), blocks: slopes.blocks.clone(), starts: Vec::new() };
        for SlopeBlock { call, by } in &layout.blocks {
            layout.starts.push(layout.length);
            layout.length += by.len() * size(problem, call);
        }
        layout
    }
}

/// Number of derivatives of all results by all arguments.
fn size<X>(problem: &Problem, call: &Call<X>) -> usize {
    let Supplied { inputs, outputs, .. } = problem.functions[call.function as usize];
    inputs * outputs
}

impl FunctionContext<'_> {
    /// Emits the array of slopes, the first of which are `numbers`.
    pub(super) fn slopes(&self, slopes: &Program, numbers: &[TokenStream]) -> TokenStream {
        if slopes.blocks.is_empty() {
            return quote!(#(#numbers)*);
        }
        let layout = SlopeLayout::of(self.problem, slopes);
        let (zero, count, length) = (self.constant(0.0), slopes.results.len(), layout.length);
        let written = layout.blocks.iter().zip(&layout.starts);
        let written = written.map(|(block, &start)| self.write_gradients(block, start));
        quote! {{
            let mut slopes = [#zero; #length];
            slopes[..#count].copy_from_slice(&#(#numbers)*);
            #(#written)*
            slopes
        }}
    }

    fn write_gradients(&self, block: &SlopeBlock, start: usize) -> TokenStream {
        let SlopeBlock { call, by } = block;
        let scalar = self.types.scalar;
        let arguments = call.arguments.iter().map(|argument| match argument {
            CallArgument::Constant(bits) => self.constant(f64::from_bits(*bits)),
            CallArgument::Kept(place) => quote!(slopes[#place]),
        });
        let (_, order) = block.order();
        let earlier: Vec<_> = (1..order).map(|k| format_ident!("i{k}")).collect();
        let (capability, method) = capability(order);
        let (capability, method) = (format_ident!("{capability}"), format_ident!("{method}"));
        let function = &self.problem.functions[call.function as usize];
        let (inputs, outputs, field) =
            (function.inputs, function.outputs, self.supplied_field(call.function));
        let length = by.len() * outputs * inputs;
        let by = by.iter().map(|derivatives| literals(derivatives));
        quote! {
            let x = [#(#arguments),*];
            __lagrange::generated::write_gradients(
                #inputs,
                &[#(#by),*],
                |[#(#earlier),*], i| __lagrange::function::#capability::<#scalar, #inputs, #outputs>::#method(#field, x, [#(#earlier,)* i]),
                &mut slopes[#start..][..#length],
            );
        }
    }

    /// Emits the index of the slope at which the gradients of a partial derivative begin.
    pub(super) fn start_of_gradients(&self, block: usize, derivatives: &[u32]) -> TokenStream {
        let SlopeBlock { call, by } = &self.slopes.blocks[block];
        let rows = by.get_index_of(derivatives).unwrap_or(0);
        let start = self.slopes.starts[block] + rows * size(self.problem, call);
        quote!(#start)
    }
}

/// An array of indices.
pub(super) fn literals(indices: &[u32]) -> TokenStream {
    let indices = indices.iter().map(|&i| Literal::u32_unsuffixed(i));
    quote!([#(#indices),*])
}
