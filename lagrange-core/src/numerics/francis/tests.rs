//! Tests eigenvalues by their backward error: elimination solves (A − s) x = b for a random b, and ‖b‖/‖x‖ bounds the
//! distance from A to a matrix that has the eigenvalue s.

use nalgebra::{Complex, DMatrix, DVector};

use super::eigenvalues;
use crate::fixtures::RandomMatrix;
use lagrange_random::{Random, cases};

/// Hamiltonian matrix [[A, B], [C, −Aᵀ]] with symmetric B and C.
fn hamiltonian(random: &mut Random, n: usize) -> DMatrix<f64> {
    let (a, b, c) = (random.matrix(n, n), random.symmetric(n), random.symmetric(n));
    blocks([[a.clone(), b], [c, -a.transpose()]])
}

/// Matrix of q̈ = G q̇ + K q with antisymmetric G and symmetric K of few values, many of them multiple.
fn gyroscopic(random: &mut Random, n: usize) -> DMatrix<f64> {
    let (g, mut k) = (random.matrix(n, n), random.symmetric(n));
    if random.below(2) == 0 {
        k = DMatrix::from_diagonal(&DVector::from_fn(n, |_, _| random.below(3) as f64 - 1.0));
    }
    blocks([[DMatrix::zeros(n, n), DMatrix::identity(n, n)], [k, &g - g.transpose()]])
}

/// Particle in a rotating saddle, m = 1, L = ½((ẋ − w y)² + (ẏ + w x)²) + ½ a (x² − y²) − ½ k (x² + y²): quadruples ±α
/// ± iβ.
fn rotating_saddle(random: &mut Random) -> DMatrix<f64> {
    let tenth = |n: usize| n as f64 / 10.0;
    let (w, a, k) = (tenth(1 + random.below(10)), tenth(random.below(10)), random.number() / 2.0);
    saddle(w, a, k)
}

fn saddle(w: f64, a: f64, k: f64) -> DMatrix<f64> {
    let mut m = DMatrix::zeros(4, 4);
    (m[(0, 2)], m[(1, 3)], m[(2, 3)], m[(3, 2)]) = (1.0, 1.0, 2.0 * w, -2.0 * w);
    (m[(2, 0)], m[(3, 1)]) = (w * w + a - k, w * w - a - k);
    m
}

/// Jordan blocks of small integers, transformed by integer shears that keep them exact.
fn defective(random: &mut Random, n: usize) -> DMatrix<f64> {
    let mut a = DMatrix::zeros(n, n);
    for i in 0..n {
        a[(i, i)] =
            if i > 0 && random.below(3) > 0 { a[(i - 1, i - 1)] } else { random.below(5) as f64 - 2.0 };
        if i > 0 && a[(i, i)] == a[(i - 1, i - 1)] {
            a[(i - 1, i)] = 1.0;
        }
    }
    for _ in 0..n {
        let (i, j) = (random.below(n), random.below(n));
        if i != j {
            let row = a.row(j).into_owned();
            a.row_mut(i).iter_mut().zip(row.iter()).for_each(|(x, y)| *x += y);
            let column = a.column(i).into_owned();
            a.column_mut(j).iter_mut().zip(column.iter()).for_each(|(x, y)| *x -= y);
        }
    }
    a
}

fn blocks([[a, b], [c, d]]: [[DMatrix<f64>; 2]; 2]) -> DMatrix<f64> {
    let n = a.nrows();
    let mut whole = DMatrix::zeros(2 * n, 2 * n);
    for (at, block) in [((0, 0), a), ((0, n), b), ((n, 0), c), ((n, n), d)] {
        whole.view_mut(at, (n, n)).copy_from(&block);
    }
    whole
}

/// ‖b‖/‖x‖ relative to ‖A‖, the least of three random b.
fn backward_error(a: &DMatrix<f64>, s: Complex<f64>, random: &mut Random) -> f64 {
    let n = a.nrows();
    let moved = DMatrix::from_fn(n, n, |i, j| {
        Complex::new(a[(i, j)], 0.0) - if i == j { s } else { Complex::new(0.0, 0.0) }
    });
    let lu = moved.lu();
    let tries = (0..3).map(|_| {
        let b = DVector::from_fn(n, |_, _| Complex::new(random.number(), random.number()));
        // Elimination fails at a zero pivot: the eigenvalue is exact to the last bit.
        lu.solve(&b).map_or(0.0, |x| if x.norm().is_finite() { b.norm() / x.norm() } else { 0.0 })
    });
    tries.fold(f64::INFINITY, f64::min) / a.norm().max(f64::MIN_POSITIVE)
}

#[test]
fn no_matrix_is_refused_and_every_eigenvalue_is_one_of_a_matrix_nearby() {
    let count = cases([50, 200, 100_000]);
    let (mut random, mut worst) = (Random(0x9E37_79B9_7F4A_7C15), 0.0_f64);
    for round in 0..count {
        let (half, n) = (1 + random.below(6), 1 + random.below(12));
        let matrices = [
            hamiltonian(&mut random, half),
            gyroscopic(&mut random, half),
            rotating_saddle(&mut random),
            defective(&mut random, n),
            random.matrix(n, n),
        ];
        for (kind, a) in matrices.into_iter().enumerate() {
            let found =
                eigenvalues(a.clone()).unwrap_or_else(|| panic!("round {round}: kind {kind} refused: {a}"));
            assert_eq!(found.len(), a.nrows());
            let trace = found.iter().fold(0.0, |sum, s| sum + s.re);
            assert!(
                (trace - a.trace()).abs() <= 1e-12 * a.norm() * a.nrows() as f64,
                "{trace} is not that of {a}"
            );
            for s in found {
                let error = backward_error(&a, s, &mut random);
                worst = worst.max(error);
                assert!(error <= 1e-12, "round {round}: {s} of kind {kind} is {error:e} off: {a}");
            }
        }
    }
    println!("{count} matrices of each kind: backward errors up to {worst:e} of the norm");
}

/// One of many matrices on which nalgebra's iteration does not converge, shifted or not.
#[test]
fn a_rotating_saddle_has_its_quadruple() {
    let (w, a, k): (f64, f64, f64) = (0.3, 0.3, -0.44);
    // The characteristic polynomial is s⁴ + b s² + c.
    let (b, c) = (2.0 * (k + w * w), (w * w - k).powi(2) - a * a);
    let square = (Complex::new(b * b / 4.0 - c, 0.0).sqrt() - b / 2.0).sqrt();
    let found = eigenvalues(saddle(w, a, k)).expect("convergence");
    for expected in [square, -square, square.conj(), -square.conj()] {
        assert!(found.iter().any(|s| (s - expected).norm() < 1e-14), "{expected} is not among {found:?}");
    }
}

/// The ordinary shifts of this orthogonal matrix are zero, and leave it unchanged: exceptional shifts are needed.
#[test]
fn a_cyclic_permutation_has_the_roots_of_unity() {
    for n in 3..=12 {
        let found =
            eigenvalues(DMatrix::from_fn(n, n, |i, j| f64::from(i == (j + 1) % n))).expect("convergence");
        for k in 0..n {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
            let root = Complex::new(cos, sin);
            assert!(found.iter().any(|s| (s - root).norm() < 1e-13), "{n}: {root} is not among {found:?}");
        }
    }
}

/// A matrix with Jordan blocks of sizes 5 and 3. The iteration does not converge if it keeps the sum and product of the
/// shifts instead of the shifts.
#[test]
fn a_triple_eigenvalue_beside_a_quintuple_one_is_found() {
    #[rustfmt::skip]
    let entries = [
        -1, 1, 0, 0, 0, 0, 0, 2, 0,
        0, -1, 1, 0, 0, 0, 0, 0, 0,
        0, 0, -1, 1, 0, 0, 0, 0, 0,
        0, 0, 0, -1, 1, 0, 0, 0, 0,
        0, 0, 0, 0, -1, 0, 0, 0, 0,
        0, -1, 1, 1, 0, -2, 1, 0, 0,
        0, 1, 1, 0, 0, 0, -2, 0, 0,
        0, 0, 0, 0, 0, 0, 0, 1, 0,
        0, 1, 1, 1, 1, 0, 0, 0, -2,
    ];
    let found = eigenvalues(DMatrix::from_row_iterator(9, 9, entries.map(f64::from))).expect("convergence");
    for (expected, count, off) in [(-1.0, 5, 1e-2), (-2.0, 3, 1e-4), (1.0, 1, 1e-14)] {
        let near = found.iter().filter(|s| (*s - expected).norm() < off).count();
        assert_eq!(near, count, "{expected} among {found:?}");
    }
}
