//! Bounds on the multipliers within a step, from their values at its stages.

use super::pair::{Pair, last};
use super::pair_memory::PairMemory;
use crate::number::{Real, larger, smaller};
use crate::vector::{Array, Element, Length, entries};

/// Bounds on the multiplier of each constraint within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MultiplierBounds<T: Element, M: Length> {
    /// Number that no multiplier falls below.
    pub lowest: Array<T, M>,
    /// Number that no multiplier exceeds.
    pub highest: Array<T, M>,
}

/// Widest gap between stages, as a fraction of the step, across which they say something. A dip 1 − a exp(−(t/w)²) below zero
/// with w = 0.15 steps, as narrow as the search for events finds all, then shows at a stage.
const WIDEST: f64 = 0.3;

/// Extreme points of the Chebyshev polynomial of degree 3, as fractions of the step.
const CUBIC: [f64; 4] = [0.0, 0.25, 0.75, 1.0];

/// Points at which the Lebesgue function is taken.
const POINTS: usize = 256;

/// Number of the slopes of a step.
const fn count<P: Pair>() -> usize {
    last::<P>() + 1 + P::INTERPOLATION_STAGES.len()
}

/// Bounds on the multipliers within the last accepted step, whose dense output is known.
pub(super) fn multiplier_bounds<P: Pair, T: Real, N: Length, M: Length>(
    memory: &PairMemory<T, N, M>,
) -> Option<MultiplierBounds<T, M>> {
    let taken = memory.taken.as_ref()?;
    if const { widest::<P>() > WIDEST }
        || memory.active.contains(&false)
        || taken.from.active.contains(&false)
    {
        return None;
    }
    Some(bounds::<P, _, _>(&memory.stage_multipliers[..const { count::<P>() }]))
}

/// Bounds on functions with these values at the stages.
///
/// A function λ stays within 1 + 2Λ half ranges of the middle of its values at the stages, if it is off a cubic polynomial p by
/// at most a half range R: |p − middle| ≤ 2R at the stages, and ≤ 2ΛR between them, with their Lebesgue constant Λ.
#[inline]
fn bounds<P: Pair, T: Real, M: Length>(all: &[Array<T, M>]) -> MultiplierBounds<T, M> {
    // Halves: half as many comparisons wait for one another. If the values at the start are unknown, NaN remains.
    let (one, other) = all.split_at(const { count::<P>() / 2 });
    let [mut lowest, mut highest] = [all[0]; 2];
    for (x, y) in one.iter().chain(&other[other.len() - 1..]).zip(other.iter().chain(&other[..1])) {
        lowest = entries(|a| smaller(lowest[a], smaller(x[a], y[a])));
        highest = entries(|a| larger(highest[a], larger(x[a], y[a])));
    }
    // From the middle by a half range to the ends, and by 2Λ of them beyond.
    let beyond = |a: usize| (highest[a] - lowest[a]) * T::constant(const { lebesgue::<P>() });
    MultiplierBounds {
        lowest: entries(|a| lowest[a] - beyond(a)),
        highest: entries(|a| highest[a] + beyond(a)),
    }
}

/// Widest gap between the times of two stages, as a fraction of the step.
const fn widest<P: Pair>() -> f64 {
    let (mut widest, mut i) = (0.0, 0);
    while i < count::<P>() {
        let (mut next, mut j) = (1.0, 0);
        while j < count::<P>() {
            if P::NODES[j] > P::NODES[i] && P::NODES[j] < next {
                next = P::NODES[j];
            }
            j += 1;
        }
        if next - P::NODES[i] > widest {
            widest = next - P::NODES[i];
        }
        i += 1;
    }
    widest
}

/// Bound on the Lebesgue constant of the four stages nearest to the extreme points of the Chebyshev polynomial of degree 3.
///
/// Between two points of the grid, a cubic polynomial on −1 … 1 rises above its largest value there by at most 9 Λ (Markov) times
/// the distance, which is at most 1/255.
const fn lebesgue<P: Pair>() -> f64 {
    let nodes = nearest::<P>();
    let (mut most, mut k) = (0.0, 0);
    while k < POINTS {
        let sum = lebesgue_function(&nodes, k as f64 / (POINTS - 1) as f64);
        if sum > most {
            most = sum;
        }
        k += 1;
    }
    most / (1.0 - 9.0 / (POINTS - 1) as f64)
}

/// Times of the stages nearest to the extreme points.
const fn nearest<P: Pair>() -> [f64; 4] {
    let (mut nodes, mut k) = ([f64::INFINITY; 4], 0);
    while k < 4 * count::<P>() {
        let (place, node) = (k % 4, P::NODES[k / 4]);
        if (node - CUBIC[place]).abs() < (nodes[place] - CUBIC[place]).abs() {
            nodes[place] = node;
        }
        k += 1;
    }
    nodes
}

/// Σ |ℓᵢ| of the Lagrange polynomials of four nodes.
const fn lebesgue_function(nodes: &[f64; 4], x: f64) -> f64 {
    let (mut sum, mut i) = (0.0, 0);
    while i < 4 {
        let (mut product, mut j) = (1.0, 0);
        while j < 4 {
            if j != i {
                product *= (x - nodes[j]) / (nodes[i] - nodes[j]);
            }
            j += 1;
        }
        sum += product.abs();
        i += 1;
    }
    sum
}

#[cfg(test)]
mod tests {
    use nalgebra::Const;

    use super::*;
    use crate::fixtures::Random;
    use crate::motion::{DormandPrince54, DormandPrince853};

    type Nodes = DormandPrince853;

    /// Bounds on a function of the fraction of the step, by its values at the stages.
    fn of(f: impl Fn(f64) -> f64) -> [f64; 2] {
        let values = Nodes::NODES.iter().map(|&node| [f(node)].into()).collect::<Vec<Array<f64, Const<1>>>>();
        let MultiplierBounds { lowest, highest } = bounds::<Nodes, _, _>(&values);
        [lowest[0], highest[0]]
    }

    fn grid() -> impl Iterator<Item = f64> {
        (0..=400).map(|k| f64::from(k) / 400.0)
    }

    #[test]
    fn stages_of_dop853_are_dense_and_those_of_dopri5_are_not() {
        assert!((widest::<Nodes>() - 0.266_666_666_666_666_6).abs() < 1e-12, "{}", widest::<Nodes>());
        assert!(widest::<DormandPrince54>() > WIDEST);
    }

    /// The polynomials that are ±1 at the four stages reach the Lebesgue constant.
    #[test]
    fn the_lebesgue_constant_is_that_of_the_stages() {
        let nodes = nearest::<Nodes>();
        let most = grid().map(|x| lebesgue_function(&nodes, x)).fold(0.0, f64::max);
        let found = lebesgue::<Nodes>();
        assert!(nodes == [0.0, 0.25, 0.777_777_777_777_777_8, 1.0], "{nodes:?}");
        assert!(most <= found && found < 1.05 * most && most > 1.5, "{most} {found}");
    }

    /// Whatever is off a cubic polynomial by up to the half range of its values at the stages is within the bounds.
    #[test]
    fn functions_near_cubic_polynomials_are_within_their_bounds() {
        let mut random = Random(11);
        for k in 0..100_000 {
            let c: [f64; 4] = core::array::from_fn(|_| random.next());
            let [rate, phase] = [40.0 * random.next(), 7.0 * random.next()];
            let cubic = |x: f64| c[0] + x * (c[1] + x * (c[2] + x * c[3]));
            let share = 10.0_f64.powf(-2.0 * random.next().abs());
            let f = |x: f64| cubic(x) + share * (rate * x + phase).sin();
            let values = || Nodes::NODES.iter().map(|&node| f(node));
            let (low, high) =
                (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            if share > (high - low) / 2.0 {
                continue;
            }
            let [lowest, highest] = of(f);
            for x in grid() {
                assert!(lowest <= f(x) && f(x) <= highest, "{k}: {} at {x} of {lowest} to {highest}", f(x));
            }
        }
    }

    /// Dips through zero that are as wide as those that the search for events finds all.
    #[test]
    fn dips_are_not_excluded() {
        for middle in grid() {
            for width in [0.15, 0.2, 0.4, 1.0] {
                for depth in [1.0, 1.2, 3.0] {
                    let [lowest, _] = of(|x| 1.0 - depth * (-((x - middle) / width).powi(2)).exp());
                    assert!(lowest <= 0.0, "a dip of {depth} at {middle}, {width} wide, has {lowest}");
                }
            }
        }
    }
}
