//! The momentum and the angular momentum of several bodies stand among what is conserved, where L and the forces depend on
//! differences and distances alone.

use super::everywhere::check;
use super::forms::check_forms;
use super::systems::System;

/// Systems, each with lines that must stand on its printed page.
#[rustfmt::skip]
const ENTRIES: &[(&str, &[&str])] = &[
    (
        "#[coordinates(r1: [3], r2: [3])]
         #[lagrangian(m1/2*dot(r1_dot, r1_dot) + m2/2*dot(r2_dot, r2_dot) + G*m1*m2/norm(r1 - r2))]
         struct TwoStars { m1: f64, m2: f64, G: f64 }",
        &["P = m₁ ṙ₁ + m₂ ṙ₂", "J = m₁ (r₁×ṙ₁) + m₂ (r₂×ṙ₂)"],
    ),
    // A spring with a damper between the masses.
    (
        "#[coordinates(a: [3], b: [3])] #[dissipation(c/2*dot(a_dot - b_dot, a_dot - b_dot))]
         #[lagrangian(m/2*(dot(a_dot, a_dot) + dot(b_dot, b_dot)) - k/2*(norm(a - b) - l)^2)]
         struct DampedMolecule { m: f64, k: f64, l: f64, c: f64 }",
        &["P = m ȧ + m ḃ"],
    ),
    // The centre is fixed; one body alone has the momentum of its coordinates.
    (
        "#[coordinates(r: [3])] #[lagrangian(m/2*dot(r_dot, r_dot) + k/norm(r))] struct CentralForce { m: f64, k: f64 }",
        &["J = m (r×ṙ)"],
    ),
    // Milton (8.16): the weight leaves the component along it.
    (
        "#[coordinates(r: [3])] #[lagrangian(m/2*dot(r_dot, r_dot) - m*g*r[2])] #[constraint(string: dot(r, r) = l^2)]
         struct BobOnString { m: f64, g: f64, l: f64 }",
        &["J[2] = m (r[0] ṙ[1] − r[1] ṙ[0])"],
    ),
    // A rod between two bodies that fall: its force has no moment.
    (
        "#[coordinates(a: [3], b: [3])] #[constraint(rod: norm(a - b) = l)]
         #[lagrangian(m/2*(dot(a_dot, a_dot) + dot(b_dot, b_dot)) - m*g*(a[2] + b[2]))]
         struct FallingRod { m: f64, g: f64, l: f64 }",
        &["P[0] = m ȧ[0] + m ḃ[0]", "P[1] = m ȧ[1] + m ḃ[1]"],
    ),
    // In a plane the angular momentum is a number.
    (
        "#[coordinates(a: [2], b: [2])] #[lagrangian(m/2*(dot(a_dot, a_dot) + dot(b_dot, b_dot)) - k/2*dot(a - b, a - b))]
         struct PlaneMolecule { m: f64, k: f64 }",
        &["P = m ȧ + m ḃ", "J = m (a[0] ȧ[1] + b[0] ḃ[1] − a[1] ȧ[0] − b[1] ḃ[0])"],
    ),
    // An angular momentum of more than a line is a sum of named momenta. The field P leaves another letter to the momentum.
    (
        "#[coordinates(r1: [3], r2: [3], r3: [3], r4: [3])]
         #[lagrangian(m1/2*dot(r1_dot, r1_dot) + m2/2*dot(r2_dot, r2_dot) + m3/2*dot(r3_dot, r3_dot) + m4/2*dot(r4_dot, r4_dot)
             + a*dot(r1_dot, r2_dot) + b*dot(r2_dot, r3_dot) + c*dot(r3_dot, r4_dot) + P*dot(r4_dot, r1_dot) + d*dot(r1_dot, r3_dot))]
         #[force(r1: r2 - r1)] #[force(r2: r1 - r2)]
         struct CoupledMasses { m1: f64, m2: f64, m3: f64, m4: f64, a: f64, b: f64, c: f64, d: f64, P: f64 }",
        &["J = r₁×p_r₁ + r₂×p_r₂ + r₃×p_r₃ + r₄×p_r₄"],
    ),
];

#[test]
fn bodies_have_a_common_momentum_and_angular_momentum() {
    check_forms(ENTRIES);
    for (source, _) in ENTRIES {
        check(&System::new(source.parse().expect("tokens")).expect("a system"));
    }
}

/// Forces from outside, and places in space, break the symmetry.
#[test]
fn bodies_that_space_acts_on_have_none() {
    for source in [
        "#[coordinates(a: [3], b: [3])] #[lagrangian(m/2*(dot(a_dot, a_dot) + dot(b_dot, b_dot)) - k/2*dot(a - b, a - b) - a[0]^2*b[1]*b[2])]
         struct InField { m: f64, k: f64 }",
        "#[coordinates(a: [3], b: [3])] #[lagrangian(m/2*(dot(a_dot, a_dot) + dot(b_dot, b_dot)) - k/2*dot(a - b, a - b))]
         #[force(a: -c*a_dot)] struct Dragged { m: f64, k: f64, c: f64 }",
    ] {
        let system = System::new(source.parse().expect("tokens")).unwrap_or_else(|| panic!("{source}"));
        let names: Vec<_> = system.derived.facts.conserved.iter().map(|conserved| &*conserved.name).collect();
        assert!(!names.iter().any(|name| name.contains("momentum")), "{names:?} of {source}");
    }
}
