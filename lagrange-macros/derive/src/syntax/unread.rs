//! Guesses the names and the shape of tokens that are not a valid expression. Later stages need both to avoid
//! follow-up errors.

use std::iter::from_fn;

use proc_macro2::{Delimiter, Group, Ident, Span, TokenTree};

use super::cursor::Cursor;
use super::expression::{Expression, Kind, Operator};
use super::name::Name;
use super::number::{number, suffix};
use crate::diagnostics::Place;

/// Returns the product of all names, calls, elements and vectors in the tokens. The product is a vector if one factor
/// is.
pub(super) fn unread(mut cursor: Cursor) -> Expression {
    let whole = cursor.place();
    let mut factors = Vec::new();
    while !cursor.is_empty() {
        let place = cursor.place();
        let kind = factor(&mut cursor, place);
        factors.extend(kind.map(|kind| (Operator::Times, Expression { kind, place })));
    }
    Expression { kind: Kind::Product(factors), place: whole }
}

fn factor(cursor: &mut Cursor, place: Place) -> Option<Kind> {
    let ident = match cursor.take_ident() {
        Some(ident) => ident,
        None => match cursor.next()? {
            TokenTree::Group(group) if group.delimiter() == Delimiter::Bracket => {
                return Some(Kind::Vector(items(&group)));
            }
            TokenTree::Group(group) => return Some(unread(Cursor::inside(&group)).kind),
            TokenTree::Literal(literal) => match number(&literal, place) {
                Ok(value) => return Some(Kind::Number(value)),
                // `2x`: keep the name, drop the number.
                Err(_) => identifier(suffix(&literal.to_string()), literal.span())?,
            },
            _ => return None,
        },
    };
    let name = Name::new(&ident);
    let mut kind = match cursor.take_group(Delimiter::Parenthesis) {
        Some(group) => Kind::Call(name, items(&group)),
        None => Kind::Name(name),
    };
    // Keep at most two indices, as a matrix has, and so bound the nesting.
    for brackets in from_fn(|| cursor.take_group(Delimiter::Bracket)).take(2) {
        let index = Box::new(unread(Cursor::inside(&brackets)));
        kind = Kind::Index(Box::new(Expression { kind, place }), index);
    }
    Some(kind)
}

fn items(group: &Group) -> Vec<Expression> {
    let mut inside = Cursor::inside(group);
    let mut items = Vec::new();
    while !inside.is_empty() {
        items.push(unread(inside.until_comma()));
    }
    items
}

fn identifier(text: &str, span: Span) -> Option<Ident> {
    let mut ident = syn::parse_str::<Ident>(text).ok()?;
    ident.set_span(span);
    Some(ident)
}
