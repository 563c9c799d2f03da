//! Products and roots of plain numbers, also where no library of functions is.

/// x·y. Four sums, each of every fourth product, are added side by side: of one sum, each addition would wait for the one before.
#[inline]
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    debug_assert_eq!(x.len(), y.len());
    let (x_parts, y_parts) = (x.chunks_exact(4), y.chunks_exact(4));
    let rest = x_parts.remainder().iter().zip(y_parts.remainder()).fold(0.0, |sum, (x, y)| sum + x * y);
    let mut sums = [0.0; 4];
    for (x, y) in x_parts.zip(y_parts) {
        (0..4).for_each(|k| sums[k] += x[k] * y[k]);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(any(feature = "std", feature = "libm"))]
pub(crate) fn sqrt(x: f64) -> f64 {
    crate::number::Scalar::sqrt(x)
}

#[cfg(not(any(feature = "std", feature = "libm")))]
pub(crate) use root_by_heron as sqrt;

/// Without a library of functions, by Heron's method from the power of two below.
#[cfg(any(test, not(any(feature = "std", feature = "libm"))))]
pub(crate) fn root_by_heron(x: f64) -> f64 {
    let start = if x > 0.0 && x.is_finite() { power_of_two_near_root(x) } else { return x.max(0.0) };
    (0..6).fold(start, |root, _| 0.5 * (root + x / root))
}

pub(crate) fn length(x: [f64; 2]) -> f64 {
    sqrt(x[0] * x[0] + x[1] * x[1])
}

/// The power of two next to √x below it, 1 for 0.
pub(crate) fn power_of_two_near_root(x: f64) -> f64 {
    let exponent = (x.to_bits() >> 52) as i64 - 1023;
    if x > 0.0 { f64::from_bits(((exponent.div_euclid(2) + 1023) as u64) << 52) } else { 1.0 }
}
