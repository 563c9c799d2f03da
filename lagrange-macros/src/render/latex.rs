//! The page as LaTeX: numbered equations, aligned, with labels, long ones broken before a sign.

use unicode_normalization::UnicodeNormalization;

use super::formula::Formula;
use super::lines::{Equation, Line, Section};
use super::symbols::Notation;
use crate::syntax::GREEK;

/// What fits between the margins of `article` beside the number of an equation, in points.
pub(super) const LINE: f64 = 310.0;

/// A left side wider than this stands on a line of its own.
const LEFT: f64 = 110.0;

/// An `align` environment; `\eqref{eq:Pendulum-theta}` is the equation of `theta`.
pub(super) fn latex(name: &str, sections: &[Section]) -> String {
    let lines: Vec<&Line> = sections.iter().flat_map(|section| &section.lines).collect();
    let sides: Vec<[Vec<String>; 2]> = lines.iter().map(|line| sides(&line.equation)).collect();
    let lefts = sides.iter().map(|[left, _]| width(&left.concat())).filter(|&left| left <= LEFT);
    let column = lefts.fold(0.0, f64::max);
    let mut labels = Vec::new();
    let equations = lines.iter().zip(&sides).map(|(line, [left, right])| {
        let label = format!("\\label{{eq:{name}-{}}}", unique(label(line), &mut labels));
        equation(left, right, column).join(" \\nonumber \\\\\n    ") + " " + &label
    });
    let equations: Vec<String> = equations.collect();
    format!("\\begin{{align}}\n  {}\n\\end{{align}}\n", equations.join(" \\\\\n  "))
}

/// The pieces of both sides.
fn sides(equation: &Equation) -> [Vec<String>; 2] {
    match equation {
        Equation::Known(left, right) => [pieces(left), pieces(right)],
        Equation::Term(formula) => {
            [vec![], [pieces(formula), vec![r" = \text{total time derivative}".to_owned()]].concat()]
        }
        Equation::TooLong(size) => [vec![], vec![format!(r"\text{{({size} symbols)}}")]],
    }
}

/// The lines of an equation.
fn equation(left: &[String], right: &[String], column: f64) -> Vec<String> {
    let rest = LINE - column;
    if left.is_empty() {
        return filled(right, "&", r"&\quad", rest);
    }
    let whole = left.concat();
    if width(&whole) <= LEFT {
        return filled(right, &format!("{whole} &= "), r"&\quad", rest);
    }
    // Of no width, so that it does not move the others to the right.
    let mut lines = filled(left, "", r"\quad", LINE);
    lines.iter_mut().for_each(|line| *line = format!(r"\lefteqn{{{line}}} &"));
    lines.extend(filled(right, "&= ", r"&\quad", rest));
    lines
}

/// Pieces in lines that are no longer than `room`, the first line and the others with what they begin with.
fn filled(pieces: &[String], first: &str, others: &str, room: f64) -> Vec<String> {
    let mut lines = vec![first.to_owned()];
    let mut used = 15.0;
    for piece in pieces {
        let wide = width(piece);
        if used + wide > room && used > 20.0 {
            lines.push(others.to_owned());
            used = 25.0;
        }
        used += wide;
        lines.last_mut().into_iter().for_each(|line| *line += piece);
    }
    lines
}

/// A formula in parts between which a line may end: before its signs and behind its commas, but for those in arguments of
/// commands and between `\left` and `\right`.
fn pieces(formula: &Formula) -> Vec<String> {
    let text = Notation::Latex.write(formula);
    let (mut pieces, mut depth, mut start) = (Vec::new(), 0, 0);
    for (place, sign) in text.char_indices() {
        let rest = &text[place..];
        depth += i32::from(sign == '{' || rest.starts_with(r"\left"))
            - i32::from(sign == '}' || rest.starts_with(r"\right"));
        let is_sign = rest.starts_with(" + ") || rest.starts_with(" - ");
        if depth == 0 && place > start && (is_sign || rest.starts_with(' ') && text[..place].ends_with(',')) {
            pieces.push(text[start..place].to_owned());
            start = place;
        }
    }
    pieces.push(text[start..].to_owned());
    pieces
}

/// What a line is called in labels: `theta` of an equation of motion, and otherwise its left side.
fn label(line: &Line) -> String {
    let name = match (&line.label, &line.equation) {
        (Some(label), _) => label.clone(),
        (None, Equation::Known(left, _)) => Notation::Unicode.write(left),
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

/// The label, with a number where another has it already.
fn unique(label: String, labels: &mut Vec<String>) -> String {
    let count = labels.iter().filter(|known| **known == label).count();
    labels.push(label.clone());
    if count == 0 { label } else { format!("{label}-{}", count + 1) }
}

/// About how wide LaTeX sets this, in points at 10 point.
pub(super) fn width(latex: &str) -> f64 {
    Measure { rest: latex }.all()
}

struct Measure<'a> {
    rest: &'a str,
}

impl<'a> Measure<'a> {
    fn all(&mut self) -> f64 {
        let mut sum = 0.0;
        while let Some(part) = self.next() {
            sum += part;
        }
        sum
    }

    /// The width of the next sign or command, with its arguments.
    fn next(&mut self) -> Option<f64> {
        let sign = self.rest.chars().next()?;
        self.rest = &self.rest[sign.len_utf8()..];
        Some(match sign {
            '\\' => self.command(),
            '{' => Measure { rest: self.group() }.all(),
            '}' | ' ' => 0.0,
            '^' | '_' => 0.75 * self.next().unwrap_or(0.0),
            '+' | '=' => 13.0,
            '-' => 13.0,
            '(' | ')' | '[' | ']' | '|' | ',' | '\'' | '.' => 4.0,
            'm' | 'M' | 'W' => 9.5,
            sign if sign.is_ascii_uppercase() => 7.8,
            _ => 5.6,
        })
    }

    /// What is left of a group that has been opened.
    fn group(&mut self) -> &'a str {
        let mut depth = 1;
        let end = self.rest.find(|sign| {
            depth += i32::from(sign == '{') - i32::from(sign == '}');
            depth == 0
        });
        let (group, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        group
    }

    fn command(&mut self) -> f64 {
        let end = self.rest.find(|sign: char| !sign.is_ascii_alphabetic()).unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(end);
        self.rest = rest;
        match name {
            "" => self.next().map_or(0.0, |_| 2.0),
            "frac" => [self.next(), self.next()].into_iter().flatten().fold(0.0, f64::max) + 3.0,
            "tfrac" => 7.0,
            "sqrt" => 9.0 + self.next().unwrap_or(0.0),
            "sum" => 15.0,
            "sin" | "cos" | "tan" | "exp" | "ln" | "sinh" | "cosh" | "tanh" => 5.2 * name.len() as f64 + 3.0,
            "left" | "right" => self.next().unwrap_or(0.0) + 2.0,
            "lvert" | "rvert" | "bigl" | "bigr" | "quad" => 5.0,
            "cdot" | "times" | "ldots" => 13.0,
            "dot" | "ddot" | "mathit" | "mathrm" | "text" | "operatorname" | "mathbf" | "boldsymbol" => 0.0,
            _ => 6.8,
        }
    }
}
