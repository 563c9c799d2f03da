//! Numbers as digits.

use crate::symbolic::{Rational, finite_decimal};

/// A finite decimal such as 9.81; simple fractions are read better as such.
pub(super) fn decimal(value: Rational) -> Option<String> {
    if *value.denom() < 16 { None } else { finite_decimal(value).map(point) }
}

/// Digits, with so many of them after the point.
pub(super) fn point((digits, places): (i128, u32)) -> String {
    let places = places as usize;
    let text = format!("{digits:0>width$}", width = places + 1);
    let (whole, fraction) = text.split_at(text.len() - places);
    match fraction.trim_end_matches('0') {
        "" => whole.to_owned(),
        fraction => format!("{whole}.{fraction}"),
    }
}
