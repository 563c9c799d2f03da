//! Sines and cosines of several angles at once, which a processor computes side by side.
//!
//! Each angle loses the nearest multiple of π/2 in three steps (Cody and Waite, *Software Manual for the Elementary
//! Functions*, 1980), so that some 150 bits of π/2 count, and polynomials give both functions of what is left, with its
//! rounding (their coefficients, and the constants of the steps, are those of fdlibm, Sun Microsystems, 1993): less than a
//! unit in the last place. Nothing branches, so the compiler makes vectors of it.

/// Beyond, the multiple of π/2 has too many digits for the first step to be exact.
const LARGEST: f64 = 1e5;

/// π/2 in parts: the product of each of the first three with a whole number below 2²⁰ is exact.
const PARTS: [f64; 4] = [
    f64::from_bits(0x3ff9_21fb_5440_0000),
    f64::from_bits(0x3dd0_b461_1a60_0000),
    f64::from_bits(0x3ba3_198a_2e00_0000),
    f64::from_bits(0x397b_839a_2520_49c1),
];

/// 3 · 2⁵¹: a number to which this is added is rounded to a whole one, which is in the last bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Of (sin x)/x = 1 + s₀ x² + …
const SINE: [f64; 6] = [
    f64::from_bits(0xbfc5_5555_5555_5549),
    f64::from_bits(0x3f81_1111_1110_f8a6),
    f64::from_bits(0xbf2a_01a0_19c1_61d5),
    f64::from_bits(0x3ec7_1de3_57b1_fe7d),
    f64::from_bits(0xbe5a_e5e6_8a2b_9ceb),
    f64::from_bits(0x3de5_d93a_5acf_d57c),
];

/// Of cos x = 1 − x²/2 + c₀ x⁴ + …
const COSINE: [f64; 6] = [
    f64::from_bits(0x3fa5_5555_5555_554c),
    f64::from_bits(0xbf56_c16c_16c1_5177),
    f64::from_bits(0x3efa_01a0_19cb_1590),
    f64::from_bits(0xbe92_7e4f_809c_52ad),
    f64::from_bits(0x3e21_ee9e_bdb4_b1c4),
    f64::from_bits(0xbda8_fae9_be88_38d4),
];

/// As many angles as are taken at once.
const WIDTH: usize = 4;
/// Of fewer the standard library's are as fast, where the processor foresees their branches, as along a motion.
const FEWEST: usize = 6;

type Group = [f64; WIDTH];

/// The sines and the cosines of all angles, where they are not few and none is too large.
#[inline(always)]
pub(super) fn sin_cos<const K: usize>(angles: [f64; K]) -> Option<([f64; K], [f64; K])> {
    if K < FEWEST {
        return None;
    }
    let (mut sines, mut cosines) = ([0.0; K], [0.0; K]);
    let mut is_small = true;
    for ((angles, sines), cosines) in
        angles.chunks(WIDTH).zip(sines.chunks_mut(WIDTH)).zip(cosines.chunks_mut(WIDTH))
    {
        let mut group = [0.0; WIDTH];
        group[..angles.len()].copy_from_slice(angles);
        // Comparisons with what is no number fail.
        is_small &= group.iter().all(|x| x.abs() < LARGEST);
        let (sine, cosine) = group_of(group);
        sines.copy_from_slice(&sine[..angles.len()]);
        cosines.copy_from_slice(&cosine[..angles.len()]);
    }
    is_small.then_some((sines, cosines))
}

/// A function of its own: in the midst of an emitted one the compiler makes no vectors of it.
#[inline(never)]
fn group_of(x: Group) -> (Group, Group) {
    let shifted = x.map(|x| x * core::f64::consts::FRAC_2_PI + ROUNDER);
    let quadrant = shifted.map(f64::to_bits);
    let multiple = shifted.map(|shifted| shifted - ROUNDER);
    let (mut sines, mut cosines) = ([0.0; WIDTH], [0.0; WIDTH]);
    for i in 0..WIDTH {
        let (rest, error) = reduced(x[i], multiple[i]);
        let (sine, cosine) = (sine(rest, error), cosine(rest, error));
        // In odd quadrants they change places; in the second and third the sine, in the first and second the cosine is
        // that of an angle before, with the other sign.
        let is_odd = 0_u64.wrapping_sub(quadrant[i] & 1);
        let (s, c) = (sine.to_bits(), cosine.to_bits());
        let swapped = (s ^ c) & is_odd;
        let (s, c) = (s ^ swapped, c ^ swapped);
        sines[i] = f64::from_bits(s ^ ((quadrant[i] & 2) << 62));
        cosines[i] = f64::from_bits(c ^ (((quadrant[i] + 1) & 2) << 62));
    }
    (sines, cosines)
}

/// x − n π/2 as a number and what it is rounded by.
#[inline(always)]
fn reduced(x: f64, n: f64) -> (f64, f64) {
    let first = x - n * PARTS[0];
    let (second, lost) = difference(first, n * PARTS[1]);
    let (third, more) = difference(second, n * PARTS[2]);
    let (rest, last) = difference(third, n * PARTS[3] - (lost + more));
    (rest, last)
}

/// x − y, and what the rounding took from it (Knuth, *The Art of Computer Programming*, volume 2, 4.2.2).
#[inline(always)]
fn difference(x: f64, y: f64) -> (f64, f64) {
    let difference = x - y;
    let part = x - difference;
    let rest = (x - (difference + part)) + (part - y);
    (difference, rest)
}

#[inline(always)]
fn sine(x: f64, error: f64) -> f64 {
    let z = x * x;
    let cube = z * x;
    let [first, rest @ .., last] = SINE;
    let tail = rest.iter().rev().fold(last, |sum, coefficient| sum * z + coefficient);
    x - ((z * (0.5 * error - cube * tail) - error) - cube * first)
}

#[inline(always)]
fn cosine(x: f64, error: f64) -> f64 {
    let z = x * x;
    let half = 0.5 * z;
    let [rest @ .., last] = COSINE;
    let tail = rest.iter().rev().fold(last, |sum, coefficient| sum * z + coefficient);
    let near = 1.0 - half;
    near + (((1.0 - near) - half) + (z * z * tail - x * error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Scalar;

    /// How far two numbers are apart, in units of the last place.
    fn off(ours: f64, theirs: f64) -> f64 {
        let unit = f64::from_bits(theirs.abs().max(f64::MIN_POSITIVE).to_bits() + 1) - theirs.abs();
        (ours - theirs).abs() / unit
    }

    fn check(angles: [f64; 7]) {
        let (sines, cosines) = sin_cos(angles).expect("small angles");
        for ((x, sine), cosine) in angles.into_iter().zip(sines).zip(cosines) {
            let (theirs, their_cosine) = x.sin_cos();
            // Two roundings of less than a unit each differ by one at most.
            assert!(off(sine, theirs) <= 1.0, "sin {x:e}: {sine:e}, {theirs:e}");
            assert!(off(cosine, their_cosine) <= 1.0, "cos {x:e}: {cosine:e}, {their_cosine:e}");
        }
    }

    #[test]
    fn they_are_those_of_the_standard_library_to_the_last_place() {
        let mut state = 1_u64;
        for _ in 0..200_000 {
            check(core::array::from_fn(|k| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let part = (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
                part * [1e-8, 0.5, 2.0, 10.0, 100.0, 1e4, 2e5][k]
            }));
        }
    }

    /// Where a sine is all but zero, nothing is left of it but what is lost in the angle.
    #[test]
    fn near_multiples_of_a_quarter_turn_every_digit_counts() {
        for n in 0..60_000 {
            let x = f64::from(n) * core::f64::consts::FRAC_PI_2;
            let next = f64::from_bits(x.to_bits() + 1);
            check([x, -x, next, -next, x + 1e-9, x - 1e-9, x + 0.78]);
        }
    }

    #[test]
    fn what_is_too_large_or_no_number_is_left_to_others() {
        for x in [1e5, -1e6, f64::INFINITY, f64::NAN] {
            assert_eq!(sin_cos([0.1, x, 0.2, 0.3, 0.4, 0.5]), None);
            let (sines, _) = f64::sin_cos_of([0.1, x, 0.2, 0.3, 0.4, 0.5]);
            assert_eq!(sines[1].to_bits(), x.sin().to_bits());
        }
        let (sines, cosines) = sin_cos([0.0, -0.0, 1e-300, 5e-324, 99_999.9, 1.0]).expect("small angles");
        assert_eq!(
            sines[..4].iter().map(|sine| sine.to_bits()).collect::<Vec<_>>(),
            [0.0, -0.0, 1e-300, 5e-324].map(f64::to_bits)
        );
        assert_eq!(cosines[..4], [1.0; 4]);
    }
}
