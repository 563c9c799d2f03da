//! Which symbol of the graph stands for which variable of mechanics, and how these change along a motion.

use crate::symbolic::{Forward, Graph, Id, Symbol};

/// What a symbol stands for.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Variable {
    Time,
    Coordinate(usize),
    Velocity(usize),
    Acceleration(usize),
    Multiplier(usize),
    /// An entry of the list of parameters that the expressions use.
    Parameter(usize),
    /// How fast the time, a coordinate or a velocity changes along a direction.
    Change(usize),
    /// A number of the factor of the equations' matrix.
    Factor(usize),
    /// What stands in the place of h, for each coordinate.
    Forcing(usize),
    /// What stands in the place of γ, for each constraint.
    Bias(usize),
    /// How fast a parameter changes; by its place in the order of the fields.
    ParameterChange(usize),
    /// A number that the derivatives along any direction are made of.
    Slope(usize),
    /// The newest Taylor coefficient of an acceleration.
    AccelerationChange(usize),
    /// The newest Taylor coefficient of a multiplier.
    MultiplierChange(usize),
    /// A sum over products of Taylor coefficients before the newest.
    Sum(usize),
    /// What of a newest Taylor coefficient is known before the accelerations and multipliers of its order.
    Term(usize),
    /// The order of the newest Taylor coefficients …
    Order,
    /// … 1 over it …
    OrderReciprocal,
    /// … a multiple of all orders over the next …
    NextWeight,
    /// … and 1 over the square of that multiple.
    WeightsReciprocal,
    /// What the Hamiltonian is a function of in the place of velocities.
    Momentum(usize),
    /// What a round of a loop in emitted code is given.
    Given(usize),
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
        };
        Symbol { family, index: index as u32 }
    }

    /// Whether only the solution of the equations of motion gives it a value.
    pub(crate) fn is_solved(self) -> bool {
        matches!(self, Self::Acceleration(_) | Self::Multiplier(_))
    }

    /// Whether it is what a linear function is taken of: a change, or a Taylor coefficient.
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
            _ => Self::WeightsReciprocal,
        }
    }
}

/// Whether a velocity occurs in one of these expressions.
pub(crate) fn has_velocity(graph: &Graph, roots: &[Id]) -> bool {
    graph.symbols(roots).any(|symbol| matches!(Variable::of(symbol), Variable::Velocity(_)))
}

/// The symbols of one variable of every coordinate.
pub(crate) fn symbols(count: usize, variable: fn(usize) -> Variable) -> Vec<Symbol> {
    (0..count).map(|i| variable(i).symbol()).collect()
}

/// One variable of every coordinate.
pub(crate) fn nodes(graph: &mut Graph, count: usize, variable: fn(usize) -> Variable) -> Vec<Id> {
    (0..count).map(|i| graph.symbol(variable(i).symbol())).collect()
}

/// Of a variable of every coordinate, the variable that is its rate of change.
type Rate = (fn(usize) -> Variable, fn(usize) -> Variable);

/// d/dt: coordinates change by velocities, velocities by accelerations, time by 1.
pub(crate) fn total_time_derivative(graph: &mut Graph, coordinates: usize) -> Forward {
    let rates: [Rate; 2] =
        [(Variable::Coordinate, Variable::Velocity), (Variable::Velocity, Variable::Acceleration)];
    in_time(directions(graph, coordinates, &rates))
}

/// d/dt along a motion whose accelerations are zero.
pub(crate) fn drift(graph: &mut Graph, coordinates: usize) -> Forward {
    in_time(directions(graph, coordinates, &[(Variable::Coordinate, Variable::Velocity)]))
}

fn in_time(rates: Vec<(Symbol, Id)>) -> Forward {
    Forward::along([(Variable::Time.symbol(), Id::ONE)].into_iter().chain(rates))
}

/// Directions along which the variables of one coordinate after another change at these rates.
pub(crate) fn directions(graph: &mut Graph, coordinates: usize, rates: &[Rate]) -> Vec<(Symbol, Id)> {
    let pairs = (0..coordinates).flat_map(|i| rates.iter().map(move |(of, rate)| (of(i), rate(i))));
    pairs.map(|(of, rate)| (of.symbol(), graph.symbol(rate.symbol()))).collect()
}
