//! Elementary functions on numbers and dual numbers.

use lagrange_symbolic::Function;
use num_dual::DualNum;

/// Applies the function to a number of any kind.
pub(crate) fn apply<D: DualNum<Primitive = f64>>(function: Function, x: &D) -> D {
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
        Function::Ramp if x.re() > 0.0 => x.clone(),
        Function::Ramp => D::from(0.0),
        Function::Step => D::from(0.5 + 0.5 * if x.re() == 0.0 { 0.0 } else { x.re().signum() }),
    }
}
