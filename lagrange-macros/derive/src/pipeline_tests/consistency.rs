//! Constraints that contradict each other, and redundant constraints.

use super::{declaration, tokens};
use crate::diagnostics::Diagnostics;
use crate::mechanics;
use crate::resolve;
use crate::{expand, stub};
use lagrange_random::{Random, rounds};

/// Returns the errors for a system with these constraints, named a, b, c, ….
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
    messages(&expand(tokens(&source)).to_string())
}

fn messages(emitted: &str) -> Vec<String> {
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
        // The rates contradict each other: y' = 0 and y' = 1.
        (&["y = 2", "y_dot = 1"], "`b` contradicts `a`: together they say -1 = 0"),
        (&["x = sin(h)^2 + cos(h)^2", "x = 2"], "`b` contradicts `a`: together they say -1 = 0"),
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

/// For any parameter values, the two constraints contradict each other or are the same.
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

/// A redundant constraint is an error. The message depends on which other constraints imply it.
#[test]
fn what_follows_from_others_is_one_too_many() {
    let too = "`b` follows from `a`, which holds for velocities, too: leave `b` out";
    for (constraints, wanted) in [
        (&["x - h*y = 0", "x_dot - h*y_dot = 0"][..], too),
        (&["x = 0", "x_dot = 0"], too),
        (&["x = h", "x_dot = 0"], too),
        (&["x = h*t", "2*x_dot = 2*h"], too),
        (&["x^2 + y^2 = h^2", "x*x_dot + y*y_dot = 0"], too),
        (&["sqrt(x^2 + y^2) = h", "x*x_dot + y*y_dot = 0"], too),
        (&["x^2 + y^2 = h^2", "(x*x_dot + y*y_dot)/sqrt(x^2 + y^2) = 0"], too),
        (&["x = sin(y)", "x_dot*cos(y) - y_dot*(1 - sin(y)^2) = 0"], too),
        (&["x*y = f(t)", "x*y_dot + y*x_dot = der(f(t))"], too),
        (&["(x - y)^2 + z^2 = h", "x*(x_dot - y_dot) + z*z_dot = y*(x_dot - y_dot)"], too),
        // The holonomic constraint is kept, in either order.
        (
            &["x_dot - h*y_dot = 0", "x - h*y = 0"],
            "`a` follows from `b`, which holds for velocities, too: leave `a` out",
        ),
        (
            &["x = h*y", "y = k*z", "x_dot = h*k*z_dot"],
            "`c` follows from `a`, `b`, which hold for velocities, too: leave `c` out",
        ),
        (&["x + y = 1", "x - y = 0", "2*x = 1"], "`c` follows from `a`, `b`: leave `c` out"),
        (&["x^2 + y^2 = 1", "x^2 + z^2 = 1", "y^2 - z^2 = 0"], "`c` follows from `a`, `b`: leave `c` out"),
        (
            &["x_dot = y*z_dot", "y_dot = x*z_dot", "x_dot + y_dot = (x + y)*z_dot"],
            "`c` follows from `a`, `b`: leave `c` out",
        ),
        (
            &["x_dot*cos(z) + y_dot*sin(z) = h", "y_dot*cos(z) - x_dot*sin(z) = 0", "x_dot = h*cos(z)"],
            "`c` follows from `a`, `b`: leave `c` out",
        ),
        (&["x_dot = y*z_dot", "sin(y)*x_dot = sin(y)*y*z_dot"], "`b` follows from `a`: leave `b` out"),
        (&["sin(y)*x_dot = sin(y)*y*z_dot", "x_dot = y*z_dot"], "`a` follows from `b`: leave `a` out"),
        (&["h*x_dot = h*y_dot", "x_dot = y_dot"], "`a` follows from `b`: leave `a` out"),
        (
            &["x*x_dot + y*y_dot = 1", "(x*x_dot + y*y_dot)/sqrt(x^2 + y^2) = 1/sqrt(x^2 + y^2)"],
            "`b` follows from `a`: leave `b` out",
        ),
        (&["x = 0", "h*x = 1"], "`b` contradicts `a`, or follows from it: leave `b` out"),
        (
            &["x^2 + y^2 + z^2 = 1", "z = 0", "x^2 + y^2 = 1"],
            "`c` contradicts `a`, `b`, or follows from them: leave `c` out",
        ),
        (
            &["x + y = h", "x - y = 0", "2*x = k"],
            "`c` contradicts `a`, `b`, or says the same: together they leave an equation in `h`, `k` without a coordinate. Leave one of them out",
        ),
        (
            &["x + y = f(t)", "x - y = 0", "x = 0"],
            "`c` contradicts `a`, `b`, or says the same: together they leave an equation in `f` without a coordinate. Leave one of them out",
        ),
        (&["x = sin(h)^2 + cos(h)^2", "x = 1"], "`b` says the same as `a`: leave one of them out"),
        (&["(x + y)^2 = h", "x^2 + 2*x*y + y^2 = h"], "`b` says the same as `a`: leave one of them out"),
    ] {
        let found = said(constraints);
        assert_eq!(found.first().map(String::as_str), Some(wanted), "{constraints:?}");
    }
}

/// Accepts constraints that depend on one another only at some states or for some parameters. The numerical
/// solution at run time detects such states.
#[test]
fn what_may_be_needed_is_let_through() {
    for constraints in [
        &["x*y = 0", "x*z = 0", "y*z = 0"][..],
        &["x = f(t)", "y = f(t)"],
        &["h*x = 0", "k*x = 0"],
        &["x = y", "x_dot = h*y_dot"],
        // Only on the constraint surface does the last constraint follow from the others.
        &["x^2 + y^2 = h^2", "(2 + x)*(x^2 + y^2 - h^2) = 0"],
        &["x^2 + y^2 = h^2", "x*x_dot + y*y_dot = (x^2 + y^2 - h^2)*x_dot"],
        &["x = 0", "y_dot = 0", "x*y_dot + (y + x)*x_dot = x*z_dot"],
        // Each of the three is needed where the coefficients of the other two vanish.
        &["y*x_dot = x*y_dot", "z*x_dot = x*z_dot", "z*y_dot = y*z_dot"],
        // At rest both constraints hold, together with y = 0.
        &["x_dot = 0", "x_dot = y"],
        &["x_dot = h", "x_dot*sin(z)^2 = 1 - h*cos(z)^2"],
        &["x*x_dot + y*y_dot = 1", "(x*x_dot + y*y_dot)/sqrt(x^2 + y^2) = 1"],
    ] {
        assert_eq!(said(constraints), [""; 0], "{constraints:?}");
    }
}

const N: usize = 6;

/// Returns the errors for these constraints on `N` coordinates q, without code generation.
fn wrong(constraints: &[String]) -> Vec<String> {
    let attributes: String = (0..)
        .zip(constraints)
        .map(|(number, equation)| format!("#[constraint(c{number}: {equation} = 0)]\n"))
        .collect();
    let source = format!(
        "#[coordinates(q: [{N}])] #[lagrangian(m/2*dot(q_dot, q_dot))] {attributes}
         struct System {{ m: f64, h: f64, k: f64 }}"
    );
    let (declaration, mut diagnostics): (_, Diagnostics) = declaration(&source);
    let (mut graph, problem) = resolve::problem(&declaration, &mut diagnostics).expect("a problem");
    match mechanics::derive(&mut graph, &problem, &mut diagnostics) {
        Some(_) => Vec::new(),
        None => messages(&stub(&declaration, diagnostics.into_errors()).to_string()),
    }
}

/// A constraint Σ c_k f_k(q_k), or its rate as a velocity constraint. Gradients are linearly independent if their
/// coefficient vectors c are.
struct Sums {
    functions: Vec<String>,
}

impl Sums {
    fn draw(random: &mut Random) -> Self {
        let forms = [
            "q[#]",
            "sin(q[#])",
            "(q[#]^3 + 2*q[#])",
            "exp(h*q[#])",
            "q[#]*cos(q[*])",
            "sqrt(2 + q[#]^2)*q[#]",
        ];
        let mut function = |k: usize| {
            let form = random.one_of(&forms);
            form.replace('#', &k.to_string())
                .replace('*', "@")
                .replace("[@]", &format!("[{}]", (k + 1) % N))
                .replace('@', "*")
        };
        Self { functions: (0..N).map(&mut function).collect() }
    }

    fn of(&self, coefficients: &[i64], is_rate: bool) -> String {
        let terms = coefficients.iter().zip(&self.functions).filter(|(c, _)| **c != 0);
        let sum = terms.map(|(c, function)| format!("({c})*{function}")).collect::<Vec<_>>().join(" + ");
        if is_rate { format!("der({sum})") } else { sum }
    }
}

/// Returns true if rows of small integers are linearly independent, by fraction-free elimination.
fn independent(rows: &[Vec<i64>]) -> bool {
    let mut rows: Vec<Vec<i128>> = rows.iter().map(|row| row.iter().map(|&c| c.into()).collect()).collect();
    for step in 0..rows.len() {
        let Some(column) = rows[step].iter().position(|&c| c != 0) else { return false };
        let pivot = rows[step].clone();
        for row in &mut rows[step + 1..] {
            let factor = row[column];
            row.iter_mut().zip(&pivot).for_each(|(c, &above)| *c = *c * pivot[column] - factor * above);
        }
    }
    true
}

#[test]
fn random_constraints_that_are_independent_are_let_through_and_combinations_are_not() {
    rounds("combinations of constraints", [20, 60, 5_000], |random| {
        let sums = Sums::draw(random);
        let count = 1 + random.below(4);
        let rows = loop {
            let row = |random: &mut Random| (0..N).map(|_| random.below(5) as i64 - 2).collect();
            let rows: Vec<Vec<i64>> = (0..count).map(|_| row(random)).collect();
            if independent(&rows) {
                break rows;
            }
        };
        let rates: Vec<bool> = rows.iter().map(|_| random.once_in(2)).collect();
        let mut constraints: Vec<String> =
            rows.iter().zip(&rates).map(|(row, &is_rate)| sums.of(row, is_rate)).collect();
        assert_eq!(wrong(&constraints), [""; 0], "{constraints:?}");
        let factors: Vec<i64> = rows.iter().map(|_| random.below(7) as i64 - 3).collect();
        let combined = |i: usize| rows.iter().zip(&factors).map(|(row, c)| c * row[i]).sum();
        let combined: Vec<i64> = (0..N).map(combined).collect();
        let mut used: Vec<usize> = (0..count).filter(|&k| factors[k] != 0).collect();
        if used.is_empty() {
            return;
        }
        // A combination of at most two rates may get a factor that depends on the position.
        let is_rate = random.once_in(2);
        let factor = if is_rate && used.len() <= 2 {
            random.one_of(&["1", "(2 + q[0]^2)", "sin(q[1] + q[2])", "k"])
        } else {
            "1"
        };
        constraints.push(format!("{factor}*({})", sums.of(&combined, is_rate)));
        used.push(count);
        let found = wrong(&constraints);
        let first = found.first().unwrap_or_else(|| panic!("nothing is wrong with {constraints:?}"));
        for used in used {
            assert!(first.contains(&format!("`c{used}`")), "{first}: {constraints:?}");
        }
    });
}
