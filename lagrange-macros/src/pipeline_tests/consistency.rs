//! Constraints that cannot all hold, or that say the same.

use super::tokens;
use crate::expand;

/// The errors for a system with these constraints, called a, b, c, ….
fn said(constraints: &[&str]) -> Vec<String> {
    let attributes: String = ('a'..)
        .zip(constraints)
        .map(|(name, equation)| format!("#[constraint({name}: {equation})]\n"))
        .collect();
    let source = format!(
        "#[coordinates(x, y, z)]
         #[function(f(t))]
         #[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) - m*y)]
         {attributes}
         struct System<F> {{ m: f64, h: f64, k: f64, f: F }}"
    );
    let emitted = expand(tokens(&source)).to_string();
    emitted
        .split("compile_error ! {")
        .skip(1)
        .filter_map(|rest| rest.split('"').nth(1))
        .map(String::from)
        .collect()
}

#[test]
fn numbers_contradict_each_other() {
    for (constraints, wanted) in [
        (&["y = 0", "y = 1"][..], "`b` contradicts `a`: together they say -1 = 0"),
        (&["x^2 + y^2 = 1", "3*x^2 + 3*y^2 = 4"], "`b` contradicts `a`: together they say -1 = 0"),
        (&["x + y = 1", "x - y = 0", "x = 3"], "`c` contradicts `a`, `b`: together they say -5/2 = 0"),
        (&["x_dot = 0", "z = 0", "x_dot = 1"], "`c` contradicts `a`: together they say -1 = 0"),
        // From the rates: y' = 0 and y' = 1.
        (&["y = 2", "y_dot = 1"], "`a` contradicts `b`: together they say"),
        (&["x*(y + z) = sqrt(2)", "x*(y + z) = 1"], "`b` contradicts `a`: together they leave an equation"),
    ] {
        let found = said(constraints);
        assert!(found[0].starts_with(wanted), "{constraints:?}: {found:?}");
        assert!(found[1..].iter().all(|error| error == "the other one is here"), "{found:?}");
    }
}

#[test]
fn what_holds_at_one_time_only_contradicts() {
    for constraints in [["y = 0", "y = sin(t)"], ["y = t", "y = t^2 + pi"], ["y = t", "2*y_dot = 2*t"]] {
        let found = said(&constraints);
        assert!(found[0].contains("does not hold at all times"), "{constraints:?}: {found:?}");
    }
}

/// Whatever the parameters are, one of the two is one too many.
#[test]
fn two_that_differ_in_parameters_contradict_or_repeat() {
    for (constraints, names) in [
        (["y = 0", "y = h"], "`h`"),
        (["x^2 + y^2 = h^2", "2*x^2 = k - 2*y^2"], "`h`, `k`"),
        (["y = h*t", "y = sin(k)"], "`h`, `k`"),
        (["y = f(t)", "y = t"], "`f`"),
    ] {
        let found = said(&constraints);
        let wanted = format!(
            "`b` contradicts `a`, or says the same: together they leave an equation in {names} without a coordinate. Leave one of them out"
        );
        assert_eq!(found, [wanted.as_str(), "the other one is here"], "{constraints:?}");
    }
}

#[test]
fn repeated_ones_are_found_under_factors() {
    for constraints in
        [["x = y", "2*y - 2*x = 0"], ["x = h*y", "-1/3*x + h*y/3 = 0"], ["x_dot = 0", "5*x_dot = 0"]]
    {
        assert_eq!(
            said(&constraints),
            ["`b` says the same as `a`: leave one of them out", "the other one is here"]
        );
    }
}

/// Constraints that depend on one another may be given: the numbers at run time tell.
#[test]
fn what_may_hold_is_let_through() {
    for constraints in [
        &["x + y = 1", "x - y = 0", "2*x = 1"][..],
        &["x + y = h", "x - y = 0", "2*x = k"],
        &["x = 0", "x_dot = 0"],
        &["x = h", "x_dot = 0"],
        &["x*y = 0", "x*z = 0", "y*z = 0"],
        &["x = 0", "h*x = 1"],
        &["x^2 + y^2 = 1", "x^2 + z^2 = 1", "y^2 - z^2 = 0"],
        &["x = sin(h)^2 + cos(h)^2", "x = 1"],
        &["x = f(t)", "y = f(t)"],
        &["x + y = f(t)", "x - y = 0", "x = 0"],
    ] {
        assert_eq!(said(constraints), [""; 0], "{constraints:?}");
    }
}
