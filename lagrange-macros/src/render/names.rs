//! Names in formulas: letters with what stands above and below them.

use super::formula::Formula;
use super::notation::{braced, is_command};
use super::symbols::{Notation, subscript};
use crate::syntax::GREEK;

impl Notation {
    /// Greek by their names; dots above the letter; indices below.
    pub(super) fn name(self, base: &str, dots: usize, indices: &[Formula]) -> String {
        let indices = indices.iter().map(|index| self.write(index));
        let (letter, below) = letter_and_below(base);
        let letter = self.dotted(self.letter(letter), dots);
        let below = below.iter().map(|below| self.below(below));
        match self {
            Self::Latex => self.with_below(letter, &below.chain(indices).collect::<Vec<_>>()),
            Self::Unicode => {
                let below: String = below.collect();
                let indices: String = indices.map(|index| format!("[{index}]")).collect();
                format!("{letter}{below}{indices}")
            }
        }
    }

    fn with_below(self, letter: String, below: &[String]) -> String {
        if below.is_empty() { letter } else { format!("{letter}_{}", braced(&below.join(", "))) }
    }

    /// What stands below a letter: digits, a Greek letter, or a word upright.
    fn below(self, name: &str) -> String {
        let is_number = name.chars().all(|sign| sign.is_ascii_digit());
        let is_indexed = !letter_and_below(name).1.is_empty();
        match self {
            Self::Unicode if is_number => subscript(name),
            Self::Unicode => format!("_{}", self.name(name, 0, &[])),
            Self::Latex if !is_number && is_indexed => self.name(name, 0, &[]),
            Self::Latex if is_number => name.to_owned(),
            Self::Latex if name.chars().count() > 1 && !is_greek(name) => {
                format!(r"\mathrm{{{}}}", name.replace('_', r"\,"))
            }
            Self::Latex => self.letter(name),
        }
    }

    fn dotted(self, letter: String, dots: usize) -> String {
        let [accent, command] = match dots {
            0 => return letter,
            1 => ["\u{307}", r"\dot"],
            _ => ["\u{308}", r"\ddot"],
        };
        match self {
            Self::Unicode => crate::syntax::normal_form(&format!("{letter}{accent}")),
            Self::Latex if letter.chars().count() == 1 => format!("{command} {letter}"),
            Self::Latex if is_command(&letter) => format!("{command}{letter}"),
            Self::Latex => format!("{command}{{{letter}}}"),
        }
    }

    /// In LaTeX the member's letter, with all else below: the mass of `link[2]` is mₗᵢₙₖ,₂.
    pub(super) fn member(self, of: &Formula, member: &Formula) -> String {
        match self {
            Self::Unicode => format!("{}.{}", self.write(of), self.write(member)),
            Self::Latex => {
                let [letter, below @ ..] = &self.apart(member)[..] else { return String::new() };
                self.with_below(letter.clone(), &[self.apart(of), below.to_vec()].concat())
            }
        }
    }

    /// A name, and what stands below it.
    fn apart(self, formula: &Formula) -> Vec<String> {
        match formula {
            Formula::Name { base, indices, .. } => {
                let (base, below) = letter_and_below(base);
                let below = below.iter().map(|name| self.below(name));
                let indices = indices.iter().map(|index| self.write(index));
                std::iter::once(self.letter(base)).chain(below).chain(indices).collect()
            }
            Formula::Member(of, member) => [self.apart(of), self.apart(member)].concat(),
            other => vec![self.write(other)],
        }
    }

    fn letter(self, name: &str) -> String {
        let greek = GREEK.iter().find(|(latin, greek)| *latin == name || *greek == name);
        match (self, greek) {
            (Self::Unicode, Some((_, greek))) => (*greek).to_owned(),
            (Self::Latex, Some((latin, _))) => match *latin {
                // Their names in LaTeX are those of other shapes than the letters have in print.
                "phi" => r"\varphi".to_owned(),
                "varphi" => r"\phi".to_owned(),
                "epsilon" => r"\varepsilon".to_owned(),
                latin => format!(r"\{latin}"),
            },
            (Self::Latex, None) if name.chars().count() > 1 => {
                format!(r"\mathit{{{}}}", name.replace('_', r"\_"))
            }
            _ => name.to_owned(),
        }
    }

    pub(super) fn subscript(self, base: &str, below: &str) -> String {
        match self {
            Self::Unicode => format!("{base}_{below}"),
            Self::Latex => {
                let Formula::Name { base: name, indices, .. } = Formula::labelled(below, 0) else {
                    return format!("{base}_{}", braced(&self.below(below)));
                };
                let indices = indices.iter().map(|index| self.write(index));
                let below: Vec<String> = std::iter::once(self.below(&name)).chain(indices).collect();
                self.with_below(base.to_owned(), &below)
            }
        }
    }
}

/// `theta` and `1` of `theta_1`.
fn with_tail(name: &str) -> (&str, Option<&str>) {
    match name.split_once('_') {
        Some((base, tail)) if !base.is_empty() && !tail.is_empty() => (base, Some(tail)),
        _ => (name, None),
    }
}

/// `theta` and `1` of `theta_1`, `m` and `1` of `m1`, `m`, `1` and `x` of `m1_x`.
fn letter_and_below(name: &str) -> (&str, Vec<&str>) {
    let (base, tail) = with_tail(name);
    let letter = base.trim_end_matches(|sign: char| sign.is_ascii_digit());
    let is_letter = letter.chars().count() == 1 || is_greek(letter);
    let (letter, digits) = base.split_at(if is_letter { letter.len() } else { base.len() });
    (letter, [digits].into_iter().filter(|digits| !digits.is_empty()).chain(tail).collect())
}

fn is_greek(name: &str) -> bool {
    GREEK.iter().any(|(latin, greek)| *latin == name || *greek == name)
}
