//! Taylor series of user-supplied functions. The runtime evaluates the functions on power series of their arguments.

use std::collections::BTreeMap;

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::coefficients::{Recurrences, STAGES, SeriesQuantity, Stage, Sum};
use crate::codegen::bounds::{FUNCTION_ORDER, orders_of};
use crate::codegen::emitter::Emitter;
use crate::codegen::operation::{Call, Operation, Register};
use crate::codegen::passes::Program;

/// Argument of a call on series.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum CallArgument {
    /// Constant, as the bits of an `f64`.
    Constant(u64),
    /// Series, by its index among the arguments that the runtime stores.
    Kept(usize),
}

/// Call on series. `results` holds pairs of an output and the index of the sum that receives it.
pub(super) struct CallOnSeries {
    call: Call<CallArgument>,
    results: Vec<(u32, usize)>,
}

impl Recurrences {
    /// Result of a user-supplied function, y = U(x): y_k is Σ ∂U/∂x_i x_{i,k} plus a term from lower orders. `None`
    /// if this takes derivatives of a higher order than functions have.
    pub(super) fn result(&mut self, call: Call<SeriesQuantity>, output: u32) -> Option<SeriesQuantity> {
        let first = self.value(&call, None, output);
        if call.arguments.iter().all(|&x| self.is_at_rest(x)) {
            return Some(self.add(first, None));
        }
        (call.derivatives.len() < FUNCTION_ORDER).then_some(())?;
        let moving = (0..).zip(call.arguments.clone()).filter(|&(_, x)| !self.is_at_rest(x));
        let moving: Vec<(u32, SeriesQuantity)> = moving.collect();
        let slopes: Vec<(Register, SeriesQuantity)> =
            moving.into_iter().map(|(i, x)| (self.value(&call, Some(i), output), x)).collect();
        let (place, _) = self.calls.insert_full(call);
        let sum = self.place(Sum::Value(place, output));
        let newest = STAGES.map(|stage| {
            let mut all = (stage == Stage::Known).then_some(sum);
            for &(slope, x) in &slopes {
                let change = self.times(slope, self.part(x, stage));
                all = self.sum(all, change);
            }
            all
        });
        Some(self.add(first, Some(newest)))
    }

    /// Returns a result of the call at order 0, or its derivative with respect to argument `by`.
    fn value(&mut self, call: &Call<SeriesQuantity>, by: Option<u32>, output: u32) -> Register {
        let mut derivatives: Vec<u32> = call.derivatives.iter().copied().chain(by).collect();
        derivatives.sort_unstable();
        let arguments = call.arguments.iter().map(|&x| self.first(x)).collect();
        let call = Call { function: call.function, derivatives: derivatives.into(), arguments };
        let (call, _) = self.schedule.calls.insert_full(call);
        self.schedule.push(Operation::Result { call: call as u32, output })
    }

    /// Returns the calls, and for each argument that is not constant the index of its sum and its value at order 0.
    pub(super) fn calls(&mut self) -> (Vec<CallOnSeries>, Vec<(usize, Register)>) {
        let mut kept: Vec<(usize, Register)> = Vec::new();
        let calls = core::mem::take(&mut self.calls);
        let calls =
            calls.into_iter().enumerate().map(|(place, Call { function, derivatives, arguments })| {
                let arguments = arguments.iter().map(|&x| self.argument(x, &mut kept)).collect();
                let results = self.sums.iter().enumerate().filter_map(|(at, sum)| match sum {
                    Sum::Value(of, output) if *of == place => Some((*output, at)),
                    _ => None,
                });
                CallOnSeries { call: Call { function, derivatives, arguments }, results: results.collect() }
            });
        (calls.collect(), kept)
    }

    fn argument(&mut self, x: SeriesQuantity, kept: &mut Vec<(usize, Register)>) -> CallArgument {
        let first = self.first(x);
        if let Operation::Constant(bits) = self.schedule.operations[first.index()] {
            return CallArgument::Constant(bits);
        }
        let place = self.argument_place(x);
        let known = kept.iter().position(|&(known, _)| known == place);
        CallArgument::Kept(known.unwrap_or_else(|| {
            kept.push((place, first));
            kept.len() - 1
        }))
    }

    /// Index of the entry of `sums` where the runtime stores the series of an argument.
    pub(super) fn argument_place(&mut self, x: SeriesQuantity) -> usize {
        self.sums.insert_full(Sum::Argument(x)).0
    }
}

impl Emitter<'_> {
    /// Emits the method that evaluates the functions on series. `None` if there are no calls.
    pub(super) fn series_functions(&self, calls: &[CallOnSeries]) -> Option<TokenStream> {
        let scalar = self.style.types.scalar;
        let written = calls.iter().map(|call| self.call_on_series(call));
        (!calls.is_empty()).then(|| {
            quote! {
                #[doc = "What the functions add to an order."]
                fn series_functions(&self, order: usize, arguments: &[__lagrange::PowerSeries<#scalar>], sums: &mut Self::Sums) {
                    #(#written)*
                }
            }
        })
    }

    fn call_on_series(&self, CallOnSeries { call, results }: &CallOnSeries) -> TokenStream {
        let scalar = self.style.types.scalar;
        let series = quote!(__lagrange::PowerSeries<#scalar>);
        let values = self.style.call_on(&series, call, |argument| match argument {
            CallArgument::Constant(bits) => {
                let value = Literal::f64_unsuffixed(f64::from_bits(*bits));
                quote!(__lagrange::Scalar::constant(#value))
            }
            CallArgument::Kept(place) => quote!(arguments[#place]),
        });
        let puts = results.iter().map(|&(output, place)| {
            let output = output as usize;
            quote!(sums[#place] = values[#output].coefficient(order);)
        });
        quote! {
            let values = #values;
            #(#puts)*
        }
    }

    /// Generics with bounds on the functions: series as arguments, and one derivative more than the equations of
    /// motion need. The compiler checks these bounds only where the trait is used.
    pub(super) fn generics_on_series(&self, slopes: &Program, calls: &[CallOnSeries]) -> syn::Generics {
        let scalar = self.style.types.scalar;
        let orders = orders_of(self.orders(&[]), slopes.schedule.calls.iter());
        let mut generics = self.generics(&orders, calls.is_empty());
        let on_series = orders_of(BTreeMap::new(), calls.iter().map(|of| &of.call));
        self.ask_for(&mut generics, &on_series, &quote!(__lagrange::PowerSeries<#scalar>), false);
        generics
    }
}
