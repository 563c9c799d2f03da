//! The ITP method for a zero between two points of opposite sign: I. F. D. Oliveira and R. H. C. Takahashi, *ACM
//! Transactions on Mathematical Software* 47 (2021), 5:1–5:24, with their κ₁ = 0.2/(b − a), κ₂ = 2 and n₀ = 1.
//!
//! Interpolation estimates the zero, truncation moves the estimate a little towards the middle, and projection limits
//! its distance from the middle, so that the method is never slower than bisection by more than one step.

use crate::number::{Real, Scalar, smaller};

/// A point x between 0 and 1, an attached result such as a state, and the value of the function.
#[derive(Clone)]
pub(crate) struct Probe<T, S> {
    pub(crate) x: T,
    pub(crate) what: S,
    pub(crate) value: T,
}

/// Narrows an interval around a zero. Returns the last point before the zero and the first one after it, where the
/// function is zero or has the opposite sign, at most 2 `resolution` apart. `at` evaluates the result and the value at
/// a point.
pub(crate) fn narrow<T: Real, S: Clone, E>(
    [mut low, mut high]: [Probe<T, S>; 2],
    resolution: T,
    mut at: impl FnMut(T) -> Result<(S, T), E>,
) -> Result<[Probe<T, S>; 2], E> {
    let (zero, half, two) = (T::constant(0.0), T::constant(0.5), T::constant(2.0));
    let length = high.x - low.x;
    let truncation = T::constant(0.2) / length;
    // Largest distance from the middle that still guarantees the resolution within one step more than bisection.
    let mut reach = resolution;
    while reach < length {
        reach *= two;
    }
    while high.x - low.x > two * resolution && high.value != zero {
        let width = high.x - low.x;
        let middle = low.x + half * width;
        let secant = low.x + width * (low.value / (low.value - high.value));
        let (away, push) = (middle - secant, truncation * width * width);
        let truncated = if push <= Scalar::abs(away) { secant + toward(away, push) } else { middle };
        let radius = reach - half * width;
        let offset = truncated - middle;
        let x = middle + toward(offset, smaller(Scalar::abs(offset), radius));
        reach *= half;
        let (what, value) = at(x)?;
        let probe = Probe { x, what, value };
        if value * low.value.signum() > zero { low = probe } else { high = probe }
    }
    Ok([low, high])
}

/// The length, with the sign of `way`.
fn toward<T: Real>(way: T, length: T) -> T {
    if way < T::constant(0.0) { -length } else { length }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function and its zero.
    type Solved = (fn(f64) -> f64, f64);

    /// Location of the zero, distance of the two points, and number of evaluations.
    fn zero(resolution: f64, f: impl Fn(f64) -> f64) -> (f64, f64, usize) {
        let ends = [0.0, 1.0].map(|x| Probe { x, what: x, value: f(x) });
        let mut evaluations = 0;
        let sign = ends[0].value.signum();
        let narrowed = narrow(ends, resolution, |x| {
            evaluations += 1;
            Ok::<_, ()>((x, f(x)))
        });
        let [low, high] = narrowed.expect("no error");
        assert!(low.value * sign > 0.0 && high.value * sign <= 0.0);
        (high.what, high.what - low.what, evaluations)
    }

    #[test]
    fn zeros_are_narrowed_down_in_few_evaluations() {
        let functions: [Solved; 5] = [
            (|x| x - 0.3, 0.3),
            (|x| 0.3 - x, 0.3),
            (|x| (1.5 * x).sin() - 0.9, 0.9_f64.asin() / 1.5),
            (|x| (10.0 * x).exp() - 2000.0, 2000.0_f64.ln() / 10.0),
            (|x| (x - 0.7).powi(3), 0.7),
        ];
        for (function, expected) in functions {
            let (found, apart, evaluations) = zero(1e-15, function);
            assert!((found - expected).abs() < 1e-14 || expected == 0.7, "{found}, not {expected}");
            assert!(apart <= 2e-15 || function(found) == 0.0, "{apart:e} apart");
            assert!(evaluations <= 52, "{evaluations} evaluations");
        }
        let (_, _, evaluations) = zero(1e-15, |x| x.cos() - x);
        assert!(evaluations <= 14, "{evaluations} evaluations");
    }

    #[test]
    fn no_function_takes_more_than_bisection_and_one() {
        let steep = |x: f64| if x < 0.123_456 { -1.0 } else { 1e300 };
        let flat = |x: f64| (x - 0.99).powi(9);
        for function in [steep, flat] {
            let (_, apart, evaluations) = zero(1e-12, function);
            assert!(apart <= 2e-12 && evaluations <= 41, "{apart:e} apart after {evaluations}");
        }
    }
}
