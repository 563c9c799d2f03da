//! The methods: stages at the zeros of Radau's polynomials, and the transformation that uncouples them.

use nalgebra::{Complex, Const};

use super::lu::Lu;

/// Number of stages of a method: 3, 5 or 7, for order 5, 9 or 13.
///
/// The tables are those of `tests/radau_tables.py`, rounded from 60 digits.
pub trait Stages {
    /// Times of the stages in units of the step: the zeros of dˢ⁻¹/dxˢ⁻¹ (xˢ⁻¹ (x − 1)ˢ).
    #[doc(hidden)]
    const NODES: &'static [f64];
    /// Real eigenvalue of the inverse of the method's matrix: a zero of the denominator of the stability function.
    #[doc(hidden)]
    const REAL: f64;
    /// Real and imaginary parts of the other eigenvalues, one of each conjugate pair.
    #[doc(hidden)]
    const COMPLEX: &'static [[f64; 2]];
}

impl Stages for Const<3> {
    const NODES: &'static [f64] = &[0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];
    const REAL: f64 = 3.637_834_252_744_496;
    const COMPLEX: &'static [[f64; 2]] = &[[2.681_082_873_627_752_3, 3.050_430_199_247_410_5]];
}

impl Stages for Const<5> {
    const NODES: &'static [f64] = &[
        0.057_104_196_114_517_68,
        0.276_843_013_638_123_8,
        0.583_590_432_368_916_8,
        0.860_240_135_656_219_5,
        1.0,
    ];
    const REAL: f64 = 6.286_704_751_729_276_5;
    const COMPLEX: &'static [[f64; 2]] =
        &[[5.700_953_298_671_79, 3.210_265_600_308_549_7], [3.655_694_325_463_572, 6.543_736_899_360_077]];
}

impl Stages for Const<7> {
    const NODES: &'static [f64] = &[
        0.029_316_427_159_784_893,
        0.148_078_599_668_484_3,
        0.336_984_690_281_154_3,
        0.558_671_518_771_550_1,
        0.769_233_862_030_054_5,
        0.926_945_671_319_741_1,
        1.0,
    ];
    const REAL: f64 = 8.936_832_788_405_216;
    const COMPLEX: &'static [[f64; 2]] = &[
        [8.511_834_825_102_946, 3.281_013_624_325_059],
        [7.141_055_219_187_64, 6.623_045_922_639_276],
        [4.378_693_561_506_806, 10.169_693_283_795_011],
    ];
}

/// Value and slope at `x` of Lagrange's polynomial that is 1 at node `j` and 0 at time 0 and at the other nodes.
pub(super) fn basis(nodes: &[f64], j: usize, x: f64) -> [f64; 2] {
    let others = nodes.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, node)| *node);
    others.chain([0.0]).fold([1.0, 0.0], |[value, slope], node| {
        let width = nodes[j] - node;
        [value * (x - node) / width, (slope * (x - node) + value) / width]
    })
}

/// What follows from the nodes and eigenvalues. Stages are differences z from the start of a step, on a polynomial.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tableau<const S: usize> {
    /// Slopes of the polynomial at the stages by z: the inverse of the method's matrix.
    pub(super) slopes: [[f64; S]; S],
    /// Slope of the polynomial at the start of the step by z.
    pub(super) start: [f64; S],
    /// Columns: the real eigenvector of `slopes`, then real and negative imaginary part of the complex ones.
    pub(super) from_eigenvectors: [[f64; S]; S],
    /// The inverse of that matrix.
    pub(super) to_eigenvectors: [[f64; S]; S],
}

impl<const S: usize> Tableau<S>
where
    Const<S>: Stages,
{
    pub(super) fn new() -> Self {
        let nodes = <Const<S>>::NODES;
        let mut from_eigenvectors = [[0.0; S]; S];
        for (i, row) in from_eigenvectors.iter_mut().enumerate() {
            row[0] = eigenvector(nodes, i, Complex::new(<Const<S>>::REAL, 0.0)).re;
            for (pair, [re, im]) in row[1..].chunks_exact_mut(2).zip(<Const<S>>::COMPLEX) {
                let entry = eigenvector(nodes, i, Complex::new(*re, *im));
                pair.copy_from_slice(&[entry.re, -entry.im]);
            }
        }
        Self {
            slopes: core::array::from_fn(|i| core::array::from_fn(|j| basis(nodes, j, nodes[i])[1])),
            start: core::array::from_fn(|j| basis(nodes, j, 0.0)[1]),
            from_eigenvectors,
            to_eigenvectors: inverse(&from_eigenvectors),
        }
    }
}

/// Entry `i` of the eigenvector of an eigenvalue λ. On it a polynomial p with p(0) = 0 has p′ = λp at the nodes, so
/// that p′ − λp is a multiple of the nodal polynomial Π: p = Σ Π⁽ᵏ⁾ λ⁻ᵏ but for a factor.
fn eigenvector(nodes: &[f64], i: usize, lambda: Complex<f64>) -> Complex<f64> {
    // Taylor coefficients of Π at the node.
    let mut taylor = [0.0; 8];
    taylor[0] = 1.0;
    for node in nodes {
        for k in (0..8).rev() {
            taylor[k] = taylor[k] * (nodes[i] - node) + if k > 0 { taylor[k - 1] } else { 0.0 };
        }
    }
    (1..=nodes.len()).rev().fold(Complex::new(0.0, 0.0), |sum, k| (sum + taylor[k]) * k as f64 / lambda)
}

fn inverse<const S: usize>(matrix: &[[f64; S]; S]) -> [[f64; S]; S] {
    let mut lu = Lu::<f64, Const<S>>::new();
    let _ = lu.factorize(|i, j| matrix[i][j]);
    let columns: [[f64; S]; S] =
        core::array::from_fn(|j| lu.solve(core::array::from_fn(|i| f64::from(u8::from(i == j))).into()).0);
    core::array::from_fn(|i| core::array::from_fn(|j| columns[j][i]))
}
