//! Maps symbols of the graph to variables of mechanics, and defines their time derivatives.

use crate::symbolic::{Forward, Graph, Id, Symbol};

/// Variable that a symbol stands for.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Variable {
    Time,
    Coordinate(usize),
    Velocity(usize),
    Acceleration(usize),
    Multiplier(usize),
    /// Parameter, by its index in the list of parameters that expressions use.
    Parameter(usize),
    /// Switch of a constraint, by its index in the list of switches: 1 while the constraint holds, else 0.
    Switch(usize),
    /// Component of a direction in the space of states: time, then coordinates, then velocities.
    Change(usize),
    /// Entry of the factorization of the KKT matrix.
    Factor(usize),
    /// Right-hand side of a coordinate, in place of h.
    Forcing(usize),
    /// Right-hand side of a constraint, in place of γ.
    Bias(usize),
    /// Component of a direction in the space of parameters, in the order of the fields.
    ParameterChange(usize),
    /// Coefficient that the directional derivatives at one state share, whatever the direction.
    Slope(usize),
    /// Taylor coefficient of order k of an acceleration.
    AccelerationChange(usize),
    /// Taylor coefficient of order k of a multiplier.
    MultiplierChange(usize),
    /// Convolution sum over Taylor coefficients of lower orders.
    Sum(usize),
    /// Part of a Taylor coefficient of order k that does not depend on the accelerations and multipliers of
    /// order k.
    Term(usize),
    /// Order k of the Taylor coefficients to compute.
    Order,
    /// 1/k.
    OrderReciprocal,
    /// c/(k + 1), where c is a common multiple of all orders.
    NextWeight,
    /// 1/c².
    WeightsReciprocal,
    /// Generalized momentum, argument of the Hamiltonian in place of a velocity.
    Momentum(usize),
    /// Input of one iteration of a loop in the emitted code.
    Given(usize),
    /// Running index of the loop at this depth, where the length of the loop is known when the program runs.
    Level(usize),
    /// Length of arrays that is known when the program runs.
    Length(usize),
    /// Sum over a range that is known when the program runs.
    Total(usize),
}

impl Variable {
    pub(crate) fn symbol(self) -> Symbol {
        let (family, index) = match self {
            Self::Time => (0, 0),
            Self::Coordinate(i) => (1, i),
            Self::Velocity(i) => (2, i),
            Self::Acceleration(i) => (3, i),
            Self::Multiplier(a) => (4, a),
            Self::Parameter(k) => (5, k),
            Self::Change(i) => (6, i),
            Self::Factor(k) => (7, k),
            Self::Forcing(i) => (8, i),
            Self::Bias(a) => (9, a),
            Self::ParameterChange(k) => (10, k),
            Self::Slope(k) => (11, k),
            Self::AccelerationChange(i) => (12, i),
            Self::MultiplierChange(a) => (13, a),
            Self::Sum(k) => (14, k),
            Self::Order => (15, 0),
            Self::OrderReciprocal => (16, 0),
            Self::Momentum(i) => (17, i),
            Self::Term(k) => (18, k),
            Self::Given(k) => (19, k),
            Self::NextWeight => (20, 0),
            Self::WeightsReciprocal => (21, 0),
            Self::Switch(k) => (22, k),
            Self::Level(level) => (23, level),
            Self::Length(k) => (24, k),
            Self::Total(k) => (25, k),
        };
        Symbol { family, index: index as u32 }
    }

    /// True if only the solution of the equations of motion determines the value.
    pub(crate) fn is_solved(self) -> bool {
        matches!(self, Self::Acceleration(_) | Self::Multiplier(_))
    }

    /// True for an argument of a linear function: a component of a direction, a Taylor coefficient, or a number that
    /// depends on its order.
    pub(crate) fn is_change(self) -> bool {
        matches!(
            self,
            Self::Change(_)
                | Self::ParameterChange(_)
                | Self::AccelerationChange(_)
                | Self::MultiplierChange(_)
                | Self::Sum(_)
                | Self::Term(_)
                | Self::Order
                | Self::OrderReciprocal
                | Self::NextWeight
                | Self::WeightsReciprocal
        )
    }

    pub(crate) fn of(symbol: Symbol) -> Self {
        let index = symbol.index as usize;
        match symbol.family {
            0 => Self::Time,
            1 => Self::Coordinate(index),
            2 => Self::Velocity(index),
            3 => Self::Acceleration(index),
            4 => Self::Multiplier(index),
            5 => Self::Parameter(index),
            6 => Self::Change(index),
            7 => Self::Factor(index),
            8 => Self::Forcing(index),
            9 => Self::Bias(index),
            10 => Self::ParameterChange(index),
            11 => Self::Slope(index),
            12 => Self::AccelerationChange(index),
            13 => Self::MultiplierChange(index),
            14 => Self::Sum(index),
            15 => Self::Order,
            16 => Self::OrderReciprocal,
            17 => Self::Momentum(index),
            18 => Self::Term(index),
            19 => Self::Given(index),
            20 => Self::NextWeight,
            22 => Self::Switch(index),
            23 => Self::Level(index),
            24 => Self::Length(index),
            25 => Self::Total(index),
            _ => Self::WeightsReciprocal,
        }
    }
}

/// True if a velocity occurs in any of these expressions.
pub(crate) fn has_velocity(graph: &Graph, roots: &[Id]) -> bool {
    graph.symbols(roots).any(|symbol| matches!(Variable::of(symbol), Variable::Velocity(_)))
}

/// Returns the symbols of a variable, one per coordinate.
pub(crate) fn symbols(count: usize, variable: fn(usize) -> Variable) -> Vec<Symbol> {
    (0..count).map(|i| variable(i).symbol()).collect()
}

/// Returns the graph nodes of a variable, one per coordinate.
pub(crate) fn nodes(graph: &mut Graph, count: usize, variable: fn(usize) -> Variable) -> Vec<Id> {
    (0..count).map(|i| graph.symbol(variable(i).symbol())).collect()
}

/// A variable of each coordinate, and its rate of change.
type Rate = (fn(usize) -> Variable, fn(usize) -> Variable);

/// Total time derivative: q changes with q̇, q̇ with q̈, time with 1.
pub(crate) fn total_time_derivative(graph: &mut Graph, coordinates: usize) -> Forward {
    let rates: [Rate; 2] =
        [(Variable::Coordinate, Variable::Velocity), (Variable::Velocity, Variable::Acceleration)];
    in_time(directions(graph, coordinates, &rates))
}

/// Total time derivative for zero accelerations.
pub(crate) fn drift(graph: &mut Graph, coordinates: usize) -> Forward {
    in_time(directions(graph, coordinates, &[(Variable::Coordinate, Variable::Velocity)]))
}

fn in_time(rates: Vec<(Symbol, Id)>) -> Forward {
    Forward::along([(Variable::Time.symbol(), Id::ONE)].into_iter().chain(rates))
}

/// Returns pairs of a variable and its rate, coordinate by coordinate.
pub(crate) fn directions(graph: &mut Graph, coordinates: usize, rates: &[Rate]) -> Vec<(Symbol, Id)> {
    let pairs = (0..coordinates).flat_map(|i| rates.iter().map(move |(of, rate)| (of(i), rate(i))));
    pairs.map(|(of, rate)| (of.symbol(), graph.symbol(rate.symbol()))).collect()
}
