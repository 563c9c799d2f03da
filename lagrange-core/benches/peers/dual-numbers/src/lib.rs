//! The same equations with the derivatives of the Lagrangian taken at run time, by the dual numbers of `num-dual`,
//! and solved by `nalgebra`'s Cholesky decomposition. The signature is that of all implementations here.

mod bodies;
mod planar;

use num_dual::DualNum;

/// What the Lagrangians are evaluated on.
trait Number: DualNum<Primitive = f64> + Copy {}

impl<D: DualNum<Primitive = f64> + Copy> Number for D {}
