//! Rigid bodies are printed as vectors: points of bodies along the fixed axes, and forces along the axes of the bodies.
//!
//! Each system is also read back at random states: `everywhere` finds the systems in this file.

use super::forms::check_forms;
use super::golden::rendered;

/// Systems, each with lines that must stand on its printed page.
#[rustfmt::skip]
const BODIES: &[(&str, &[&str])] = &[
    // The gradient of gravity turns a satellite by 3 μ r×(I r)/|r|⁵, as the crate `orts` has it (`GravityGradientTorque`).
    (
        "#[coordinates(r: [3], q: [4])] #[frame(body: translate(r), rotate(q))]
         #[define(n = express(vector(fixed, r), body))] #[parameter(I: symmetric)]
         #[lagrangian(kinetic(body, m, [0, 0, 0], I) + mu*m/norm(r) - 3*mu/(2*norm(r)^5)*dot(n, I*n))]
         struct GravityGradient { m: f64, mu: f64, I: Matrix3<f64> }",
        &[
            "m r̈ = μ (15 (n·(I n)) r/(2 |r|⁴) − m r − 3 A_q I n/|r|²)/|r|³",
            "I ω̇_q + ω_q×(I ω_q) = 3 μ (n×(I n))/|r|⁵",
        ],
    ),
    (
        "#[coordinates(q: [4])] #[frame(body: rotate(q))]
         #[define(n = express(vector(fixed, e), body))]
         #[lagrangian(kinetic(body, 0, [0, 0, 0], I) - 3*mu/(2*R^3)*dot(n, I*n))]
         struct SatelliteAtRest { R: f64, mu: f64, e: Vector3<f64>, I: Matrix3<f64> }",
        &[
            "I ω̇_q + ω_q×(I ω_q) = 3 μ (n×(I n))/R³",
        ],
    ),
    // A spring between points of two bodies, by name and without one.
    (
        "#[coordinates(r1: [3], q1: [4], r2: [3], q2: [4])] #[frame(a: translate(r1), rotate(q1))] #[frame(b: translate(r2), rotate(q2))]
         #[define(d = position(a, c1) - position(b, c2))]
         #[lagrangian(kinetic(a, m1, [0, 0, 0], I1) + kinetic(b, m2, [0, 0, 0], I2) - k/2*dot(d, d))]
         struct SpringOfBodies { m1: f64, m2: f64, k: f64, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "m₁ r̈₁ = −k d",
            "I₁ ω̇_q₁ + ω_q₁×(I₁ ω_q₁) = k ((A_q₁ᵀ d)×c₁)",
            "I₂ ω̇_q₂ + ω_q₂×(I₂ ω_q₂) = k (c₂×(A_q₂ᵀ d))",
        ],
    ),
    (
        "#[coordinates(r1: [3], q1: [4], r2: [3], q2: [4])] #[frame(a: translate(r1), rotate(q1))] #[frame(b: translate(r2), rotate(q2))]
         #[lagrangian(kinetic(a, m1, [0, 0, 0], I1) + kinetic(b, m2, [0, 0, 0], I2) - k/2*(norm(position(a, c1) - position(b, c2)) - l)^2)]
         struct StiffSpringOfBodies { m1: f64, m2: f64, k: f64, l: f64, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "I₁ ω̇_q₁ + ω_q₁×(I₁ ω_q₁) = k l (c₁×(A_q₁ᵀ (r₁ − r₂ − A_q₂ c₂)))/|r₁ − r₂ + A_q₁ c₁ − A_q₂ c₂| + k (c₁×(A_q₁ᵀ (r₂ + A_q₂ c₂ − r₁)))",
        ],
    ),
    (
        "#[coordinates(r: [3], q: [4])] #[frame(body: translate(r), rotate(q))]
         #[lagrangian(kinetic(body, m, [0, 0, 0], I) - m*g*r[2] - k/2*(norm(position(body, c) - p) - l)^2)]
         struct BodyOnSpring { m: f64, g: f64, k: f64, l: f64, c: Vector3<f64>, p: Vector3<f64>, I: Matrix3<f64> }",
        &[
            "I ω̇_q + ω_q×(I ω_q) = k l (c×(A_qᵀ (r − p)))/|r − p + A_q c| + k (c×(A_qᵀ (p − r)))",
        ],
    ),
    (
        "#[coordinates(r: [3], q: [4])] #[frame(rod: translate(r), rotate(q))]
         #[define(a = position(rod, c))] #[define(b = position(rod, -c))]
         #[lagrangian(kinetic(rod, 2*m, [0, 0, 0], I) + G*m/norm(a) + G*m/norm(b))]
         struct Dumbbell { m: f64, G: f64, c: Vector3<f64>, I: Matrix3<f64> }",
        &[
            "2 r̈ = −G a/d₁³ − G b/d₂³",
            "I ω̇_q + ω_q×(I ω_q) = G m ((A_qᵀ a)×c)/d₁³ + G m (c×(A_qᵀ b))/d₂³",
        ],
    ),
    // The last row of A_q is the vertical along the turned axes: the equations of Euler and Poisson.
    (
        "#[coordinates(q: [4])] #[frame(top: rotate(q))]
         #[lagrangian(kinetic(top, m, centre, I) - m*g*position(top, centre)[2])]
         struct HeavyTopByVectors { m: f64, g: f64, centre: Vector3<f64>, I: Matrix3<f64> }",
        &[
            "I_q ω̇_q + ω_q×(I_q ω_q) = m g (A_q[2]×centre)",
        ],
    ),
    // About a point beside the centre of mass, the accelerations of the point and of the rotation are coupled.
    (
        "#[coordinates(r: [3], q: [4])] #[frame(body: translate(r), rotate(q))]
         #[lagrangian(kinetic(body, m, centre, I) - m*g*position(body, centre)[2])]
         struct OffCentre { m: f64, g: f64, centre: Vector3<f64>, I: Matrix3<f64> }",
        &[
            "r̈[0] + (A_q (ω̇_q×centre))[0] = −(A_q (ω_q×(ω_q×centre)))[0]",
            "I_q ω̇_q + ω_q×(I_q ω_q) + m (centre×(A_qᵀ r̈)) = m g (A_q[2]×centre)",
        ],
    ),
    // The force at a pin or in a joint is the multiplier.
    (
        "#[coordinates(r: [3], q: [4])] #[frame(body: translate(r), rotate(q))]
         #[lagrangian(kinetic(body, m, [0, 0, 0], I) - m*g*r[2])] #[constraint(pin: position(body, c) = p)]
         struct Pinned { m: f64, g: f64, c: Vector3<f64>, p: Vector3<f64>, I: Matrix3<f64> }",
        &[
            "I ω̇_q + ω_q×(I ω_q) = c×(A_qᵀ λ_pin)",
            "R_q = 2 q (c×(A_qᵀ λ_pin)) + 2 λ_q q",
        ],
    ),
    (
        "#[coordinates(r1: [3], q1: [4], r2: [3], q2: [4])] #[frame(a: translate(r1), rotate(q1))] #[frame(b: translate(r2), rotate(q2))]
         #[lagrangian(kinetic(a, m1, [0, 0, 0], I1) + kinetic(b, m2, [0, 0, 0], I2))] #[constraint(joint: position(a, c1) = position(b, c2))]
         struct Jointed { m1: f64, m2: f64, c1: Vector3<f64>, c2: Vector3<f64>, I1: Matrix3<f64>, I2: Matrix3<f64> }",
        &[
            "m₁ r̈₁ = λ_joint",
            "m₂ r̈₂ = −λ_joint",
            "I₁ ω̇_q₁ + ω_q₁×(I₁ ω_q₁) = c₁×(A_q₁ᵀ λ_joint)",
            "I₂ ω̇_q₂ + ω_q₂×(I₂ ω_q₂) = (A_q₂ᵀ λ_joint)×c₂",
        ],
    ),
    (
        "#[coordinates(r: [3], q: [4])] #[frame(body: translate(r), rotate(q))] #[define(s = position(body, c))]
         #[lagrangian(kinetic(body, m, [0, 0, 0], inertia) - k/2*dot(s, s))]
         struct Hanging { m: f64, k: f64, c: Vector3<f64>, inertia: Matrix3<f64> }",
        &[
            "m r̈ = −k s",
            "inertia ω̇_q + ω_q×(inertia ω_q) = k ((A_qᵀ s)×c)",
        ],
    ),
    // The force of a constraint with a turned vector: a disc that rolls, with its axle k and the point of contact p.
    (
        "#[coordinates(r: [3], q: [4])] #[frame(disc: translate(r), rotate(q))] #[parameter(I: symmetric)]
         #[define(k = express(vector(disc, [0, 1, 0]), fixed))] #[define(p = a*(k[2]*k - [0, 0, 1])/sqrt(1 - k[2]^2))]
         #[lagrangian(kinetic(disc, m, [0, 0, 0], I) - m*g*r[2])]
         #[constraint(rolls: express(velocity(disc), fixed) + cross(express(angular_velocity(disc), fixed), p) = 0)]
         struct RollingDisc { m: f64, g: f64, a: f64, I: Matrix3<f64> }",
        &[
            "I ω̇_q + ω_q×(I ω_q) = A_qᵀ (p×λ_rolls)",
            "R_q = 2 q (A_qᵀ (p×λ_rolls)) + 2 λ_q q",
        ],
    ),
    // A turned vector is turned again.
    (
        "#[coordinates(q: [4])] #[frame(body: rotate(q))]
         #[define(u = position(body, c))] #[define(w = position(body, [u[0], u[1], u[2]]))]
         #[lagrangian(kinetic(body, 0, [0, 0, 0], I) - k*dot(e, w))]
         struct TurnedTwice { k: f64, c: Vector3<f64>, e: Vector3<f64>, I: Matrix3<f64> }",
        &[],
    ),
];

#[test]
fn bodies_are_turned_by_vectors() {
    check_forms(BODIES);
}

/// The matrix of a rotation stands as such, or as a list of its columns if it is wider than a page.
#[test]
fn a_wide_matrix_is_a_list_of_columns() {
    for (quaternion, columns) in [("q", [3].as_slice()), ("attitude", &[1, 1, 1])] {
        let source = format!(
            "#[coordinates({quaternion}: [4])] #[frame(body: rotate({quaternion}))] #[define(s = position(body, c) - p)]
             #[lagrangian(kinetic(body, m, [0, 0, 0], I) - k/2*dot(s, s))]
             struct Held {{ m: f64, k: f64, c: Vector3<f64>, p: Vector3<f64>, I: Matrix3<f64> }}"
        );
        let [[_, _, html], ..] = rendered(&source).forms;
        let tables = html.split("<mtable>").skip(1).map(|table| {
            let row = table.split("</mtr>").next().unwrap_or_default();
            assert_eq!(table.matches("<mtr>").count(), 3, "{html}");
            row.matches("<mtd>").count()
        });
        assert_eq!(tables.collect::<Vec<_>>(), columns, "{html}");
    }
}
