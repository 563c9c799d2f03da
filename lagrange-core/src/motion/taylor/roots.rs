//! Detection of steps in which the series of a root becomes negative, which the root cannot: the series of
//! √x² at x > 0 is x, also where x < 0.

use super::expansion::Expansion;
use crate::number::{Real, Scalar, exceeds, power_of_epsilon};
use crate::system::TaylorSeries;
use crate::vector::{FixedArray, StaticLength};

/// Series of a root, or of the argument of a steep function, in powers of (t − t₀)/unit.
pub(super) struct WatchedSeries<I, T> {
    value: T,
    /// Coefficients from order 1 on.
    coefficients: I,
}

impl<T: Scalar, I: Iterator<Item = T> + Clone> WatchedSeries<I, T> {
    pub(super) fn new(value: T, coefficients: I) -> Self {
        Self { value, coefficients }
    }

    /// Value at the start, and a bound on the change over a step of this length. The bound usually shows that a root
    /// does not vanish: its zero, a branch point, is about four steps away (e to the power of `STEP`).
    pub(super) fn value_and_change(&self, length: T) -> [T; 2] {
        let zero = T::constant(0.0);
        let sum = |(sum, power): (T, T), c: T| (sum + (c * power).abs(), power * length);
        [self.value, self.coefficients.clone().fold((zero, length), sum).0]
    }
}

impl<T: Real, I: Iterator<Item = T> + Clone> WatchedSeries<I, T> {
    /// Position of the minimum of the series in a step of this length, if the minimum is below zero.
    fn vanishes(&self, length: T) -> Option<T> {
        let [value, change] = self.value_and_change(length);
        if change < value { None } else { self.least(length) }
    }

    /// The same: the lowest of as many points as the series has orders, then a search for the minimum between its
    /// neighbours, to √ε of the step, within which the value changes by round-off only.
    #[cold]
    fn least(&self, length: T) -> Option<T> {
        let count = self.coefficients.clone().count();
        let at = |k: usize| length * T::constant(k as f64 / count as f64);
        let lowest =
            (1..=count).fold(1, |lowest, k| if self.at(at(k)) < self.at(at(lowest)) { k } else { lowest });
        let (mut from, mut to) = (at(lowest - 1), at((lowest + 1).min(count)));
        while Scalar::abs(to - from) > power_of_epsilon::<T>(0.5) * Scalar::abs(length) {
            let third = (to - from) / T::constant(3.0);
            let [near, far] = [from + third, to - third];
            if self.at(near) < self.at(far) { to = far } else { from = near }
        }
        let candidates = [(from + to) / T::constant(2.0), at(lowest)];
        candidates.into_iter().find(|&theta| exceeds(T::constant(0.0), self.at(theta)))
    }

    fn at(&self, theta: T) -> T {
        let (sum, _) = self
            .coefficients
            .clone()
            .fold((self.value, theta), |(sum, power), c| (c.multiply_add(power, sum), power * theta));
        sum
    }
}

impl<S: FixedArray<T>, T: Scalar, N: StaticLength> Expansion<S, T, N> {
    /// Series of the roots, in powers of (t − t₀)/unit.
    pub(super) fn series_of_roots<L: TaylorSeries<Scalar = T, Sums = S>>(
        &self,
    ) -> impl Iterator<Item = WatchedSeries<impl Iterator<Item = T> + Clone, T>> {
        let coefficients = |place| self.factors.right_factor(place, self.order() - 1);
        let root = move |(&[place, _], &value): (&[usize; 2], &T)| WatchedSeries {
            value,
            coefficients: coefficients(place),
        };
        L::ROOTS.iter().zip(&self.roots).map(root)
    }
}

impl<S: FixedArray<T>, T: Real, N: StaticLength> Expansion<S, T, N> {
    /// For each root whose series becomes negative in a step of this length, a position with a negative value.
    pub(super) fn roots_below_zero<L: TaylorSeries<Scalar = T, Sums = S>>(
        &self,
        length: T,
    ) -> impl Iterator<Item = T> {
        let theta = length / self.unit;
        let vanishing = self.series_of_roots::<L>().filter_map(move |root| root.vanishes(theta));
        vanishing.map(|theta| theta * self.unit)
    }
}
