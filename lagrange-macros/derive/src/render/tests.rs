//! Written formulas keep their value, and read as textbooks print them.

mod bodies;
mod driven;
mod everywhere;
mod excerpts;
mod forms;
mod frames;
mod golden;
mod golden_contacts;
mod golden_lines;
mod letters;
mod mathml;
mod multipliers;
mod potentials;
mod reader;
mod systems;
mod texts;
mod totals;
mod typeset;

use lagrange_random::cases;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::formula::Formula;
use super::notation::Notation;
use crate::symbolic::Rational;

/// Values of x, y and z at which formulas are evaluated.
const POINT: [(&str, f64); 3] = [("x", 1.3), ("y", -0.7), ("z", 2.1)];

fn number(numerator: i128, denominator: i128) -> Formula {
    Formula::Number(Rational::new(numerator, denominator))
}

fn name(text: &str) -> Formula {
    Formula::labelled(text, 0)
}

fn call(function: &str, arguments: impl Into<Vec<Formula>>) -> Formula {
    Formula::Call(function.to_owned(), arguments.into())
}

fn power(base: Formula, exponent: Formula) -> Formula {
    Formula::Power(base.into(), exponent.into())
}

/// Value of a formula, for comparison with the value that [`reader`] reads from the text.
fn value(formula: &Formula) -> f64 {
    let float = |rational: &Rational| *rational.numer() as f64 / *rational.denom() as f64;
    match formula {
        Formula::Number(number) => float(number),
        Formula::Name { base, .. } => POINT.iter().find(|(known, _)| known == base).expect("a name").1,
        Formula::Negative(inner) => -value(inner),
        Formula::Sum(terms) => terms.iter().map(value).sum(),
        Formula::Product(above, below) => {
            above.iter().map(value).product::<f64>() / below.iter().map(value).product::<f64>()
        }
        Formula::Power(base, exponent) => value(base).powf(value(exponent)),
        Formula::Root(inner) => value(inner).sqrt(),
        Formula::Call(function, arguments) => {
            reader::apply(function, &arguments.iter().map(value).collect::<Vec<_>>())
        }
        other => panic!("no value of {other:?}"),
    }
}

fn formulas() -> impl Strategy<Value = Formula> {
    let leaf = prop_oneof![
        4 => (0..3_usize).prop_map(|i| name(POINT[i].0)),
        1 => (-3..12_i128).prop_map(|n| number(n, 1)),
        1 => (1..9_i128, 2..9_i128).prop_map(|(n, d)| number(n, d)),
        1 => Just(number(981, 100)),
    ];
    leaf.prop_recursive(5, 40, 3, |inner| {
        let several = || prop::collection::vec(inner.clone(), 2..4);
        let pair = || (inner.clone(), inner.clone());
        prop_oneof![
            2 => several().prop_map(Formula::Sum),
            3 => (several(), prop::collection::vec(inner.clone(), 0..3))
                .prop_map(|(above, below)| Formula::Product(above, below)),
            1 => inner.clone().prop_map(|inner| Formula::Negative(inner.into())),
            1 => (inner.clone(), -3..4_i128).prop_map(|(base, e)| power(base, number(e, 1))),
            1 => pair().prop_map(|(base, exponent)| power(base, exponent)),
            1 => inner.clone().prop_map(|inner| Formula::Root(inner.into())),
            2 => (prop::sample::select(vec!["sin", "exp", "abs", "asin"]), inner.clone())
                .prop_map(|(function, x)| call(function, [x])),
            1 => (prop::sample::select(vec!["dot", "atan2", "f"]), pair())
                .prop_map(|(function, (x, y))| call(function, [x, y])),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: cases([250, 500, 20_000]) as u32,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1687),
        ..ProptestConfig::default()
    })]

    /// A reader who knows the usual precedence, and rejects ambiguous text, reads the same value.
    #[test]
    fn what_is_written_is_read_as_it_was_meant(formula in formulas()) {
        let text = Notation::UNICODE.write(&formula);
        let (read, meant) = (reader::read(&text), value(&formula));
        let close = (read - meant).abs() <= 1e-9 * meant.abs().max(1e-300);
        prop_assert!(close || !meant.is_finite() || meant == read, "{text}: {read}, meant {meant}");
    }

    #[test]
    fn braces_and_delimiters_of_latex_are_balanced(formula in formulas()) {
        reader::assert_balanced(&Notation::LATEX.write(&formula));
    }
}

#[track_caller]
fn assert_written(formula: Formula, text: &str, latex: &str) {
    assert_eq!(Notation::UNICODE.write(&formula), text);
    assert_eq!(Notation::LATEX.write(&formula), latex);
    reader::assert_balanced(latex);
}

#[test]
fn a_sine_ends_where_a_reader_ends_it() {
    let sine = || call("sin", [name("theta")]);
    assert_written(Formula::Product(vec![sine(), name("x")], vec![]), "sin(θ) x", r"\sin(\theta) x");
    assert_written(Formula::Product(vec![name("x"), sine()], vec![]), "x sin θ", r"x \sin \theta");
    let squares = vec![power(sine(), number(2, 1)), call("cos", [name("x")])];
    assert_written(Formula::Product(squares, vec![]), "sin² θ cos x", r"\sin^2 \theta \cos x");
    assert_written(power(sine(), number(-1, 1)), "(sin θ)⁻¹", r"(\sin \theta)^{-1}");
    assert_written(Formula::Product(vec![sine()], vec![name("x")]), "sin(θ)/x", r"\frac{\sin \theta}{x}");
}

#[test]
fn numbers_do_not_run_into_each_other() {
    let tower = power(number(2, 1), name("x"));
    assert_written(Formula::Product(vec![number(3, 1), tower], vec![]), "3 · 2^x", r"3 \cdot 2^x");
    assert_written(power(Formula::Root(name("x").into()), number(2, 1)), "(√x)²", r"\sqrt{x}^2");
    assert_written(power(number(1, 2), name("x")), "(½)^x", r"(\tfrac{1}{2})^x");
}

#[test]
fn vectors_are_written_as_in_books() {
    let (v, w, r) = (|| name("v"), || name("Omega"), || name("r"));
    let cross = || call("cross", [w(), r()]);
    assert_written(
        Formula::Product(vec![name("m"), call("dot", [v(), cross()])], vec![]),
        "m v·(Ω×r)",
        r"m v \cdot (\Omega \times r)",
    );
    let dots = vec![call("dot", [v(), v()]), call("dot", [r(), r()])];
    assert_written(Formula::Product(dots, vec![]), "(v·v) r·r", r"(v \cdot v) r \cdot r");
    assert_written(
        Formula::Product(vec![name("x")], vec![call("dot", [v(), r()])]),
        "x/(v·r)",
        r"\frac{x}{v \cdot r}",
    );
    assert_written(power(call("norm", [r()]), number(3, 1)), "|r|³", r"\lvert r \rvert^3");
    let entry = |whole: Formula| Formula::Entry(whole.into(), number(2, 1).into());
    assert_written(entry(cross()), "(Ω×r)[2]", r"(\Omega \times r)_2");
    assert_written(entry(call("Omega", [name("t")])), "Ω(t)[2]", r"\Omega(t)_2");
    assert_written(
        call("quat_rotate", [name("q"), v()]),
        "quat_rotate(q, v)",
        r"\operatorname{quat\_rotate}(q, v)",
    );
}

#[test]
fn derivatives_of_unknown_functions_say_where_they_are_taken() {
    let derivative =
        |order| Formula::Derivative { function: name("Omega[0]").into(), order, argument: name("t").into() };
    assert_written(derivative(1), "Ω[0]′(t)", r"\Omega_0'(t)");
    assert_written(derivative(2), "Ω[0]″(t)".replace('″', "′′").as_str(), r"\Omega_0''(t)");
    let partial = |arguments| Formula::Partial {
        function: name("U").into(),
        by: vec![name("r[0]"), name("r[1]")],
        arguments,
    };
    assert_written(partial(vec![]), "∂²U/∂r[0]∂r[1]", r"\frac{\partial^2 U}{\partial r_0\partial r_1}");
    assert_written(
        partial(vec![Formula::Sum(vec![name("a"), name("b")])]),
        "(∂²U/∂r[0]∂r[1])(a + b)",
        r"\left( \frac{\partial^2 U}{\partial r_0\partial r_1} \right)(a + b)",
    );
    assert_written(
        Formula::Product(vec![partial(vec![]), name("x")], vec![]),
        "(∂²U/∂r[0]∂r[1]) x",
        r"\frac{\partial^2 U}{\partial r_0\partial r_1} x",
    );
}

#[test]
fn indices_and_letters_suit_the_notation() {
    let before = Formula::Sum(vec![name("i"), number(-1, 1)]);
    let element = Formula::Name { base: "vx".to_owned(), dots: 0, indices: vec![before] };
    assert_written(element, "vx[i − 1]", r"\mathit{vx}_{i - 1}");
    assert_written(Formula::labelled("θ", 1), "θ\u{307}", r"\dot\theta");
    assert_written(Formula::labelled("theta_1[2]", 2), "θ\u{308}₁[2]", r"\ddot\theta_{1, 2}");
    let sum = |to| Formula::SumOver {
        index: "i".to_owned(),
        from: number(0, 1).into(),
        to: Box::new(to),
        body: name("x").into(),
    };
    assert_written(sum(number(3, 1)), "Σ(i = 0 … 2) x", r"\sum_{i = 0}^{2} x");
    assert_written(sum(name("n")), "Σ(i = 0 … n − 1) x", r"\sum_{i = 0}^{n - 1} x");
}

#[test]
fn lines_break_in_sums_before_they_break_in_arguments() {
    let sum = |one: &str, other: &str| Formula::Sum(vec![name(one), name(other)]);
    let cosine = call("cos", [sum("theta_1", "theta_2")]);
    let formula = Formula::Product(vec![sum("x", "y"), cosine], vec![]);
    let broken = |notation: Notation| notation.within(notation.write(&formula), 40.0);
    assert_eq!(broken(Notation::LATEX), ["(x", r" + y) \cos(\theta_1", r" + \theta_2)"]);
    let room = |notation: Notation| notation.within(notation.write(&formula), 88.0);
    assert_eq!(room(Notation::LATEX), ["(x", r" + y) \cos(\theta_1 + \theta_2)"]);
}

#[test]
fn typeset_pages_say_from_where_indices_count() {
    let note = "Indices count from 0";
    let noted = |source: &str| {
        let system = systems::System::new(source.parse().expect("tokens")).expect("a system");
        system.forms[0].each_ref().map(|page| page.contains(note))
    };
    let falling =
        "#[coordinates(r: [3])] #[lagrangian(m/2*dot(r_dot, r_dot) - m*g*r[2])] struct F { m: f64, g: f64 }";
    assert_eq!(noted(falling), [false, true, true]);
    let free = "#[coordinates(r: [3])] #[lagrangian(m/2*dot(r_dot, r_dot))] struct F { m: f64 }";
    assert_eq!(noted(free), [false; 3]);
}
