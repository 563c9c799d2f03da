//! Line breaks in formulas.

use super::formula::Formula;
use super::notation::Notation;
use super::spelling::WIDE;

impl Notation<'_> {
    /// Splits a formula into pieces between which a line may break: before signs and after commas, and in wide pieces
    /// between words, but never inside a group that is held together.
    pub(super) fn pieces(self, formula: &Formula) -> Vec<String> {
        let signs = [" + ", " − "].map(|sign| self.spelling.sign(sign));
        let comma = self.spelling.sign(", ");
        let (comma, space) = comma.split_at(comma.trim_end().len());
        let may_end = |before: &str, rest: &str| {
            let is_after_comma = before.ends_with(comma) && rest.starts_with(space);
            is_after_comma || signs.iter().any(|sign| rest.starts_with(sign))
        };
        let words = self.spelling.between_words();
        let pieces = self.parted(&self.write(formula), may_end);
        let narrow = |piece: String| match self.spelling.width(&piece) > WIDE {
            true => self.parted(&piece, |before, _| before.ends_with(words)),
            false => vec![piece],
        };
        pieces.into_iter().flat_map(narrow).collect()
    }

    /// Splits text outside such groups, where `may_end` accepts the text before and after the break.
    fn parted(self, text: &str, may_end: impl Fn(&str, &str) -> bool) -> Vec<String> {
        let (mut parts, mut depth, mut start) = (Vec::new(), 0, 0);
        for (place, _) in text.char_indices() {
            let (before, rest) = text.split_at(place);
            if depth == 0 && place > start && may_end(before, rest) {
                parts.push(text[start..place].to_owned());
                start = place;
            }
            depth += self.spelling.nesting(rest);
        }
        parts.push(text[start..].to_owned());
        parts
    }
}
