//! Equations as texts print them: what is printed here has the same terms, and is not longer by half.
//!
//! Compared are both sides together, as a set of terms whose factors have no order; an equation that a text prints divided by a
//! factor, θ̈ = −(g/l) sin θ, is stated here multiplied by it.

use super::everywhere::System;

/// Where it stands, the system, and lines that the text prints.
struct Entry {
    source: &'static str,
    system: &'static str,
    lines: &'static [&'static str],
}

const ENTRIES: &[Entry] = &[
    Entry {
        source: "Milton, chapter 8, (8.8)–(8.10)",
        system: "#[coordinates(x, phi)] #[define(I = 2/5*m*a^2)]
            #[lagrangian(m/2*x_dot^2 + I/2*phi_dot^2 + m*g*x*sin(alpha))] #[constraint(roll: x_dot - a*phi_dot = 0)]
            struct S { m: f64, a: f64, g: f64, alpha: f64 }",
        lines: &["m ẍ = m g sin α + λ_roll", "I φ̈ = −a λ_roll", "E = ½ m ẋ² + ½ I φ̇² − m g x sin α"],
    },
    Entry {
        source: "Milton, chapter 8, (8.14), (8.17)",
        system: "#[coordinates(x, y, z)] #[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
            #[constraint(rod: (x^2 + y^2 + z^2 - l^2)/2 = 0)] struct S { m: f64, g: f64, l: f64 }",
        lines: &["m ẍ = λ_rod x", "m ÿ = λ_rod y", "m z̈ = −m g + λ_rod z", "E = ½ m (ẋ² + ẏ² + ż²) + m g z"],
    },
    Entry {
        source: "Tong, Classical Dynamics, 2.5.5: the spherical pendulum, (2.66)–(2.70)",
        system: "#[coordinates(theta, phi)]
            #[lagrangian(m*l^2/2*(theta_dot^2 + phi_dot^2*sin(theta)^2) + m*g*l*cos(theta))]
            struct S { m: f64, g: f64, l: f64 }",
        lines: &["l θ̈ = l φ̇² sin θ cos θ − g sin θ", "p_phi = m l² φ̇ sin² θ"],
    },
    Entry {
        source: "Wikipedia, Hamiltonian mechanics, Example: the spherical pendulum",
        system: "#[coordinates(theta, phi)]
            #[lagrangian(m*l^2/2*(theta_dot^2 + sin(theta)^2*phi_dot^2) + m*g*l*cos(theta))]
            struct S { m: f64, g: f64, l: f64 }",
        lines: &[
            "p_theta = m l² θ̇",
            "p_phi = m l² sin² θ φ̇",
            "H = p_theta²/(2 m l²) + p_phi²/(2 m l² sin² θ) − m g l cos θ",
            "θ̇ = p_theta/(m l²)",
            "φ̇ = p_phi/(m l² sin² θ)",
            "ṗ_theta = p_phi² cos θ/(m l² sin³ θ) − m g l sin θ",
            "ṗ_phi = 0",
        ],
    },
    Entry {
        source: "Wikipedia, Inverted pendulum, Inverted pendulum on a cart, equations of motion from Lagrange's equations",
        system: "#[coordinates(x, theta)]
            #[define(px = x - l*sin(theta))] #[define(py = l*cos(theta))]
            #[lagrangian(M/2*x_dot^2 + m/2*(der(px)^2 + der(py)^2) - m*g*py)] #[force(x: F)]
            struct S { M: f64, m: f64, l: f64, g: f64, F: f64 }",
        lines: &[
            "(M + m) ẍ − m l θ̈ cos θ + m l θ̇² sin θ = F",
            "l θ̈ − g sin θ = ẍ cos θ",
        ],
    },
    Entry {
        source: "Wikipedia, Lagrangian mechanics, Examples: pendulum on a movable support",
        system: "#[coordinates(x, theta)]
            #[define(px = x + l*sin(theta))] #[define(py = -l*cos(theta))]
            #[lagrangian(M/2*x_dot^2 + m/2*(der(px)^2 + der(py)^2) - m*g*py)]
            struct S { M: f64, m: f64, l: f64, g: f64 }",
        lines: &[
            "p_x = (M + m) ẋ + m l θ̇ cos θ",
            "l θ̈ + ẍ cos θ + g sin θ = 0",
        ],
    },
    Entry {
        source: "Landau and Lifshitz, Mechanics, §5, problem 1: the coplanar double pendulum, by T and U of its Lagrangian",
        system: "#[coordinates(phi1, phi2)]
            #[define(x1 = l1*sin(phi1))] #[define(y1 = l1*cos(phi1))]
            #[define(x2 = x1 + l2*sin(phi2))] #[define(y2 = y1 + l2*cos(phi2))]
            #[lagrangian(m1/2*(der(x1)^2 + der(y1)^2) + m2/2*(der(x2)^2 + der(y2)^2) + m1*g*y1 + m2*g*y2)]
            struct S { m1: f64, m2: f64, l1: f64, l2: f64, g: f64 }",
        lines: &[
            "E = ½ (m1 + m2) l1² φ̇1² + ½ m2 l2² φ̇2² + m2 l1 l2 φ̇1 φ̇2 cos(φ1 − φ2) − (m1 + m2) g l1 cos φ1 − m2 g l2 cos φ2",
        ],
    },
];
