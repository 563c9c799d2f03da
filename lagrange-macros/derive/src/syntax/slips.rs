//! Common mistakes, such as Rust syntax that the language lacks, and messages that suggest a correction.

use proc_macro2::{Delimiter, TokenTree};
use syn::Result;

use super::cursor::Cursor;
use crate::diagnostics::Place;

/// Rejects a product without its sign, such as `2 (x + y)`.
pub(super) fn reject_adjacent(cursor: &Cursor) -> Result<()> {
    match cursor.peek() {
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis => {
            Err(cursor.error(
                "a product needs its sign: write `*` before the parenthesis (and `sin(x)^2` for a power of a function)",
            ))
        }
        _ => Ok(()),
    }
}

/// Rejects Rust keywords. A raw identifier such as `r#loop` is a name.
pub(super) fn reject_keyword(ident: &str, place: Place) -> Result<()> {
    let message = match ident {
        "if" | "else" | "match" => {
            "the Lagrangian is one smooth expression: there is no branching (`abs`, `sqrt` and `tanh` may serve)"
        }
        "let" => "intermediate quantities are written `#[define(name = expression)]`",
        "self" => "fields are named without `self`",
        "true" | "false" => "there are no truth values here: an expression is a number",
        "for" | "while" | "loop" => "repetition is written `sum(i in 0..3, expression)`",
        "as" => AS,
        _ => return Ok(()),
    };
    Err(place.error(message))
}

const AS: &str = "numbers are exact and have no type: leave `as` out";

/// Error for a token that can neither begin nor continue an expression, with a suggestion.
pub(super) fn unexpected(cursor: &Cursor) -> syn::Error {
    let message = match cursor.peek() {
        None => "expected an expression",
        Some(TokenTree::Punct(punct)) => return unexpected_sign(cursor, punct.as_char()),
        Some(TokenTree::Ident(word)) if word == "as" => AS,
        Some(TokenTree::Literal(_) | TokenTree::Ident(_)) => {
            "two factors stand side by side: a product needs its sign `*`, a function its parentheses `sin(x)`"
        }
        Some(TokenTree::Group(_)) => "unexpected group: a product needs its sign `*`",
    };
    cursor.error(message)
}

fn unexpected_sign(cursor: &Cursor, sign: char) -> syn::Error {
    let message = match sign {
        '=' => {
            let place = if cursor.is_pair('=', '=') { cursor.pair_place() } else { cursor.place() };
            return place.error(
                "an equation belongs into `#[constraint(name: left = right)]`; here an expression is expected",
            );
        }
        '|' => "the absolute value is written `abs(x)`, and there is no logic here",
        '<' | '>' | '!' | '&' => {
            "there are no comparisons or logic here: expressions are smooth, and constraints are equations; a gap that is never negative is a contact, `#[contact(name: gap >= 0)]`, and where a motion reaches a bound is an event, `system.event(…)`"
        }
        '.' => return unexpected_point(cursor),
        ':' if cursor.is_pair(':', ':') => {
            return cursor.pair_place().error("there are no paths here: write `pi`, `sin(x)`");
        }
        '%' => "there is no remainder: the expression must be smooth",
        other => return cursor.error(format!("unexpected `{other}`")),
    };
    cursor.error(message)
}

fn unexpected_point(cursor: &Cursor) -> syn::Error {
    if cursor.is_pair('.', '.') {
        return cursor.pair_place().error(
            "a range has both its ends, and stands in a slice `v[0..3]` or in `sum(i in 0..3, expression)`",
        );
    }
    let message = match (cursor.last(), cursor.follower()) {
        (_, Some(TokenTree::Literal(_))) => "a number begins with a digit: write `0.5`",
        (Some(TokenTree::Literal(_)), _) => {
            "a product needs its sign, and an exponent a digit before it: write `2.0*x`, `2.0e3`"
        }
        _ => {
            "there are no methods here, and members only of fields that are structs: write `sin(x)` for `x.sin()`, `r[0]` for `r.x`, `m` for `self.m`"
        }
    };
    cursor.error(message)
}

/// A message, with the word that was meant if the next one is a slip of it.
pub(super) fn meant(cursor: &Cursor, words: &[&str], message: &str) -> String {
    let Some(written) = cursor.clone().take_ident().map(|ident| ident.to_string()) else {
        return message.to_owned();
    };
    let distance = |word: &&&str| strsim::damerau_levenshtein(&written, word);
    match words.iter().min_by_key(distance).filter(|word| (1..=2).contains(&distance(word))) {
        Some(word) => format!("did you mean `{word}`? {message}"),
        None => message.to_owned(),
    }
}
