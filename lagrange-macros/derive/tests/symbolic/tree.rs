//! Random expressions as trees, with an interpreter independent of the graph.

use std::fmt;

use num_dual::DualNum;
use num_traits::ToPrimitive;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::strategy::Union;
use proptest::test_runner::TestCaseError;

use super::functions::apply;
use super::{Outcome, rational, symbol};
use lagrange_symbolic::Approximate;
use lagrange_symbolic::Function as F;
use lagrange_symbolic::{Function, Graph, Id, Rational};

pub(super) const SYMBOLS: usize = 3;

#[derive(Clone)]
pub(super) enum Tree {
    Number(Rational),
    Pi,
    Symbol(usize),
    Sum(Vec<Self>),
    Difference(Box<[Self; 2]>),
    Product(Vec<Self>),
    Quotient(Box<[Self; 2]>),
    Power(Box<Self>, Rational),
    Function(Function, Box<Self>),
    Atan2(Box<[Self; 2]>),
    SymbolicPower(Box<[Self; 2]>),
    Defined(Box<Self>),
}

impl fmt::Debug for Tree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |trees: &[Self], sign| {
            trees.iter().map(|tree| format!("{tree:?}")).collect::<Vec<_>>().join(sign)
        };
        match self {
            Self::Number(value) => write!(f, "{value}"),
            Self::Pi => write!(f, "π"),
            Self::Symbol(index) => write!(f, "{}", ["x", "y", "z"][*index]),
            Self::Sum(terms) => write!(f, "({})", list(terms, " + ")),
            Self::Difference(pair) => write!(f, "({})", list(&pair[..], " - ")),
            Self::Product(factors) => write!(f, "({})", list(factors, " * ")),
            Self::Quotient(pair) => write!(f, "({})", list(&pair[..], " / ")),
            Self::Power(base, exponent) => write!(f, "{base:?}^({exponent})"),
            Self::Function(function, x) => write!(f, "{function:?}({x:?})"),
            Self::Atan2(pair) => write!(f, "Atan2({})", list(&pair[..], ", ")),
            Self::SymbolicPower(pair) => write!(f, "({})", list(&pair[..], " ^ ")),
            Self::Defined(inner) => write!(f, "[{inner:?}]"),
        }
    }
}

impl Tree {
    pub(super) fn number(numerator: i128, denominator: i128) -> Self {
        Self::Number(rational(numerator, denominator))
    }

    pub(super) fn power(self, exponent: Rational) -> Self {
        Self::Power(Box::new(self), exponent)
    }

    pub(super) fn function(function: Function, x: Self) -> Self {
        Self::Function(function, Box::new(x))
    }

    pub(super) fn over(self, denominator: Self) -> Self {
        Self::Quotient(Box::new([self, denominator]))
    }

    pub(super) fn defined(self) -> Self {
        Self::Defined(Box::new(self))
    }

    /// Applies `f` to every subtree, innermost first.
    pub(super) fn map(&self, f: &mut impl FnMut(Self) -> Self) -> Self {
        let all = |trees: &[Self], f: &mut _| trees.iter().map(|tree| tree.map(f)).collect();
        let both = |pair: &[Self; 2], f: &mut _| Box::new([pair[0].map(f), pair[1].map(f)]);
        let mapped = match self {
            Self::Number(_) | Self::Pi | Self::Symbol(_) => self.clone(),
            Self::Sum(terms) => Self::Sum(all(terms, f)),
            Self::Product(factors) => Self::Product(all(factors, f)),
            Self::Difference(pair) => Self::Difference(both(pair, f)),
            Self::Quotient(pair) => Self::Quotient(both(pair, f)),
            Self::Atan2(pair) => Self::Atan2(both(pair, f)),
            Self::SymbolicPower(pair) => Self::SymbolicPower(both(pair, f)),
            Self::Power(base, exponent) => Self::Power(Box::new(base.map(f)), *exponent),
            Self::Function(function, x) => Self::Function(*function, Box::new(x.map(f))),
            Self::Defined(inner) => Self::Defined(Box::new(inner.map(f))),
        };
        f(mapped)
    }

    pub(super) fn build(&self, graph: &mut Graph) -> Id {
        let one = rational(1, 1);
        match self {
            Self::Number(value) => graph.number(*value),
            Self::Pi => graph.pi(),
            Self::Symbol(index) => graph.symbol(symbol(*index)),
            Self::Sum(terms) => {
                let terms: Vec<_> = terms.iter().map(|term| (term.build(graph), one)).collect();
                graph.sum(terms)
            }
            Self::Product(factors) => {
                let factors: Vec<_> = factors.iter().map(|factor| (factor.build(graph), one)).collect();
                graph.product(factors)
            }
            Self::Difference(pair) => Self::build_pair(pair, graph, Graph::sub),
            Self::Quotient(pair) => Self::build_pair(pair, graph, Graph::div),
            Self::Atan2(pair) => Self::build_pair(pair, graph, Graph::atan2),
            Self::SymbolicPower(pair) => Self::build_pair(pair, graph, Graph::power),
            Self::Power(base, exponent) => {
                let base = base.build(graph);
                graph.pow(base, *exponent)
            }
            Self::Function(function, x) => {
                let x = x.build(graph);
                graph.function(*function, x)
            }
            Self::Defined(inner) => {
                let inner = inner.build(graph);
                graph.defined(inner)
            }
        }
    }

    fn build_pair(pair: &[Self; 2], graph: &mut Graph, f: fn(&mut Graph, Id, Id) -> Id) -> Id {
        let [x, y] = [0, 1].map(|i| pair[i].build(graph));
        f(graph, x, y)
    }

    /// Value at a point, in f64 or dual numbers, with noise on every operation.
    fn interpret<D: DualNum<Primitive = f64>>(&self, point: &[D], noise: &mut Noise) -> D {
        let value = match self {
            Self::Number(value) => D::from(quotient(*value)),
            Self::Pi => D::from(std::f64::consts::PI),
            Self::Symbol(index) => return point[*index].clone(),
            Self::Sum(terms) => terms.iter().map(|term| term.interpret(point, noise)).sum(),
            Self::Product(factors) => factors.iter().map(|factor| factor.interpret(point, noise)).product(),
            Self::Difference(pair) => pair[0].interpret(point, noise) - pair[1].interpret(point, noise),
            Self::Quotient(pair) => pair[0].interpret(point, noise) / pair[1].interpret(point, noise),
            Self::Atan2(pair) => pair[0].interpret(point, noise).atan2(pair[1].interpret(point, noise)),
            Self::SymbolicPower(pair) => {
                pair[0].interpret(point, noise).powd(pair[1].interpret(point, noise))
            }
            Self::Power(base, exponent) => {
                let base = base.interpret(point, noise);
                match exponent.is_integer() {
                    true => base.powi(exponent.to_integer() as i32),
                    false => base.powf(quotient(*exponent)),
                }
            }
            Self::Function(function, x) => apply(*function, &x.interpret(point, noise)),
            Self::Defined(inner) => return inner.interpret(point, noise),
        };
        noise.on(value)
    }

    /// Returns one component of the value over dual numbers, and a tolerance. The tolerance comes from the response of the result to small
    /// random relative changes of every intermediate (Monte Carlo arithmetic: Parker). The changes are far larger than
    /// rounding errors, so that a deviation beyond the tolerance cannot be rounding. `None` if the tolerance is too
    /// large to be useful.
    pub(super) fn reference<D: DualNum<Primitive = f64>>(
        &self,
        point: &[D],
        part: impl Fn(D) -> f64,
    ) -> Option<Reference> {
        let value = part(self.interpret(point, &mut Noise { size: 0.0, state: 0 }));
        let spread = (1..=4).map(|state| {
            let noisy = part(self.interpret(point, &mut Noise { size: 1e-9, state }));
            (noisy - value).abs()
        });
        // A maximum that propagates NaN.
        let spread = spread.fold(0.0, |worst: f64, next| if next <= worst { worst } else { next });
        let tolerance = 10.0 * spread + 1e-11 * (1.0 + value.abs());
        let tells = tolerance <= 1e-3 * (1.0 + value.abs()) && value.abs() < 1e60;
        tells.then_some(Reference { value, tolerance })
    }
}

fn quotient(value: Rational) -> f64 {
    value.numer().to_f64().expect("a number") / value.denom().to_f64().expect("a number")
}

/// Value found by the interpreter, and tolerance for another computation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    pub(super) value: f64,
    pub(super) tolerance: f64,
}

impl Reference {
    /// Checks that the value of the graph agrees; skips values with a large error bound.
    pub(super) fn check(self, found: Approximate) -> Result<Outcome, TestCaseError> {
        prop_assert!(found.value.is_finite(), "{found:?} is not {self:?}");
        let is_certain = found.error <= 1e-3 * (1.0 + self.value.abs());
        if !is_certain {
            return Ok(Outcome::Skipped);
        }
        let difference = (found.value - self.value).abs();
        prop_assert!(difference <= self.tolerance + found.error, "{found:?} is not {self:?}");
        Ok(Outcome::Checked)
    }
}

/// Random relative changes of size `size`.
struct Noise {
    size: f64,
    state: u64,
}

impl Noise {
    fn on<D: DualNum<Primitive = f64>>(&mut self, value: D) -> D {
        if self.size == 0.0 {
            return value;
        }
        self.state =
            self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let uniform = (self.state >> 32) as f64 / (1_u64 << 31) as f64 - 1.0;
        value * (1.0 + self.size * uniform)
    }
}

/// Random values of the symbols, away from 0, where many functions have poles and kinks.
pub(super) fn points() -> impl Strategy<Value = [f64; SYMBOLS]> {
    let coordinate = prop_oneof![0.05..2.5_f64, -2.5..-0.05_f64];
    prop::array::uniform3(coordinate)
}

/// Expressions with all functions, some with arguments outside their domain.
pub(super) fn trees() -> impl Strategy<Value = Tree> {
    leaves().prop_recursive(
        4,
        24,
        3,
        |inner| prop_oneof![5 => rational_step(inner.clone()), 4 => function_step(inner)],
    )
}

/// Expressions with + − × ÷, integer powers and definitions only.
pub(super) fn rational_trees() -> impl Strategy<Value = Tree> {
    leaves().prop_recursive(4, 24, 3, rational_step)
}

fn leaves() -> impl Strategy<Value = Tree> + Clone {
    prop_oneof![
        5 => (0..SYMBOLS).prop_map(Tree::Symbol),
        3 => (-12..=12_i128, 1..=6_i128).prop_map(|(n, d)| Tree::number(n, d)),
        1 => Just(Tree::Pi),
    ]
}

fn rational_step(inner: impl Strategy<Value = Tree> + Clone + 'static) -> Union<BoxedStrategy<Tree>> {
    let pair = || (inner.clone(), inner.clone()).prop_map(|(x, y)| Box::new([x, y]));
    Union::new_weighted(vec![
        (4, vec(inner.clone(), 2..4).prop_map(Tree::Sum).boxed()),
        (4, vec(inner.clone(), 2..4).prop_map(Tree::Product).boxed()),
        (2, pair().prop_map(Tree::Difference).boxed()),
        (2, pair().prop_map(Tree::Quotient).boxed()),
        (3, (inner.clone(), -3..=4_i128).prop_map(|(x, n)| x.power(rational(n, 1))).boxed()),
        (2, inner.prop_map(Tree::defined).boxed()),
    ])
}

fn function_step(inner: impl Strategy<Value = Tree> + Clone + 'static) -> Union<BoxedStrategy<Tree>> {
    const ANYWHERE: [F; 9] = [F::Sin, F::Cos, F::Tan, F::Atan, F::Sinh, F::Cosh, F::Tanh, F::Exp, F::Abs];
    let everywhere = (prop::sample::select(&ANYWHERE[..]), inner.clone());
    let positive = prop_oneof![3 => inner.clone().prop_map(made_positive), 1 => inner.clone()];
    // A tanh may round to 1, where the slopes of asin and acos are infinite.
    let below_one = |x| Tree::Product(vec![Tree::number(15, 16), Tree::function(F::Tanh, x)]);
    let bounded = prop_oneof![3 => inner.clone().prop_map(below_one), 1 => inner.clone()];
    let inverse = (prop::sample::select(&[F::Asin, F::Acos][..]), bounded);
    let roots = prop::sample::select(&[(1, 2), (-1, 2), (3, 2), (-3, 2), (1, 3), (-2, 3), (5, 4)][..]);
    Union::new_weighted(vec![
        (6, everywhere.prop_map(|(function, x)| Tree::function(function, x)).boxed()),
        (2, inverse.prop_map(|(function, x)| Tree::function(function, x)).boxed()),
        (2, positive.clone().prop_map(|x| Tree::function(F::Ln, x)).boxed()),
        (3, (positive.clone(), roots).prop_map(|(x, (n, d))| x.power(rational(n, d))).boxed()),
        (1, (inner.clone(), inner.clone()).prop_map(|(y, x)| Tree::Atan2(Box::new([y, x]))).boxed()),
        (1, (positive, inner).prop_map(|(x, y)| Tree::SymbolicPower(Box::new([x, y]))).boxed()),
    ])
}

/// 1/2 + x²
fn made_positive(x: Tree) -> Tree {
    Tree::Sum(vec![Tree::number(1, 2), x.power(rational(2, 1))])
}
