use nalgebra::{Complex, DMatrix};

use super::spectrum::shifted_eigenvalues;
use crate::linearized::Direction;
use crate::number::vector;

/// A top that sleeps too slowly: z̈ − i b ż − k z = 0 with b² < 4 k, and its spin.
fn slow_top(b: f64, k: f64) -> DMatrix<f64> {
    let mut a = DMatrix::zeros(6, 6);
    (0..3).for_each(|i| a[(i, i + 3)] = 1.0);
    (a[(3, 0)], a[(4, 1)], a[(3, 4)], a[(4, 3)]) = (k, k, -b, b);
    a
}

/// s = ½ (± i b ± √(4k − b²)): four of one magnitude, which a shift on the real axis tells apart.
#[test]
fn eigenvalues_that_lie_symmetrically_about_both_axes_are_found() {
    let (b, k) = (6.2_f64, 9.81);
    let a = slow_top(b, k);
    assert!(shifted_eigenvalues(&a, 0.0).is_none(), "the plain iteration has learned it: drop the shifts");
    let found = shifted_eigenvalues(&a, a.amax() / 8.0).expect("convergence");
    let growth = (k - b * b / 4.0).sqrt();
    for s in [growth, -growth].map(|re| Complex::new(re, b / 2.0)) {
        let distance =
            |other: Complex<f64>| found.iter().map(|s| (s - other).norm()).fold(f64::MAX, f64::min);
        assert!(distance(s) < 1e-12 && distance(s.conj()) < 1e-12, "{s} is not among {found:?}");
    }
}

#[test]
fn a_direction_of_one_argument_changes_that_alone() {
    let zero = Direction::<f64, 2>::zero();
    assert_eq!((zero.t, zero.q, zero.v), (0.0, vector([0.0; 2]), vector([0.0; 2])));
    assert_eq!(Direction::of_time(), Direction { t: 1.0, ..zero });
    assert_eq!(Direction::of_coordinate(1), Direction { q: vector([0.0, 1.0]), ..zero });
    assert_eq!(Direction::of_velocity(0), Direction { v: vector([1.0, 0.0]), ..zero });
    assert_eq!(Direction::of_velocity(2), zero);
}
