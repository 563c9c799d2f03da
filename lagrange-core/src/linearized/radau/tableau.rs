//! The methods: stages at the zeros of Radau's polynomials, and the transformation that uncouples them.

use nalgebra::{Complex, Const};

use crate::numerics::lu::Lu;

/// Number of stages of a method: 3, 5 or 7, for order 5, 9 or 13.
#[diagnostic::on_unimplemented(
    message = "`Radau` has 3, 5 or 7 stages",
    label = "no such number of stages",
    note = "`.stages::<5>()` for errors below 10⁻⁶, `.stages::<7>()` below 10⁻⁹"
)]
pub trait RadauStages {
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

impl RadauStages for Const<3> {
    const NODES: &'static [f64] = &[0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];
    const REAL: f64 = 3.637_834_252_744_496;
    const COMPLEX: &'static [[f64; 2]] = &[[2.681_082_873_627_752_3, 3.050_430_199_247_410_5]];
}

impl RadauStages for Const<5> {
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

impl RadauStages for Const<7> {
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
pub(super) struct Transformation<const S: usize> {
    /// Slopes of the polynomial at the stages by z: the inverse of the method's matrix.
    pub(super) slopes: [[f64; S]; S],
    /// Slope of the polynomial at the start of the step by z.
    pub(super) start: [f64; S],
    /// Columns: the real eigenvector of `slopes`, then real and negative imaginary part of the complex ones.
    pub(super) from_eigenvectors: [[f64; S]; S],
    /// The inverse of that matrix.
    pub(super) to_eigenvectors: [[f64; S]; S],
}

impl<const S: usize> Transformation<S>
where
    Const<S>: RadauStages,
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

pub(super) fn inverse<const S: usize>(matrix: &[[f64; S]; S]) -> [[f64; S]; S] {
    let mut lu = Lu::<f64, Const<S>>::new();
    let _ = lu.factorize(|i, j| matrix[i][j]);
    let columns: [[f64; S]; S] =
        core::array::from_fn(|j| lu.solve(core::array::from_fn(|i| f64::from(u8::from(i == j))).into()).0);
    core::array::from_fn(|i| core::array::from_fn(|j| columns[j][i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error of a sum in units of ε of its terms.
    fn off(terms: impl Iterator<Item = f64>, expected: f64) -> f64 {
        let (sum, size) = terms.fold((-expected, expected.abs()), |(sum, size), x| (sum + x, size + x.abs()));
        sum.abs() / (f64::EPSILON * size)
    }

    fn powers(x: f64, n: usize) -> f64 {
        (0..n).fold(1.0, |power, _| power * x)
    }

    /// The simplifying assumptions B(2s − 1) and C(s), which imply order 2s − 1 (Hairer and Wanner, *Solving Ordinary
    /// Differential Equations II*, theorem IV.5.1).
    fn satisfies_its_order_conditions<const S: usize>()
    where
        Const<S>: RadauStages,
    {
        let (c, transformation) = (<Const<S>>::NODES, Transformation::<S>::new());
        let a = inverse(&transformation.slopes);
        for k in 1..2 * S {
            let conditions = if k <= S { 0..S } else { S - 1..S };
            for i in conditions {
                let terms = (0..S).map(|j| a[i][j] * powers(c[j], k - 1));
                let error = off(terms, powers(c[i], k) / k as f64);
                assert!(error < 100.0, "{S} stages, stage {i}, power {k}: {error} ε");
            }
        }
    }

    /// Eigenvectors by the products of matrices; the eigenvalues' sums of powers are the traces of powers of the matrix.
    fn has_its_eigenvectors<const S: usize>()
    where
        Const<S>: RadauStages,
    {
        let Transformation { slopes, from_eigenvectors: t, to_eigenvectors, .. } = Transformation::<S>::new();
        for i in 0..S {
            for k in 0..S {
                let left = (0..S).map(|j| slopes[i][j] * t[j][k]);
                // Columns x and y = −z of an eigenvector x + iz: Ax = αx + βy, Ay = αy − βx.
                let right = match k.checked_sub(1) {
                    None => <Const<S>>::REAL * t[i][0],
                    Some(k) => {
                        let ([re, im], first) = (<Const<S>>::COMPLEX[k / 2], 1 + k / 2 * 2);
                        let (x, y) = (t[i][first], t[i][first + 1]);
                        if k.is_multiple_of(2) { re * x + im * y } else { re * y - im * x }
                    }
                };
                let error = off(left, right);
                assert!(error < 1e3, "{S} stages, row {i}, column {k}: {error} ε");
                let error = off((0..S).map(|j| to_eigenvectors[i][j] * t[j][k]), f64::from(u8::from(i == k)));
                assert!(error < 1e3, "{S} stages, inverse, {i}, {k}: {error} ε");
            }
        }
    }

    #[test]
    fn tables_satisfy_the_conditions_of_their_orders() {
        satisfies_its_order_conditions::<3>();
        satisfies_its_order_conditions::<5>();
        satisfies_its_order_conditions::<7>();
    }

    #[test]
    fn eigenvectors_uncouple_the_stages() {
        has_its_eigenvectors::<3>();
        has_its_eigenvectors::<5>();
        has_its_eigenvectors::<7>();
    }

    /// A sum a + b of two numbers, for twice the digits.
    type Double = (f64, f64);

    fn add(x: Double, y: Double) -> Double {
        let sum = x.0 + y.0;
        let part = sum - x.0;
        let error = (x.0 - (sum - part)) + (y.0 - part) + x.1 + y.1;
        (sum + error, error - ((sum + error) - sum))
    }

    fn multiply(x: Double, y: Double) -> Double {
        let product = x.0 * y.0;
        let error = x.0.mul_add(y.0, -product) + x.0 * y.1 + x.1 * y.0;
        (product + error, error - ((product + error) - product))
    }

    fn negated(x: Double) -> Double {
        (-x.0, -x.1)
    }

    /// Newton's correction of a zero of Σ aₖ xᵏ by twice the digits, real and imaginary part. The coefficients are integers.
    fn correction(a: &[f64], [re, im]: [f64; 2]) -> [f64; 2] {
        let times = |x: [Double; 2]| {
            let [p, q] = [(re, 0.0), (im, 0.0)];
            let minus = negated(multiply(x[1], q));
            [add(multiply(x[0], p), minus), add(multiply(x[0], q), multiply(x[1], p))]
        };
        let none = [(0.0, 0.0); 2];
        let (mut value, mut slope) = (none, none);
        for a in a.iter().rev() {
            slope = times(slope);
            slope = [add(slope[0], value[0]), add(slope[1], value[1])];
            value = times(value);
            value[0] = add(value[0], (*a, 0.0));
        }
        let quotient = Complex::new(value[0].0, value[1].0) / Complex::new(slope[0].0, slope[1].0);
        [quotient.re, quotient.im]
    }

    fn ulp(x: f64) -> f64 {
        x.abs().next_up() - x.abs()
    }

    /// Every number of the tables is the nearest to a zero, by its polynomial with integer coefficients.
    fn is_rounded<const S: usize>()
    where
        Const<S>: RadauStages,
    {
        let factorial = |n: usize| (1..=n).fold(1.0, |product, k| product * k as f64);
        let binomial = |k: usize| factorial(S) / factorial(k) / factorial(S - k);
        let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        // The derivative of xˢ⁻¹ (x − 1)ˢ, s − 1 times, over (s − 1)!; the denominator of the (s − 1, s) approximation of
        // eˣ by Padé, times (2s − 1)!/(s − 1)!.
        let nodal: [f64; 8] = core::array::from_fn(|k| match k <= S {
            true => sign(S - k) * binomial(k) * (factorial(S - 1 + k) / factorial(k) / factorial(S - 1)),
            false => 0.0,
        });
        let padé: [f64; 8] = core::array::from_fn(|k| match k <= S {
            true => sign(k) * binomial(k) * (factorial(2 * S - 1 - k) / factorial(S - 1)),
            false => 0.0,
        });
        assert!(nodal.iter().chain(&padé).all(|x| x.fract() == 0.0 && x.abs() < 9e15));
        let nodes = <Const<S>>::NODES.iter().map(|x| (&nodal, [*x, 0.0]));
        let complex = <Const<S>>::COMPLEX.iter().map(|x| (&padé, *x));
        for (polynomial, zero) in nodes.chain(complex).chain([(&padé, [<Const<S>>::REAL, 0.0])]) {
            let off = correction(polynomial, zero);
            assert!((0..2).all(|k| off[k].abs() <= 0.51 * ulp(zero[k])), "{zero:?}: {off:?}");
        }
    }

    #[test]
    fn tables_are_rounded_correctly() {
        is_rounded::<3>();
        is_rounded::<5>();
        is_rounded::<7>();
    }
}
