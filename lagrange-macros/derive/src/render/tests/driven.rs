//! Bodies in frames that move with time: the energy function, which is not T + U, and its rate, by the velocities of the bodies.
//!
//! Each system is also read back at random states: `everywhere` finds the systems in this file. It takes ∂r/∂t, Ω, ∂ṙ/∂t and
//! ∂ω/∂t from differences of positions and orientations at other times.

use super::forms::check_forms;
use super::systems::System;

/// Systems, each with lines that must stand on its printed page.
#[rustfmt::skip]
const DRIVEN: &[(&str, &[&str])] = &[
    // A table that turns: E is T + U less the angular velocity times the angular momentum, and conserved.
    (
        "#[coordinates(a, b)]
         #[frame(table: rotate_z(w*t))] #[frame(arm in table: translate([l, 0, 0]), rotate_x(a), rotate_y(b))]
         #[lagrangian(kinetic(arm, m, c, I) - m*g*position(arm, c)[2])]
         struct PendulumOnTurntable { m: f64, g: f64, l: f64, w: f64, c: Vector3<f64>, I: Matrix3<f64> }",
        &[
            "ω_arm = A_armᵀ A_table ω_table + [ȧ cos b, ḃ, ȧ sin b]",
            "Ω_arm = A_armᵀ A_table ω_table",
            "E = ½ m ṙ_arm·ṙ_arm + ½ ω_arm·(I ω_arm) + m g r_arm[2] − m ṙ_arm·(∂r_arm/∂t) − (I ω_arm)·Ω_arm",
        ],
    ),
    // A base that is shaken and turns, and a motor.
    (
        "#[coordinates(a, b, c, d)]
         #[frame(base: translate([0, 0, h*sin(nu*t)]), rotate_z(w*t))]
         #[frame(upper in base: rotate_x(a), rotate_y(b))] #[frame(lower in upper: translate([0, 0, -l]), rotate_x(c), rotate_y(d))]
         #[lagrangian(kinetic(upper, m1, c1, I1) + kinetic(lower, m2, c2, I2) - m1*g*position(upper, c1)[2] - m2*g*position(lower, c2)[2])]
         #[force(d: motor - mu*d_dot)]
         struct DoublePendulumOnShakenTable { m1: f64, m2: f64, g: f64, l: f64, h: f64, nu: f64, w: f64, motor: f64, mu: f64, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "Ω_upper = A_upperᵀ A_base ω_base",
            "Ω_lower = A_lowerᵀ A_upper Ω_upper",
            "d/dt E = −m₁ ṙ_upper·(∂ṙ_upper/∂t) − m₂ ṙ_lower·(∂ṙ_lower/∂t) + m₁ g (∂r_upper[2]/∂t) + m₂ g (∂r_lower[2]/∂t) + (motor − μ ḋ) ḋ",
        ],
    ),
    // A pivot that is driven: nothing turns with time. All of the family of links.
    (
        "#[coordinates(q: [3])] #[frame(cart: translate([x0*sin(w*t), 0, 0]))] #[frame(link[0] in cart: rotate_z(q[0]))]
         #[frame(link[1] in link[0]: rotate_x(pi/2), rotate_z(q[1]))] #[frame(link[2] in link[1]: translate(l), rotate_z(q[2]))]
         #[lagrangian(sum(i in 0..3, kinetic(link[i], m[i], c[i], I[i]) - m[i]*g*position(link[i], c[i])[2]))]
         struct ArmOnDrivenCart { m: [f64; 3], c: [Vector3<f64>; 3], I: [Matrix3<f64>; 3], l: Vector3<f64>, g: f64, x0: f64, w: f64 }",
        &[
            "d/dt E = −m[0] ṙ_link[0]·(∂ṙ_link[0]/∂t) − m[1] ṙ_link[1]·(∂ṙ_link[1]/∂t) − m[2] ṙ_link[2]·(∂ṙ_link[2]/∂t)",
        ],
    ),
    // A body that a quaternion turns, on a ship that rolls by a function of time.
    (
        "#[coordinates(r: [3], q: [4])] #[function(roll(t))]
         #[frame(ship: rotate_x(roll(t)))] #[frame(gyro in ship: translate(r), rotate(q))]
         #[lagrangian(kinetic(gyro, m, c, I) - m*g*position(gyro, c)[2] - k/2*dot(r, r))]
         struct GyroscopeOnShip<R> { m: f64, g: f64, k: f64, c: Vector3<f64>, I: Matrix3<f64>, roll: R }",
        &[
            "ω_ship = [roll′(t), 0, 0]",
            "ω_gyro = A_gyroᵀ A_ship ω_ship + ω_q",
            "Ω_gyro = A_gyroᵀ A_ship ω_ship",
            "E = ½ m ṙ_gyro·ṙ_gyro + ½ ω_gyro·(I ω_gyro) + m g r_gyro[2] + ½ k r·r − m ṙ_gyro·(∂r_gyro/∂t) − (I ω_gyro)·Ω_gyro",
            "d/dt E = −m ṙ_gyro·(∂ṙ_gyro/∂t) − (I ω_gyro)·(∂ω_gyro/∂t) + m g (∂r_gyro[2]/∂t)",
        ],
    ),
    // Given functions of time, and weights that rise with them alike.
    (
        "#[coordinates(a, b, c)] #[function(z(t))] #[function(phi(t))]
         #[frame(base: translate([0, 0, z(t)]), rotate_z(phi(t)))] #[frame(top in base: rotate_x(a), rotate_z(b))] #[frame(tip in top: translate(l), rotate_x(c))]
         #[lagrangian(kinetic(top, m, [0, 0, h], I) + kinetic(tip, M, [0, 0, 0], J) - m*g*position(top, [0, 0, h])[2] - M*g*position(tip, [0, 0, 0])[2])]
         struct TopOnDrivenBase<Z, P> { m: f64, M: f64, g: f64, h: f64, l: Vector3<f64>, I: Matrix3<f64>, J: Matrix3<f64>, z: Z, phi: P }",
        &[
            "Ω_tip = A_tipᵀ A_top Ω_top",
            "d/dt E = −m ṙ_top·(∂ṙ_top/∂t) − (I ω_top)·(∂ω_top/∂t) − M ṙ_tip·(∂ṙ_tip/∂t) − (J ω_tip)·(∂ω_tip/∂t) + (m + M) g z′(t)",
        ],
    ),
    // A table with inertia that no coordinate turns, joints that slide, and an inertia that is no parameter.
    (
        "#[coordinates(x, a, b)]
         #[frame(table: rotate_z(w*t))] #[frame(cart in table: translate([x, 0, h]), rotate_x(a))] #[frame(arm in cart: translate(l), rotate_y(b))]
         #[lagrangian(kinetic(table, 0, [0, 0, 0], [[A, 0, 0], [0, A, 0], [0, 0, B]]) + kinetic(cart, m, [0, 0, h], [[A, 0, D], [0, B, 0], [D, 0, C]])
                      + kinetic(arm, M, centre, inertia) + m*g*position(cart, [0, 0, h])[0] + M*g*position(arm, centre)[0])]
         struct ArmOnTurntable { m: f64, M: f64, w: f64, h: f64, g: f64, A: f64, B: f64, C: f64, D: f64, l: Vector3<f64>, centre: Vector3<f64>, inertia: Matrix3<f64> }",
        &[
            "I_table = [[A, 0, 0], [0, A, 0], [0, 0, B]]",
            "I_cart = [[A, 0, D], [0, B, 0], [D, 0, C]]",
            "A_table = [[cos(w t), −sin(w t), 0], [sin(w t), cos(w t), 0], [0, 0, 1]]",
            "ω_cart = A_cartᵀ A_table ω_table + [ȧ, 0, 0]",
            "r_arm = A_table [x, 0, h] + A_cart l + A_arm centre",
            "E = ½ m ṙ_cart·ṙ_cart + ½ ω_cart·(I_cart ω_cart) + ½ M ṙ_arm·ṙ_arm + ½ ω_arm·(inertia ω_arm) − m g r_cart[0] − M g r_arm[0] − ½ ω_table·(I_table ω_table) − m ṙ_cart·(∂r_cart/∂t) − (I_cart ω_cart)·Ω_cart − M ṙ_arm·(∂r_arm/∂t) − (inertia ω_arm)·Ω_arm",
        ],
    ),
    // A rotor at a given rate inside of a body, a spring by the definition of its length, and a constraint that moves.
    (
        "#[coordinates(a, b, s)]
         #[frame(body: rotate_x(a), rotate_y(b))] #[frame(rotor in body: translate(l), rotate_z(w*t))] #[frame(arm in rotor: rotate_x(s))]
         #[define(d = position(arm, e) - p)]
         #[lagrangian(kinetic(body, m, c, I) + kinetic(rotor, M, [0, 0, 0], J) + kinetic(arm, N, e, K)
                      - m*g*position(body, c)[2] - M*g*position(rotor)[2] - N*g*position(arm, e)[2] - k/2*dot(d, d))]
         #[constraint(rail: position(arm, f)[0] = h*sin(w*t))]
         struct BodyWithRotorAtGivenRate { m: f64, M: f64, N: f64, w: f64, g: f64, k: f64, h: f64, f: Vector3<f64>, e: Vector3<f64>, p: Vector3<f64>, l: Vector3<f64>, c: Vector3<f64>, I: Matrix3<f64>, J: Matrix3<f64>, K: Matrix3<f64> }",
        &[
            "Ω_rotor = [0, 0, w]",
            "E = ½ m ṙ_body·ṙ_body + ½ ω_body·(I ω_body) + ½ M ṙ_rotor·ṙ_rotor + ½ ω_rotor·(J ω_rotor) + ½ N ṙ_arm·ṙ_arm + ½ ω_arm·(K ω_arm) + m g r_body[2] + M g r_rotor[2] + N g r_arm[2] + ½ k d·d − (J ω_rotor)·Ω_rotor − N ṙ_arm·(∂r_arm/∂t) − (K ω_arm)·Ω_arm",
        ],
    ),
    // A wheel at a given rate in a body that a quaternion turns.
    (
        "#[coordinates(r: [3], q: [4])] #[frame(body: translate(r), rotate(q))] #[frame(wheel in body: translate(p), rotate_z(w*t))]
         #[lagrangian(kinetic(body, m, [0, 0, 0], I) + kinetic(wheel, M, c, J) - k*q[0]^2)]
         struct SatelliteWithDrivenWheel { k: f64, m: f64, M: f64, w: f64, c: Vector3<f64>, p: Vector3<f64>, I: Matrix3<f64>, J: Matrix3<f64> }",
        &[
            "E = ½ m ṙ_body·ṙ_body + ½ ω_q·(I ω_q) + ½ M ṙ_wheel·ṙ_wheel + ½ ω_wheel·(J ω_wheel) + k q[0]² − M ṙ_wheel·(∂r_wheel/∂t) − (J ω_wheel)·Ω_wheel",
            "d/dt E = −M ṙ_wheel·(∂ṙ_wheel/∂t) − (J ω_wheel)·(∂ω_wheel/∂t)",
        ],
    ),
    // Gravity in a lift, a body that time alone moves, and a letter that is taken.
    (
        "#[coordinates(a, b, c)] #[define(Omega_two = w^2)]
         #[frame(hook: translate([h*cos(w*t), 0, 0]))] #[frame(one in hook: rotate_x(a), rotate_y(b))] #[frame(two in one: translate(l), rotate_z(w*t), rotate_x(c))]
         #[lagrangian(kinetic(hook, M, [0, 0, 0]) + kinetic(one, m1, c1, I1) + kinetic(two, m2, c2, I2)
                      - m1*(g + Omega_two*h*cos(w*t))*position(one, c1)[2] - m2*(g + Omega_two*h*cos(w*t))*position(two, c2)[2])]
         struct PendulumInLift { m1: f64, m2: f64, M: f64, g: f64, w: f64, h: f64, l: Vector3<f64>, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "W_two = [0, w sin c, w cos c]",
            "E = ½ m₁ ṙ_one·ṙ_one + ½ ω_one·(I₁ ω_one) + ½ m₂ ṙ_two·ṙ_two + ½ ω_two·(I₂ ω_two) + m₁ (g + h Ω_two cos(w t)) r_one[2] + m₂ (g + h Ω_two cos(w t)) r_two[2] − ½ M ṙ_hook·ṙ_hook − m₁ ṙ_one·(∂r_one/∂t) − m₂ ṙ_two·(∂r_two/∂t) − (I₂ ω_two)·W_two",
        ],
    ),
    // Equations that can be read, of an energy that cannot: both are by vectors.
    (
        "#[coordinates(a: [3], b: [3])] #[frame(hook: translate([0, 0, h*cos(w*t)]))] #[frame(rod[i in 0..3] in hook: rotate_x(a[i]), rotate_y(b[i]))]
         #[lagrangian(sum(i in 0..3, kinetic(rod[i], m[i], c[i], I[i]) - m[i]*g*position(rod[i], c[i])[2]) - k*a[0]*a[1])]
         struct ThreeOnShaker { k: f64, m: [f64; 3], g: f64, h: f64, w: f64, c: [Vector3<f64>; 3], I: [Matrix3<f64>; 3] }",
        &[
            "F_rod[0]·(∂ṙ_rod[0]/∂ȧ[0]) + N_rod[0]·(∂ω_rod[0]/∂ȧ[0]) = −k a[1]",
            "E = ½ m[0] ṙ_rod[0]·ṙ_rod[0] + ½ ω_rod[0]·(I[0] ω_rod[0]) + ½ m[1] ṙ_rod[1]·ṙ_rod[1] + ½ ω_rod[1]·(I[1] ω_rod[1]) + ½ m[2] ṙ_rod[2]·ṙ_rod[2] + ½ ω_rod[2]·(I[2] ω_rod[2]) + m[0] g r_rod[0][2] + m[1] g r_rod[1][2] + m[2] g r_rod[2][2] + k a[0] a[1] − m[0] ṙ_rod[0]·(∂r_rod[0]/∂t) − m[1] ṙ_rod[1]·(∂r_rod[1]/∂t) − m[2] ṙ_rod[2]·(∂r_rod[2]/∂t)",
        ],
    ),
];

#[test]
fn energies_of_bodies_in_frames_that_move_are_printed_by_their_velocities() {
    check_forms(DRIVEN);
}

#[test]
fn energies_that_are_short_in_coordinates_stay_so() {
    let source = "#[coordinates(theta)] #[frame(hoop: rotate_z(w*t))] #[frame(bead in hoop: rotate_y(theta), translate([0, 0, -R]))]
         #[lagrangian(kinetic(bead, m, [0, 0, 0]) - m*g*position(bead, [0, 0, 0])[2])]
         struct BeadOnHoop { m: f64, g: f64, w: f64, R: f64 }";
    let system = System::new(source.parse().expect("tokens")).expect("a system");
    let [text, ..] = &system.forms[0];
    assert!(text.contains("E = ½ m R² θ̇² − m g R cos θ − ½ m w² R² sin² θ"), "{text}");
}
