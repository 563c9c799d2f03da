//! Headings and lines of a page, and its plain text.

use super::formula::Formula;
use super::length::length;
use super::notation::Notation;
use super::remark::Remark;

/// Longest equation, in symbols, that fits on a line.
pub(super) const LINE: usize = 60;

/// A heading, the lines below it, and a note on all of the lines. Each line has a label, an equation and a remark.
pub(super) struct Section {
    pub(super) heading: &'static str,
    pub(super) lines: Vec<Line>,
    pub(super) note: Option<String>,
}

#[derive(Clone)]
pub(super) struct Line {
    pub(super) label: Option<String>,
    pub(super) equation: Equation,
    pub(super) remark: Remark,
}

impl Section {
    pub(super) fn is_empty(&self) -> bool {
        self.lines.is_empty() && self.note.is_none()
    }
}

impl Line {
    pub(super) fn of(equation: Equation) -> Self {
        Self { label: None, equation, remark: Remark::default() }
    }

    pub(super) fn labelled(label: &Formula, equation: Equation) -> Self {
        Self { label: Some(Notation::UNICODE.write(label)), ..Self::of(equation) }
    }

    /// True if a name stands in the equation or in the remark on it.
    pub(super) fn has_name(&self, name: &Formula) -> bool {
        self.any(|formula| formula.has_name(name))
    }

    /// True if this holds of a formula of the equation or of the remark on it.
    pub(super) fn any(&self, is_it: impl Fn(&Formula) -> bool) -> bool {
        let is_in_equation = match &self.equation {
            Equation::Known(left, right) | Equation::Complementary(left, right) => {
                is_it(left) || is_it(right)
            }
            Equation::Term(term) => is_it(term),
            Equation::TooLong(_) => false,
        };
        is_in_equation || self.remark.any(is_it)
    }

    /// True if the equation fits on a line.
    pub(super) fn is_short(&self) -> bool {
        match &self.equation {
            Equation::Known(left, right) => length(left) + length(right) <= LINE,
            _ => false,
        }
    }

    pub(super) fn is_too_long(&self) -> bool {
        matches!(self.equation, Equation::TooLong(_))
    }

    /// Replaces the formulas of the equation and of the remark.
    pub(super) fn map(&mut self, new: impl Fn(Formula) -> Formula) {
        let formulas = match &mut self.equation {
            Equation::Known(left, right) | Equation::Complementary(left, right) => vec![left, right],
            Equation::Term(term) => vec![term],
            Equation::TooLong(_) => Vec::new(),
        };
        for formula in formulas.into_iter().chain(self.remark.formulas()) {
            *formula = new(formula.clone());
        }
    }

    /// The equation left = right; if the right side is too long, the left side becomes a label.
    pub(super) fn known(left: Formula, right: Result<Formula, u64>) -> Self {
        match right {
            Ok(right) => Self::of(Equation::Known(left, right)),
            Err(size) => {
                let label = Some(Notation::UNICODE.write(&left));
                Self { label, ..Self::of(Equation::TooLong(size)) }
            }
        }
    }
}

#[derive(Clone)]
pub(super) enum Equation {
    Known(Formula, Formula),
    /// A gap and the multiplier of a contact: 0 ≤ gap ⊥ λ ≥ 0.
    Complementary(Formula, Formula),
    /// A single expression without an equals sign.
    Term(Formula),
    /// Not written out: the number of symbols it would take.
    TooLong(u64),
}

impl From<Result<[Formula; 2], u64>> for Equation {
    fn from(sides: Result<[Formula; 2], u64>) -> Self {
        match sides {
            Ok([left, right]) => Self::Known(left, right),
            Err(size) => Self::TooLong(size),
        }
    }
}

pub(super) fn text(notation: Notation, name: &str, sections: &[Section]) -> String {
    let mut text = format!("{name}\n");
    for Section { heading, lines, note } in sections.iter().filter(|section| !section.is_empty()) {
        text += &format!("\n{heading}\n");
        let width =
            lines.iter().filter_map(|line| line.label.as_ref()).map(|label| label.chars().count()).max();
        for Line { label, equation, remark } in lines {
            let label = match (label, width) {
                (Some(label), Some(width)) => {
                    let padding = " ".repeat(width - label.chars().count());
                    format!("{label}:{padding} ")
                }
                _ => String::new(),
            };
            let equation = match equation {
                Equation::Known(left, right) => notation.equation(left, right),
                Equation::Complementary(gap, multiplier) => {
                    let [left, right] = notation.complementary(gap, multiplier);
                    left.concat() + " ⊥ " + &right.concat()
                }
                Equation::Term(formula) => notation.write(formula),
                Equation::TooLong(size) => format!("… ({size} symbols)"),
            };
            let remark = remark.spelled(notation, str::to_owned, |formula| formula);
            let remark = if remark.is_empty() { String::new() } else { format!("   {remark}") };
            text += &format!("  {label}{equation}{remark}\n");
        }
        text.extend(note.iter().map(|note| format!("  {note}\n")));
    }
    text
}
