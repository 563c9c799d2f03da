//! Signs, letters, fractions, roots and powers, as every way of writing provides them.

use crate::syntax::GREEK;

/// What is wider than that, in points at 10 point, is not held together between two lines.
pub(crate) const WIDE: f64 = 155.0;

/// The parts that a formula is put together from. What is given to them is written already.
pub(crate) trait Spelling: Sync {
    /// Whether all stands on one line: fractions, roots and powers then need parentheses to hold them together.
    fn is_flat(&self) -> bool {
        false
    }

    /// About how wide it is set, in points at 10 point.
    fn width(&self, text: &str) -> f64;

    /// Whether parentheses around it must be higher than a line.
    fn is_tall(&self, inner: &str) -> bool;

    /// By how much deeper than before what follows is in parts between which no line can end.
    fn nesting(&self, rest: &str) -> i32;

    /// A sign, given as it stands in a line of text, with its spaces.
    fn sign(&self, sign: &str) -> String;

    /// An integer or a decimal.
    fn digits(&self, digits: &str) -> String;

    /// A fraction of integers, as small as a letter.
    fn small_fraction(&self, above: i128, below: i128) -> String;

    /// A letter or a word for a quantity.
    fn letter(&self, name: &str, is_array: bool) -> String;

    /// A word that stands for no quantity: below a letter, or for a function.
    fn word(&self, word: &str) -> String;

    /// The name of a function of mathematics.
    fn function(&self, name: &str) -> String;

    /// A letter with dots above, and below it what belongs to its name, and indices.
    fn symbol(&self, letter: String, dots: usize, below: &[String], indices: &[String]) -> String {
        self.indexed(self.dotted(letter, dots), below, indices)
    }

    fn dotted(&self, letter: String, dots: usize) -> String;

    /// A letter with what belongs to its name below it, and indices.
    fn indexed(&self, letter: String, below: &[String], indices: &[String]) -> String;

    /// What numbers, Greek letters and words belong to a name, below it.
    fn below(&self, part: String) -> String {
        part
    }

    /// Both as they are to stand, in parentheses where they need them.
    fn power(&self, base: &str, exponent: &str) -> String;

    /// f″, without its argument.
    fn primes(&self, function: &str, order: usize) -> String;

    fn root(&self, inner: &str) -> String;

    fn fraction(&self, above: &str, below: &str) -> String;

    /// Between parentheses, brackets or bars that are as high as a line, or as what is inside.
    fn between(&self, bounds: [&str; 2], inner: &str, is_tall: bool) -> String;

    /// A matrix by its rows.
    fn matrix(&self, rows: &[Vec<String>]) -> String;

    /// Writes a function and its argument, in parentheses or bare.
    fn applied(&self, function: &str, argument: &str, is_bare: bool) -> String;

    /// ∂x, ∂²U
    fn differential(&self, order: usize, of: &str) -> String;

    /// Σ from the first to the last.
    fn sum_over(&self, index: &str, from: &str, last: &str, body: &str) -> String;

    /// What stands between factors that would run into each other: words.
    fn between_words(&self) -> &'static str {
        " "
    }

    /// What stands between two factors.
    fn beside(&self, before: &str, after: &str) -> &'static str;
}

/// The name of a Greek letter in Latin, and the letter, given one of them.
pub(super) fn greek(name: &str) -> Option<(&'static str, &'static str)> {
    GREEK.iter().copied().find(|(latin, greek)| *latin == name || *greek == name)
}
