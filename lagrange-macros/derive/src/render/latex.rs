//! Renders the page as LaTeX: headings, and aligned, numbered equations with labels and remarks. Long equations break
//! before a sign.

use unicode_normalization::UnicodeNormalization;

use super::formula::Formula;
use super::lines::{Equation, Line, Section};
use super::notation::Notation;
use super::remark::{Fragment, Remark};
use super::spelling::WIDE;
use crate::syntax::GREEK;

/// Width, in points, that `article` leaves between its margins beside an equation number.
const LINE: f64 = 310.0;

/// Widest left side, in points, that shares a line with the right side.
const LEFT: f64 = 110.0;

/// Widest remark, in points, that is kept on one line: about half of [`LINE`].
const REMARK: f64 = 150.0;

/// Indent of a line that continues an equation, in points.
const INDENT: f64 = 25.0;

/// Start of a heading. TeX keeps the heading with the equations below: the penalty before a display is infinite.
const HEADING: &str = r"\par\medskip\noindent\textbf";

/// Writes a heading and an `align` environment for each section; `\eqref{eq:Pendulum-theta}` refers to the equation of
/// `theta`. Pages may break between equations. `Equations` of lagrange-core parses this text.
pub(super) fn latex(notation: Notation, name: &str, sections: &[Section]) -> String {
    let page = Lines { notation };
    let mut labels = Vec::new();
    let sections = sections.iter().filter(|section| !section.is_empty());
    let sections: String = sections.map(|section| page.section(section, name, &mut labels)).collect();
    format!("\\begingroup\\allowdisplaybreaks\n{sections}\\endgroup\n")
}

struct Lines<'a> {
    notation: Notation<'a>,
}

impl Lines<'_> {
    fn section(
        &self,
        Section { heading, lines, note }: &Section,
        name: &str,
        labels: &mut Vec<String>,
    ) -> String {
        let sides: Vec<[Vec<String>; 2]> = lines.iter().map(|line| self.sides(line)).collect();
        let lefts = sides.iter().map(|[left, _]| self.width(&left.concat())).filter(|&left| left <= LEFT);
        let column = lefts.fold(0.0, f64::max);
        let equations = lines.iter().zip(&sides).map(|(line, [left, right])| {
            let label = format!("\\label{{eq:{name}-{}}}", unique(self.label(line), labels));
            self.equation(left, relation(line), right, column).join(" \\nonumber \\\\*\n    ") + " " + &label
        });
        let equations = equations.collect::<Vec<_>>().join(" \\\\\n  ");
        let equations = match lines.is_empty() {
            true => String::new(),
            false => format!("\\begin{{align}}\n  {equations}\n\\end{{align}}\n"),
        };
        let note = note.as_ref().map_or(String::new(), |note| format!("\\par\\noindent {}\n", prose(note)));
        format!("{HEADING}{{{heading}}}\n{equations}{note}")
    }

    fn width(&self, text: &str) -> f64 {
        self.notation.spelling.width(text)
    }

    /// Pieces of the left side, and of the right side with the remark after it.
    fn sides(&self, line: &Line) -> [Vec<String>; 2] {
        let notation = self.notation;
        let [left, right] = match &line.equation {
            Equation::Known(left, right) => [notation.pieces(left), notation.pieces(right)],
            Equation::Complementary(gap, multiplier) => notation.complementary(gap, multiplier),
            Equation::Term(formula) => {
                let all = [notation.pieces(formula), vec![r" = \text{total time derivative}".to_owned()]];
                [vec![], all.concat()]
            }
            Equation::TooLong(size) => {
                let name = match &line.label {
                    Some(name) if name.is_ascii() => name.clone(),
                    _ => self.label(line),
                };
                [vec![], vec![format!(r"\text{{{}: ({size} symbols)}}", prose(&name))]]
            }
        };
        [left, [right, self.remark(&line.remark)].concat()]
    }

    /// Splits a remark into pieces: a long one may break after punctuation and in long formulas.
    fn remark(&self, remark: &Remark) -> Vec<String> {
        let (mut pieces, mut is_new): (Vec<String>, bool) = (Vec::new(), true);
        for part in remark.in_parentheses() {
            let (parts, ends) = match part {
                Fragment::Words(words) => {
                    let parts =
                        clauses(&words).map(|clause| format!(r"\text{{{}}}", clause.replace('≤', r"$\le$")));
                    (parts.collect(), words.ends_with([' ']) && !words.ends_with("not "))
                }
                Fragment::Formula(formula) => (self.held_together(&formula), false),
            };
            for (place, part) in parts.into_iter().enumerate() {
                match pieces.last_mut().filter(|_| place == 0 && !is_new) {
                    Some(last) => *last += &part,
                    None => pieces.push(part),
                }
            }
            is_new = ends;
        }
        let whole = pieces.concat();
        if !pieces.is_empty() && self.width(&whole) <= REMARK {
            pieces = vec![whole];
        }
        pieces.first_mut().into_iter().for_each(|first| first.insert_str(0, r" \quad "));
        pieces
    }

    /// Keeps a formula in one piece, unless it is too wide.
    fn held_together(&self, formula: &Formula) -> Vec<String> {
        let pieces = self.notation.pieces(formula);
        if self.width(&pieces.concat()) < WIDE { vec![pieces.concat()] } else { pieces }
    }

    /// Lines of an equation.
    fn equation(&self, left: &[String], relation: &str, right: &[String], column: f64) -> Vec<String> {
        let rest = LINE - column;
        if left.is_empty() {
            return self.filled(right, "&", r"&\quad", rest);
        }
        let whole = left.concat();
        if self.width(&whole) <= LEFT {
            return self.filled(right, &format!("{whole} &{relation} "), r"&\quad", rest);
        }
        // `\lefteqn` has no width, so a long left side does not shift the other equations to the right.
        let mut lines = self.filled(left, "", r"\quad", LINE);
        lines.iter_mut().for_each(|line| *line = format!(r"\lefteqn{{{line}}} &"));
        lines.extend(self.filled(right, &format!("&{relation} "), r"&\quad", rest));
        lines
    }

    /// Fills lines up to the width `room` with pieces. The first line begins with `first`, the following ones with
    /// `others`.
    fn filled(&self, pieces: &[String], first: &str, others: &str, room: f64) -> Vec<String> {
        let mut lines = vec![first.to_owned()];
        let mut used = 15.0;
        let pieces = pieces.iter().flat_map(|piece| self.notation.within(piece.clone(), room - INDENT));
        for piece in pieces {
            let wide = self.width(&piece);
            if used + wide > room && used > 20.0 {
                lines.push(others.to_owned());
                used = INDENT;
            }
            used += wide;
            let space = if piece.starts_with(' ') { "" } else { " " };
            lines.last_mut().into_iter().for_each(|line| {
                *line += if line.ends_with("quad") { space } else { "" };
                *line += &piece;
            });
        }
        lines
    }

    /// Label of a line: `theta` for an equation of motion, else the left side with the first letters of the page's symbols.
    fn label(&self, line: &Line) -> String {
        let name = match (&line.label, &line.equation) {
            (Some(label), _) => label.clone(),
            (None, Equation::Known(left, _)) => Notation::UNICODE.write(&self.notation.standard(left)),
            (None, _) => "term".to_owned(),
        };
        let latin = name.nfd().map(|sign| match sign {
            '\u{307}' => "-dot".to_owned(),
            '\u{308}' => "-ddot".to_owned(),
            sign => {
                let greek = GREEK.iter().find(|(_, greek)| greek.chars().eq([sign]));
                greek.map_or_else(|| sign.to_string(), |(latin, _)| (*latin).to_owned())
            }
        });
        let text: String = latin.collect::<String>().nfkd().collect();
        let words = text.split(|sign: char| !sign.is_ascii_alphanumeric() && sign != '_');
        words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-")
    }
}

/// Sign between the sides of a line.
fn relation(line: &Line) -> &'static str {
    if matches!(line.equation, Equation::Complementary(..)) { r"\perp" } else { "=" }
}

/// Escapes plain text for LaTeX, and sets code in a typewriter font.
fn prose(plain: &str) -> String {
    let escaped = |sign: char| match sign {
        '#' | '_' | '&' | '%' | '{' | '}' => format!("\\{sign}"),
        '…' => "\\dots{}".to_owned(),
        '\n' => " ".to_owned(),
        sign => sign.to_string(),
    };
    let parts = plain.split('`').enumerate().map(|(place, part)| {
        let part: String = part.chars().map(escaped).collect();
        if place % 2 == 1 { format!("\\texttt{{{part}}}") } else { part }
    });
    parts.collect()
}

/// Splits words after punctuation, where a line may break.
fn clauses(words: &str) -> impl Iterator<Item = &str> {
    let mut rest = Some(words);
    std::iter::from_fn(move || {
        let text = rest?;
        let end = [", ", "; ", ": "].iter().filter_map(|sign| text.find(sign)).min().map(|end| end + 2);
        rest = end.map(|end| &text[end..]).filter(|rest| !rest.is_empty());
        Some(&text[..end.unwrap_or(text.len())])
    })
}

/// The label, with a number appended if an earlier label is equal.
fn unique(label: String, labels: &mut Vec<String>) -> String {
    let count = labels.iter().filter(|known| **known == label).count();
    labels.push(label.clone());
    if count == 0 { label } else { format!("{label}-{}", count + 1) }
}
