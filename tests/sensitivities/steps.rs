//! How long steps are where the motion rests: its own error is zero there, and says nothing about variations.

use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*x^2 + push*x)]
struct Held {
    m: f64,
    k: f64,
    push: f64,
}

/// At rest where the spring holds against the push, at x = 1; ω = 1.
fn held(size: f64) -> (Held, State<f64, 1>) {
    (Held { m: size, k: size, push: size }, State::at_rest([1.0]))
}

/// ∂x/∂push = (1 − cos t)/k.
#[test]
fn parameters_count_by_their_size() {
    for size in [1e-8, 1.0, 1e8] {
        let (held, start) = held(size);
        let motion = held.integrate_sensitivities(start, 10.0, Dop853::default(), &["push"]).unwrap();
        let found = motion.coordinate(10.0, "x", "push").unwrap() * size;
        assert!((found - (1.0 - 10.0_f64.cos())).abs() < 1e-7, "{found} at {size}");
    }
}

#[test]
fn a_step_too_long_for_variations_is_taken_back() {
    let (held, start) = held(1.0);
    let method = Dop853::default().first_step(8.0);
    let motion = held.integrate_sensitivities(start, 100.0, method, &["x"]).unwrap();
    for t in [1.0_f64, 8.0, 100.0] {
        let found = motion.coordinate(t, "x", "x").unwrap();
        assert!((found - t.cos()).abs() < 1e-6, "{found} at {t}");
    }
    // And the next is as long as the variations like it, not ten times the last.
    let statistics = motion.trajectory().statistics();
    assert!(statistics.rejected >= 1 && 5 * statistics.rejected < statistics.accepted, "{statistics:?}");
}

/// On top of a hill variations grow as eᵗ, and steps get no shorter.
#[test]
fn variations_that_grow_are_followed_to_the_same_digits() {
    let hill = Held { m: 1.0, k: -1.0, push: -1.0 };
    let steps = |end: f64| {
        let motion =
            hill.integrate_sensitivities(State::at_rest([1.0]), end, Dop853::default(), &["x"]).unwrap();
        let found = motion.coordinate(end, "x", "x").unwrap();
        assert!((found / end.cosh() - 1.0).abs() < 1e-6, "{found} at {end}");
        motion.trajectory().statistics().accepted
    };
    let (half, whole) = (steps(30.0), steps(60.0));
    assert!(whole <= 2 * half + 2, "{half} and {whole}");
}
