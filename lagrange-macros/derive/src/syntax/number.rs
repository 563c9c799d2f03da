//! Number literals.

use proc_macro2::Literal;
use syn::Result;

use crate::diagnostics::Place;
use crate::symbolic::{Scaled, parse_decimal};

pub(super) fn number(literal: &Literal, place: Place) -> Result<Scaled> {
    let text = literal.to_string();
    let unsigned = text.strip_prefix('-').unwrap_or(&text);
    if !unsigned.starts_with(|c: char| c.is_ascii_digit()) {
        return Err(place.error("text and characters have no meaning here: write a number or a name"));
    }
    if ["0x", "0o", "0b"].iter().any(|prefix| unsigned.starts_with(prefix)) {
        return Err(place.error("numbers are written in decimal"));
    }
    let length = number_length(unsigned);
    let (digits, suffix) = unsigned.split_at(length);
    if !suffix.is_empty() {
        return Err(place.error(suffix_message(digits, suffix)));
    }
    parse_decimal(&text).ok_or_else(|| place.error(refusal(digits)))
}

/// Returns the name after the number, as in `2x`, a product without its sign.
pub(super) fn suffix(literal: &str) -> &str {
    literal[number_length(literal)..].trim_start_matches('_')
}

/// Reason why a number cannot be represented.
fn refusal(digits: &str) -> &'static str {
    match digits.replace('_', "").parse::<f64>() {
        Ok(value) if value.is_infinite() => "this number is beyond the largest `f64`, about 1.8e308",
        _ => "this number is closer to zero than an `f64` can be exactly, about 2.2e-308",
    }
}

/// Length of the number in a literal, without its suffix, in bytes.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(|b| b.is_ascii_digit() || *b == b'_' || *b == b'.') {
            at += 1;
        }
        at
    };
    let mantissa = digits(0);
    if !matches!(bytes.get(mantissa), Some(b'e' | b'E')) {
        return mantissa;
    }
    let sign = usize::from(matches!(bytes.get(mantissa + 1), Some(b'+' | b'-')));
    let end = digits(mantissa + 1 + sign);
    if end > mantissa + 1 + sign { end } else { mantissa }
}

fn suffix_message(digits: &str, suffix: &str) -> String {
    let digits = digits.trim_end_matches('_');
    if ["f64", "f32", "i8", "i16", "i32", "i64", "u8", "u16", "u32", "u64", "usize", "isize"]
        .contains(&suffix)
    {
        format!("numbers are exact and have no type: write `{digits}`")
    } else {
        format!("a product needs its sign: write `{digits}*{}`", suffix.trim_start_matches('_'))
    }
}
