//! Two ways to write a [`Formula`] down: as text in Unicode, and as LaTeX.

use num_traits::{One, Signed};

use super::formula::Formula;
use crate::symbolic::Rational;

/// How tightly a formula holds together: what is looser than its surroundings needs parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Power,
    Atom,
}

/// A way of writing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Notation {
    Unicode,
    Latex,
}

impl Notation {
    pub(super) fn write(self, formula: &Formula) -> String {
        match formula {
            Formula::Number(value) => self.number(*value),
            Formula::Pi => self.pick("π", r"\pi").to_owned(),
            Formula::Name { base, dots, indices } => self.name(base, *dots, indices),
            Formula::Multiplier(constraint) => self.subscript(self.pick("λ", r"\lambda"), constraint),
            Formula::Negative(inner) => {
                format!("{}{}", self.pick("−", "-"), self.at_least(inner, Binding::Product))
            }
            Formula::Sum(terms) => self.sum(terms),
            Formula::Product(above, below) => self.product(above, below),
            Formula::Power(base, exponent) => self.power(base, exponent),
            Formula::Root(inner) => match self {
                Self::Unicode => format!("√{}", self.at_least(inner, Binding::Atom)),
                Self::Latex => format!(r"\sqrt{{{}}}", self.write(inner)),
            },
            Formula::Call(name, arguments) => self.call(name, arguments),
            Formula::SumOver { index, from, to, body } => self.sum_over(index, from, to, body),
            Formula::Vector(items) => self.brackets(&self.list(items)),
            Formula::Partial { function, by } => self.partial(function, by),
        }
    }

    /// left = right
    pub(super) fn equation(self, left: &Formula, right: &Formula) -> String {
        format!("{} = {}", self.write(left), self.write(right))
    }

    fn pick(self, text: &'static str, latex: &'static str) -> &'static str {
        if self == Self::Unicode { text } else { latex }
    }

    fn at_least(self, formula: &Formula, least: Binding) -> String {
        let text = self.write(formula);
        if binding(formula) >= least { text } else { self.parentheses(&text) }
    }

    fn parentheses(self, inner: &str) -> String {
        format!("{}{inner}{}", self.pick("(", r"\left("), self.pick(")", r"\right)"))
    }

    fn brackets(self, inner: &str) -> String {
        format!("{}{inner}{}", self.pick("[", r"\left["), self.pick("]", r"\right]"))
    }

    fn list(self, items: &[Formula]) -> String {
        items.iter().map(|item| self.write(item)).collect::<Vec<_>>().join(", ")
    }

    fn sum(self, terms: &[Formula]) -> String {
        let minus = self.pick("−", "-");
        let mut text = String::new();
        for (position, term) in terms.iter().enumerate() {
            let (is_negative, magnitude) = term.sign_and_magnitude();
            let part = self.at_least(&magnitude, Binding::Product);
            text += match (position, is_negative) {
                (0, false) => "",
                (0, true) => minus,
                (_, false) => " + ",
                (_, true) => self.pick(" − ", " - "),
            };
            text += &part;
        }
        text
    }

    fn product(self, above: &[Formula], below: &[Formula]) -> String {
        let join = |factors: &[Formula]| {
            let parts: Vec<_> = factors.iter().map(|factor| self.at_least(factor, Binding::Power)).collect();
            parts.join(self.pick(" ", r" \, "))
        };
        if below.is_empty() {
            return join(above);
        }
        match self {
            Self::Latex => format!(r"\frac{{{}}}{{{}}}", join(above), join(below)),
            Self::Unicode if below.len() == 1 => {
                format!("{}/{}", join(above), self.at_least(&below[0], Binding::Power))
            }
            Self::Unicode => format!("{}/({})", join(above), join(below)),
        }
    }

    fn power(self, base: &Formula, exponent: &Formula) -> String {
        // The exponent of a function stands at its name: sin² x.
        if let (Formula::Call(name, arguments), Formula::Number(value)) = (base, exponent)
            && let ([x], true) = (&arguments[..], PREFIX.contains(&name.as_str()) && value.is_integer())
        {
            let exponent = match self {
                Self::Unicode => superscript(&value.to_string()),
                Self::Latex => format!("^{{{value}}}"),
            };
            return self.prefix(name, &exponent, x);
        }
        let base = self.at_least(base, Binding::Atom);
        match (self, exponent) {
            (Self::Latex, _) => format!("{base}^{{{}}}", self.write(exponent)),
            (Self::Unicode, Formula::Number(value)) if value.is_integer() => {
                format!("{base}{}", superscript(&value.to_string()))
            }
            (Self::Unicode, _) => format!("{base}^{}", self.at_least(exponent, Binding::Atom)),
        }
    }

    /// ∂U/∂x, ∂²U/∂x∂y
    fn partial(self, function: &str, by: &[Formula]) -> String {
        let function = self.write(&Formula::labelled(function, 0));
        let order = if by.len() == 1 { String::new() } else { self.superscript(&by.len().to_string()) };
        let partial = self.pick("∂", r"\partial ");
        let below: String =
            by.iter().map(|x| format!("{partial}{}", self.at_least(x, Binding::Atom))).collect();
        match self {
            Self::Unicode => format!("∂{order}{function}/{below}"),
            Self::Latex => format!(r"\frac{{\partial{order} {function}}}{{{below}}}"),
        }
    }

    fn superscript(self, digits: &str) -> String {
        if self == Self::Latex { format!("^{{{digits}}}") } else { superscript(digits) }
    }

    fn call(self, name: &str, arguments: &[Formula]) -> String {
        match (name, arguments) {
            ("abs", [x]) => {
                format!("{}{}{}", self.pick("|", r"\left|"), self.write(x), self.pick("|", r"\right|"))
            }
            ("norm", [x]) => {
                format!("{}{}{}", self.pick("|", r"\left|"), self.write(x), self.pick("|", r"\right|"))
            }
            ("dot", [x, y]) => self.infix(x, self.pick("·", r" \cdot "), y),
            ("cross", [x, y]) => self.parentheses(&self.infix(x, self.pick("×", r" \times "), y)),
            ("der", [x]) => {
                format!("{}{}", self.pick("d/dt ", r"\frac{d}{dt} "), self.at_least(x, Binding::Power))
            }
            (name, [x]) if PREFIX.contains(&name) => self.prefix(name, "", x),
            _ => {
                let name =
                    if self == Self::Latex { format!(r"\operatorname{{{name}}}") } else { name.to_owned() };
                format!("{name}{}", self.parentheses(&self.list(arguments)))
            }
        }
    }

    /// sin x, sin² x, sin(2 x)
    fn prefix(self, name: &str, exponent: &str, x: &Formula) -> String {
        let backslash = self.pick("", r"\");
        match x {
            Formula::Name { .. } | Formula::Pi => format!("{backslash}{name}{exponent} {}", self.write(x)),
            _ => format!("{backslash}{name}{exponent}{}", self.parentheses(&self.write(x))),
        }
    }

    fn infix(self, x: &Formula, operator: &str, y: &Formula) -> String {
        format!("{}{operator}{}", self.at_least(x, Binding::Power), self.at_least(y, Binding::Power))
    }

    fn sum_over(self, index: &str, from: &Formula, to: &Formula, body: &Formula) -> String {
        let (from, to, body) = (self.write(from), self.write(to), self.at_least(body, Binding::Product));
        match self {
            Self::Unicode => format!("Σ({index} = {from} … {to} − 1) {body}"),
            Self::Latex => format!(r"\sum_{{{index} = {from}}}^{{{to} - 1}} {body}"),
        }
    }

    fn number(self, value: Rational) -> String {
        let sign = if value.is_negative() { self.pick("−", "-") } else { "" };
        let (numerator, denominator) = (value.numer().abs(), *value.denom());
        if denominator == 1 {
            return format!("{sign}{numerator}");
        }
        if let Some(decimal) = decimal(value.abs()) {
            return format!("{sign}{decimal}");
        }
        match self {
            Self::Latex => format!(r"{sign}\tfrac{{{numerator}}}{{{denominator}}}"),
            Self::Unicode => match vulgar(numerator, denominator) {
                Some(fraction) => format!("{sign}{fraction}"),
                None => format!("{sign}{numerator}/{denominator}"),
            },
        }
    }

    /// Greek by their names; dots above the last letter; indices below.
    fn name(self, base: &str, dots: usize, indices: &[String]) -> String {
        let (base, tail) = match base.split_once('_') {
            Some((base, tail)) if !base.is_empty() && !tail.is_empty() => (base, Some(tail)),
            _ => (base, None),
        };
        let letter = self.letter(base);
        let letter = match (self, dots) {
            (_, 0) => letter,
            (Self::Unicode, 1) => crate::syntax::normal_form(&format!("{letter}\u{307}")),
            (Self::Unicode, _) => crate::syntax::normal_form(&format!("{letter}\u{308}")),
            (Self::Latex, 1) => format!(r"\dot{{{letter}}}"),
            (Self::Latex, _) => format!(r"\ddot{{{letter}}}"),
        };
        match (self, tail) {
            (Self::Latex, _) if tail.is_some() || !indices.is_empty() => {
                let below: Vec<String> =
                    tail.map(|tail| self.letter(tail)).into_iter().chain(indices.to_vec()).collect();
                format!("{letter}_{{{}}}", below.join(", "))
            }
            _ => {
                let tail = tail.map(|tail| format!("_{tail}")).unwrap_or_default();
                let indices: String = indices.iter().map(|index| format!("[{index}]")).collect();
                format!("{letter}{tail}{indices}")
            }
        }
    }

    fn letter(self, name: &str) -> String {
        match (self, GREEK.iter().find(|(latin, _)| *latin == name)) {
            (Self::Unicode, Some((_, greek))) => (*greek).to_owned(),
            (Self::Latex, Some((latin, _))) => format!(r"\{latin}"),
            (Self::Latex, None) if name.chars().count() > 1 => {
                format!(r"\mathit{{{}}}", name.replace('_', r"\_"))
            }
            _ => name.to_owned(),
        }
    }

    fn subscript(self, base: &str, below: &str) -> String {
        match self {
            Self::Unicode => format!("{base}_{below}"),
            Self::Latex => format!(r"{base}_{{\mathrm{{{}}}}}", below.replace('_', r"\_")),
        }
    }
}

/// Functions that are written without parentheses before a single name.
const PREFIX: [&str; 8] = ["sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "ln"];

fn binding(formula: &Formula) -> Binding {
    match formula {
        Formula::Number(value) if value.is_negative() => Binding::Sum,
        Formula::Negative(_) => Binding::Sum,
        Formula::Sum(_) | Formula::SumOver { .. } => Binding::Sum,
        Formula::Product(..) => Binding::Product,
        Formula::Power(..) => Binding::Power,
        // `sin x` holds like a factor, not like the base of a power.
        Formula::Call(..) => Binding::Power,
        Formula::Number(value) if !value.denom().is_one() => Binding::Power,
        _ => Binding::Atom,
    }
}

/// A finite decimal such as 9.81; simple fractions are read better as such.
fn decimal(value: Rational) -> Option<String> {
    let mut denominator = *value.denom();
    if denominator < 16 {
        return None;
    }
    let mut digits = 0;
    while denominator % 10 == 0 {
        denominator /= 10;
        digits += 1;
    }
    while denominator > 1 && digits < 12 {
        let factor = if denominator % 2 == 0 { 2 } else { 5 };
        if denominator % factor != 0 {
            return None;
        }
        denominator /= factor;
        digits += 1;
    }
    let scaled = value.numer().checked_mul(10_i128.checked_pow(digits)?)? / value.denom();
    let text = format!("{scaled:0>width$}", width = digits as usize + 1);
    let (whole, fraction) = text.split_at(text.len() - digits as usize);
    Some(format!("{whole}.{}", fraction.trim_end_matches('0')))
}

fn vulgar(numerator: i128, denominator: i128) -> Option<char> {
    const KNOWN: [(i128, i128, char); 15] = [
        (1, 2, '½'),
        (1, 3, '⅓'),
        (2, 3, '⅔'),
        (1, 4, '¼'),
        (3, 4, '¾'),
        (1, 5, '⅕'),
        (2, 5, '⅖'),
        (3, 5, '⅗'),
        (4, 5, '⅘'),
        (1, 6, '⅙'),
        (5, 6, '⅚'),
        (1, 8, '⅛'),
        (3, 8, '⅜'),
        (5, 8, '⅝'),
        (7, 8, '⅞'),
    ];
    KNOWN.iter().find(|(n, d, _)| (*n, *d) == (numerator, denominator)).map(|(_, _, fraction)| *fraction)
}

fn superscript(digits: &str) -> String {
    digits
        .chars()
        .map(|digit| match digit {
            '-' => '⁻',
            digit => {
                ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize]
            }
        })
        .collect()
}

const GREEK: [(&str, &str); 33] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("iota", "ι"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("upsilon", "υ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Gamma", "Γ"),
    ("Delta", "Δ"),
    ("Theta", "Θ"),
    ("Lambda", "Λ"),
    ("Xi", "Ξ"),
    ("Sigma", "Σ"),
    ("Phi", "Φ"),
    ("Psi", "Ψ"),
    ("Omega", "Ω"),
    ("varphi", "φ"),
    ("vartheta", "ϑ"),
];
