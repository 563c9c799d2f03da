//! What the user wrote, as formulas.

use num_traits::One;

use super::Page;
use super::formula::Formula;
use crate::symbolic::{Rational, Scaled};
use crate::syntax::{Expression, Kind, Operator, Sign, normal_form};

impl Page<'_> {
    pub(super) fn written(&self, expression: &Expression) -> Formula {
        let boxed = |part: &Expression| Box::new(self.written(part));
        let all = |parts: &[Expression]| parts.iter().map(|part| self.written(part)).collect();
        let term = |(sign, term): &(Sign, Expression)| self.written(term).signed(*sign == Sign::Minus);
        match &expression.kind {
            Kind::Number(value) => Formula::number(*value),
            Kind::Name(name) if name.text == "pi" => Formula::Pi,
            Kind::Name(name) => self.named(&name.text),
            Kind::Index(base, index) => self.written(base).indexed(self.written(index)),
            Kind::Member(base, member) => {
                let name = Formula::Name { base: member.text.clone(), dots: 0, indices: Vec::new() };
                Formula::Member(boxed(base), Box::new(name))
            }
            Kind::Slice(slice) => {
                let (from, to) = (boxed(&slice.from), boxed(&slice.to));
                self.written(&slice.base).indexed(Formula::Running { index: None, from, to })
            }
            Kind::Call(name, arguments) => call(&name.text, all(arguments)),
            Kind::SumOver(sum) => Formula::SumOver {
                index: sum.index.text.clone(),
                from: boxed(&sum.from),
                to: boxed(&sum.to),
                body: boxed(&sum.body),
            },
            Kind::Negative(part) => self.written(part).negated(),
            Kind::Sum(terms) => Formula::Sum(terms.iter().map(term).collect()),
            Kind::Product(factors) => self.product(factors),
            Kind::Power(base, exponent) => Formula::Power(boxed(base), boxed(exponent)),
            Kind::Vector(items) => Formula::Vector(all(items)),
        }
    }

    /// A leading `m/2` is read as ½ m: numbers gather in front.
    fn product(&self, factors: &[(Operator, Expression)]) -> Formula {
        let (mut above, mut below, mut number) = (Vec::new(), Vec::new(), Scaled::from(Rational::one()));
        for (operator, factor) in factors {
            let exponent = if *operator == Operator::Times { 1 } else { -1 };
            let gathered = match &factor.kind {
                Kind::Number(value) => value.power(exponent).and_then(|value| number.times(value)),
                _ => None,
            };
            if let Some(gathered) = gathered {
                number = gathered;
                continue;
            }
            let (is_negative, magnitude) = self.written(factor).sign_and_magnitude();
            number.fraction = if is_negative { -number.fraction } else { number.fraction };
            if *operator == Operator::Times { above.push(magnitude) } else { below.push(magnitude) }
        }
        Formula::product(number, above, below)
    }

    /// `x_dot` is x with a dot if x is a coordinate.
    fn named(&self, text: &str) -> Formula {
        let coordinates = || self.problem.coordinates.iter().map(|label| label.text.as_str());
        let is_coordinate =
            |name: &str| coordinates().any(|text| text == name || text.starts_with(&format!("{name}[")));
        for (suffix, combining, dots) in [("_dot", '\u{307}', 1), ("_ddot", '\u{308}', 2)] {
            let dotted = |base: &&str| normal_form(&format!("{base}{combining}")) == text;
            let base = text.strip_suffix(suffix).filter(|base| is_coordinate(base));
            if let Some(base) = base.or_else(|| coordinates().find(dotted)) {
                return Formula::Name { base: base.to_owned(), dots, indices: Vec::new() };
            }
        }
        Formula::Name { base: text.to_owned(), dots: 0, indices: Vec::new() }
    }
}

fn call(name: &str, mut arguments: Vec<Formula>) -> Formula {
    match (name, arguments.len()) {
        ("sqrt", 1) => Formula::Root(Box::new(arguments.remove(0))),
        _ => Formula::Call(name.to_owned(), arguments),
    }
}
