//! Linear systems and equilibria of further mechanisms.

use std::f64::consts::PI;

use lagrange_core::linearized::{DiscreteTime, Stability};
use lagrange_core::nalgebra::{Complex, DMatrix};
use lagrange_core::prelude::*;
use lagrange_systems::BeadOnHoop;

use crate::constrained::{G, is_orthonormal};
use crate::local::{WALKER, pose};
use crate::refused::Swing;
use crate::{TOLERANCE, assert_spectrum, oscillations};

/// A sphere that rolls down a slope without slipping, held by a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(x, phi)]
#[lagrangian(m/2*x_dot^2 + 2/5*m*a^2/2*phi_dot^2 + m*g*sin(0.3)*x - k/2*x^2)]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
pub(crate) struct RollingSphere {
    pub(crate) m: f64,
    pub(crate) a: f64,
    pub(crate) g: f64,
    pub(crate) k: f64,
}

#[test]
fn the_bead_on_a_hoop_leaves_the_bottom_where_the_hoop_turns_fast() {
    let (g, r) = (9.81, 0.4);
    let critical = (g / r).sqrt();
    for (part, stability) in [(0.99, Stability::Undecided), (1.01, Stability::Unstable)] {
        let bead = BeadOnHoop { r, g, omega: part * critical };
        let near = bead.linearize(&State::at_rest([0.0]), &[]).unwrap();
        assert_eq!(near.stability(), Ok(stability), "at {part} of the critical rate");
    }
    let bead = BeadOnHoop { r, g, omega: 1.5 * critical };
    let found = bead.equilibrium(&State::at_rest([0.8]), &[]).unwrap();
    let theta = found.state.q[0];
    assert!((theta.cos() - 1.0 / 2.25).abs() < 1e-15, "{theta}");
    let frequency = bead.linearize(&found.state, &[]).unwrap().natural_frequencies().unwrap()[0];
    assert!((frequency - bead.omega * theta.sin()).abs() < 1e-14);
}

/// The second constraint says nothing new where the first one holds.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
#[constraint(again: (2 + x)*(x^2 + y^2 - l^2) = 0)]
struct Overdetermined {
    m: f64,
    g: f64,
    l: f64,
}

#[test]
fn constraints_that_depend_on_one_another_count_once() {
    let system = Overdetermined { m: 3.0, g: G, l: 0.7 };
    let near = system.linearize(&State::at_rest([0.0, -0.7]), &[]).unwrap();
    assert_spectrum(&near.eigenvalues().unwrap(), &oscillations(&[(G / 0.7_f64).sqrt()]), TOLERANCE);
    let jacobian = system.jacobian(&State::at_rest([0.0, -0.7])).unwrap();
    assert_eq!(jacobian.solution.rank, 1);

    // Of the multipliers that carry the bob, 2 y (λ₀ + (2 + x) λ₁) = m g, those of least norm: each row has half of the force.
    let found = system.equilibrium(&State::at_rest([0.2, -0.6]), &[]).unwrap();
    let [x, y]: [f64; 2] = found.state.q.into();
    assert!(x.abs() < 1e-15 && (y + 0.7).abs() < 1e-15, "{x} {y}");
    for (lambda, part) in found.multipliers.iter().zip([0.5, 0.25]) {
        let expected = -part * 3.0 * G / 1.4;
        assert!((lambda - expected).abs() < 1e-13 * G, "{lambda} {expected}");
    }
}

/// Two links in a wind that pushes the lower bob, with friction of the air, in angles …
#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[define(first = l[0]*[sin(a), -cos(a)])]
#[define(second = first + l[1]*[sin(b), -cos(b)])]
#[lagrangian(m[0]/2*dot(der(first), der(first)) + m[1]/2*dot(der(second), der(second))
    - g*(m[0]*first[1] + m[1]*second[1]))]
#[dissipation(c/2*(dot(der(first), der(first)) + dot(der(second), der(second))))]
#[force(a: wind*l[0]*cos(a))]
#[force(b: wind*l[1]*cos(b))]
struct Angles {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
    c: f64,
    wind: f64,
}

/// … and in Cartesian coordinates.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[lagrangian(m[0]/2*dot(r_dot, r_dot) + m[1]/2*dot(s_dot, s_dot) - g*(m[0]*r[1] + m[1]*s[1]))]
#[constraint(upper: dot(r, r) = l[0]^2)]
#[constraint(lower: dot(s - r, s - r) = l[1]^2)]
#[dissipation(c/2*(dot(r_dot, r_dot) + dot(s_dot, s_dot)))]
#[force(s: [wind, 0])]
struct Cartesian {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
    c: f64,
    wind: f64,
}

/// Where the wind holds the links at an angle, both have one spectrum, and pass the wind on alike.
#[test]
fn angles_and_cartesian_coordinates_give_one_spectrum() {
    let (m, l, g, c, wind) = ([1.0, 0.6], [0.8, 0.5], G, 0.4, 3.0);
    let angles = Angles { m, l, g, c, wind };
    let cartesian = Cartesian { m, l, g, c, wind };
    let by_angles = angles.equilibrium(&State::at_rest([0.1, 0.1]), &[]).unwrap();
    let guess = State::at_rest([0.1, -0.7, 0.2, -1.2]);
    let by_place = cartesian.equilibrium(&guess, &["r", "s"]).unwrap();
    // tan a = wind/((m₀ + m₁) g), tan b = wind/(m₁ g).
    let [a, b] = [(wind / (1.6 * G)).atan(), (wind / (0.6 * G)).atan()];
    assert!((by_angles.state.q - State::at_rest([a, b]).q).amax() < 1e-15);
    assert!((by_place.state.q[0] - 0.8 * a.sin()).abs() < 1e-15);
    assert!((by_place.state.q[3] + 0.8 * a.cos() + 0.5 * b.cos()).abs() < 1e-15);
    let near = angles.linearize(&by_angles.state, &["wind"]).unwrap();
    let on_manifold = cartesian.linearize(&by_place.state, &["wind"]).unwrap();
    assert_eq!(on_manifold.a.shape(), (4, 4));
    is_orthonormal(&on_manifold.basis);
    let expected = near.eigenvalues().unwrap();
    assert!(expected.iter().all(|s| s.re < -0.1 && s.im.abs() > 1.0), "{expected:?}");
    assert_spectrum(&on_manifold.eigenvalues().unwrap(), &expected, TOLERANCE);
    // The horizontal acceleration of the lower bob for a unit of wind.
    let lower = l[0] * a.cos() * near.b[(2, 0)] + l[1] * b.cos() * near.b[(3, 0)];
    assert!(((&on_manifold.basis * &on_manifold.b)[6] - lower).abs() < 1e-14);
}

/// A velocity constraint takes one degree of freedom away from the state: here x − a φ stays what it is.
#[test]
fn a_sphere_that_rolls_on_a_spring() {
    let system = RollingSphere { m: 2.0, a: 0.1, g: 0.0, k: 5.0 };
    let near = system.linearize(&State::at_rest([0.0, 1.0]), &[]).unwrap();
    assert_eq!(near.a.shape(), (3, 3));
    let mut expected = oscillations(&[(5.0 / (7.0 / 5.0 * 2.0_f64)).sqrt()]);
    expected.push(Complex::from(0.0));
    assert_spectrum(&near.eigenvalues().unwrap(), &expected, TOLERANCE);
}

/// A potential turned by π, so that round-off is all that is left of the force at θ = 0.
#[test]
fn what_rests_already_is_found_to_rest() {
    let turned = Swing { g: -1.0, phase: PI };
    let found = turned.equilibrium(&State::at_rest([0.0]), &[]).unwrap();
    assert!(found.state.q[0].abs() < 1e-15, "{:?}", found.state.q);
    let again = turned.equilibrium(&found.state, &[]).unwrap();
    assert!(again.state.q[0].abs() < 1e-15, "{:?}", again.state.q);
}

/// A quartic well, at whose place the Jacobian vanishes.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - (x - place)^4)]
struct Quartic {
    place: f64,
}

/// Convergence is slow, but to the point. About zero, neither the place nor the stiffness gives a unit of length.
#[test]
fn a_flat_equilibrium_is_found_from_any_distance() {
    for (place, start, tolerance) in
        [(1.0, 2.0, 1e-12), (0.0, 1e-9, 1e-19), (0.0, 1.0, 1e-10), (0.0, 1e9, 1e-1)]
    {
        let x = Quartic { place }.equilibrium(&State::at_rest([start]), &[]).unwrap().state.q[0] - place;
        assert!(x.abs() < tolerance, "{x:e} from {start:e}");
    }
}

/// A chain of rods in Cartesian coordinates.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [4], y: [4])]
#[lagrangian(sum(i in 0..4, m/2*(x_dot[i]^2 + y_dot[i]^2) - m*g*y[i]))]
#[constraint(rod[0]: x[0]^2 + y[0]^2 - l^2 = 0)]
#[constraint(rod[i in 1..4]: (x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 - l^2 = 0)]
struct Rods {
    m: f64,
    g: f64,
    l: f64,
}

/// A chain of a micrometre hangs like one of a thousand kilometres, and both are found alike, from far off.
#[test]
fn the_search_does_not_depend_on_units() {
    for (length, mass) in [(1e-6, 1e-9), (1.0, 1.0), (1e6, 1e9)] {
        let rods = Rods { m: mass, g: 9.81, l: length };
        let guess = [0.5, 1.2, 1.4, 1.9, -0.7, -1.1, -2.3, -2.8].map(|x| x * length);
        let found = rods.equilibrium(&State::at_rest(guess), &[]).unwrap();
        println!("{length:e} m: {} steps", found.iterations);
        for i in 0..4 {
            let depth = found.state.q[4 + i] / length;
            assert!(found.state.q[i].abs() < 1e-14 * length, "x[{i}] = {}", found.state.q[i]);
            assert!((depth + i as f64 + 1.0).abs() < 1e-14, "y[{i}] = {depth} l");
            // −2 λ l carries the bobs below.
            let carried = -2.0 * found.multipliers[i] * length / (mass * 9.81);
            assert!((carried - (4 - i) as f64).abs() < 1e-12, "rod {i} carries {carried}");
        }
        // What is found is found again from there.
        let again = rods.equilibrium(&found.state, &[]).unwrap().state;
        assert!((again.q - found.state.q).amax() < 1e-14 * length, "{:?}", again.q - found.state.q);
    }
}

/// Two weights on one spring cannot both be held by its stretch.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[force(x: k*s - f[0])]
#[force(y: k*s - f[1])]
struct Shared {
    k: f64,
    s: f64,
    f: [f64; 2],
}

#[test]
fn forces_that_cannot_balance_are_told_from_round_off_in_any_unit() {
    for (k, f) in [(1e3, 1e-9), (1.0, 1.0), (1e-3, 1e9), (1.0, 1e-14)] {
        for s in [0.0, 1.5 * f / k, 100.0 * f / k] {
            let shared = Shared { k, s, f: [f, 2.0 * f] };
            let found = shared.equilibrium(&State::at_rest([0.0; 2]), &["s"]);
            assert!(matches!(found, Err(Error::NoEquilibrium { .. })), "k = {k:e}, f = {f:e}: {found:?}");
            // Where they can, they do.
            let found = Shared { f: [f, f], ..shared }.equilibrium(&State::at_rest([0.0; 2]), &["s"]);
            let stretch = found.unwrap().system.s;
            assert!((stretch * k / f - 1.0).abs() < 1e-15, "k = {k:e}, f = {f:e}: {stretch:e}");
        }
    }
}

/// A is the rate at which changes of the moving state grow: that of the map to times shortly before and after.
#[test]
fn changes_of_a_moving_state_grow_by_it() {
    let state = pose().state();
    let near = WALKER.linearize_locally(&state, &["torque"]).unwrap();
    let here = WALKER.local_coordinates(&state).unwrap();
    let map = |h: f64| {
        let mut walker = DiscreteTime::new(WALKER, Dop853::with_tolerance(1e-14), &["torque"]).unwrap();
        walker.advance(&state, h).unwrap();
        let there = WALKER.local_coordinates(walker.state()).unwrap();
        (there.inverse() * walker.a() * here.basis(), there.inverse() * walker.b())
    };
    let steps = [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)].map(|(k, c)| (k * 2e-3, c / 2e-3));
    let rate = |of: &dyn Fn(f64) -> DMatrix<f64>| {
        steps.into_iter().map(|(h, c)| (of(h) - of(-h)) * c).reduce(|a, b| a + b).unwrap()
    };
    let off = (rate(&|h| map(h).0) - &near.a).amax();
    assert!(off < 1e-8 * near.a.amax(), "A is off by {off:e} of {:e}", near.a.amax());
    let off = (rate(&|h| map(h).1) - &near.b).amax();
    assert!(off < 1e-8 * near.b.amax(), "B is off by {off:e} of {:e}", near.b.amax());
}
