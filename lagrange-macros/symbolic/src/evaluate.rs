//! Values of expressions with bounds on their rounding errors.

use num_traits::ToPrimitive;

use super::graph::{External, Function, Graph, Id, Node, Symbol};
use super::rational::Rational;
use super::wide::to_f64;

/// A value and a bound on its distance from the exact value (running error analysis: Higham, *Accuracy and Stability
/// of Numerical Algorithms*, 3.3).
#[derive(Clone, Copy, Debug)]
pub struct Approximate {
    pub value: f64,
    pub error: f64,
}

impl Approximate {
    /// A rounded result: adds the rounding error of the operation, also of a subnormal result, to the error inherited
    /// from the operands.
    fn rounded(value: f64, inherited: f64) -> Self {
        Self { value, error: inherited + 4.0 * f64::EPSILON * value.abs() + f64::MIN_POSITIVE }
    }

    /// A value with error bound 0.
    pub fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// True if the value is exactly zero.
    pub fn is_zero(self) -> bool {
        self.value == 0.0 && self.error == 0.0
    }

    /// True if the error bound excludes zero; false if the value or the bound is not finite.
    pub fn excludes_zero(self) -> bool {
        self.error.is_finite() && self.value.abs() > self.error
    }

    pub fn negated(self) -> Self {
        Self { value: -self.value, error: self.error }
    }

    pub fn plus(self, other: Self) -> Self {
        Self::rounded(self.value + other.value, self.error + other.error)
    }

    pub fn minus(self, other: Self) -> Self {
        Self::rounded(self.value - other.value, self.error + other.error)
    }

    /// |x/y − x̃/ỹ| ≤ (|x − x̃| + |x/y| |y − ỹ|) / least |ỹ|
    pub fn over(self, other: Self) -> Self {
        let (quotient, (least, _)) = (self.value / other.value, other.magnitudes());
        let inherited = (self.error + quotient.abs() * other.error) / least;
        Self::rounded(quotient, if least > 0.0 { inherited } else { f64::INFINITY })
    }

    pub fn times(self, other: Self) -> Self {
        let (x, y) = (self, other);
        let inherited = x.error * y.value.abs() + y.error * x.value.abs() + x.error * y.error;
        Self::rounded(x.value * y.value, inherited)
    }

    /// Σ x y
    pub fn dot(pairs: impl Iterator<Item = (Self, Self)>) -> Self {
        pairs.fold(Self::exact(0.0), |sum, (x, y)| sum.plus(x.times(y)))
    }

    /// Lower and upper bound of the absolute value of the exact value.
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
    /// Value of a constant, with the error bound of its rounding.
    fn number_value(&self, value: Rational) -> Approximate {
        let Approximate { value: nearest, error } = value.into();
        Approximate { value: nearest, error: error + self.roundings.error(value.into()) * nearest.abs() }
    }

    /// Value of a node, from the values `at` of its operands. The error is infinite or NaN if it has no bound: the
    /// exact argument of a function may lie beyond a pole or a branch cut.
    pub(super) fn value_of(
        &self,
        id: Id,
        at: impl Fn(Id) -> Approximate,
        symbol: impl Fn(Symbol) -> Approximate,
        external: impl Fn(&External, &[Approximate]) -> Approximate,
    ) -> Approximate {
        match self.node(id) {
            Node::Number(value) => self.number_value(*value),
            Node::Pi => Approximate::rounded(std::f64::consts::PI, 0.0),
            Node::Symbol(name) => symbol(*name),
            Node::Sum(terms) => {
                Approximate::dot(terms.iter().map(|&(term, c)| (at(term), self.number_value(c))))
            }
            Node::Product(factors) => {
                let one = Approximate::exact(1.0);
                factors.iter().fold(one, |product, &(factor, e)| product.times(power(at(factor), e)))
            }
            Node::Function(function, x) => apply(*function, at(*x)),
            Node::Atan2(y, x) => angle(at(*y), at(*x)),
            Node::Power(base, exponent) => general_power(at(*base), at(*exponent)),
            Node::Defined(inner) => at(*inner),
            Node::External(function) => {
                let arguments: Vec<_> = function.arguments.iter().map(|&x| at(x)).collect();
                external(function, &arguments)
            }
        }
    }
}

/// |x^e − x̃^e| ≤ |e| · max |x|^(e − 1) · |x − x̃|
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
    // `powi` takes at most |e| multiplications; for `powf` the exponent is rounded.
    let roundings = e.abs() * (4.0 + x.value.abs().max(f64::MIN_POSITIVE).ln().abs());
    let own = if exponent.is_integer() { 4.0 * e.abs() } else { roundings };
    Approximate::rounded(value, e.abs() * steepest * x.error + own * f64::EPSILON * value.abs())
}

/// b^e = exp(e ln b)
fn general_power(base: Approximate, exponent: Approximate) -> Approximate {
    let logarithm = apply(Function::Ln, base).times(exponent);
    Approximate::rounded(base.value.powf(exponent.value), apply(Function::Exp, logarithm).error)
}

/// The angle of (x, y) has a slope of at most 1/r; it jumps at the branch cut.
fn angle(y: Approximate, x: Approximate) -> Approximate {
    let blur = y.error.hypot(x.error);
    let nearest = y.value.hypot(x.value) - blur;
    let at_the_cut = x.value < x.error && y.value.abs() <= y.error;
    let slope = if nearest > 0.0 && !at_the_cut { 1.0 / nearest } else { f64::INFINITY };
    Approximate::rounded(y.value.atan2(x.value), slope * blur)
}

/// |f(x) − f(x̃)| ≤ max |f′| · |x − x̃|, with the largest slope between x and x̃.
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
        Function::Ramp => (v.max(0.0), 1.0),
        // Constant on both sides of the jump.
        Function::Step => (
            0.5 + 0.5 * if v == 0.0 { 0.0 } else { v.signum() },
            if least > 0.0 { 0.0 } else { f64::INFINITY },
        ),
    };
    // The factor 2 covers the rounding errors of the slope.
    Approximate::rounded(value, if x.error == 0.0 { 0.0 } else { 2.0 * slope * x.error })
}
