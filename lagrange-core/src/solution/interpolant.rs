//! Dense output: the motion within a step.

use crate::number::{Real, Scalar};
use crate::solution::vector_field::StagePoint;
use crate::vector::{Element, Length, Numbers, PhaseVector, VectorOf};

/// Dense output of one step: a continuous function of time, equal to the states at both ends.
///
/// An interpolant contains the start time and the length of its step.
pub trait Interpolant<T: Element, N: Length> {
    /// True if states of a motion satisfy its constraints, so that those within a step are projected onto them.
    #[doc(hidden)]
    const IS_PROJECTED: bool = true;

    /// Returns the phase at a time within the step, with a velocity there or nearby.
    fn at(&self, t: T) -> StagePoint<T, N>;
}

/// A polynomial r₀ + θ(r₁ + (1−θ)(r₂ + θ(r₃ + (1−θ)(…)))), θ from 0 to 1 over the step (Hairer, Nørsett and
/// Wanner, *Solving Ordinary Differential Equations I*, II.6). `C` is an array of the coefficients r₀, r₁, …,
/// each a [`PhaseVector`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial<T, C> {
    start: T,
    length: T,
    coefficients: C,
}

impl<T: Real, C> Polynomial<T, C> {
    /// Creates the polynomial of a step from the time `start`, of signed `length`, negative backwards in time.
    #[inline(always)]
    pub fn new(start: T, length: T, coefficients: C) -> Self {
        Self { start, length, coefficients }
    }
}

impl<T, C> Polynomial<T, C> {
    /// Returns the coefficients for writing in place.
    pub(crate) fn coefficients_mut<X>(&mut self) -> &mut [X]
    where
        C: AsMut<[X]>,
    {
        self.coefficients.as_mut()
    }
}

/// The phase and its rate at one end of a step.
pub type HermiteNode<T, N> = (PhaseVector<T, N>, PhaseVector<T, N>);

/// Writes the four coefficients of the cubic Hermite interpolant over a step of `length`, from the phase and
/// its rate at both ends.
#[inline]
pub(crate) fn hermite<T: Scalar, N: Length>(
    length: T,
    (start, first): (&PhaseVector<T, N>, &PhaseVector<T, N>),
    (end, last): (&PhaseVector<T, N>, &PhaseVector<T, N>),
    coefficients: &mut [PhaseVector<T, N>],
) {
    for half in 0..2 {
        for i in 0..start[half].len() {
            let rise = end[half][i] - start[half][i];
            let bend = length * first[half][i] - rise;
            let entries = [start[half][i], rise, bend, rise - length * last[half][i] - bend];
            for (coefficient, entry) in coefficients.iter_mut().zip(entries) {
                coefficient[half][i] = entry;
            }
        }
    }
}

impl<T: Real, N: Length> Polynomial<T, [PhaseVector<T, N>; 4]> {
    /// Cubic Hermite interpolant of a step, with an error of fourth order.
    pub fn hermite(start: T, length: T, first: &HermiteNode<T, N>, last: &HermiteNode<T, N>) -> Self {
        let mut coefficients = core::array::from_fn(|_| first.0.clone());
        hermite(length, (&first.0, &first.1), (&last.0, &last.1), &mut coefficients);
        Self::new(start, length, coefficients)
    }
}

impl<T: Real, N: Length, C: AsRef<[PhaseVector<T, N>]>> Interpolant<T, N> for Polynomial<T, C> {
    // Inlined, so that an unused velocity is not computed.
    #[inline(always)]
    fn at(&self, t: T) -> StagePoint<T, N> {
        let (y, mut velocity) = evaluate(self.coefficients.as_ref(), (t - self.start) / self.length);
        velocity.entries_mut().iter_mut().for_each(|x| *x /= self.length);
        StagePoint { t, y, velocity }
    }
}

/// Returns the polynomial at θ, and the derivative of its first half by θ. For a run-time length this derivative has no entries.
#[inline(always)]
pub(crate) fn evaluate<T: Scalar, N: Length>(
    coefficients: &[PhaseVector<T, N>],
    theta: T,
) -> (PhaseVector<T, N>, VectorOf<T, N>) {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let mut sum = coefficients.first().map_or(PhaseVector::placeholder(zero), Clone::clone);
    sum.flat_mut().fill(zero);
    let mut slope = sum.half_if_constant(0);
    for (k, r) in coefficients.iter().enumerate().rev() {
        let (factor, sign) = if k % 2 == 0 { (theta, one) } else { (one - theta, -one) };
        for (slope, sum) in slope.entries_mut().iter_mut().zip(&sum[0]) {
            *slope = factor.multiply_add(*slope, sign * *sum);
        }
        for (sum, r) in sum.flat_mut().iter_mut().zip(r.flat()) {
            *sum = factor.multiply_add(*sum, *r);
        }
    }
    (sum, slope)
}
