//! Last coefficients of a series, which determine the step length.

use super::limits::{LAST, STEP};
use crate::number::{Real, Scalar, larger};

/// Sizes of the last coefficients of a series, up to its order.
pub(crate) struct Last<T> {
    pub(crate) order: usize,
    pub(crate) unit: T,
    /// Largest coefficient of each order, relative to the size of its coordinate or velocity.
    pub(crate) sizes: [T; LAST],
}

impl<T: Real> Last<T> {
    /// Step length at which the last terms no longer matter; infinite if all are zero. This is Jorba and Zou, 3.2.1,
    /// with five coefficients instead of two: if only every fourth is nonzero, two may both be zero.
    #[inline(always)]
    pub(crate) fn allowed(&self) -> T {
        let Self { order, unit, sizes } = *self;
        let mut rate = f64::NEG_INFINITY;
        for (k, size) in (order + 1 - LAST..).zip(sizes) {
            rate = larger(rate, log2_roughly(size.to_f64()) / k as f64);
        }
        let length = Scalar::abs(unit) * T::constant(exp2_roughly(safety(order) - rate));
        if sizes.iter().any(|&size| size > T::constant(0.0)) { length } else { T::constant(f64::INFINITY) }
    }
}

/// Binary logarithm of the ratio of the step length to the radius of convergence (Jorba and Zou, (3-12)).
fn safety(order: usize) -> f64 {
    (-STEP - 0.7 / (order as f64 - 1.0)) * core::f64::consts::LOG2_E
}

/// Binary logarithm, at most 0.09 too small; divided by the order, this is accurate enough. Returns −1023 for zero.
#[inline]
pub(crate) fn log2_roughly(x: f64) -> f64 {
    // The bits of x, times 2⁻⁵², are the biased exponent plus the fraction: about 1023 + log₂ x.
    const UNIT: f64 = 1.0 / (1_u64 << 52) as f64;
    x.to_bits() as i64 as f64 * UNIT - 1023.0
}

/// 2ˣ with a relative error of at most 1/300. Below and beyond the normal powers of two, it returns the smallest or the
/// largest of them.
#[inline(always)]
pub(crate) fn exp2_roughly(x: f64) -> f64 {
    let biased = (x + 1023.0).clamp(1.0, 2046.0);
    let exponent = biased as u64;
    let fraction = biased - exponent as f64;
    f64::from_bits(exponent << 52) * (1.0 + fraction * (0.66 + 0.34 * fraction))
}

#[cfg(test)]
mod tests {
    use core::array::from_fn;

    use super::*;

    #[test]
    fn powers_and_logarithms_are_as_good_as_they_say() {
        for k in -60_000..60_000 {
            let x = f64::from(k) / 59.0;
            let (power, exact) = (exp2_roughly(x), x.clamp(-1022.0, 1023.0).exp2());
            assert!((power / exact - 1.0).abs() < 1.0 / 300.0, "{x}: {power:e} {exact:e}");
            let short = exact.log2() - log2_roughly(exact);
            assert!((-1e-12..0.09).contains(&short), "{exact:e}: {short}");
        }
        assert_eq!(log2_roughly(0.0), -1023.0);
    }

    /// x_k = r⁻ᵏ: each coefficient implies the radius of convergence r.
    #[test]
    fn a_step_is_a_part_of_the_radius_of_convergence() {
        for (radius, order) in [(0.01_f64, 5), (1.0, 12), (300.0, 24)] {
            let last = |scale: f64| {
                let sizes = from_fn(|k| scale * radius.powi(-((order + 1 - LAST + k) as i32)));
                Last { order, unit: -2.0, sizes }
            };
            let length = last(1.0).allowed();
            let part = length / (2.0 * radius) / safety(order).exp2();
            assert!((part - 1.0).abs() < 0.03, "{part}");
            assert!(last(1e3).allowed() < length);
            assert_eq!(last(0.0).allowed(), f64::INFINITY);
        }
    }
}
