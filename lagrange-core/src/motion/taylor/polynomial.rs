//! Dense output of Taylor's method: the series itself.

use crate::number::{ROOM, Real};
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::StagePoint;
use crate::vector::{Array, Element, PhaseVector, StaticLength, vector};

/// The Taylor series of the coordinates about the start of a step; the velocities are its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaylorPolynomial<T: Element, N: StaticLength> {
    start: T,
    unit: T,
    count: usize,
    coefficients: [Array<T, N>; ROOM],
}

impl<T: Real, N: StaticLength> TaylorPolynomial<T, N> {
    /// Creates the polynomial from its coefficients of powers of (t − start)/unit, at most [`ROOM`] of them.
    pub(super) fn new(start: T, unit: T, coefficients: impl ExactSizeIterator<Item = Array<T, N>>) -> Self {
        let mut polynomial = Self::empty(start, unit);
        polynomial.set(coefficients);
        polynomial
    }

    /// The zero polynomial.
    pub(super) fn empty(start: T, unit: T) -> Self {
        Self { start, unit, count: 0, coefficients: [Array::filled(T::constant(0.0)); ROOM] }
    }

    /// Sets the coefficients.
    pub(super) fn set(&mut self, coefficients: impl ExactSizeIterator<Item = Array<T, N>>) {
        self.count = coefficients.len().min(ROOM);
        self.coefficients.iter_mut().zip(coefficients).for_each(|(place, coefficient)| *place = coefficient);
    }
}

impl<T: Real, N: StaticLength> Interpolant<T, N> for TaylorPolynomial<T, N> {
    fn at(&self, t: T) -> StagePoint<T, N> {
        let theta = (t - self.start) / self.unit;
        let zero = T::constant(0.0);
        let (mut q, mut slope) = (Array::filled(zero), Array::filled(zero));
        for coefficient in self.coefficients[..self.count].iter().rev() {
            for i in 0..N::COUNT {
                slope[i] = slope[i].multiply_add(theta, q[i]);
                q[i] = q[i].multiply_add(theta, coefficient[i]);
            }
        }
        let v = slope.map(|x| x / self.unit);
        StagePoint { t, y: PhaseVector::new([q, v]), velocity: vector(v) }
    }
}
