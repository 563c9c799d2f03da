//! The library outside of a compiler: text in, equations, facts and errors out.

use lagrange_derive::{Refusal, System};

/// Program that prints the equations of a double pendulum.
#[test]
fn twenty_lines_print_the_equations_of_a_system() -> Result<(), Refusal> {
    let system = System::parse(
        "#[coordinates(theta1, theta2)]
         #[define(v1 = der([l*sin(theta1), -l*cos(theta1)]))]
         #[define(v2 = v1 + der([l*sin(theta2), -l*cos(theta2)]))]
         #[lagrangian(m/2 * (dot(v1, v1) + dot(v2, v2)) + m*g*l*(2*cos(theta1) + cos(theta2)))]
         struct DoublePendulum { m: f64, l: f64, g: f64 }",
    )?;
    let printed = system.to_string();
    println!("{printed}");
    assert!(printed.contains("θ₁: 2 l θ̈₁ + l θ̈₂ cos(θ₁ − θ₂) = −l θ̇₂² sin(θ₁ − θ₂) − 2 g sin θ₁"));
    assert!(printed.contains("θ₂: l θ̈₁ cos(θ₁ − θ₂) + l θ̈₂ = l θ̇₁² sin(θ₁ − θ₂) − g sin θ₂"));
    Ok(())
}

#[test]
fn names_of_arrays_are_those_of_their_elements() -> Result<(), Refusal> {
    let system = System::parse(
        "#[coordinates(x: [2], r#type)]
         #[function(U(x) = field)]
         #[lagrangian(m[1]/2 * dot(x_dot, x_dot) + type_dot^2/2 - U(x))]
         #[constraint(fixed: x = [0, a])]
         #[observable(place = [x[0], x[1], type])]
         struct r#struct<F> { a: f64, m: [f64; 2], field: F }",
    )?;
    assert_eq!(system.name(), "struct");
    assert_eq!(system.coordinates(), ["x[0]", "x[1]", "type"]);
    assert_eq!(system.velocities(), ["x_dot[0]", "x_dot[1]", "type_dot"]);
    assert_eq!(system.parameters(), ["a", "m[1]"]);
    assert_eq!(system.functions(), ["U"]);
    assert_eq!(system.observables(), ["place[0]", "place[1]", "place[2]"]);
    let constraints: Vec<_> = system.constraints().iter().map(|constraint| &*constraint.name).collect();
    assert_eq!(constraints, ["fixed[0]", "fixed[1]"]);
    Ok(())
}

/// Running indices stand as numbers, sums within sums, and no equation is stated for elements that have another one.
#[test]
fn equations_of_all_elements_hold_for_them() -> Result<(), Refusal> {
    let printed = |text: &str| Ok::<_, Refusal>(System::parse(text)?.to_string());
    let weighted = printed(
        "#[coordinates(q: [n])]
         #[define(mean = sum(i in 0..n, q[i])/n)]
         #[lagrangian(sum(i in 0..n, q_dot[i]^2/2 - i*q[i]^2/n) - q[0])]
         #[force(q[i in 0..n]: mean*i + sum(j in 0..i, sin(q[j]*i)))]
         struct S { n: usize }",
    )?;
    assert!(weighted.contains("q[0]: q̈[0] = −1\n"), "{weighted}");
    let others = "q̈[i] = i (Σ(l = 0 … n − 1) q[l])/n + Σ(l = 0 … i − 1) sin(q[l] i) − 2 q[i] i/n   (for i = 1 … n − 1)";
    assert!(weighted.contains(others), "{weighted}");
    let limited = printed(
        "#[coordinates(q: [n])]
         #[lagrangian(sum(i in 0..n, q_dot[i]^2/2))]
         #[force(q[i in 0..n]: max(-f, min(f, sum(j in 0..n, clamp(q[j], -1, 1)))))]
         struct S { n: usize, f: f64 }",
    )?;
    let force = "Q_q[i = 0 … n − 1] = max(−f, min(f, Σ(j = 0 … n − 1) clamp(q[j], −1, 1)))";
    assert!(limited.contains(force), "{limited}");
    let product = printed(
        "#[coordinates(q: [n])]
         #[define(mean = sum(i in 0..n, q[i]))]
         #[lagrangian(sum(i in 0..n, q_dot[i]^2/2) - sum(i in 1..n, i*q[i]*mean))]
         struct S { n: usize }",
    )?;
    assert!(product.contains("q̈[0] = −Σ(j = 1 … n − 1) q[j] j"), "{product}");
    let fixed = printed(
        "#[coordinates(u: [n, w])]
         #[lagrangian(sum(i in 0..n, sum(j in 0..w, u_dot[i][j]^2/2)) - u[0][0]^2)]
         struct S { n: usize, w: usize }",
    )?;
    assert!(fixed.contains("ü[i][j] = 0   (for elements that are not at an edge)"), "{fixed}");
    let two_lengths = printed(
        "#[coordinates(q: [n])]
         #[lagrangian(sum(i in 0..n, q_dot[i]^2/2) - sum(i in 0..n-3, q[i]^2) - sum(i in 0..k, q[i]^4))]
         struct S { n: usize, k: usize }",
    )?;
    assert!(!two_lengths.contains("q̈[i] ="), "{two_lengths}");
    let triangle = printed(
        "#[coordinates(x: [n], y: [n])]
         #[lagrangian(sum(i in 0..n, x_dot[i]^2/2 + y_dot[i]^2/2) - sum(k in 0..n, sum(j in 0..k, k*x[j+1]*y[j])))]
         struct S { n: usize, k: f64 }",
    )?;
    assert!(triangle.contains("x[0]: ẍ[0] = 0\n"), "{triangle}");
    assert!(
        triangle.contains("x[i]: ẍ[i] = −y[i − 1] Σ(j = i … n − 1) j   (for i = 1 … n − 1)"),
        "{triangle}"
    );
    let beyond = printed(
        "#[coordinates(x: [n])]
         #[lagrangian(sum(i in 0..n, x_dot[i]^2/2) - sum(i in 2..n, sum(j in 0..i, x[j]^2)))]
         struct S { n: usize }",
    )?;
    assert!(!beyond.contains("ẍ[i] ="), "{beyond}");
    Ok(())
}

/// Returns what a terminal shows of a refused text.
fn shown(text: &str) -> String {
    System::parse(text).expect_err(text).to_string()
}

/// A compiler knows no such attributes either.
#[test]
fn attributes_that_nobody_knows_are_refused() {
    let text = "#[coordinates(x)]\n#[lagrangian(x_dot^2/2)]\n#[dissipaton(x_dot^2/2)]\n#[damping(c)]\n#[serde(default)]\n#[derive(Clone)]\nstruct S;";
    let refusal = System::parse(text).expect_err("two slips");
    let [near, other] = refusal.diagnostics() else { panic!("{refusal}") };
    assert_eq!(near.to_string(), "3:3: no attribute is called `dissipaton`: did you mean `dissipation`?");
    assert!(
        other.message().starts_with("no attribute is called `damping`: there are `coordinates`, "),
        "{other}"
    );
    let known = text.replace("#[dissipaton(x_dot^2/2)]", "").replace("#[damping(c)]", "");
    assert!(System::parse(&known).is_ok());
}

#[test]
fn text_without_a_struct_is_told_what_a_system_is() {
    for (text, place) in [("", ""), ("m/2*x_dot^2 - m*g*x", "1:19: "), ("fn main() {}", "1:11: ")] {
        let refusal = System::parse(text).expect_err(text);
        let wanted = format!("{place}a system is a struct, after its attributes: `#[coordinates(x)]");
        assert!(refusal.to_string().starts_with(&wanted), "{refusal}");
    }
}

#[test]
fn a_constraint_with_an_error_is_not_told_to_be_missing() {
    let refusal = System::parse(
        "#[coordinates(x, y)]\n#[lagrangian(x_dot^2/2 + y_dot^2/2)]\n#[constraint(along: x = q)]\n#[observable(pull = lambda(along))]\nstruct S;",
    );
    let refusal = refusal.expect_err("no q");
    assert_eq!(refusal.diagnostics().len(), 1, "{refusal}");
}

#[test]
fn text_that_is_no_rust_is_refused_where_it_ends_to_be() {
    for (text, wanted) in [
        ("struct System { m: f64", "1:15: this is never closed\nstruct System { m: f64\n              ^"),
        ("#[coordinates(x)\nstruct S;", "1:2: this is never closed\n#[coordinates(x)\n ^"),
        (
            "#[coordinates(x))]\nstruct S;",
            "1:17: either a `]` is missing before this `)`, or it is one too many\n#[coordinates(x))]\n                ^\n\n1:2: this `[` is open until then\n#[coordinates(x))]\n ^",
        ),
        ("struct S;\n\t}", "2:2: this closes nothing that is open\n\t}\n\t^"),
        (
            "#[lagrangian(sin(x)]\nstruct S;",
            "1:20: either a `)` is missing before this `]`, or it is one too many\n#[lagrangian(sin(x)]\n                   ^\n\n1:13: this `(` is open until then\n#[lagrangian(sin(x)]\n            ^",
        ),
        (
            "#[lagrangian(φ̇² − ½*x)]\nstruct S;",
            "1:16: instead of `²`, write `^2`\n#[lagrangian(φ̇² − ½*x)]\n              ^\n\n1:18: instead of `−`, write `-`\n#[lagrangian(φ̇² − ½*x)]\n                ^\n\n1:20: instead of `½`, write `1/2*`\n#[lagrangian(φ̇² − ½*x)]\n                  ^",
        ),
        ("/* struct S;", "1:1: no token of Rust begins here\n/* struct S;\n^"),
        ("struct \"S", "1:8: no token of Rust begins here\nstruct \"S\n       ^"),
    ] {
        assert_eq!(shown(text), wanted, "{text}");
    }
}

#[test]
fn text_of_something_else_is_refused() {
    for text in ["", "fn main() {}", "struct", "struct S; struct T;", "#![no_std] struct S;", "1 + 1"] {
        let refusal = System::parse(text).expect_err(text);
        assert_eq!(refusal.diagnostics().len(), 1, "{text}: {refusal}");
        assert!(!refusal.diagnostics()[0].message().is_empty(), "{text}");
    }
}

#[test]
fn an_error_is_shown_with_its_notes_and_the_first_line_of_what_is_wrong() {
    let text = "#[coordinates(x)]
#[lagrangian(x_dot^2)]
#[lagrangian(
    θ̈ + x
)]
struct System;";
    assert_eq!(
        shown(text),
        "\
3:3: `#[lagrangian(…)]` is given twice: a system has one Lagrangian: write it as one sum
#[lagrangian(
  ^^^^^^^^^^^ …

2:3: the first one is here
#[lagrangian(x_dot^2)]
  ^^^^^^^^^^^^^^^^^^^"
    );
    let refusal = System::parse(text).expect_err(text);
    let [error] = refusal.diagnostics() else { panic!("{refusal}") };
    let location = error.location().expect("it comes from the text");
    assert_eq!(&text[location.bytes.clone()], location.text);
    assert_eq!(location.text, "lagrangian(\n    θ̈ + x\n)");
    assert_eq!(error.notes().len(), 1);
}

/// Programs of a test and of a server share an error among threads.
#[test]
fn a_refusal_is_an_error_of_any_program() {
    let refused: Result<System, Box<dyn std::error::Error + Send + Sync>> =
        System::parse("struct System;").map_err(Into::into);
    assert!(refused.expect_err("no attributes").to_string().contains("`#[coordinates(…)]` is missing"));
}

fn printed(text: &str) -> String {
    System::parse(text).expect("a system").to_string()
}

/// Even powers of a distance keep its bars: a vector has a square, but no sixth power.
#[test]
fn powers_of_distances_are_those_of_norms() {
    let text = "#[coordinates(r: [n, 3])]
#[lagrangian(sum(i in 0..n, dot(r_dot[i], r_dot[i])/2) - sum(i in 0..n, sum(j in 0..i, (s/norm(r[i] - r[j]))^6)))]
struct Gas { n: usize, s: f64 }";
    let equations = printed(text);
    let row = "r̈[i] = 6 s⁶ Σ(j ≠ i) (r[i] − r[j])/|r[i] − r[j]|⁸";
    assert!(equations.contains(row), "{equations}");
    let equations = printed(
        "#[coordinates(r: [2, 3])]
#[lagrangian(dot(r_dot[0], r_dot[0])/2 + dot(r_dot[1], r_dot[1])/2 - (s/norm(r[0] - r[1]))^6)]
struct Pair { s: f64 }",
    );
    for line in ["r[1]: r̈[1] = 6 s⁶ (r[1] − r[0])/|r[0] − r[1]|⁸", "+ s⁶/|r[0] − r[1]|⁶"] {
        assert!(equations.contains(line), "{equations}");
    }
}

/// Multipliers under a sum over a table have its index, and belong into it.
#[test]
fn multipliers_stand_in_the_sums_of_their_constraints() {
    let equations = printed(
        "#[coordinates(x: [n])]
#[parameter(bond: [bonds, 2])]
#[lagrangian(sum(i in 0..n, x_dot[i]^2/2))]
#[constraint(rod[b in 0..bonds]: x[bond[b][0]] - 2*x[bond[b][1]] = 1)]
struct Chain { n: usize, bond: Vec<[usize; 2]> }",
    );
    let row = "ẍ[i] = Σ(bond[j][0] = i) λ_rod[j] − 2 Σ(bond[j][1] = i) λ_rod[j]";
    assert!(equations.contains(row), "{equations}");
    let stated = "rod[b = 0 … bonds − 1]: x[bond[b][0]] − 2 x[bond[b][1]] = 1   (holonomic)";
    assert!(equations.contains(stated), "{equations}");
}

/// A constraint whose forces act from outside takes the momentum from what is conserved, and one that moves takes the energy.
#[test]
fn constraints_from_outside_conserve_less() {
    let held = |constraint: &str| {
        printed(&format!(
            "#[coordinates(r: [n, 3])]
#[lagrangian(sum(i in 0..n, dot(r_dot[i], r_dot[i])/2))]
#[constraint({constraint})]
struct Chain {{ n: usize, l: f64 }}"
        ))
    };
    let conserved = |text: &str, name: &str| {
        let section = text.split("Conserved").nth(1).unwrap_or_default();
        section.split("\n\n").next().unwrap_or_default().contains(name)
    };
    for (constraint, expected) in [
        ("rod[i in 1..n]: norm(r[i] - r[i-1]) = l", [true, true, true]),
        ("hung: norm(r[0]) = l", [false, true, true]),
        ("floor: r[0][2] = 0", [false, false, true]),
        ("carried: r[0][2] = sin(t)", [false, false, false]),
        ("apart[i in 1..n]: norm(r[i] - r[i-1]) = l + t", [true, true, false]),
    ] {
        let text = held(constraint);
        assert_eq!(["P = ", "J = ", "E = "].map(|name| conserved(&text, name)), expected, "{text}");
    }
}
