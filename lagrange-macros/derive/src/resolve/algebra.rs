//! Sums, products, powers and vectors of values.

use num_traits::Signed;

use super::expression::is_literal_zero;
use super::lowering::Lowering;
use super::value::{Shape, Value};
use crate::diagnostics::Place;
use crate::symbolic::{Fault, Id, Rational};
use crate::syntax::{Expression, Kind, LENGTH_LIMIT, Operator, Sign, SumOver};

/// Maximum number of factors: the derivatives of a product have the square of its length.
const FACTOR_LIMIT: usize = 1000;

impl Lowering<'_> {
    pub(super) fn sum(&mut self, terms: &[(Sign, Expression)]) -> Option<Value> {
        let mut values: Vec<(Value, Rational)> = Vec::with_capacity(terms.len());
        let (mut shape, mut places, mut failed) = (None, Vec::new(), false);
        for (sign, term) in terms {
            let Some(value) = self.lower(term) else {
                failed = true;
                continue;
            };
            // The literal 0 is the zero of every shape.
            if is_literal_zero(term) {
                continue;
            }
            let met = match &shape {
                Some(shape) => self.meeting(shape, &value, term.place, "what it is added to"),
                None => Some(value.shape()),
            };
            let Some(met) = met else {
                failed = true;
                continue;
            };
            shape = Some(met);
            places.push(term.place);
            values.push((value, Rational::from_integer(if *sign == Sign::Minus { -1 } else { 1 })));
        }
        let placed: Vec<_> = values.iter().map(|(value, _)| value).zip(places).collect();
        self.along_what_axes(&placed)?;
        (!failed).then(|| Value::combination(&values, &mut self.graph))
    }

    /// Lowers a product. Scalar factors commute, so they are multiplied into one scalar, applied once.
    pub(super) fn product(&mut self, factors: &[(Operator, Expression)]) -> Option<Value> {
        if let Some((_, factor)) = factors.get(FACTOR_LIMIT) {
            let message = format!("a product has at most {FACTOR_LIMIT} factors: name parts of it");
            return self.report(factor.place, message);
        }
        let values: Vec<_> = factors.iter().map(|(_, factor)| self.lower(factor)).collect();
        let mut scalars = Vec::with_capacity(factors.len());
        let mut array: Option<Value> = None;
        for ((operator, factor), value) in factors.iter().zip(values) {
            match (operator, value?) {
                (Operator::Over, Value::Scalar(Id::ZERO)) => {
                    return self.fault(Fault::DivisionByZero, factor.place);
                }
                (Operator::Over, Value::Scalar(x)) => scalars.push((x, Rational::from_integer(-1))),
                (Operator::Times, Value::Scalar(x)) => scalars.push((x, Rational::from_integer(1))),
                (Operator::Over, value) => {
                    return self.report(factor.place, format!("one cannot divide by {}", value.shape()));
                }
                (Operator::Times, value) => {
                    array = Some(match array {
                        None => value,
                        Some(array) => self.times(&array, &value, factor.place)?,
                    });
                }
            }
        }
        let scalar = self.graph.product(scalars);
        Some(match array {
            None => Value::Scalar(scalar),
            Some(array) => array.map(&mut |x| self.graph.mul(scalar, x)),
        })
    }

    pub(super) fn power(&mut self, base: &Expression, exponent: &Expression) -> Option<Value> {
        if let Kind::Name(name) = &exponent.kind
            && name.text == "T"
            && self.scope.get("T").is_none()
            && !self.locals.iter().any(|(local, _)| local == "T")
        {
            return self.report(base.place.to(exponent.place), "the transpose of a matrix is `transpose(A)`");
        }
        let (value, exponent) = (self.lower(base), self.scalar(exponent));
        match value? {
            Value::Scalar(value) => {
                let exponent = exponent?;
                let numbers = (self.graph.as_scaled(value), self.graph.as_scaled(exponent));
                if matches!(numbers, (Some(b), Some(e)) if b.fraction.is_negative() && !e.is_integer()) {
                    return self
                        .report(base.place, "a negative number to a fractional power has no real value");
                }
                Some(Value::Scalar(self.graph.power(value, exponent)))
            }
            value if value.as_matrix().is_some() => {
                self.report(base.place, "a matrix has no power: write `A*A`")
            }
            _ => self.report(base.place, "a vector has no power: its square is `dot(v, v)`"),
        }
    }

    pub(super) fn vector(&mut self, items: &[Expression], place: Place) -> Option<Value> {
        let values = self.lower_all(items)?;
        let Some(first) = values.first() else { return self.report(place, "an empty vector has no meaning") };
        let shape = first.shape();
        if let Some(odd) = values.iter().position(|value| value.shape() != shape) {
            let message = format!("this is {}, but the first entry is {shape}", values[odd].shape());
            return self.report(items[odd].place, message);
        }
        let count: usize = values.iter().map(Value::count).sum();
        if count > LENGTH_LIMIT {
            return self.report(place, format!("a vector has at most {LENGTH_LIMIT} numbers"));
        }
        Some(Value::Vector(values))
    }

    /// Returns whether an outer index makes the range empty, as in `sum(j in 0..i, …)` at i = 0. An empty range without
    /// an outer index is an error.
    fn is_first_of_triangle(&mut self, sum: &SumOver) -> Option<bool> {
        let (from, to) = (self.integer(&sum.from), self.integer(&sum.to));
        Some(from? == to? && !self.locals.is_empty())
    }

    pub(super) fn sum_over(&mut self, sum: &SumOver) -> Option<Value> {
        if let Some(value) = self.open_sum(sum) {
            return value;
        }
        if self.is_first_of_triangle(sum)? {
            return Some(Value::Scalar(Id::ZERO));
        }
        let range = self.range(&sum.from, &sum.to)?;
        self.declare_local(&sum.index)?;
        let mut values: Vec<(Value, Rational)> = Vec::with_capacity(range.len());
        for i in range {
            let index = Value::Scalar(self.graph.integer(i as i128));
            self.locals.push((sum.index.text.clone(), index));
            let value = self.lower(&sum.body);
            self.locals.pop();
            let value = value?;
            if let Some(differ) =
                values.first().and_then(|(first, _)| differing(&first.shape(), &value.shape()))
            {
                return self.report(sum.body.place, differ);
            }
            values.push((value, Rational::from_integer(1)));
        }
        Some(Value::combination(&values, &mut self.graph))
    }
}

/// Describes why two terms of a sum have incompatible shapes.
fn differing(first: &Shape, other: &Shape) -> Option<&'static str> {
    if first.is_turned_to(other) {
        return Some(
            "the terms of this sum are vectors in the axes of several frames: write `express(…, frame)` to have all in the axes of one",
        );
    }
    (first != other).then_some("the terms of this sum differ in shape")
}
