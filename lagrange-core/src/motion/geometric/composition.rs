//! Symmetric compositions of a symmetric method of order 2.

/// A composition of steps γ₁h, γ₂h, …, γ₁h of a symmetric method of order 2, which is of higher order.
///
/// Some of the γ are negative, so the composition partly goes back in time. `Yoshida4`, `Yoshida6` and `SuzukiUmeno8` evaluate
/// forces up to 0.36 h, 0.16 h and 0.06 h before and after the step; the others stay within it. At equal order, a composition of more steps has an error that is smaller by
/// more than the steps cost (Hairer, Lubich and Wanner, *Geometric Numerical Integration*, V.3.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Composition {
    /// Order 4 in 3 steps, the triple jump (Yoshida, *Physics Letters A* 150, 1990).
    Yoshida4,
    /// Order 4 in 5 steps (Suzuki, *Physics Letters A* 146, 1990).
    Suzuki4,
    /// Order 6 in 7 steps (Yoshida 1990, solution A).
    Yoshida6,
    /// Order 6 in 9 steps (Kahan and Li, *Mathematics of Computation* 66, 1997).
    KahanLi6,
    /// Order 8 in 15 steps (Suzuki and Umeno, *Computer Simulation Studies in Condensed-Matter Physics VI*, 1993).
    SuzukiUmeno8,
    /// Order 8 in 17 steps (Kahan and Li 1997).
    KahanLi8,
}

impl Composition {
    /// Order of the composition.
    #[must_use]
    pub fn order(self) -> usize {
        match self {
            Self::Yoshida4 | Self::Suzuki4 => 4,
            Self::Yoshida6 | Self::KahanLi6 => 6,
            Self::SuzukiUmeno8 | Self::KahanLi8 => 8,
        }
    }

    /// The lengths γ of the steps, in units of the whole step.
    #[must_use]
    pub fn lengths(self) -> &'static [f64] {
        match self {
            Self::Yoshida4 => &YOSHIDA_4,
            Self::Suzuki4 => &SUZUKI_4,
            Self::Yoshida6 => &YOSHIDA_6,
            Self::KahanLi6 => &KAHAN_LI_6,
            Self::SuzukiUmeno8 => &SUZUKI_UMENO_8,
            Self::KahanLi8 => &KAHAN_LI_8,
        }
    }
}

/// γ₁ = 1/(2 − 2^⅓) and 1 − 2γ₁.
const YOSHIDA_4: [f64; 3] = mirrored([1.351_207_191_959_657_5, -1.702_414_383_919_315_3]);
/// γ₁ = γ₂ = 1/(4 − 4^⅓) and 1 − 4γ₁.
const SUZUKI_4: [f64; 5] =
    mirrored([0.414_490_771_794_375_77, 0.414_490_771_794_375_77, -0.657_963_087_177_502_8]);
const YOSHIDA_6: [f64; 7] = mirrored([
    0.784_513_610_477_557_3,
    0.235_573_213_359_358_13,
    -1.177_679_984_178_871,
    1.315_186_320_683_911_2,
]);
const KAHAN_LI_6: [f64; 9] = mirrored([
    0.392_161_444_007_314_1,
    0.332_599_136_789_359_43,
    -0.706_246_172_557_639_3,
    0.082_213_596_293_550_8,
    0.798_543_990_934_83,
]);
const SUZUKI_UMENO_8: [f64; 15] = mirrored([
    0.741_670_364_350_613,
    -0.409_100_825_800_031_6,
    0.190_754_710_296_238_4,
    -0.573_862_471_116_082_2,
    0.299_064_181_303_655_9,
    0.334_624_918_245_298_16,
    0.315_293_092_396_766_6,
    -0.796_887_939_352_916_4,
]);
const KAHAN_LI_8: [f64; 17] = mirrored([
    0.130_202_483_088_890_1,
    0.561_162_981_775_108_4,
    -0.389_474_962_644_847_27,
    0.158_841_906_555_155_6,
    -0.395_903_894_133_237_57,
    0.184_539_640_978_315_7,
    0.258_374_387_686_322_04,
    0.295_011_723_609_310_3,
    -0.605_508_533_830_034_4,
]);

/// Continues the first half of a symmetric sequence.
const fn mirrored<const H: usize, const K: usize>(half: [f64; H]) -> [f64; K] {
    let mut all = [0.0; K];
    let mut k = 0;
    while k < K {
        all[k] = half[if k < H { k } else { K - 1 - k }];
        k += 1;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::Composition::{self, KahanLi6, KahanLi8, Suzuki4, SuzukiUmeno8, Yoshida4, Yoshida6};

    const ALL: [Composition; 6] = [Yoshida4, Suzuki4, Yoshida6, KahanLi6, SuzukiUmeno8, KahanLi8];

    /// The order conditions of single powers: Σγ = 1, and Σγᵏ = 0 for odd k below the order.
    #[test]
    fn sums_of_powers_vanish() {
        for composition in ALL {
            let sum = |power: i32| composition.lengths().iter().map(|x| x.powi(power)).sum::<f64>();
            assert!((sum(1) - 1.0).abs() < 4e-16, "{composition:?}");
            for power in (3..composition.order() as i32).step_by(2) {
                assert!(sum(power).abs() < 4e-15, "{composition:?} {power}: {}", sum(power));
            }
            // The next power is an error term of this order.
            assert!(sum(composition.order() as i32 + 1).abs() > 5e-4, "{composition:?}");
        }
    }
    /// Forces that end in time, as a table does, are asked for that far beyond the end.
    #[test]
    fn times_lie_within_the_step_or_near_it() {
        let beyond = |composition: Composition| {
            let times = composition.lengths().iter().scan(0.0, |time, length| {
                *time += length;
                Some(*time)
            });
            times.fold(0.0_f64, |beyond, time| beyond.max(time - 1.0).max(-time))
        };
        let limits = [0.36, 1e-15, 0.16, 1e-15, 0.06, 1e-15];
        for (composition, limit) in ALL.into_iter().zip(limits) {
            assert!(beyond(composition) < limit, "{composition:?}: {}", beyond(composition));
        }
    }
}
