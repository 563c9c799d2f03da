//! Two ways to write a [`Formula`] down: as text in Unicode, and as LaTeX.

use num_traits::{One, Signed};

use super::binding::{Binding, PREFIX, begins_with_function, exponent_at_name, is_number, is_prefixed};
use super::formula::Formula;
use super::latex::{LINE, width};
use super::symbols::{Notation, decimal, point, superscript, vulgar};
use crate::resolve::is_built_in;
use crate::symbolic::{Rational, Scaled, finite_decimal};

impl Notation {
    pub(super) fn write(self, formula: &Formula) -> String {
        match formula {
            Formula::Number(value) => self.number(*value),
            Formula::Scaled(value) => self.scaled(*value),
            Formula::Pi => self.pick("π", r"\pi").to_owned(),
            Formula::Name { base, dots, indices } => self.name(base, *dots, indices),
            Formula::Member(of, member) => self.member(of, member),
            Formula::Entry(whole, index) => self.entry(self.at_least(whole, Binding::Atom), index),
            Formula::Running { index, from, to } => self.running(index.as_deref(), from, to),
            Formula::Multiplier(constraint) => self.subscript(self.pick("λ", r"\lambda"), constraint),
            Formula::Negative(inner) => {
                format!("{}{}", self.pick("−", "-"), self.at_least(inner, Binding::Product))
            }
            Formula::Sum(terms) => self.sum(terms),
            Formula::Product(above, below) => self.product(above, below),
            Formula::Power(base, exponent) => self.power(base, exponent, false),
            Formula::Root(inner) => match self {
                Self::Unicode => format!("√{}", self.at_least(inner, Binding::Atom)),
                Self::Latex => match self.write(inner) {
                    inner if width(&inner) < LINE / 2.0 => format!(r"\sqrt{{{inner}}}"),
                    inner => format!("{}^{{1/2}}", self.parentheses(&inner)),
                },
            },
            Formula::Call(name, arguments) => self.call(name, arguments),
            Formula::SumOver { index, from, to, body } => self.sum_over(index, from, to, body),
            Formula::Vector(items) => self.brackets(&self.list(items)),
            Formula::Derivative { function, order, argument } => {
                let primes = self.pick("′", "'").repeat(*order);
                format!("{}{primes}{}", self.write(function), self.parentheses(&self.write(argument)))
            }
            Formula::Partial { function, by, arguments } => self.partial(function, by, arguments),
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
        if self.binding(formula) >= least { text } else { self.parentheses(&text) }
    }

    fn parentheses(self, inner: &str) -> String {
        self.between("(", inner, ")")
    }

    fn brackets(self, inner: &str) -> String {
        self.between("[", inner, "]")
    }

    fn bars(self, inner: &str) -> String {
        match self {
            Self::Latex if !is_tall(inner) => format!(r"\lvert {inner} \rvert"),
            _ => self.between("|", inner, "|"),
        }
    }

    /// As high as what is inside.
    fn between(self, open: &str, inner: &str, close: &str) -> String {
        match self {
            // Between these no line can end.
            Self::Latex if is_tall(inner) && width(inner) < LINE / 2.0 => {
                format!(r"\left{open} {inner} \right{close}")
            }
            Self::Latex if is_tall(inner) => format!(r"\bigl{open}{inner}\bigr{close}"),
            _ => format!("{open}{inner}{close}"),
        }
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
        match self {
            _ if below.is_empty() => self.factors(above, false),
            Self::Latex => self.fraction(above, below),
            Self::Unicode => {
                let below = match below {
                    // a/2/3 could be read in two ways.
                    [Formula::Number(value)] if !value.is_integer() => self.parentheses(&self.number(*value)),
                    [Formula::Scaled(value)] => self.parentheses(&self.scaled(*value)),
                    [single] => self.at_least(single, Binding::Power),
                    several => self.parentheses(&self.factors(several, false)),
                };
                format!("{}/{below}", self.factors(above, true))
            }
        }
    }

    /// Where it is too wide for a line, with sums beside it, or on one line that may be broken.
    fn fraction(self, above: &[Formula], below: &[Formula]) -> String {
        let [over, under] = [above, below].map(|factors| match factors {
            // The line holds it together.
            [sum @ Formula::Sum(_)] => self.at_least(sum, Binding::Sum),
            factors => self.factors(factors, false),
        });
        let (sums, others): (Vec<Formula>, Vec<Formula>) =
            above.iter().cloned().partition(|factor| matches!(factor, Formula::Sum(_)));
        if width(&over).max(width(&under)) < LINE / 2.0 {
            format!(r"\frac{{{over}}}{{{under}}}")
        } else if width(&under) < LINE / 2.0 && !sums.is_empty() {
            let one = vec![Formula::Number(Rational::one())];
            let before = self.fraction(if others.is_empty() { &one } else { &others }, below);
            format!("{before} {}", self.factors(&sums, true))
        } else {
            format!("{} / ({under})", self.factors(above, true))
        }
    }

    /// Side by side; with a dot between where a number would run into the next.
    fn factors(self, factors: &[Formula], is_followed: bool) -> String {
        let mut text = String::new();
        for (position, factor) in factors.iter().enumerate() {
            let factor = match (factor, factors.get(position + 1)) {
                // What follows must not be taken for part of the dot product.
                (Formula::Call(name, arguments), None) if name == "dot" && !is_followed => {
                    self.call(name, arguments)
                }
                (factor, next) => {
                    self.factor(factor, next.map_or(is_followed, |next| !begins_with_function(next)))
                }
            };
            let begins_with_digit = factor.starts_with(|first: char| first.is_ascii_digit());
            text += match position {
                0 => "",
                _ if begins_with_digit => self.pick(" · ", r" \cdot "),
                // Words would run into each other.
                _ if factor.contains(r"\mathit") || text.ends_with('}') && text.contains(r"\mathit") => {
                    r" \, "
                }
                _ => " ",
            };
            text += &factor;
        }
        text
    }

    /// What follows must not be taken for part of the argument of a sine, or of what a root is taken of.
    fn factor(self, factor: &Formula, is_followed: bool) -> String {
        match factor {
            Formula::Call(name, arguments) if is_prefixed(factor) => {
                self.prefix(name, "", &arguments[0], is_followed)
            }
            Formula::Power(base, exponent) => self.power(base, exponent, is_followed),
            Formula::Root(inner) if self == Self::Unicode && is_followed && is_number(inner) => {
                self.parentheses(&self.write(factor))
            }
            _ => self.at_least(factor, Binding::Power),
        }
    }

    fn power(self, base: &Formula, exponent: &Formula, is_followed: bool) -> String {
        if let (Formula::Call(name, arguments), Some(value)) = (base, exponent_at_name(base, exponent)) {
            let exponent = self.superscript(&value.to_string());
            return self.prefix(name, &exponent, &arguments[0], is_followed);
        }
        let base = self.at_least(base, Binding::Atom);
        match (self, exponent) {
            (Self::Latex, _) => format!("{base}^{}", braced(&self.write(exponent))),
            (Self::Unicode, Formula::Number(value)) if value.is_integer() => {
                format!("{base}{}", superscript(&value.to_string()))
            }
            (Self::Unicode, _) => format!("{base}^{}", self.at_least(exponent, Binding::Atom)),
        }
    }

    /// ∂U/∂x, ∂²U/∂x∂y
    fn partial(self, function: &Formula, by: &[Formula], arguments: &[Formula]) -> String {
        let function = self.write(function);
        let order = if by.len() == 1 { String::new() } else { self.superscript(&by.len().to_string()) };
        let partial = self.pick("∂", r"\partial ");
        let below: String =
            by.iter().map(|x| format!("{partial}{}", self.at_least(x, Binding::Atom))).collect();
        let derivative = match self {
            Self::Unicode => format!("∂{order}{function}/{below}"),
            Self::Latex => format!(r"\frac{{\partial{order} {function}}}{{{below}}}"),
        };
        if arguments.is_empty() {
            return derivative;
        }
        format!("{}{}", self.parentheses(&derivative), self.parentheses(&self.list(arguments)))
    }

    fn superscript(self, digits: &str) -> String {
        if self == Self::Latex { format!("^{}", braced(digits)) } else { superscript(digits) }
    }

    fn call(self, name: &str, arguments: &[Formula]) -> String {
        match (name, arguments) {
            ("abs" | "norm", [x]) => self.bars(&self.write(x)),
            ("dot", [x, y]) => self.infix(x, self.pick("·", r" \cdot "), y),
            ("cross", [x, y]) => self.infix(x, self.pick("×", r" \times "), y),
            ("der", [x]) => {
                format!("{}{}", self.pick("d/dt ", r"\frac{d}{dt} "), self.at_least(x, Binding::Power))
            }
            (name, [x]) if PREFIX.contains(&name) => self.prefix(name, "", x, false),
            _ => format!("{}{}", self.function(name), self.parentheses(&self.list(arguments))),
        }
    }

    /// The name of a function: upright if it has a fixed meaning.
    fn function(self, name: &str) -> String {
        match self {
            Self::Latex if is_built_in(name) => {
                format!(r"\operatorname{{{}}}", name.replace('_', r"\_"))
            }
            _ => self.write(&Formula::labelled(name, 0)),
        }
    }

    /// sin x, sin² x, sin(2 x)
    fn prefix(self, name: &str, exponent: &str, x: &Formula, is_followed: bool) -> String {
        let backslash = self.pick("", r"\");
        match x {
            Formula::Name { .. } | Formula::Pi if !is_followed => {
                format!("{backslash}{name}{exponent} {}", self.write(x))
            }
            _ => format!("{backslash}{name}{exponent}{}", self.parentheses(&self.write(x))),
        }
    }

    fn infix(self, x: &Formula, operator: &str, y: &Formula) -> String {
        format!("{}{operator}{}", self.factor(x, true), self.at_least(y, Binding::Power))
    }

    fn sum_over(self, index: &str, from: &Formula, to: &Formula, body: &Formula) -> String {
        let body = self.at_least(body, Binding::Product);
        match self {
            Self::Unicode => format!("Σ({}) {body}", self.running(Some(index), from, to)),
            Self::Latex => {
                let (from, last) = (self.write(from), self.last(to));
                format!(r"\sum_{{{index} = {from}}}^{{{last}}} {body}")
            }
        }
    }

    /// i = 0 … 2
    fn running(self, index: Option<&str>, from: &Formula, to: &Formula) -> String {
        let index = index.map_or(String::new(), |index| format!("{index} = "));
        format!("{index}{} {} {}", self.write(from), self.pick("…", r"\ldots"), self.last(to))
    }

    /// The whole number before `end`.
    fn last(self, end: &Formula) -> String {
        match end {
            Formula::Number(value) => self.number(value - Rational::one()),
            end => format!("{} {} 1", self.write(end), self.pick("−", "-")),
        }
    }

    fn entry(self, whole: String, index: &Formula) -> String {
        match self {
            Self::Unicode => format!("{whole}[{}]", self.write(index)),
            Self::Latex => format!("{whole}_{}", braced(&self.write(index))),
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

    /// 6.62607015×10⁻³⁴
    fn scaled(self, Scaled { fraction, exponent }: Scaled) -> String {
        let power = format!("10{}", self.superscript(&exponent.to_string()));
        let digits = finite_decimal(fraction).map_or_else(|| self.parentheses(&self.number(fraction)), point);
        if fraction.is_one() { power } else { format!("{digits}{}{power}", self.pick("×", r" \times ")) }
    }
}

/// As the argument of `^` and `_`: a single sign needs no braces.
pub(super) fn braced(text: &str) -> String {
    if text.chars().count() == 1 || is_command(text) { text.to_owned() } else { format!("{{{text}}}") }
}

/// Whether it is a command without arguments, such as `\theta`.
pub(super) fn is_command(text: &str) -> bool {
    text.strip_prefix('\\')
        .is_some_and(|name| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphabetic()))
}

/// Whether parentheses around it must be higher than a line.
fn is_tall(inner: &str) -> bool {
    [r"\frac", r"\sqrt", r"\sum", r"\left"].iter().any(|tall| inner.contains(tall))
}
