//! E = p·q̇ − L, Milton (8.17), of Lagrangians of every degree in the velocities.

use approx::assert_relative_eq;
use lagrange_core::facts::{EnergyForm, LinearPart};
use lagrange_core::{facts::Evidence, nalgebra::Const, prelude::*};
use lagrange_random::Random;
use lagrange_systems::random_state;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[define(speed = x_dot^2 + 2*x*x_dot + y)]
#[define(field = y*x_dot*sin(t) - k*x^2*y_dot)]
#[lagrangian(m/2 * speed^2 + m/2 * y_dot^2 + field - k*cos(x*y) + x_dot^2*y_dot)]
struct Mixed {
    m: f64,
    k: f64,
}

/// The same kinds of parts, each of a degree that can be read off, in a definition of two degrees.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[define(parts = y*x_dot*sin(t) - k*x^2 + x_dot^2*y_dot)]
#[lagrangian(m/2 * (x_dot + x*y_dot)^2 + m/2 * y_dot^2 - 3*parts - k*cos(x*y))]
struct Degrees {
    m: f64,
    k: f64,
}

/// A relativistic particle: no part of L has a degree.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(-m*c^2*sqrt(1 - (x_dot^2 + y_dot^2)/c^2) - m*g*y)]
struct Relativistic {
    m: f64,
    c: f64,
    g: f64,
}

fn check<L: Lagrangian<N = Const<2>, M = Const<0>, Scalar = f64>>(system: &L) {
    let random = &mut Random(1);
    for _ in 0..20 {
        let mut state = random_state(random);
        // Slower than light.
        state.v *= 0.5;
        let expected = system.momentum(&state).dot(&state.v) - system.lagrangian(&state);
        assert_relative_eq!(system.energy(&state), expected, epsilon = 1e-14, max_relative = 1e-13);
    }
}

#[test]
fn energy_8_17() {
    check(&Mixed { m: 1.3, k: 0.7 });
    check(&Degrees { m: 1.3, k: 0.7 });
    check(&Relativistic { m: 1.3, c: 2.0, g: 9.81 });
}

#[test]
fn what_is_no_sum_of_t_and_u_is_told() {
    for facts in [Mixed::FACTS, Relativistic::FACTS] {
        assert_eq!((facts.energy_form, facts.linear_part), (EnergyForm::General, LinearPart::Open));
    }
    assert_eq!(Mixed::FACTS.energy_is_conserved, None);
    assert_eq!(Relativistic::FACTS.energy_is_conserved, Some(Evidence::Proved));
    assert_eq!(Relativistic::FACTS.cyclic, ["x"]);
    // γ m c² and the potential.
    let particle = Relativistic { m: 1.0, c: 2.0, g: 10.0 };
    let state = State::new([0.0, 0.3], [1.2, 0.0]);
    assert_relative_eq!(particle.energy(&state), 4.0 / 0.8 + 3.0, max_relative = 1e-14);
}
