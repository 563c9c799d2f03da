use super::LARGEST_ANGLE;
use crate::number::numeric::only_where;
use crate::number::scalar::FUSED;
use crate::number::{FourLanes, Lanes, Scalar};

type Function = (&'static str, fn(Lanes) -> Lanes, fn(f64) -> f64);

const FUNCTIONS: [Function; 14] = [
    ("sin", |x| x.sin(), f64::sin),
    ("cos", |x| x.cos(), f64::cos),
    ("tan", |x| x.tan(), f64::tan),
    ("asin", |x| x.asin(), f64::asin),
    ("acos", |x| x.acos(), f64::acos),
    ("atan", |x| x.atan(), f64::atan),
    ("sinh", |x| x.sinh(), f64::sinh),
    ("cosh", |x| x.cosh(), f64::cosh),
    ("tanh", |x| x.tanh(), f64::tanh),
    ("exp", |x| x.exp(), f64::exp),
    ("ln", |x| x.ln(), f64::ln),
    ("sqrt", |x| x.sqrt(), f64::sqrt),
    ("abs", |x| x.abs(), f64::abs),
    ("neg", |x| -x, |x| -x),
];

type Operation = (&'static str, fn(Lanes, Lanes) -> Lanes, fn(f64, f64) -> f64);

const OPERATIONS: [Operation; 8] = [
    ("+", |x, y| x + y, |x, y| x + y),
    ("-", |x, y| x - y, |x, y| x - y),
    ("*", |x, y| x * y, |x, y| x * y),
    ("/", |x, y| x / y, |x, y| x / y),
    ("atan2", |x, y| x.atan2(y), f64::atan2),
    ("powf", |x, y| x.powf(y), f64::powf),
    ("min", |x, y| x.min(y), f64::min),
    ("max", |x, y| x.max(y), f64::max),
];

const NUMBERS: [f64; 16] = [
    0.0,
    -0.0,
    0.3,
    -0.7,
    1.0,
    -2.5,
    7.9,
    1e-300,
    -1e-12,
    4e3,
    -7e7,
    3e11,
    1e300,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

/// Calls `check` with every number in every lane, next to every other number.
fn each_beside_each(check: impl Fn(f64, usize, Lanes, Lanes)) {
    for x in NUMBERS {
        for other in NUMBERS {
            for lane in 0..Lanes::COUNT {
                let beside = std::array::from_fn(|i| if i == lane { x } else { other });
                check(x, lane, Lanes::constant(x), beside.into());
            }
        }
    }
}

#[test]
fn no_lane_depends_on_another() {
    each_beside_each(|x, lane, alone, beside| {
        for (name, lanes, _) in FUNCTIONS {
            let (alone, beside) = (lanes(alone).to_array()[0], lanes(beside).to_array()[lane]);
            assert!(same(alone, beside), "{name}({x}) is {alone} and {beside} in lane {lane}");
        }
        for (name, lanes, _) in OPERATIONS {
            for y in NUMBERS {
                let y = Lanes::constant(y);
                let (alone, beside) = (lanes(alone, y).to_array()[0], lanes(beside, y).to_array()[lane]);
                assert!(same(alone, beside), "{name} of {x} is {alone} and {beside} in lane {lane}");
            }
        }
    });
}

/// Tolerance: two units in the last place, or of 10⁻³ for a result near zero. Sines and cosines of large angles
/// may be NaN.
#[test]
fn each_lane_is_what_the_number_alone_gives() {
    let close = |a: f64, b: f64| same(a, b) || (a - b).abs() <= 4.5e-16 * b.abs().max(1e-3);
    for x in NUMBERS {
        for (name, lanes, alone) in FUNCTIONS {
            let (lane, alone) = (lanes(Lanes::constant(x)).to_array()[1], alone(x));
            let too_far = ["sin", "cos"].contains(&name) && x.abs() >= LARGEST_ANGLE && lane.is_nan();
            assert!(too_far || close(lane, alone), "{name}({x}) is {lane}, not {alone}");
        }
        for y in NUMBERS.into_iter().filter(|y| !x.is_nan() && !y.is_nan()) {
            for (name, lanes, alone) in OPERATIONS {
                let (lane, alone) =
                    (lanes(Lanes::constant(x), Lanes::constant(y)).to_array()[2], alone(x, y));
                assert!(close(lane, alone) || lane == alone, "{x} {name} {y} is {lane}, not {alone}");
            }
        }
    }
}

/// `multiply_add` rounds once with FMA and twice without, the same as for a single number.
#[test]
fn products_and_sums_are_fused_as_for_the_number_alone() {
    let product_and_sum = |x: f64, y, z| if FUSED { x.mul_add(y, z) } else { x * y + z };
    each_beside_each(|x, lane, _, beside| {
        // The rounding error of 0.1 · 10 − 1 and the like is the whole result.
        for (y, z) in [(3.0, -3.0 * x), (0.1, -0.1 * x), (x, -x * x), (1e300, x), (x, f64::NAN)] {
            let sum = beside.multiply_add(Lanes::constant(y), Lanes::constant(z)).to_array()[lane];
            assert!(same(sum, product_and_sum(x, y, z)), "{x} · {y} + {z} is {sum}");
            assert!(same(sum, x.multiply_add(y, z)), "{x} · {y} + {z} is {sum}");
            let difference =
                beside.subtract_product(Lanes::constant(y), Lanes::constant(-z)).to_array()[lane];
            assert!(same(difference, product_and_sum(-x, y, -z)), "{z} − {x} · {y} is {difference}");
            assert!(same(difference, x.subtract_product(y, -z)), "{z} − {x} · {y} is {difference}");
        }
    });
}

#[test]
fn sines_are_accurate_up_to_the_largest_angle() {
    for k in 0..200_000 {
        let part = (f64::from(k) * 0.618_033_988_749_894_9).fract();
        let angle = LARGEST_ANGLE * part.powi(1 + 8 * (k % 2));
        let (sin, cos) = Lanes::constant(angle).sin_cos();
        let off = (sin.to_array()[3] - angle.sin()).abs().max((cos.to_array()[3] - angle.cos()).abs());
        assert!(off < 3e-16, "off by {off:e} at {angle}");
    }
}

/// Derivatives have no scalar arithmetic to fall back on. A lane beside large angles keeps its bits.
#[test]
fn sines_of_large_angles_are_those_of_the_number_alone() {
    let small = FourLanes::constant(1.25).sin_cos().0.to_array()[0];
    for angle in [LARGEST_ANGLE, -1.5e8, 3e10, -1e15, 1e22, f64::INFINITY, f64::NAN] {
        let (sin, cos) = FourLanes::from([angle, 1.25, -angle, angle]).sin_cos();
        let (sin, cos) = (sin.to_array(), cos.to_array());
        assert!(same(sin[0], angle.sin()) && same(cos[3], angle.cos()) && same(sin[2], (-angle).sin()));
        assert_eq!(sin[1].to_bits(), small.to_bits());
    }
}

/// Zero where the activity is zero, whatever the value; NaN where the activity is NaN.
#[test]
fn values_are_there_only_where_something_changes() {
    let activity = [0.0, -0.0, f64::NAN, -1e-300, f64::INFINITY];
    for (k, value) in [f64::NAN, f64::INFINITY, 3.0, 3.0, 3.0].into_iter().enumerate() {
        let expected = if k < 2 { 0.0 } else { [f64::NAN, 3.0, 3.0][k - 2] };
        let in_lanes = only_where(Lanes::constant(activity[k]), Lanes::constant(value)).to_array();
        let in_four = only_where(FourLanes::constant(activity[k]), FourLanes::constant(value)).to_array();
        let all = in_lanes.into_iter().chain(in_four).chain([only_where(activity[k], value)]);
        all.for_each(|found| {
            assert!(found == expected || found.is_nan() && expected.is_nan(), "{k}: {found}");
        });
    }
}
