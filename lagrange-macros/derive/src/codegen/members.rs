//! Access to members of structs. A derive macro cannot see their types, so a trait of the runtime reads the numbers.
//! A missing member or a wrong type is then a compile error at the member in the attribute.

use proc_macro2::{Literal, Span, TokenStream};
use quote::{quote, quote_spanned};

use super::emitter::Emitter;
use super::inputs::Varying;
use super::style::FunctionContext;
use crate::resolve::Entry;
use crate::syntax::{Field, Inside, Property};

impl Emitter<'_> {
    /// Emits a function that reads one number of each member, whether the system uses it or not.
    pub(super) fn check_members(&self) -> Option<TokenStream> {
        let fields = 0..self.problem.parameters.fields.len();
        let reads = fields.filter_map(|field| {
            self.style.number_of_member(&quote!(system), Entry { field, number: 0 }, None)
        });
        let reads: Vec<TokenStream> = reads.collect();
        let ident = &self.declaration.ident;
        let generics = super::bounds::bounded_generics(self.declaration, &self.problem.scalar);
        let (impl_generics, type_generics, where_clause) = generics.split_for_impl();
        // The function is never called; it only makes the compiler check the types.
        (!reads.is_empty()).then(|| {
            quote! {
                #[allow(
                    dead_code, clippy::all, clippy::pedantic, clippy::nursery,
                    reason = "its types are checked, and nothing calls it"
                )]
                fn members #impl_generics(system: &#ident #type_generics) #where_clause {
                    #(let _ = #reads;)*
                }
            }
        })
    }
}

impl FunctionContext<'_> {
    /// Reads a number of a member of `owner`. `None` if the entry is not in a member.
    pub(super) fn number_of_member(
        &self,
        owner: &TokenStream,
        entry: Entry,
        varying: Option<&Varying>,
    ) -> Option<TokenStream> {
        let MemberNumber { span, of, shape, number } = self.member(owner, entry, varying)?;
        let scalar = &self.problem.scalar;
        Some(
            quote_spanned!(span=> __lagrange::generated::FieldMember::<#scalar, #shape>::number(&#of, #number)),
        )
    }

    pub(super) fn set_number_of_member(&self, entry: Entry, value: &TokenStream) -> Option<TokenStream> {
        let MemberNumber { span, of, shape, number } = self.member(&self.system, entry, None)?;
        let scalar = &self.problem.scalar;
        Some(quote_spanned! {span=>
            if !__lagrange::generated::FieldMember::<#scalar, #shape>::set(&mut #of, #number, #value) {
                return false;
            }
        })
    }

    fn member(&self, owner: &TokenStream, entry: Entry, varying: Option<&Varying>) -> Option<MemberNumber> {
        let field = &self.problem.parameters.fields[entry.field];
        let (last, shape) = (field.members.last()?, field.shape.as_ref().ok()?);
        let span = Span::call_site().located_at(last.ident.span());
        let indices = Varying::indices(varying, &self.problem.parameters.indices(entry));
        let inner = &shape.layout.lengths[last.after..];
        let number = Literal::usize_unsuffixed(entry.number % crate::syntax::numbers(inner));
        Some(MemberNumber {
            span,
            of: path(owner, field, &indices, span),
            shape: self.shape(entry.field, inner),
            number,
        })
    }

    /// Type by which the runtime recognizes the shape of a member.
    fn shape(&self, field: usize, lengths: &[usize]) -> TokenStream {
        let (scalar, parameters) = (&self.problem.scalar, &self.problem.parameters);
        let inside = parameters.fields[field].shape.as_ref().map(|shape| shape.layout.inside);
        match (lengths, inside) {
            (_, Ok(Inside::UnitQuaternion)) => quote!(__lagrange::nalgebra::UnitQuaternion<#scalar>),
            ([size, _], _) if parameters.property(field) == Some(Property::Rotation) => {
                quote!(__lagrange::nalgebra::Rotation<#scalar, #size>)
            }
            ([length], _) => quote!([#scalar; #length]),
            ([rows, columns, ..], _) => quote!([[#scalar; #columns]; #rows]),
            ([], _) => quote!(#scalar),
        }
    }
}

/// A member, and the index of a number in it.
struct MemberNumber {
    span: Span,
    of: TokenStream,
    shape: TokenStream,
    number: Literal,
}

/// Place expression such as `self.link[2].c`. All its tokens have the given span.
fn path(owner: &TokenStream, field: &Field, indices: &[TokenStream], span: Span) -> TokenStream {
    let mut root = field.ident.clone();
    root.set_span(span);
    let owner: TokenStream = owner
        .clone()
        .into_iter()
        .map(|mut token| {
            token.set_span(span);
            token
        })
        .collect();
    let (mut place, mut from) = (quote_spanned!(span=> #owner.#root), 0);
    for member in &field.members {
        let (ident, after) = (&member.ident, member.after);
        let arrays = &indices[from..after];
        place = quote_spanned!(span=> #place #([#arrays])*.#ident);
        from = after;
    }
    place
}
