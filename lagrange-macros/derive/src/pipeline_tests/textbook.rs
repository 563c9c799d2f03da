//! Velocity-dependent terms equal those in textbooks.

use super::equations;
use crate::symbolic::{Function, Graph, Id, Rational};
use crate::variables::Variable;

/// Double pendulum, angles from the vertical: Landau and Lifshitz, *Mechanics*, § 5, problem 1.
const DOUBLE_PENDULUM: &str = "
    #[coordinates(a, b)]
    #[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 2*cos(a) + cos(b))]
    struct DoublePendulum;
";

/// Two-link arm, second angle from the first link: Spong, Hutchinson and Vidyasagar, *Robot Modeling and Control*,
/// chapter 7.
const ARM: &str = "
    #[coordinates(a, b)]
    #[lagrangian(a_dot^2 + (a_dot + b_dot)^2/2 + a_dot*(a_dot + b_dot)*cos(b))]
    struct Arm;
";

/// Returns h, and dp/dt − ∂L/∂q as a function of the accelerations.
fn found(source: &str) -> (Graph, [Vec<Id>; 2]) {
    let (graph, _, equations) = equations(source);
    (graph, [equations.forcing, equations.balance])
}

fn symbol(graph: &mut Graph, variable: Variable) -> Id {
    graph.symbol(variable.symbol())
}

fn both(graph: &mut Graph, variable: fn(usize) -> Variable) -> [Id; 2] {
    [0, 1].map(|i| symbol(graph, variable(i)))
}

fn product<const K: usize>(graph: &mut Graph, factors: [Id; K]) -> Id {
    graph.product(factors.map(|factor| (factor, Rational::from_integer(1))))
}

/// Σ coefficient · term
fn sum<const K: usize>(graph: &mut Graph, terms: [(i32, Id); K]) -> Id {
    graph.sum(terms.map(|(coefficient, term)| (term, Rational::from_integer(coefficient.into()))))
}

#[test]
fn of_a_double_pendulum_the_squares_of_velocities_are_left() {
    let (mut graph, [forcing, balance]) = found(DOUBLE_PENDULUM);
    let graph = &mut graph;
    let [[a, b], [u, v], [du, dv]] =
        [Variable::Coordinate, Variable::Velocity, Variable::Acceleration].map(|family| both(graph, family));
    let between = graph.sub(a, b);
    let [s, c] = [Function::Sin, Function::Cos].map(|function| graph.function(function, between));
    let weights = [a, b].map(|angle| graph.function(Function::Sin, angle));
    let (of_u, of_v) = (product(graph, [s, u, u]), product(graph, [s, v, v]));
    let h = [sum(graph, [(-1, of_v), (-2, weights[0])]), sum(graph, [(1, of_u), (-1, weights[1])])];
    assert_eq!(forcing, h);
    let (c_du, c_dv) = (product(graph, [c, du]), product(graph, [c, dv]));
    let inertia = [sum(graph, [(2, du), (1, c_dv)]), sum(graph, [(1, dv), (1, c_du)])];
    assert_eq!(balance, [0, 1].map(|i| graph.sub(inertia[i], h[i])));
}

#[test]
fn of_an_arm_no_joint_has_its_own_velocity_in_its_equation() {
    let (mut graph, [forcing, _]) = found(ARM);
    let graph = &mut graph;
    let ([_, b], [u, v]) = (both(graph, Variable::Coordinate), both(graph, Variable::Velocity));
    let s = graph.function(Function::Sin, b);
    let twice = sum(graph, [(2, u), (1, v)]);
    let centrifugal = product(graph, [s, u, u]);
    assert_eq!(forcing, [product(graph, [s, v, twice]), graph.neg(centrifugal)]);
}
