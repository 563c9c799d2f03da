//! Tests decompositions by A = (A V) Vᵀ and orthogonality of V and of the columns of A V, and by known singular values.

use nalgebra::DMatrix;

use super::Singular;
use crate::fixtures::RandomMatrix;
use lagrange_random::{Random, cases};

fn orthogonal(random: &mut Random, n: usize) -> DMatrix<f64> {
    random.matrix(n, n).qr().q()
}

/// Random matrices: dense; of low rank; with rows and columns of widely different sizes; of small integers; sparse;
/// bidiagonal with tiny entries; with entries of widely different sizes; with columns that nearly or exactly repeat
/// others.
fn kinds(random: &mut Random) -> [DMatrix<f64>; 8] {
    let (rows, columns) = (1 + random.below(12), 1 + random.below(12));
    let rank = 1 + random.below(rows.min(columns));
    let dense = random.matrix(rows, columns);
    let low = random.matrix(rows, rank) * random.matrix(rank, columns);
    let size = |x: f64| 10.0_f64.powf(8.0 * x);
    let (tall, wide) = (random.matrix(rows, 1).map(size), random.matrix(1, columns).map(size));
    let graded = dense.component_mul(&(tall * wide));
    let integers = random.matrix(rows, columns).map(|x| (1.5 * x).round());
    let sparse = dense.map(|x| if x.abs() < 0.3 { x } else { 0.0 });
    let tiny = 10.0_f64.powf(8.0 * (random.number() - 1.0));
    let mut bidiagonal = DMatrix::zeros(columns, columns);
    for i in 0..columns {
        bidiagonal[(i, i)] = if random.below(2) == 0 { tiny } else { 0.0 };
        if i > 0 {
            bidiagonal[(i - 1, i)] = random.number();
        }
    }
    let mut repeated = dense.clone();
    for j in 0..columns {
        if random.below(3) == 0 {
            let of = repeated.column(random.below(columns)) * (1.0 + 1e-15 * random.number());
            repeated.set_column(j, &of);
        }
    }
    let unlike = dense.map(|x| x.powi(31));
    [dense, low, graded, integers, sparse, bidiagonal, unlike, repeated]
}
/// The matrices A V and V.
fn parts(found: &Singular<f64>) -> [DMatrix<f64>; 2] {
    let (rows, count) = (found.rows, found.columns.ncols());
    [found.columns.rows(0, rows).into_owned(), found.columns.rows(rows, count).into_owned()]
}

#[test]
fn every_matrix_is_the_product_of_its_decomposition() {
    let count = cases([30, 100, 100_000]);
    let (mut random, mut worst) = (Random(0x9E37_79B9_7F4A_7C15), [0.0_f64; 3]);
    for round in 0..count {
        for (kind, a) in kinds(&mut random).into_iter().enumerate() {
            let found = Singular::of(&a).unwrap_or_else(|| panic!("round {round}: kind {kind} refused: {a}"));
            let ([images, v], size) = (parts(&found), a.norm().max(f64::MIN_POSITIVE));
            let product = (&images * v.transpose() - &a).norm() / size;
            let directions = (v.transpose() * &v - DMatrix::identity(a.ncols(), a.ncols())).amax();
            let mut angles = images.transpose() * &images;
            angles.fill_diagonal(0.0);
            // u_p·u_q σ_q relative to the largest singular value.
            let longest = found.norm().max(f64::MIN_POSITIVE);
            let mixed = (0..a.ncols()).filter(|&p| found.values[p] > f64::EPSILON * longest);
            let angle = mixed.map(|p| angles.row(p).amax() / found.values[p]).fold(0.0, f64::max) / longest;
            for (worst, now) in worst.iter_mut().zip([product, directions, angle]) {
                *worst = worst.max(now);
                assert!(now <= 1e-14, "round {round}: kind {kind} is {now:e} off: {a}");
            }
        }
    }
    println!("{count} matrices of each kind: product, directions and angles are off by up to {worst:?}");
}

#[test]
fn singular_values_are_those_that_a_matrix_is_made_with() {
    let mut random = Random(7);
    for _ in 0..100 {
        let n = 1 + random.below(10);
        let mut values: Vec<f64> = (0..n).map(|_| [1.0, 1.0, 1e-8, 1e-16, 0.0][random.below(5)]).collect();
        let a = orthogonal(&mut random, n)
            * DMatrix::from_diagonal(&values.clone().into())
            * orthogonal(&mut random, n);
        let found = Singular::of(&a).expect("a decomposition");
        let largest = values.iter().copied().fold(0.0, f64::max);
        assert!((found.norm() - largest).abs() < 1e-14, "{} for {largest}", found.norm());
        let mut found = found.values;
        values.sort_by(f64::total_cmp);
        found.sort_by(f64::total_cmp);
        for (found, expected) in found.iter().zip(&values) {
            assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
        }
    }
}

#[test]
fn what_is_empty_has_a_decomposition_and_what_is_no_number_none() {
    assert_eq!(Singular::of(&DMatrix::<f64>::zeros(3, 0)).map(|found| found.values), Some(Vec::new()));
    assert_eq!(Singular::of(&DMatrix::<f64>::zeros(0, 2)).map(|found| found.values), Some(vec![0.0; 2]));
    for x in [f64::NAN, f64::INFINITY] {
        assert!(Singular::of(&DMatrix::from_row_slice(2, 2, &[0.0, x, 0.0, 0.0])).is_none());
    }
}
