//! Bounds on the multipliers within a step, from their Taylor series.

use super::memory::TaylorMemory;
use crate::motion::method::MultiplierBounds;
use crate::number::{Real, Scalar, larger};
use crate::vector::{Array, Length, entries};

/// Number of the last terms whose largest bounds the omitted ones.
const LAST: usize = 3;

/// Bounds on the multipliers within the last accepted step.
///
/// A multiplier c₀ + c₁ θ + … differs from c₀ by at most Σ |cₖ| |θ|ᵏ. The omitted terms add up to at most K times the largest of
/// the last three of K terms, if they fall like k⁻² from there on.
pub(super) fn multiplier_bounds<S, T: Real, N: Length, M: Length>(
    memory: &TaylorMemory<S, T, N, M>,
) -> Option<MultiplierBounds<T, M>> {
    let (series, before) = (&memory.series, memory.before.as_ref()?);
    let count = series.v.len() - 1;
    let are_all_active = !before.solved.active.contains(&false) && !memory.solved.active.contains(&false);
    if !are_all_active || memory.is_expanded || series.summed < count || count <= LAST {
        return None;
    }
    let theta = Scalar::abs((memory.clock.now - series.start) / series.unit);
    let size = |k: usize, a: usize| Scalar::abs(series.multipliers[k * M::COUNT + a]);
    let zero = Array::filled(T::constant(0.0));
    let sum = (1..count).rev().fold(zero, |sum: Array<T, M>, k| entries(|a| (sum[a] + size(k, a)) * theta));
    let power = (0..count - LAST).fold(T::constant(1.0), |power, _| power * theta);
    let last = |a: usize| {
        let largest = (count - LAST..count).fold((T::constant(0.0), power), |(largest, power), k| {
            (larger(largest, size(k, a) * power), power * theta)
        });
        largest.0 * T::constant(count as f64)
    };
    let change: Array<T, M> = entries(|a| sum[a] + last(a));
    Some(MultiplierBounds {
        lowest: entries(|a| series.multipliers[a] - change[a]),
        highest: entries(|a| series.multipliers[a] + change[a]),
    })
}
