//! Where a line may end in a formula.

use super::formula::Formula;
use super::notation::Notation;

impl Notation<'_> {
    /// A formula in parts between which a line may end: before its signs and behind its commas, but for those that are inside of
    /// what is held together.
    pub(super) fn pieces(self, formula: &Formula) -> Vec<String> {
        let text = self.write(formula);
        let signs = [" + ", " − "].map(|sign| self.spelling.sign(sign));
        let comma = self.spelling.sign(", ");
        let (comma, space) = comma.split_at(comma.trim_end().len());
        let (mut pieces, mut depth, mut start) = (Vec::new(), 0, 0);
        for (place, _) in text.char_indices() {
            let (before, rest) = text.split_at(place);
            let is_sign = signs.iter().any(|sign| rest.starts_with(sign));
            // The space `\,` of LaTeX among them: it stands between words.
            let is_after_comma = before.ends_with(comma) && rest.starts_with(space);
            if depth == 0 && place > start && (is_sign || is_after_comma) {
                pieces.push(text[start..place].to_owned());
                start = place;
            }
            depth += self.spelling.nesting(rest);
        }
        pieces.push(text[start..].to_owned());
        pieces
    }
}
