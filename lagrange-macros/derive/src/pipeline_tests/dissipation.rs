//! Dissipation functions that certainly dissipate no power are errors; all others are accepted.

use lagrange_random::cases;

use super::tokens;
use crate::expand;
use crate::symbolic::random;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Answer {
    Accepted,
    Odd,
    Negative,
}

fn said(function: &str) -> Answer {
    let source = format!(
        "#[coordinates(x, y)]
         #[function(f(v))]
         #[define(both = x_dot + y_dot)]
         #[lagrangian(x_dot^2 + y_dot^2)]
         #[dissipation({function})]
         struct System<F> {{ c: f64, u: f64, f: F }}"
    );
    let emitted = expand(tokens(&source)).to_string();
    match emitted.split("compile_error ! {").nth(1) {
        None => Answer::Accepted,
        Some(error) if error.contains("is odd in the velocities") => Answer::Odd,
        Some(error) if error.contains("drives the motion") => Answer::Negative,
        Some(error) => panic!("{function}: {error:.200}"),
    }
}

#[test]
fn what_may_take_power_is_accepted() {
    for function in [
        "c/2*x_dot^2",
        // A conveyor belt or the wind, which drives a slower body.
        "c/2*(x_dot - u)^2",
        "c*x_dot^2 - u*x_dot",
        // Van der Pol: it drives small motions and brakes large ones.
        "-c/2*(1 - x^2)*x_dot^2",
        // A negative function with a positive power.
        "-c/(1 + x_dot^2)",
        "c*abs(x_dot)^3",
        "c*sqrt(x_dot^2 + u^2)",
        "x*x_dot^2",
        "f(x_dot)",
        "f(x_dot)*x_dot",
        // The direction of the velocity: its power is zero.
        "atan2(y_dot, x_dot)",
        "-(x_dot - y_dot)^2 + c*y_dot^2",
    ] {
        assert_eq!(said(function), Answer::Accepted, "{function}");
    }
}

#[test]
fn what_takes_no_power_is_refused() {
    for (function, wanted) in [
        ("c*x_dot", Answer::Odd),
        ("c*x*both + u", Answer::Odd),
        ("sin(x_dot)*(1 + both^2)", Answer::Odd),
        ("c*x_dot*abs(x_dot)", Answer::Odd),
        ("-x_dot^2", Answer::Negative),
        ("-c/2*both^2 - u*exp(x)*y_dot^4", Answer::Negative),
        ("-c*sqrt(1 + x_dot^2)", Answer::Negative),
        ("-pi*abs(both)^3/c", Answer::Negative),
    ] {
        assert_eq!(said(function), wanted, "{function}");
    }
}

/// A term s cᵖ (a ẋ + b ẏ + w)ⁿ of a dissipation function.
struct Term {
    sign: f64,
    power: i32,
    along: [f64; 2],
    wind: f64,
    degree: i32,
}

impl Term {
    fn random(index: u64, draw: u64) -> Self {
        let below = |k: u64, count: f64| (random(k, index, draw) * count).floor();
        Self {
            sign: if below(0, 4.0) > 0.0 { -1.0 } else { 1.0 },
            power: below(1, 4.0) as i32 - 1,
            along: [below(2, 3.0) + 1.0, below(3, 5.0) - 2.0],
            wind: (below(4, 5.0) - 3.0).max(0.0),
            degree: if below(5, 4.0) > 0.0 {
                2 * below(6, 2.0) as i32 + 2
            } else {
                below(6, 2.0) as i32 * 2 + 1
            },
        }
    }

    fn text(&self) -> String {
        let Self { sign, power, along: [a, b], wind, degree } = self;
        format!("({sign})*c^({power})*({a}*x_dot + ({b})*y_dot + {wind})^{degree}")
    }

    /// Contribution of the term to the power q̇·∂D/∂q̇.
    fn taken(&self, c: f64, [x, y]: [f64; 2]) -> f64 {
        let along = self.along[0] * x + self.along[1] * y;
        let slope = f64::from(self.degree) * (along + self.wind).powi(self.degree - 1);
        self.sign * c.powi(self.power) * slope * along
    }
}

/// Compares the verdict on random sums with their power at random velocities, computed by a formula.
#[test]
fn sums_at_random_are_refused_where_they_take_no_power() {
    let mut refused = [0; 2];
    let draws = cases([20, 60, 1_500]);
    for draw in 0..draws as u64 {
        let count = 1 + (random(20, 0, draw) * 3.0) as u64;
        let terms: Vec<Term> = (0..count).map(|index| Term::random(index, draw)).collect();
        let text: Vec<String> = terms.iter().map(Term::text).collect();
        let text = text.join(" + ");
        let answer = said(&text);
        for point in 0..50 {
            let at = |k: u64| 6.0 * random(30 + k, point, draw) - 3.0;
            let (c, v) = (at(0).abs(), [at(1), at(2)]);
            let taken = |v: [f64; 2]| terms.iter().map(|term| term.taken(c, v)).sum::<f64>();
            let (there, back) = (taken(v), taken([-v[0], -v[1]]));
            match answer {
                Answer::Odd => assert!((there + back).abs() <= 1e-9 * (there.abs() + 1.0), "{text}"),
                Answer::Negative => assert!(there <= 0.0, "{text}: {there}"),
                Answer::Accepted => {}
            }
        }
        let is_calm = terms.iter().all(|term| term.wind == 0.0);
        let all = |rest: i32| is_calm && terms.iter().all(|term| term.degree % 2 == rest);
        let is_driven = all(0) && terms.iter().all(|term| term.sign < 0.0);
        assert!(!is_driven || answer == Answer::Negative, "{text}: {answer:?}");
        assert!(!all(1) || answer == Answer::Odd, "{text}: {answer:?}");
        refused[0] += usize::from(is_driven);
        refused[1] += usize::from(all(1));
    }
    assert!(refused.iter().all(|&count| count > draws / 30), "{refused:?}");
}
