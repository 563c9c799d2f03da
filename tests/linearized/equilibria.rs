//! Where systems rest, and what holds them there.

use lagrange_core::nalgebra::Vector2;
use lagrange_core::{linearized::Stability, prelude::*};

use crate::TOP;

/// Two bobs between two hinges on three equal rods: the arch of a hanging bridge.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[lagrangian(m/2*(dot(r_dot, r_dot) + dot(s_dot, s_dot)) - m*g*(r[1] + s[1]))]
#[constraint(left: dot(r, r) = l^2)]
#[constraint(middle: dot(s - r, s - r) = l^2)]
#[constraint(right: (s[0] - d)^2 + s[1]^2 = l^2)]
struct Bridge {
    m: f64,
    g: f64,
    l: f64,
    d: f64,
}

/// With hinges two rods apart the outer rods hang at 60°: their tension is m g/sin 60° = −2 λ l.
#[test]
fn a_bridge_hangs_at_sixty_degrees() {
    let bridge = Bridge { m: 2.0, g: 9.81, l: 1.5, d: 3.0 };
    let found = bridge.equilibrium(&State::at_rest([0.5, -1.0, 2.4, -1.0]), &[]).unwrap();
    let depth = 1.5 * 0.75_f64.sqrt();
    let expected = State::at_rest([0.75, -depth, 2.25, -depth]);
    assert!((found.state.q - expected.q).amax() < 1e-15, "{:?}", found.state.q);
    let tension = 2.0 * 9.81 / 0.75_f64.sqrt();
    let multipliers = [tension / 3.0, tension / 6.0, tension / 3.0].map(|x| -x);
    assert!((found.multipliers - bridge.solve(&expected).unwrap().multipliers).amax() < 1e-13);
    for (found, expected) in found.multipliers.iter().zip(multipliers) {
        assert!((found - expected).abs() < 1e-14 * tension, "{found} {expected}");
    }
    assert!(found.undetermined().is_empty());
    assert!(found.iterations < 12, "{}", found.iterations);
    // The same from below upwards: an arch, unstable.
    let arch = bridge.equilibrium(&State::at_rest([0.5, 1.2, 2.4, 1.2]), &[]).unwrap();
    assert!((arch.state.q[1] - depth).abs() < 1e-15);
    let stability = |found: &State<f64, 4>| bridge.linearize(found, &[]).unwrap().stability();
    assert_eq!(stability(&arch.state), Ok(Stability::Unstable));
    assert_eq!(stability(&found.state), Ok(Stability::Undecided));
}

/// A rotorcraft in a plane, two rotors at the ends of its arms, wind from the side.
#[derive(Clone, Lagrangian)]
#[coordinates(x, z, pitch)]
#[lagrangian(m/2*(x_dot^2 + z_dot^2) + inertia/2*pitch_dot^2 - m*g*z)]
#[force(x: -(thrust[0] + thrust[1])*sin(pitch) + wind)]
#[force(z: (thrust[0] + thrust[1])*cos(pitch))]
#[force(pitch: arm*(thrust[1] - thrust[0]))]
struct Rotorcraft {
    m: f64,
    inertia: f64,
    arm: f64,
    g: f64,
    wind: f64,
    thrust: Vector2<f64>,
}

#[test]
fn a_rotorcraft_leans_into_the_wind() {
    let craft = Rotorcraft { m: 0.5, inertia: 0.01, arm: 0.2, g: 9.81, wind: 1.0, thrust: Vector2::zeros() };
    let guess = State::at_rest([2.0, 3.0, 0.0]);
    let found = craft.equilibrium(&guess, &["pitch", "thrust"]).unwrap();
    let weight = 0.5 * 9.81;
    assert!((found.state.q[2] - (1.0 / weight).atan()).abs() < 1e-15);
    for thrust in &found.system.thrust {
        assert!((thrust - weight.hypot(1.0) / 2.0).abs() < 1e-14);
    }
    assert_eq!((found.state.q[0], found.state.q[1]), (2.0, 3.0));
    assert!(found.undetermined().is_empty());
    assert_eq!(craft.thrust, Vector2::zeros());
    // The thrusts enter as one force and one torque.
    let near = found.system.linearize(&found.state, &["thrust"]).unwrap();
    assert_eq!(near.inputs(), ["thrust[0]", "thrust[1]"]);
    let (sine, cosine) = found.state.q[2].sin_cos();
    let column = [0.0, 0.0, 0.0, -sine / 0.5, cosine / 0.5, -0.2 / 0.01];
    assert!(near.b.column(0).iter().zip(column).all(|(b, x)| (b - x).abs() < 1e-13));
    // Anywhere will do: with all sought, the place stays where the search began, and is said to be free.
    let anywhere = craft.equilibrium(&guess, &["x", "z", "pitch", "thrust"]).unwrap();
    assert_eq!((anywhere.state.q[0], anywhere.state.q[1]), (2.0, 3.0));
    assert_eq!(anywhere.undetermined(), ["x", "z"]);
}

/// m g l = φ̇ (I₃ (ψ̇ + φ̇ cos θ) − I₁ φ̇ cos θ) (Goldstein, *Classical Mechanics*, 5.7).
#[test]
fn a_top_precesses_steadily_at_an_angle() {
    let top = &TOP;
    let (precession, spin) = (2.0, 15.0);
    let guess = State::new([0.3, 1.0, 0.2], [precession, 0.0, spin]);
    let found = top.equilibrium(&guess, &[]).unwrap();
    let cosine = (1.2 * 9.81 * 0.25 / precession - 0.1 * spin) / ((0.1 - 0.3) * precession);
    assert!((found.state.q[1].cos() - cosine).abs() < 1e-14);
    assert_eq!(found.undetermined(), ["phi", "psi"]);
    let accelerations = top.solve(&found.state).unwrap().accelerations;
    assert!(accelerations.amax() < 1e-13, "{accelerations:?}");
}

/// The place of a quartic well, where the Jacobian vanishes: convergence is slow, but to the point.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - (x - 1)^4)]
struct QuarticWell;

#[test]
fn an_equilibrium_without_stiffness_is_found_as_far_as_it_can_be_told() {
    let found = QuarticWell.equilibrium(&State::at_rest([2.0]), &[]).unwrap();
    let x = found.state.q[0] - 1.0;
    println!("x − 1 = {x:e} after {} steps", found.iterations);
    assert!(x.abs() < 1e-12, "{x:e}");
}

/// The floor, and a carpet that says the same on it.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(m/2*dot(r_dot, r_dot) - m*g*r[1])]
#[constraint(floor: r[1] = 0)]
#[constraint(carpet: r[1]*(2 + r[0]) = 0)]
struct OnTheFloor {
    m: f64,
    g: f64,
}

/// Of the forces that share the weight, λ₀ + (2 + x) λ₁ = m g, those of least norm.
#[test]
fn dependent_constraints_share_the_load() {
    let found = OnTheFloor { m: 1.0, g: 10.0 }.equilibrium(&State::at_rest([1.0, 0.5]), &[]).unwrap();
    let [x, y]: [f64; 2] = found.state.q.into();
    assert!(y.abs() < 1e-15 && (x - 1.0).abs() < 0.1, "{x} {y}");
    let share = 10.0 / (1.0 + (2.0 + x).powi(2));
    for (lambda, expected) in found.multipliers.iter().zip([share, (2.0 + x) * share]) {
        assert!((lambda - expected).abs() < 1e-13, "{lambda} {expected}");
    }
    assert_eq!(found.undetermined(), ["r[0]"]);
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

/// A potential turned by π, so that round-off is all that is left of the force at θ = 0.
#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 - cos(theta + 3.141592653589793))]
struct Turned;

#[test]
fn what_rests_already_is_found_to_rest() {
    let found = Turned.equilibrium(&State::at_rest([0.0]), &[]).unwrap();
    assert!(found.state.q[0].abs() < 1e-15, "{:?}", found.state.q);
    let again = Turned.equilibrium(&found.state, &[]).unwrap();
    assert!(again.state.q[0].abs() < 1e-15, "{:?}", again.state.q);
}

/// A quartic well about zero, where neither the place nor the stiffness gives a unit of length.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^4)]
struct Quartic;

#[test]
fn a_flat_equilibrium_at_zero_is_found_from_any_distance() {
    for start in [1e-9, 1.0, 1e9] {
        let x = Quartic.equilibrium(&State::at_rest([start]), &[]).unwrap().state.q[0];
        assert!(x.abs() < 1e-10 * start, "{x:e} from {start:e}");
    }
}
