//! Writes a [`Formula`] by one set of rules for signs and parentheses. A [`Spelling`] provides the parts.

use num_traits::{One, Signed, Zero};

use super::arrays::Arrays;
use super::binding::{Binding, PREFIX, begins_with_function, exponent_at_name, is_prefixed};
use super::digits::{decimal, point};
use super::formula::Formula;
use super::letters::{Letters, PageQuantity};
use super::spelling::{Latex, MathMl, Spelling, Unicode, WIDE};
use crate::resolve::{is_built_in, is_of_frames, is_step};
use crate::symbolic::{Rational, Scaled, finite_decimal};

/// A spelling, the names of arrays, which are bold, and the letters of the page.
#[derive(Clone, Copy)]
pub(super) struct Notation<'a> {
    pub(super) spelling: &'static dyn Spelling,
    arrays: Option<&'a Arrays>,
    letters: Option<&'a Letters>,
}

impl Notation<'static> {
    pub(super) const UNICODE: Self = Self { spelling: &Unicode, arrays: None, letters: None };
    pub(super) const LATEX: Self = Self { spelling: &Latex, arrays: None, letters: None };
    pub(super) const MATHML: Self = Self { spelling: &MathMl, arrays: None, letters: None };
}

impl<'a> Notation<'a> {
    /// The same notation with these names as arrays, and with the letters of a page.
    pub(super) fn with(self, arrays: &'a Arrays, letters: &'a Letters) -> Self {
        Self { arrays: Some(arrays), letters: Some(letters), ..self }
    }

    /// Letter of the multipliers.
    pub(super) fn multiplier_letter(self) -> &'a str {
        self.letters.map_or("lambda", |letters| letters.letter(PageQuantity::Multiplier))
    }

    /// The name by which programs ask for the row with this left side.
    pub(super) fn standard(self, left: &Formula) -> Formula {
        self.letters.map_or_else(|| left.clone(), |letters| letters.standard(left))
    }

    pub(super) fn is_array(self, formula: &Formula) -> bool {
        self.arrays.is_some_and(|arrays| arrays.contains(formula))
    }

    pub(super) fn write(self, formula: &Formula) -> String {
        let spelling = self.spelling;
        match formula {
            Formula::Number(value) => self.number(*value),
            Formula::Scaled(value) => self.scaled(*value),
            Formula::Pi => spelling.sign("π"),
            Formula::Name { .. } => self.name(formula),
            Formula::Member(of, member) => self.member(of, member),
            Formula::Entry(whole, index) => {
                spelling.indexed(self.at_least(whole, Binding::Atom), &[], &[self.write(index)])
            }
            Formula::Running { index, from, to } => self.running(index.as_deref(), from, to),
            Formula::Multiplier(constraint) => self.multiplier(constraint),
            Formula::Negative(inner) => spelling.sign("−") + &self.at_least(inner, Binding::Product),
            Formula::Sum(terms) => self.sum(terms),
            Formula::Product(above, below) => self.product(above, below),
            Formula::Power(base, exponent) => self.power(base, exponent, false),
            Formula::Root(inner) if spelling.is_flat() => spelling.root(&self.at_least(inner, Binding::Atom)),
            Formula::Root(inner) => match self.write(inner) {
                inner if spelling.width(&inner) < WIDE => spelling.root(&inner),
                inner => spelling.power(&self.parentheses(&inner), &self.slashed("1", "2")),
            },
            Formula::Call(name, arguments) => self.call(name, arguments),
            Formula::SumOver { index, from, to, body } => self.sum_over(index, from, to, body),
            Formula::SumWhere { condition, sign, body } => {
                let [left, right] = condition.each_ref().map(|formula| self.write(formula));
                let condition = left + &self.spelling.sign(&format!(" {sign} ")) + &right;
                self.spelling.sum_where(&condition, &self.at_least(body, Binding::Product))
            }
            Formula::Vector(items) => self.vector(items),
            Formula::Transpose(matrix) => spelling.transposed(&self.at_least(matrix, Binding::Atom)),
            Formula::Derivative { function, order, argument } => {
                let function = spelling.primes(&self.write(function), *order);
                spelling.applied(&function, &self.parentheses(&self.write(argument)), false)
            }
            Formula::Partial { function, by, arguments } => self.partial(function, by, arguments),
        }
    }

    /// Writes left = right.
    pub(super) fn equation(self, left: &Formula, right: &Formula) -> String {
        self.write(left) + &self.spelling.sign(" = ") + &self.write(right)
    }

    /// Pieces of 0 ≤ gap, and of λ ≥ 0.
    pub(super) fn complementary(self, gap: &Formula, multiplier: &Formula) -> [Vec<String>; 2] {
        let [mut left, mut right] = [gap, multiplier].map(|formula| self.pieces(formula));
        let zero = self.spelling.digits("0");
        left[0].insert_str(0, &(zero.clone() + &self.spelling.sign(" ≤ ")));
        right.push(self.spelling.sign(" ≥ ") + &zero);
        [left, vec![right.concat()]]
    }

    fn slashed(self, above: &str, below: &str) -> String {
        self.spelling.digits(above) + &self.spelling.sign("/") + &self.spelling.digits(below)
    }

    fn at_least(self, formula: &Formula, least: Binding) -> String {
        let text = self.write(formula);
        if Binding::of(formula, self.spelling.is_flat()) >= least { text } else { self.parentheses(&text) }
    }

    fn parentheses(self, inner: &str) -> String {
        self.between(["(", ")"], inner)
    }

    /// Encloses text in brackets as tall as the text.
    fn between(self, bounds: [&str; 2], inner: &str) -> String {
        self.spelling.between(bounds, inner, self.spelling.is_tall(inner))
    }

    fn list(self, items: &[Formula]) -> String {
        items.iter().map(|item| self.write(item)).collect::<Vec<_>>().join(&self.spelling.sign(", "))
    }

    /// Writes a vector. A vector of vectors is a matrix.
    fn vector(self, items: &[Formula]) -> String {
        let row = |item: &Formula| match item {
            Formula::Vector(row) => Some(row.iter().map(|entry| self.write(entry)).collect::<Vec<_>>()),
            _ => None,
        };
        match items.iter().map(row).collect::<Option<Vec<_>>>() {
            Some(rows) => self.spelling.matrix(&rows),
            None => self.between(["[", "]"], &self.list(items)),
        }
    }

    fn sum(self, terms: &[Formula]) -> String {
        let mut text = String::new();
        for (position, term) in terms.iter().enumerate() {
            let (is_negative, magnitude) = term.sign_and_magnitude();
            let sign = match (position, is_negative) {
                (0, false) => "",
                (0, true) => "−",
                (_, false) => " + ",
                (_, true) => " − ",
            };
            text += &if sign.is_empty() { String::new() } else { self.spelling.sign(sign) };
            text += &self.at_least(&magnitude, Binding::Product);
        }
        text
    }

    fn product(self, above: &[Formula], below: &[Formula]) -> String {
        match below {
            [] => self.factors(above, false),
            _ if self.spelling.is_flat() => self.on_a_line(above, below),
            _ => self.fraction(above, below),
        }
    }

    fn on_a_line(self, above: &[Formula], below: &[Formula]) -> String {
        let below = match below {
            // a/2/3 is ambiguous.
            [number @ Formula::Number(value)] if !value.is_integer() => self.parentheses(&self.write(number)),
            [number @ Formula::Scaled(_)] => self.parentheses(&self.write(number)),
            [single] => self.at_least(single, Binding::Power),
            several => self.parentheses(&self.factors(several, false)),
        };
        self.spelling.fraction(&self.factors(above, true), &below)
    }

    /// Writes a fraction with a bar. If it is too wide, moves the sums of the numerator behind it, as in (1/b)(x +
    /// y); if that does not help, writes a / (b), where lines may break.
    fn fraction(self, above: &[Formula], below: &[Formula]) -> String {
        let [over, under] = [above, below].map(|factors| match factors {
            // The fraction bar groups a single sum, so it needs no parentheses.
            [sum @ Formula::Sum(_)] => self.at_least(sum, Binding::Sum),
            factors => self.factors(factors, false),
        });
        let (sums, others): (Vec<Formula>, Vec<Formula>) =
            above.iter().cloned().partition(|factor| matches!(factor, Formula::Sum(_)));
        let is_narrow = |text: &str| self.spelling.width(text) < WIDE;
        if is_narrow(&over) && is_narrow(&under) {
            self.spelling.fraction(&over, &under)
        } else if is_narrow(&under) && !sums.is_empty() && is_narrow(&self.factors(&others, false)) {
            let one = vec![Formula::Number(Rational::one())];
            let before = self.fraction(if others.is_empty() { &one } else { &others }, below);
            let sums = self.factors(&sums, true);
            format!("{before}{}{sums}", self.spelling.beside(&before, &sums))
        } else {
            self.factors(above, true) + &self.spelling.sign(" / ") + &self.parentheses(&under)
        }
    }

    /// Writes factors side by side, with a dot where a number would run into the next factor.
    fn factors(self, factors: &[Formula], is_followed: bool) -> String {
        let (mut text, words) = (String::new(), words(factors));
        for (position, factor) in factors.iter().enumerate() {
            let factor = match (factor, factors.get(position + 1)) {
                // A factor after a dot product or a sum would be read as part of it.
                (Formula::Call(name, arguments), None) if name == "dot" && !is_followed => {
                    self.call(name, arguments)
                }
                (Formula::SumOver { .. } | Formula::SumWhere { .. }, None) if !is_followed => {
                    self.write(factor)
                }
                (factor, next) => {
                    self.factor(factor, next.map_or(is_followed, |next| !begins_with_function(next)))
                }
            };
            text += match position {
                0 => "",
                _ if words.contains(&position) => self.spelling.between_words(),
                _ => self.spelling.beside(&text, &factor),
            };
            text += &factor;
        }
        text
    }

    /// Writes a factor. A following factor must not be read as part of the argument of a sine, or of a root.
    fn factor(self, factor: &Formula, is_followed: bool) -> String {
        match factor {
            Formula::Call(name, arguments) if is_prefixed(factor) => {
                self.prefix(name, None, &arguments[0], is_followed)
            }
            Formula::Power(base, exponent) => self.power(base, exponent, is_followed),
            Formula::Root(inner)
                if self.spelling.is_flat() && is_followed && matches!(**inner, Formula::Number(_)) =>
            {
                self.parentheses(&self.write(factor))
            }
            _ => self.at_least(factor, Binding::Power),
        }
    }

    fn power(self, base: &Formula, exponent: &Formula, is_followed: bool) -> String {
        if let (Formula::Call(name, arguments), Some(value)) = (base, exponent_at_name(base, exponent)) {
            return self.prefix(name, Some(value), &arguments[0], is_followed);
        }
        let exponent = match exponent {
            Formula::Number(value) if value.is_integer() => self.number(*value),
            Formula::Number(value) => self.slanted(*value),
            exponent if self.spelling.is_flat() => self.at_least(exponent, Binding::Atom),
            exponent => self.write(exponent),
        };
        self.spelling.power(&self.at_least(base, Binding::Atom), &exponent)
    }

    /// Writes a fraction in an exponent, such as 3/2.
    fn slanted(self, value: Rational) -> String {
        let sign = if value.is_negative() { self.spelling.sign("−") } else { String::new() };
        let [above, below] = [value.numer().abs(), *value.denom()].map(|number| number.to_string());
        let fraction = sign + &self.slashed(&above, &below);
        if self.spelling.is_flat() { self.parentheses(&fraction) } else { fraction }
    }

    /// Writes a partial derivative: ∂U/∂x, ∂²U/∂x∂y.
    fn partial(self, function: &Formula, by: &[Formula], arguments: &[Formula]) -> String {
        let spelling = self.spelling;
        let below: String =
            by.iter().map(|x| spelling.differential(1, &self.at_least(x, Binding::Atom))).collect();
        let derivative = spelling.fraction(&spelling.differential(by.len(), &self.write(function)), &below);
        if arguments.is_empty() {
            return derivative;
        }
        spelling.applied(&self.parentheses(&derivative), &self.parentheses(&self.list(arguments)), false)
    }

    fn call(self, name: &str, arguments: &[Formula]) -> String {
        match (name, arguments) {
            ("abs" | "norm", [x]) => self.between(["|", "|"], &self.write(x)),
            ("dot", [x, y]) => self.infix(x, "·", y),
            ("cross", [x, y]) => self.infix(x, "×", y),
            ("der", [x]) => self.spelling.sign("d/dt ") + &self.at_least(x, Binding::Power),
            (name, [x]) if PREFIX.contains(&name) => self.prefix(name, None, x, false),
            _ => {
                let arguments = self.parentheses(&self.list(arguments));
                self.spelling.applied(&self.function(name), &arguments, false)
            }
        }
    }

    /// Writes the name of a function, upright for a built-in.
    fn function(self, name: &str) -> String {
        match is_built_in(name) || is_of_frames(name) || is_step(name) {
            true => self.spelling.function(name),
            false => self.write(&Formula::labelled(name, 0)),
        }
    }

    /// Writes a function before its argument: sin x, sin² x, sin(2 x).
    fn prefix(self, name: &str, exponent: Option<Rational>, x: &Formula, is_followed: bool) -> String {
        let name = self.spelling.function(name);
        let function = match exponent {
            Some(exponent) => self.spelling.power(&name, &self.number(exponent)),
            None => name,
        };
        let is_bare = !is_followed && matches!(x, Formula::Name { .. } | Formula::Pi);
        let argument = self.write(x);
        self.spelling.applied(
            &function,
            &if is_bare { argument } else { self.parentheses(&argument) },
            is_bare,
        )
    }

    fn infix(self, x: &Formula, operator: &str, y: &Formula) -> String {
        self.factor(x, true) + &self.spelling.sign(operator) + &self.at_least(y, Binding::Power)
    }

    fn sum_over(self, index: &str, from: &Formula, to: &Formula, body: &Formula) -> String {
        let index = self.write(&Formula::labelled(index, 0));
        let body = self.at_least(body, Binding::Product);
        self.spelling.sum_over(&index, &self.write(from), &self.last(to), &body)
    }

    /// Writes the range of a running index: i = 0 … 2.
    fn running(self, index: Option<&str>, from: &Formula, to: &Formula) -> String {
        let index = index.map_or(String::new(), |index| {
            self.write(&Formula::labelled(index, 0)) + &self.spelling.sign(" = ")
        });
        index + &self.write(from) + &self.spelling.sign(" … ") + &self.last(to)
    }

    /// Writes the integer before `end`, the last value of a range.
    fn last(self, end: &Formula) -> String {
        match end {
            Formula::Number(value) => self.number(value - Rational::one()),
            Formula::Sum(terms) => self.write(&before(terms)),
            end => self.write(end) + &self.spelling.sign(" − ") + &self.spelling.digits("1"),
        }
    }

    fn number(self, value: Rational) -> String {
        let sign = if value.is_negative() { self.spelling.sign("−") } else { String::new() };
        let magnitude = match (value.denom(), decimal(value.abs())) {
            (1, _) => self.spelling.digits(&value.numer().abs().to_string()),
            (_, Some(decimal)) => self.spelling.digits(&decimal),
            (denominator, None) => self.spelling.small_fraction(value.numer().abs(), *denominator),
        };
        sign + &magnitude
    }

    /// Writes a number with a power of ten: 6.62607015×10⁻³⁴.
    fn scaled(self, Scaled { fraction, exponent }: Scaled) -> String {
        let exponent = self.number(Rational::from_integer(exponent.into()));
        let power = self.spelling.power(&self.spelling.digits("10"), &exponent);
        if fraction.is_one() {
            return power;
        }
        let digits = match finite_decimal(fraction) {
            Some(digits) => self.spelling.digits(&point(digits)),
            None => self.parentheses(&self.number(fraction)),
        };
        digits + &self.spelling.sign("×") + &power
    }
}

/// Places of factors that would form a word with the ones before: three single Latin letters or more, a vowel among them,
/// as in m a g. A space sets them apart.
fn words(factors: &[Formula]) -> Vec<usize> {
    let letter = |factor: &Formula| match factor {
        Formula::Name { base, dots: 0, indices } if indices.is_empty() && base.len() == 1 => {
            base.chars().next()
        }
        _ => None,
    };
    let letters: Vec<Option<char>> = factors.iter().map(letter).collect();
    let mut places = Vec::new();
    let mut first = 0;
    for run in letters.chunk_by(|one, other| one.is_some() == other.is_some()) {
        let is_vowel = |letter: &Option<char>| letter.is_some_and(|letter| "aeiouAEIOU".contains(letter));
        if run.len() > 2 && run.iter().any(is_vowel) {
            places.extend(first + 1..first + run.len());
        }
        first += run.len();
    }
    places
}

/// The whole number before a sum of names and whole numbers.
fn before(terms: &[Formula]) -> Formula {
    let (mut number, mut others) = (-Rational::one(), Vec::new());
    for term in terms {
        match term {
            Formula::Number(value) => number += value,
            Formula::Negative(inner) if let Formula::Number(value) = &**inner => number -= value,
            other => others.push(other.clone()),
        }
    }
    if !number.is_zero() {
        others.push(Formula::Number(number));
    }
    Formula::sum(others)
}
