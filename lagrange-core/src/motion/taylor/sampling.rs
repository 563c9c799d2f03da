//! Sampling of the equations within a step, to check the series.
//!
//! A force that vanishes to round-off at the start of a step is not in the series of the motion, however
//! strong it is later: a Gaussian pulse, or a step of the potential by tanh. Samples of the equations detect
//! it. The distance between samples is at most [twice](WIDER) that of the step before, unless there are
//! [`MOST`] samples. Few samples suffice if terms of middle orders are significant, as is usual in a step
//! whose length follows from the last terms.

use super::expansion::{Expansion, is_linear};
use super::limits::{AT_FUNCTIONS, GROWTH, MOST, STEEP, WIDER};
use super::roots::WatchedSeries;
use crate::number::{Real, Scalar, larger, smaller};
use crate::system::TaylorSeries;
use crate::vector::{FixedArray, StaticLength};

/// Position of the first sample, in units of the distance between samples and from the last one to the end: the ratio
/// that is worst approximated by fractions, so that not all samples coincide with zeros of a periodic force.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Length of the last step, and distance between its samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampling<T> {
    /// Length of the last step, zero before the first.
    pub(super) step: T,
    pub(super) distance: T,
}

impl<T: Real> Sampling<T> {
    /// Initial value, for a first step of at most this length.
    pub(super) fn of_first(longest: T) -> Self {
        Self { step: T::constant(0.0), distance: longest / T::constant(WIDER * MOST as f64) }
    }

    /// Value after a step of this length with `count` samples within.
    pub(super) fn after(length: T, count: usize) -> Self {
        Self { step: length, distance: length / T::constant(larger(count as f64 + GOLDEN, 1.0)) }
    }

    /// Largest length of the next step; `first` if it is the first.
    pub(super) fn longest<L: TaylorSeries>(&self, first: T) -> T {
        match (is_linear::<L>(), self.step > T::constant(0.0)) {
            (true, _) => T::constant(f64::INFINITY),
            (false, true) => T::constant(GROWTH) * self.step,
            (false, false) => first,
        }
    }

    /// Number of samples in a step of this length whose series lacks terms of middle orders.
    pub(super) fn count<L: TaylorSeries>(&self, length: T) -> usize {
        let few = few::<L>();
        if is_linear::<L>() {
            return few;
        }
        let distances = length / (T::constant(WIDER) * self.distance);
        (smaller(distances, T::constant(MOST as f64)).to_f64() as usize).max(few)
    }
}

impl<S: FixedArray<T>, T: Scalar, N: StaticLength> Expansion<S, T, N> {
    /// Arguments of steep functions: each with its value, a bound on its change in a step of this length, and its
    /// exponent.
    pub(super) fn steep<L: TaylorSeries<Scalar = T, Sums = S>>(
        &self,
        length: T,
    ) -> impl Iterator<Item = ([T; 2], usize)> {
        let theta = length / self.unit;
        let steep = move |(&[place, _, exponent], &value): (&[usize; 3], &T)| {
            let watched = WatchedSeries::new(value, self.factors.left_factor(place, self.order() - 1));
            (watched.value_and_change(theta), exponent)
        };
        L::STEEP.iter().zip(&self.steep).map(steep)
    }
}

/// Logarithm of the smallest normal number: exponentials of less are zero.
const UNDERFLOW_OF_EXP: f64 = (f64::MIN_EXP - 1) as f64 * core::f64::consts::LN_2;

/// Number of samples needed for a steep function whose argument has this value and changes by up to `change` in a step:
/// e^x and tanh x (exponent 0), or x^exponent. None are needed where e^−|x| underflows.
pub(super) fn samples_of_steep([value, change]: [f64; 2], exponent: usize) -> usize {
    let (value, change) = (value.abs(), change.abs());
    let logarithm = if exponent == 0 { change } else { exponent as f64 * change / value };
    match logarithm <= STEEP || exponent == 0 && change - value < UNDERFLOW_OF_EXP {
        true => 0,
        // The quotient is NaN if value and change are zero.
        false => smaller(logarithm / STEEP, MOST as f64) as usize,
    }
}

impl<S: FixedArray<T>, T: Real, N: StaticLength> Expansion<S, T, N> {
    /// True if terms of the second quarter of the orders are significant in a step of this length. If they are not,
    /// the series may lack a force that is negligible at the start of the step.
    #[cold]
    pub(super) fn has_middle_terms(&self, length: T, [tolerance, slack]: [f64; 2]) -> bool {
        let (scales, theta) = (self.scales(T::constant(slack)), Scalar::abs(length / self.unit));
        let [first, end] = [4, 2].map(|part| (self.order() / part).max(1));
        let powers = (0..=end).scan(T::constant(1.0), |power, _| {
            let this = *power;
            *power = this * theta;
            Some(this)
        });
        let mut terms =
            powers.enumerate().skip(first).map(|(order, power)| self.size(order, &scales) * power);
        terms.any(|term| term >= T::constant(tolerance))
    }
}

/// Number of samples within a step whose series [has middle terms](Expansion::has_middle_terms). The check at
/// the end suffices without user-supplied functions.
pub(super) const fn few<L: TaylorSeries>() -> usize {
    if L::ARGUMENTS.is_empty() { 0 } else { AT_FUNCTIONS }
}

/// Positions of the samples of a step, as fractions of it.
pub(super) fn parts(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| (k as f64 + GOLDEN) / (count as f64 + GOLDEN))
}
