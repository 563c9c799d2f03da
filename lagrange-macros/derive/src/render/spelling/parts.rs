//! Interface of a spelling: signs, letters, fractions, roots and powers.

use unicode_normalization::UnicodeNormalization;

use crate::syntax::GREEK;

/// Widest group, in points at a font size of 10 points, that is kept on one line.
pub(crate) const WIDE: f64 = 155.0;

/// Parts from which a notation composes formulas. Arguments are already written in this spelling.
pub(crate) trait Spelling: Sync {
    /// Returns whether formulas stand on a single line, so that fractions, roots and powers need parentheses.
    fn is_flat(&self) -> bool {
        false
    }

    /// Approximate width in points, at a font size of 10 points.
    fn width(&self, text: &str) -> f64;

    /// Returns whether parentheses around this text must be taller than a line.
    fn is_tall(&self, inner: &str) -> bool;

    /// Change in nesting depth at the start of `rest`, counting groups that no line break may split.
    fn nesting(&self, rest: &str) -> i32;

    /// Returns whether this text ends with the name of a function, so that the bracket after it holds its argument.
    fn is_applied(&self, _before: &str) -> bool {
        false
    }

    /// A sign, given as in plain text with the spaces around it.
    fn sign(&self, sign: &str) -> String;

    /// An integer or a decimal.
    fn digits(&self, digits: &str) -> String;

    /// A fraction of integers in the size of a letter.
    fn small_fraction(&self, above: i128, below: i128) -> String;

    /// A letter or a word that names a quantity.
    fn letter(&self, name: &str, is_array: bool) -> String;

    /// A word that names no quantity: a subscript or a function.
    fn word(&self, word: &str) -> String;

    /// Name of a mathematical function.
    fn function(&self, name: &str) -> String;

    /// A letter with dots above it, with the subscripts of its name, and with indices.
    fn symbol(&self, letter: String, dots: usize, below: &[String], indices: &[String]) -> String {
        self.indexed(self.dotted(letter, dots), below, indices)
    }

    fn dotted(&self, letter: String, dots: usize) -> String;

    /// A letter with the subscripts of its name, and with indices.
    fn indexed(&self, letter: String, below: &[String], indices: &[String]) -> String;

    /// A subscript of a name: a number, a Greek letter or a word.
    fn below(&self, part: String) -> String {
        part
    }

    /// Base and exponent. Both already have the parentheses that they need.
    fn power(&self, base: &str, exponent: &str) -> String;

    /// Transpose of a matrix.
    fn transposed(&self, matrix: &str) -> String;

    /// Derivative of a function by primes, such as f″, without its argument.
    fn primes(&self, function: &str, order: usize) -> String;

    fn root(&self, inner: &str) -> String;

    fn fraction(&self, above: &str, below: &str) -> String;

    /// Text between parentheses, brackets or bars, as tall as a line or as the text.
    fn between(&self, bounds: [&str; 2], inner: &str, is_tall: bool) -> String;

    /// A matrix by its rows.
    fn matrix(&self, rows: &[Vec<String>]) -> String;

    /// A function and its argument, in parentheses or bare.
    fn applied(&self, function: &str, argument: &str, is_bare: bool) -> String;

    /// A differential: ∂x, ∂²U.
    fn differential(&self, order: usize, of: &str) -> String;

    /// A sum Σ from the first to the last value of an index.
    fn sum_over(&self, index: &str, from: &str, last: &str, body: &str) -> String;

    /// A sum Σ over all that meet a condition.
    fn sum_where(&self, condition: &str, body: &str) -> String;

    /// Separator between words, which would run into each other.
    fn between_words(&self) -> &'static str {
        " "
    }

    /// Separator between two factors.
    fn beside(&self, before: &str, after: &str) -> &'static str;
}

/// The capital that a script letter such as ℰ or 𝒫 is a form of.
pub(super) fn script(name: &str) -> Option<char> {
    let mut signs = name.chars();
    let is_script = |sign: &char| ('𝒜'..='𝒵').contains(sign) || "ℬℰℱℋℐℒℳℛ".contains(*sign);
    let sign = signs.next().filter(|sign| is_script(sign) && signs.next().is_none())?;
    sign.nfkd().next()
}

/// Latin name and character of a Greek letter, given either.
pub(super) fn greek(name: &str) -> Option<(&'static str, &'static str)> {
    GREEK.iter().copied().find(|(latin, greek)| *latin == name || *greek == name)
}
