//! Chebyshev series Σ cₖ Tₖ of a function on an interval, to decide how far it is from zero and whether it is
//! monotonic.
//!
//! The coefficients of degree n follow from the values at the n + 1 extreme points of Tₙ (Clenshaw and Curtis). The
//! points of degree n are among those of degree 2n, so doubling the degree repeats no evaluation.

use crate::motion::limits::{COARSEST, FINEST, RESOLVED};
use crate::number::limits::SUM;
use crate::number::{Real, Scalar, larger};
use crate::vector::from_fn;

/// Values of a function at the extreme points of the polynomial of the highest degree, from the start of the interval
/// to its end. Entries that a lower degree does not use may be anything.
pub(super) type Samples<T> = [T; FINEST + 1];

/// cos(kπ/32) for k from 0 to 16.
const COSINES: [f64; FINEST / 2 + 1] = [
    1.0,
    0.995_184_726_672_196_9,
    0.980_785_280_403_230_4,
    0.956_940_335_732_208_8,
    0.923_879_532_511_286_7,
    0.881_921_264_348_355,
    0.831_469_612_302_545_2,
    0.773_010_453_362_737,
    core::f64::consts::FRAC_1_SQRT_2,
    0.634_393_284_163_645_5,
    0.555_570_233_019_602_3,
    0.471_396_736_825_997_8,
    0.382_683_432_365_089_84,
    0.290_284_677_254_462_3,
    0.195_090_322_016_128_33,
    0.098_017_140_329_560_77,
    0.0,
];

/// cos(kπ/32) for all k up to a full turn.
const TURN: [f64; 2 * FINEST] = {
    let (mut turn, mut k) = ([0.0; 2 * FINEST], 0);
    while k < 2 * FINEST {
        let angle = if k > FINEST { 2 * FINEST - k } else { k };
        turn[k] = if angle > FINEST / 2 { -COSINES[FINEST - angle] } else { COSINES[angle] };
        k += 1;
    }
    turn
};

/// Position of point `place`, as a fraction of the interval.
pub(super) fn part(place: usize) -> f64 {
    0.5 - 0.5 * TURN[place]
}

/// Points of this degree, a power of two, that half the degree does not have; for the lowest degree, all points but the
/// ends.
#[inline(always)]
pub(super) fn places(degree: usize) -> impl Iterator<Item = usize> {
    let apart = FINEST >> degree.trailing_zeros();
    let stride = if degree == COARSEST { apart } else { 2 * apart };
    (1..).map(move |k| apart + (k - 1) * stride).take_while(|place| *place < FINEST)
}

/// Bounds on a function from its Chebyshev coefficients of one degree. The unit of length is half the interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape<T> {
    degree: usize,
    /// |c₀|
    mean: T,
    /// Σ |cₖ| from k = 1 on.
    pub(super) swing: T,
    /// Largest of the last coefficients, even and odd: two for the lowest degree, else three.
    pub(super) tail: T,
    /// |d₀| of the derivative Σ dₖ Tₖ.
    slope: T,
    /// Σ |dₖ| from k = 1 on.
    bend: T,
    /// Largest magnitude of a sample.
    pub(super) most: T,
    /// Highest degree whose coefficient is a [noticeable](RESOLVED) part of `swing`.
    pub(super) order: usize,
}

impl<T: Real> Shape<T> {
    #[inline(always)]
    pub(super) fn of(samples: &Samples<T>, degree: usize) -> Self {
        // Constant degrees let the compiler unroll the loops.
        match degree {
            COARSEST => Self::of_degree::<COARSEST>(samples),
            8 => Self::of_degree::<8>(samples),
            16 => Self::of_degree::<16>(samples),
            _ => Self::of_degree::<FINEST>(samples),
        }
    }

    #[inline(always)]
    fn of_degree<const DEGREE: usize>(samples: &Samples<T>) -> Self {
        let (zero, half) = (T::constant(0.0), T::constant(0.5));
        // c[k − 1] is the coefficient of Tₖ.
        let c: [T; DEGREE] = from_fn(|k| coefficient::<T, DEGREE>(samples, k + 1));
        // Recurrence of the derivative: dₖ₋₁ = dₖ₊₁ + 2k cₖ.
        let (mut slope, mut bend, mut d) = (zero, zero, [zero; 2]);
        for k in (1..=DEGREE).rev() {
            let lower = d[1] + T::constant(2.0 * k as f64) * c[k - 1];
            d = [lower, d[0]];
            match k {
                1 => slope = Scalar::abs(lower) * half,
                _ => bend += Scalar::abs(lower),
            }
        }
        let sizes = c.map(Scalar::abs);
        let swing = sizes.iter().fold(zero, |sum, c| sum + *c);
        let last = if DEGREE > COARSEST { 3 } else { 2 };
        let tail = sizes[DEGREE - last..].iter().fold(zero, |most, c| larger(most, *c));
        let values = samples.iter().step_by(FINEST / DEGREE);
        let most = values.fold(zero, |most, value| larger(most, Scalar::abs(*value)));
        let least = swing / T::constant(RESOLVED);
        let order = sizes.iter().rposition(|size| *size > least).map_or(0, |k| k + 1);
        let mean = Scalar::abs(coefficient::<T, DEGREE>(samples, 0));
        Self { degree: DEGREE, mean, swing, tail, slope, bend, most, order }
    }

    /// Bound on the rounding errors of the values. `jitter` is the rounding error of the points, in halves of the
    /// interval.
    fn rounding(&self, jitter: T) -> T {
        T::constant(SUM * T::EPSILON) * self.most + (self.slope + self.bend) * jitter
    }

    /// True if the function stays away from zero, is monotonic, or is zero.
    ///
    /// A function differs from the interpolating polynomial by at most twice the sum of the omitted coefficients,
    /// because of aliasing. Coefficients are assumed to fall at least like k⁻² from the last one on, so the omitted
    /// ones add up to at most n times it. Those of the derivative are assumed to fall like k⁻⁴, and add up to at most
    /// n³ times it. If the last coefficients are rounding errors, they say nothing about the omitted ones.
    pub(super) fn is_plain(&self, jitter: T) -> bool {
        let (n, rounding) = (self.degree as f64, self.rounding(jitter));
        let [rest, rest_of_slope] = match self.tail > rounding {
            true => [2.0 * n, 2.0 * n * n * n].map(|factor| T::constant(factor) * self.tail),
            false => [4.0, 4.0 * n * n].map(|factor| T::constant(factor) * rounding),
        };
        // Unless the coefficients fall, the function may do anything between two points.
        let is_away = self.mean > self.swing + rest;
        let falls = self.tail <= rounding || !self.has_level_end();
        falls && (is_away || self.slope > self.bend + rest_of_slope) || self.most == T::constant(0.0)
    }

    /// True if the polynomial comes near zero and is not monotonic, and is well resolved: a higher degree would not
    /// change that.
    pub(super) fn is_bent(&self) -> bool {
        let is_known = T::constant(2.0 * self.degree as f64) * self.tail <= self.swing;
        is_known && self.mean <= self.swing && self.slope <= self.bend
    }

    /// True if the coefficients do not fall: a higher degree may help, or the samples are all noise.
    pub(super) fn is_rough(&self) -> bool {
        self.degree > COARSEST && self.has_level_end()
    }

    /// True if the coefficients do not fall: the last are at least 1/16 of the sum of all and, from degree 8
    /// on, at least half their mean. A narrow dip has such coefficients if only one sample lies on its slope.
    fn has_level_end(&self) -> bool {
        let factor = if self.degree > 8 { 2 * self.degree } else { 16 };
        T::constant(factor as f64) * self.tail >= self.swing
    }

    /// True if the function stays away from zero by more than its variation and this noise.
    pub(super) fn is_beyond(&self, noise: T) -> bool {
        self.tail <= noise && self.mean > self.swing + noise
    }
}

/// Coefficient of Tₖ of the interpolating polynomial of this degree.
#[inline(always)]
fn coefficient<T: Real, const DEGREE: usize>(samples: &Samples<T>, k: usize) -> T {
    let (half, apart) = (T::constant(0.5), FINEST / DEGREE);
    let mut sum = (samples[0] + samples[FINEST] * T::constant(TURN[k % 2 * FINEST])) * half;
    for j in 1..DEGREE {
        sum += samples[j * apart] * T::constant(TURN[j * k * apart % (2 * FINEST)]);
    }
    let part = if k == 0 || k == DEGREE { 1.0 } else { 2.0 };
    sum * T::constant(part / DEGREE as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bounds of f on −1 … 1; the first point is x = 1.
    fn shape(degree: usize, f: impl Fn(f64) -> f64) -> Shape<f64> {
        let mut samples = [f64::NAN; FINEST + 1];
        for place in (0..=FINEST).step_by(FINEST / degree) {
            samples[place] = f(1.0 - 2.0 * part(place));
        }
        Shape::of(&samples, degree)
    }

    #[test]
    fn cosines_are_cosines() {
        for (k, cosine) in TURN.into_iter().enumerate() {
            assert!((cosine - (core::f64::consts::PI * k as f64 / 32.0).cos()).abs() < 2e-15, "{k}");
        }
    }

    #[test]
    fn every_degree_adds_the_places_between_those_of_the_last() {
        let mut all: std::vec::Vec<usize> = [COARSEST, 8, 16, 32].into_iter().flat_map(places).collect();
        all.sort_unstable();
        assert_eq!(all, (1..FINEST).collect::<std::vec::Vec<_>>());
    }

    /// 3 T₀ − 2 T₁ + T₃/4, with the derivative −2 + 3/4 + 3/2 T₂.
    #[test]
    fn coefficients_are_those_of_the_polynomial() {
        for degree in [COARSEST, 8, 16, 32] {
            let found = shape(degree, |x| 3.0 - 2.0 * x + 0.25 * (4.0 * x.powi(3) - 3.0 * x));
            let sizes = [found.mean, found.swing, found.slope, found.bend];
            for (size, expected) in sizes.into_iter().zip([3.0, 2.25, 1.25, 1.5]) {
                assert!((size - expected).abs() < 1e-12, "{degree}: {found:?}");
            }
            assert!(found.order == 3 && (4.75..4.76).contains(&found.most));
            assert!(degree == 4 || found.tail < 1e-15 && found.is_plain(0.0));
        }
    }

    /// 1/(1 + a²x²) is below 1 at all points but one, and is resolved once the points are as dense as the peak is wide.
    #[test]
    fn what_is_not_resolved_is_not_plain() {
        for (a, from) in [(0.5, 4), (2.0, 16), (5.0, 32), (25.0, 64)] {
            for degree in [4, 8, 16, 32] {
                // Values between −0.2 and 0.8, with zeros.
                let found = shape(degree, |x| 1.0 / (1.0 + (a * (x - 0.3)).powi(2)) - 0.2);
                assert!(a == 0.5 || !found.is_plain(0.0), "{a}, {degree}: {found:?}");
                // Far from zero: reported only once the coefficients fall.
                let found = shape(degree, |x| 1.0 / (1.0 + (a * (x - 0.3)).powi(2)) + 1.0);
                assert!(degree < from || found.is_plain(0.0), "{a}, {degree}: {found:?}");
            }
        }
    }

    /// A dip through zero between two points, with one sample on its slope: the coefficients do not fall.
    #[test]
    fn what_is_seen_of_a_dip_is_not_plain() {
        for degree in [8, 16, 32] {
            let apart = FINEST / degree;
            for place in (0..FINEST).step_by(apart) {
                let ends = [place, place + apart].map(|place| 1.0 - 2.0 * part(place));
                let (middle, width) = (0.75 * ends[0] + 0.25 * ends[1], (ends[0] - ends[1]).abs() / 6.3);
                let found = shape(degree, |x| 1.0 - 1.1 * (-((x - middle) / width).powi(2)).exp());
                assert!(found.most < 1.01 && !found.is_plain(0.0), "{degree}, {place}: {found:?}");
            }
        }
    }

    #[test]
    fn what_may_be_noise_is_not_beyond_it() {
        let found = shape(8, |x| 3.0 + x);
        assert!(found.is_beyond(1.9) && !found.is_beyond(2.1), "{found:?}");
        let rough = shape(8, |x| 3.0 + 0.5 * (40.0 * x).sin());
        assert!(!rough.is_beyond(0.01), "{rough:?}");
    }
}
