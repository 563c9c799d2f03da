//! Chaotic motions: sensitivities followed to their end, and Lyapunov exponents in pairs, with and without constraints.

use lagrange_core::prelude::*;
use lagrange_random::Level;
use lagrange_systems::DoublePendulum;

use crate::differences::flow;
use crate::lyapunov::method;

const PENDULUM: DoublePendulum<f64> = DoublePendulum { m: [1.0, 1.0], l: [1.0, 1.0], g: 9.81 };
const START: [f64; 2] = [2.0, 2.5];

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

#[test]
fn exponents_of_a_double_pendulum_come_in_pairs() {
    let end = span(1500.0, 300.0);
    let spectrum = PENDULUM.lyapunov_spectrum(State::at_rest(START), end, method()).unwrap();
    let (l, errors) = (&spectrum.exponents, &spectrum.errors);
    println!("{l:?} ± {errors:?}");
    assert_eq!((l.len(), spectrum.running.len()), (4, 20));
    come_in_pairs(l, 2.2 / end);
    // Along the motion nothing grows, and across surfaces of one energy what grows as the time does.
    assert!(l[1].abs() < 2.0 * end.ln() / end && l[2].abs() < 2.0 * end.ln() / end, "{l:?}");
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

/// Motions that part by five orders of magnitude, and a parameter in each of two blocks of lanes.
#[test]
fn chaos_is_followed_to_the_end() {
    let (system, start) = (PENDULUM, State::at_rest([2.0, 1.0]));
    let names = ["a", "b", "a_dot", "b_dot", "m[0]", "l[1]", "g"];
    let by_series = system.integrate_sensitivities(start, 10.0, Taylor::default(), &names).unwrap();
    let by_pairs = system.integrate_sensitivities(start, 10.0, crate::method(), &names).unwrap();
    let [series, pairs] = [by_series, by_pairs].map(|motion| motion.derivatives_at_end().unwrap().clone());
    let (flow, other) = (flow(&series), flow(&pairs));
    let (size, apart) = (other.amax(), (&flow - other).amax());
    println!("{size:e}, apart {apart:e}");
    assert!(size > 1e4 && apart < 1e-8 * size, "{apart:e} of {size:e}");
    // The determinant of the flow is that of the momenta's, by Liouville: M at the start over M at the end.
    let flow = flow.columns(0, 4).into_owned();
    let mass = |state: &State<f64, 2>| system.mass_matrix(state).determinant();
    let expected = mass(&start) / mass(&series.state);
    let determinant = flow.determinant();
    // By as much as round-off of the largest entries changes the determinant.
    let stretches = flow.singular_values();
    let limit = f64::EPSILON * stretches.max() / stretches.min();
    assert!(
        limit < 1e-3 && (determinant / expected - 1.0).abs() < limit,
        "{determinant} for {expected}, {limit:e}"
    );
}
