//! Multipliers are printed as functions of the state, by the sign of M q̈ = h + Fᵀλ.
//!
//! Each printed line is compared with multipliers that numbers alone solve for, at random states on the constraints.

use super::everywhere::check;
use super::forms::check_forms;
use super::systems::System;

/// Systems, each with lines that must stand on its printed page.
#[rustfmt::skip]
const ENTRIES: &[(&str, &[&str])] = &[
    // Milton (8.10): friction points up the incline.
    (
        "#[coordinates(x, phi)] #[define(I = 2/5*m*a^2)]
         #[lagrangian(m/2*x_dot^2 + I/2*phi_dot^2 + m*g*x*sin(alpha))] #[constraint(rolling: x_dot - a*phi_dot = 0)]
         struct SphereDownIncline { m: f64, a: f64, g: f64, alpha: f64 }",
        &["λ_rolling = −2/7 m g sin α"],
    ),
    // Milton (8.20): the string replaces r² in the denominator.
    (
        "#[coordinates(r: [3])] #[lagrangian(m/2*dot(r_dot, r_dot) - m*g*r[2])] #[constraint(string: (dot(r, r) - l^2)/2 = 0)]
         struct BobOnString { m: f64, g: f64, l: f64 }",
        &["λ_string = m (g r[2] − ṙ·ṙ)/l²"],
    ),
    // Atwood's machine with a movable pulley; all terms of λ are negative.
    (
        "#[coordinates(x, y)] #[lagrangian(m/2*x_dot^2 + M/2*y_dot^2 + g*(m*x + M*y))] #[constraint(rope: x + 2*y = l)]
         struct MovablePulley { m: f64, M: f64, g: f64, l: f64 }",
        &["λ_rope = −3 g m M/(4 m + M)"],
    ),
    // A bead on a parabola, and a knife edge.
    (
        "#[coordinates(x, z)] #[lagrangian(m/2*(x_dot^2 + z_dot^2) - m*g*z)] #[constraint(wire: z = b*x^2)]
         struct BeadOnParabola { m: f64, g: f64, b: f64 }",
        &["λ_wire = m (2 b ẋ² + g)/(1 + 4 b² x²)"],
    ),
    (
        "#[coordinates(x, y, theta)] #[lagrangian(m/2*(x_dot^2 + y_dot^2) + J/2*theta_dot^2)]
         #[constraint(blade: x_dot*sin(theta) = y_dot*cos(theta))]
         struct KnifeEdge { m: f64, J: f64 }",
        &["λ_blade = −m (ẋ cos θ + ẏ sin θ) θ̇"],
    ),
    // Three components by one vector, and two constraints that act on one body.
    (
        "#[coordinates(r: [3])] #[lagrangian(m/2*dot(r_dot, r_dot) + m*dot(g, r))] #[constraint(held: r = a)]
         struct HeldMass { m: f64, g: [f64; 3], a: [f64; 3] }",
        &["λ_held = −m g"],
    ),
    (
        "#[coordinates(x, y, z)] #[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
         #[constraint(wall: x = 0)] #[constraint(slope: z = k*y)]
         struct BeadInGroove { m: f64, g: f64, k: f64 }",
        &["λ_wall = 0", "λ_slope = m g/(k² + 1)"],
    ),
];

#[test]
fn multipliers_are_functions_of_the_state() {
    check_forms(ENTRIES);
    for (source, _) in ENTRIES {
        check(&System::new(source.parse().expect("tokens")).expect("a system"));
    }
}

/// Where contacts open, where M has no inverse, and where constraints depend on each other once they hold, λ has no formula.
#[test]
fn multipliers_without_a_formula_are_not_printed() {
    for source in [
        "#[coordinates(z)] #[lagrangian(m/2*z_dot^2 - m*g*z)] #[contact(floor: z >= 0, restitution: e)]
         struct Bouncing { m: f64, g: f64, e: f64, floor: Contact }",
        "#[coordinates(x, y)] #[lagrangian(m/2*x_dot^2 - y)] #[constraint(tied: y = x)] struct Massless { m: f64 }",
        "#[coordinates(x, y, z)] #[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2))]
         #[constraint(sphere: a*(x^2 + y^2 + z^2 - l^2) = 0)] #[constraint(also: b*(x*x_dot + y*y_dot + z*z_dot) = 0)]
         struct Twice { m: f64, a: f64, b: f64, l: f64 }",
    ] {
        let system = System::new(source.parse().expect("tokens")).unwrap_or_else(|| panic!("{source}"));
        assert_eq!(system.derived.multipliers, None, "{source}");
    }
}
