//! Operations of a schedule and their operands.

use crate::symbolic::{Function, MOST_PARTIALS, Symbol};

/// Result of one operation of a schedule.
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

/// One operation. Operands are registers, or another representation `X`.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Operation<X = Register> {
    /// Constant, as the bits of an `f64`.
    Constant(u64),
    Input(Symbol),
    Negate(X),
    Add(X, X),
    Subtract(X, X),
    Multiply(X, X),
    Divide(X, X),
    /// x y + z, rounded once if the target has a fused multiply-add
    MultiplyAdd(X, X, X),
    /// z − x y
    SubtractProduct(X, X, X),
    Minimum(X, X),
    Maximum(X, X),
    /// Zero if the first operand is zero, else the second. Discards a NaN or an infinity in the second.
    Where(X, X),
    /// Zero if the smallest and the largest ratio of a diagonal entry to its pivot are moderate, else NaN.
    NanIfIllConditioned(X, X),
    SquareRoot(X),
    Function(Function, X),
    Atan2(X, X),
    Power(X, X),
    /// One result of a call, by the index of the call in the schedule.
    Result {
        call: u32,
        output: u32,
    },
}

/// Call of a user-supplied function, or of a derivative of it.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) struct Call<X = Register> {
    pub(super) function: u32,
    pub(super) derivatives: Box<[u32]>,
    pub(super) arguments: Box<[X]>,
    pub(super) kind: CallKind,
}

/// Arguments that a call of a supplied function takes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum CallKind {
    /// The arguments of the function.
    Partial,
    /// The arguments of the function, followed by a direction to differentiate along. [Slopes](super::slopes) replace it.
    Along,
    /// A direction, which multiplies the gradients in [block](super::slopes::SlopeBlock) number so-and-so of the slopes.
    Slopes(usize),
}

/// Function, order, partial derivative if it stands apart, kind, arguments.
pub(super) type Family<'c, X = Register> = (u32, usize, &'c [u32], CallKind, &'c [X]);

/// Argument of a call outside of a schedule.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum CallArgument {
    /// Constant, as the bits of an `f64`.
    Constant(u64),
    /// A number that is kept, by its index.
    Kept(usize),
}

impl<X> Call<X> {
    /// Calls with equal families are emitted together: those of a long function that differ only in the arguments of differentiation.
    /// Calls of a short function are optimized better apart: six partial derivatives take 50 ns, and 256 ns in a loop.
    pub(super) fn family(&self) -> Family<'_, X> {
        let is_long = self.arguments.len() > MOST_PARTIALS;
        let apart = if is_long { &[] } else { &self.derivatives[..] };
        (self.function, self.derivatives.len(), apart, self.kind, &self.arguments)
    }

    /// The same call with other arguments.
    pub(super) fn on<Y>(&self, argument: impl FnMut(&X) -> Y) -> Call<Y> {
        let (function, derivatives, kind) = (self.function, self.derivatives.clone(), self.kind);
        Call { function, derivatives, arguments: self.arguments.iter().map(argument).collect(), kind }
    }
}

impl Operation {
    /// Orders the operands of a commutative operation, so that x + y and y + x are equal.
    pub(super) fn canonical(self) -> Self {
        match self {
            Self::Add(x, y) => Self::Add(x.min(y), x.max(y)),
            Self::Multiply(x, y) => Self::Multiply(x.min(y), x.max(y)),
            _ => self,
        }
    }
}

impl<X> Operation<X> {
    /// Maps the operands. Arguments of a call are stored elsewhere and do not change.
    pub(super) fn with_operands<Y>(self, mut new: impl FnMut(X) -> Y) -> Operation<Y> {
        match self {
            Self::Constant(bits) => Operation::Constant(bits),
            Self::Input(symbol) => Operation::Input(symbol),
            Self::Result { call, output } => Operation::Result { call, output },
            Self::Negate(x) => Operation::Negate(new(x)),
            Self::SquareRoot(x) => Operation::SquareRoot(new(x)),
            Self::Function(function, x) => Operation::Function(function, new(x)),
            Self::Add(x, y) => Operation::Add(new(x), new(y)),
            Self::Subtract(x, y) => Operation::Subtract(new(x), new(y)),
            Self::Multiply(x, y) => Operation::Multiply(new(x), new(y)),
            Self::Divide(x, y) => Operation::Divide(new(x), new(y)),
            Self::Minimum(x, y) => Operation::Minimum(new(x), new(y)),
            Self::Maximum(x, y) => Operation::Maximum(new(x), new(y)),
            Self::Where(x, y) => Operation::Where(new(x), new(y)),
            Self::NanIfIllConditioned(x, y) => Operation::NanIfIllConditioned(new(x), new(y)),
            Self::Atan2(x, y) => Operation::Atan2(new(x), new(y)),
            Self::Power(x, y) => Operation::Power(new(x), new(y)),
            Self::MultiplyAdd(x, y, z) => Operation::MultiplyAdd(new(x), new(y), new(z)),
            Self::SubtractProduct(x, y, z) => Operation::SubtractProduct(new(x), new(y), new(z)),
        }
    }

    /// Returns the operands, except the arguments of a call.
    pub(super) fn operands(self) -> impl Iterator<Item = X> {
        let (mut operands, mut count) = ([None, None, None], 0);
        self.with_operands(|operand| {
            operands[count] = Some(operand);
            count += 1;
        });
        operands.into_iter().flatten()
    }
}
