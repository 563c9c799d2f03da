//! Dual numbers nested three deep, compared with num-dual and closed forms.

use core::cmp::Ordering;

use num_dual::Dual3_64;
use simba::simd::{SimdValue, WideF64x4};

use crate::number::{Dual, Scalar};

type Thrice<S> = Dual<Dual<Dual<S>>>;

/// Returns x with derivative 1 at each of the three levels.
fn moving<S: Scalar>(x: f64) -> Thrice<S> {
    let one = Dual::constant(1.0);
    let once = Dual { value: S::constant(x), slope: S::constant(1.0) };
    let twice = Dual { value: once, slope: one };
    Dual { value: twice, slope: Dual::constant(1.0) }
}

/// Returns f, f′, f″, f‴.
fn orders<S>(y: Thrice<S>) -> [S; 4] {
    let Dual { value, slope } = y;
    [value.value.value, value.value.slope, value.slope.slope, slope.slope.slope]
}

/// Arguments at which each function of [`function`] is compared.
const PLACES: [(&str, &[f64]); 25] = [
    ("sin", &[-2.1, 0.0, 0.7]),
    ("cos", &[-2.1, 0.0, 0.7]),
    ("sin_cos", &[-2.1, 0.0, 0.7]),
    ("tan", &[-1.2, 0.0, 0.7]),
    ("asin", &[-0.6, 0.0, 0.3]),
    ("acos", &[-0.6, 0.0, 0.3]),
    ("atan", &[-2.1, 0.0, 0.7]),
    ("atan2", &[-2.1, 0.0, 0.7]),
    ("sinh", &[-2.1, 0.0, 0.7]),
    ("cosh", &[-2.1, 0.0, 0.7]),
    ("tanh", &[-2.1, 0.0, 0.7]),
    ("exp", &[-2.1, 0.0, 0.7]),
    ("ln", &[0.4, 1.0, 2.5]),
    ("sqrt", &[0.4, 1.0, 2.5]),
    ("abs", &[-2.1, 0.7]),
    ("power of two thirds", &[0.4, 1.0, 2.5]),
    ("power of itself", &[0.4, 1.0, 2.5]),
    ("power of a number", &[-2.1, 0.0, 0.7]),
    ("sum", &[-2.1, 0.0, 0.7]),
    ("product", &[-2.1, 0.0, 0.7]),
    ("quotient", &[-2.1, 0.0, 0.7]),
    ("negative", &[-2.1, 0.0, 0.7]),
    ("smaller", &[-2.1, 0.7]),
    ("larger", &[-2.1, 0.7]),
    ("all in one", &[-0.8, 0.0, 0.7]),
];

fn function<S: Scalar>(name: &str, x: S) -> S {
    let c = S::constant;
    match name {
        "sin" => x.sin(),
        "cos" => x.cos(),
        "sin_cos" => x.sin_cos().0 * c(2.0) - x.sin_cos().1,
        "tan" => x.tan(),
        "asin" => x.asin(),
        "acos" => x.acos(),
        "atan" => x.atan(),
        "atan2" => (x * x - c(1.0)).atan2(x - c(3.0)),
        "sinh" => x.sinh(),
        "cosh" => x.cosh(),
        "tanh" => x.tanh(),
        "exp" => x.exp(),
        "ln" => x.ln(),
        "sqrt" => x.sqrt(),
        "abs" => x.abs() * x,
        "power of two thirds" => x.powf(c(2.0 / 3.0)),
        "power of itself" => x.powf(x),
        "power of a number" => c(1.7).powf(x),
        "sum" => x + x.exp() - c(2.0) - x.sin(),
        "product" => x * x.exp() * x.sin(),
        "quotient" => x.exp() / (c(2.0) + x * x),
        "negative" => -(x * x * x),
        "smaller" => (x * x).min(x * c(2.0)),
        "larger" => (x * x).max(x * c(2.0)),
        "all in one" => (x.sin() * x.cosh() / (c(1.5) + x.atan()).sqrt()).tanh(),
        _ => panic!("no function {name}"),
    }
}

#[track_caller]
fn agree(what: &str, ours: [f64; 4], theirs: [f64; 4], tolerance: f64) {
    for (order, (ours, theirs)) in ours.into_iter().zip(theirs).enumerate() {
        let error = (ours - theirs).abs() / theirs.abs().max(1.0);
        assert!(error <= tolerance, "order {order} of {what}: {ours}, expected {theirs}");
    }
}

fn everywhere(check: impl Fn(&str, f64, [f64; 4])) {
    for (name, places) in PLACES {
        for &x in places {
            check(name, x, orders(function(name, moving::<f64>(x))));
        }
    }
}

#[test]
fn three_derivatives_are_those_of_num_dual() {
    everywhere(|name, x, ours| {
        let theirs = function(name, Dual3_64::new(x, 1.0, 0.0, 0.0));
        agree(&format!("{name} at {x}"), ours, [theirs.re, theirs.v1, theirs.v2, theirs.v3], 1e-13);
    });
}

#[test]
fn single_precision_has_them_too() {
    everywhere(|name, x, double| {
        let single = orders(function(name, moving::<f32>(x))).map(f64::from);
        agree(&format!("{name} at {x}"), single, double, 1e-4);
    });
}

#[test]
fn each_lane_has_its_own() {
    for (name, places) in PLACES {
        let lane = |i: usize| places[i % places.len()];
        let x = WideF64x4::from([lane(0), lane(1), lane(2), lane(3)]);
        let one = WideF64x4::splat(1.0);
        let mut moving = moving(0.0);
        moving.value.value = Dual { value: x, slope: one };
        let lanes = orders(function(name, moving));
        for i in 0..4 {
            let double = orders(function(name, self::moving::<f64>(lane(i))));
            agree(&format!("{name} in lane {i}"), lanes.map(|value| value.extract(i)), double, 1e-12);
        }
    }
}

#[test]
fn a_constant_power_takes_no_logarithm_and_ends_in_zero() {
    // (x³)‴ = 6 and (x²)‴ = 0, also at zero and for a negative base.
    for x in [-2.0, 0.0, 1.5] {
        let power = |exponent: f64| orders(moving::<f64>(x).powf(Dual::constant(exponent)));
        agree("x³", power(3.0), [x * x * x, 3.0 * x * x, 6.0 * x, 6.0], 1e-15);
        agree("x²", power(2.0), [x * x, 2.0 * x, 2.0, 0.0], 1e-15);
        agree("x", power(1.0), [x, 1.0, 0.0, 0.0], 1e-15);
    }
}

#[test]
fn partial_derivatives_mix() {
    // ∂²/∂x∂y of x² y³ + atan2(y, x): x varies at the inner level and y at the outer.
    let (x, y) = (1.3, -0.7);
    let along_x = Dual { value: Dual { value: x, slope: 1.0 }, slope: Dual::constant(0.0) };
    let along_y = Dual { value: Dual { value: y, slope: 0.0 }, slope: Dual::constant(1.0) };
    let f = along_x * along_x * along_y * along_y * along_y + along_y.atan2(along_x);
    let radius2: f64 = x * x + y * y;
    let expected = 6.0 * x * y * y + (y * y - x * x) / (radius2 * radius2);
    assert!((f.slope.slope - expected).abs() < 1e-14, "{} {expected}", f.slope.slope);
}

#[test]
fn where_two_agree_the_smaller_has_their_mean_slope() {
    let (x, y) = (Dual { value: 2.0, slope: 1.0 }, Dual { value: 2.0, slope: 5.0 });
    assert_eq!(x.min(y), Dual { value: 2.0, slope: 3.0 });
}

/// Numbers of every size, infinities and NaN.
const EXTREMES: [f64; 13] = [
    0.0,
    -0.0,
    5e-324,
    1.0,
    -1.0,
    1.0 + f64::EPSILON,
    1e16,
    -1e16,
    1e200,
    f64::MAX,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

fn same(x: f64, y: f64) -> bool {
    x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan()
}

/// Expected slope of min(x, y), by branches.
fn slope_of_smaller([x, y]: [f64; 2], [dx, dy]: [f64; 2]) -> f64 {
    match x.partial_cmp(&y) {
        None => f64::NAN,
        Some(Ordering::Less) => dx,
        Some(Ordering::Equal) => dx / 2.0 + dy / 2.0,
        Some(Ordering::Greater) => dy,
    }
}

#[test]
fn the_smaller_and_the_larger_are_those_of_the_scalar_with_their_own_slopes() {
    let slopes = [3.0, -7.0];
    for x in EXTREMES {
        for y in EXTREMES {
            let (a, b) = (Dual { value: x, slope: slopes[0] }, Dual { value: y, slope: slopes[1] });
            let (smaller, larger) = (a.min(b), a.max(b));
            assert!(same(smaller.value, Scalar::min(x, y)), "min({x}, {y}) is {smaller:?}");
            assert!(same(larger.value, Scalar::max(x, y)), "max({x}, {y}) is {larger:?}");
            assert!(same(smaller.slope, slope_of_smaller([x, y], slopes)), "min({x}, {y}) is {smaller:?}");
            assert!(same(larger.slope, slope_of_smaller([-x, -y], slopes)), "max({x}, {y}) is {larger:?}");
        }
    }
}

#[test]
fn in_lanes_too_whatever_is_beside() {
    // Two constant lanes beside the pair, so that all four orders of the pair occur in one vector.
    for x in EXTREMES {
        for y in EXTREMES {
            let wide = |a, b| Dual { value: WideF64x4::from([a, 1.0, b, 2.0]), slope: WideF64x4::splat(3.0) };
            let other = Dual { slope: WideF64x4::splat(-7.0), ..wide(y, x) };
            for (ours, inner, sign) in [
                (wide(x, y).min(other), Scalar::min(wide(x, y).value, other.value), 1.0),
                (wide(x, y).max(other), Scalar::max(wide(x, y).value, other.value), -1.0),
            ] {
                for lane in 0..4 {
                    let pair = [wide(x, y), other].map(|dual| sign * dual.value.extract(lane));
                    let (value, slope) = (ours.value.extract(lane), ours.slope.extract(lane));
                    assert!(same(value, inner.extract(lane)), "{pair:?}: {value} in lane {lane}");
                    assert!(same(slope, slope_of_smaller(pair, [3.0, -7.0])), "{pair:?}: {slope} in {lane}");
                }
            }
        }
    }
}

#[test]
fn a_magnitude_has_the_mean_slope_at_zero() {
    let slope = |x: f64| Dual { value: x, slope: 2.0 }.abs().slope;
    assert_eq!([-1e-300, -0.0, 0.0, 1e-300, f64::INFINITY].map(slope), [-2.0, 0.0, 0.0, 2.0, 2.0]);
    assert!(slope(f64::NAN).is_nan());
}

#[test]
fn derivatives_do_not_cancel() {
    let slope = |f: fn(Dual<f64>) -> Dual<f64>, x: f64| f(Dual { value: x, slope: 1.0 }).slope;
    let close =
        |ours: f64, expected: f64| assert!((ours / expected - 1.0).abs() < 1e-14, "{ours} {expected}");
    // At 1 − d with a power of two d: 1 − x² = d (2 − d).
    for d in [2.0_f64.powi(-20), 2.0_f64.powi(-40), 2.0_f64.powi(-52)] {
        let expected = 1.0 / (d * (2.0 - d)).sqrt();
        close(slope(Dual::asin, 1.0 - d), expected);
        close(slope(Dual::asin, d - 1.0), expected);
        close(slope(Dual::acos, 1.0 - d), -expected);
    }
    for x in [-30.0_f64, -1.0, 0.0, 1e-9, 3.0, 17.0, 300.0] {
        close(slope(Dual::tanh, x), x.cosh().powi(-2));
    }
    assert_eq!(slope(Dual::tanh, 1000.0), 0.0);
    // The second derivative −2 tanh/cosh², far from zero and where the branches for the two signs meet.
    for x in [-20.0_f64, 0.0, 25.0] {
        let [_, _, second, _] = orders(moving::<f64>(x).tanh());
        let expected = -2.0 * x.tanh() * x.cosh().powi(-2);
        assert!((second - expected).abs() <= 1e-14 * expected.abs(), "{second} {expected}");
    }
}

#[test]
fn an_angle_does_not_depend_on_the_unit_of_length() {
    let turn = |unit: f64| {
        let (x, y) = (Dual { value: 3.0 * unit, slope: 0.5 * unit }, Dual { value: 4.0 * unit, slope: unit });
        y.atan2(x)
    };
    let expected = (3.0 * 1.0 - 4.0 * 0.5) / 25.0;
    for unit in [1e-300, 1e-200, 1e-160, 1.0, 1e154, 1e200, 1e307] {
        let Dual { value, slope } = turn(unit);
        assert!((value - 4.0_f64.atan2(3.0)).abs() < 1e-15, "{value} for {unit}");
        assert!((slope - expected).abs() < 1e-15, "{slope} for {unit}, expected {expected}");
    }
}

#[test]
fn what_does_not_move_has_no_slope_at_a_pole_of_the_derivative() {
    let (rest, one) = (Dual { value: 0.0, slope: 0.0 }, Dual::constant(1.0));
    let power = |x: Dual<f64>, y: f64| x.powf(Dual::constant(y));
    for still in [rest.sqrt(), power(rest, 0.5), power(rest, 1.5), one.asin(), one.acos()] {
        assert_eq!(still.slope, 0.0, "{still:?}");
    }
    let moving = Dual { value: 0.0, slope: 1.0 };
    assert_eq!([moving.sqrt().slope, power(moving, 0.5).slope], [f64::INFINITY; 2]);
    // Second derivatives of max(x, 0)^(3/2), the contact force of a ball that touches nothing.
    let [value, first, second, _] =
        orders(self::moving::<f64>(-1.0).max(Dual::constant(0.0)).powf(Dual::constant(1.5)));
    assert_eq!([value, first, second], [0.0; 3]);
}

#[test]
fn a_power_is_the_same_beside_others() {
    // Base, exponent, slope of the base, slope of the exponent: a constant base of zero, a negative base with a
    // constant exponent, x⁰ at zero, varying exponents.
    let cases: [[f64; 4]; 8] = [
        [0.0, 0.5, 0.0, 0.0],
        [-2.0, 3.0, 1.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [2.0, 1.5, 1.0, 1.0],
        [-2.0, 2.0, 1.0, 0.0],
        [2.0, 0.0, 0.0, 1.0],
        [0.0, 2.0, 1.0, 0.0],
        [3.0, -1.0, 0.5, 0.0],
    ];
    for turn in 0..8 {
        let lane = |i: usize| cases[(turn + 3 * i) % 8];
        let lanes = |k: usize| WideF64x4::from([lane(0)[k], lane(1)[k], lane(2)[k], lane(3)[k]]);
        let power = Dual { value: lanes(0), slope: lanes(2) }.powf(Dual { value: lanes(1), slope: lanes(3) });
        for i in 0..4 {
            let [x, y, dx, dy] = lane(i);
            let alone = Dual { value: x, slope: dx }.powf(Dual { value: y, slope: dy });
            let (value, slope) = (power.value.extract(i), power.slope.extract(i));
            agree(
                &format!("{:?}", lane(i)),
                [value, slope, 0.0, 0.0],
                [alone.value, alone.slope, 0.0, 0.0],
                1e-13,
            );
            // Expected slope by case.
            let by_x = if y == 0.0 || dx == 0.0 { 0.0 } else { y * x.powf(y - 1.0) * dx };
            let by_y = if dy == 0.0 { 0.0 } else { x.powf(y) * x.ln() * dy };
            assert!((slope - by_x - by_y).abs() < 1e-13, "{slope} for {:?}", lane(i));
        }
    }
}
