//! Coefficients of partitioned Runge–Kutta methods: Gauss, and Lobatto IIIA–IIIB.
//!
//! The nodes are the zeros of the polynomials of Legendre and of Lobatto; the other coefficients follow from them
//! (Hairer, Lubich and Wanner, *Geometric Numerical Integration*, II.1.3 and II.1.4, IV.2.2). They were computed with
//! 50 digits, and tests check the order conditions.

/// Coefficients of a method with `S` stages, in units of the step.
#[derive(Debug)]
pub struct Tableau<const S: usize> {
    /// Times of the stages.
    pub(super) nodes: [f64; S],
    /// Weights of the stages' velocities in their coordinates.
    pub(super) a: [[f64; S]; S],
    /// Weights of the stages' forces in their momenta.
    pub(super) hat: [[f64; S]; S],
    /// Weights of the stages in the step.
    pub(super) weights: [f64; S],
    /// Inverse of the product `a`·`hat` without its first row and last column, for the multipliers.
    pub(super) inverse: [[f64; S]; S],
}

/// A tableau of a method without multipliers, whose momenta have the weights of the coordinates.
const fn gauss<const S: usize>(nodes: [f64; S], a: [[f64; S]; S], weights: [f64; S]) -> Tableau<S> {
    Tableau { nodes, a, hat: a, weights, inverse: [[0.0; S]; S] }
}

pub(super) const GAUSS_1: Tableau<1> = gauss([0.5], [[0.5]], [1.0]);
pub(super) const GAUSS_2: Tableau<2> = gauss(
    [0.211_324_865_405_187_1, 0.788_675_134_594_812_9],
    [[0.25, -0.038_675_134_594_812_88], [0.538_675_134_594_812_9, 0.25]],
    [0.5; 2],
);
pub(super) const GAUSS_3: Tableau<3> = gauss(
    [0.112_701_665_379_258_31, 0.5, 0.887_298_334_620_741_7],
    [
        [0.138_888_888_888_888_9, -0.035_976_667_524_938_9, 0.009_789_444_015_308_325],
        [0.300_263_194_980_864_6, 0.222_222_222_222_222_2, -0.022_485_417_203_086_815],
        [0.267_988_333_762_469_44, 0.480_421_111_969_383_36, 0.138_888_888_888_888_9],
    ],
    [0.277_777_777_777_777_8, 0.444_444_444_444_444_4, 0.277_777_777_777_777_8],
);
pub(super) const GAUSS_4: Tableau<4> = gauss(
    [0.069_431_844_202_973_71, 0.330_009_478_207_571_87, 0.669_990_521_792_428_1, 0.930_568_155_797_026_3],
    [
        [
            0.086_963_711_284_363_46,
            -0.026_604_180_084_998_794,
            0.012_627_462_689_404_725,
            -0.003_555_149_685_795_683,
        ],
        [
            0.188_118_117_499_868_06,
            0.163_036_288_715_636_55,
            -0.027_880_428_602_470_895,
            0.006_735_500_594_538_155,
        ],
        [
            0.167_191_921_974_188_78,
            0.353_953_006_033_743_97,
            0.163_036_288_715_636_55,
            -0.014_190_694_931_141_144,
        ],
        [
            0.177_482_572_254_522_6,
            0.313_445_114_741_868_37,
            0.352_676_757_516_271_87,
            0.086_963_711_284_363_46,
        ],
    ],
    [0.173_927_422_568_726_92, 0.326_072_577_431_273_05, 0.326_072_577_431_273_05, 0.173_927_422_568_726_92],
);

const SIXTH: f64 = 1.0 / 6.0;
const TWELFTH: f64 = 1.0 / 12.0;

pub(super) const LOBATTO_2: Tableau<2> = Tableau {
    nodes: [0.0, 1.0],
    a: [[0.0; 2], [0.5; 2]],
    hat: [[0.5, 0.0]; 2],
    weights: [0.5; 2],
    inverse: [[2.0, 0.0], [0.0; 2]],
};
pub(super) const LOBATTO_3: Tableau<3> = Tableau {
    nodes: [0.0, 0.5, 1.0],
    a: [[0.0; 3], [5.0 / 24.0, 1.0 / 3.0, -1.0 / 24.0], [SIXTH, 2.0 / 3.0, SIXTH]],
    hat: [[SIXTH, -SIXTH, 0.0], [SIXTH, 1.0 / 3.0, 0.0], [SIXTH, 5.0 / 6.0, 0.0]],
    weights: [SIXTH, 2.0 / 3.0, SIXTH],
    inverse: [[16.0, -2.0, 0.0], [-8.0, 4.0, 0.0], [0.0; 3]],
};
pub(super) const LOBATTO_4: Tableau<4> = Tableau {
    nodes: [0.0, 0.276_393_202_250_021, 0.723_606_797_749_979, 1.0],
    a: [
        [0.0; 4],
        [
            0.110_300_566_479_164_9,
            0.189_699_433_520_835_1,
            -0.033_907_364_229_143_89,
            0.010_300_566_479_164_913,
        ],
        [
            0.073_032_766_854_168_42,
            0.450_574_030_895_810_55,
            0.226_967_233_145_831_6,
            -0.026_967_233_145_831_58,
        ],
        [TWELFTH, 5.0 / 12.0, 5.0 / 12.0, TWELFTH],
    ],
    hat: [
        [TWELFTH, -0.134_836_165_729_157_9, 0.051_502_832_395_824_57, 0.0],
        [TWELFTH, 0.226_967_233_145_831_6, -0.033_907_364_229_143_89, 0.0],
        [TWELFTH, 0.450_574_030_895_810_55, 0.189_699_433_520_835_1, 0.0],
        [TWELFTH, 0.365_163_834_270_842_1, 0.551_502_832_395_824_5, 0.0],
    ],
    weights: [TWELFTH, 5.0 / 12.0, 5.0 / 12.0, TWELFTH],
    inverse: [
        [58.541_019_662_496_84, -8.541_019_662_496_845, 2.0, 0.0],
        [-20.0, 10.0, -1.708_203_932_499_369_2, 0.0],
        [10.0, -20.0, 11.708_203_932_499_37, 0.0],
        [0.0; 4],
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The simplifying conditions C(S) of the coordinates, B of the weights, and symplecticity
    /// wᵢ ĥᵢⱼ + wⱼ aⱼᵢ = wᵢ wⱼ.
    fn check<const S: usize>(tableau: &Tableau<S>, order: i32) {
        let Tableau { nodes, a, hat, weights, .. } = tableau;
        for k in 1..=order {
            let moment: f64 = (0..S).map(|i| weights[i] * nodes[i].powi(k - 1)).sum();
            assert!((moment - 1.0 / f64::from(k)).abs() < 1e-15, "B({k}) of {S} stages");
        }
        for i in 0..S {
            for k in 1..=S as i32 {
                let moment: f64 = (0..S).map(|j| a[i][j] * nodes[j].powi(k - 1)).sum();
                assert!((moment - nodes[i].powi(k) / f64::from(k)).abs() < 1e-15, "C({k}) of {S} stages");
            }
            for j in 0..S {
                let left = weights[i] * hat[i][j] + weights[j] * a[j][i] - weights[i] * weights[j];
                assert!(left.abs() < 1e-16, "stages {i} and {j} of {S}");
            }
        }
    }

    #[test]
    fn coefficients_satisfy_their_conditions() {
        check(&GAUSS_1, 2);
        check(&GAUSS_2, 4);
        check(&GAUSS_3, 6);
        check(&GAUSS_4, 8);
        check(&LOBATTO_2, 2);
        check(&LOBATTO_3, 4);
        check(&LOBATTO_4, 6);
    }

    fn check_inverse<const S: usize>(tableau: &Tableau<S>) {
        let product =
            |i: usize, k: usize| -> f64 { (0..S).map(|j| tableau.a[i + 1][j] * tableau.hat[j][k]).sum() };
        for i in 0..S - 1 {
            for l in 0..S - 1 {
                let entry: f64 = (0..S - 1).map(|k| product(i, k) * tableau.inverse[k][l]).sum();
                assert!((entry - f64::from(u8::from(i == l))).abs() < 1e-14, "{S} stages: {i}, {l}");
            }
        }
    }

    #[test]
    fn inverses_invert() {
        check_inverse(&LOBATTO_2);
        check_inverse(&LOBATTO_3);
        check_inverse(&LOBATTO_4);
    }
}
