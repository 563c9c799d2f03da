//! Random smooth functions that stand in for user-supplied functions, of which no formula is known.
//!
//! f(x) = Σ_k a_k sin(w_k·x + φ_k). The derivatives are consistent with the function, so that equations that contain f
//! can be solved. Equal arguments give equal values, however they are written.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::evaluate::{Approximate, apply};
use super::graph::{External, Function};
use super::random::random;

/// Number of waves: enough that a function and its first derivatives satisfy no relation by chance.
const WAVES: u64 = 6;

/// Value of a random function, or of its derivative, at given arguments: Σ_k a_k Π_j w_kj sin(w_k·x + φ_k + d π/2),
/// where j runs over the d arguments of differentiation. Along a direction v, w_k·v is one more factor.
pub fn superposition(external: &External, arguments: &[Approximate], draw: u64) -> Approximate {
    let quarters = external.order() as f64 * FRAC_PI_2;
    let (arguments, direction) = arguments.split_at(arguments.len() / (1 + usize::from(external.is_along)));
    (0..WAVES).fold(Approximate::exact(0.0), |sum, k| {
        let number = |kind: u64, argument: u64| {
            let function = u64::from(external.function) << 28 | u64::from(external.output) << 16;
            random(kind, function | k << 12 | argument, draw)
        };
        let frequency = |i: u64| Approximate::exact(0.5 + 1.5 * number(250, i));
        let phase = Approximate::exact(TAU * number(251, 0)).plus(Approximate::exact(quarters));
        let on = |start, x: &[Approximate]| {
            x.iter().zip(0..).fold(start, |sum: Approximate, (&x, i)| sum.plus(frequency(i).times(x)))
        };
        let phase = on(phase, arguments);
        let amplitude = Approximate::exact(2.0 * number(252, 0) - 1.0);
        let amplitude = external.derivatives.iter().fold(amplitude, |a, &i| a.times(frequency(u64::from(i))));
        let amplitude = match external.is_along {
            true => amplitude.times(on(Approximate::exact(0.0), direction)),
            false => amplitude,
        };
        sum.plus(amplitude.times(apply(Function::Sin, phase)))
    })
}
