//! Sums, products, powers and roots of fractions of all magnitudes, compared with arithmetic modulo primes, which
//! never overflows.

use lagrange_random::{Random, rounds};
use lagrange_symbolic::{Rational, Scaled, finite_decimal, parse_decimal, to_f64};
use lagrange_symbolic::{plus, power, square_root, times};

/// True for what the graph can hold: the negative and the reciprocal of i128::MIN overflow.
fn fits(x: &Rational) -> bool {
    *x.numer() != i128::MIN
}

/// Largest primes below 2⁶², 2⁶¹ and 2³¹. Two different numbers below 2¹⁰⁰⁰ have the same residues in only one of 10³⁰
/// cases.
const PRIMES: [u128; 3] = [(1 << 62) - 57, (1 << 61) - 1, (1 << 31) - 1];

/// Random integer of any number of bits, often at the ends of the range.
fn whole(random: &mut Random) -> i128 {
    let bits = random.below(128) as u32;
    let any = (i128::from(random.bits() as i64) << 64 | i128::from(random.bits())) & i128::MAX;
    let near = 1_i128.checked_shl(bits).unwrap_or(0).wrapping_add(random.below(5) as i128 - 2);
    let size = match random.below(6) {
        0 => i128::MAX - random.below(3) as i128,
        1 => random.below(12) as i128,
        2 => 10_i128.pow(random.below(39) as u32),
        3 => near.checked_abs().unwrap_or(0),
        _ => any >> bits,
    };
    if random.once_in(2) { -size } else { size }
}

fn fraction(random: &mut Random) -> Rational {
    let (numerator, denominator) = (whole(random), whole(random));
    let denominator = if random.once_in(3) { 1 } else { denominator.abs().max(1) };
    Rational::new(numerator, denominator)
}

/// Numerator and denominator modulo a prime.
fn modulo(x: Rational, prime: u128) -> [u128; 2] {
    [*x.numer(), *x.denom()].map(|n| n.rem_euclid(prime as i128) as u128)
}

/// True if x equals a/b modulo every prime.
fn is(x: Rational, expected: impl Fn(u128) -> [u128; 2]) -> bool {
    PRIMES.into_iter().all(|prime| {
        let ([n, d], [a, b]) = (modulo(x, prime), expected(prime));
        n * b % prime == a * d % prime
    })
}

/// True if x is in lowest terms with a positive denominator, and the graph can hold it.
fn is_proper(x: Rational) -> bool {
    fits(&x) && *x.denom() > 0 && Rational::new(*x.numer(), *x.denom()) == x
}

/// True if x is small enough that no operation on two such numbers overflows.
fn is_small(x: Rational) -> bool {
    x.numer().unsigned_abs() < 1 << 40 && *x.denom() < 1 << 40
}

fn checked(x: Rational, y: Rational, n: i128) {
    let modulo = |x, prime| -> [u128; 2] { modulo(x, prime) };
    let sum = plus(x, y);
    assert!(sum.is_some() || !(is_small(x) && is_small(y)), "{x} + {y} fits");
    let product = times(x, y);
    assert!(product.is_some() || !(is_small(x) && is_small(y)), "{x} · {y} fits");
    if let Some(sum) = sum {
        let expected = |p| {
            let ([a, b], [c, d]) = (modulo(x, p), modulo(y, p));
            [(a * d + b * c) % p, b * d % p]
        };
        assert!(is_proper(sum) && is(sum, expected), "{x} + {y} is not {sum}");
    }
    if let Some(product) = product {
        let expected = |p| {
            let ([a, b], [c, d]) = (modulo(x, p), modulo(y, p));
            [a * c % p, b * d % p]
        };
        assert!(is_proper(product) && is(product, expected), "{x} · {y} is not {product}");
    }
    if let Some(power) = power(x, n).filter(|_| n.unsigned_abs() < 1000) {
        let expected = |p| {
            let [a, b] = modulo(x, p).map(|y| (0..n.unsigned_abs()).fold(1, |power, _| power * y % p));
            if n < 0 { [b, a] } else { [a, b] }
        };
        assert!(is_proper(power) && is(power, expected), "{x}^{n} is not {power}");
    }
    match square_root(x) {
        Some(root) => assert_eq!(times(root, root), Some(x), "the root of {x} is not {root}"),
        None => assert!(times(y, y).is_none_or(|square| square != x), "the root of {x} is {y}"),
    }
    if let Some(square) = times(y, y).filter(fits) {
        assert!(
            square_root(square).is_some_and(|root| root == y || root == -y),
            "{square} is the square of {y}"
        );
    }
}

/// Checks that a finite decimal parses to the same fraction, and that its f64 equals the one parsed by Rust.
fn read_again(x: Rational) {
    let Some((digits, places)) = finite_decimal(x) else { return };
    let text = format!("{}e-{places}", digits.unsigned_abs());
    let Some(value) = parse_decimal(&text) else { return };
    let expected: f64 = text.parse().expect("a number");
    assert_eq!(value.to_f64().to_bits(), expected.to_bits(), "{text}");
    let size = if *x.numer() < 0 { -x } else { x };
    assert_eq!(value, Scaled::from(size), "{text}");
    assert_eq!(to_f64(size).to_bits(), expected.to_bits(), "{text}");
}

/// Checks that numbers with powers of ten multiply without overflow, and commute.
fn scaled(random: &mut Random, x: Rational, y: Rational) {
    let mut of = |x| Scaled::new(x, random.below(700) as i32 - 350);
    let (Some(x), Some(y)) = (of(x), of(y)) else { return };
    assert_eq!(x.times(y), y.times(x), "{x:?} · {y:?}");
    assert_eq!(x.plus(y), y.plus(x), "{x:?} + {y:?}");
    for n in [random.below(9) as i128 - 4, whole(random)] {
        let _ = x.power(n);
    }
    if let Some(product) = x.times(y) {
        let (found, expected) = (product.to_f64(), x.to_f64() * y.to_f64());
        // Tolerance: two roundings for each factor, and two for the product.
        let is_close = (found - expected).abs() <= 8.0 * f64::EPSILON * expected.abs();
        assert!(is_close || !expected.is_normal(), "{x:?} · {y:?} is {expected:e}, not {found:e}");
    }
}

#[test]
fn fractions_are_exact_or_not_there() {
    rounds("fractions", [20_000, 20_000, 2_000_000], |random| {
        let (x, y) = (fraction(random), fraction(random));
        let n = if random.once_in(4) { whole(random) } else { random.below(40) as i128 - 20 };
        if fits(&x) && fits(&y) {
            checked(x, y, n);
            read_again(x);
            scaled(random, x, y);
        }
    });
}
