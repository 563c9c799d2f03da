//! Derivatives of any order by nilpotent numbers, to twice the precision of f64. Each number carries the rounding
//! error that its evaluation in f64 would have.

use std::ops::{Add, Div, Mul, Neg, Sub};

use num_traits::Signed;

use super::double::Double;
use crate::symbolic::{Function, Rational};

/// A number, with a bound on the rounding errors of its evaluation in f64, in units of the round-off. Each
/// operation adds one error, which the slopes of later operations propagate (running error analysis: Higham,
/// *Accuracy and Stability of Numerical Algorithms*, 3.3).
#[derive(Clone, Copy)]
pub(super) struct Running {
    pub(super) value: Double,
    pub(super) errors: f64,
}

impl Running {
    fn exact(value: Double) -> Self {
        Self { value, errors: 0.0 }
    }

    /// Adds `roundings` errors of one round-off. An elementary function is assumed accurate to one unit in the last
    /// place, which is two round-offs.
    fn rounded(value: Double, roundings: f64, inherited: f64) -> Self {
        Self { value, errors: inherited + roundings * value.to_f64().abs() }
    }

    fn size(self) -> f64 {
        self.value.to_f64().abs()
    }

    fn is_zero(self) -> bool {
        self.value.to_f64() == 0.0 && self.errors == 0.0
    }
}

/// Hyper-dual number a + a₁ε₁ + a₂ε₂ + a₁₂ε₁ε₂ + …, where every ε² = 0. The bits of an index are the set of ε of
/// that entry. The coefficient of ε₁ε₂ in f(x + ε₁ + ε₂) is f″(x). (Fike and Alonso, *The Development of Hyper-Dual
/// Numbers*, 2011)
#[derive(Clone)]
pub(super) struct Jet(Vec<Running>);

impl Jet {
    /// A number that f64 represents exactly.
    pub(super) fn number(value: f64) -> Self {
        Self(vec![Running::exact(Double::from(value))])
    }

    /// A number that f64 may round.
    pub(super) fn rounded(value: Double) -> Self {
        Self(vec![Running::rounded(value, 1.0, 0.0)])
    }

    pub(super) fn running(value: Running) -> Self {
        Self(vec![value])
    }

    /// Coefficient of the product of the first `all` ε.
    pub(super) fn coefficient(&self, all: u32) -> Running {
        let all = (1_usize << all) - 1;
        self.0.get(all).copied().unwrap_or(Running::exact(Double::from(0.0)))
    }

    /// Returns `self` + `rate` ε, where `epsilon` is the number of the ε.
    pub(super) fn moved(&self, rate: &Self, epsilon: u32) -> Self {
        let [mut rest, rate] = [self, rate].map(|jet| jet.long(1 << epsilon));
        rest.extend(rate);
        Self(rest)
    }

    /// Coefficient of the ε with number `epsilon`, which must be the last one.
    pub(super) fn rate(&self, epsilon: u32) -> Self {
        let half = 1 << epsilon;
        if self.0.len() > half { Self(self.0[half..].to_vec()) } else { Self::number(0.0) }
    }

    fn long(&self, length: usize) -> Vec<Running> {
        let mut entries = self.0.clone();
        entries.resize(length.max(entries.len()), Running::exact(Double::from(0.0)));
        entries
    }

    fn halves(&self) -> (Self, Self) {
        let (rest, rates) = self.0.split_at(self.0.len() / 2);
        (Self(rest.to_vec()), Self(rates.to_vec()))
    }

    /// f(a + bε) = f(a) + f′(a) b ε, for a function with known value and slope.
    fn chain(&self, value: impl Fn(&Self) -> Self, slope: impl Fn(&Self) -> Self) -> Self {
        let (a, b) = self.halves();
        let (mut entries, rates) = (value(&a).long(b.0.len()), slope(&a) * b);
        entries.extend(rates.long(entries.len()));
        Self(entries)
    }

    fn of_functions(&self, function: Function, slope: fn(&Self) -> Self) -> Self {
        if let [x] = self.0[..] {
            let value = x.value.apply(function);
            let (x, y) = (x.value.to_f64(), x.errors);
            return Self(vec![Running::rounded(value, 2.0, y * steepness(function, x).abs())]);
        }
        self.chain(|a| a.of_functions(function, slope), slope)
    }

    pub(super) fn power(&self, exponent: Rational) -> Self {
        let e = *exponent.numer() as f64 / *exponent.denom() as f64;
        if e == 0.0 {
            return Self::number(1.0);
        }
        if let [x] = self.0[..] {
            let value = x.value.power(exponent);
            let slope = e.abs() * x.size().powf(e - 1.0);
            let inherited = if x.errors == 0.0 { 0.0 } else { slope * x.errors };
            return Self(vec![Running::rounded(value, exponent.numer().abs() as f64 + 1.0, inherited)]);
        }
        let factor = Self::rounded(Double::from(exponent));
        self.chain(|a| a.power(exponent), |a| factor.clone() * a.power(exponent - Rational::from_integer(1)))
    }

    pub(super) fn sqrt(&self) -> Self {
        self.power(Rational::new(1, 2))
    }

    pub(super) fn atan2(&self, x: &Self) -> Self {
        let length = self.0.len().max(x.0.len());
        if let ([y], [x]) = (&self.0[..], &x.0[..]) {
            let square = x.size() * x.size() + y.size() * y.size();
            let inherited = (x.size() * y.errors + y.size() * x.errors) / square;
            return Self(vec![Running::rounded(y.value.atan2(x.value), 2.0, inherited)]);
        }
        let [(y, dy), (x, dx)] = [self, x].map(|jet| Self(jet.long(length)).halves());
        let rates = (x.clone() * dy - y.clone() * dx) / (x.clone() * x.clone() + y.clone() * y.clone());
        let mut entries = y.atan2(&x).long(length / 2);
        entries.extend(rates.long(length / 2));
        Self(entries)
    }

    /// Applies an elementary function. Most reduce to the sine, cosine, exponential, logarithm, arc tangent and
    /// square root.
    pub(super) fn apply(&self, function: Function) -> Self {
        let one = || Self::number(1.0);
        let exponentials = || (self.apply(Function::Exp), (-self.clone()).apply(Function::Exp));
        let leg = || ((one() - self.clone()) * (one() + self.clone())).sqrt();
        match function {
            Function::Sin => self.of_functions(function, |x| x.apply(Function::Cos)),
            Function::Cos => self.of_functions(function, |x| -x.apply(Function::Sin)),
            Function::Exp => self.of_functions(function, |x| x.apply(Function::Exp)),
            Function::Ln => self.of_functions(function, |x| x.power(Rational::from_integer(-1))),
            Function::Abs => self.of_functions(function, |x| Self::number(x.0[0].value.to_f64().signum())),
            Function::Atan => self.atan2(&one()),
            Function::Tan => self.apply(Function::Sin) / self.apply(Function::Cos),
            Function::Asin => self.atan2(&leg()),
            Function::Acos => leg().atan2(self),
            Function::Sinh => (exponentials().0 - exponentials().1) / Self::number(2.0),
            Function::Cosh => (exponentials().0 + exponentials().1) / Self::number(2.0),
            // The difference loses digits where it is small, as it does in the emitted code.
            Function::Tanh => self.of_functions(function, |x| {
                Self::number(1.0) - x.apply(Function::Tanh).power(Rational::from_integer(2))
            }),
            Function::Ramp | Function::Step => unreachable!("none is drawn"),
        }
    }
}

fn steepness(function: Function, x: f64) -> f64 {
    match function {
        Function::Sin => x.cos(),
        Function::Cos => x.sin(),
        Function::Exp => x.exp(),
        Function::Ln => 1.0 / x,
        Function::Tanh => 1.0 - x.tanh().powi(2),
        _ => 1.0,
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.into_iter().map(|x| Running { value: -x.value, ..x }).collect())
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let length = self.0.len().max(other.0.len());
        let sum = |(x, y): (Running, Running)| match (x.is_zero(), y.is_zero()) {
            (true, _) => y,
            (_, true) => x,
            _ => Running::rounded(x.value + y.value, 1.0, x.errors + y.errors),
        };
        Self(self.long(length).into_iter().zip(other.long(length)).map(sum).collect())
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Self;
    /// (a + bε)(c + dε) = ac + (ad + bc)ε
    fn mul(self, other: Self) -> Self {
        if let ([x], [y]) = (&self.0[..], &other.0[..]) {
            let inherited = x.size() * y.errors + y.size() * x.errors;
            return Self(vec![Running::rounded(x.value * y.value, 1.0, inherited)]);
        }
        if self.0.len() < other.0.len() {
            return other * self;
        }
        let length = self.0.len();
        let (a, b) = self.halves();
        let (rest, rates) = if other.0.len() < length {
            (a * other.clone(), b * other)
        } else {
            let (c, d) = other.halves();
            (a.clone() * c.clone(), a * d + b * c)
        };
        let mut entries = rest.long(length / 2);
        entries.extend(rates.long(length / 2));
        Self(entries)
    }
}

impl Div for Jet {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self * other.power(Rational::from_integer(-1))
    }
}

#[test]
fn mixed_derivatives_are_those_of_closed_forms() {
    // sin(x y) by x and y: cos(x y) − x y sin(x y); x^(3/2) twice by x: 3/4 x^(−1/2); atan2 twice by y: −2 x y/(x² + y²)².
    let (x, y) = (0.7_f64, 1.3_f64);
    let one = Jet::number(1.0);
    let [a, b] = [Jet::number(x).moved(&one, 0), Jet::number(y).moved(&Jet::number(0.0), 0).moved(&one, 1)];
    let twice = Jet::number(x).moved(&one, 0).moved(&one, 1);
    let cases = [
        ((a * b).apply(Function::Sin), (x * y).cos() - x * y * (x * y).sin()),
        (twice.power(Rational::new(3, 2)), 0.75 / x.sqrt()),
        (twice.atan2(&Jet::number(y)), -2.0 * x * y / (x * x + y * y).powi(2)),
        (twice.apply(Function::Tanh), -2.0 * x.tanh() / x.cosh().powi(2)),
        (twice.apply(Function::Asin), x / (1.0 - x * x).powf(1.5)),
        (twice.apply(Function::Ln), -1.0 / (x * x)),
    ];
    for (jet, expected) in cases {
        let Running { value, errors } = jet.coefficient(2);
        assert!(value.distance(expected) < 1e-14, "{value:?}, not {expected}");
        assert!((1.0..200.0).contains(&errors), "{errors} roundings");
    }
}
