//! Bounds on the multipliers within a step, from their values at its stages.

use super::pair::{Pair, SLOPES, Slopes, TableauRow, advance, last};
use super::pair_memory::{PairMemory, Taken};
use super::slope::slope;
use crate::error::Error;
use crate::motion::limits::{POINTS, WIDEST};
use crate::number::{Real, Scalar, larger, smaller};
use crate::solution::vector_field::{StagePoint, VectorField};
use crate::statistics::Statistics;
use crate::system::System;
use crate::vector::{Array, Element, StaticLength};

/// Bounds on the multiplier of each constraint within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MultiplierBounds<T: Element, M: StaticLength> {
    /// Number that no multiplier falls below.
    pub lowest: Array<T, M>,
    /// Number that no multiplier exceeds.
    pub highest: Array<T, M>,
}

/// Extreme points of the Chebyshev polynomial of degree 3, as fractions of the step.
const CUBIC: [f64; 4] = [0.0, 0.25, 0.75, 1.0];

/// Number of the slopes of a step.
const fn count<P: Pair>() -> usize {
    last::<P>() + 1 + P::INTERPOLATION_STAGES.len()
}

/// Bounds on the multipliers within the last accepted step, whose dense output is known. Where the stages leave too wide a gap, they
/// are evaluated in its middle too.
pub(super) fn multiplier_bounds<P: Pair, L: System<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    memory: &PairMemory<L::Scalar, L::Length, L::M>,
    statistics: &mut Statistics,
) -> Option<MultiplierBounds<L::Scalar, L::M>> {
    let taken = memory.taken.as_ref()?;
    if const { widest::<P>(middle::<P>())[1] > WIDEST }
        || memory.active.contains(&false)
        || taken.from.active.contains(&false)
    {
        return None;
    }
    let stages = &memory.stage_multipliers[..const { count::<P>() }];
    let another = match const { widest::<P>(0.0)[1] > WIDEST } {
        false => stages[0],
        true => in_the_middle::<P, L, F>(system, taken, &memory.slopes, statistics).ok()?,
    };
    Some(bounds::<P, _, _>(stages, &another))
}

/// Multipliers in the middle of the widest gap between stages.
fn in_the_middle<P: Pair, L: System<Scalar: Real>, F: VectorField<L>>(
    system: &L,
    Taken { from, h, .. }: &Taken<L::Scalar, L::Length, L::M>,
    slopes: &Slopes<L::Scalar, L::Length>,
    statistics: &mut Statistics,
) -> Result<Array<L::Scalar, L::M>, Error> {
    let t = from.t + *h * L::Scalar::constant(const { middle::<P>() });
    let mut point = StagePoint { t, y: from.y.clone(), velocity: slopes[0].half_if_constant(0) };
    let row = &const { row_at::<P>(middle::<P>()) }[..const { count::<P>() }];
    advance(&from.y, *h, slopes, row, &mut point.y);
    let mut rates = point.y.clone();
    Ok(slope::<L, F>(system, &point, Some(&from.active), &mut rates, statistics)?.multipliers)
}

/// Coefficients of the slopes in the dense output at a part θ of the step: those of r₀ + θ(r₁ + (1−θ)(r₂ + θ(r₃ + …))).
const fn row_at<P: Pair>(theta: f64) -> [(usize, f64); SLOPES] {
    let (mut row, mut i) = ([(0, 0.0); SLOPES], 0);
    while i < SLOPES {
        row[i].0 = i;
        i += 1;
    }
    let [one, two, three] = [theta, theta * (1.0 - theta), theta * theta * (1.0 - theta)];
    add(&mut row, P::WEIGHTS, one - two + 2.0 * three);
    row[0].1 += two - three;
    row[last::<P>()].1 -= three;
    let (mut factor, mut k) = (three, 0);
    while k < P::INTERPOLATION.len() {
        factor *= if k % 2 == 0 { 1.0 - theta } else { theta };
        add(&mut row, P::INTERPOLATION[k], factor);
        k += 1;
    }
    row
}

/// Adds a multiple of the coefficients `of` slopes.
const fn add(row: &mut [(usize, f64); SLOPES], of: TableauRow, factor: f64) {
    let mut k = 0;
    while k < of.len() {
        row[of[k].0].1 += factor * of[k].1;
        k += 1;
    }
}

/// Bounds on functions with these values at the stages, and at another time.
///
/// A function λ stays within 1 + 2Λ half ranges of the middle of these values, if it is off a cubic polynomial p by at most a half
/// range R: |p − middle| ≤ 2R at the stages, and ≤ 2ΛR between them, with their Lebesgue constant Λ.
#[inline]
fn bounds<P: Pair, T: Real, M: StaticLength>(
    all: &[Array<T, M>],
    another: &Array<T, M>,
) -> MultiplierBounds<T, M> {
    // Halves: half as many comparisons wait for one another. If the values at the start are unknown, NaN remains.
    let (one, other) = all.split_at(const { count::<P>() / 2 });
    let [mut lowest, mut highest] = [all[0]; 2];
    for (x, y) in one.iter().chain(&other[other.len() - 1..]).zip(other.iter().chain(&other[..1])) {
        lowest = Array::from_fn(|a| smaller(lowest[a], smaller(x[a], y[a])));
        highest = Array::from_fn(|a| larger(highest[a], larger(x[a], y[a])));
    }
    lowest = Array::from_fn(|a| smaller(lowest[a], another[a]));
    highest = Array::from_fn(|a| larger(highest[a], another[a]));
    // From the middle by a half range to the ends, and by 2Λ of them beyond.
    let beyond = |a: usize| (highest[a] - lowest[a]) * T::constant(const { lebesgue::<P>() });
    MultiplierBounds {
        lowest: Array::from_fn(|a| lowest[a] - beyond(a)),
        highest: Array::from_fn(|a| highest[a] + beyond(a)),
    }
}

/// Middle of the widest gap between stages.
const fn middle<P: Pair>() -> f64 {
    let [start, width] = widest::<P>(0.0);
    start + width / 2.0
}

/// Start and width of the widest gap between the times of two stages, or of a stage and `another` time, as fractions of the step.
const fn widest<P: Pair>(another: f64) -> [f64; 2] {
    let ([mut start, mut widest], mut i) = ([0.0, gap::<P>(another, another)], 0);
    while i < count::<P>() {
        let gap = gap::<P>(P::NODES[i], another);
        if gap > widest {
            [start, widest] = [P::NODES[i], gap];
        }
        i += 1;
    }
    [start, widest]
}

/// Time from here to the next stage, or to `another` time.
const fn gap<P: Pair>(from: f64, another: f64) -> f64 {
    let (mut next, mut i) = (if another > from { another } else { 1.0 }, 0);
    while i < count::<P>() {
        if P::NODES[i] > from && P::NODES[i] < next {
            next = P::NODES[i];
        }
        i += 1;
    }
    next - from
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
    use crate::motion::{DormandPrince54, DormandPrince853};
    use lagrange_random::Random;

    /// Fractions of the step at which functions are known.
    fn places<P: Pair>() -> impl Iterator<Item = f64> {
        P::NODES.iter().copied().chain([another::<P>()])
    }

    /// The middle of the widest gap, if the stages leave one that is too wide; else the first stage.
    fn another<P: Pair>() -> f64 {
        if widest::<P>(0.0)[1] > WIDEST { middle::<P>() } else { 0.0 }
    }

    /// Bounds on a function of the fraction of the step, by its values there.
    fn of<P: Pair>(f: impl Fn(f64) -> f64) -> [f64; 2] {
        let value = |place: f64| Array::<f64, Const<1>>::from([f(place)]);
        let stages: Vec<_> = P::NODES.iter().map(|&node| value(node)).collect();
        let MultiplierBounds { lowest, highest } = bounds::<P, _, _>(&stages, &value(another::<P>()));
        [lowest[0], highest[0]]
    }

    fn grid() -> impl Iterator<Item = f64> {
        (0..=400).map(|k| f64::from(k) / 400.0)
    }

    #[test]
    fn the_stages_of_dop853_are_dense_and_the_gap_of_dopri5_is_divided() {
        let is_close = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs() < 1e-15 && (b - d).abs() < 1e-15;
        assert!(is_close(widest::<DormandPrince853>(0.0), [1.0 / 3.0, 4.0 / 15.0]));
        assert!(is_close(widest::<DormandPrince853>(middle::<DormandPrince853>()), [6.0 / 7.0, 1.0 / 7.0]));
        assert!(is_close(widest::<DormandPrince54>(0.0), [0.3, 0.5]));
        assert!(widest::<DormandPrince54>(middle::<DormandPrince54>())[1] < 0.251);
        assert!(another::<DormandPrince853>() == 0.0 && another::<DormandPrince54>() == 0.55);
    }

    /// The dense output of t⁴ and t⁵ is known where the multipliers are evaluated once more.
    #[test]
    fn the_middle_is_on_the_dense_output() {
        fn check<P: Pair>(power: i32) {
            let (row, at) = (row_at::<P>(middle::<P>()), middle::<P>());
            let slope = |node: f64| f64::from(power) * node.powi(power - 1);
            let sum: f64 = P::NODES.iter().zip(row).map(|(&node, (_, weight))| weight * slope(node)).sum();
            assert!((sum - at.powi(power)).abs() < 1e-14, "{sum} for {}", at.powi(power));
        }
        (1..=7).for_each(check::<DormandPrince853>);
        (1..=4).for_each(check::<DormandPrince54>);
    }

    /// The polynomials that are ±1 at the four stages reach the Lebesgue constant.
    #[test]
    fn the_lebesgue_constant_is_that_of_the_stages() {
        fn check<P: Pair>(expected: [f64; 4]) {
            let nodes = nearest::<P>();
            let most = grid().map(|x| lebesgue_function(&nodes, x)).fold(0.0, f64::max);
            let found = lebesgue::<P>();
            assert!(nodes == expected, "{nodes:?}");
            assert!(most <= found && found < 1.05 * most && most > 1.5, "{most} {found}");
        }
        check::<DormandPrince853>([0.0, 0.25, 0.777_777_777_777_777_8, 1.0]);
        check::<DormandPrince54>([0.0, 0.2, 0.8, 1.0]);
    }

    /// Whatever is off a cubic polynomial by up to the half range of its values at the stages is within the bounds.
    fn check_near_cubic_polynomials<P: Pair>() {
        let mut random = Random(11);
        for k in 0..lagrange_random::cases([20_000, 40_000, 1_000_000]) {
            let c: [f64; 4] = core::array::from_fn(|_| random.number());
            let [rate, phase] = [40.0 * random.number(), 7.0 * random.number()];
            let cubic = |x: f64| c[0] + x * (c[1] + x * (c[2] + x * c[3]));
            let share = 10.0_f64.powf(-2.0 * random.number().abs());
            let f = |x: f64| cubic(x) + share * (rate * x + phase).sin();
            let values = || places::<P>().map(f);
            let (low, high) =
                (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            if share > (high - low) / 2.0 {
                continue;
            }
            let [lowest, highest] = of::<P>(f);
            for x in grid() {
                assert!(lowest <= f(x) && f(x) <= highest, "{k}: {} at {x} of {lowest} to {highest}", f(x));
            }
        }
    }

    #[test]
    fn functions_near_cubic_polynomials_are_within_their_bounds() {
        check_near_cubic_polynomials::<DormandPrince853>();
        check_near_cubic_polynomials::<DormandPrince54>();
    }

    /// Dips through zero that are as wide as those that the search for events finds all.
    #[test]
    fn dips_are_not_excluded() {
        fn check<P: Pair>() {
            for (middle, width) in grid().flat_map(|x| [0.15, 0.2, 0.4, 1.0].map(|width| (x, width))) {
                for depth in [1.0, 1.2, 3.0] {
                    let [lowest, _] = of::<P>(|x| 1.0 - depth * (-((x - middle) / width).powi(2)).exp());
                    assert!(lowest <= 0.0, "a dip of {depth} at {middle}, {width} wide, has {lowest}");
                }
            }
        }
        check::<DormandPrince853>();
        check::<DormandPrince54>();
    }
}
