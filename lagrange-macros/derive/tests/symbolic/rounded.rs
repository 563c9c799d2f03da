//! Numbers with too many digits for exact fractions: rounded once, and all others kept exact.

use proptest::prelude::*;

use super::double::{self, Double};
use super::{Outcome, at, for_all, graph, rational, value, within};
use lagrange_random::Random;
use lagrange_symbolic::{Graph, Id, Rational, Scaled, Verdict, parse_decimal};

/// Decimal digits of a number, least significant first.
fn digits(mut value: u64) -> Vec<u32> {
    let mut digits = Vec::new();
    while value > 0 {
        digits.push((value % 10) as u32);
        value /= 10;
    }
    digits
}

/// Long multiplication on decimal digits.
fn multiplied(x: &[u32], y: &[u32]) -> Vec<u32> {
    let mut product = vec![0; x.len() + y.len()];
    for (i, a) in x.iter().enumerate() {
        for (j, b) in y.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    carried(product)
}

/// x 10^`zeros` + y
fn added(x: &[u32], zeros: usize, y: &[u32]) -> Vec<u32> {
    let mut sum = vec![0; (x.len() + zeros).max(y.len()) + 1];
    x.iter().enumerate().for_each(|(i, digit)| sum[i + zeros] += digit);
    y.iter().enumerate().for_each(|(i, digit)| sum[i] += digit);
    carried(sum)
}

fn carried(mut digits: Vec<u32>) -> Vec<u32> {
    for i in 1..digits.len() {
        digits[i] += digits[i - 1] / 10;
        digits[i - 1] %= 10;
    }
    digits
}

fn read(digits: &[u32], exponent: i32) -> f64 {
    let text: String = digits.iter().rev().map(|digit| char::from(b'0' + *digit as u8)).collect();
    format!("{text}e{exponent}").parse().expect("a number")
}

fn decimal(value: u64) -> Scaled {
    parse_decimal(&format!("{value}e-16")).expect("in range")
}

/// a b c x and (a b + c d e) x, with numbers of 16 and 17 digits, compared with long multiplication. The nearest f64
/// is required if one number was rounded; two more roundings are allowed if the last product is left unevaluated.
#[test]
fn what_does_not_fit_is_rounded_once() {
    let number = || 1_000_000_000_000_001..99_999_999_999_999_999_u64;
    let numbers = [number(), number(), number(), number(), number()];
    for_all(2000, 1.0, numbers, |numbers| {
        let (mut graph, [x, ..]) = graph();
        let [a, b, c, d, e] = numbers.map(|value| graph.scaled(decimal(value)));
        let [u, v, w, r, s] = numbers.map(digits);
        let (ab, cde) = (multiplied(&u, &v), multiplied(&multiplied(&w, &r), &s));
        let expected = read(&added(&ab, 16, &cde), -48);
        let (xa, cd) = (graph.mul(a, x), graph.mul(c, d));
        let (abx, cdx) = (graph.mul(xa, b), graph.mul(cd, x));
        let both = {
            let by_e = graph.sum([(cdx, rational(1, 1))]);
            let cdex = graph.mul(by_e, e);
            graph.add(abx, cdex)
        };
        let at_one = graph.substituted(both, |_| Some(Id::ONE));
        let found = value(&graph, at_one);
        prop_assert!((found / expected - 1.0).abs() <= 2.0 * f64::EPSILON, "{found:e}, not {expected:e}");
        // Products that fit are exact.
        let product = value(&graph, cd);
        prop_assert_eq!(product, read(&multiplied(&w, &r), -32));
        prop_assert_eq!(graph.take_fault(), None);
        Ok(Outcome::Checked)
    });
}

/// The coefficient has no digits left for another factor.
#[test]
fn a_factor_before_a_sum_is_rounded_once() {
    let number = || 1_000_000_000_000_001..99_999_999_999_999_999_u64;
    for_all(2000, 1.0, [number(), number(), number()], |numbers| {
        let (mut graph, [x, y, _]) = graph();
        let [a, b, c] = numbers.map(|value| graph.scaled(decimal(value)));
        let ab = graph.mul(a, b);
        let by = graph.as_number(ab).expect("a number");
        let sum = graph.sum([(x, by), (y, rational(1, 1))]);
        let scaled = graph.sum([(sum, graph.as_number(c).expect("a number"))]);
        let coefficient = graph
            .substituted(scaled, |symbol| Some(if symbol == super::symbol(0) { Id::ONE } else { Id::ZERO }));
        let [u, v, w] = numbers.map(digits);
        let expected = read(&multiplied(&multiplied(&u, &v), &w), -48);
        prop_assert_eq!(value(&graph, coefficient), expected);
        prop_assert_eq!(graph.take_fault(), None);
        Ok(Outcome::Checked)
    });
}

/// Numbers that are rounded in different orders still cancel, and unrounded numbers stay exact.
#[test]
fn rounded_numbers_cancel() {
    let (mut graph, [x, y, _]) = graph();
    let [a, b, c] =
        ["0.1234567890123456", "9.876543210987654", "3.141592653589793"].map(|text| number(&mut graph, text));
    let long = |graph: &mut Graph, first: Id, second: Id, third: Id| {
        let product = graph.mul(first, second);
        let by = [product, third].map(|id| graph.as_number(id).expect("a number"));
        let sum = graph.sum([(x, by[0]), (y, rational(1, 1))]);
        let sum = graph.sum([(sum, by[1])]);
        graph.sum([(sum, rational(1, 1)), (y, -by[1])])
    };
    let small = graph.sum([(Id::ONE, rational(1, 1)), (x, rational(1, 10_i128.pow(30)))]);
    assert_eq!(graph.sub(small, Id::ONE), graph.sum([(x, rational(1, 10_i128.pow(30)))]));
    let products = [long(&mut graph, a, b, c), long(&mut graph, b, c, a), long(&mut graph, c, a, b)];
    for pair in products.windows(2) {
        assert_eq!(graph.sub(pair[0], pair[1]), Id::ZERO);
    }
    assert_eq!(graph.take_fault(), None);
}

fn number(graph: &mut Graph, text: &str) -> Id {
    graph.scaled(parse_decimal(text).expect("a number"))
}

/// Σ (a monomial times or divided by numbers of sixteen digits), times such a number.
struct ExactPolynomial {
    terms: Vec<(Id, Vec<(Scaled, i128)>)>,
    factor: Scaled,
}

impl ExactPolynomial {
    fn drawn(graph: &mut Graph, symbols: [Id; 3], random: &mut Random) -> Self {
        let decimal = |random: &mut Random| {
            let text = format!("{:?}", random.between(0.1, 10.0));
            parse_decimal(&text).expect("in range")
        };
        let terms = (0..1 + random.below(3)).map(|_| {
            let monomial = graph.mul(random.one_of(&symbols), random.one_of(&symbols));
            let sign = |random: &mut Random| if random.once_in(3) { -1 } else { 1 };
            (monomial, (0..2 + random.below(4)).map(|_| (decimal(random), sign(random))).collect())
        });
        Self { terms: terms.collect(), factor: decimal(random) }
    }

    /// Multiplies the factors and adds the terms in random order.
    fn built(&self, graph: &mut Graph, random: &mut Random) -> Id {
        let is_factored = random.once_in(2);
        let by = graph.scaled(self.factor);
        let mut terms = Vec::new();
        for (monomial, numbers) in &self.terms {
            let mut factors = vec![*monomial];
            for &(number, exponent) in numbers {
                let number = graph.scaled(number);
                factors.push(graph.pow(number, rational(exponent, 1)));
            }
            factors.extend((!is_factored).then_some(by));
            terms.push(folded(factors, random, |x, y| graph.mul(x, y)));
        }
        let sum = folded(terms, random, |x, y| graph.add(x, y));
        if is_factored { graph.mul(by, sum) } else { sum }
    }

    /// Value to thirty digits.
    fn value(&self, graph: &Graph, point: &[f64]) -> Double {
        let number = |scaled: Scaled| Double::from(scaled.fraction);
        let terms = self.terms.iter().map(|(monomial, numbers)| {
            numbers.iter().fold(double::value(graph, *monomial, at(point)), |product, &(x, exponent)| {
                product * number(x).power(Rational::from_integer(exponent))
            })
        });
        terms.fold(Double::from(0.0), |sum, term| sum + term) * number(self.factor)
    }
}

/// Replaces two random parts by their combination until one is left.
fn folded(mut parts: Vec<Id>, random: &mut Random, mut both: impl FnMut(Id, Id) -> Id) -> Id {
    while parts.len() > 1 {
        let [x, y] = [0; 2].map(|_| parts.swap_remove(random.below(parts.len())));
        parts.push(both(x, y));
    }
    parts[0]
}

/// For any order of operations: the error bounds hold, equal values are never distinguished, and values that differ by
/// 10⁻⁹ are.
#[test]
fn roundings_are_within_their_bounds() {
    for_all(300, 0.9, any::<u64>(), |seed| {
        let (mut graph, symbols) = graph();
        let random = &mut Random(seed);
        let polynomial = ExactPolynomial::drawn(&mut graph, symbols, random);
        let [one, other] = [0; 2].map(|_| polynomial.built(&mut graph, random));
        let point = [0; 3].map(|_| random.between(-1.0, 1.0));
        let (found, exact) = (graph.evaluate(one, at(&point)), polynomial.value(&graph, &point));
        prop_assert!(exact.distance(found.value) <= found.error, "{:?}, not {}", found, exact.to_f64());
        let difference = graph.sub(one, other);
        prop_assert_ne!(graph.is_zero(difference, within((-1.25, 1.75))), Verdict::NonZero);
        let larger = graph.sum([(one, rational(1_000_000_001, 1_000_000_000)), (other, rational(-1, 1))]);
        let verdict = graph.is_zero(larger, within((-1.25, 1.75)));
        prop_assert_eq!(graph.take_fault(), None);
        Ok(if verdict == Verdict::NonZero { Outcome::Checked } else { Outcome::Skipped })
    });
}
