//! Emits the implementation of `System`.

use proc_macro2::TokenStream;
use quote::quote;

/// Emits the items of the implementation.
pub(super) fn moving(scalar: &syn::Type, constraints: usize) -> TokenStream {
    let view = quote!(__lagrange::generic::ViewOf<Self::Scalar, Self::Length>);
    quote! {
        type Scalar = #scalar;
        type Length = <Self as __lagrange::Lagrangian>::N;
        type M = __lagrange::nalgebra::Const<#constraints>;
        type Field = __lagrange::motion::LagrangianVectorField;

        #[inline(always)]
        fn length(&self) -> Self::Length {
            __lagrange::nalgebra::Const
        }

        #[inline]
        fn accelerations(&self, t: Self::Scalar, q: &#view, v: &#view, a: &mut #view) {
            __lagrange::generated::write_accelerations(self, t, [q, v], a);
        }
    }
}
