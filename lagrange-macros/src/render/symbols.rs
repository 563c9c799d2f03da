//! Greek letters, fractions, exponents: the signs that formulas are written with.

use crate::symbolic::{Rational, finite_decimal};

/// A way of writing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Notation {
    Unicode,
    Latex,
}

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

pub(super) fn vulgar(numerator: i128, denominator: i128) -> Option<char> {
    const KNOWN: [(i128, i128, char); 15] = [
        (1, 2, '½'),
        (1, 3, '⅓'),
        (2, 3, '⅔'),
        (1, 4, '¼'),
        (3, 4, '¾'),
        (1, 5, '⅕'),
        (2, 5, '⅖'),
        (3, 5, '⅗'),
        (4, 5, '⅘'),
        (1, 6, '⅙'),
        (5, 6, '⅚'),
        (1, 8, '⅛'),
        (3, 8, '⅜'),
        (5, 8, '⅝'),
        (7, 8, '⅞'),
    ];
    KNOWN.iter().find(|(n, d, _)| (*n, *d) == (numerator, denominator)).map(|(_, _, fraction)| *fraction)
}

pub(super) fn superscript(digits: &str) -> String {
    digits
        .chars()
        .map(|digit| match digit {
            '-' => '⁻',
            digit => {
                ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize]
            }
        })
        .collect()
}

pub(super) fn subscript(digits: &str) -> String {
    let digits = digits.chars().filter_map(|digit| digit.to_digit(10));
    digits.map(|digit| ['₀', '₁', '₂', '₃', '₄', '₅', '₆', '₇', '₈', '₉'][digit as usize]).collect()
}
