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
