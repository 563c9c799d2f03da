//! Which symbol of the graph stands for which variable of mechanics.

use crate::symbolic::Symbol;

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
    /// How fast one of the arguments of the equations changes along a direction.
    Change(usize),
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
        };
        Symbol { family, index: index as u32 }
    }

    /// Whether only the solution of the equations of motion gives it a value.
    pub(crate) fn is_solved(self) -> bool {
        matches!(self, Self::Acceleration(_) | Self::Multiplier(_))
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
            _ => Self::Change(index),
        }
    }
}
