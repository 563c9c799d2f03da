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
    /// A freshly rounded value: its own rounding, which may be a denormal's, on top of what its operands
    /// brought along.
    fn rounded(value: f64, inherited: f64) -> Self {
        Self { value, error: inherited + 4.0 * f64::EPSILON * value.abs() + f64::MIN_POSITIVE }
    }

    /// Taken as it is, without an error.
    pub(crate) fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// Whether the error bound excludes zero. False where there is no value or no bound.
    pub(crate) fn excludes_zero(self) -> bool {
        self.error.is_finite() && self.value.abs() > self.error
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self::rounded(self.value + other.value, self.error + other.error)
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        Self::rounded(self.value - other.value, self.error + other.error)
    }

    /// |x/y − x̃/ỹ| ≤ (|x − x̃| + |x/y| |y − ỹ|) / least |ỹ|
    pub(crate) fn over(self, other: Self) -> Self {
        let (quotient, (least, _)) = (self.value / other.value, other.magnitudes());
        let inherited = (self.error + quotient.abs() * other.error) / least;
        Self::rounded(quotient, if least > 0.0 { inherited } else { f64::INFINITY })
    }

    pub(crate) fn times(self, other: Self) -> Self {
        let (x, y) = (self, other);
        let inherited = x.error * y.value.abs() + y.error * x.value.abs() + x.error * y.error;
        Self::rounded(x.value * y.value, inherited)
    }

    /// The least and the greatest absolute value that the exact one may have.
    fn magnitudes(self) -> (f64, f64) {
        (self.value.abs() - self.error, self.value.abs() + self.error)
    }
}

impl From<Rational> for Approximate {
    fn from(value: Rational) -> Self {
        let nearest = to_f64(value);
        let exact = value.is_integer() && nearest.abs() <= 1.0 / f64::EPSILON;
        if exact { Self { value: nearest, error: 0.0 } } else { Self::rounded(nearest, 0.0) }
    }
}

impl Graph {
    /// The value of `root`, where each symbol has the value given. Where the error has no bound, because the
    /// exact argument of some function may lie beyond a pole or a cut, it is infinite or NaN.
    #[cfg(test)]
    pub(crate) fn evaluate(&self, root: Id, value: impl FnMut(Symbol) -> f64) -> Approximate {
        self.evaluate_in(&self.reachable(&[root]), value, |_, _| Approximate::exact(f64::NAN))
    }

    /// The value of the last of `order`, which holds all that it is made of, operands first.
    pub(super) fn evaluate_in(
        &self,
        order: &[Id],
        mut value: impl FnMut(Symbol) -> f64,
        external: impl FnMut(Id, &[Approximate]) -> Approximate,
    ) -> Approximate {
        let values = self.values_in(order, |symbol| Approximate::exact(value(symbol)), external);
        order.last().map_or(Approximate::exact(f64::NAN), |root| values[root.index()])
    }

    /// The values of all of `order`, by their indices. `external` is given the values of its operands.
    pub(super) fn values_in(
        &self,
        order: &[Id],
        mut value: impl FnMut(Symbol) -> Approximate,
        mut external: impl FnMut(Id, &[Approximate]) -> Approximate,
    ) -> Vec<Approximate> {
        let mut values = vec![Approximate::exact(f64::NAN); order.last().map_or(0, |root| root.index() + 1)];
        for &id in order {
            values[id.index()] = match self.node(id) {
                Node::External(_) => external(id, &values),
                _ => self.value_of(id, &values, &mut value),
            };
        }
        values
    }

    /// The values of the nodes that have none yet, in order of their ids; `symbol` and `external` give those of
    /// what has no operands.
    pub(super) fn extend_values(
        &self,
        values: &mut Vec<Approximate>,
        symbol: impl Fn(Symbol) -> Approximate,
        external: impl Fn(Id, &[Approximate]) -> Approximate,
    ) {
        for index in values.len()..self.len() {
            let id = Id(index as u32);
            let value = match self.node(id) {
                Node::External(_) => external(id, values),
                Node::Symbol(name) => symbol(*name),
                _ => self.value_of(id, values, &mut |_| Approximate::exact(f64::NAN)),
            };
            values.push(value);
        }
    }

    fn value_of(
        &self,
        id: Id,
        values: &[Approximate],
        symbol: &mut impl FnMut(Symbol) -> Approximate,
    ) -> Approximate {
        let at = |id: Id| values[id.index()];
        match self.node(id) {
            Node::Number(value) => (*value).into(),
            Node::Pi => Approximate::rounded(std::f64::consts::PI, 0.0),
            Node::Symbol(name) => symbol(*name),
            Node::Sum(terms) => {
                let zero = Approximate { value: 0.0, error: 0.0 };
                terms.iter().fold(zero, |sum, &(term, c)| sum.plus(at(term).times(c.into())))
            }
            Node::Product(factors) => {
                let one = Approximate { value: 1.0, error: 0.0 };
                factors.iter().fold(one, |product, &(factor, e)| product.times(power(at(factor), e)))
            }
            Node::Function(function, x) => apply(*function, at(*x)),
            Node::Atan2(y, x) => angle(at(*y), at(*x)),
            Node::Power(base, exponent) => general_power(at(*base), at(*exponent)),
            Node::Defined(inner) => at(*inner),
            Node::External(_) => Approximate { value: f64::NAN, error: 0.0 },
        }
    }
}

/// |x^e − x̃^e| ≤ |e| · greatest |x|^(e − 1) · |x − x̃|
fn power(x: Approximate, exponent: Rational) -> Approximate {
    let e = to_f64(exponent);
    let value = match exponent.numer().to_i32().filter(|_| exponent.is_integer()) {
        Some(integer) => x.value.powi(integer),
        None => x.value.powf(e),
    };
    let (least, greatest) = x.magnitudes();
    let steepest = match x.error {
        0.0 => 0.0,
        _ if e >= 1.0 => greatest.powf(e - 1.0),
        _ if least > 0.0 => least.powf(e - 1.0),
        _ => f64::INFINITY,
    };
    // `powi` multiplies |e| times at most, and the exponent of `powf` is rounded.
    let roundings = e.abs() * (4.0 + x.value.abs().max(f64::MIN_POSITIVE).ln().abs());
    let own = if exponent.is_integer() { 4.0 * e.abs() } else { roundings };
    Approximate::rounded(value, e.abs() * steepest * x.error + own * f64::EPSILON * value.abs())
}

/// b^e = exp(e ln b)
fn general_power(base: Approximate, exponent: Approximate) -> Approximate {
    let logarithm = apply(Function::Ln, base).times(exponent);
    Approximate::rounded(base.value.powf(exponent.value), apply(Function::Exp, logarithm).error)
}

/// The angle of (x, y) turns by 1/r at most; at the cut it jumps.
fn angle(y: Approximate, x: Approximate) -> Approximate {
    let blur = y.error.hypot(x.error);
    let nearest = y.value.hypot(x.value) - blur;
    let at_the_cut = x.value < x.error && y.value.abs() <= y.error;
    let slope = if nearest > 0.0 && !at_the_cut { 1.0 / nearest } else { f64::INFINITY };
    Approximate::rounded(y.value.atan2(x.value), slope * blur)
}

/// |f(x) − f(x̃)| ≤ greatest |f′| · |x − x̃|, with the greatest slope between x and x̃.
pub(super) fn apply(function: Function, x: Approximate) -> Approximate {
    let v = x.value;
    let (least, greatest) = x.magnitudes();
    let inverse = |y: f64| if y > 0.0 { 1.0 / y } else { f64::INFINITY };
    let (value, slope) = match function {
        Function::Sin => (v.sin(), 1.0_f64.min(v.cos().abs() + x.error)),
        Function::Cos => (v.cos(), 1.0_f64.min(v.sin().abs() + x.error)),
        Function::Tan => (v.tan(), inverse(v.cos().abs() - x.error).powi(2)),
        Function::Asin => (v.asin(), inverse((1.0 - greatest) * (1.0 + greatest)).sqrt()),
        Function::Acos => (v.acos(), inverse((1.0 - greatest) * (1.0 + greatest)).sqrt()),
        Function::Atan => (v.atan(), 1.0 / (1.0 + least.max(0.0).powi(2))),
        Function::Sinh => (v.sinh(), greatest.cosh()),
        Function::Cosh => (v.cosh(), greatest.sinh()),
        Function::Tanh => (v.tanh(), least.max(0.0).cosh().recip().powi(2)),
        Function::Exp => (v.exp(), (v + x.error).exp()),
        Function::Ln => (v.ln(), inverse(least)),
        Function::Abs => (v.abs(), 1.0),
    };
    // Twice, for the roundings of the slope.
    Approximate::rounded(value, if x.error == 0.0 { 0.0 } else { 2.0 * slope * x.error })
}
