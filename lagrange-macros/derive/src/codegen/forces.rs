//! Emits the derivatives of the forces of a system with contacts, which time steps take.

use proc_macro2::TokenStream;
use quote::quote;

use super::bounds::FUNCTION_ORDER;
use super::emitter::Emitter;
use super::linearized::Changing;
use super::shape::ResultShape;
use super::signature::{Types, wide};
use super::slopes::SlopeLayout;
use crate::contract::{Argument, Dimension};
use crate::mechanics::Linearization;

impl Emitter<'_> {
    /// Emits `ForceDerivatives`. `None` if there are no contacts, if a function is too long, or if the derivatives exceed the order
    /// that user-supplied functions have.
    pub(super) fn force_derivatives(
        &self,
        linearization: &Linearization,
        changing: &Changing,
    ) -> Option<TokenStream> {
        let n = linearization.forces.len();
        let orders = self.orders(&linearization.forces);
        (n > 0 && orders.values().all(|&order| order <= FUNCTION_ORDER)).then_some(())?;
        let [slopes, changes] = &changing.of_forces;
        let (wide, layout) = (wide(), SlopeLayout::of(self.problem, slopes));
        let (numbers, count) = (slopes.results.len(), layout.length);
        let of_slopes = self.style.write("force_slopes", slopes, &[ResultShape::Vector(numbers)]);
        let over = self.style.over(&wide, layout);
        let of_changes = over.write("force_change_with", changes, &[ResultShape::Vector(n)]);
        let kernels = [&of_slopes, &of_changes];
        kernels.iter().all(|kernel| kernel.refused.is_none()).then_some(())?;
        let generics = self.generics(&orders, false);
        let types = self.style.types;
        let (scalar, state, over) = (types.scalar, types.argument(Argument::State), types.over());
        let types = Types { scalar: &wide, ..types };
        let [direction, vector] = [types.argument(Argument::Direction), types.vector(Dimension::Coordinates)];
        let arguments = changing.force_arguments.iter();
        let found = self.style.slopes(slopes, &of_slopes.results);
        let [slopes, changes] = kernels.map(|kernel| &kernel.statements);
        let changed = &of_changes.results;
        let items = quote! {
            type ForceSlopes = [#scalar; #count];
            const FORCE_ARGUMENTS: &'static [usize] = &[#(#arguments),*];

            #[allow(unused_variables)]
            fn force_slopes(&self, #state) -> Self::ForceSlopes {
                #slopes
                #found
            }

            #[allow(unused_variables)]
            fn force_change_with #over(&self, slopes: &Self::ForceSlopes, #direction) -> #vector {
                #changes
                __lagrange::generated::vector(#(#changed)*)
            }
        };
        let items = self.implementation(&quote!(contact::ForceDerivatives), &generics, &items);
        Some(self.in_scope(kernels.into_iter(), &generics, &items))
    }
}
