//! Composite scalars that combine with the scalars of one system.

use super::scalar::Scalar;

/// A scalar that broadcasts a number of type `T` into all of its components: `Lanes` over `f64`, and every
/// scalar over itself.
///
/// Linear operations accept it: one factorization solves for right-hand sides on lanes,
/// [`Lagrangian::solve_with`](crate::Lagrangian::solve_with).
pub trait Broadcast<T>: Scalar {
    /// Returns `x` in all components.
    fn of(x: T) -> Self;
}

impl<T: Scalar> Broadcast<T> for T {
    #[inline(always)]
    fn of(x: T) -> Self {
        x
    }
}

/// Composite scalars over `T` with accessible components.
pub trait Wide<T>: Broadcast<T> {
    /// Number of components.
    const COUNT: usize;

    /// Returns the number with these components.
    fn from_lanes(of: impl FnMut(usize) -> T) -> Self;

    /// Sets one component.
    fn put(&mut self, lane: usize, x: T);

    /// Returns one component.
    fn lane(&self, lane: usize) -> T;
}
