//! Printed equations have the forms that textbooks choose: closed Hamiltonians, names for roots, squares, separate forces.
//!
//! Each system is also read back at random states: `everywhere` finds the systems in this file.

use lagrange_random::cases;

use super::systems::System;

/// Systems, each with lines that must stand on its printed page.
#[rustfmt::skip]
const ENTRIES: &[(&str, &[&str])] = &[
    // A spring between bodies: its distance and its square stay as they are in L.
    (
        "#[coordinates(r1: [3], r2: [3])]
         #[lagrangian(m1/2*dot(r1_dot, r1_dot) + m2/2*dot(r2_dot, r2_dot) - k/2*(norm(r1 - r2) - l)^2)]
         struct BodiesOnSpring { m1: f64, m2: f64, k: f64, l: f64 }",
        &[
            "E = ½ m₁ ṙ₁·ṙ₁ + ½ m₂ ṙ₂·ṙ₂ + ½ k (|r₁ − r₂| − l)²",
            "H = (p_r₁·p_r₁)/(2 m₁) + (p_r₂·p_r₂)/(2 m₂) + ½ k (|r₁ − r₂| − l)²",
        ],
    ),
    (
        "#[coordinates(r: [3])] #[lagrangian(m/2*dot(r_dot, r_dot) - k/2*(norm(r) - l)^2 - m*g*r[2])]
         struct BobOnSpring { m: f64, k: f64, l: f64, g: f64 }",
        &[
            "E = ½ m ṙ·ṙ + ½ k (|r| − l)² + m g r[2]",
            "H = (p_r·p_r)/(2 m) + ½ k (|r| − l)² + m g r[2]",
        ],
    ),
    // The masses of an array are no components of a vector.
    (
        "#[coordinates(r: [2, 3])]
         #[lagrangian(sum(i in 0..2, m[i]/2*dot(r_dot[i] + cross(W, r[i]), r_dot[i] + cross(W, r[i]))) + G*m[0]*m[1]/norm(r[0] - r[1]))]
         struct MassesInFrame { m: [f64; 2], G: f64, W: [f64; 3] }",
        &[
            "r̈[0] = G m[1] (r[1] − r[0])/|r[0] − r[1]|³ + 2 (ṙ[0]×W) − W×(W×r[0])",
            "p_r[1] = m[1] ṙ[1] + m[1] (W×r[1])",
        ],
    ),
    // Limits of forces stay as they are written.
    (
        "#[coordinates(x, y)] #[lagrangian(m/2*(x_dot^2 + y_dot^2))]
         #[force(x: min(f, max(-f, -k*x)) - c*x_dot)] #[force(y: clamp(k*(x - y) - c*y_dot, -f, f))]
         struct LimitedForces { m: f64, f: f64, k: f64, c: f64 }",
        &[
            "m ẍ = min(f, max(−f, −k x)) − c ẋ",
            "m ÿ = clamp(k (x − y) − c ẏ, −f, f)",
            "ṗ_x = min(f, max(−f, −k x)) − c p_x/m",
            "ṗ_y = clamp(k (x − y) − c p_y/m, −f, f)",
        ],
    ),
    // The terms of a kinetic energy over their own denominators.
    (
        "#[coordinates(phi, theta, psi)] #[frame(top: rotate_z(phi), rotate_x(theta), rotate_z(psi))]
         #[lagrangian(kinetic(top, m, [0, 0, l], [[A, 0, 0], [0, A, 0], [0, 0, C]]) - m*g*position(top, [0, 0, l])[2])]
         struct TopInFrame { A: f64, C: f64, m: f64, g: f64, l: f64 }",
        &[
            "H = (p_φ − p_ψ cos θ)²/(2 (A + m l²) sin² θ) + p_θ²/(2 (A + m l²)) + p_ψ²/(2 C) + m g l cos θ",
        ],
    ),
    // A vector that is a definition is one vector in H, and hides no force in the equations of motion.
    (
        "#[coordinates(r: [3])] #[define(A = cross(B, r)/2)]
         #[lagrangian(m/2*dot(r_dot, r_dot) + q*dot(A, r_dot) + q*dot(E, r))]
         struct ChargeInVectors { m: f64, q: f64, B: Vector3<f64>, E: Vector3<f64> }",
        &[
            "p_r = m ṙ + q A",
            "H = (p_r − q A)²/(2 m) − q E·r",
        ],
    ),
    (
        "#[coordinates(r: [3])] #[define(A = cross(B, r)/2)]
         #[lagrangian(-m*c^2*sqrt(1 - dot(r_dot, r_dot)/c^2) + q*dot(A, r_dot) + q*dot(E, r))]
         struct RelativisticInVectors { m: f64, c: f64, q: f64, B: Vector3<f64>, E: Vector3<f64> }",
        &[
            "H = √(m² c⁴ + c² (p_r − q A)²) − q E·r",
        ],
    ),
    (
        "#[coordinates(r: [3])] #[define(v_0 = r_dot + cross(Omega, r))]
         #[lagrangian(m/2*dot(v_0, v_0) - k/2*dot(r, r))]
         struct RotatingByName { m: f64, k: f64, Omega: Vector3<f64> }",
        &[
            "p_r = m v₀",
            "m r̈ = 2 m (ṙ×Ω) − m (Ω×(Ω×r)) − k r",
        ],
    ),
    (
        "#[coordinates(r: [3])]
         #[lagrangian(m/2*dot(r_dot, r_dot) + m*dot(r_dot, cross(Omega, r)) + m/2*dot(cross(Omega, r), cross(Omega, r)) - k/2*dot(r, r))]
         struct RotatingWrittenOut { m: f64, k: f64, Omega: Vector3<f64> }",
        &[
            "p_r = m ṙ + m (Ω×r)",
            "m r̈ = 2 m (ṙ×Ω) − m (Ω×(Ω×r)) − k r",
        ],
    ),
    (
        "#[coordinates(q: [4])] #[frame(body: rotate(q))] #[parameter(I: symmetric)]
         #[lagrangian(kinetic(body, 0, [0, 0, 0], I))]
         struct FreeBody { I: Matrix3<f64> }",
        &[
            "I ω̇_q + ω_q×(I ω_q) = 0",
            "E = ½ ω_q·(I ω_q)",
        ],
    ),
    (
        "#[coordinates(x)]
         #[lagrangian(-m*c^2*sqrt(1 - x_dot^2/c^2) - k*x^2/2)]
         struct RelativisticOscillator { m: f64, c: f64, k: f64 }",
        &[
            "γ = 1/√(1 − ẋ²/c²)",
            "p_x = m γ ẋ",
            "m γ³ ẍ = −k x",
            "E = m c² γ + ½ k x²",
            "H = √(c² p_x² + m² c⁴) + ½ k x²",
        ],
    ),
    (
        "#[coordinates(x, y, z)] #[function(U(x, y, z) = potential)]
         #[lagrangian(-m*c^2*sqrt(1 - (x_dot^2 + y_dot^2 + z_dot^2)/c^2) - U(x, y, z))]
         struct Relativistic3 { m: f64, c: f64, potential: P }",
        &[
            "p_z = m γ ż",
            "E = m c² γ + U(x, y, z)",
            "m γ ẍ + m γ³ (ẋ ẍ + ẏ ÿ + ż z̈) ẋ/c² = −∂U/∂x",
        ],
    ),
    (
        "#[coordinates(r: [3])] #[function(A(r): [3] = potential)] #[function(phi(r) = scalar)]
         #[lagrangian(-m*c^2*sqrt(1 - dot(r_dot, r_dot)/c^2) + e*dot(r_dot, A(r)) - e*phi(r))]
         struct ChargeRelativistic { m: f64, c: f64, e: f64, potential: P, scalar: Q }",
        &[
            "γ = 1/√(1 − (ṙ·ṙ)/c²)",
            "p_r = m γ ṙ + e A(r)",
            "H = √(m² c⁴ + c² (p_r − e A(r))²) + e φ(r)",
            "ṙ = c² (p_r − e A(r))/√(m² c⁴ + c² (p_r − e A(r))²)",
        ],
    ),
    (
        "#[coordinates(x, y, z)]
         #[lagrangian(-m*c^2*sqrt(1 - (x_dot^2 + y_dot^2 + z_dot^2)/c^2) + e*B/2*(x*y_dot - y*x_dot) + e*E*z)]
         struct ChargeInFields { m: f64, c: f64, e: f64, B: f64, E: f64 }",
        &[
            "H = √(c² ((p_x + ½ e B y)² + (p_y − ½ e B x)² + p_z²) + m² c⁴) − e E z",
        ],
    ),
    (
        "#[coordinates(r: [3])] #[function(A(r): [3] = potential)] #[function(phi(r) = scalar)]
         #[lagrangian(m/2*dot(r_dot, r_dot) + e*dot(r_dot, A(r)) - e*phi(r))]
         struct Charge { m: f64, e: f64, potential: P, scalar: Q }",
        &[
            "H = (p_r − e A(r))²/(2 m) + e φ(r)",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(m/2*(x_dot^2 + y_dot^2) + e*B/2*(x*y_dot - y*x_dot))]
         struct Landau { m: f64, e: f64, B: f64 }",
        &[
            "H = (p_x + ½ e B y)²/(2 m) + (p_y − ½ e B x)²/(2 m)",
            "ẏ = (p_y − ½ e B x)/m",
            "ṗ_x = e B (p_y − ½ e B x)/(2 m)",
        ],
    ),
    (
        "#[coordinates(x)]
         #[lagrangian(a*abs(x_dot)^n/n - k*x^2/2)]
         struct PowerN { a: f64, n: f64, k: f64 }",
        &[
            "H = (n − 1) a (|p_x|/a)^(n/(n − 1))/n + ½ k x²",
            "ẋ = (|p_x|/a)^(1/(n − 1)) p_x/|p_x|",
        ],
    ),
    (
        "#[coordinates(x)]
         #[lagrangian(a*x_dot^4/4 - k*x^2/2)]
         struct Quartic { a: f64, k: f64 }",
        &[
            "H = ¾ a (|p_x|/a)^(4/3) + ½ k x²",
        ],
    ),
    (
        "#[coordinates(r: [3])]
         #[lagrangian(a*norm(r_dot)^3/3 + k/norm(r))]
         struct Cubic3 { a: f64, k: f64 }",
        &[
            "H = ⅔ a (|p_r|/a)^(3/2) − k/|r|",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(m/2*(x_dot^2 + y_dot^2) + k/sqrt(x^2 + y^2))]
         struct Kepler { m: f64, k: f64 }",
        &[
            "r = √(x² + y²)",
            "m ẍ = −k x/r³",
            "H = (p_x² + p_y²)/(2 m) − k/r",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian((x_dot^2 + y_dot^2)/2 + x*y_dot - y*x_dot + (x^2 + y^2)/2 + (1 - mu)/sqrt((x + mu)^2 + y^2) + mu/sqrt((x - 1 + mu)^2 + y^2))]
         struct Restricted { mu: f64 }",
        &[
            "r₁ = √((x + μ)² + y²)",
            "r₂ = √((x − 1 + μ)² + y²)",
            "ẍ = 2 ẏ + x − (1 − μ) (x + μ)/r₁³ − μ (x − 1 + μ)/r₂³",
        ],
    ),
    (
        "#[coordinates(x, y, z)] #[define(r1 = sqrt((x + mu)^2 + y^2 + z^2))] #[define(r2 = sqrt((x - 1 + mu)^2 + y^2 + z^2))]
         #[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 + x*y_dot - y*x_dot + (x^2 + y^2)/2 + (1 - mu)/r1 + mu/r2)]
         struct RestrictedNamed { mu: f64 }",
        &[
            "z̈ = −(1 − μ) z/r₁³ − μ z/r₂³",
        ],
    ),
    (
        "#[coordinates(a: [3], b: [3], c: [3])]
         #[lagrangian(ma/2*dot(a_dot, a_dot) + mb/2*dot(b_dot, b_dot) + mc/2*dot(c_dot, c_dot) + G*ma*mb/norm(a - b) + G*mb*mc/norm(b - c) + G*ma*mc/norm(a - c))]
         struct ThreeBodies { ma: f64, mb: f64, mc: f64, G: f64 }",
        &[
            "r_ab = |a − b|",
            "ä = G mb (b − a)/r_ab³ + G mc (c − a)/r_ac³",
        ],
    ),
    (
        "#[coordinates(x1, y1, x2, y2)]
         #[lagrangian(m1/2*(x1_dot^2 + y1_dot^2) + m2/2*(x2_dot^2 + y2_dot^2) + G*m1*m2/sqrt((x1 - x2)^2 + (y1 - y2)^2))]
         struct TwoBodies { m1: f64, m2: f64, G: f64 }",
        &[
            "r = √((x₁ − x₂)² + (y₁ − y₂)²)",
            "ẍ₁ = G m₂ (x₂ − x₁)/r³",
        ],
    ),
    (
        "#[coordinates(r: [3])]
         #[lagrangian(m/2*dot(r_dot, r_dot) + q1/norm(r - s1) + q2/norm(r - s2))]
         struct TwoCentres { m: f64, q1: f64, q2: f64, s1: [f64; 3], s2: [f64; 3] }",
        &[
            "d₁ = |r − s₁|",
            "m r̈ = −q₁ (r − s₁)/d₁³ − q₂ (r − s₂)/d₂³",
        ],
    ),
    (
        "#[coordinates(theta)] #[function(l(t) = length)]
         #[lagrangian(m/2*(der(l(t))^2 + l(t)^2*theta_dot^2) + m*g*l(t)*cos(theta))]
         struct VaryingLength { m: f64, g: f64, length: Length }",
        &[
            "l(t) θ̈ = −2 l′(t) θ̇ − g sin θ",
        ],
    ),
    (
        "#[coordinates(theta)] #[define(l = l0 - u*t)]
         #[lagrangian(m/2*(der(l)^2 + l^2*theta_dot^2) + m*g*l*cos(theta))]
         struct PulledPendulum { m: f64, g: f64, l0: f64, u: f64 }",
        &[
            "l θ̈ = 2 u θ̇ − g sin θ",
        ],
    ),
    (
        "#[coordinates(theta)]
         #[lagrangian(m*a^2/2*(theta_dot^2 + w^2*sin(theta)^2) + m*g*a*cos(theta))]
         struct BeadOnHoop { m: f64, a: f64, g: f64, w: f64 }",
        &[
            "a θ̈ = a w² sin θ cos θ − g sin θ",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*w*(x*y_dot - y*x_dot) + m/2*w^2*(x^2 + y^2) - k/2*(x^2 + y^2))]
         struct RotatingPlane { m: f64, w: f64, k: f64 }",
        &[
            "m ẍ = 2 m w ẏ + m w² x − k x",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(m/2*((x_dot - w*y)^2 + (y_dot + w*x)^2) - k/2*(x^2 + y^2))]
         struct RotatingPlaneSquares { m: f64, w: f64, k: f64 }",
        &[
            "m ẍ = 2 m w ẏ + m w² x − k x",
        ],
    ),
    (
        "#[coordinates(r)]
         #[lagrangian(m/2*(r_dot^2 + r^2*w^2) - k/2*(r - l)^2)]
         struct RotatingSpring { m: f64, w: f64, k: f64, l: f64 }",
        &[
            "m r̈ = m w² r − k (r − l)",
            "E = ½ m ṙ² + ½ k (r − l)² − ½ m w² r²",
        ],
    ),
    (
        "#[coordinates(r, phi)]
         #[lagrangian(m/2*(r_dot^2 + r^2*(phi_dot + w)^2) + k/r)]
         struct RotatingPolar { m: f64, w: f64, k: f64 }",
        &[
            "m r̈ = m r φ̇² + 2 m w r φ̇ + m w² r − k/r²",
        ],
    ),
    (
        "#[coordinates(r, theta)]
         #[lagrangian(m/2*(r_dot^2 + r^2*theta_dot^2) + m*g*r*cos(theta) - k/2*(r - l)^2)]
         struct SpringPendulum { m: f64, l: f64, g: f64, k: f64 }",
        &[
            "m r̈ = m r θ̇² + m g cos θ − k (r − l)",
        ],
    ),
    (
        "#[coordinates(x, theta)]
         #[lagrangian(m/2*(x_dot^2 + (l + x)^2*theta_dot^2) + m*g*(l + x)*cos(theta) - k/2*x^2)]
         struct ElasticPendulum { m: f64, l: f64, g: f64, k: f64 }",
        &[
            "ṗ_x = p_θ²/(m (l + x)³) + m g cos θ − k x",
        ],
    ),
    (
        "#[coordinates(phi)] #[define(x = l*sin(phi))] #[define(y = a*cos(gamma*t) - l*cos(phi))]
         #[lagrangian(m/2*(der(x)^2 + der(y)^2) - m*g*y)]
         struct VibratingSupport { m: f64, l: f64, a: f64, gamma: f64, g: f64 }",
        &[
            "l φ̈ = −(g − a γ² cos(γ t)) sin φ",
            "H = (p_φ + m l a γ sin(γ t) sin φ)²/(2 m l²) + m g y − ½ m a² γ² sin²(γ t)",
        ],
    ),
    (
        "#[coordinates(phi)]
         #[lagrangian(m/2*l^2*phi_dot^2 + m*l*(g - a*gamma^2*cos(gamma*t))*cos(phi))]
         struct VibratingSupportReduced { m: f64, l: f64, a: f64, gamma: f64, g: f64 }",
        &[
            "H = p_φ²/(2 m l²) − m l (g − a γ² cos(γ t)) cos φ",
        ],
    ),
    (
        "#[coordinates(x, phi)]
         #[lagrangian((M + m)/2*x_dot^2 + m/2*(l^2*phi_dot^2 + 2*l*x_dot*phi_dot*cos(phi)) + m*g*l*cos(phi))]
         struct CartPendulum { M: f64, m: f64, l: f64, g: f64 }",
        &[
            "H = (m l² p_x² + (M + m) p_φ² − 2 m l p_x p_φ cos φ)/(2 m l² (M + m sin² φ)) − m g l cos φ",
            "ẋ = (l p_x − p_φ cos φ)/(l (M + m sin² φ))",
            "φ̇ = ((M + m) p_φ − m l p_x cos φ)/(m l² (M + m sin² φ))",
        ],
    ),
    (
        "#[coordinates(phi1, phi2)]
         #[lagrangian((m1 + m2)/2*l1^2*phi1_dot^2 + m2/2*l2^2*phi2_dot^2 + m2*l1*l2*phi1_dot*phi2_dot*cos(phi1 - phi2) + (m1 + m2)*g*l1*cos(phi1) + m2*g*l2*cos(phi2))]
         struct DoublePendulum { m1: f64, m2: f64, l1: f64, l2: f64, g: f64 }",
        &[
            "φ̇₁ = (l₂ p_φ₁ − l₁ p_φ₂ cos(φ₁ − φ₂))/(l₁² l₂ (m₁ + m₂ sin²(φ₁ − φ₂)))",
        ],
    ),
    (
        "#[coordinates(r: [3])] #[define(A = cross(B, r)/2)]
         #[lagrangian(m/2*dot(r_dot, r_dot) + q*dot(A, r_dot) + q*dot(E, r))]
         struct ChargeInUniformFields { m: f64, q: f64, B: Vector3<f64>, E: Vector3<f64> }",
        &[
            "m r̈ = q (E + ṙ×B)",
            "ṙ = (p_r − q A)/m",
        ],
    ),
    (
        "#[coordinates(theta)]
         #[lagrangian(m*l^2/6*theta_dot^2 - m*g*l/2*cos(theta))]
         struct Ladder { m: f64, l: f64, g: f64 }",
        &[
            "2 l θ̈ = 3 g sin θ",
        ],
    ),
    (
        "#[coordinates(theta, phi, psi)]
         #[lagrangian(I1/2*(theta_dot^2 + sin(theta)^2*phi_dot^2) + I3/2*(psi_dot + phi_dot*cos(theta))^2 - M*g*l*cos(theta))]
         struct Top { I1: f64, I3: f64, M: f64, g: f64, l: f64 }",
        &[
            "H = p_θ²/(2 I₁) + (p_φ − p_ψ cos θ)²/(2 I₁ sin² θ) + p_ψ²/(2 I₃) + M g l cos θ",
            "φ̇ = (p_φ − p_ψ cos θ)/(I₁ sin² θ)",
            "ψ̇ = p_ψ/I₃ − (p_φ − p_ψ cos θ) cos(θ)/(I₁ sin² θ)",
        ],
    ),
    (
        "#[coordinates(r, phi)]
         #[lagrangian(-m*c^2*sqrt(1 - (r_dot^2 + r^2*phi_dot^2)/c^2) + k/r)]
         struct Sommerfeld { m: f64, c: f64, k: f64 }",
        &[
            "p_φ = m r² γ φ̇",
            "H = √(c² (p_r² + p_φ²/r²) + m² c⁴) − k/r",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(-m*c^2*sqrt(1 - ((x_dot - w*y)^2 + (y_dot + w*x)^2)/c^2))]
         struct RelativisticRotating { m: f64, c: f64, w: f64 }",
        &[
            "p_x = m γ (ẋ − w y)",
            "H = w (y p_x − x p_y) + √(c² p_x² + c² p_y² + m² c⁴)",
        ],
    ),
    (
        "#[coordinates(x1, x2)]
         #[lagrangian(-m1*c^2*sqrt(1 - x1_dot^2/c^2) - m2*c^2*sqrt(1 - x2_dot^2/c^2) - k/2*(x1 - x2)^2)]
         struct TwoRelativistic { m1: f64, m2: f64, c: f64, k: f64 }",
        &[
            "γ₂ = 1/√(1 − ẋ₂²/c²)",
            "m₁ γ₁³ ẍ₁ = k (x₂ − x₁)",
            "H = √(c² p_x₁² + m₁² c⁴) + √(c² p_x₂² + m₂² c⁴) + ½ k (x₁ − x₂)²",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(m/2*x_dot^2 - m*c^2*sqrt(1 - y_dot^2/c^2) - k*x*y)]
         struct Mixed { m: f64, c: f64, k: f64 }",
        &[
            "H = p_x²/(2 m) + √(c² p_y² + m² c⁴) + k x y",
        ],
    ),
    (
        "#[coordinates(u, v)]
         #[lagrangian(-m*c^2*sqrt(1 - (u_dot^2 + v_dot^2 + u_dot*v_dot)/c^2) - k*u*v)]
         struct Oblique { m: f64, c: f64, k: f64 }",
        &[
            "p_v = ½ m γ u̇ + m γ v̇",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(a/3*(x_dot^2 + 2*y_dot^2)^(3/2) + e*(x*y_dot - y*x_dot) - k*x)]
         struct PowerInField { a: f64, k: f64, e: f64 }",
        &[
            "H = ⅔ a (√((p_x + e y)² + ½ (p_y − e x)²)/a)^(3/2) + k x",
        ],
    ),
    (
        "#[coordinates(x)]
         #[lagrangian(a/4*(x_dot - w*x)^4 - k*x^2)]
         struct Shifted { a: f64, w: f64, k: f64 }",
        &[
            "H = ¾ a (|p_x|/a)^(4/3) + w x p_x + k x²",
        ],
    ),
    (
        "#[coordinates(x)] #[define(gamma = 1/sqrt(1 - x_dot^2/c^2))]
         #[lagrangian(-m*c^2/gamma - k/2*x^2)]
         struct UserGamma { m: f64, c: f64, k: f64 }",
        &[
            "p_x = m γ ẋ",
            "E = m c² γ + ½ k x²",
        ],
    ),
    (
        "#[coordinates(r: [3])] #[function(U(r) = potential)]
         #[lagrangian(-m*c^2*sqrt(1 - dot(r_dot, r_dot)/c^2) - U(r))]
         struct RelativisticVector { m: f64, c: f64, potential: P }",
        &[
            "m γ r̈ + m γ³ ṙ (ṙ·r̈)/c² = −∂U/∂r",
        ],
    ),
    (
        "#[coordinates(x1, y1, x2, y2, x3, y3)]
         #[lagrangian(m1/2*(x1_dot^2 + y1_dot^2) + m2/2*(x2_dot^2 + y2_dot^2) + m3/2*(x3_dot^2 + y3_dot^2) + G*m1*m2/sqrt((x1 - x2)^2 + (y1 - y2)^2) + G*m2*m3/sqrt((x2 - x3)^2 + (y2 - y3)^2) + G*m1*m3/sqrt((x1 - x3)^2 + (y1 - y3)^2))]
         struct ThreePlane { m1: f64, m2: f64, m3: f64, G: f64 }",
        &[
            "r₁₃ = √((x₁ − x₃)² + (y₁ − y₃)²)",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(m/2*(x_dot^2 + y_dot^2) - k/2*(sqrt(x^2 + y^2) - l)^2 - m*g*y)]
         struct ElasticPendulum2 { m: f64, k: f64, l: f64, g: f64 }",
        &[
            "m ẍ = k l x/r − k x",
        ],
    ),
    (
        "#[coordinates(x1, x2)]
         #[lagrangian(m1/2*x1_dot^2 + m2/2*x2_dot^2 - k1/2*x1^2 - k2/2*(x2 - x1)^2 - k3/2*x2^2)]
         struct Coupled { m1: f64, m2: f64, k1: f64, k2: f64, k3: f64 }",
        &[
            "E = ½ m₁ ẋ₁² + ½ m₂ ẋ₂² + ½ k₁ x₁² + ½ k₂ (x₂ − x₁)² + ½ k₃ x₂²",
            "H = p_x₁²/(2 m₁) + p_x₂²/(2 m₂) + ½ k₁ x₁² + ½ k₂ (x₂ − x₁)² + ½ k₃ x₂²",
        ],
    ),
    (
        "#[coordinates(phi1, phi2)]
         #[lagrangian((m1 + m2)/2*l1^2*phi1_dot^2 + m2/2*l2^2*phi2_dot^2 + m2*l1*l2*phi1_dot*phi2_dot*cos(phi1 - phi2) - (m1 + m2)*g*l1*(1 - cos(phi1)) - m2*g*l2*(1 - cos(phi2)))]
         struct DoublePendulum { m1: f64, m2: f64, l1: f64, l2: f64, g: f64 }",
        &[
            "E = ½ (m₁ + m₂) l₁² φ̇₁² + ½ m₂ l₂² φ̇₂² + m₂ l₁ l₂ φ̇₁ φ̇₂ cos(φ₁ − φ₂) + (m₁ + m₂) g l₁ (1 − cos φ₁) + m₂ g l₂ (1 − cos φ₂)",
            "p_φ₁ = (m₁ + m₂) l₁² φ̇₁ + m₂ l₁ l₂ φ̇₂ cos(φ₁ − φ₂)",
        ],
    ),
    (
        "#[coordinates(x)]
         #[lagrangian((m1 + m2)/2*l^2*x_dot^2 + (m1 + m2)*g*l*cos(x))]
         struct TwoMasses { m1: f64, m2: f64, l: f64, g: f64 }",
        &[
            "E = ½ (m₁ + m₂) l² ẋ² − (m₁ + m₂) g l cos x",
            "H = p_x²/(2 (m₁ + m₂) l²) − (m₁ + m₂) g l cos x",
        ],
    ),
    (
        "#[coordinates(theta)]
         #[lagrangian(m/2*R^2*(theta_dot^2 + omega^2*sin(theta)^2) + m*g*R*cos(theta))]
         struct Hoop { m: f64, R: f64, omega: f64, g: f64 }",
        &[
            "R θ̈ = R ω² sin θ cos θ − g sin θ",
            "E = ½ m R² θ̇² − m g R cos θ − ½ m R² ω² sin² θ",
            "H = p_θ²/(2 m R²) − m g R cos θ − ½ m R² ω² sin² θ",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(m/2*x_dot^2 + m/2*y_dot^2 - k/2*(a + x)^2 - k/2*(a - y)^2)]
         struct Springs { m: f64, k: f64, a: f64 }",
        &[
            "m ẍ = −k (a + x)",
            "E = ½ m (ẋ² + ẏ²) + ½ k (a + x)² + ½ k (a − y)²",
            "H = (p_x² + p_y²)/(2 m) + ½ k (a + x)² + ½ k (a − y)²",
        ],
    ),
    (
        "#[coordinates(x, theta)]
         #[lagrangian(m/2*(x_dot^2 + (l + x)^2*theta_dot^2) + m*g*(l + x)*cos(theta) - k/2*x^2)]
         struct ElasticPendulum { m: f64, l: f64, g: f64, k: f64 }",
        &[
            "m ẍ = m (l + x) θ̇² + m g cos θ − k x",
            "(l + x) θ̈ = −2 ẋ θ̇ − g sin θ",
            "E = ½ m (ẋ² + (l + x)² θ̇²) − m g (l + x) cos θ + ½ k x²",
            "H = p_x²/(2 m) + p_θ²/(2 m (l + x)²) − m g (l + x) cos θ + ½ k x²",
        ],
    ),
    (
        "#[coordinates(x, theta)]
         #[lagrangian(M/2*x_dot^2 + M/2*r^2*theta_dot^2 - M*g*(l - x)*sin(phi))]
         #[constraint(rolling: r*theta_dot = x_dot)]
         struct RollingHoop { M: f64, r: f64, g: f64, l: f64, phi: f64 }",
        &[
            "E = ½ M (ẋ² + r² θ̇²) + M g (l − x) sin φ",
            "H = p_x²/(2 M) + p_θ²/(2 M r²) + M g (l − x) sin φ",
        ],
    ),
    (
        "#[coordinates(x, y)] #[define(r1 = sqrt((x + mu)^2 + y^2))] #[define(r2 = sqrt((x - 1 + mu)^2 + y^2))]
         #[lagrangian((x_dot - y)^2/2 + (y_dot + x)^2/2 + (1 - mu)/r1 + mu/r2)]
         struct RestrictedSquares { mu: f64 }",
        &[
            "ẍ = 2 ẏ + x − (1 − μ) (x + μ)/r₁³ − μ (x − 1 + μ)/r₂³",
            "ÿ = y − 2 ẋ − (1 − μ) y/r₁³ − μ y/r₂³",
            "E = ½ (ẋ² + ẏ²) − ½ x² − ½ y² − (1 − μ)/r₁ − μ/r₂",
            "H = ½ (p_x² + p_y²) + y p_x − x p_y − (1 − μ)/r₁ − μ/r₂",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*w*(x*y_dot - y*x_dot) - m/2*w0^2*(x^2 + y^2))]
         struct Foucault { m: f64, w: f64, w0: f64 }",
        &[
            "H = (p_x² + p_y²)/(2 m) − w (x p_y − y p_x) + ½ m (w² + w₀²) (x² + y²)",
            "ṗ_x = w p_y − m (w² + w₀²) x",
        ],
    ),
    (
        "#[coordinates(theta1, theta2)]
         #[lagrangian((alpha + 2*beta*cos(theta2))/2*theta1_dot^2 + (delta + beta*cos(theta2))*theta1_dot*theta2_dot + delta/2*theta2_dot^2)]
         struct Arm { alpha: f64, beta: f64, delta: f64 }",
        &[
            "(α + 2 β cos θ₂) θ̈₁ + (δ + β cos θ₂) θ̈₂ = β θ̇₂² sin θ₂ + 2 β θ̇₁ θ̇₂ sin θ₂",
            "E = ½ (α + 2 β cos θ₂) θ̇₁² + (δ + β cos θ₂) θ̇₁ θ̇₂ + ½ δ θ̇₂²",
            "p_θ₁ = (α + 2 β cos θ₂) θ̇₁ + (δ + β cos θ₂) θ̇₂",
        ],
    ),
    (
        "#[coordinates(phi)] #[define(x = l*sin(phi))] #[define(y = a*cos(gamma*t) - l*cos(phi))]
         #[lagrangian(m/2*(der(x)^2 + der(y)^2) - m*g*y)]
         struct Kapitza { m: f64, l: f64, g: f64, a: f64, gamma: f64 }",
        &[
            "H = (p_φ + m l a γ sin(γ t) sin φ)²/(2 m l²) + m g y − ½ m a² γ² sin²(γ t)",
        ],
    ),
    (
        "#[coordinates(x, y)]
         #[lagrangian((x_dot^2 + y_dot^2)/2 - x^2/2 - y^2/2 - a*(x^2*y - y^3/3))]
         struct HenonHeiles { a: f64 }",
        &[
            "H = ½ p_x² + ½ p_y² + ½ x² + ½ y² + a (x² y − ⅓ y³)",
        ],
    ),
    (
        "#[coordinates(q1, q2)]
         #[lagrangian(L1/2*q1_dot^2 + L2/2*q2_dot^2 + M*q1_dot*q2_dot - (q1^2 + q2^2)/(2*C))]
         struct Circuits { L1: f64, L2: f64, M: f64, C: f64 }",
        &[
            "H = (L₂ p_q₁² + L₁ p_q₂² − 2 M p_q₁ p_q₂)/(2 (L₁ L₂ − M²)) + (q₁² + q₂²)/(2 C)",
        ],
    ),
    // Momenta are divided by entries of the mass matrix with their common factors in front.
    (
        "#[coordinates(x)] #[define(y = x^2/(2*a))]
         #[lagrangian(m/2 * (x_dot^2 + der(y)^2) - m*g*y)]
         struct Bead { m: f64, a: f64, g: f64 }",
        &[
            "E = ½ m (1 + x²/a²) ẋ² + m g y",
            "H = p_x²/(2 m (1 + x²/a²)) + m g y",
        ],
    ),
    // A sum of the Lagrangian is taken out of the motion, and cancels from all of it.
    (
        "#[coordinates(theta, phi)]
         #[lagrangian(m/2*(b^2*theta_dot^2 + (a + b*cos(theta))^2*phi_dot^2) - m*g*b*sin(theta))]
         struct Torus { m: f64, a: f64, b: f64, g: f64 }",
        &[
            "b θ̈ = −(a + b cos θ) φ̇² sin θ − g cos θ",
            "(a + b cos θ) φ̈ = 2 b θ̇ φ̇ sin θ",
        ],
    ),
    (
        "#[coordinates(r, theta)]
         #[lagrangian((M + m)/2*r_dot^2 + m/2*r^2*theta_dot^2 - g*r*(M - m*cos(theta)))]
         struct SwingingAtwood { M: f64, m: f64, g: f64 }",
        &[
            "(M + m) r̈ = m r θ̇² − g (M − m cos θ)",
        ],
    ),
    (
        "#[coordinates(x)] #[lagrangian(m/2*x_dot^2 - k/4*(x^2 - b^2)^2)]
         struct DoubleWell { m: f64, k: f64, b: f64 }",
        &[
            "m ẍ = −k x (x² − b²)",
        ],
    ),
    // Fractions beside accelerations are cleared.
    (
        "#[coordinates(phi)] #[lagrangian(3*m/4*(R - a)^2*phi_dot^2 + m*g*(R - a)*cos(phi))]
         struct CylinderInCylinder { m: f64, g: f64, R: f64, a: f64 }",
        &[
            "3 (R − a) φ̈ = −2 g sin φ",
        ],
    ),
    // ½ stands once, in front, or under the bar.
    (
        "#[coordinates(r)] #[lagrangian(m/2*(1 + 4*c^2*r^2)*r_dot^2 + m/2*omega^2*r^2 - m*g*c*r^2)]
         struct RotatingParabola { m: f64, c: f64, omega: f64, g: f64 }",
        &[
            "p_r = m (1 + 4 c² r²) ṙ",
        ],
    ),
];

/// Checks that each system has these lines on its page, not counting remarks, and none that is too long. At the level
/// `test`, one system in three is checked. `everywhere` compares the values of the lines.
pub(super) fn check_forms(entries: &[(&str, &[&str])]) {
    let mut missed = Vec::new();
    for (source, lines) in entries.iter().step_by(cases([3, 2, 1])) {
        let system = System::new(source.parse().expect("tokens")).unwrap_or_else(|| panic!("{source}"));
        let printed =
            system.forms[0][0].lines().map(|line| line.split("   (").next().unwrap_or_default().trim());
        let printed: Vec<&str> =
            printed.map(|line| line.split_once(": ").map_or(line, |(_, line)| line.trim())).collect();
        let missing = lines.iter().filter(|line| !printed.contains(line));
        missed.extend(missing.map(|line| format!("{line} is not in\n{}", printed.join("\n"))));
        assert!(!system.forms[0][0].contains(" symbols)"), "{}", system.forms[0][0]);
    }
    assert!(missed.is_empty(), "{}", missed.join("\n\n"));
}

#[test]
fn equations_have_the_forms_of_textbooks() {
    check_forms(ENTRIES);
}
