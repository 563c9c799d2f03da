//! Binary operations and what they compute with.

use crate::symbolic::{Function, Symbol};

/// The result of one operation.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct Register(u32);

impl Register {
    pub(super) fn at(index: usize) -> Self {
        Self(index as u32)
    }

    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// One operation on earlier results.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Operation {
    /// A constant, by the bits of its value.
    Constant(u64),
    Input(Symbol),
    Negate(Register),
    Add(Register, Register),
    Subtract(Register, Register),
    Multiply(Register, Register),
    Divide(Register, Register),
    /// x y + z, rounded once where the target can.
    MultiplyAdd(Register, Register, Register),
    /// z − x y
    SubtractProduct(Register, Register, Register),
    Minimum(Register, Register),
    Maximum(Register, Register),
    /// Zero where the first is zero, else the second.
    Where(Register, Register),
    SquareRoot(Register),
    Function(Function, Register),
    Atan2(Register, Register),
    Power(Register, Register),
    /// One result of a call, by its place among the calls of the schedule.
    Result {
        call: u32,
        output: u32,
    },
}

/// A call of a function that the user supplies, or of a partial derivative of it.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) struct Call {
    pub(super) function: u32,
    pub(super) derivatives: Box<[u32]>,
    pub(super) arguments: Box<[Register]>,
}

impl Operation {
    /// Of x + y and y + x, and of the like, the one form that stands for both.
    pub(super) fn canonical(self) -> Self {
        let sorted = |x: Register, y: Register| (x.min(y), x.max(y));
        match self {
            Self::Add(x, y) => {
                let (x, y) = sorted(x, y);
                Self::Add(x, y)
            }
            Self::Multiply(x, y) => {
                let (x, y) = sorted(x, y);
                Self::Multiply(x, y)
            }
            _ => self,
        }
    }

    /// The same operation on other operands, but for those of a call.
    pub(super) fn with_operands(self, mut new: impl FnMut(Register) -> Register) -> Self {
        match self {
            Self::Constant(_) | Self::Input(_) | Self::Result { .. } => self,
            Self::Negate(x) => Self::Negate(new(x)),
            Self::SquareRoot(x) => Self::SquareRoot(new(x)),
            Self::Function(function, x) => Self::Function(function, new(x)),
            Self::Add(x, y) => Self::Add(new(x), new(y)),
            Self::Subtract(x, y) => Self::Subtract(new(x), new(y)),
            Self::Multiply(x, y) => Self::Multiply(new(x), new(y)),
            Self::Divide(x, y) => Self::Divide(new(x), new(y)),
            Self::Minimum(x, y) => Self::Minimum(new(x), new(y)),
            Self::Maximum(x, y) => Self::Maximum(new(x), new(y)),
            Self::Where(x, y) => Self::Where(new(x), new(y)),
            Self::Atan2(x, y) => Self::Atan2(new(x), new(y)),
            Self::Power(x, y) => Self::Power(new(x), new(y)),
            Self::MultiplyAdd(x, y, z) => Self::MultiplyAdd(new(x), new(y), new(z)),
            Self::SubtractProduct(x, y, z) => Self::SubtractProduct(new(x), new(y), new(z)),
        }
    }

    /// All but those of a call.
    pub(super) fn operands(self) -> impl Iterator<Item = Register> {
        let [first, second, third] = match self {
            Self::Constant(_) | Self::Input(_) | Self::Result { .. } => [None; 3],
            Self::Negate(x) | Self::SquareRoot(x) | Self::Function(_, x) => [Some(x), None, None],
            Self::Add(x, y)
            | Self::Subtract(x, y)
            | Self::Multiply(x, y)
            | Self::Divide(x, y)
            | Self::Minimum(x, y)
            | Self::Maximum(x, y)
            | Self::Where(x, y)
            | Self::Atan2(x, y)
            | Self::Power(x, y) => [Some(x), Some(y), None],
            Self::MultiplyAdd(x, y, z) | Self::SubtractProduct(x, y, z) => [Some(x), Some(y), Some(z)],
        };
        first.into_iter().chain(second).chain(third)
    }
}
