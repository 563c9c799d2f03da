//! LaTeX mathematics with the package `amsmath`.

use super::parts::{Spelling, WIDE, greek, script};

pub(crate) struct Latex;

/// Widest matrix, in points: a line of `article`, less a short left side.
const WIDEST_MATRIX: f64 = 270.0;
/// Space between the columns of a matrix, in points.
const GAP: f64 = 10.0;

impl Spelling for Latex {
    fn width(&self, text: &str) -> f64 {
        Measure { rest: text }.all()
    }

    fn is_tall(&self, inner: &str) -> bool {
        [r"\frac", r"\sqrt", r"\sum", r"\left", r"\begin"].iter().any(|tall| inner.contains(tall))
    }

    fn nesting(&self, rest: &str) -> i32 {
        let begins = |with: &[&str]| i32::from(with.iter().any(|start| rest.starts_with(start)));
        begins(&["{", r"\left", r"\lvert", r"\begin"]) - begins(&["}", r"\right", r"\rvert", r"\end"])
    }

    fn is_applied(&self, before: &str) -> bool {
        let before = [r"\bigl", r"\left"].iter().fold(before, |before, size| before.trim_end_matches(size));
        before.ends_with(|last: char| last.is_ascii_alphanumeric() || "}'".contains(last))
    }

    fn sign(&self, sign: &str) -> String {
        match sign {
            "·" => r" \cdot ".to_owned(),
            "×" => r" \times ".to_owned(),
            " … " => r" \ldots ".to_owned(),
            " ≤ " => r" \le ".to_owned(),
            " ≥ " => r" \ge ".to_owned(),
            " ⊥ " => r" \perp ".to_owned(),
            "\u{2009}" => r"\,".to_owned(),
            "λ" => r"\lambda".to_owned(),
            "π" => r"\pi".to_owned(),
            "d/dt " => r"\frac{d}{dt} ".to_owned(),
            _ => sign.replace('−', "-"),
        }
    }

    fn digits(&self, digits: &str) -> String {
        digits.to_owned()
    }

    fn small_fraction(&self, above: i128, below: i128) -> String {
        format!(r"\tfrac{{{above}}}{{{below}}}")
    }

    fn letter(&self, name: &str, is_array: bool) -> String {
        let latin = greek(name).map(|(latin, _)| match latin {
            // The standard commands of these letters give other shapes than texts print.
            "phi" => r"\varphi".to_owned(),
            "varphi" => r"\phi".to_owned(),
            "epsilon" => r"\varepsilon".to_owned(),
            latin => format!(r"\{latin}"),
        });
        let script = script(name).map(|capital| format!(r"\mathcal{{{capital}}}"));
        match (latin.or(script), is_array) {
            (Some(letter), true) => format!(r"\boldsymbol{{{letter}}}"),
            (Some(letter), false) => letter,
            (None, true) => format!(r"\mathbf{{{}}}", name.replace('_', r"\_")),
            (None, false) if name.chars().count() > 1 => format!(r"\mathit{{{}}}", name.replace('_', r"\_")),
            (None, false) => name.to_owned(),
        }
    }

    fn word(&self, word: &str) -> String {
        format!(r"\mathrm{{{word}}}")
    }

    fn function(&self, name: &str) -> String {
        match name {
            "sin" | "cos" | "tan" | "sinh" | "cosh" | "tanh" | "exp" | "ln" => format!(r"\{name}"),
            _ => format!(r"\operatorname{{{}}}", name.replace('_', r"\_")),
        }
    }

    fn dotted(&self, letter: String, dots: usize) -> String {
        let accent = ["", r"\dot", r"\ddot"][dots.min(2)];
        match dots {
            0 => letter,
            _ if letter.chars().count() == 1 => format!("{accent} {letter}"),
            _ if is_command(&letter) => format!("{accent}{letter}"),
            _ => format!("{accent}{{{letter}}}"),
        }
    }

    fn indexed(&self, letter: String, below: &[String], indices: &[String]) -> String {
        let all = [below, indices].concat().join(", ");
        if all.is_empty() { letter } else { format!("{letter}_{}", braced(&all)) }
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        format!("{base}^{}", braced(exponent))
    }

    fn transposed(&self, matrix: &str) -> String {
        self.power(matrix, r"\mathsf{T}")
    }

    fn primes(&self, function: &str, order: usize) -> String {
        format!("{function}{}", "'".repeat(order))
    }

    fn root(&self, inner: &str) -> String {
        format!(r"\sqrt{{{inner}}}")
    }

    fn fraction(&self, above: &str, below: &str) -> String {
        format!(r"\frac{{{above}}}{{{below}}}")
    }

    fn between(&self, [open, close]: [&str; 2], inner: &str, is_tall: bool) -> String {
        match is_tall {
            // TeX does not break lines between `\left` and `\right`.
            true if self.width(inner) < WIDE => {
                format!(r"\left{open} {inner} \right{close}")
            }
            true => format!(r"\bigl{open}{inner}\bigr{close}"),
            false if open == "|" => format!(r"\lvert {inner} \rvert"),
            false => format!("{open}{inner}{close}"),
        }
    }

    /// A matrix, or the list of its rows if it is too wide for a line: lines break in a list.
    fn matrix(&self, rows: &[Vec<String>]) -> String {
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let wide =
            |column: usize| rows.iter().map(move |row| row.get(column).map_or(0.0, |text| self.width(text)));
        let width: f64 = (0..columns).map(|column| GAP + wide(column).fold(0.0, f64::max)).sum();
        if width > WIDEST_MATRIX {
            let rows: Vec<String> = rows.iter().map(|row| format!("[{}]", row.join(", "))).collect();
            return format!("[{}]", rows.join(", "));
        }
        let rows: Vec<String> = rows.iter().map(|row| row.join(" & ")).collect();
        format!(r"\begin{{bmatrix}} {} \end{{bmatrix}}", rows.join(r" \\ "))
    }

    fn applied(&self, function: &str, argument: &str, is_bare: bool) -> String {
        format!("{function}{}{argument}", if is_bare { " " } else { "" })
    }

    fn differential(&self, order: usize, of: &str) -> String {
        let order = if order == 1 { String::new() } else { format!("^{}", braced(&order.to_string())) };
        format!(r"\partial{order} {of}")
    }

    fn sum_over(&self, index: &str, from: &str, last: &str, body: &str) -> String {
        format!(r"\sum_{{{index} = {from}}}^{{{last}}} {body}")
    }

    fn sum_where(&self, condition: &str, body: &str) -> String {
        format!(r"\sum_{{{condition}}} {body}")
    }

    fn between_words(&self) -> &'static str {
        r" \, "
    }

    fn beside(&self, before: &str, after: &str) -> &'static str {
        // Two words side by side would run into each other.
        let has_word = |text: &str| text.contains(r"\mathit");
        match after.starts_with(|first: char| first.is_ascii_digit()) {
            true => r" \cdot ",
            false if has_word(after) || before.ends_with('}') && has_word(before) => self.between_words(),
            false => " ",
        }
    }
}

/// Argument of `^` or `_`: a single character or command needs no braces.
fn braced(text: &str) -> String {
    if text.chars().count() == 1 || is_command(text) { text.to_owned() } else { format!("{{{text}}}") }
}

/// Returns whether the text is a command without arguments, such as `\theta`.
fn is_command(text: &str) -> bool {
    text.strip_prefix('\\')
        .is_some_and(|name| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphabetic()))
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

    /// Width of the next character or command, with its arguments.
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

    /// Rest of a group whose opening brace has been read.
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
            "dot" | "ddot" | "mathit" | "mathrm" | "mathcal" | "text" | "operatorname" | "mathbf"
            | "boldsymbol" => 0.0,
            _ => 6.8,
        }
    }
}
