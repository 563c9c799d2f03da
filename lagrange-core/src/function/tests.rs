//! Derivatives of user-supplied functions, compared with closed forms.

use super::gradients::{along, write_gradients};
use super::{
    First, Function, FunctionWithDerivatives, Second, Third, Value, WithDerivatives, check_derivatives,
};
use crate::number::Scalar;
use lagrange_random::cases;

/// The functions x² y z³ and x y⁴.
struct Monomials;

const EXPONENTS: [[u32; 3]; 2] = [[2, 1, 3], [1, 4, 0]];

impl Function<3, 2> for Monomials {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 2] {
        [x * x * y * z * z * z, x * y * y * y * y]
    }
}

/// Returns the derivatives by each variable in `by`, from (xⁿ)⁽ᵏ⁾ = n (n − 1) … xⁿ⁻ᵏ.
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

#[test]
fn gradients_are_rows_of_derivatives_and_multiply_directions() {
    let x = PLACES[0];
    let mut rows = [0.0; 2 * 2 * 3];
    write_gradients(3, &[[2], [0]], |[i], j| Monomials.second(x, [i, j]), &mut rows);
    for (row, [i, output]) in rows.chunks(3).zip([[2, 0], [2, 1], [0, 0], [0, 1]]) {
        assert_eq!(row, [0, 1, 2].map(|j| closed(x, &[i, j])[output]));
    }
    let direction = [1.0, -2.0, 0.5];
    let product = |row: &[f64]| row[0] - 2.0 * row[1] + 0.5 * row[2];
    assert_eq!(along(&rows[6..], direction), [product(&rows[6..9]), product(&rows[9..])]);
}

#[test]
fn an_infinite_slope_counts_only_where_the_direction_has_a_part() {
    let gradients = [f64::INFINITY, 3.0, f64::NAN];
    assert_eq!(along(&gradients, [0.0, 2.0, 0.0]), [6.0]);
    assert_eq!(along(&gradients, [1.0, 2.0, 0.0]), [f64::INFINITY]);
}

/// The function sin(x) e^y.
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

/// Function whose derivatives encode their indices in their digits.
struct Places;

impl FunctionWithDerivatives<2, 2> for Places {
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
    let (by_hand, x) = (WithDerivatives(Places), [5.0, 6.0]);
    assert_eq!(by_hand.value(x), [5.0, 6.0]);
    assert_eq!(by_hand.first(x, [0]), [10.0, 20.0]);
    assert_eq!(by_hand.first(x, [1]), [11.0, 21.0]);
    assert_eq!(by_hand.second(x, [0, 1]), [101.0, 201.0]);
    assert_eq!(by_hand.second(x, [1, 1]), [111.0, 211.0]);
}

/// A sum of a sine, a product and an exponential with hand-written derivatives. Derivative `which` is
/// multiplied by `off`.
struct ByFormula {
    a: [f64; 7],
    off: f64,
    which: usize,
}

impl FunctionWithDerivatives<2, 1> for ByFormula {
    fn value(&self, [x, y]: [f64; 2]) -> [f64; 1] {
        let [a, b, c, d, e, f, g] = self.a;
        [a * (b * x + c * y).sin() + d * x * x * y + e * (f * x - g * y).exp()]
    }

    fn gradient(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 1] {
        let [a, b, c, d, e, f, g] = self.a;
        let (cos, exp) = (a * (b * x + c * y).cos(), e * (f * x - g * y).exp());
        let mut gradient = [b * cos + 2.0 * d * x * y + f * exp, c * cos + d * x * x - g * exp];
        if let Some(x) = gradient.get_mut(self.which) {
            *x *= self.off;
        }
        [gradient]
    }

    fn hessian(&self, [x, y]: [f64; 2]) -> [[[f64; 2]; 2]; 1] {
        let [a, b, c, d, e, f, g] = self.a;
        let (sin, exp) = (a * (b * x + c * y).sin(), e * (f * x - g * y).exp());
        let mixed = 2.0 * d * x - b * c * sin - f * g * exp;
        let mut hessian =
            [[2.0 * d * y - b * b * sin + f * f * exp, mixed], [mixed, g * g * exp - c * c * sin]];
        if let Some(x) = hessian.as_flattened_mut().get_mut(self.which.wrapping_sub(2)) {
            *x *= self.off;
        }
        [hessian]
    }
}

/// Checks functions, correct and with an error of 0.1 % in each of their six derivatives.
#[test]
fn a_derivative_that_is_off_by_a_thousandth_is_found_and_none_else() {
    let count = cases([200, 500, 100_000]) as u64;
    let mut seed = 1_u64;
    let mut number = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * (seed >> 11) as f64 / (1_u64 << 53) as f64 - 1.0
    };
    for _ in 0..count {
        let (a, x) = ([0; 7].map(|_| 3.0 * number()), [0; 2].map(|_| 2.0 * number()));
        let right = ByFormula { a, off: 1.0, which: 6 };
        assert_eq!(check_derivatives(&WithDerivatives(right), x), Ok(()), "{a:?} {x:?}");
        for which in 0..6 {
            let wrong = ByFormula { a, off: 1.001, which };
            let found = check_derivatives(&WithDerivatives(wrong), x).expect_err("a wrong derivative");
            // A wrong gradient also has wrong differences, so its second derivatives are reported for the same
            // argument.
            let by = if which < 2 { which } else { (which - 2) / 2 };
            assert_eq!(found.by, by, "{a:?} {x:?} {which}: {found}");
        }
    }
}

#[test]
fn what_is_wrong_is_said_with_its_arguments() {
    let wrong = ByFormula { a: [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], off: 1.001, which: 2 };
    let text = std::string::ToString::to_string(
        &check_derivatives(&WithDerivatives(wrong), [0.5, 2.0]).unwrap_err(),
    );
    let start =
        "the second derivative of result 0 by arguments 0 and 0 is given as 4.004, where differences say ";
    assert!(text.starts_with(start) && text.contains(" ± "), "{text}");
    // Derivatives that follow from the values are correct.
    assert_eq!(check_derivatives(&Wave, [0.7, -0.4]), Ok(()));
    assert_eq!(check_derivatives(&Monomials, [2.0, 3.0, 5.0]), Ok(()));
}
