//! `min`, `max` and `clamp`: motors with limits.

use approx::assert_relative_eq;
use lagrange_core::prelude::*;
use lagrange_core::{Dual, number::FourLanes};

/// A mass held by a motor of limited force, on a string that only pulls.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2))]
#[force(x: clamp(-k*x - c*x_dot, -limit, limit))]
#[force(y: -k*max(y - slack, 0))]
#[observable(larger = max(x, y))]
#[observable(smaller = min(x, 2*y))]
#[observable(limited = clamp(x, -limit, limit))]
#[observable(both = max(x, y) + min(x, y) - x - y)]
struct Held<T> {
    m: T,
    k: T,
    c: T,
    limit: T,
    slack: T,
}

fn held() -> Held<f64> {
    Held { m: 2.0, k: 10.0, c: 0.5, limit: 3.0, slack: 0.25 }
}

#[test]
fn the_larger_and_the_smaller_are_what_they_are() {
    let held = held();
    for (x, y) in [(1.0, 2.0), (2.0, 1.0), (-1e9, 3.0), (3.0, -1e9), (0.5, 0.5), (-0.0, 0.0)] {
        let state = State::at_rest([x, y]);
        assert_eq!(held.larger(&state), x.max(y));
        assert_eq!(held.smaller(&state), x.min(2.0 * y));
        assert_eq!(held.limited(&state), x.clamp(-3.0, 3.0));
        assert_relative_eq!(held.both(&state), 0.0, epsilon = 1e-6);
    }
    let nowhere = State::at_rest([f64::NAN, 1.0]);
    assert!(held.limited(&nowhere).is_nan());
}

#[test]
fn a_limited_force_is_the_limit_where_it_would_be_more() {
    let held = held();
    let accelerations = |x: f64, v: f64, y: f64| {
        <[f64; 2]>::from(held.solve(&State::new([x, y], [v, 0.0])).unwrap().accelerations)
    };
    assert_eq!(accelerations(5.0, 0.0, 0.0), [-1.5, 0.0]);
    assert_eq!(accelerations(-5.0, 0.0, 1.25), [1.5, -5.0]);
    assert_relative_eq!(accelerations(0.1, 0.2, 0.25)[0], -(1.0 + 0.1) / 2.0, max_relative = 1e-15);
}

/// From far off it comes back as a stone falls.
#[test]
fn under_the_limit_it_moves_on_a_parabola() {
    let held = held();
    let path = held.integrate(State::at_rest([10.0, 0.0]), 3.0, Dop853::with_tolerance(1e-10)).unwrap();
    assert_relative_eq!(path.end().coordinate("x").unwrap(), 10.0 - 0.75 * 9.0, max_relative = 1e-12);
}

#[test]
fn the_slope_is_that_of_the_side() {
    let one = |x: f64, y: f64| {
        let held = Held { m: 2.0, k: 10.0, c: 0.5, limit: 3.0, slack: 0.25 };
        let slopes = held.jacobian(&State::at_rest([x, y])).unwrap().accelerations.q;
        (slopes[(0, 0)], slopes[(1, 1)])
    };
    assert_eq!(one(0.1, 0.0), (-5.0, 0.0));
    assert_eq!(one(5.0, 1.0), (0.0, -5.0));
    // At the edge of the slack, half of it.
    assert_eq!(one(0.0, 0.25).1, -2.5);
}

#[test]
fn lanes_and_dual_numbers_keep_to_it() {
    let wide = |x: f64| FourLanes::constant(x);
    let system = Held { m: wide(2.0), k: wide(10.0), c: wide(0.5), limit: wide(3.0), slack: wide(0.25) };
    let x = FourLanes::from([5.0, -5.0, 0.1, 0.0]);
    let state = State::new([x, wide(0.0)], [wide(0.0); 2]);
    let solution = system.accelerations_unchecked(&state);
    assert_eq!(solution.accelerations[0].to_array(), [-1.5, 1.5, -0.5, 0.0]);
    let dual = |x: f64| Dual::constant(x);
    let system = Held { m: dual(2.0), k: dual(10.0), c: dual(0.5), limit: dual(3.0), slack: dual(0.25) };
    let along = |x: f64| {
        let state = State::new([Dual { value: x, slope: 1.0 }, dual(0.0)], [dual(0.0); 2]);
        system.accelerations_unchecked(&state).accelerations[0].slope
    };
    assert_eq!([along(0.1), along(5.0)], [-5.0, 0.0]);
}
