//! Errors for unknown names, with suggestions.

use super::tokens;
use crate::expand;

/// Returns the errors for a system with `term` as a term of L.
fn said(term: &str) -> String {
    let source = format!(
        "#[coordinates(theta, phi, stiffening, r: [3])]
         #[lagrangian(theta_dot^2/2 + phi_dot^2 + stiffening_dot^2 + dot(r_dot, r_dot) + {term})]
         struct System {{ g: f64, mass: f64, k2: f64, load1: f64, l: [f64; 4] }}"
    );
    expand(tokens(&source)).to_string()
}

fn assert_said(term: &str, wanted: &str) {
    let found = said(term);
    let first = found.split("compile_error").nth(1).unwrap_or_default();
    assert!(first.contains(wanted), "{term}: {}", first.chars().take(200).collect::<String>());
}

#[test]
fn slips_of_the_fingers() {
    for (term, meant) in [
        ("cos(tetha)", "theta"),
        ("tehta", "theta"),
        ("thetta", "theta"),
        ("Theta", "theta"),
        ("masss", "mass"),
        ("stifening", "stiffening"),
        ("k_2", "k2"),
        ("thetadot^2", "theta_dot"),
        ("snin(theta)", "sin"),
        ("tahn(theta)", "tanh"),
        ("PI", "pi"),
        ("thta_dot^2", "theta_dot"),
        ("theta_dott^2", "theta_dot"),
        ("Theta_dot^2", "theta_dot"),
    ] {
        assert_said(term, &format!("did you mean `{meant}`?"));
    }
}

#[test]
fn other_names_for_the_same() {
    for (term, meant) in [
        ("m*theta", "mass"),
        ("gravity", "g"),
        ("θ", "theta"),
        ("ϑ", "theta"),
        ("θ_dot", "theta_dot"),
        ("varphi", "phi"),
        ("dtheta", "theta_dot"),
        ("dot_theta", "theta_dot"),
        ("vphi", "phi_dot"),
        ("v_phi", "phi_dot"),
        ("theta_d", "theta_dot"),
        ("theta_dt", "theta_dot"),
        ("phi_do", "phi_dot"),
        ("phi_prime", "phi_dot"),
        ("theta_dot_dot", "theta_ddot"),
        ("thetaddot", "theta_ddot"),
        ("ddtheta", "theta_ddot"),
        ("rdot[0]", "r_dot"),
    ] {
        assert_said(term, &format!("did you mean `{meant}`?"));
    }
    for (term, advice) in [
        ("cos(time)", "the time is `t`"),
        ("mass·g", "a product is written `mass*g`"),
        ("mass·g·sin(theta)", "a product is written `mass*g*sin`"),
        ("exp1", "a parameter is a field of the struct, and the exponential function is `exp(x)`"),
        ("30*deg", "a degree is `pi/180`"),
        ("Sin*theta", "functions are written `sin(x)`"),
        ("vel^2", "the velocity of `theta` is `theta_dot`"),
        ("l1", "the elements of `l` are `l[0]` to `l[3]`"),
        ("r_2", "the elements of `r` are `r[0]` to `r[2]`"),
        ("r1_dot", "the elements of `r` are `r_dot[0]` to `r_dot[2]`"),
        ("r_dot_1", "the elements of `r` are `r_dot[0]` to `r_dot[2]`"),
        ("y_dot^2", "it would be the velocity of `y`: add `y` to the `#[coordinates(…)]`"),
        ("psi_ddot", "it would be the acceleration of `psi`: add `psi`"),
    ] {
        assert_said(term, advice);
    }
}

#[test]
fn functions_of_other_tools() {
    for (term, advice) in [
        ("arcsin(theta)", "inverse functions are `asin`"),
        ("log(theta)", "the natural logarithm is `ln`"),
        ("pow(theta, 2)", "a power is written `x^2`"),
        ("sqr(theta)", "a square is written `x^2`"),
        ("fabs(theta)", "the absolute value is `abs(x)`"),
        ("diff(theta, t)", "the total time derivative is `der(x)`"),
        ("Derivative(theta, t)", "the total time derivative is `der(x)`"),
        ("dot(theta)", "the velocity of `x` is `x_dot`"),
        ("der(theta, t)", "it is by the time, `der(x)`"),
        ("atan(theta, phi)", "is `atan2(y, x)`"),
        ("norm(theta, phi)", "a vector is written `[x, y]`"),
        ("sind(theta)", "angles are in radians"),
        ("product(theta)", "defined one by one"),
    ] {
        assert_said(term, advice);
    }
}

/// A wrong guess is worse than none.
#[test]
fn no_guesses() {
    for term in [
        "m2", "k3", "load2", "omega", "U(theta)", "alpha", "psi", "W", "x", "tau", "delta", "v1", "energy",
        "s_dot", "psi_dot", "psi_ddot", "l_max",
    ] {
        let found = said(term);
        assert!(!found.contains("did you mean") && !found.contains("elements of"), "{term}: {found:.300}");
    }
}

/// If no name is similar, the error lists up to four names; of more, the three least unlike, and the number of the others.
#[test]
fn where_nothing_is_near_the_nearest_names_are_told() {
    let said = |constraints: usize| {
        let constraints: String =
            (0..constraints).map(|k| format!("#[constraint(stop{k}: x[{k}] = 0)]")).collect();
        let source = format!(
            "#[coordinates(x: [12])]
             #[lagrangian(dot(x_dot, x_dot))]
             {constraints}
             #[observable(push = lambda(wall))]
             struct System;"
        );
        expand(tokens(&source)).to_string()
    };
    for (constraints, wanted) in [
        (0, "`wall`: there are no constraints"),
        (1, "`wall`: the only constraint is `stop0`"),
        (3, "`wall`: the constraints are `stop0`, `stop1` and `stop2`"),
        (4, "`wall`: the constraints are `stop0`, `stop1`, `stop2` and `stop3`"),
        (5, "`wall`: the constraints are `stop0`, `stop1`, `stop2` and 2 more"),
        (11, "`stop0`, `stop1`, `stop2` and 8 more"),
    ] {
        let found = said(constraints);
        assert!(found.contains(wanted), "{constraints}: {found:.300}");
    }
    let unlike = "#[coordinates(x, y)]
         #[lagrangian(x_dot^2 + y_dot^2)]
         #[constraint(spring: x = 0)]
         #[constraint(belt: y = 0)]
         #[constraint(wheel: x = y)]
         #[constraint(floor: x = -y)]
         #[constraint(walled: x = 2*y)]
         #[observable(push = lambda(wand))]
         struct System;";
    let found = expand(tokens(unlike)).to_string();
    assert!(found.contains("the constraints are `walled`, `belt`, `wheel` and 2 more"), "{found:.900}");
}
