//! Line breaks in formulas.

use super::formula::Formula;
use super::notation::Notation;

/// Brackets within brackets at whose sums a line may break. Those of an argument count twice, so that a line breaks in the
/// argument of a cosine only after all sums around it.
const DEPTH: i32 = 5;

impl Notation<'_> {
    /// Splits a formula into the terms of its sum, between which a line may break.
    pub(super) fn pieces(self, formula: &Formula) -> Vec<String> {
        self.terms(&self.write(formula), 0)
    }

    /// Splits a piece that is wider than `room`, in points: at sums and commas in brackets, in the outer ones first, and
    /// between words if there are none. A group that is held together stays whole.
    pub(super) fn within(self, piece: String, room: f64) -> Vec<String> {
        if self.spelling.width(&piece) <= room {
            return vec![piece];
        }
        let words = self.spelling.between_words();
        let ways = (0..DEPTH).map(|depth| self.terms(&piece, depth));
        let words = std::iter::once_with(|| self.parted(&piece, DEPTH, |before, _| before.ends_with(words)));
        let parts = ways.chain(words).find(|parts| parts.len() > 1);
        let narrow =
            |parts: Vec<String>| parts.into_iter().flat_map(|part| self.within(part, room)).collect();
        parts.map_or_else(|| vec![piece.clone()], narrow)
    }

    /// Splits text before signs and after commas that are in so many brackets at most.
    fn terms(self, text: &str, depth: i32) -> Vec<String> {
        let signs = [" + ", " − "].map(|sign| self.spelling.sign(sign));
        let comma = self.spelling.sign(", ");
        let (comma, space) = comma.split_at(comma.trim_end().len());
        self.parted(text, depth, |before, rest| {
            // A thin space of LaTeX, `\,`, is no comma.
            let is_after_comma =
                before.ends_with(comma) && !before.ends_with(r"\,") && rest.starts_with(space);
            is_after_comma || signs.iter().any(|sign| rest.starts_with(sign))
        })
    }

    /// Splits text outside of groups that are held together and in `depth` brackets at most, where `may_end` accepts the
    /// text before and after the break.
    fn parted(self, text: &str, depth: i32, may_end: impl Fn(&str, &str) -> bool) -> Vec<String> {
        let (mut parts, mut groups, mut start) = (Vec::new(), 0, 0);
        let mut brackets: Vec<i32> = Vec::new();
        for (place, sign) in text.char_indices() {
            let (before, rest) = text.split_at(place);
            if groups == 0 && brackets.iter().sum::<i32>() <= depth && place > start && may_end(before, rest)
            {
                parts.push(text[start..place].to_owned());
                start = place;
            }
            groups += self.spelling.nesting(rest);
            match sign {
                '(' | '[' => brackets.push(1 + i32::from(self.spelling.is_applied(before))),
                ')' | ']' => drop(brackets.pop()),
                _ => {}
            }
        }
        parts.push(text[start..].to_owned());
        parts
    }
}
