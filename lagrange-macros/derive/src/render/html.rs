//! Renders the page as HTML, with its formulas in MathML.
//!
//! MathML Core does not break lines. So each part of an equation that may begin a line is a formula of its own, and the
//! formulas follow each other like words: the equation takes as many lines as the width of the page requires. Short
//! left sides are aligned in a column; long ones begin their own line.

use super::formula::Formula;
use super::lines::{Equation, Line, Section};
use super::notation::Notation;
use super::remark::{Fragment, Remark};

/// Widest left side in the column, in points at a font size of 10 points. A wider one begins its line.
const LEFT: f64 = 60.0;

/// Widest formula that is kept on one line of a page, in points at a font size of 10 points.
const LINE: f64 = 310.0;

/// Widest formula that is kept on one line of a page too narrow for [`LINE`], such as that of a phone.
const NARROW: f64 = 120.0;

// Styles are inline, because the surrounding page provides no style sheet.
const PAGE: &str = "overflow-x:auto";
const ROWS: &str =
    "display:grid;grid-template-columns:auto minmax(0,1fr);gap:.5em .25em;align-items:baseline";
const SHORT: &str = "text-align:right";
const LONG: &str = "grid-column:1/-1;padding-left:2em;text-indent:-2em";
const WRAPPED: &str = "padding-left:1em;text-indent:-1em";
// A formula wider than `NARROW` has breaks of its own, which are taken only where the whole formula has no room on a line.
const FOLDED: &str = "display:inline-flex;flex-wrap:wrap;align-items:baseline;text-indent:0";
// A remark moves to its own line if it does not fit after the equation.
const REMARK: &str = "display:inline-block;text-indent:0;opacity:.75;margin-left:1em";

/// Writes a single HTML element without empty lines, so that Markdown documentation can contain it.
pub(super) fn html(notation: Notation, sections: &[Section]) -> String {
    let page = HtmlRows { notation };
    let sections = sections.iter().filter(|section| !section.is_empty());
    let sections: String = sections.map(|section| page.section(section)).collect();
    format!("<div class=\"equations\" style=\"{PAGE}\">\n{sections}</div>\n")
}

struct HtmlRows<'a> {
    notation: Notation<'a>,
}

impl HtmlRows<'_> {
    fn section(&self, Section { heading, lines, note }: &Section) -> String {
        let rows: String = lines.iter().map(|line| self.row(line)).collect();
        let rows = match lines.is_empty() {
            true => String::new(),
            false => format!("<div style=\"{ROWS}\">\n{rows}</div>\n"),
        };
        let note = note.as_ref().map_or(String::new(), |note| format!("<p>{}</p>\n", text(note)));
        format!("<h5>{heading}</h5>\n{rows}{note}")
    }

    fn row(&self, line: &Line) -> String {
        let notation = self.notation;
        let remark = self.remark(line.label.as_deref(), &line.remark);
        let (left, right) = match &line.equation {
            Equation::Known(left, right) => {
                let mut right = self.by_columns(right).unwrap_or_else(|| notation.pieces(right));
                right[0].insert_str(0, &notation.spelling.sign(" = "));
                (notation.pieces(left), right)
            }
            Equation::Complementary(gap, multiplier) => {
                let [left, mut right] = notation.complementary(gap, multiplier);
                right[0].insert_str(0, &notation.spelling.sign(" ⊥ "));
                (left, right)
            }
            Equation::Term(formula) => (notation.pieces(formula), Vec::new()),
            Equation::TooLong(size) => {
                let label =
                    line.label.as_ref().map_or(String::new(), |label| format!("<span>{label}: </span>"));
                return format!("<div style=\"{LONG}\">{label}… ({size} symbols){remark}</div>\n");
            }
        };
        if notation.spelling.width(&left.concat()) > LEFT || right.is_empty() {
            let all = self.formulas([left, right].concat());
            return format!("<div style=\"{LONG}\">{all}{remark}</div>\n");
        }
        let [left, right] = [left, right].map(|pieces| self.formulas(pieces));
        format!("<div style=\"{SHORT}\">{left}</div><div style=\"{WRAPPED}\">{right}{remark}</div>\n")
    }

    /// A matrix whose rows are wider than a line, as a list of its columns, which may stand on several lines.
    fn by_columns(&self, matrix: &Formula) -> Option<Vec<String>> {
        let Formula::Vector(rows) = matrix else { return None };
        let entries = |row: &Formula| if let Formula::Vector(row) = row { Some(row.clone()) } else { None };
        let rows: Vec<Vec<Formula>> = rows.iter().map(entries).collect::<Option<_>>()?;
        let (notation, spelling) = (self.notation, self.notation.spelling);
        // The width of a matrix is that of all its entries side by side.
        (spelling.width(&notation.write(matrix)) > LINE * rows.len() as f64).then_some(())?;
        let count = rows.iter().map(Vec::len).min()?;
        let entry = |row: &Vec<Formula>, k: usize| Formula::Vector(vec![row[k].clone()]);
        let column = |k: usize| Formula::Vector(rows.iter().map(|row| entry(row, k)).collect());
        let piece = |k: usize| {
            let begin = if k == 0 { spelling.sign("[") } else { String::new() };
            let end = spelling.sign(if k + 1 == count { "]" } else { "," });
            begin + &notation.write(&column(k)) + &end
        };
        (count > 0).then(|| (0..count).map(piece).collect())
    }

    /// MathML formulas side by side, with optional line breaks between them.
    fn formulas(&self, pieces: Vec<String>) -> String {
        let pieces = pieces.into_iter().flat_map(|piece| self.notation.within(piece, LINE));
        pieces.map(|piece| self.formula(piece)).collect::<Vec<_>>().join("<wbr/>")
    }

    /// A formula that stands on a line, or on several where a line is short.
    fn formula(&self, piece: String) -> String {
        let parts = self.notation.within(piece, NARROW);
        let formulas: String =
            parts.iter().map(|part| format!("<math displaystyle=\"true\">{part}</math>")).collect();
        if parts.len() == 1 { formulas } else { format!("<span style=\"{FOLDED}\">{formulas}</span>") }
    }

    /// Remark with the name and the kind of a constraint.
    fn remark(&self, label: Option<&str>, remark: &Remark) -> String {
        let part = |part| match part {
            Fragment::Words(words) => text(&words),
            Fragment::Formula(formula) => self.formulas(self.notation.pieces(&formula)),
        };
        let said: String = remark.in_parentheses().into_iter().map(part).collect();
        let name = label.map_or(String::new(), |label| text(label) + " ");
        if said.is_empty() { said } else { format!("<span style=\"{REMARK}\">{name}{said}</span>") }
    }
}

fn text(plain: &str) -> String {
    plain.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('\n', " ")
}
