//! Taylor series of user-supplied functions. The runtime evaluates the functions on power series of their arguments.

use std::collections::BTreeMap;

use indexmap::{IndexMap, IndexSet};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::coefficients::{Recurrences, STAGES, SeriesQuantity, Stage, Sum};
use crate::codegen::bounds::{FUNCTION_ORDER, orders_of};
use crate::codegen::emitter::Emitter;
use crate::codegen::operation::{Call, CallArgument, CallKind, Operation, Register};
use crate::codegen::passes::Program;
use crate::codegen::slopes::SlopeBlock;
use crate::symbolic::MOST_PARTIALS;

/// Calls on series, which differ in their derivatives. The arguments are indices of those that the runtime stores.
pub(super) struct CallsOnSeries {
    call: Call<CallArgument>,
    by: Vec<Box<[u32]>>,
    /// Index of the derivative, index of its result, and index of the sum that receives it.
    results: Vec<[usize; 3]>,
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
        let changes = STAGES.map(|stage| self.change(&call, output, stage));
        let (place, _) = self.calls.insert_full(call);
        let sum = self.place(Sum::Value(place, output));
        let [known, added] = changes;
        let known = self.sum(Some(sum), known);
        Some(self.add(first, Some([known, added])))
    }

    /// Σ ∂U/∂x_i x_{i,k} for a part of the coefficients x_{i,k}. `None` if they vanish.
    fn change(&mut self, call: &Call<SeriesQuantity>, output: u32, stage: Stage) -> Option<Register> {
        let newest: Vec<Option<Register>> = call.arguments.iter().map(|&x| self.part(x, stage)).collect();
        newest.iter().any(Option::is_some).then_some(())?;
        if newest.len() > MOST_PARTIALS {
            return Some(self.along(call, output, &newest));
        }
        let mut all = None;
        for (i, newest) in (0..).zip(newest).filter(|(_, newest)| newest.is_some()) {
            let slope = self.value(call, Some(i), output);
            let change = self.times(slope, newest);
            all = self.sum(all, change);
        }
        all
    }

    /// The same sum as a single call.
    fn along(&mut self, call: &Call<SeriesQuantity>, output: u32, newest: &[Option<Register>]) -> Register {
        let zero = self.schedule.constant(0.0);
        let at = call.on(|&x| self.first(x));
        let newest = newest.iter().map(|x| x.unwrap_or(zero));
        let arguments = at.arguments.iter().copied().chain(newest).collect();
        self.call(Call { arguments, kind: CallKind::Along, ..at }, output)
    }

    /// Returns a result of the call at order 0, or its derivative with respect to argument `by`.
    fn value(&mut self, call: &Call<SeriesQuantity>, by: Option<u32>, output: u32) -> Register {
        let mut derivatives: Vec<u32> = call.derivatives.iter().copied().chain(by).collect();
        derivatives.sort_unstable();
        let at = call.on(|&x| self.first(x));
        self.call(Call { derivatives: derivatives.into(), ..at }, output)
    }

    fn call(&mut self, call: Call, output: u32) -> Register {
        let (call, _) = self.schedule.calls.insert_full(call);
        self.schedule.push(Operation::Result { call: call as u32, output })
    }

    /// Returns the calls, those of a [family](Call::family) together, and for each argument that is not constant the index of
    /// its sum and its value at order 0.
    pub(super) fn calls(&mut self) -> (Vec<CallsOnSeries>, Vec<(usize, Register)>) {
        let mut kept = IndexMap::new();
        let (mut families, mut places) = (IndexSet::new(), Vec::new());
        let mut found: Vec<CallsOnSeries> = Vec::new();
        let calls = core::mem::take(&mut self.calls);
        for call in &calls {
            let (family, is_new) = families.insert_full(call.family());
            if is_new {
                let call = call.on(|&x| self.argument(x, &mut kept));
                found.push(CallsOnSeries { call, by: Vec::new(), results: Vec::new() });
            }
            places.push((family, found[family].by.len()));
            found[family].by.push(call.derivatives.clone());
        }
        for (at, sum) in self.sums.iter().enumerate() {
            if let &Sum::Value(call, output) = sum {
                let (family, which) = places[call];
                found[family].results.push([which, output as usize, at]);
            }
        }
        (found, kept.into_iter().collect())
    }

    fn argument(&mut self, x: SeriesQuantity, kept: &mut IndexMap<usize, Register>) -> CallArgument {
        let first = self.first(x);
        if let Operation::Constant(bits) = self.schedule.operations[first.index()] {
            return CallArgument::Constant(bits);
        }
        CallArgument::Kept(kept.insert_full(self.argument_place(x), first).0)
    }

    /// Index of the entry of `sums` where the runtime stores the series of an argument.
    pub(super) fn argument_place(&mut self, x: SeriesQuantity) -> usize {
        self.sums.insert_full(Sum::Argument(x)).0
    }
}

impl Emitter<'_> {
    /// Emits the method that evaluates the functions on series. `None` if there are no calls.
    pub(super) fn series_functions(&self, calls: &[CallsOnSeries]) -> Option<TokenStream> {
        let scalar = self.style.types.scalar;
        let written = calls.iter().map(|calls| self.calls_on_series(calls));
        (!calls.is_empty()).then(|| {
            quote! {
                #[doc = "What the functions add to an order."]
                fn series_functions(&self, order: usize, arguments: &[__lagrange::PowerSeries<#scalar>], sums: &mut Self::Sums) {
                    #(#written)*
                }
            }
        })
    }

    fn calls_on_series(&self, CallsOnSeries { call, by, results }: &CallsOnSeries) -> TokenStream {
        let scalar = self.style.types.scalar;
        let series = quote!(__lagrange::PowerSeries<#scalar>);
        let by: Vec<&[u32]> = by.iter().map(|derivatives| &derivatives[..]).collect();
        let values = self.style.calls_on(&series, call, &by, |argument| match argument {
            CallArgument::Constant(bits) => {
                let value = Literal::f64_unsuffixed(f64::from_bits(*bits));
                quote!(__lagrange::Scalar::constant(#value))
            }
            CallArgument::Kept(place) => quote!(arguments[#place]),
        });
        let puts = results.iter().map(|&[which, output, place]| {
            let which = (by.len() > 1).then(|| quote!([#which]));
            quote!(sums[#place] = values #which [#output].coefficient(order);)
        });
        quote! {
            let values = #values;
            #(#puts)*
        }
    }

    /// Generics with bounds on the functions: series as arguments, and one derivative more than the equations of
    /// motion need. The compiler checks these bounds only where the trait is used.
    pub(super) fn generics_on_series(&self, slopes: &Program, calls: &[CallsOnSeries]) -> syn::Generics {
        let scalar = self.style.types.scalar;
        let called = slopes.schedule.calls.iter().map(|call| (call.function, call.derivatives.len()));
        let orders = orders_of(self.orders(&[]), called.chain(slopes.blocks.iter().map(SlopeBlock::order)));
        let mut generics = self.generics(&orders, calls.is_empty());
        let called = calls.iter().map(|CallsOnSeries { call, .. }| (call.function, call.derivatives.len()));
        let on_series = orders_of(BTreeMap::new(), called);
        self.ask_for(&mut generics, &on_series, &quote!(__lagrange::PowerSeries<#scalar>), false);
        generics
    }
}
