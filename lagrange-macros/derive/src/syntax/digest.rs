//! Hash that identifies a system. The runtime uses it to recognize results of another system.

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{Attribute, Ident};

use super::field::Field;

/// 32-bit FNV-1a hash of the names of the struct and its fields, in their order, and of the tokens of these attributes.
/// Whitespace, comments and the types of fields, including array lengths, do not affect it.
pub(super) fn digest<'a>(
    ident: &Ident,
    fields: &[Field],
    attributes: impl Iterator<Item = &'a Attribute>,
) -> u32 {
    let names = [ident].into_iter().chain(fields.iter().map(|field| &field.ident));
    let of_names = names.fold(0x811c_9dc5, |hash, name| text(hash, &name.to_string()));
    attributes.fold(of_names, |hash, attribute| tokens(hash, attribute.meta.to_token_stream()))
}

fn tokens(hash: u32, stream: TokenStream) -> u32 {
    stream.into_iter().fold(hash, |hash, token| match token {
        TokenTree::Group(group) => {
            let inside = tokens(text(hash, &format!("{:?}", group.delimiter())), group.stream());
            text(inside, "end")
        }
        token => text(hash, &token.to_string()),
    })
}

/// Hashes the text and an end marker, a byte that never occurs in UTF-8.
fn text(hash: u32, text: &str) -> u32 {
    text.bytes().chain([0xff]).fold(hash, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[cfg(test)]
mod tests {
    use crate::diagnostics::Diagnostics;

    fn digest(source: &str) -> u32 {
        let input = syn::parse_str(source).expect("a struct");
        crate::syntax::declaration(input, &mut Diagnostics::default()).digest
    }

    const SPRING: &str =
        "#[coordinates(x)] #[lagrangian(m/2*x_dot^2 - k/2*x^2)] struct Spring { m: f64, k: f64 }";

    #[test]
    fn what_moves_it_counts_and_nothing_else() {
        for same in [
            SPRING.replace('*', " * "),
            format!("/// A spring.\n#[derive(Clone)] #[observable(strain = k*x)] {SPRING}"),
            SPRING.replace("m: f64", "/// In kg.\npub m: f64"),
        ] {
            assert_eq!(digest(&same), digest(SPRING), "{same}");
        }
        for other in [
            SPRING.replace('-', "+"),
            SPRING.replace("Spring", "String"),
            SPRING.replace("m: f64, k: f64", "k: f64, m: f64"),
            SPRING.replace("k/2*x^2", "k/(2*x^2)"),
            format!("#[force(x: k)] {SPRING}"),
        ] {
            assert_ne!(digest(&other), digest(SPRING), "{other}");
        }
    }
}
