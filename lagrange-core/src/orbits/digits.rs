//! Numbers for people, without digits that are round-off.

use core::fmt::{self, Display, Formatter};

use nalgebra::Complex;

use super::multipliers::modulus;
use crate::number::{Real, power_of_epsilon};

/// Resolution to which multipliers are printed, of their modulus.
pub(super) fn printed<T: Real>() -> f64 {
    power_of_epsilon::<T>(2.0 / 3.0).to_f64()
}

/// The number rounded to a decimal place that is not beyond the resolution; 0 if it is less.
pub(super) fn rounded(x: f64, resolution: f64) -> f64 {
    if x.abs() < resolution {
        return 0.0;
    }
    // Resolutions are mostly a power of ten of the number itself: products may be above it by their round-off.
    let size = x.abs() * (1.0 + 16.0 * f64::EPSILON);
    let is_place = |digits: &i32| (0..*digits).fold(resolution, |unit, _| 10.0 * unit) <= size;
    let digits = (1..=16).take_while(is_place).count();
    alloc::format!("{x:.digits$e}").parse().unwrap_or(x)
}

/// Real and imaginary part of a multiplier, rounded to this part of its modulus.
pub(super) fn parts<T: Real>(x: Complex<T>, resolution: f64) -> [f64; 2] {
    let size = modulus(x).to_f64() * resolution;
    [x.re, x.im].map(|part| rounded(part.to_f64(), size))
}

/// A multiplier as printed: without an imaginary part if it is real.
pub(super) struct Printed<T>(pub(super) Complex<T>);

impl<T: Real> Display for Printed<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [re, im] = parts(self.0, printed::<T>());
        plain(f, re)?;
        if im == 0.0 {
            return Ok(());
        }
        f.write_str(if im < 0.0 { " − " } else { " + " })?;
        plain(f, im.abs())?;
        f.write_str(" i")
    }
}

/// Very small and large numbers with an exponent.
fn plain(f: &mut Formatter<'_>, x: f64) -> fmt::Result {
    let size = x.abs();
    if x == 0.0 || (1e-4..1e9).contains(&size) { write!(f, "{x}") } else { write!(f, "{x:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_off_is_left_out() {
        let one = parts(Complex::new(1.000_000_000_000_000_2, -1e-17), 4.0 * f64::EPSILON);
        assert_eq!(one.map(f64::to_bits), [1.0_f64, 0.0].map(f64::to_bits));
        assert_eq!(rounded(-123.456_789, 1e-3).to_bits(), (-123.457_f64).to_bits());
        assert_eq!(rounded(-4e-4, 1e-3).to_bits(), 0);
        assert!(rounded(f64::NAN, 1e-3).is_nan() && rounded(f64::INFINITY, 1e-3).is_infinite());
        assert_eq!(
            alloc::format!("{}", Printed(Complex::new(4.235_217_661_e-5_f64, -0.0))),
            "4.235217661e-5"
        );
        assert_eq!(alloc::format!("{}", Printed(Complex::new(-0.5_f32, -0.25))), "-0.5 − 0.25 i");
    }
}
