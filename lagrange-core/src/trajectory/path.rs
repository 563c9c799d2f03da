//! The accepted steps, and what lies between them.

use alloc::vec::Vec;
use core::array::from_fn;

use crate::number::Real;
use crate::solution::flow::{Phase, PhasePoint};
use crate::system::State;

/// The states at the ends of the steps, and the interpolants between them.
pub(crate) struct Path<T, const N: usize> {
    pub(super) start: State<T, N>,
    pub(super) last: State<T, N>,
    /// The times at the starts of the steps.
    times: Vec<T>,
    coefficients: Vec<Phase<T, N>>,
    /// Coefficients a step.
    stride: usize,
}

impl<T: Real, const N: usize> Path<T, N> {
    pub(crate) fn from(start: State<T, N>) -> Self {
        Self { start, last: start, times: Vec::new(), coefficients: Vec::new(), stride: 0 }
    }

    pub(crate) fn push(&mut self, state: State<T, N>, interpolant: &[Phase<T, N>]) {
        self.times.push(self.last.t);
        self.coefficients.extend_from_slice(interpolant);
        self.stride = interpolant.len();
        self.last = state;
    }

    /// Where step `step` starts.
    pub(super) fn start_of(&self, step: usize) -> Option<PhasePoint<T, N>> {
        Some(self.point(step, *self.times.get(step)?))
    }

    /// `None` before the start and from the last state on.
    pub(super) fn at(&self, t: T) -> Option<PhasePoint<T, N>> {
        if !(t >= self.start.t && t < self.last.t) {
            return None;
        }
        let step = self.times.partition_point(|start| *start <= t).checked_sub(1)?;
        Some(self.point(step, t))
    }

    fn point(&self, step: usize, t: T) -> PhasePoint<T, N> {
        let time = |step: usize| self.times.get(step).copied().unwrap_or(self.last.t);
        let (begin, length) = (time(step), time(step + 1) - time(step));
        let (y, velocity) = evaluate(self.interpolant(step), (t - begin) / length);
        PhasePoint { t, y, velocity: velocity.map(|x| x / length) }
    }

    fn interpolant(&self, step: usize) -> &[Phase<T, N>] {
        let from = step * self.stride;
        self.coefficients.get(from..from + self.stride).unwrap_or(&[])
    }
}

/// r₀ + θ(r₁ + (1−θ)(r₂ + θ(r₃ + …))), and the derivative of its first half by θ.
fn evaluate<T: Real, const N: usize>(coefficients: &[Phase<T, N>], theta: T) -> (Phase<T, N>, [T; N]) {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let (mut sum, mut slope) = ([[zero; N]; 2], [zero; N]);
    for (k, r) in coefficients.iter().enumerate().rev() {
        let (factor, sign) = if k % 2 == 0 { (theta, one) } else { (one - theta, -one) };
        slope = from_fn(|i| sign * sum[0][i] + factor * slope[i]);
        sum = from_fn(|half| from_fn(|i| r[half][i] + factor * sum[half][i]));
    }
    (sum, slope)
}
