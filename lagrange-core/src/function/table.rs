//! Tabulated functions of one variable.

mod smooth;

pub use smooth::SmoothTable;
use smooth::are_increasing;

use alloc::boxed::Box;
use alloc::vec::Vec;

use super::supplied::{First, Second, Value};
use crate::error::Error;

/// Natural cubic spline through given points: twice continuously differentiable, with the second derivative
/// zero at both ends (Stoer and Bulirsch, *Introduction to Numerical Analysis*, 2.5.2). Beyond the ends it
/// continues as the tangent.
///
/// A field named in `#[function(…)]` may have this type in systems over `f64`. The third derivative jumps at
/// the points, which costs accuracy and steps. Example: twenty oscillations in a Morse potential of 320 points,
/// by `Dop853` at the tolerance 10⁻¹², change the energy by 37,000 tolerances in 6,600 steps; a [`SmoothTable`]
/// of the same points changes it by 7 in 900.
///
/// ```
/// use lagrange_core::function::Table;
/// use lagrange_core::function::Value;
/// let table = Table::new(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)])?;
/// assert_eq!(table.value([1.5]), [1.5]);
/// # Ok::<(), lagrange_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    knots: Box<[CubicKnot]>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct CubicKnot {
    x: f64,
    y: f64,
    /// Second derivative at the point.
    bend: f64,
}

impl Table {
    /// Interpolates points `(x, y)`: at least two, with `x` increasing.
    ///
    /// # Errors
    /// [`Error::Table`] for fewer points, for coordinates or derivatives that are not finite, and if `x` does
    /// not increase.
    pub fn new(points: &[(f64, f64)]) -> Result<Self, Error> {
        if points.len() < 2 || !are_increasing(points) {
            return Err(Error::Table);
        }
        let knots = points.iter().zip(bends(points)).map(|(&(x, y), bend)| CubicKnot { x, y, bend });
        let table = Self { knots: knots.collect() };
        let finite =
            |knot: &CubicKnot| knot.x.is_finite() && table.at(knot.x).into_iter().all(f64::is_finite);
        if table.knots.iter().all(finite) { Ok(table) } else { Err(Error::Table) }
    }

    /// Returns the value and the first two derivatives.
    fn at(&self, x: f64) -> [f64; 3] {
        let last = self.knots.len() - 1;
        let right = self.knots.partition_point(|knot| knot.x <= x).clamp(1, last);
        let (a, b) = (self.knots[right - 1], self.knots[right]);
        let inside = x.clamp(a.x, b.x);
        let width = b.x - a.x;
        let (u, w) = ((inside - a.x) / width, (b.x - inside) / width);
        let square = width * width / 6.0;
        let value = w * a.y + u * b.y + ((w * w * w - w) * a.bend + (u * u * u - u) * b.bend) * square;
        let slope =
            (b.y - a.y) / width + ((3.0 * u * u - 1.0) * b.bend - (3.0 * w * w - 1.0) * a.bend) * width / 6.0;
        let bend = if x == inside { w * a.bend + u * b.bend } else { 0.0 };
        [value + slope * (x - inside), slope, bend]
    }
}

/// Returns the second derivatives at the points. A continuous slope requires a tridiagonal system, solved by
/// Thomas's algorithm.
fn bends(points: &[(f64, f64)]) -> Vec<f64> {
    let n = points.len();
    let mut bends = alloc::vec![0.0; n];
    let mut above = alloc::vec![0.0; n];
    for i in 1..n - 1 {
        let (left, right) = (points[i].0 - points[i - 1].0, points[i + 1].0 - points[i].0);
        let rise = (points[i + 1].1 - points[i].1) / right - (points[i].1 - points[i - 1].1) / left;
        let pivot = 2.0 * (left + right) - left * above[i - 1];
        above[i] = right / pivot;
        bends[i] = (6.0 * rise - left * bends[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        bends[i] -= above[i] * bends[i + 1];
    }
    bends
}

impl Value<f64, 1, 1> for Table {
    fn value(&self, [x]: [f64; 1]) -> [f64; 1] {
        [self.at(x)[0]]
    }
}

impl First<f64, 1, 1> for Table {
    fn first(&self, [x]: [f64; 1], _: [usize; 1]) -> [f64; 1] {
        [self.at(x)[1]]
    }
}

impl Second<f64, 1, 1> for Table {
    fn second(&self, [x]: [f64; 1], _: [usize; 2]) -> [f64; 1] {
        [self.at(x)[2]]
    }
}

#[cfg(test)]
mod tests;
