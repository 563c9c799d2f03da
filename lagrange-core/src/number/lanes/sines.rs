//! Sines and cosines of several angles together, on SIMD lanes.
//!
//! The nearest multiple of π/2 is subtracted from each angle in three steps (Cody and Waite, *Software Manual
//! for the Elementary Functions*, 1980), which use about 150 bits of π/2. Polynomials give both functions of
//! the remainder and of its rounding error, with an error below one unit in the last place. The coefficients of
//! the polynomials and the constants of the steps are those of fdlibm (Sun Microsystems, 1993). The terms are
//! added in pairs (Estrin, *Proceedings of the Western Joint Computer Conference*, 1960) to shorten the longest
//! chain of operations.

use super::quad::Quad;
use super::simd::SimdVector;
use crate::number::Scalar;

/// Largest angle. Beyond, the multiple of π/2 has too many digits for the first step to be exact.
const LARGEST: f64 = 1e5;

/// Parts of π/2. The product of each of the first three with an integer below 2²⁰ is exact.
const PARTS: [f64; 4] = [
    f64::from_bits(0x3ff9_21fb_5440_0000),
    f64::from_bits(0x3dd0_b461_1a60_0000),
    f64::from_bits(0x3ba3_198a_2e00_0000),
    f64::from_bits(0x397b_839a_2520_49c1),
];

/// 3 · 2⁵¹. Adding this constant rounds a number to an integer, which is in the last bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Coefficients of (sin x)/x = 1 + s₀ x² + …
const SINE: [f64; 6] = [
    f64::from_bits(0xbfc5_5555_5555_5549),
    f64::from_bits(0x3f81_1111_1110_f8a6),
    f64::from_bits(0xbf2a_01a0_19c1_61d5),
    f64::from_bits(0x3ec7_1de3_57b1_fe7d),
    f64::from_bits(0xbe5a_e5e6_8a2b_9ceb),
    f64::from_bits(0x3de5_d93a_5acf_d57c),
];

/// Coefficients of cos x = 1 − x²/2 + c₀ x⁴ + …
const COSINE: [f64; 6] = [
    f64::from_bits(0x3fa5_5555_5555_554c),
    f64::from_bits(0xbf56_c16c_16c1_5177),
    f64::from_bits(0x3efa_01a0_19cb_1590),
    f64::from_bits(0xbe92_7e4f_809c_52ad),
    f64::from_bits(0x3e21_ee9e_bdb4_b1c4),
    f64::from_bits(0xbda8_fae9_be88_38d4),
];

/// Returns the angles, reduced by full turns if they are too large.
#[inline(always)]
pub(in crate::number) fn small<const K: usize>(angles: [f64; K]) -> [f64; K] {
    // No magnitude exceeds the sum. The sum is scalar code, as the compiler does not vectorize it; a comparison
    // with NaN is false.
    let sum = angles.iter().fold(0.0, |sum, x| sum + x.abs());
    if sum < LARGEST { angles } else { less_turns(angles) }
}

#[cold]
#[inline(never)]
fn less_turns<const K: usize>(angles: [f64; K]) -> [f64; K] {
    angles.map(|x| if x.abs() < LARGEST { x } else { x.sin().atan2(x.cos()) })
}

/// Returns the sines and cosines of small angles.
#[inline(always)]
pub(in crate::number) fn sin_cos<const K: usize>(angles: [f64; K]) -> ([f64; K], [f64; K]) {
    let (mut sines, mut cosines) = ([0.0; K], [0.0; K]);
    for first in (0..K).step_by(4) {
        // Angle by angle: copying a slice would go through memory and delay the vector load.
        let angle = |lane: usize| if first + lane < K { angles[first + lane] } else { 0.0 };
        let (sine, cosine) = side_by_side([angle(0), angle(1), angle(2), angle(3)].into());
        let found = <[f64; 4]>::from(sine).into_iter().zip(<[f64; 4]>::from(cosine));
        let places = sines.iter_mut().zip(&mut cosines).skip(first);
        places.zip(found).for_each(|((sine, cosine), found)| (*sine, *cosine) = found);
    }
    (sines, cosines)
}

#[inline(always)]
fn all(x: f64) -> Quad {
    Scalar::constant(x)
}

/// Returns the sines and cosines of small angles.
#[inline(always)]
fn side_by_side(x: Quad) -> (Quad, Quad) {
    let n = rounded(x * all(core::f64::consts::FRAC_2_PI));
    let (rest, error) = reduced(x, n);
    let (sine, cosine) = (sine(rest, error), cosine(rest, error));
    // In odd quadrants sine and cosine change places. The sine changes sign in the third and fourth quadrant,
    // the cosine in the second and third.
    let parity = rounded(n * all(0.5)).multiply_add(all(-2.0), n);
    let is_odd = parity * parity - all(0.5);
    let turns = rounded(n * all(0.25) - all(0.375));
    let from_middle = turns.multiply_add(all(-4.0), n) - all(1.5);
    let is_in_middle = all(1.0) - from_middle.abs();
    let [s, c] = [cosine.select(is_odd, sine), sine.select(is_odd, cosine)];
    ((-s).select(from_middle, s), (-c).select(is_in_middle, c))
}

/// Rounds to integers, ties to even.
#[inline(always)]
fn rounded(x: Quad) -> Quad {
    (x + all(ROUNDER)) - all(ROUNDER)
}

/// Returns x − n π/2 as a number and its rounding error.
#[inline(always)]
fn reduced(x: Quad, n: Quad) -> (Quad, Quad) {
    let part = |k: usize| n * all(PARTS[k]);
    let (left, lost) = difference(x - part(0), part(1));
    let (left, more) = difference(left, part(2));
    difference(left, part(3) - (lost + more))
}

/// Returns x − y and its rounding error (Knuth, *The Art of Computer Programming*, volume 2, 4.2.2).
#[inline(always)]
fn difference(x: Quad, y: Quad) -> (Quad, Quad) {
    let difference = x - y;
    let part = x - difference;
    let rest = (x - (difference + part)) + (part - y);
    (difference, rest)
}

#[inline(always)]
fn sine(x: Quad, error: Quad) -> Quad {
    let z = x * x;
    let (square, cube) = (z * z, z * x);
    // No `map` here: the compiler would not inline the map of an array.
    let pair = |k: usize| z.multiply_add(all(SINE[k + 1]), all(SINE[k]));
    let tail = square.multiply_add(square.multiply_add(all(SINE[5]), pair(3)), pair(1));
    let correction = z * cube.subtract_product(tail, all(0.5) * error) - error;
    x - cube.subtract_product(all(SINE[0]), correction)
}

#[inline(always)]
fn cosine(x: Quad, error: Quad) -> Quad {
    let z = x * x;
    let (square, half) = (z * z, all(0.5) * z);
    let pair = |k: usize| z.multiply_add(all(COSINE[k + 1]), all(COSINE[k]));
    let tail = square.multiply_add(square.multiply_add(pair(4), pair(2)), pair(0));
    let near = all(1.0) - half;
    near + (((all(1.0) - near) - half) + (square * tail - x * error))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance of two numbers, in units of the last place.
    fn off(ours: f64, theirs: f64) -> f64 {
        let unit = f64::from_bits(theirs.abs().max(f64::MIN_POSITIVE).to_bits() + 1) - theirs.abs();
        (ours - theirs).abs() / unit
    }

    fn check(angles: [f64; 7]) {
        let (sines, cosines) = sin_cos(angles);
        for ((x, sine), cosine) in angles.into_iter().zip(sines).zip(cosines) {
            let (theirs, their_cosine) = x.sin_cos();
            // Both values have an error below one unit, so they differ by at most one.
            assert!(off(sine, theirs) <= 1.0, "sin {x:e}: {sine:e}, {theirs:e}");
            assert!(off(cosine, their_cosine) <= 1.0, "cos {x:e}: {cosine:e}, {their_cosine:e}");
        }
    }

    #[test]
    fn they_are_those_of_the_standard_library_to_the_last_place() {
        let mut state = 1_u64;
        for _ in 0..lagrange_random::cases([50_000, 200_000, 5_000_000]) {
            check(core::array::from_fn(|k| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let part = (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
                part * [1e-8, 0.5, 2.0, 10.0, 100.0, 1e4, 2e5][k]
            }));
        }
    }

    /// Near a zero of the sine, every digit of the reduced angle counts.
    #[test]
    fn near_multiples_of_a_quarter_turn_every_digit_counts() {
        for n in 0..60_000 {
            let x = f64::from(n) * core::f64::consts::FRAC_PI_2;
            let next = f64::from_bits(x.to_bits() + 1);
            check([x, -x, next, -next, x + 1e-9, x - 1e-9, x + 0.78]);
        }
    }

    #[test]
    fn large_angles_lose_full_turns_and_what_is_no_number_stays_so() {
        for x in [1e5, -1e6, 123_456_789.123, -9e15, 1e300] {
            let small = small([0.1, x, 0.2]);
            assert!(small[1].abs() < 4.0 && [small[0], small[2]] == [0.1, 0.2], "{small:?}");
            let (sines, cosines) = sin_cos(small);
            let off = [sines[1] - x.sin(), cosines[1] - x.cos()].map(f64::abs);
            assert!(off.into_iter().all(|off| off < 5e-16), "{x:e}: {off:?}");
        }
        for x in [f64::INFINITY, f64::NAN] {
            let (sines, cosines) = sin_cos(small([x, 0.5]));
            assert!(sines[0].is_nan() && cosines[0].is_nan() && off(sines[1], 0.5_f64.sin()) <= 1.0);
        }
    }

    #[test]
    fn small_numbers_and_signs_of_zero_are_kept() {
        let (sines, cosines) = sin_cos([0.0, -0.0, 1e-300, 5e-324]);
        assert_eq!(sines.map(f64::to_bits), [0.0, -0.0, 1e-300, 5e-324].map(f64::to_bits));
        assert_eq!(cosines, [1.0; 4]);
    }
}
