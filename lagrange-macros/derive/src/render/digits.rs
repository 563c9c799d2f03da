//! Decimal digits of numbers.

use crate::symbolic::{Rational, finite_decimal};

/// A finite decimal such as 9.81. Fractions with a denominator below 16 are easier to read as fractions.
pub(super) fn decimal(value: Rational) -> Option<String> {
    if *value.denom() < 16 { None } else { finite_decimal(value).map(point) }
}

/// Digits with a decimal point before the last `places` of them.
pub(super) fn point((digits, places): (i128, u32)) -> String {
    let places = places as usize;
    let text = format!("{digits:0>width$}", width = places + 1);
    let (whole, fraction) = text.split_at(text.len() - places);
    match fraction.trim_end_matches('0') {
        "" => whole.to_owned(),
        fraction => format!("{whole}.{fraction}"),
    }
}
