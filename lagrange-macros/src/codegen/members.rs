//! Numbers in members of structs. A derive cannot see their types: a trait of the runtime reads them, so that a member
//! that is missing, or is something else than is said, is an error where it is said.

use proc_macro2::{Literal, Span, TokenStream};
use quote::{quote, quote_spanned};

use super::emitter::Emitter;
use super::inputs::Varying;
use super::style::FunctionContext;
use crate::resolve::Entry;
use crate::syntax::{Field, Inside, Property};

impl Emitter<'_> {
    /// Reads one number of each member, whether the system uses it or not.
    pub(super) fn check_members(&self) -> Option<TokenStream> {
        let fields = 0..self.problem.parameters.fields.len();
        let reads = fields.filter_map(|field| {
            self.style.number_of_member(&quote!(system), Entry { field, number: 0 }, None)
        });
        let reads: Vec<TokenStream> = reads.collect();
        let ident = &self.declaration.ident;
        let generics = super::bounds::bounded_generics(self.declaration, &self.problem.scalar);
        let (impl_generics, type_generics, where_clause) = generics.split_for_impl();
        // Never called: the compiler checks the types of its body.
        (!reads.is_empty()).then(|| {
            quote! {
                #[allow(dead_code, clippy::all, clippy::pedantic, clippy::nursery)]
                fn members #impl_generics(system: &#ident #type_generics) #where_clause {
                    #(let _ = #reads;)*
                }
            }
        })
    }
}

impl FunctionContext<'_> {
    /// A number of a member of `owner`, where this is one.
    pub(super) fn number_of_member(
        &self,
        owner: &TokenStream,
        entry: Entry,
        varying: Option<&Varying>,
    ) -> Option<TokenStream> {
        let MemberNumber { span, of, shape, number } = self.member(owner, entry, varying)?;
        let scalar = &self.problem.scalar;
        Some(quote_spanned!(span=> __lagrange::generated::Member::<#scalar, #shape>::number(&#of, #number)))
    }

    pub(super) fn set_number_of_member(&self, entry: Entry, value: &TokenStream) -> Option<TokenStream> {
        let MemberNumber { span, of, shape, number } = self.member(&quote!(self), entry, None)?;
        let scalar = &self.problem.scalar;
        Some(quote_spanned! {span=>
            if !__lagrange::generated::Member::<#scalar, #shape>::set(&mut #of, #number, #value) {
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

    /// What the runtime takes for the shape of a member.
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

/// A member, and which of its numbers.
struct MemberNumber {
    span: Span,
    of: TokenStream,
    shape: TokenStream,
    number: Literal,
}

/// `self.link[2].c`, with what is not in the user's words in their place.
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
