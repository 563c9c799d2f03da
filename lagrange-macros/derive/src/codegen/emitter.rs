//! Context of the emission of one system, shared by all emitted traits.

use proc_macro2::{Group, TokenStream, TokenTree};
use quote::quote;

use super::count::OPERATION_LIMIT;
use super::kernel::{Kernel, Part};
use super::solving::Solving;
use super::style::FunctionContext;
use crate::facts::Facts;
use crate::mechanics::Derived;
use crate::render::Rendered;
use crate::resolve::{self, Problem};
use crate::syntax::Declaration;

/// System to be emitted.
pub(super) struct Emitter<'a> {
    pub(super) declaration: &'a Declaration,
    pub(super) problem: &'a Problem,
    pub(super) derived: &'a Derived,
    pub(super) rendered: &'a Rendered,
    pub(super) facts: &'a Facts,
    pub(super) solving: Solving,
    pub(super) style: FunctionContext<'a>,
}

impl Emitter<'_> {
    /// Emits the parts that long functions call: modules, to stand beside the struct, and methods.
    ///
    /// rustc compiles a method in the unit of the module that has its type. All that is emitted for the struct would be one
    /// unit, so each part is a method of a type in a module of its own. The module names nothing of the user's, as it could not
    /// within a function.
    pub(super) fn parts_of<'k>(
        &self,
        kernels: impl Iterator<Item = &'k Kernel>,
        generics: &syn::Generics,
    ) -> [TokenStream; 2] {
        let (_, type_generics, _) = self.declaration.generics.split_for_impl();
        let ident = &self.declaration.ident;
        let system = quote!(#ident #type_generics);
        let (impl_generics, _, where_clause) = generics.split_for_impl();
        let [impl_generics, where_clause] =
            [quote!(#impl_generics), quote!(#where_clause)].map(|tokens| without_self(tokens, &system));
        let parts = kernels.flat_map(|kernel| &kernel.parts).map(|part| {
            let Part { module, name, doc, generics, arguments, body } = part;
            let of_type = quote! {
                #[allow(dead_code, non_snake_case, reason = "the type only has methods, and the name is that of the part")]
                mod #module {
                    pub(super) struct Part<S: ?Sized>(::core::marker::PhantomData<S>);
                }
            };
            let method = quote! {
                #[automatically_derived]
                #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens)]
                impl #impl_generics #module::Part<#system> #where_clause {
                    #[doc = #doc]
                    #[inline(never)]
                    #[allow(unused_variables)]
                    fn #name #generics(__system: &#system, #arguments) {
                        #body
                    }
                }
            };
            (of_type, method)
        });
        let (modules, methods) = parts.unzip();
        [modules, methods]
    }
}

impl Emitter<'_> {
    /// Emits the implementation of a trait of the runtime.
    pub(super) fn implementation(
        &self,
        name: &TokenStream,
        generics: &syn::Generics,
        items: &TokenStream,
    ) -> TokenStream {
        let (impl_generics, _, where_clause) = generics.split_for_impl();
        let (_, type_generics, _) = self.declaration.generics.split_for_impl();
        let ident = &self.declaration.ident;
        quote! {
            #[automatically_derived]
            #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens)]
            impl #impl_generics __lagrange::#name for #ident #type_generics #where_clause {
                #items
            }
        }
    }

    /// Emits implementations in a scope of their own, with the parts of their long functions.
    pub(super) fn in_scope<'k>(
        &self,
        kernels: impl Iterator<Item = &'k Kernel>,
        generics: &syn::Generics,
        items: &TokenStream,
    ) -> TokenStream {
        let ([modules, parts], runtime) = (self.parts_of(kernels, generics), runtime(self.declaration));
        quote! {
            #modules

            const _: () = {
                // Import a single name that users will not choose.
                use #runtime as __lagrange;

                #items
                #parts
            };
        }
    }
}

/// Replaces `Self` by the type of the system.
fn without_self(tokens: TokenStream, system: &TokenStream) -> TokenStream {
    let replaced = |token| match token {
        TokenTree::Ident(word) if word == "Self" => system.clone(),
        TokenTree::Group(group) => {
            let inner = without_self(group.stream(), system);
            TokenTree::Group(Group::new(group.delimiter(), inner)).into()
        }
        other => other.into(),
    };
    tokens.into_iter().map(replaced).collect()
}

/// Emitted methods, with their kernels.
pub(super) struct Written {
    pub(super) tokens: TokenStream,
    pub(super) kernels: Vec<Kernel>,
}

impl FromIterator<Self> for Written {
    fn from_iter<I: IntoIterator<Item = Self>>(all: I) -> Self {
        let (mut tokens, mut kernels) = (TokenStream::new(), Vec::new());
        for written in all {
            tokens.extend(written.tokens);
            kernels.extend(written.kernels);
        }
        Self { tokens, kernels }
    }
}

pub(super) fn too_long(declaration: &Declaration, what: &str) -> String {
    let loops = resolve::loops_instead(&declaration.coordinates);
    format!(
        "{what}: more than the {OPERATION_LIMIT} that one function may have. Name what recurs with `#[define(…)]`, recursively along chains, so that it is shared, or take coordinates with constraints between them{loops}"
    )
}

/// Path of the runtime crate.
pub(super) fn runtime(declaration: &Declaration) -> TokenStream {
    declaration.options.runtime.clone().unwrap_or_else(|| quote!(::lagrange_core))
}
