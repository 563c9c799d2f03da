//! Plain Unicode text, on one line.

use super::parts::{Spelling, greek};
use crate::syntax::normal_form;

pub(crate) struct Unicode;

impl Spelling for Unicode {
    fn is_flat(&self) -> bool {
        true
    }

    fn width(&self, text: &str) -> f64 {
        5.0 * text.chars().count() as f64
    }

    fn is_tall(&self, _: &str) -> bool {
        false
    }

    fn nesting(&self, _: &str) -> i32 {
        0
    }

    fn sign(&self, sign: &str) -> String {
        sign.to_owned()
    }

    fn digits(&self, digits: &str) -> String {
        digits.to_owned()
    }

    fn small_fraction(&self, above: i128, below: i128) -> String {
        vulgar(above, below).map_or_else(|| format!("{above}/{below}"), String::from)
    }

    fn letter(&self, name: &str, _: bool) -> String {
        greek(name).map_or(name, |(_, greek)| greek).to_owned()
    }

    fn word(&self, word: &str) -> String {
        word.to_owned()
    }

    fn function(&self, name: &str) -> String {
        name.to_owned()
    }

    /// Words cannot have dots above them: `pitch_dot`, as in attributes.
    fn symbol(&self, letter: String, dots: usize, below: &[String], indices: &[String]) -> String {
        match letter.chars().count() {
            1 => self.indexed(self.dotted(letter, dots), below, indices),
            _ => self.indexed(letter + &below.concat() + ["", "_dot", "_ddot"][dots.min(2)], &[], indices),
        }
    }

    fn dotted(&self, letter: String, dots: usize) -> String {
        let accent = ["", "\u{307}", "\u{308}"][dots.min(2)];
        normal_form(&format!("{letter}{accent}"))
    }

    fn indexed(&self, letter: String, below: &[String], indices: &[String]) -> String {
        let indices: String = indices.iter().map(|index| format!("[{index}]")).collect();
        letter + &below.concat() + &indices
    }

    fn below(&self, part: String) -> String {
        match part.chars().all(|sign| sign.is_ascii_digit()) {
            true => subscript(&part),
            false => format!("_{part}"),
        }
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        let digits = exponent.trim_start_matches('−');
        match !digits.is_empty() && digits.chars().all(|digit| digit.is_ascii_digit()) {
            true => format!("{base}{}", superscript(exponent)),
            false => format!("{base}^{exponent}"),
        }
    }

    fn transposed(&self, matrix: &str) -> String {
        format!("{matrix}ᵀ")
    }

    fn primes(&self, function: &str, order: usize) -> String {
        format!("{function}{}", "′".repeat(order))
    }

    fn root(&self, inner: &str) -> String {
        format!("√{inner}")
    }

    fn fraction(&self, above: &str, below: &str) -> String {
        format!("{above}/{below}")
    }

    fn between(&self, [open, close]: [&str; 2], inner: &str, _: bool) -> String {
        format!("{open}{inner}{close}")
    }

    fn matrix(&self, rows: &[Vec<String>]) -> String {
        let rows: Vec<String> = rows.iter().map(|row| format!("[{}]", row.join(", "))).collect();
        format!("[{}]", rows.join(", "))
    }

    fn applied(&self, function: &str, argument: &str, is_bare: bool) -> String {
        format!("{function}{}{argument}", if is_bare { " " } else { "" })
    }

    fn differential(&self, order: usize, of: &str) -> String {
        let order = if order == 1 { String::new() } else { superscript(&order.to_string()) };
        format!("∂{order}{of}")
    }

    fn sum_over(&self, index: &str, from: &str, last: &str, body: &str) -> String {
        format!("Σ({index} = {from} … {last}) {body}")
    }

    fn sum_where(&self, condition: &str, body: &str) -> String {
        format!("Σ({condition}) {body}")
    }

    fn beside(&self, _: &str, after: &str) -> &'static str {
        if after.starts_with(|first: char| first.is_ascii_digit()) { " · " } else { " " }
    }
}

fn vulgar(numerator: i128, denominator: i128) -> Option<char> {
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

fn superscript(digits: &str) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    digits.chars().map(|digit| digit.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize])).collect()
}

fn subscript(digits: &str) -> String {
    const DIGITS: [char; 10] = ['₀', '₁', '₂', '₃', '₄', '₅', '₆', '₇', '₈', '₉'];
    digits.chars().filter_map(|digit| digit.to_digit(10)).map(|digit| DIGITS[digit as usize]).collect()
}
