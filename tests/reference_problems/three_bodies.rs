//! The restricted problem of three bodies in the frame that turns with the two heavy ones.

use lagrange_core::nalgebra::Complex;
use lagrange_core::prelude::*;
use lagrange_systems::ThreeBodies;

use crate::reference::{Problem, table};

/// The orbit closes after its period (Hairer, Nørsett and Wanner, II.0), though it passes near the moon. A relative change
/// of the initial position grows by 10⁶ in the velocity at the end. There `Dop853` misses the bar, with 1.3·10⁻⁹.
#[test]
fn arenstorf_orbit() {
    let system = ThreeBodies { mu: 0.012_277_471 };
    let problem = Problem { name: "Arenstorf's orbit", system, known: table!("arenstorf") };
    problem.check(&[[1e-11, 1e-9, 0.0], [1e-9, 3e-8, 0.0]]);
}

/// Five points of rest for each of two ratios of masses: three on the axis, found with 26 digits, and two triangles.
#[test]
fn lagrange_points() {
    let axis = [
        (0.012_150_585_609_624, [0.836_915_125_772_357_4, 1.155_682_165_444_884, -1.005_062_645_810_277_8]),
        (0.04, [0.740_909_842_861_323_3, 1.216_430_567_614_388, -1.016_663_104_796_437]),
    ];
    let height = 3.0_f64.sqrt() / 2.0;
    for (mu, axis) in axis {
        let triangles = [height, -height].map(|y| [0.5 - mu, y]);
        for point in axis.map(|x| [x, 0.0]).into_iter().chain(triangles) {
            let solution = ThreeBodies { mu }.solve(&State::at_rest(point)).unwrap();
            assert!(solution.accelerations.norm() < 1e-13, "{:e}", solution.accelerations.norm());
        }
    }
}

/// The exponents s at the triangles: s⁴ + s² + 27/4 μ(1 − μ) = 0.
#[test]
fn exponents_at_the_triangles() {
    let squares = [
        (
            0.012_150_585_609_624,
            [Complex::new(-0.911_071_885_522_436_8, 0.0), Complex::new(-0.088_928_114_477_563_17, 0.0)],
        ),
        (0.04, [Complex::new(-0.5, 0.095_916_630_466_254_39), Complex::new(-0.5, -0.095_916_630_466_254_39)]),
    ];
    for (mu, squares) in squares {
        let point = State::at_rest([0.5 - mu, 3.0_f64.sqrt() / 2.0]);
        let found = ThreeBodies { mu }.linearize(&point, &[]).unwrap().eigenvalues().unwrap();
        for square in squares {
            let near = found.iter().filter(|s| (**s * **s - square).norm() < 1e-13).count();
            assert_eq!(near, 2, "{square} among the squares of {found:?}");
        }
    }
}
