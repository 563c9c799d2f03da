//! Terms of L that depend on velocities beside bodies in frames: Lorentz forces on points of bodies, gyroscopic terms, Weber's
//! potential.
//!
//! Each system is also read back at random states: `everywhere` finds the systems in this file. It takes the derivatives of
//! definitions and potentials from differences.

use super::forms::check_forms;

/// Systems, each with lines that must stand on its printed page.
#[rustfmt::skip]
const POTENTIALS: &[(&str, &[&str])] = &[
    // A charge at the tip of a double pendulum, in a homogeneous field.
    (
        "#[coordinates(a, b, c, d)]
         #[frame(upper: rotate_x(a), rotate_y(b))] #[frame(lower in upper: translate([0, 0, -l]), rotate_x(c), rotate_y(d))]
         #[define(s = position(lower, p))] #[define(A = cross(B, s)/2)]
         #[lagrangian(kinetic(upper, m1, c1, I1) + kinetic(lower, m2, c2, I2) - m1*g*position(upper, c1)[2] - m2*g*position(lower, c2)[2] + e*dot(A, der(s)))]
         struct ChargeOnDoublePendulum { m1: f64, m2: f64, g: f64, l: f64, e: f64, B: Vector3<f64>, p: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "F_lower·(∂ṙ_lower/∂ċ) + N_lower·(∂ω_lower/∂ċ) = (e (ṡ×B))·(∂s/∂c)",
            "F_lower = m₂ (r̈_lower + [0, 0, g])",
            "E = ½ m₁ ṙ_upper·ṙ_upper + ½ ω_upper·(I₁ ω_upper) + ½ m₂ ṙ_lower·ṙ_lower + ½ ω_lower·(I₂ ω_lower) + m₁ g r_upper[2] + m₂ g r_lower[2]",
        ],
    ),
    // The field is that of a magnet, and rises; v has a name.
    (
        "#[coordinates(a, b, c, d)]
         #[frame(upper: rotate_x(a), rotate_y(b))] #[frame(lower in upper: translate([0, 0, -l]), rotate_x(c), rotate_y(d))]
         #[define(s = position(lower, p))] #[define(v = express(velocity(lower, p), fixed))] #[define(A = t*cross(B, s)/(2*norm(s)^3))]
         #[lagrangian(kinetic(upper, m1, c1, I1) + kinetic(lower, m2, c2, I2) - m1*g*position(upper, c1)[2] - m2*g*position(lower, c2)[2] + e*dot(A, v))]
         struct ChargeInRisingField { m1: f64, m2: f64, g: f64, l: f64, e: f64, B: Vector3<f64>, p: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "F_lower·(∂ṙ_lower/∂ċ) + N_lower·(∂ω_lower/∂ċ) = −(e Ȧ)·(∂s/∂c) + (e v)·(∂A/∂c)",
            "d/dt E = −(e v)·(∂A/∂t)",
        ],
    ),
    // Magnetic moments of bodies that are charged like their masses, in a homogeneous field.
    (
        "#[coordinates(a, b, c, d)]
         #[frame(upper: rotate_x(a), rotate_y(b))] #[frame(lower in upper: translate([0, 0, -l]), rotate_x(c), rotate_y(d))]
         #[define(n = express(vector(fixed, B), lower))]
         #[lagrangian(kinetic(upper, m1, c1, I1) + kinetic(lower, m2, c2, I2) - m1*g*position(upper, c1)[2] - m2*g*position(lower, c2)[2] + e*dot(n, I2*angular_velocity(lower)))]
         struct ChargedRodInFrames { m1: f64, m2: f64, g: f64, l: f64, e: f64, B: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "F_lower·(∂ṙ_lower/∂ċ) + N_lower·(∂ω_lower/∂ċ) = d/dt (∂V/∂ċ) − ∂V/∂c",
            "V = ½ m₁ ṙ_upper·ṙ_upper + ½ ω_upper·(I₁ ω_upper) + ½ m₂ ṙ_lower·ṙ_lower + ½ ω_lower·(I₂ ω_lower) − m₁ g r_upper[2] − m₂ g r_lower[2] − L",
        ],
    ),
    // The magnetic top.
    (
        "#[coordinates(phi, theta, psi)] #[frame(top: rotate_z(phi), rotate_x(theta), rotate_z(psi))]
         #[lagrangian(kinetic(top, m, centre, inertia) - m*g*position(top, centre)[2] + gamma*dot(express(vector(fixed, B), top), inertia*angular_velocity(top)))]
         struct MagneticTop { m: f64, g: f64, gamma: f64, B: Vector3<f64>, centre: Vector3<f64>, inertia: Matrix3<f64> }",
        &[
            "F_top·(∂ṙ_top/∂ψ̇) + N_top[2] = d/dt (∂V/∂ψ̇) − ∂V/∂ψ",
        ],
    ),
    // A rotor in the lower body, by its spin alone, and a velocity-dependent potential of coordinates.
    (
        "#[coordinates(a, b, c, d)]
         #[frame(upper: rotate_x(a), rotate_y(b))] #[frame(lower in upper: translate([0, 0, -l]), rotate_x(c), rotate_y(d))]
         #[lagrangian(kinetic(upper, m1, c1, I1) + kinetic(lower, m2, c2, I2) - m1*g*position(upper, c1)[2] - m2*g*position(lower, c2)[2] + dot(h, angular_velocity(lower)) + k*a*c*b_dot)]
         #[force(d: -mu*d_dot)]
         struct RotorInPendulum { m1: f64, m2: f64, g: f64, l: f64, k: f64, mu: f64, h: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "F_upper·(∂ṙ_upper/∂ȧ) + N_upper·(∂ω_upper/∂ȧ) + F_lower·(∂ṙ_lower/∂ȧ) + N_lower·(∂ω_lower/∂ȧ) = k c ḃ + (h×ω_lower)·(∂ω_lower/∂ȧ)",
        ],
    ),
    // Weber's potential between points of two bodies.
    (
        "#[coordinates(a, b, c, d)]
         #[frame(one: rotate_x(a), rotate_y(b))] #[frame(two: translate(o), rotate_x(c), rotate_y(d))]
         #[define(rho = norm(position(two, p2) - position(one, p1)))]
         #[lagrangian(kinetic(one, m1, c1, I1) + kinetic(two, m2, c2, I2) - m1*g*position(one, c1)[2] - m2*g*position(two, c2)[2] - k/rho*(1 + der(rho)^2/(2*u^2)))]
         struct WeberPendulums { m1: f64, m2: f64, g: f64, k: f64, u: f64, o: Vector3<f64>, p1: Vector3<f64>, p2: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "F_one·(∂ṙ_one/∂ȧ) + N_one·(∂ω_one/∂ȧ) = (k ρ̈/(u² ρ) + k/ρ² − k ρ̇²/(2 u² ρ²)) (∂ρ/∂a)",
        ],
    ),
    // Without definitions, in a frame that moves.
    (
        "#[coordinates(a, b, c, d)]
         #[frame(base: translate([h*sin(w*t), 0, 0]))] #[frame(upper in base: rotate_x(a), rotate_y(b))] #[frame(lower in upper: translate([0, 0, -l]), rotate_x(c), rotate_y(d))]
         #[lagrangian(kinetic(upper, m1, c1, I1) + kinetic(lower, m2, c2, I2) - m1*g*position(upper, c1)[2] - m2*g*position(lower, c2)[2] + e/2*dot(cross(B, position(lower, p)), der(position(lower, p))))]
         struct ChargeWithoutNames { m1: f64, m2: f64, g: f64, l: f64, h: f64, w: f64, e: f64, B: Vector3<f64>, p: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "d/dt E = −m₁ ṙ_upper·(∂ṙ_upper/∂t) − m₂ ṙ_lower·(∂ṙ_lower/∂t) + ∂V/∂t",
        ],
    ),
    (
        "#[coordinates(a, b, c, d)]
         #[frame(base: translate([h*sin(w*t), 0, 0]))] #[frame(upper in base: rotate_x(a), rotate_y(b))] #[frame(lower in upper: translate([0, 0, -l]), rotate_x(c), rotate_y(d))]
         #[define(s = position(lower, p))]
         #[lagrangian(kinetic(upper, m1, c1, I1) + kinetic(lower, m2, c2, I2) - m1*g*position(upper, c1)[2] - m2*g*position(lower, c2)[2] + e/2*dot(cross(B, s), der(s)) + e*dot(E, s))]
         struct ChargeOnShakenPendulum { m1: f64, m2: f64, g: f64, l: f64, h: f64, w: f64, e: f64, B: Vector3<f64>, E: Vector3<f64>, p: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "F_lower·(∂ṙ_lower/∂ċ) + N_lower·(∂ω_lower/∂ċ) = (e (ṡ×B) + e E)·(∂s/∂c)",
            "d/dt ℰ = −m₁ ṙ_upper·(∂ṙ_upper/∂t) − m₂ ṙ_lower·(∂ṙ_lower/∂t) − (½ e (ṡ×B) + e E)·(∂s/∂t) − (½ e (B×s))·(∂ṡ/∂t)",
        ],
    ),
    // A charge on a body that a quaternion turns, with a wheel.
    (
        "#[coordinates(r: [3], q: [4], s)]
         #[frame(body: translate(r), rotate(q))] #[frame(wheel in body: translate(p), rotate_z(s))]
         #[define(x = position(wheel, c))]
         #[lagrangian(kinetic(body, m, [0, 0, 0], I) + kinetic(wheel, M, [0, 0, 0], J) + e/2*dot(cross(B, x), der(x)))]
         struct ChargeOnWheel { m: f64, M: f64, e: f64, B: Vector3<f64>, c: Vector3<f64>, p: Vector3<f64>, I: Matrix3<f64>, J: Matrix3<f64> }",
        &[
            "N_body[0] + F_wheel·(∂ṙ_wheel/∂ω_q[0]) + N_wheel·(∂ω_wheel/∂ω_q[0]) = (e (ẋ×B))·(∂ẋ/∂ω_q[0])",
        ],
    ),
    // The momentum of a cyclic coordinate.
    (
        "#[coordinates(phi, theta, psi)]
         #[frame(top: rotate_z(phi), rotate_x(theta))] #[frame(arm in top: translate(l), rotate_x(psi))]
         #[define(s = position(arm, p))] #[define(A = cross(vector(fixed, [0, 0, B]), s)/2)]
         #[lagrangian(kinetic(top, m1, c1, I1) + kinetic(arm, m2, c2, I2) - m1*g*position(top, c1)[2] - m2*g*position(arm, c2)[2] + e*dot(A, der(s)))]
         struct ChargeOnTop { m1: f64, m2: f64, g: f64, e: f64, B: f64, p: Vector3<f64>, l: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[],
    ),
];

#[test]
fn potentials_of_velocities_beside_bodies_are_printed_by_named_vectors() {
    check_forms(POTENTIALS);
}
