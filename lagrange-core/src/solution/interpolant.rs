//! What lies between the two ends of a step.

use core::array::from_fn;

use crate::number::{Real, Scalar, entries};
use crate::solution::vector_field::{PhaseVector, StagePoint};

/// The motion within one step, as a method knows it: continuous, and equal to the states at both ends.
///
/// It knows where its step starts and how long it is.
pub trait Interpolant<T, const N: usize> {
    /// The place at a time within the step, and a velocity there or nearby.
    fn at(&self, t: T) -> StagePoint<T, N>;
}

/// A polynomial r₀ + θ(r₁ + (1−θ)(r₂ + θ(r₃ + (1−θ)(…)))), θ from 0 to 1 over the step (Hairer, Nørsett and Wanner,
/// *Solving Ordinary Differential Equations I*, II.6). `C` are the coefficients r₀, r₁, …, an array of [`PhaseVector`]s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial<T, C> {
    start: T,
    length: T,
    coefficients: C,
}

impl<T: Real, C> Polynomial<T, C> {
    /// Of a step from the time `start`, of this length, negative where it leads back.
    #[inline(always)]
    pub fn new(start: T, length: T, coefficients: C) -> Self {
        Self { start, length, coefficients }
    }
}

#[cfg(feature = "alloc")]
impl<T, C> Polynomial<T, C> {
    /// The coefficients, to be written where they stay.
    pub(crate) fn coefficients_mut<X>(&mut self) -> &mut [X]
    where
        C: AsMut<[X]>,
    {
        self.coefficients.as_mut()
    }
}

/// The place and its rates at one end of a step.
pub type HermiteNode<T, const N: usize> = (PhaseVector<T, N>, PhaseVector<T, N>);

/// Puts the coefficients of the cubic polynomial between two places with these rates, a step of `length` apart, into four
/// `coefficients`.
#[inline]
pub(crate) fn hermite<T: Scalar, const N: usize>(
    length: T,
    (start, first): (&PhaseVector<T, N>, &PhaseVector<T, N>),
    (end, last): (&PhaseVector<T, N>, &PhaseVector<T, N>),
    coefficients: &mut [PhaseVector<T, N>],
) {
    for half in 0..2 {
        for i in 0..N {
            let rise = end[half][i] - start[half][i];
            let bend = length * first[half][i] - rise;
            let entries = [start[half][i], rise, bend, rise - length * last[half][i] - bend];
            for (coefficient, entry) in coefficients.iter_mut().zip(entries) {
                coefficient[half][i] = entry;
            }
        }
    }
}

impl<T: Real, const N: usize> Polynomial<T, [PhaseVector<T, N>; 4]> {
    /// The cubic polynomial with the places and rates at both ends of a step: its error is of the fourth order.
    pub fn hermite(start: T, length: T, first: &HermiteNode<T, N>, last: &HermiteNode<T, N>) -> Self {
        let mut coefficients = [[[T::constant(0.0); N]; 2]; 4];
        hermite(length, (&first.0, &first.1), (&last.0, &last.1), &mut coefficients);
        Self::new(start, length, coefficients)
    }
}

impl<T: Real, const N: usize, C: AsRef<[PhaseVector<T, N>]>> Interpolant<T, N> for Polynomial<T, C> {
    // Inlined, so that a velocity which nobody asks for is not computed.
    #[inline(always)]
    fn at(&self, t: T) -> StagePoint<T, N> {
        let (y, velocity) = evaluate(self.coefficients.as_ref(), (t - self.start) / self.length);
        StagePoint { t, y, velocity: velocity.map(|x| x / self.length) }
    }
}

/// The polynomial, and the derivative of its first half by θ.
#[inline(always)]
pub(crate) fn evaluate<T: Scalar, const N: usize>(
    coefficients: &[PhaseVector<T, N>],
    theta: T,
) -> (PhaseVector<T, N>, [T; N]) {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let (mut sum, mut slope) = ([[zero; N]; 2], [zero; N]);
    for (k, r) in coefficients.iter().enumerate().rev() {
        let (factor, sign) = if k % 2 == 0 { (theta, one) } else { (one - theta, -one) };
        slope = entries(|i| factor.multiply_add(slope[i], sign * sum[0][i]));
        sum = from_fn(|half| entries(|i| factor.multiply_add(sum[half][i], r[half][i])));
    }
    (sum, slope)
}
