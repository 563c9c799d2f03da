//! Exact rational numbers: every literal is exact until code is emitted.

use num_rational::Ratio;
use num_traits::{CheckedAdd, CheckedMul, One, Signed, Zero};

/// A fraction of two `i128` in lowest terms, with a positive denominator.
pub type Rational = Ratio<i128>;

/// True if the graph can hold the fraction: its numerator must not be `i128::MIN`, whose negative, absolute value and
/// reciprocal overflow.
pub(super) fn fits(x: &Rational) -> bool {
    *x.numer() != i128::MIN
}

/// x + y; `None` on overflow.
pub fn plus(x: Rational, y: Rational) -> Option<Rational> {
    let sum = match (x.is_integer(), y.is_integer()) {
        (true, true) => Rational::from_integer(x.numer().checked_add(y.numer())?),
        _ => x.checked_add(&y)?,
    };
    fits(&sum).then_some(sum)
}

/// x y; `None` on overflow.
pub fn times(x: Rational, y: Rational) -> Option<Rational> {
    let product = match (x.is_integer(), y.is_integer()) {
        (true, true) => Rational::from_integer(x.numer().checked_mul(y.numer())?),
        _ => x.checked_mul(&y)?,
    };
    fits(&product).then_some(product)
}

/// `base` to an integer power; `None` on overflow, and for zero to a negative power.
pub fn power(base: Rational, exponent: i128) -> Option<Rational> {
    if base.is_zero() && exponent != 0 {
        return (exponent > 0).then(Rational::zero);
    }
    if base.abs().is_one() {
        return Some(if exponent % 2 == 0 { Rational::one() } else { base });
    }
    let base = if exponent < 0 { base.recip() } else { base };
    let exponent = usize::try_from(exponent.unsigned_abs()).ok()?;
    num_traits::checked_pow(base, exponent).filter(fits)
}

/// The exact square root, if there is one.
pub fn square_root(x: Rational) -> Option<Rational> {
    let root = |n: i128| n.checked_isqrt().filter(|root| root * root == n);
    Some(Rational::new_raw(root(*x.numer())?, root(*x.denom())?))
}
