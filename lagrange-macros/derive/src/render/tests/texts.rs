//! Compares equations with those that textbooks print: they have the same terms, and are not longer by half.
//!
//! Both sides are compared together, as a set of terms whose factors have no order. An equation that a text prints
//! divided by a factor, θ̈ = −(g/l) sin θ, is stated here multiplied by it. Letters are those of the text, except that
//! velocities replace the letters that a text introduces for them. Works that are not open are cited by chapter:
//! editions number sections and equations differently.

use lagrange_random::cases;

use super::systems::System;

/// Source, system, and lines that the text prints.
struct Entry {
    text: &'static str,
    system: &'static str,
    lines: &'static [&'static str],
}

#[rustfmt::skip]
const ENTRIES: &[Entry] = &[
    Entry {
        text: "Milton, constraints and noninertial frames, (8.8)–(8.10): a sphere rolls down an incline",
        system: "#[coordinates(x, phi)] #[define(I = 2/5*m*a^2)]
            #[lagrangian(m/2*x_dot^2 + I/2*phi_dot^2 + m*g*x*sin(alpha))] #[constraint(roll: x_dot - a*phi_dot = 0)]
            struct S { m: f64, a: f64, g: f64, alpha: f64 }",
        lines: &["m ẍ = m g sin α + λ_roll", "I φ̈ = −a λ_roll"],
    },
    Entry {
        text: "Milton, (8.14), (8.17): the spherical pendulum",
        system: "#[coordinates(x, y, z)] #[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
            #[constraint(rod: (x^2 + y^2 + z^2 - l^2)/2 = 0)] struct S { m: f64, g: f64, l: f64 }",
        lines: &["m ẍ = λ_rod x", "m ÿ = λ_rod y", "m z̈ = −m g + λ_rod z", "E = ½ m (ẋ² + ẏ² + ż²) + m g z"],
    },
    Entry {
        text: "Tong, Classical Dynamics, 2.5.3: the spherical pendulum",
        system: "#[coordinates(theta, phi)]
            #[lagrangian(m*l^2/2*(theta_dot^2 + phi_dot^2*sin(theta)^2) + m*g*l*cos(theta))]
            struct S { m: f64, g: f64, l: f64 }",
        lines: &["l θ̈ = l φ̇² sin θ cos θ − g sin θ", "p_φ = m l² φ̇ sin² θ"],
    },
    Entry {
        text: "Wikipedia, Hamiltonian mechanics: the spherical pendulum",
        system: "#[coordinates(theta, phi)]
            #[lagrangian(m*l^2/2*(theta_dot^2 + sin(theta)^2*phi_dot^2) + m*g*l*cos(theta))]
            struct S { m: f64, g: f64, l: f64 }",
        lines: &[
            "p_θ = m l² θ̇", "p_φ = m l² φ̇ sin² θ",
            "H = p_θ²/(2 m l²) + p_φ²/(2 m l² sin² θ) − m g l cos θ",
            "θ̇ = p_θ/(m l²)", "φ̇ = p_φ/(m l² sin² θ)",
            "ṗ_θ = p_φ² cos θ/(m l² sin³ θ) − m g l sin θ", "ṗ_φ = 0",
        ],
    },
    Entry {
        text: "Wikipedia, Inverted pendulum: on a cart, by Lagrange's equations",
        system: "#[coordinates(x, theta)] #[define(px = x - l*sin(theta))] #[define(py = l*cos(theta))]
            #[lagrangian(M/2*x_dot^2 + m/2*(der(px)^2 + der(py)^2) - m*g*py)] #[force(x: F)]
            struct S { M: f64, m: f64, l: f64, g: f64, F: f64 }",
        lines: &["(M + m) ẍ − m l θ̈ cos θ + m l θ̇² sin θ = F", "l θ̈ − g sin θ = ẍ cos θ"],
    },
    Entry {
        text: "Wikipedia, Lagrangian mechanics: a pendulum on a movable support",
        system: "#[coordinates(x, theta)] #[define(px = x + l*sin(theta))] #[define(py = -l*cos(theta))]
            #[lagrangian(M/2*x_dot^2 + m/2*(der(px)^2 + der(py)^2) - m*g*py)]
            struct S { M: f64, m: f64, l: f64, g: f64 }",
        lines: &["p_x = (M + m) ẋ + m l θ̇ cos θ", "l θ̈ + ẍ cos θ + g sin θ = 0"],
    },
    Entry {
        text: "Landau and Lifshitz, Mechanics, problems to §5, The Lagrangian for a system of particles: the coplanar double pendulum",
        system: "#[coordinates(phi1, phi2)]
            #[define(x1 = l1*sin(phi1))] #[define(y1 = l1*cos(phi1))]
            #[define(x2 = x1 + l2*sin(phi2))] #[define(y2 = y1 + l2*cos(phi2))]
            #[lagrangian(m1/2*(der(x1)^2 + der(y1)^2) + m2/2*(der(x2)^2 + der(y2)^2) + m1*g*y1 + m2*g*y2)]
            struct S { m1: f64, m2: f64, l1: f64, l2: f64, g: f64 }",
        lines: &["L = ½ (m₁ + m₂) l₁² φ̇₁² + ½ m₂ l₂² φ̇₂² + m₂ l₁ l₂ φ̇₁ φ̇₂ cos(φ₁ − φ₂) + (m₁ + m₂) g l₁ cos φ₁ + m₂ g l₂ cos φ₂"],
    },
    Entry {
        text: "Weisstein, ScienceWorld, Double Pendulum",
        system: "#[coordinates(theta1, theta2)]
            #[define(x1 = l1*sin(theta1))] #[define(y1 = -l1*cos(theta1))]
            #[define(x2 = x1 + l2*sin(theta2))] #[define(y2 = y1 - l2*cos(theta2))]
            #[lagrangian(m1/2*(der(x1)^2 + der(y1)^2) + m2/2*(der(x2)^2 + der(y2)^2) - m1*g*y1 - m2*g*y2)]
            struct S { m1: f64, m2: f64, l1: f64, l2: f64, g: f64 }",
        lines: &[
            "(m₁ + m₂) l₁ θ̈₁ + m₂ l₂ θ̈₂ cos(θ₁ − θ₂) + m₂ l₂ θ̇₂² sin(θ₁ − θ₂) + g (m₁ + m₂) sin θ₁ = 0",
            "l₂ θ̈₂ + l₁ θ̈₁ cos(θ₁ − θ₂) − l₁ θ̇₁² sin(θ₁ − θ₂) + g sin θ₂ = 0",
        ],
    },
    Entry {
        text: "Morin, Introduction to Classical Mechanics, chapter 6, The Lagrangian method: a spring pendulum",
        system: "#[coordinates(x, theta)]
            #[lagrangian(m/2*(x_dot^2 + (l + x)^2*theta_dot^2) + m*g*(l + x)*cos(theta) - k/2*x^2)]
            struct S { m: f64, l: f64, g: f64, k: f64 }",
        lines: &["m ẍ = m (l + x) θ̇² + m g cos θ − k x", "(l + x) θ̈ + 2 ẋ θ̇ = −g sin θ"],
    },
    Entry {
        text: "Wikipedia, Swinging Atwood's machine: the second equation; and its L by T and U",
        system: "#[coordinates(r, theta)]
            #[lagrangian((M + m)/2*r_dot^2 + m/2*r^2*theta_dot^2 - g*r*(M - m*cos(theta)))]
            struct S { M: f64, m: f64, g: f64 }",
        lines: &["r θ̈ + 2 ṙ θ̇ + g sin θ = 0", "E = ½ (M + m) ṙ² + ½ m r² θ̇² + g r (M − m cos θ)"],
    },
    Entry {
        text: "Wikipedia, Foucault pendulum",
        system: "#[coordinates(x, y)]
            #[lagrangian((x_dot^2 + y_dot^2)/2 - omega^2/2*(x^2 + y^2) + Omega*sin(phi)*(x*y_dot - y*x_dot))]
            struct S { omega: f64, Omega: f64, phi: f64 }",
        lines: &["ẍ = −ω² x + 2 Ω ẏ sin φ", "ÿ = −ω² y − 2 Ω ẋ sin φ"],
    },
    Entry {
        text: "Wikipedia, Hénon–Heiles system, with k for its λ",
        system: "#[coordinates(x, y)]
            #[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - k*(x^2*y - y^3/3))] struct S { k: f64 }",
        lines: &["ẍ = −x − 2 k x y", "ÿ = −y − k (x² − y²)"],
    },
    Entry {
        text: "Wikipedia, Duffing equation",
        system: "#[coordinates(x)] #[lagrangian(x_dot^2/2 - alpha*x^2/2 - beta*x^4/4)]
            #[force(x: gamma*cos(omega*t) - delta*x_dot)]
            struct S { alpha: f64, beta: f64, gamma: f64, delta: f64, omega: f64 }",
        lines: &["ẍ + δ ẋ + α x + β x³ = γ cos(ω t)"],
    },
    Entry {
        text: "Goldstein, Classical Mechanics, chapter 3, The central force problem, with f = −V′",
        system: "#[coordinates(r, theta)] #[function(V(r) = potential)]
            #[lagrangian(m/2*(r_dot^2 + r^2*theta_dot^2) - V(r))] struct S { m: f64, potential: Potential }",
        lines: &["m r̈ − m r θ̇² = −V′(r)", "p_θ = m r² θ̇"],
    },
    Entry {
        text: "Goldstein, chapter 1, Survey of the elementary principles: Atwood's machine",
        system: "#[coordinates(x)] #[lagrangian((M1 + M2)/2*x_dot^2 + M1*g*x + M2*g*(l - x))]
            struct S { M1: f64, M2: f64, g: f64, l: f64 }",
        lines: &["(M₁ + M₂) ẍ = (M₁ − M₂) g"],
    },
    Entry {
        text: "Goldstein, chapter 1: a bead on a rotating wire",
        system: "#[coordinates(r)] #[define(x = r*cos(omega*t))] #[define(y = r*sin(omega*t))]
            #[lagrangian(m/2*(der(x)^2 + der(y)^2))] struct S { m: f64, omega: f64 }",
        lines: &["r̈ = r ω²"],
    },
    Entry {
        text: "Goldstein, chapter 2, Variational principles and Lagrange's equations: a hoop rolls down an inclined plane",
        system: "#[coordinates(x, theta)]
            #[lagrangian(M/2*x_dot^2 + M*r^2/2*theta_dot^2 - M*g*(l - x)*sin(phi))]
            #[constraint(roll: r*theta_dot - x_dot = 0)] struct S { M: f64, r: f64, g: f64, l: f64, phi: f64 }",
        lines: &["M ẍ − M g sin φ + λ_roll = 0", "M r θ̈ − λ_roll = 0"],
    },
    Entry {
        text: "Landau and Lifshitz, problems to §40, Hamilton's equations: H in cylindrical coordinates",
        system: "#[coordinates(r, phi, z)] #[function(U(r, phi, z) = potential)]
            #[lagrangian(m/2*(r_dot^2 + r^2*phi_dot^2 + z_dot^2) - U(r, phi, z))]
            struct S { m: f64, potential: Potential }",
        lines: &["H = (p_r² + p_φ²/r² + p_z²)/(2 m) + U(r, φ, z)"],
    },
    Entry {
        text: "Landau and Lifshitz, problems to §40: H in spherical coordinates",
        system: "#[coordinates(r, theta, phi)] #[function(U(r, theta, phi) = potential)]
            #[lagrangian(m/2*(r_dot^2 + r^2*theta_dot^2 + r^2*sin(theta)^2*phi_dot^2) - U(r, theta, phi))]
            struct S { m: f64, potential: Potential }",
        lines: &["H = (p_r² + p_θ²/r² + p_φ²/(r² sin² θ))/(2 m) + U(r, θ, φ)"],
    },
    Entry {
        text: "Wikipedia, Normal mode: two masses between three springs",
        system: "#[coordinates(x1, x2)]
            #[lagrangian(m/2*(x1_dot^2 + x2_dot^2) - k/2*(x1^2 + (x2 - x1)^2 + x2^2))] struct S { m: f64, k: f64 }",
        lines: &["m ẍ₁ = −2 k x₁ + k x₂", "m ẍ₂ = −2 k x₂ + k x₁"],
    },
    Entry {
        text: "Wikipedia, Pendulum (mechanics)",
        system: "#[coordinates(theta)] #[define(x = l*sin(theta))] #[define(y = -l*cos(theta))]
            #[lagrangian(m/2*(der(x)^2 + der(y)^2) - m*g*y)] struct S { m: f64, l: f64, g: f64 }",
        lines: &["l θ̈ + g sin θ = 0"],
    },
    Entry {
        text: "Goldstein, chapter 2: a series circuit",
        system: "#[coordinates(q)] #[lagrangian(L0/2*q_dot^2 - q^2/(2*C))] #[force(q: V - R*q_dot)]
            struct S { L0: f64, C: f64, R: f64, V: f64 }",
        lines: &["L₀ q̈ + R q̇ + q/C = V"],
    },
    Entry {
        text: "Tong, 3.6: the heavy symmetric top",
        system: "#[coordinates(theta, phi, psi)]
            #[lagrangian(I1/2*(theta_dot^2 + sin(theta)^2*phi_dot^2) + I3/2*(psi_dot + phi_dot*cos(theta))^2 - M*g*l*cos(theta))]
            struct S { I1: f64, I3: f64, M: f64, g: f64, l: f64 }",
        lines: &[
            "p_ψ = I₃ (ψ̇ + φ̇ cos θ)", "p_φ = I₁ φ̇ sin² θ + I₃ (ψ̇ + φ̇ cos θ) cos θ",
            "E = ½ I₁ (θ̇² + φ̇² sin² θ) + ½ I₃ (ψ̇ + φ̇ cos θ)² + M g l cos θ",
        ],
    },
    Entry {
        text: "Strogatz, Nonlinear Dynamics and Chaos, 3.5: an overdamped bead on a rotating hoop",
        system: "#[coordinates(phi)]
            #[lagrangian(m*r^2/2*(phi_dot^2 + omega^2*sin(phi)^2) + m*g*r*cos(phi))] #[force(phi: -b*r*phi_dot)]
            struct S { m: f64, r: f64, omega: f64, g: f64, b: f64 }",
        lines: &["m r φ̈ = −b φ̇ − m g sin φ + m r ω² sin φ cos φ"],
    },
    Entry {
        text: "Strogatz, chapter 12, Strange attractors: the forced double well",
        system: "#[coordinates(x)] #[lagrangian(x_dot^2/2 + x^2/2 - x^4/4)] #[force(x: F*cos(omega*t) - delta*x_dot)]
            struct S { F: f64, omega: f64, delta: f64 }",
        lines: &["ẍ + δ ẋ − x + x³ = F cos(ω t)"],
    },
    Entry {
        text: "Wikipedia, Clohessy–Wiltshire equations",
        system: "#[coordinates(x, y, z)]
            #[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 + n*(x*y_dot - y*x_dot) + n^2/2*(3*x^2 - z^2))]
            struct S { n: f64 }",
        lines: &["ẍ = 3 n² x + 2 n ẏ", "ÿ = −2 n ẋ", "z̈ = −n² z"],
    },
    Entry {
        text: "Murray and Dermott, Solar System Dynamics, chapter 3, The restricted three-body problem",
        system: "#[coordinates(x, y, z)] #[function(U(x, y, z) = potential)]
            #[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 + n*(x*y_dot - y*x_dot) + U(x, y, z))]
            struct S { n: f64, potential: Potential }",
        lines: &["ẍ − 2 n ẏ = ∂U/∂x", "ÿ + 2 n ẋ = ∂U/∂y", "z̈ = ∂U/∂z"],
    },
    Entry {
        text: "Landau and Lifshitz, chapter V, Small oscillations: two oscillators coupled by α x y",
        system: "#[coordinates(x, y)]
            #[lagrangian((x_dot^2 + y_dot^2)/2 - omega0^2/2*(x^2 + y^2) + alpha*x*y)] struct S { omega0: f64, alpha: f64 }",
        lines: &["ẍ + ω₀² x = α y", "ÿ + ω₀² y = α x"],
    },
    Entry {
        text: "Wikipedia, Harmonic oscillator: damped and driven",
        system: "#[coordinates(x)] #[lagrangian(m/2*x_dot^2 - k/2*x^2)] #[dissipation(c/2*x_dot^2)] #[force(x: F*cos(omega*t))]
            struct S { m: f64, k: f64, c: f64, F: f64, omega: f64 }",
        lines: &["m ẍ = F cos(ω t) − k x − c ẋ"],
    },
    Entry {
        text: "Feynman, Lectures, volume II, The motion of charges in electric and magnetic fields: a uniform field along z",
        system: "#[coordinates(x, y)] #[lagrangian(m/2*(x_dot^2 + y_dot^2) + q*B/2*(x*y_dot - y*x_dot))]
            struct S { m: f64, q: f64, B: f64 }",
        lines: &["m ẍ = q B ẏ", "m ÿ = −q B ẋ"],
    },
];

/// Largest accepted ratio of a length to that of the equation in the text. A longer equation is not what a person
/// writes.
const LONGER: f64 = 1.5;

#[test]
fn texts_print_the_same_equations() {
    let mut missed = Vec::new();
    for Entry { text, system, lines } in ENTRIES.iter().step_by(cases([3, 2, 1])) {
        let system =
            System::new(system.parse().expect("tokens")).unwrap_or_else(|| panic!("{text}: {system}"));
        let printed: Vec<&str> =
            system.forms.iter().flat_map(|[text, ..]| text.lines()).map(str::trim).collect();
        let printed = printed.iter().map(|line| line.split("   (").next().unwrap_or_default());
        let printed: Vec<&str> =
            printed.map(|line| line.split_once(": ").map_or(line, |(_, line)| line.trim())).collect();
        for line in *lines {
            let equal =
                printed.iter().find(|printed| printed.contains(" = ") && terms(printed) == terms(line));
            match equal {
                Some(equal) => {
                    let [ours, theirs] = [equal, line].map(|line| line.chars().count() as f64);
                    assert!(ours <= LONGER * theirs, "{equal} for {line}");
                }
                None => missed.push(format!("{text}: {line}\n{}", system.forms[0][0])),
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n\n"));
}

/// Terms of both sides, those of the right with the opposite sign, each as a sorted list of factors.
fn terms(equation: &str) -> Vec<String> {
    let (left, right) = equation.split_once(" = ").expect("an equation");
    let [one, other] = [false, true].map(|sign| {
        let mut terms = [sum(left, sign), sum(right, !sign)].concat();
        terms.retain(|term| !term.ends_with("0/"));
        terms.sort();
        terms
    });
    one.min(other)
}

/// Splits a sum at the signs outside parentheses.
fn sum(text: &str, is_negative: bool) -> Vec<String> {
    let text = text.trim();
    let (first, text) = text.strip_prefix('−').map_or((false, text), |rest| (true, rest));
    let mut parts = Vec::new();
    let (mut sign, mut rest) = (first, text);
    while let Some((end, next)) = split(rest, &[" + ", " − "]) {
        parts.push((sign, &rest[..end]));
        sign = next == " − ";
        rest = &rest[end + next.len()..];
    }
    parts.push((sign, rest));
    parts.into_iter().map(|(sign, part)| product(part, sign != is_negative)).collect()
}

/// First position of one of these signs outside parentheses.
fn split<'a>(text: &str, signs: &[&'a str]) -> Option<(usize, &'a str)> {
    let mut depth = 0;
    for (place, sign) in text.char_indices() {
        depth += i32::from(sign == '(') - i32::from(sign == ')');
        let found = signs.iter().find(|sign| text[place..].starts_with(**sign));
        if let Some(found) = found.filter(|_| depth == 0) {
            return Some((place, found));
        }
    }
    None
}

/// Normal form of a product: sign, and sorted factors over sorted factors.
fn product(text: &str, is_negative: bool) -> String {
    let (above, below) = split(text, &["/"]).map_or((text, ""), |(end, _)| (&text[..end], &text[end + 1..]));
    let below = below.strip_prefix('(').and_then(|inner| inner.strip_suffix(')')).unwrap_or(below);
    let (above, is_turned) = factors(above);
    let (below, _) = factors(below);
    format!("{}{above}/{below}", if is_negative != is_turned { '−' } else { '+' })
}

/// Sorted factors, and whether the sign of a sum among them was reversed.
fn factors(text: &str) -> (String, bool) {
    let (mut rest, mut factors, mut is_turned) = (text, Vec::new(), false);
    while !rest.is_empty() {
        let next = |text: &str| split(text, &[" "]).map_or(text.len(), |(end, _)| end);
        let mut end = next(rest);
        // A bare argument belongs to its function.
        if ["sin", "cos"].contains(&rest[..end].trim_end_matches(['²', '³'])) {
            end += 1 + next(&rest[end + 1..]);
        }
        let (factor, turned) = factor(&rest[..end]);
        factors.push(factor);
        is_turned ^= turned;
        rest = rest.get(end + 1..).unwrap_or("");
    }
    factors.sort();
    (factors.join(" "), is_turned)
}

/// Normal form of a factor, and whether its sign was reversed: `cos(θ)` becomes `cos θ`, and a sum takes the sign that
/// sorts first.
fn factor(text: &str) -> (String, bool) {
    let inner = text.strip_prefix('(').and_then(|rest| rest.rsplit_once(')'));
    if let Some((inner, power)) = inner {
        let [one, other] = [false, true].map(|sign| {
            let mut terms = sum(inner, sign);
            terms.sort();
            terms.join(" ")
        });
        let is_turned = other < one;
        return (format!("({}){power}", one.min(other)), is_turned && power.is_empty());
    }
    let is_function = ["sin", "cos"].iter().any(|name| text.starts_with(name));
    match is_function {
        true => (text.replacen('(', " ", 1).trim_end_matches(')').replace("  ", " "), false),
        false => (text.to_owned(), false),
    }
}
