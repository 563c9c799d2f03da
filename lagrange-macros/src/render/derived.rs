//! Nodes of the graph, as formulas. Definitions appear by name.

use num_traits::{One, Signed};

use super::formula::Formula;
use super::supplied;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Node, Rational, Scaled};
use crate::variables::Variable;

pub(super) fn derived(id: Id, graph: &Graph, problem: &Problem) -> Formula {
    match graph.node(id) {
        Node::Number(value) => Formula::number((*value).into()),
        Node::Pi => Formula::Pi,
        Node::Symbol(symbol) => variable(Variable::of(*symbol), problem),
        Node::Sum(terms) => {
            let mut terms: Vec<_> =
                terms.iter().map(|&(term, c)| derived_term(term, c, graph, problem)).collect();
            terms.sort_by_key(Formula::is_negative);
            if terms.len() == 1 { terms.remove(0) } else { Formula::Sum(terms) }
        }
        Node::Product(_) => derived_term(id, Rational::one(), graph, problem),
        Node::Function(function, x) => {
            Formula::Call(function.name().to_owned(), vec![derived(*x, graph, problem)])
        }
        Node::External(external) => {
            let arguments = external.arguments.iter().map(|&x| derived(x, graph, problem)).collect();
            supplied::call(external, arguments, problem)
        }
        Node::Atan2(y, x) => {
            Formula::Call("atan2".to_owned(), vec![derived(*y, graph, problem), derived(*x, graph, problem)])
        }
        Node::Power(base, exponent) => Formula::Power(
            Box::new(derived(*base, graph, problem)),
            Box::new(derived(*exponent, graph, problem)),
        ),
        Node::Defined(inner) => match problem.names.get(&id) {
            Some(name) => Formula::labelled(name, 0),
            None => derived(*inner, graph, problem),
        },
    }
}

/// coefficient · term
fn derived_term(term: Id, coefficient: Rational, graph: &Graph, problem: &Problem) -> Formula {
    let Node::Product(factors) = graph.node(term) else {
        let above = if term == Id::ONE { Vec::new() } else { vec![derived(term, graph, problem)] };
        return Formula::product(coefficient.into(), above, Vec::new());
    };
    let coefficient = Scaled { fraction: coefficient, exponent: graph.power_of_ten(factors) };
    let mut factors: Vec<_> = factors.to_vec();
    factors.retain(|&factor| !graph.is_power_of_ten(factor));
    factors.sort_by_key(|&(factor, _)| reading_order(factor, graph));
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for (factor, exponent) in factors {
        let power = power(derived(factor, graph, problem), exponent.abs());
        if exponent.is_negative() { below.push(power) } else { above.push(power) }
    }
    Formula::product(coefficient, above, below)
}

fn power(base: Formula, exponent: Rational) -> Formula {
    if exponent.is_one() {
        return base;
    }
    if exponent == Rational::new_raw(1, 2) {
        return Formula::Root(Box::new(base));
    }
    Formula::Power(Box::new(base), Box::new(Formula::Number(exponent)))
}

/// Parameters come first, then multipliers, definitions, coordinates, functions, velocities, accelerations.
fn reading_order(factor: Id, graph: &Graph) -> (u8, u32) {
    match graph.node(factor) {
        Node::Symbol(symbol) => match Variable::of(*symbol) {
            Variable::Parameter(_) => (0, symbol.index),
            Variable::Multiplier(_) => (1, symbol.index),
            Variable::Time => (3, 0),
            Variable::Coordinate(_) => (4, symbol.index),
            Variable::Velocity(_) => (7, symbol.index),
            _ => (8, symbol.index),
        },
        Node::Pi => (0, 0),
        Node::Defined(_) => (2, factor.index() as u32),
        Node::Function(..) => (5, factor.index() as u32),
        _ => (6, factor.index() as u32),
    }
}

fn variable(variable: Variable, problem: &Problem) -> Formula {
    match variable {
        Variable::Time => Formula::labelled("t", 0),
        Variable::Coordinate(i) => Formula::labelled(&problem.coordinates[i].text, 0),
        Variable::Velocity(i) => Formula::labelled(&problem.coordinates[i].text, 1),
        Variable::Acceleration(i) => Formula::labelled(&problem.coordinates[i].text, 2),
        Variable::Multiplier(a) => Formula::Multiplier(problem.constraints[a].0.text.clone()),
        Variable::Parameter(k) => Formula::labelled(&problem.parameters.name(k), 0),
        // Emitted functions take it, and no equation has it.
        only_emitted => Formula::labelled(&format!("{only_emitted:?}"), 0),
    }
}
