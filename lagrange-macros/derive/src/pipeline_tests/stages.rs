//! Output of each stage for one system, as the book shows it. `UPDATE_BOOK=1 cargo test stages` writes it into the
//! book.

#[path = "../../../../book/blocks.rs"]
mod blocks;

use super::{declaration, derived, systems, tokens};
use crate::codegen::solving;
use crate::mechanics::Equations;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Node, Rational};
use crate::syntax::{Expression, Kind, Operator, Sign};
use crate::variables::Variable;
use crate::{expand, render};

fn shows(name: &str, text: &str) {
    let book = concat!(env!("CARGO_MANIFEST_DIR"), "/../../book");
    blocks::check(book.as_ref(), "path.md", name, text);
}

#[test]
fn what_was_written() {
    let (declaration, _) = declaration(systems::SPHERE);
    let mut text: String =
        declaration.coordinates.iter().map(|one| format!("coordinate  {}\n", one.name.text)).collect();
    for define in &declaration.defines {
        text += &format!("definition  {} = {}\n", define.target.name.text, tree(&define.body));
    }
    text += &format!("lagrangian  {}\n", tree(declaration.lagrangian.as_ref().expect("one")));
    for constraint in &declaration.constraints {
        let [left, right] = [&constraint.left, &constraint.right].map(tree);
        text += &format!("constraint  {}: {left} = {right}\n", constraint.target.name.text);
    }
    shows("what was written", &text);
}

/// Text of an expression, with each operation in parentheses.
fn tree(expression: &Expression) -> String {
    match &expression.kind {
        Kind::Number(value) => value.fraction.to_string(),
        Kind::Name(name) => name.text.clone(),
        Kind::Call(name, arguments) => {
            format!("{}({})", name.text, arguments.iter().map(tree).collect::<Vec<_>>().join(", "))
        }
        Kind::Power(base, exponent) => format!("{}^{}", tree(base), tree(exponent)),
        Kind::Sum(terms) => list(terms, Sign::Plus, [" + ", " - "]),
        Kind::Product(factors) => list(factors, Operator::Times, ["*", "/"]),
        other => panic!("{other:?} is not in this system"),
    }
}

fn list<T: PartialEq>(parts: &[(T, Expression)], usual: T, [joined, taken]: [&str; 2]) -> String {
    let mut text = String::new();
    for (how, part) in parts {
        let sign = if *how == usual { joined } else { taken };
        text += if text.is_empty() { "" } else { sign };
        text += &tree(part);
    }
    format!("({text})")
}

#[test]
fn the_graph() {
    let (graph, problem, _) = derived(systems::SPHERE);
    let nodes = graph.reachable(&[problem.lagrangian]);
    let mut text: String =
        nodes.into_iter().map(|id| format!("{:>3}  {}\n", id.index(), node(&graph, &problem, id))).collect();
    text += &format!("L is {}", problem.lagrangian.index());
    shows("the graph", &text);
}

/// Text of a node, with the indices of its operands.
fn node(graph: &Graph, problem: &Problem, id: Id) -> String {
    let number = |id: Id| format!("[{}]", id.index());
    match graph.node(id) {
        Node::Defined(inner) => format!("{}, defined as {}", problem.names[&id], number(*inner)),
        other => flat(other, problem, number),
    }
}

fn flat(node: &Node, problem: &Problem, operand: impl Fn(Id) -> String) -> String {
    let times = |(term, c): &(Id, Rational)| match (*term == Id::ONE, *c == Rational::from_integer(1)) {
        (true, _) => c.to_string(),
        (_, true) => operand(*term),
        _ if *c == Rational::from_integer(-1) => format!("−{}", operand(*term)),
        _ => format!("{c} {}", operand(*term)),
    };
    let power = |(factor, exponent): &(Id, Rational)| match *exponent == Rational::from_integer(1) {
        true => operand(*factor),
        false => format!("{}^{exponent}", operand(*factor)),
    };
    match node {
        Node::Number(value) => value.to_string(),
        Node::Symbol(symbol) => name(problem, Variable::of(*symbol)),
        Node::Sum(terms) => terms.iter().map(times).collect::<Vec<_>>().join(" + "),
        Node::Product(factors) => factors.iter().map(power).collect::<Vec<_>>().join(" "),
        Node::Function(function, x) => format!("{} {}", function.name(), operand(*x)),
        other => panic!("{other:?} is not in this system"),
    }
}

fn name(problem: &Problem, variable: Variable) -> String {
    match variable {
        Variable::Coordinate(i) => problem.coordinates[i].text.clone(),
        Variable::Velocity(i) => format!("{}_dot", problem.coordinates[i].text),
        Variable::Parameter(k) => problem.parameters.name(k),
        other => panic!("{other:?} is not in this system"),
    }
}

#[test]
fn the_equations() {
    let (graph, problem, derived) = derived(systems::SPHERE);
    let equations = &derived.equations;
    let written =
        |ids: &[Id]| ids.iter().map(|&id| infix(&graph, &problem, id)).collect::<Vec<_>>().join(",  ");
    let rows = |rows: &[Vec<Id>]| rows.iter().map(|row| written(row)).collect::<Vec<_>>().join(";  ");
    let classes = &equations.integrability.classes;
    let kinds: Vec<_> = classes.iter().map(|class| format!("{:?}", class.integrability)).collect();
    let text = [
        format!("p = ∂L/∂q̇         {}", written(&equations.momentum)),
        format!("M = ∂p/∂q̇         {}", rows(&equations.mass)),
        format!("h                 {}", written(&equations.forcing)),
        format!("F                 {}", rows(&equations.linear.jacobian)),
        format!("γ                 {}", written(&equations.linear.bias)),
        format!("E = p·q̇ − L       {}", written(&[equations.energy])),
        format!("no_slip           {}", kinds.join(", ")),
    ];
    shows("the equations", &text.join("\n"));
}

/// Text of a node with its operands written out, definitions by name.
fn infix(graph: &Graph, problem: &Problem, id: Id) -> String {
    let operand = |id: Id| match graph.node(id) {
        Node::Sum(_) => format!("({})", infix(graph, problem, id)),
        _ => infix(graph, problem, id),
    };
    match graph.node(id) {
        Node::Defined(_) => problem.names[&id].clone(),
        other => flat(other, problem, operand),
    }
}

#[test]
fn what_is_read() {
    let (declaration, _) = declaration(systems::SPHERE);
    let (graph, problem, derived) = derived(systems::SPHERE);
    shows("what is read", &render::render(&declaration, &graph, &problem, &derived).forms[0][0]);
}

#[test]
fn the_passes() {
    let (graph, _, derived) = derived(systems::SPHERE);
    shows("the passes", &counts(&graph, &derived.equations, 0));
}

#[test]
fn the_passes_of_a_chain() {
    let (graph, _, derived) = derived(&systems::chain(5));
    let forms = derived.equations.linear.forms.len();
    assert_eq!(forms, 2, "over the accelerations alone, and over those of velocities that are named");
    let text = ["over the angles alone", "over the named velocities, too"]
        .into_iter()
        .enumerate()
        .map(|(form, name)| format!("{name}\n{}", counts(&graph, &derived.equations, form)));
    shows("the passes of a chain", &text.collect::<Vec<_>>().join("\n\n"));
}

/// Operation count of the accelerations after each pass, solved by this form of the equations.
fn counts(graph: &Graph, equations: &Equations, form: usize) -> String {
    let counts = solving(graph, equations).swap_remove(form).expect("no loops");
    let lines: Vec<_> = counts.iter().map(|(pass, count)| format!("  {pass:<22} {count}")).collect();
    lines.join("\n")
}

#[test]
fn what_is_emitted() {
    let file = syn::parse2(expand(tokens(systems::SPHERE))).expect("items");
    let text = prettyplease::unparse(&file);
    let at = text.find("fn accelerations_unchecked").expect("it is emitted");
    let start = text[..at].rfind("        ///").expect("its count");
    let end = at + text[at..].find("\n        }\n").expect("its end") + 10;
    let lines: Vec<_> =
        text[start..end].lines().map(|line| line.strip_prefix("        ").unwrap_or(line)).collect();
    shows("what is emitted", &lines.join("\n"));
}
