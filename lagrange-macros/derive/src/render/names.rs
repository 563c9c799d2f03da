//! Writes names: letters with dots above them and subscripts.

use super::formula::Formula;
use super::notation::Notation;
use crate::syntax::GREEK;

impl Notation<'_> {
    /// Writes a name: spelled-out Greek letters become Greek, dots stand above the letter, and indices below it.
    pub(super) fn name(self, name: &Formula) -> String {
        let Formula::Name { base, dots, indices } = name else { return self.write(name) };
        let (letter, below) = letter_and_below(base);
        let letter = self.spelling.letter(letter, self.is_array(name));
        let below: Vec<String> = below.iter().map(|below| self.below(below)).collect();
        self.spelling.symbol(letter, *dots, &below, &self.indices(indices))
    }

    fn indices(self, indices: &[Formula]) -> Vec<String> {
        indices.iter().map(|index| self.write(index)).collect()
    }

    /// Writes a subscript: digits, a letter with its own subscript, or upright words side by side.
    fn below(self, name: &str) -> String {
        let (first, tail) = letter_and_below(name);
        let part = match name.chars().all(|sign| sign.is_ascii_digit()) {
            true => self.spelling.digits(name),
            false if is_letter(first) && tail.is_empty() => self.spelling.letter(first, false),
            false if is_letter(first) || self.spelling.is_flat() => {
                self.name(&Formula::Name { base: name.to_owned(), dots: 0, indices: Vec::new() })
            }
            false if tail.is_empty() => self.spelling.word(first),
            false => {
                let tail = tail.into_iter().map(|part| self.below(part));
                let words: Vec<String> = std::iter::once(self.spelling.word(first)).chain(tail).collect();
                words.join(&self.spelling.sign("\u{2009}"))
            }
        };
        self.spelling.below(part)
    }

    /// Writes a member. Flat text keeps `link[2].m`; otherwise all but the letter of the member becomes a subscript, so
    /// that the mass of `link[2]` is mₗᵢₙₖ,₂.
    pub(super) fn member(self, of: &Formula, member: &Formula) -> String {
        if self.spelling.is_flat() {
            return format!("{}.{}", self.write(of), self.write(member));
        }
        let whole = Formula::Member(Box::new(of.clone()), Box::new(member.clone()));
        let [_, below @ ..] = &self.apart(member)[..] else { return String::new() };
        let below = [self.apart(of), below.to_vec()].concat();
        let Formula::Name { base, dots, .. } = member else { return String::new() };
        let letter = self.spelling.letter(letter_and_below(base).0, self.is_array(&whole));
        self.spelling.indexed(self.spelling.dotted(letter, *dots), &below, &[])
    }

    /// Splits a formula into a letter and its subscripts.
    fn apart(self, formula: &Formula) -> Vec<String> {
        match formula {
            Formula::Name { base, indices, .. } => {
                let (base, below) = letter_and_below(base);
                let below = below.iter().map(|name| self.below(name));
                let letter = std::iter::once(self.spelling.letter(base, false));
                letter.chain(below).chain(self.indices(indices)).collect()
            }
            Formula::Member(of, member) => [self.apart(of), self.apart(member)].concat(),
            other => vec![self.write(other)],
        }
    }

    /// Writes λ, or the letter in its place, with the name of the constraint as a subscript.
    pub(super) fn multiplier(self, constraint: &str) -> String {
        self.name(&Formula::labelled(&format!("{}_{constraint}", self.multiplier_letter()), 0))
    }
}

/// Splits a name at its first underscore: `theta_1` into `theta` and `1`.
fn with_tail(name: &str) -> (&str, Option<&str>) {
    match name.split_once('_') {
        Some((base, tail)) if !base.is_empty() && !tail.is_empty() => (base, Some(tail)),
        _ => (name, None),
    }
}

/// Splits a name into a letter and its subscripts: `theta_1` into `theta` and `1`, `m1` into `m` and `1`, `m1_x` into
/// `m`, `1` and `x`.
fn letter_and_below(name: &str) -> (&str, Vec<&str>) {
    let (base, tail) = with_tail(name);
    let letter = base.trim_end_matches(|sign: char| sign.is_ascii_digit());
    let (letter, digits) = base.split_at(if is_letter(letter) { letter.len() } else { base.len() });
    (letter, [digits].into_iter().filter(|digits| !digits.is_empty()).chain(tail).collect())
}

/// Returns whether a name is a single letter, or a Greek letter by its name.
fn is_letter(name: &str) -> bool {
    name.chars().count() == 1 || GREEK.iter().any(|(latin, greek)| *latin == name || *greek == name)
}
