//! Lyapunov exponents: pairs, sums, and a reference that shares nothing with them.

use lagrange_core::{linearized::DifferentiableMethod, prelude::*};
use lagrange_random::Level;

use crate::{DoublePendulum, Driven};

const PENDULUM: DoublePendulum<f64> = DoublePendulum { m: [1.0, 1.0], l: [1.0, 1.0], g: 9.81 };
const START: [f64; 2] = [2.0, 2.5];

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-9).max_steps(10_000_000)
}

/// A span of time: the first at the level `full`, the second below.
fn span(whole: f64, short: f64) -> f64 {
    if Level::asked() == Level::Full { whole } else { short }
}

/// Asserts that four exponents come in pairs of opposite sign. Logarithms of the growth of a pair add up to one of angles between
/// the variations, which does not grow: the exponents add up to less and less the longer the motion.
fn come_in_pairs(exponents: &[f64], most: f64) {
    let [a, b, c, d] = exponents.try_into().unwrap();
    assert!(f64::abs(a + d) < most && f64::abs(b + c) < most, "{exponents:?}");
}

/// The textbook's equations of a double pendulum of unit masses and lengths, written by hand.
fn rates([a, b, u, v]: [f64; 4]) -> [f64; 4] {
    let (sin, cos) = (a - b).sin_cos();
    let (first, second) = (-v * v * sin - 2.0 * 9.81 * a.sin(), u * u * sin - 9.81 * b.sin());
    let determinant = 2.0 - cos * cos;
    [u, v, (first - cos * second) / determinant, (2.0 * second - cos * first) / determinant]
}

/// One step of the classical method of Runge and Kutta.
fn step(y: [f64; 4], h: f64) -> [f64; 4] {
    let moved = |by: f64, k: [f64; 4]| std::array::from_fn(|i| y[i] + by * k[i]);
    let a = rates(y);
    let b = rates(moved(h / 2.0, a));
    let c = rates(moved(h / 2.0, b));
    let d = rates(moved(h, c));
    std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]))
}

/// The largest exponent and its standard error by two motions side by side, the second brought near again and again.
fn by_neighbours(end: f64) -> (f64, f64) {
    let (h, apart) = (2e-3, 1e-7);
    let mut y = [START[0], START[1], 0.0, 0.0];
    let mut near = [START[0] + apart, START[1], 0.0, 0.0];
    let mut grow = |time: f64| {
        let (steps, mut growth) = ((time / h) as usize, 0.0);
        for _ in 0..steps {
            (y, near) = (step(y, h), step(near, h));
            let distance = (0..4).map(|i| (near[i] - y[i]).powi(2)).sum::<f64>().sqrt();
            growth += (distance / apart).ln();
            near = std::array::from_fn(|i| y[i] + (near[i] - y[i]) * apart / distance);
        }
        growth / time
    };
    grow(end / 20.0);
    let parts: Vec<f64> = (0..20).map(|_| grow(end / 20.0)).collect();
    let mean = parts.iter().sum::<f64>() / 20.0;
    (mean, (parts.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (20.0 * 19.0)).sqrt())
}

#[test]
fn exponents_of_a_double_pendulum_come_in_pairs_and_the_largest_is_that_of_neighbours() {
    let end = span(1500.0, 300.0);
    let spectrum = PENDULUM.lyapunov_spectrum(State::at_rest(START), end, method()).unwrap();
    let (l, errors) = (&spectrum.exponents, &spectrum.errors);
    println!("{l:?} ± {errors:?}");
    assert_eq!((l.len(), spectrum.running.len()), (4, 20));
    come_in_pairs(l, 2.2 / end);
    // Along the motion nothing grows, and across surfaces of one energy what grows as the time does.
    assert!(l[1].abs() < 2.0 * end.ln() / end && l[2].abs() < 2.0 * end.ln() / end, "{l:?}");
    let (reference, error) = by_neighbours(1500.0);
    println!("by neighbours {reference} ± {error}");
    assert!(
        (l[0] - reference).abs() < 2.0 * errors[0].hypot(error),
        "{} ± {}: {reference} ± {error}",
        l[0],
        errors[0]
    );
    assert!(errors[0] * end.sqrt() < 1.5 * l[0], "{errors:?}");
    // The estimates settle.
    let off = |k: usize| (spectrum.running[k].1[0] - l[0]).abs();
    assert!(off(18) < 0.05 * l[0] && spectrum.running[19].1 == *l, "{:?}", spectrum.running);
}

/// Two masses on rods.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [2], y: [2])]
#[lagrangian(sum(i in 0..2, (x_dot[i]^2 + y_dot[i]^2)/2 - 9.81*y[i]))]
#[constraint(first: x[0]^2 + y[0]^2 = 1)]
#[constraint(second: (x[1] - x[0])^2 + (y[1] - y[0])^2 = 1)]
struct Rods;

#[test]
fn constraints_leave_as_many_exponents_as_degrees_of_freedom() {
    let [a, b] = START;
    let start = State::at_rest([a.sin(), a.sin() + b.sin(), -a.cos(), -a.cos() - b.cos()]);
    let end = span(300.0, 100.0);
    let of_rods = Rods.lyapunov_spectrum(start, end, method()).unwrap();
    let of_angles = PENDULUM.lyapunov_spectrum(State::at_rest(START), end, method()).unwrap();
    let (l, expected) = (&of_rods.exponents, &of_angles.exponents);
    println!("{l:?} ± {:?}, {expected:?} ± {:?}", of_rods.errors, of_angles.errors);
    come_in_pairs(l, 4.3 / end);
    assert!((l[0] - expected[0]).abs() < 3.0 * of_rods.errors[0].hypot(of_angles.errors[0]));
}

/// Volumes in the phase space of (θ, θ̇) shrink at the rate of friction, whatever the motion.
#[test]
fn exponents_of_a_driven_pendulum_sum_to_its_friction() {
    let driven = Driven { g: 1.0, c: 0.5, a: 1.5, w: 2.0 / 3.0 };
    let start = State::new([0.3], [0.1]);
    let by_pairs = driven.lyapunov_spectrum(start, 150.0, method()).unwrap();
    let by_series = driven.lyapunov_spectrum(start, 150.0, Taylor::default()).unwrap();
    for (spectrum, tolerance) in [(by_pairs, 1e-7), (by_series, 1e-11)] {
        let sum: f64 = spectrum.exponents.iter().sum();
        assert!((sum + 0.5).abs() < tolerance, "{:?}", spectrum.exponents);
    }
}

#[test]
fn what_ends_too_early_is_an_error() {
    let error = PENDULUM.lyapunov_spectrum(State::at_rest(START), 100.0, method().max_steps(10)).unwrap_err();
    assert!(error.to_string().contains("10 steps"), "{error}");
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 + k*x^2/2)]
#[dissipation(x_dot^2/4)]
struct Hill<T> {
    k: T,
}

/// Where the motion stands still its own error is zero, and would allow any step.
#[test]
fn variations_choose_the_steps_too() {
    stands_still(Dop853::default(), 1e-7);
    stands_still(Taylor::default(), 1e-13);
}

fn stands_still<D: DifferentiableMethod<Hill<f64>> + Copy>(method: D, tolerance: f64) {
    let (hill, top) = (Hill { k: 1.0 }, State::at_rest([0.0]));
    let root = (1.0_f64 / 16.0 + 1.0).sqrt();
    let [up, down] = [root - 0.25, -root - 0.25];
    let spectrum = hill.lyapunov_spectrum(top, 200.0, method).unwrap();
    for (found, exact) in spectrum.exponents.iter().zip([up, down]) {
        assert!((found - exact).abs() < tolerance, "{found} for {exact}");
    }
    let motion = hill.integrate_sensitivities(top, 10.0, method, &["x"]).unwrap();
    for t in [0.1, 3.7, 10.0] {
        let exact = (up * (down * t).exp() - down * (up * t).exp()) / (up - down);
        let found = motion.coordinate(t, "x", "x").unwrap();
        assert!((found / exact - 1.0).abs() < tolerance, "{found} for {exact} at {t}");
    }
}

/// Rates by the time, of the same linear equation, whichever way it is followed.
#[test]
fn exponents_descend_backwards_too() {
    let root = (1.0_f64 / 16.0 + 1.0).sqrt();
    for end in [200.0, -200.0] {
        let spectrum = Hill { k: 1.0 }.lyapunov_spectrum(State::at_rest([0.0]), end, method()).unwrap();
        let expected = [root - 0.25, -root - 0.25];
        let all = [&spectrum.exponents].into_iter().chain(spectrum.running.iter().map(|(_, means)| means));
        for means in all {
            for (found, expected) in means.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-5, "{means:?} for {expected:?}");
            }
        }
        assert!(spectrum.errors.iter().all(|error| *error < 1e-6), "{:?}", spectrum.errors);
    }
}
