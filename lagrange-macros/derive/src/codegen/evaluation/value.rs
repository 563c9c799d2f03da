//! Evaluates a single operation on numbers.

use crate::codegen::operation::Operation;
use crate::symbolic::{Function, Symbol};

impl<X> Operation<X> {
    /// Value, as the emitted code computes it for `f64`. The result of a supplied function is NaN: it is not known here.
    #[inline(always)]
    pub(in crate::codegen) fn value(self, input: impl Fn(Symbol) -> f64, operand: impl Fn(X) -> f64) -> f64 {
        match self {
            Self::Constant(bits) => f64::from_bits(bits),
            Self::Input(symbol) => input(symbol),
            Self::Negate(x) => -operand(x),
            Self::Add(x, y) => operand(x) + operand(y),
            Self::Subtract(x, y) => operand(x) - operand(y),
            Self::Multiply(x, y) => operand(x) * operand(y),
            Self::Divide(x, y) => operand(x) / operand(y),
            Self::MultiplyAdd(x, y, z) => operand(x) * operand(y) + operand(z),
            Self::SubtractProduct(x, y, z) => operand(z) - operand(x) * operand(y),
            Self::Minimum(x, y) => operand(x).min(operand(y)),
            Self::Maximum(x, y) => operand(x).max(operand(y)),
            Self::Where(x, y) => {
                if operand(x) == 0.0 {
                    0.0
                } else {
                    operand(y)
                }
            }
            Self::NanIfIllConditioned(least, most) => nan_if_ill_conditioned(operand(least), operand(most)),
            Self::SquareRoot(x) => operand(x).sqrt(),
            Self::Function(function, x) => applied(function, operand(x)),
            Self::Atan2(y, x) => operand(y).atan2(operand(x)),
            Self::Power(x, y) => operand(x).powf(operand(y)),
            Self::Result { .. } => f64::NAN,
        }
    }
}

/// Zero, or NaN if a ratio of a pivot to its diagonal entry loses more than a third of the digits.
fn nan_if_ill_conditioned(least: f64, most: f64) -> f64 {
    let bound = f64::EPSILON.cbrt();
    if least > bound && most < 1.0 / bound { 0.0 } else { f64::NAN }
}

fn applied(function: Function, x: f64) -> f64 {
    match function {
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => x.tanh(),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Abs => x.abs(),
        Function::Ramp => 0.5 * (x + x.abs()),
        Function::Step if x == 0.0 => 0.5,
        Function::Step => 0.5 + 0.5 * x.signum(),
    }
}
