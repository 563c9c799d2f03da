//! Eigenvalues of products whose factors are made from known ones.

use nalgebra::{Complex, DMatrix};

use super::{of_product, paired};
use crate::fixtures::RandomMatrix;
use lagrange_random::Random;

/// Factors S_k D S_{k−1}⁻¹ with S_m = S_0: the product has the eigenvalues of D^m.
fn factors(random: &mut Random, values: &[f64], count: usize) -> Vec<DMatrix<f64>> {
    let n = values.len();
    let root = |x: &f64| x.signum() * x.abs().powf(1.0 / count as f64);
    let middle = DMatrix::from_fn(n, n, |i, j| if i == j { root(&values[i]).abs() } else { 0.0 });
    let frames: Vec<_> = (0..count).map(|_| DMatrix::identity(n, n) + random.matrix(n, n) * 0.3).collect();
    let mut found: Vec<_> = (0..count)
        .map(|k| &frames[(k + 1) % count] * &middle * frames[k].clone().try_inverse().unwrap())
        .collect();
    // Signs in the first factor.
    let signs = DMatrix::from_fn(n, n, |i, j| if i == j { values[i].signum() } else { 0.0 });
    found[0] = &frames[1 % count] * &middle * signs * frames[0].clone().try_inverse().unwrap();
    found
}

/// Beside 10⁸ a multiplier of 1 keeps its digits; in the product itself it would have eight.
#[test]
fn multipliers_of_all_sizes_keep_their_digits() {
    let mut random = Random(11);
    for count in [3, 30] {
        for values in
            [vec![1e8, 3.0, 1.0, 1e-8], vec![-1e10, 1.0, -0.7], vec![1e6, 1.5, -1.2, 0.8, 1e-4, 1e-6]]
        {
            let factors = factors(&mut random, &values, count);
            let found = of_product(&factors).unwrap();
            for (found, known) in found.iter().zip(&values) {
                assert!(
                    (found.re / known - 1.0).abs() < 1e-11 && found.im == 0.0,
                    "{count}: {found} for {known}"
                );
            }
        }
    }
}

/// A pair on the circle, a real pair and a quadruple, each off by 10⁻⁹.
#[test]
fn pairs_are_made_exact() {
    let polar = |r: f64, a: f64| Complex::new(r * a.cos(), r * a.sin());
    let off = 1.0 + 1e-9;
    let all = [polar(2.0, 1.0), polar(2.0, -1.0), polar(1.5, 0.0), polar(1.0, 0.4), polar(1.0, -0.4)];
    let small = [polar(off / 1.5, 0.0), polar(off / 2.0, 1.0), polar(off / 2.0, -1.0)];
    let found = paired([&all[..], &small[..]].concat());
    for pair in found.chunks(2) {
        let product = pair[0] * pair[1];
        assert!((product - Complex::new(1.0, 0.0)).norm() < 1e-15, "{pair:?}");
        assert!(pair[0].norm() >= pair[1].norm() - 1e-15);
    }
    assert_eq!(found.len(), 8);
}
