//! Values of expressions, with a bound on their rounding errors.

use num_traits::ToPrimitive;

use super::graph::{Function, Graph, Id, Node, Symbol};
use super::rational::{Rational, to_f64};

/// A value and how far the exact one may be from it (running error analysis: Higham, *Accuracy and
/// Stability of Numerical Algorithms*, 3.3).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approximate {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Approximate {
    /// A freshly rounded value: its own rounding on top of what its operands brought along.
    fn rounded(value: f64, inherited: f64) -> Self {
        Self { value, error: inherited + 4.0 * f64::EPSILON * value.abs() }
    }
}

impl Graph {
    /// The value of `root`, where each symbol has the value given.
    pub(crate) fn evaluate(&self, root: Id, mut value: impl FnMut(Symbol) -> f64) -> Approximate {
        let order = self.reachable(&[root]);
        let mut values = vec![Approximate { value: f64::NAN, error: 0.0 }; root.index() + 1];
        for id in order {
            values[id.index()] = self.value_of(id, &values, &mut value);
        }
        values[root.index()]
    }

    fn value_of(
        &self,
        id: Id,
        values: &[Approximate],
        symbol: &mut impl FnMut(Symbol) -> f64,
    ) -> Approximate {
        let at = |id: Id| values[id.index()];
        match self.node(id) {
            Node::Number(value) => Approximate::rounded(to_f64(*value), 0.0),
            Node::Pi => Approximate::rounded(std::f64::consts::PI, 0.0),
            Node::Symbol(name) => Approximate { value: symbol(*name), error: 0.0 },
            Node::Sum(terms) => {
                terms.iter().fold(Approximate { value: 0.0, error: 0.0 }, |sum, &(term, c)| {
                    let (c, x) = (to_f64(c), at(term));
                    let part = Approximate::rounded(c * x.value, c.abs() * x.error);
                    Approximate::rounded(sum.value + part.value, sum.error + part.error)
                })
            }
            Node::Product(factors) => {
                factors.iter().fold(Approximate { value: 1.0, error: 0.0 }, |product, &(factor, exponent)| {
                    let (x, y) = (product, power(at(factor), exponent));
                    Approximate::rounded(
                        x.value * y.value,
                        x.error * y.value.abs() + y.error * x.value.abs() + x.error * y.error,
                    )
                })
            }
            Node::Function(function, x) => apply(*function, at(*x)),
            Node::Atan2(y, x) => {
                let (y, x) = (at(*y), at(*x));
                let radius2 = x.value * x.value + y.value * y.value;
                let slope = (x.value.abs() * y.error + y.value.abs() * x.error) / radius2;
                Approximate::rounded(y.value.atan2(x.value), 2.0 * slope)
            }
            Node::Power(base, exponent) => {
                let (b, e) = (at(*base), at(*exponent));
                let value = b.value.powf(e.value);
                let spread =
                    value * (e.value * b.error / b.value).abs() + value * b.value.ln().abs() * e.error;
                Approximate::rounded(value, 2.0 * spread.abs())
            }
            Node::Defined(inner) => at(*inner),
        }
    }
}

fn power(x: Approximate, exponent: Rational) -> Approximate {
    let e = to_f64(exponent);
    let value = match exponent.numer().to_i32().filter(|_| exponent.is_integer()) {
        Some(integer) => x.value.powi(integer),
        None if *exponent.denom() == 2 => x.value.sqrt().powi(exponent.numer().to_i32().unwrap_or(0)),
        None => x.value.powf(e),
    };
    let spread = (e * value / x.value).abs() * x.error;
    let own = 4.0 * f64::EPSILON * value.abs() * e.abs();
    Approximate::rounded(value, own + if x.error == 0.0 { 0.0 } else { 2.0 * spread })
}

fn apply(function: Function, x: Approximate) -> Approximate {
    let v = x.value;
    let (value, slope) = match function {
        Function::Sin => (v.sin(), v.cos()),
        Function::Cos => (v.cos(), v.sin()),
        Function::Tan => (v.tan(), 1.0 + v.tan() * v.tan()),
        Function::Asin => (v.asin(), 1.0 / (1.0 - v * v).sqrt()),
        Function::Acos => (v.acos(), 1.0 / (1.0 - v * v).sqrt()),
        Function::Atan => (v.atan(), 1.0 / (1.0 + v * v)),
        Function::Sinh => (v.sinh(), v.cosh()),
        Function::Cosh => (v.cosh(), v.sinh()),
        Function::Tanh => (v.tanh(), 1.0),
        Function::Exp => (v.exp(), v.exp()),
        Function::Ln => (v.ln(), 1.0 / v),
        Function::Abs => (v.abs(), 1.0),
    };
    // Twice the linear term, and the square for where the slope vanishes.
    Approximate::rounded(value, 2.0 * slope.abs() * x.error + x.error * x.error)
}
