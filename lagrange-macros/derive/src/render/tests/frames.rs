//! Bodies whose frames are turned by angles are printed by forces and torques, in the place of equations that are too long.
//!
//! Each system is also read back at random states: `everywhere` finds the systems in this file. It compares the printed
//! equations with the computed ones, and takes A, ω, r and their derivatives from differences of positions and orientations.

use super::forms::check_forms;
use super::systems::System;

/// Systems, each with lines that must stand on its printed page.
#[rustfmt::skip]
const FRAMES: &[(&str, &[&str])] = &[
    // One body about a fixed point. The last angle turns about an axis of the body.
    (
        "#[coordinates(phi, theta, psi)] #[frame(top: rotate_z(phi), rotate_x(theta), rotate_z(psi))]
         #[lagrangian(kinetic(top, m, centre, inertia) - m*g*position(top, centre)[2])]
         struct HeavyTopByAngles { m: f64, g: f64, centre: Vector3<f64>, inertia: Matrix3<f64> }",
        &[
            "ω_top = [φ̇ sin θ sin ψ + θ̇ cos ψ, φ̇ sin θ cos ψ − θ̇ sin ψ, φ̇ cos θ + ψ̇]",
            "r_top = A_top centre",
            "F_top·(∂ṙ_top/∂φ̇) + N_top·(∂ω_top/∂φ̇) = 0",
            "F_top·(∂ṙ_top/∂ψ̇) + N_top[2] = 0",
            "F_top = m (r̈_top + [0, 0, g])",
            "N_top = inertia ω̇_top + ω_top×(inertia ω_top)",
            "p_φ = m ṙ_top·(∂ṙ_top/∂φ̇) + (inertia ω_top)·(∂ω_top/∂φ̇)",
            "E = ½ m ṙ_top·ṙ_top + ½ ω_top·(inertia ω_top) + m g r_top[2]",
        ],
    ),
    (
        "#[coordinates(a, b, c, d)]
         #[frame(upper: rotate_x(a), rotate_y(b))] #[frame(lower in upper: translate([0, 0, -l]), rotate_x(c), rotate_y(d))]
         #[lagrangian(kinetic(upper, m1, c1, I1) + kinetic(lower, m2, c2, I2) - m1*g*position(upper, c1)[2] - m2*g*position(lower, c2)[2])]
         struct DoublePendulumInSpace { m1: f64, m2: f64, g: f64, l: f64, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "A_upper = [[cos b, 0, sin b], [sin a sin b, cos a, −sin a cos b], [−sin b cos a, sin a, cos a cos b]]",
            "A_lower = A_upper [[cos d, 0, sin d], [sin c sin d, cos c, −sin c cos d], [−sin d cos c, sin c, cos c cos d]]",
            "ω_lower = A_lowerᵀ A_upper ω_upper + [ċ cos d, ḋ, ċ sin d]",
            "r_lower = A_upper [0, 0, −l] + A_lower c₂",
            "F_upper·(∂ṙ_upper/∂ȧ) + N_upper·(∂ω_upper/∂ȧ) + F_lower·(∂ṙ_lower/∂ȧ) + N_lower·(∂ω_lower/∂ȧ) = 0",
            "F_lower·(∂ṙ_lower/∂ḋ) + N_lower[1] = 0",
            "F_lower = m₂ (r̈_lower + [0, 0, g])",
        ],
    ),
    // Centres of mass at rest: torques only.
    (
        "#[coordinates(alpha, beta, gamma)]
         #[frame(outer: rotate_z(alpha))] #[frame(inner in outer: rotate_x(beta))] #[frame(rotor in inner: rotate_z(gamma))]
         #[lagrangian(kinetic(outer, 0, [0, 0, 0], Io) + kinetic(inner, 0, [0, 0, 0], Ii) + kinetic(rotor, 0, [0, 0, 0], Ir))]
         struct GyroscopeInGimbals { Io: Matrix3<f64>, Ii: Matrix3<f64>, Ir: Matrix3<f64> }",
        &[
            "N_outer[2] + N_inner·(∂ω_inner/∂α̇) + N_rotor·(∂ω_rotor/∂α̇) = 0",
            "N_inner[0] + N_rotor·(∂ω_rotor/∂β̇) = 0",
            "N_rotor[2] = 0",
            "p_α = (Io ω_outer)[2] + (Ii ω_inner)·(∂ω_inner/∂α̇) + (Ir ω_rotor)·(∂ω_rotor/∂α̇)",
        ],
    ),
    (
        "#[coordinates(q: [3])] #[frame(link[0]: rotate_z(q[0]))]
         #[frame(link[1] in link[0]: rotate_x(pi/2), rotate_z(q[1]))] #[frame(link[2] in link[1]: translate(l), rotate_z(q[2]))]
         #[lagrangian(sum(i in 0..3, kinetic(link[i], m[i], c[i], I[i]) - m[i]*g*position(link[i], c[i])[2]))] #[force(q: torque)]
         struct ArmOfThreeLinks { m: [f64; 3], c: [Vector3<f64>; 3], I: [Matrix3<f64>; 3], l: Vector3<f64>, g: f64, torque: Vector3<f64> }",
        &[
            "ω_link[2] = A_link[2]ᵀ A_link[1] ω_link[1] + [0, 0, q̇[2]]",
            "r_link[2] = A_link[1] l + A_link[2] c[2]",
            "F_link[2]·(∂ṙ_link[2]/∂q̇[2]) + N_link[2][2] = torque[2]",
            "N_link[1] = I[1] ω̇_link[1] + ω_link[1]×(I[1] ω_link[1])",
        ],
    ),
    // A body turned by a quaternion carries one turned by an angle: the velocities of the equations are ω_q and ṡ.
    (
        "#[coordinates(r: [3], q: [4], s)]
         #[frame(body: translate(r), rotate(q))] #[frame(wheel in body: translate(p), rotate_z(s))]
         #[lagrangian(kinetic(body, m, [0, 0, 0], I) + kinetic(wheel, M, [0, 0, 0], J) - k*q[0]^2)]
         struct SatelliteWithWheel { k: f64, m: f64, M: f64, p: Vector3<f64>, I: Matrix3<f64>, J: Matrix3<f64> }",
        &[
            "ω_wheel = A_wheelᵀ A_q ω_q + [0, 0, ṡ]",
            "r_wheel = r + A_q p",
            "N_body[0] + F_wheel·(∂ṙ_wheel/∂ω_q[0]) + N_wheel·(∂ω_wheel/∂ω_q[0]) = k q[0] q[1]",
            "N_body = I ω̇_q + ω_q×(I ω_q)",
            "N_wheel[2] = 0",
            "p_r[0] = m ṙ_body[0] + M ṙ_wheel[0]",
        ],
    ),
    // A spring at the point c of the body.
    (
        "#[coordinates(r: [3], q: [4], s)] #[frame(body: translate(r), rotate(q))] #[frame(wheel in body: rotate_z(s))]
         #[define(d = position(body, c) - p)]
         #[lagrangian(kinetic(body, m, [0, 0, 0], I) + kinetic(wheel, 0, [0, 0, 0], J) - k/2*dot(d, d))]
         struct WheelOnSpring { k: f64, m: f64, c: Vector3<f64>, p: Vector3<f64>, I: Matrix3<f64>, J: Matrix3<f64> }",
        &[
            "m r̈ = −k d",
            "N_body[0] + N_wheel·(∂ω_wheel/∂ω_q[0]) = k ((A_qᵀ d)×c)[0]",
        ],
    ),
    // A spring by the definition of its length, a motor, friction, and a frame without a body between two bodies.
    (
        "#[coordinates(a, b, c, d, e)]
         #[frame(one: rotate_x(a), rotate_y(b))] #[frame(gimbal in one: translate(l), rotate_x(c), rotate_y(d))] #[frame(two in gimbal: rotate_z(e))]
         #[define(s = position(two, [0, 0, -1]) - p)]
         #[lagrangian(kinetic(one, m1, c1, I1) + kinetic(two, m2, c2, I2) - m1*g*position(one, c1)[2] - m2*g*position(two, c2)[2] - k/2*dot(s, s))]
         #[force(c: motor - mu*c_dot)]
         struct PendulumsOnSpring { m1: f64, m2: f64, g: f64, k: f64, motor: f64, mu: f64, p: Vector3<f64>, l: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "A_two = A_gimbal [[cos e, −sin e, 0], [sin e, cos e, 0], [0, 0, 1]]",
            "ω_two = A_twoᵀ A_gimbal ω_gimbal + [0, 0, ė]",
            "F_two·(∂ṙ_two/∂ċ) + N_two·(∂ω_two/∂ċ) = motor − μ ċ − (k s)·(∂s/∂c)",
            "E = ½ m₁ ṙ_one·ṙ_one + ½ ω_one·(I₁ ω_one) + ½ m₂ ṙ_two·ṙ_two + ½ ω_two·(I₂ ω_two) + m₁ g r_one[2] + m₂ g r_two[2] + ½ k s·s",
        ],
    ),
    // A closed loop: the force in the joint is the multiplier.
    (
        "#[coordinates(a, b, c, d, e, f)]
         #[frame(one: rotate_x(a), rotate_y(b), rotate_z(c))] #[frame(two: translate(o), rotate_x(d), rotate_y(e), rotate_z(f))]
         #[lagrangian(kinetic(one, m1, c1, I1) + kinetic(two, m2, c2, I2) - m1*g*position(one, c1)[2] - m2*g*position(two, c2)[2])]
         #[constraint(joint: position(one, h1) = position(two, h2))]
         struct JointedByAngles { m1: f64, m2: f64, g: f64, o: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, h1: Vector3<f64>, h2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "F_one·(∂ṙ_one/∂ȧ) + N_one·(∂ω_one/∂ȧ) = λ_joint·(∂joint/∂a)",
            "F_two·(∂ṙ_two/∂ḟ) + N_two[2] = λ_joint·(∂joint/∂f)",
            "R_a = λ_joint·(∂joint/∂a)",
            "r_two = o + A_two c₂",
        ],
    ),
    // Two bodies on one frame, and names that are taken.
    (
        "#[coordinates(a, b, c, d)] #[frame(rod: rotate_x(a), rotate_y(b))] #[frame(end in rod: translate(h), rotate_x(c), rotate_z(d))]
         #[lagrangian(kinetic(rod, m1, c1, I1) + kinetic(rod, m2, c2) + kinetic(end, F_end, c3, I3))]
         struct TwoOnOneFrame { m1: f64, m2: f64, F_end: f64, h: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, c3: Vector3<f64>, I1: Matrix3<f64>, I3: Matrix3<f64> }",
        &[
            "r_rod2 = A_rod c₂",
            "K_rod2 = m₂ r̈_rod2",
            "K_end = F_end r̈_end",
        ],
    ),
];

#[test]
fn bodies_in_frames_are_printed_by_forces_and_torques() {
    check_forms(FRAMES);
}

/// Equations that are short in coordinates stay as they are.
#[test]
fn short_equations_stay_in_coordinates() {
    let source = "#[coordinates(a, b)] #[frame(upper: rotate_y(a))] #[frame(lower in upper: translate([0, 0, -l]), rotate_y(b))]
         #[lagrangian(kinetic(upper, m, [0, 0, -l]) + kinetic(lower, m, [0, 0, -l]) - m*g*position(upper, [0, 0, -l])[2] - m*g*position(lower, [0, 0, -l])[2])]
         struct PlanarByFrames { m: f64, g: f64, l: f64 }";
    let system = System::new(source.parse().expect("tokens")).expect("a system");
    let [text, ..] = &system.forms[0];
    assert!(!["F_upper", "N_upper", "A_upper"].iter().any(|name| text.contains(name)), "{text}");
}
