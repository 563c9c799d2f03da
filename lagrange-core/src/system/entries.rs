//! Conversion of arrays and vectors to the entries of a state.

use crate::vector::{Element, StaticLength, Vector};

/// Coordinates, velocities or momenta of a state: an array, or any type that converts to a vector of
/// `nalgebra`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not {N} numbers of the type `{T}`",
    label = "not {N} numbers `{T}`",
    note = "write an array with an entry for each coordinate, and whole numbers with a point: `[1.0, 0.0]`",
    note = "in a function for any system write `StateOf::<L>::new(…)` or `generic::State {{ … }}`"
)]
pub trait Entries<T: Element, N: StaticLength> {
    /// Converts the entries to a vector.
    fn into_vector(self) -> Vector<T, N>;
}

#[diagnostic::do_not_recommend]
impl<T: Element, V: Into<Vector<T, N>>, N: StaticLength> Entries<T, N> for V {
    fn into_vector(self) -> Vector<T, N> {
        self.into()
    }
}
