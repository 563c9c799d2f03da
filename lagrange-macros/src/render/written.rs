//! What the user wrote, as formulas.

use num_traits::One;

use super::formula::Formula;
use crate::resolve::Problem;
use crate::symbolic::{Rational, Scaled};
use crate::syntax::{Expression, Kind, Operator, Sign};

pub(super) fn written(expression: &Expression, problem: &Problem) -> Formula {
    let inner = |part: &Expression| written(part, problem);
    match &expression.kind {
        Kind::Number(value) => Formula::number(*value),
        Kind::Name(name) if name.text == "pi" => Formula::Pi,
        Kind::Name(name) => named(&name.text, problem),
        Kind::Index(base, index) => indexed(inner(base), index, problem),
        Kind::Call(name, arguments) => call(&name.text, arguments.iter().map(inner).collect()),
        Kind::SumOver(sum) => Formula::SumOver {
            index: sum.index.text.clone(),
            from: Box::new(inner(&sum.from)),
            to: Box::new(inner(&sum.to)),
            body: Box::new(inner(&sum.body)),
        },
        Kind::Negative(part) => inner(part).negated(),
        Kind::Sum(terms) => Formula::Sum(
            terms
                .iter()
                .map(|(sign, term)| if *sign == Sign::Minus { inner(term).negated() } else { inner(term) })
                .collect(),
        ),
        Kind::Product(factors) => written_product(factors, problem),
        Kind::Power(base, exponent) => Formula::Power(Box::new(inner(base)), Box::new(inner(exponent))),
        Kind::Vector(items) => Formula::Vector(items.iter().map(inner).collect()),
    }
}

/// A leading `m/2` is read as ½ m: numbers gather in front.
fn written_product(factors: &[(Operator, Expression)], problem: &Problem) -> Formula {
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
        let (is_negative, magnitude) = written(factor, problem).sign_and_magnitude();
        number.fraction = if is_negative { -number.fraction } else { number.fraction };
        if *operator == Operator::Times { above.push(magnitude) } else { below.push(magnitude) }
    }
    Formula::product(number, above, below)
}

fn indexed(base: Formula, index: &Expression, problem: &Problem) -> Formula {
    let index = written(index, problem);
    match base {
        Formula::Name { base, dots, mut indices } => {
            indices.push(index);
            Formula::Name { base, dots, indices }
        }
        other => Formula::Entry(Box::new(other), Box::new(index)),
    }
}

/// `x_dot` is x with a dot if x is a coordinate.
fn named(text: &str, problem: &Problem) -> Formula {
    let is_coordinate = |name: &str| {
        problem
            .coordinates
            .iter()
            .any(|label| label.text == name || label.text.starts_with(&format!("{name}[")))
    };
    for (suffix, combining, dots) in [("_dot", '\u{307}', 1), ("_ddot", '\u{308}', 2)] {
        let dotted = |base: &str| crate::syntax::normal_form(&format!("{base}{combining}")) == text;
        let base =
            text.strip_suffix(suffix).filter(|base| is_coordinate(base)).map(str::to_owned).or_else(|| {
                problem.coordinates.iter().map(|label| label.text.clone()).find(|base| dotted(base))
            });
        if let Some(base) = base {
            return Formula::Name { base, dots, indices: Vec::new() };
        }
    }
    Formula::Name { base: text.to_owned(), dots: 0, indices: Vec::new() }
}

fn call(name: &str, mut arguments: Vec<Formula>) -> Formula {
    match (name, arguments.len()) {
        ("sqrt", 1) => Formula::Root(Box::new(arguments.remove(0))),
        _ => Formula::Call(name.to_owned(), arguments),
    }
}
