//! Dual numbers nested three deep, against those of num-dual and closed forms.

use num_dual::Dual3_64;
use simba::simd::{SimdValue, WideF64x4};

use crate::{Dual, Scalar};

type Thrice<S> = Dual<Dual<Dual<S>>>;

/// x, moving with rate 1 at every level.
fn moving<S: Scalar>(x: f64) -> Thrice<S> {
    let one = Dual::constant(1.0);
    let once = Dual { value: S::constant(x), slope: S::constant(1.0) };
    let twice = Dual { value: once, slope: one };
    Dual { value: twice, slope: Dual::constant(1.0) }
}

/// f, f′, f″, f‴
fn orders<S>(y: Thrice<S>) -> [S; 4] {
    let Dual { value, slope } = y;
    [value.value.value, value.value.slope, value.slope.slope, slope.slope.slope]
}

/// Where each function of [`function`] is to be compared.
const PLACES: [(&str, &[f64]); 24] = [
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
    // (x³)‴ = 6 and (x²)‴ = 0, at zero and for a negative base too.
    for x in [-2.0, 0.0, 1.5] {
        let power = |exponent: f64| orders(moving::<f64>(x).powf(Dual::constant(exponent)));
        agree("x³", power(3.0), [x * x * x, 3.0 * x * x, 6.0 * x, 6.0], 1e-15);
        agree("x²", power(2.0), [x * x, 2.0 * x, 2.0, 0.0], 1e-15);
        agree("x", power(1.0), [x, 1.0, 0.0, 0.0], 1e-15);
    }
}

#[test]
fn partial_derivatives_mix() {
    // ∂²/∂x∂y of x² y³ + atan2(y, x), each level moving along one of them.
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
