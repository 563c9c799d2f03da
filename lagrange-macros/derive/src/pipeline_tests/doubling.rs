//! Definitions that use the previous one twice: written out, the last is 2⁶⁰ times as long as the first. No stage
//! expands them, wherever they appear.

use lagrange_random::cases;

use super::tokens;
use crate::expand;

const DEPTH: usize = 60;

/// Each definition aₖ₊₁ as a function of aₖ, written `A`.
const STEPS: [&str; 3] = ["A + A*sin(A)*x", "A/(1 + A^2)", "A*(A + x)"];

/// Attributes that use the last definition, written `A`.
const USES: [&str; 7] = [
    "#[lagrangian(m/2*(x_dot^2 + y_dot^2) - A)]",
    "#[lagrangian((1 + A^2)*x_dot^2 + y_dot^2 + der(A))]",
    "#[lagrangian(x_dot^2 + y_dot^2)] #[constraint(c: A = 0)]",
    "#[lagrangian(x_dot^2 + y_dot^2)] #[constraint(c: A*x_dot + y_dot = 0)]",
    "#[lagrangian(x_dot^2 + y_dot^2)] #[constraint(c: A*(x_dot + m*y_dot) = 0)]",
    "#[lagrangian(x_dot^2 + y_dot^2)] #[observable(o = der(A))] #[force(x: A)]",
    "#[lagrangian(x_dot^2 + y_dot^2)] #[conserved(o = A)]",
];

fn expansion(step: &str, uses: &str) -> String {
    let mut source = String::from("#[coordinates(x, y)] #[define(a0 = x + m*y)]");
    for k in 1..=DEPTH {
        source += &format!("#[define(a{k} = {})]", step.replace('A', &format!("a{}", k - 1)));
    }
    source += &format!("{} struct Doubling {{ m: f64 }}", uses.replace('A', &format!("a{DEPTH}")));
    expand(tokens(&source)).to_string()
}

#[test]
fn what_doubles_sixty_times_is_derived() {
    let all = STEPS.iter().flat_map(|step| USES.map(|uses| (step, uses)));
    for (step, uses) in all.step_by(cases([8, 4, 1])) {
        let expansion = expansion(step, uses);
        let is_refused = expansion.contains("compile_error");
        assert_eq!(is_refused, uses.contains("conserved"), "{step}, {uses}");
        assert!(expansion.len() < 2_400_000, "{} characters for {step}, {uses}", expansion.len());
    }
}

/// The equations as text contain the last definition by name, and give the length of an expression that is too long
/// to show.
#[test]
fn what_doubles_sixty_times_is_not_written_out() {
    let written = expansion(STEPS[0], USES[0]);
    assert!(written.contains("− a₆₀") && written.contains(" symbols)"), "{written}");
}
