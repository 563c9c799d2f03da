//! Checks that the constraints are independent and do not contradict each other.
//!
//! A constraint is redundant if its row of F q̇ + b = 0 is a combination of the rows of others at every state, on the
//! constraints or off them, and for all parameters. It then either follows from the others, so that the multipliers
//! are not unique, or contradicts them. Rows that are dependent on the constraints only, as in a closed spatial
//! linkage, are left to the numerical solution at run time: the mechanism may need all of them.

mod certificate;
mod circuits;

use num_traits::One;

use super::constraints::ConstraintKind::{Holonomic, Velocity};
use super::constraints::Constraints;
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::{ExactPolynomial, Graph, Id, Node, Polynomials, Rational, Sample};
use crate::variables::{Variable, symbols};
use certificate::RowCombination;

/// Number of random points at which an expression is tested for a nonzero value.
const DRAWS: u64 = 8;

/// Reports every constraint that follows from others or contradicts them. A velocity constraint is reported as
/// following from a holonomic one, not the reverse: the holonomic one fixes the position, too.
pub(super) fn check(
    graph: &Graph,
    problem: &Problem,
    constraints: &Constraints,
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    // Those that fields switch may never hold together: two of them may contradict each other.
    let of = |kind| {
        (0..constraints.kinds.len())
            .filter(move |&row| constraints.kinds[row] == kind && constraints.always_holds(row))
    };
    let order: Vec<usize> = of(Holonomic).chain(of(Velocity)).collect();
    for circuit in circuits::find(graph, problem, constraints, &order) {
        if let Some(Redundancy { index, others, message }) =
            ConstraintRows::proved(graph, problem, constraints, &circuit)
        {
            let mut error = problem.constraints[index].0.place.error(message);
            for other in others {
                error.combine(problem.constraints[other].0.place.error("the other one is here"));
            }
            diagnostics.push(error);
        }
    }
    diagnostics.is_empty().then_some(())
}

/// A redundant constraint, the constraints it depends on, and the error message.
struct Redundancy {
    index: usize,
    others: Vec<usize>,
    message: String,
}

/// Remainder of a constraint after the combination of the others is subtracted.
enum Rest {
    Nothing,
    /// An expression without coordinates that the constraints require to be zero.
    Equation(Id),
    /// A function of time and parameters, not known in symbols, that the constraints require to be zero.
    Unknown,
}

/// Constraints of a circuit in a graph of their own, with definitions inlined.
struct ConstraintRows<'a> {
    graph: Graph,
    ring: Polynomials,
    problem: &'a Problem,
    constraints: &'a Constraints,
    circuit: &'a [usize],
    /// Expression that each constraint sets to zero; in `bias`, its terms without velocities.
    written: Vec<Id>,
    bias: Vec<Id>,
}

impl<'a> ConstraintRows<'a> {
    /// Returns the redundancy of these constraints if it is proved.
    fn proved(
        graph: &Graph,
        problem: &'a Problem,
        constraints: &'a Constraints,
        circuit: &'a [usize],
    ) -> Option<Redundancy> {
        let mut scratch = Graph::default();
        let mut copies = |of: &dyn Fn(usize) -> Id| {
            let roots: Vec<Id> = circuit.iter().map(|&row| of(row)).collect();
            scratch.copied(graph, &roots)
        };
        let is_used = |&i: &usize| circuit.iter().any(|&row| constraints.jacobian[row][i] != Id::ZERO);
        let used = (0..problem.coordinates.len()).filter(is_used);
        let mut columns: Vec<Vec<Id>> = used.map(|i| copies(&|row| constraints.jacobian[row][i])).collect();
        let (written, rates) =
            (copies(&|row| problem.constraints[row].1), copies(&|row| constraints.rate[row]));
        let velocities = symbols(problem.coordinates.len(), Variable::Velocity);
        let at_rest =
            |rate| scratch.substituted(rate, |symbol| velocities.contains(&symbol).then_some(Id::ZERO));
        let bias: Vec<Id> = rates.into_iter().map(at_rest).collect();
        columns.push(bias.clone());
        // Faults such as a division by zero are reported elsewhere.
        scratch.take_fault().is_none().then_some(())?;
        let ring = Polynomials::default();
        let mut rows = Self { graph: scratch, ring, problem, constraints, circuit, written, bias };
        rows.fault(&columns)
    }

    fn fault(&mut self, columns: &[Vec<Id>]) -> Option<Redundancy> {
        let polynomials = columns.iter().map(|column| self.polynomials(column));
        let polynomials = polynomials.collect::<Option<Vec<_>>>()?;
        let combination = certificate::find(&self.ring, &polynomials)?;
        let coefficients = self.circuit.iter().zip(&combination.coefficients);
        let mut others: Vec<usize> =
            coefficients.filter(|(_, c)| !c.is_zero()).map(|(&row, _)| row).collect();
        others.sort_unstable();
        let index = self.circuit[combination.index];
        let rest = self.rest(&combination, &others)?;
        let message = self.message(index, &others, &rest, combination.numbers.is_some());
        Some(Redundancy { index, others, message })
    }

    fn polynomials(&mut self, expressions: &[Id]) -> Option<Vec<ExactPolynomial>> {
        expressions.iter().map(|&expression| self.ring.of(&mut self.graph, expression)).collect()
    }

    /// Remainder of a combination; `None` if it contains a coordinate. The constraints may then all hold, and
    /// the remainder restricts coordinates.
    fn rest(&mut self, combination: &RowCombination, others: &[usize]) -> Option<Rest> {
        let rows = others.iter().chain([&self.circuit[combination.index]]);
        let are_holonomic = rows.into_iter().all(|&row| self.constraints.kinds[row] == Holonomic);
        let Some(numbers) = &combination.numbers else {
            return match are_holonomic {
                true => Some(Rest::Unknown),
                false => combination.is_complete.then_some(Rest::Nothing),
            };
        };
        let equations = if are_holonomic { &self.written } else { &self.bias };
        let own = (equations[combination.index], Rational::one());
        let combined = equations.iter().zip(numbers).map(|(&equation, &c)| (equation, -c));
        let left = self.graph.sum(combined.chain([own]));
        self.graph.take_fault().is_none().then_some(())?;
        if let Some(polynomials) = self.polynomials(&[left]) {
            if self.ring.cleared(&polynomials).is_some_and(|cleared| cleared[0].is_zero()) {
                return Some(Rest::Nothing);
            }
            if let Some(number) = polynomials[0].as_number() {
                return Some(Rest::Equation(self.graph.number(number)));
            }
        }
        let is_moving = self
            .graph
            .symbols(&[left])
            .any(|symbol| matches!(Variable::of(symbol), Variable::Coordinate(_) | Variable::Velocity(_)));
        match is_moving {
            false => Some(Rest::Equation(left)),
            true => are_holonomic.then_some(Rest::Unknown),
        }
    }

    fn message(&self, index: usize, others: &[usize], rest: &Rest, by_numbers: bool) -> String {
        let name = |index: usize| format!("`{}`", self.problem.constraints[index].0.text);
        let kind = |index: &usize| self.constraints.kinds[*index];
        let this = name(index);
        let those = others.iter().map(|&other| name(other)).collect::<Vec<_>>().join(", ");
        match *rest {
            Rest::Nothing => match others {
                [other] if by_numbers && kind(other) == kind(&index) => {
                    format!("{this} says the same as {those}: leave one of them out")
                }
                _ if kind(&index) == Velocity && others.iter().all(|other| kind(other) == Holonomic) => {
                    format!(
                        "{this} follows from {those}, which hold{} for velocities, too: leave {this} out",
                        plural(others)
                    )
                }
                _ => format!("{this} follows from {those}: leave {this} out"),
            },
            Rest::Equation(left) => self.disagreement(&this, &those, left),
            Rest::Unknown => {
                format!("{this} contradicts {those}, or follows from {}: leave {this} out", them(others))
            }
        }
    }

    fn disagreement(&self, this: &str, those: &str, left: Id) -> String {
        if let Some(number) = self.graph.as_number(left) {
            return format!("{this} contradicts {those}: together they say {number} = 0");
        }
        let names = self.unknown(left);
        match names.is_empty() && self.is_surely_something(left) {
            true => format!(
                "{this} contradicts {those}: together they leave an equation without a coordinate that does not hold at all times"
            ),
            false => {
                let of = if names.is_empty() { String::new() } else { format!(" in {}", names.join(", ")) };
                format!(
                    "{this} contradicts {those}, or says the same: together they leave an equation{of} without a coordinate. Leave one of them out"
                )
            }
        }
    }

    /// Names of the parameters and supplied functions in an expression.
    fn unknown(&self, root: Id) -> Vec<String> {
        let named = |id: &Id| match self.graph.node(*id) {
            Node::Symbol(symbol) => match Variable::of(*symbol) {
                Variable::Parameter(k) => Some(format!("`{}`", self.problem.parameters.name(k))),
                _ => None,
            },
            Node::External(external) => {
                Some(format!("`{}`", self.problem.functions[external.function as usize].name))
            }
            _ => None,
        };
        self.graph.reachable(&[root]).iter().filter_map(named).collect()
    }

    /// True if a value of the expression has an error bound that excludes 0.
    fn is_surely_something(&self, root: Id) -> bool {
        (0..DRAWS).any(|draw| {
            let drawn = |symbol, draw| self.problem.drawn(symbol, draw);
            let mut sample = Sample::new(self.graph.symbols(&[root]), draw, drawn);
            sample.values(&self.graph, &[root])[0].excludes_zero()
        })
    }
}

fn plural(others: &[usize]) -> &'static str {
    if others.len() == 1 { "s" } else { "" }
}

fn them(others: &[usize]) -> &'static str {
    if others.len() == 1 { "it" } else { "them" }
}
