//! Emits the implementation of `TaylorSeries`: the programs that compute one order of the Taylor coefficients of a
//! motion.

mod coefficients;
mod functions;
mod recurrences;
mod sides;
mod steep;
mod sums;
mod supplied;

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::count::OPERATION_LIMIT;
use super::emitter::{Emitter, Written};
use super::operation::Register;
use super::passes::Program;
use super::shape::ResultShape;
use super::slopes::SlopeLayout;
use crate::contract::{Method, Quantity, TAYLOR_SERIES};
use crate::mechanics::Equations;
use crate::symbolic::Graph;
use coefficients::Recurrences;
use supplied::CallsOnSeries;

/// Number of convolution sums that the runtime computes side by side, one per SIMD lane.
const WIDTH: usize = 4;

/// Programs for one order of the Taylor coefficients.
pub(super) struct TaylorPrograms {
    /// Computes the numbers of order 0 that the programs of all later orders read.
    slopes: Program,
    /// Computes the right-hand sides for the coefficients of order k of accelerations and multipliers, and
    /// the parts of the factors of the sums that do not depend on these.
    right_hand_sides: Program,
    /// Computes the coefficients of order k of the factors of each sum.
    factors: Program,
    /// Number of sums, padded to a multiple of [`WIDTH`].
    pub(super) sums: usize,
    /// Number of values that `right_hand_sides` passes to `factors`: parts of the coefficients of order k
    /// that do not depend on the accelerations and multipliers of order k.
    pub(super) terms: usize,
    /// For each root: index of a sum whose right factor is the root, and index of its value of order 0 in the results
    /// of `slopes`.
    roots: Vec<[usize; 2]>,
    /// For each argument of a user-supplied function: index of a sum whose left factor is that argument, and index of
    /// its value of order 0 in the results of `slopes`.
    arguments: Vec<[usize; 2]>,
    /// For each argument of a [steep] function: index of a sum whose left factor is that argument, index
    /// of its value in the results of `slopes`, and the exponent of a power, else 0.
    steep: Vec<[usize; 3]>,
    calls: Vec<CallsOnSeries>,
}

impl TaylorPrograms {
    /// Builds the programs. `None` if an operation in the equations of motion has no Taylor series, or if a program
    /// is too long.
    pub(super) fn new(graph: &Graph, equations: &Equations) -> Option<Self> {
        let mut recurrences = Recurrences::new(equations.balance.len());
        let mut rest = recurrences.right_hand_sides(graph, equations)?;
        let (calls, arguments) = recurrences.calls();
        let steep = recurrences.steep();
        let sums = recurrences.sums.len().next_multiple_of(WIDTH);
        let (known, factors) = recurrences.factors(sums);
        rest.extend(&known);
        let Recurrences { schedule, roots, .. } = recurrences;
        let values = roots.iter().chain(&arguments).map(|&(_, value)| value);
        let kept: Vec<Register> = values.chain(steep.iter().map(|&(_, value)| value)).collect();
        let (slopes, [right_hand_sides, factors], kept) =
            Program::of_orders(schedule, [rest, factors], &kept);
        let mut kept = kept.into_iter();
        let mut with_slopes = |all: Vec<(usize, Register)>| {
            all.into_iter().zip(&mut kept).map(|((place, _), slope)| Some([place, slope?])).collect()
        };
        let (roots, arguments): (Option<_>, Option<_>) = (with_slopes(roots), with_slopes(arguments));
        let steep: Option<_> = steep
            .into_iter()
            .zip(kept)
            .map(|(([place, exponent], _), slope)| Some([place, slope?, exponent]))
            .collect();
        let series = Self {
            slopes,
            right_hand_sides: right_hand_sides.balanced().fused(),
            factors: factors.balanced().fused(),
            sums,
            terms: known.len(),
            roots: roots?,
            arguments: arguments?,
            steep: steep?,
            calls,
        };
        let is_short = |program: &Program| program.count().total() <= OPERATION_LIMIT;
        let are_short = [&series.slopes, &series.right_hand_sides, &series.factors].into_iter().all(is_short);
        are_short.then_some(series)
    }

    /// Number of values of order 0.
    pub(super) fn slopes(&self) -> usize {
        self.slopes.results.len()
    }
}

/// Declares an associated constant that holds rows of indices. `None` if there are no rows.
fn places<const K: usize>(name: &str, all: &[[usize; K]]) -> Option<TokenStream> {
    let name = format_ident!("{name}");
    let rows = all.iter().map(|row| quote!([#(#row),*]));
    (!all.is_empty()).then(|| quote!(const #name: &'static [[usize; #K]] = &[#(#rows),*];))
}

impl Emitter<'_> {
    /// Emits the implementation of `TaylorSeries`.
    pub(super) fn taylor_series(&self, series: &TaylorPrograms) -> TokenStream {
        let layout = SlopeLayout::of(self.problem, &series.slopes);
        let slopes = layout.length;
        let style = self.style.reading(layout);
        let (n, m) = (self.problem.coordinates.len(), self.problem.constraints.len());
        let TaylorPrograms { sums, terms, .. } = *series;
        let of_order = |method: &Method, program: &Program, shapes: &[usize]| {
            let kernel = style.write(
                method.name,
                program,
                &shapes.iter().map(|&length| ResultShape::Vector(length)).collect::<Vec<_>>(),
            );
            self.function(method, kernel, |results| match results {
                [forcing, bias, terms] => {
                    let sides = [forcing, bias].map(|side| quote!(__lagrange::generated::vector(#side)));
                    quote!(((#(#sides),*), #terms))
                }
                _ => quote!([#(#results),*]),
            })
        };
        let write = |method: &Method| match method.quantity {
            Quantity::SeriesSlopes => self.slopes(method, &series.slopes),
            Quantity::SeriesRightHandSides => of_order(method, &series.right_hand_sides, &[n, m, terms]),
            _ => of_order(method, &series.factors, &[sums; 2]),
        };
        let Written { tokens, kernels } = TAYLOR_SERIES.iter().map(write).collect();
        let generics = self.generics_on_series(&series.slopes, &series.calls);
        let scalar = style.types.scalar;
        let [roots, arguments] = [("ROOTS", &series.roots), ("ARGUMENTS", &series.arguments)]
            .map(|(name, pairs)| places(name, pairs));
        let steep = places("STEEP", &series.steep);
        let functions = self.series_functions(&series.calls);
        let items = quote! {
            type SeriesSlopes = [#scalar; #slopes];
            type Sums = [#scalar; #sums];
            type SeriesTerms = [#scalar; #terms];
            #roots
            #arguments
            #steep
            #tokens
            #functions
        };
        let items = self.implementation(&quote!(TaylorSeries), &generics, &items);
        self.in_scope(kernels.iter(), &generics, &items)
    }
}
