//! Emits `Pack`, which converts a struct to another number type: several systems side by side, one per SIMD lane.

use proc_macro2::{Group, Ident, Span, TokenStream, TokenTree};
use quote::{ToTokens, quote, quote_spanned};
use syn::spanned::Spanned;

use super::bounds::bounded_generics;
use crate::syntax::{Declaration, Field};

/// Emits the implementation of `Pack`. `None` if the number type is not a type parameter and so cannot be replaced.
pub(super) fn pack(declaration: &Declaration, scalar: &syn::Type) -> Option<TokenStream> {
    let name = scalar.to_token_stream().to_string();
    let parameter = declaration.generics.type_params().find(|parameter| parameter.ident == name)?;
    let exchange = Exchange { from: &parameter.ident, to: Ident::new("__Lanes", Span::mixed_site()) };
    let fields = || declaration.fields.iter();
    let mut generics = bounded_generics(declaration, scalar);
    exchange.extend(&mut generics, parameter);
    let bounds = fields().map(|field| exchange.bound(field));
    generics.make_where_clause().predicates.extend(bounds);
    let (impl_generics, _, where_clause) = generics.split_for_impl();
    let (_, type_generics, _) = declaration.generics.split_for_impl();
    let (ident, lanes) = (&declaration.ident, &exchange.to);
    let packed = exchange.apply(quote!(#type_generics));
    let inits = fields().map(|field| exchange.init(field));
    let shared = fields().filter(|field| !exchange.concerns(field)).map(|field| &field.ident);
    let places = fields().filter(|field| exchange.concerns(field)).map(|field| exchange.place(field));
    Some(quote! {
        #[automatically_derived]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_variables, unused_lifetimes)]
        impl #impl_generics __lagrange::Pack<#lanes> for #ident #type_generics #where_clause {
            type Packed = #ident #packed;

            #[inline]
            fn pack(&self) -> Self::Packed {
                #ident { #(#inits),* }
            }

            #[inline]
            fn place(&self, packed: &mut Self::Packed, lane: usize) -> bool {
                let fits = true #(&& ::core::cmp::PartialEq::eq(&self.#shared, &packed.#shared))*;
                if fits {
                    #(#places)*
                }
                fits
            }
        }
    })
}

/// Replaces one type parameter by another.
struct Exchange<'a> {
    from: &'a Ident,
    to: Ident,
}

impl Exchange<'_> {
    fn apply(&self, tokens: TokenStream) -> TokenStream {
        tokens.into_iter().map(|token| self.apply_to(token)).collect()
    }

    fn apply_to(&self, token: TokenTree) -> TokenTree {
        match token {
            TokenTree::Ident(ident) if ident == *self.from => TokenTree::Ident(self.to.clone()),
            TokenTree::Group(group) => {
                let mut exchanged = Group::new(group.delimiter(), self.apply(group.stream()));
                exchanged.set_span(group.span());
                TokenTree::Group(exchanged)
            }
            token => token,
        }
    }

    /// True if the type of the field contains the type parameter.
    fn concerns(&self, field: &Field) -> bool {
        let ty = &field.ty;
        self.apply(quote!(#ty)).to_string() != quote!(#ty).to_string()
    }

    /// Adds the new type parameter with the bounds of the old one.
    fn extend(&self, generics: &mut syn::Generics, parameter: &syn::TypeParam) {
        let (to, bounds) = (&self.to, &parameter.bounds);
        let bounds = self.apply(quote!(#bounds));
        generics.params.push(syn::parse_quote!(#to: __lagrange::Scalar));
        let clause = generics.make_where_clause();
        let written = clause.predicates.iter().map(|predicate| self.apply(quote!(#predicate)));
        let mut written: Vec<syn::WherePredicate> =
            written.map(|tokens| syn::parse_quote!(#tokens)).collect();
        written.push(syn::parse_quote!(#to: #bounds));
        clause.predicates.extend(written);
    }

    /// Bound on the type of a field. The quantifier defers the check to the use of lanes. Without it, a bound that
    /// fails would be an error even in programs that use none.
    fn bound(&self, field: &Field) -> syn::WherePredicate {
        let ty = &field.ty;
        let packed = self.apply(quote!(#ty));
        let tokens = match self.concerns(field) {
            true => quote_spanned!(ty.span()=> for<'__any> #packed: __lagrange::Packed<#ty>),
            false => quote_spanned!(ty.span()=> for<'__any> #ty: __lagrange::Shared),
        };
        syn::parse_quote!(#tokens)
    }

    /// Initializes a field with its numbers broadcast to all lanes.
    fn init(&self, field: &Field) -> TokenStream {
        let Field { ident, ty, .. } = field;
        let packed = self.apply(quote!(#ty));
        match self.concerns(field) {
            true => quote!(#ident: <#packed as __lagrange::Packed<#ty>>::splat(&self.#ident)),
            false => quote!(#ident: ::core::clone::Clone::clone(&self.#ident)),
        }
    }

    fn place(&self, field: &Field) -> TokenStream {
        let Field { ident, ty, .. } = field;
        let packed = self.apply(quote!(#ty));
        quote!(<#packed as __lagrange::Packed<#ty>>::place(&mut packed.#ident, lane, &self.#ident);)
    }
}
