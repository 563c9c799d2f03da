//! Reference values in twice the precision of f64, to test error bounds (Dekker; Hida, Li and Bailey's double-double
//! arithmetic; elementary functions by Taylor series and one Newton step).

use std::ops::{Add, Div, Mul, Neg, Sub};

use lagrange_symbolic::{Function, Graph, Id, Node, Rational, Symbol};

/// Unevaluated sum of two f64.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Double {
    high: f64,
    low: f64,
}

const ZERO: Double = Double { high: 0.0, low: 0.0 };
const ONE: Double = Double { high: 1.0, low: 0.0 };
pub(crate) const PI: Double = Double { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };

fn two_sum(x: f64, y: f64) -> Double {
    let high = x + y;
    let of_y = high - x;
    Double { high, low: (x - (high - of_y)) + (y - of_y) }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let high = two_sum(high.high, high.low + low.high);
        two_sum(high.high, high.low + low.low)
    }
}

impl Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high);
        two_sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Double {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = Self::from(self.high / other.high);
        let rest = self - first * other;
        let second = Self::from(rest.high / other.high);
        let rest = rest - second * other;
        first + second + Self::from(rest.high / other.high)
    }
}

impl From<f64> for Double {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl From<Rational> for Double {
    fn from(value: Rational) -> Self {
        let exact = |n: i128| {
            let high = n as f64;
            two_sum(high, (n - high as i128) as f64)
        };
        exact(*value.numer()) / exact(*value.denom())
    }
}

impl Double {
    /// The nearest `f64`.
    pub(crate) fn to_f64(self) -> f64 {
        self.high
    }

    /// Absolute difference from an f64.
    pub(crate) fn distance(self, other: f64) -> f64 {
        let difference = self - Self::from(other);
        (difference.high + difference.low).abs()
    }

    fn times_power_of_two(self, exponent: i32) -> Self {
        let factor = 2.0_f64.powi(exponent);
        Self { high: self.high * factor, low: self.low * factor }
    }

    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::from(self.high.sqrt());
        }
        let guess = Self::from(self.high.sqrt());
        (guess + self / guess).times_power_of_two(-1)
    }

    fn whole_power(self, exponent: i128) -> Self {
        let power = (0..exponent.unsigned_abs()).fold(ONE, |power, _| power * self);
        if exponent < 0 { ONE / power } else { power }
    }

    pub(crate) fn power(self, exponent: Rational) -> Self {
        match *exponent.denom() {
            1 => self.whole_power(*exponent.numer()),
            2 => self.sqrt().whole_power(*exponent.numer()),
            _ => (self.ln() * Self::from(exponent)).exp(),
        }
    }

    /// Exponential: e^(self / 2^k) − 1 by its series, then k squarings.
    fn exp(self) -> Self {
        let halvings = 20;
        let x = self.times_power_of_two(-halvings);
        let mut term = x;
        let mut rest = x;
        for k in 2..14 {
            term = term * x / Self::from(f64::from(k));
            rest = rest + term;
        }
        for _ in 0..halvings {
            rest = rest.times_power_of_two(1) + rest * rest;
        }
        rest + ONE
    }

    /// Sine and cosine: sine and 1 − cos of self / 2^k by their series, then k doublings of the angle.
    fn sin_cos(self) -> (Self, Self) {
        let (halvings, turns) = (20, (self.high / std::f64::consts::TAU).round());
        let rest = self - PI.times_power_of_two(1) * Self::from(turns);
        let x = rest.times_power_of_two(-halvings);
        let (mut term, mut sine, mut versine) = (x, x, ZERO);
        for k in 2..16 {
            term = term * x / Self::from(f64::from(k));
            match k % 4 {
                0 => versine = versine - term,
                1 => sine = sine + term,
                2 => versine = versine + term,
                _ => sine = sine - term,
            }
        }
        for _ in 0..halvings {
            let cosine = ONE - versine;
            (sine, versine) = ((sine * cosine).times_power_of_two(1), (sine * sine).times_power_of_two(1));
        }
        (sine, ONE - versine)
    }

    fn ln(self) -> Self {
        let guess = Self::from(self.high.ln());
        let rest = self * (-guess).exp() - ONE;
        guess + rest - (rest * rest).times_power_of_two(-1)
    }

    pub(crate) fn atan2(self, x: Self) -> Self {
        let guess = Self::from(self.high.atan2(x.high));
        let (sine, cosine) = guess.sin_cos();
        guess + (self * cosine - x * sine) / (x * x + self * self).sqrt()
    }

    pub(crate) fn apply(self, function: Function) -> Self {
        let leg = || ((ONE - self) * (ONE + self)).sqrt();
        let exponentials = || (self.exp(), (-self).exp());
        match function {
            Function::Sin => self.sin_cos().0,
            Function::Cos => self.sin_cos().1,
            Function::Tan => self.sin_cos().0 / self.sin_cos().1,
            Function::Asin => self.atan2(leg()),
            Function::Acos => leg().atan2(self),
            Function::Atan => self.atan2(ONE),
            Function::Sinh => (exponentials().0 - exponentials().1).times_power_of_two(-1),
            Function::Cosh => (exponentials().0 + exponentials().1).times_power_of_two(-1),
            Function::Tanh => ONE - ONE.times_power_of_two(1) / (self.times_power_of_two(1).exp() + ONE),
            Function::Exp => self.exp(),
            Function::Ln => self.ln(),
            Function::Abs if self.high < 0.0 => -self,
            Function::Abs => self,
            Function::Ramp if self.high < 0.0 => ZERO,
            Function::Ramp => self,
            Function::Step if self.high < 0.0 => ZERO,
            Function::Step if self.high > 0.0 => ONE,
            Function::Step => ONE.times_power_of_two(-1),
        }
    }
}

/// The value of `root`, node by node.
pub(crate) fn value(graph: &Graph, root: Id, symbol: impl Fn(Symbol) -> f64) -> Double {
    let mut values = vec![ZERO; graph.len()];
    for id in graph.reachable(&[root]) {
        let of = |id: Id| values[id.index()];
        values[id.index()] = match graph.node(id) {
            Node::Number(value) => Double::from(*value),
            Node::Pi => PI,
            Node::Symbol(name) => Double::from(symbol(*name)),
            Node::Sum(terms) => terms.iter().fold(ZERO, |sum, &(x, c)| sum + Double::from(c) * of(x)),
            Node::Product(factors) => factors.iter().fold(ONE, |product, &(x, e)| product * of(x).power(e)),
            Node::Function(function, x) => of(*x).apply(*function),
            Node::Atan2(y, x) => of(*y).atan2(of(*x)),
            Node::Power(base, exponent) => (of(*base).ln() * of(*exponent)).exp(),
            Node::Defined(inner) => of(*inner),
            Node::External(_) => unreachable!("the trees have no external functions"),
        };
    }
    values[root.index()]
}

#[test]
fn twice_the_precision_is_reached() {
    let third = Double::from(Rational::new(1, 3));
    let near = |x: Double, y: Double| (x - y).high.abs() < 1e-28;
    assert!(near(third + third + third, ONE));
    assert!(near(third.sqrt() * third.sqrt(), third));
    assert!(near(third.ln().exp(), third));
    let (sine, cosine) = third.sin_cos();
    assert!(near(sine * sine + cosine * cosine, ONE));
    assert!(near(sine.atan2(cosine), third));
    assert!(near(PI.sin_cos().0, ZERO) && near(PI.sin_cos().1, -ONE));
    let far = PI * Double::from(2e6) + third;
    assert!(far.sin_cos().0.distance(sine.high) < sine.low.abs() + 1e-24);
    assert!(near(Double::from(0.5).apply(Function::Asin), PI / Double::from(6.0)));
    assert!(near(third.apply(Function::Tanh), third.apply(Function::Sinh) / third.apply(Function::Cosh)));
}
