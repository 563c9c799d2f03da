//! Checks that a Rayleigh dissipation function D dissipates: it must take the power q̇·∂D/∂q̇ from the motion.

use num_traits::Signed;

use super::degree::by_degree;
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::{Function, Graph, Id, Node, Rational};
use crate::variables::{Variable, has_velocity, nodes};

/// Reports a dissipation function that certainly dissipates nothing: free of velocities, odd in them, or with a power
/// that is nowhere positive for nonnegative parameters. A power that is positive at some velocities only is accepted:
/// the drag of a moving belt is an example.
pub(super) fn check(graph: &mut Graph, problem: &Problem, diagnostics: &mut Diagnostics) {
    let Some((function, place)) = problem.dissipation else { return };
    if !has_velocity(graph, &[function]) {
        return diagnostics
            .error(place, "no velocity occurs in this dissipation function, so it does nothing");
    }
    let power = by_degree(graph, problem, function);
    if graph.take_fault().is_some() {
        return;
    }
    let fault = if is_odd(graph, problem, power) {
        "is odd in the velocities: it gives the reversed motion as much power as it takes from the motion"
    } else if sign(graph, power) == PowerSign::Negative {
        "drives the motion: the power q̇·∂D/∂q̇ that it takes is negative, where parameters are positive"
    } else {
        return;
    };
    let advice = "write `c/2*x_dot^2` for the force `-c*x_dot`, and other forces as `#[force(x: …)]`";
    diagnostics.error(place, format!("this dissipation function {fault}; {advice}"));
}

/// True if the power is odd in the velocities, by its canonical form.
fn is_odd(graph: &mut Graph, problem: &Problem, power: Id) -> bool {
    let velocities = nodes(graph, problem.coordinates.len(), Variable::Velocity);
    let reversed: Vec<Id> = velocities.into_iter().map(|velocity| graph.neg(velocity)).collect();
    let plain = graph.looked_through(power);
    let reverse = graph.substituted(power, |symbol| match Variable::of(symbol) {
        Variable::Velocity(i) => Some(reversed[i]),
        _ => None,
    });
    let sum = graph.add(plain, reverse);
    graph.take_fault().is_none() && plain != Id::ZERO && sum == Id::ZERO
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum PowerSign {
    /// Nonnegative.
    Positive,
    /// Nonpositive.
    Negative,
    Unknown,
}

impl PowerSign {
    fn times(self, other: Self) -> Self {
        match (self, other) {
            (Self::Unknown, _) | (_, Self::Unknown) => Self::Unknown,
            _ if self == other => Self::Positive,
            _ => Self::Negative,
        }
    }

    fn of(number: Rational) -> Self {
        if number.is_negative() { Self::Negative } else { Self::Positive }
    }

    fn power(self, exponent: Rational) -> Self {
        // A power with a fraction as exponent has a nonnegative base.
        let is_odd = exponent.is_integer() && exponent.numer() % 2 != 0;
        if is_odd { self } else { Self::Positive }
    }
}

/// Sign of an expression at every state, for nonnegative parameters.
fn sign(graph: &Graph, root: Id) -> PowerSign {
    let mut signs = vec![PowerSign::Unknown; root.index() + 1];
    for id in graph.reachable(&[root]) {
        let of = |id: Id| signs[id.index()];
        signs[id.index()] = match graph.node(id) {
            Node::Number(number) => PowerSign::of(*number),
            Node::Pi | Node::Function(Function::Abs | Function::Exp | Function::Cosh, _) => {
                PowerSign::Positive
            }
            Node::Symbol(symbol) if matches!(Variable::of(*symbol), Variable::Parameter(_)) => {
                PowerSign::Positive
            }
            Node::Sum(terms) => {
                let first = of(terms[0].0).times(PowerSign::of(terms[0].1));
                let agrees =
                    |&(term, number): &(Id, Rational)| of(term).times(PowerSign::of(number)) == first;
                if terms.iter().all(agrees) { first } else { PowerSign::Unknown }
            }
            Node::Product(factors) => {
                factors.iter().fold(PowerSign::Positive, |sign, &(factor, exponent)| {
                    sign.times(of(factor).power(exponent))
                })
            }
            Node::Defined(inner) => of(*inner),
            Node::Power(base, _) => match of(*base) {
                PowerSign::Positive => PowerSign::Positive,
                _ => PowerSign::Unknown,
            },
            _ => PowerSign::Unknown,
        };
    }
    signs[root.index()]
}
