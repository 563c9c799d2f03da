//! Letters of the page give way to those of the system: no symbol has two meanings, in text, LaTeX and MathML.
//!
//! [`everywhere`](super::everywhere) asserts of every system that no two quantities are written alike, in text.

use super::everywhere::check;
use super::systems::System;

/// The page of a system as text, LaTeX and HTML.
fn page(source: &str) -> [String; 3] {
    let system = System::new(source.parse().expect("tokens")).unwrap_or_else(|| panic!("{source}"));
    check(&system);
    let [page, ..] = system.forms;
    page
}

#[test]
fn energy_and_hamiltonian_give_way_to_fields_and_a_mass() {
    let [text, latex, html] = page(
        "#[coordinates(r: [3])]
         #[lagrangian(H/2*dot(r_dot, r_dot) + q/2*dot(cross(B, r), r_dot) + q*dot(E, r))]
         struct Charge { H: f64, q: f64, E: [f64; 3], B: [f64; 3] }",
    );
    assert!(text.contains("\n  ℰ = ½ H ṙ·ṙ − q E·r "), "{text}");
    assert!(text.contains("\n  ℋ = (p_r·p_r)/(2 H) "), "{text}");
    assert!(latex.contains(r"\mathcal{E} &= \tfrac{1}{2} H \dot{\mathbf{r}}"), "{latex}");
    assert!(latex.contains(r"\mathcal{H} &= ") && !latex.contains(r"\mathbf{E} &= "), "{latex}");
    // Programs and references find the rows by the usual letters.
    assert!(latex.contains(r"\label{eq:Charge-E}") && latex.contains(r"\label{eq:Charge-H}"), "{latex}");
    for (left, other) in [("ℰ", "𝐄"), ("ℋ", "H")] {
        let is_left =
            |letter| html.contains(&format!("<math displaystyle=\"true\"><mi>{letter}</mi></math></div>"));
        assert!(is_left(left) && !is_left(other), "{html}");
    }
}

#[test]
fn all_other_letters_give_way_too() {
    let [text, latex, _] = page(
        "#[coordinates(x, L)]
         #[lagrangian(T/2*x_dot^2 + U/2*L_dot^2 - D*x*L + p_x*x + lambda_floor*L)]
         #[constraint(floor: x - R_x*L = 0)] #[dissipation(Q/2*x_dot^2)]
         struct Letters { T: f64, U: f64, D: f64, p_x: f64, lambda_floor: f64, R_x: f64, Q: f64 }",
    );
    for line in [
        "ℒ = ½ T ẋ² + ½ U L̇² − D x L + p_x x + λ_floor L",
        "ℱ = ½ Q ẋ²",
        "x: T ẍ = p_x − Q ẋ − D L + Λ_floor",
        "ℛ_L = −R_x Λ_floor",
        "E = ½ T ẋ² + ½ U L̇² + D x L − p_x x − λ_floor L   (K + V if V is D x L − p_x x − λ_floor L)",
        "d/dt E = −Q ẋ²   (𝒬·q̇)",
        "P_x = T ẋ",
        "H = P_x²/(2 T) + P_L²/(2 U) + D x L − p_x x − λ_floor L",
        "Ṗ_L = λ_floor − D x − R_x Λ_floor",
    ] {
        assert!(text.lines().any(|printed| printed.trim() == line), "{line} is not in {text}");
    }
    for label in ["L", "D", "R_x", "p_x", "p-dot_x"] {
        assert!(latex.contains(&format!("\\label{{eq:Letters-{label}}}")), "{label} is not in {latex}");
    }
}
