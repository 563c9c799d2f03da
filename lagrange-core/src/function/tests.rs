//! Derivatives of supplied functions against closed forms.

use super::{ByHand, First, Function, HandWritten, Second, Third, Value};
use crate::number::Scalar;

/// x² y z³ and x y⁴
struct Monomials;

const EXPONENTS: [[u32; 3]; 2] = [[2, 1, 3], [1, 4, 0]];

impl Function<3, 2> for Monomials {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 2] {
        [x * x * y * z * z * z, x * y * y * y * y]
    }
}

/// Its derivative by each variable in `by`, in whole numbers: (xⁿ)⁽ᵏ⁾ = n (n − 1) … xⁿ⁻ᵏ.
fn closed(x: [f64; 3], by: &[usize]) -> [f64; 2] {
    EXPONENTS.map(|exponents| {
        let mut product = 1.0;
        for (variable, exponent) in exponents.into_iter().enumerate() {
            let times = by.iter().filter(|&&i| i == variable).count() as u32;
            let falling: u32 = (0..times).map(|k| exponent.saturating_sub(k)).product();
            product *= f64::from(falling) * x[variable].powi(exponent.saturating_sub(times) as i32);
        }
        product
    })
}

const PLACES: [[f64; 3]; 3] = [[2.0, 3.0, 5.0], [-1.0, 2.0, -3.0], [0.0, 0.0, 0.0]];

#[test]
fn derivatives_up_to_the_third_are_exact_on_monomials() {
    let numbers: Vec<[usize; 3]> = (0..27).map(|n| [n / 9, n / 3 % 3, n % 3]).collect();
    for x in PLACES {
        assert_eq!(Monomials.value(x), closed(x, &[]));
        for &[i, j, k] in &numbers {
            assert_eq!(Monomials.first(x, [i]), closed(x, &[i]));
            assert_eq!(Monomials.second(x, [i, j]), closed(x, &[i, j]));
            assert_eq!(Monomials.third(x, [i, j, k]), closed(x, &[i, j, k]));
        }
    }
}

/// sin(x) e^y, whose derivatives recur.
struct Wave;

impl Function<2, 1> for Wave {
    fn eval<S: Scalar>(&self, [x, y]: [S; 2]) -> [S; 1] {
        [x.sin() * y.exp()]
    }
}

#[test]
fn elementary_functions_come_through_at_every_order() {
    let (x, y) = (0.7_f64, -0.4_f64);
    let circle = [x.sin(), x.cos(), -x.sin(), -x.cos()].map(|s| s * y.exp());
    let close = |[ours]: [f64; 1], expected: f64| assert!((ours - expected).abs() < 1e-15);
    close(Wave.value([x, y]), circle[0]);
    close(Wave.first([x, y], [0]), circle[1]);
    close(Wave.second([x, y], [0, 1]), circle[1]);
    close(Wave.second([x, y], [0, 0]), circle[2]);
    close(Wave.third([x, y], [0, 1, 0]), circle[2]);
    close(Wave.third([x, y], [0, 0, 0]), circle[3]);
}

/// Numbers that tell their places.
struct Places;

impl HandWritten<2, 2> for Places {
    fn value(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x, y]
    }

    fn gradient(&self, _: [f64; 2]) -> [[f64; 2]; 2] {
        [[10.0, 11.0], [20.0, 21.0]]
    }

    fn hessian(&self, _: [f64; 2]) -> [[[f64; 2]; 2]; 2] {
        [[[100.0, 101.0], [110.0, 111.0]], [[200.0, 201.0], [210.0, 211.0]]]
    }
}

#[test]
fn hand_written_derivatives_are_found_in_their_places() {
    let (by_hand, x) = (ByHand(Places), [5.0, 6.0]);
    assert_eq!(by_hand.value(x), [5.0, 6.0]);
    assert_eq!(by_hand.first(x, [0]), [10.0, 20.0]);
    assert_eq!(by_hand.first(x, [1]), [11.0, 21.0]);
    assert_eq!(by_hand.second(x, [0, 1]), [101.0, 201.0]);
    assert_eq!(by_hand.second(x, [1, 1]), [111.0, 211.0]);
}
