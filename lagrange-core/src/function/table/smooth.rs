//! Tabulated functions smooth enough for methods of high order.

use alloc::boxed::Box;
use alloc::vec::Vec;

use nalgebra::{Matrix2, Vector2};

use crate::error::Error;
use crate::function::supplied::{First, Second, Third, Value};

/// Natural quintic spline through given points: four times continuously differentiable, with the third and the
/// fourth derivative zero at both ends. It minimizes ∫ f‴² among all functions through the points (de Boor, *A
/// Practical Guide to Splines*, chapter XIII). Beyond the ends it continues as a parabola with the slope and
/// the second derivative of the end.
///
/// Motions in a potential of closely spaced points keep the tolerance and take as many steps as in the exact
/// potential; with a [`Table`](super::Table) they take several times as many and lose digits. Between points
/// that are far apart or noisy, a `SmoothTable` oscillates more than a `Table`.
///
/// A field named in `#[function(…)]` may have this type in systems over `f64`, up to third derivatives.
///
/// ```
/// use lagrange_core::function::SmoothTable;
/// use lagrange_core::function::{Third, Value};
/// let table = SmoothTable::new(&[(0.0, 0.0), (1.0, 1.0), (2.0, 4.0), (3.0, 9.0)])?;
/// assert!((table.value([1.5])[0] - 2.25).abs() < 1e-14);
/// assert!(table.third([1.5], [0; 3])[0].abs() < 1e-13);
/// # Ok::<(), lagrange_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothTable {
    knots: Box<[QuinticKnot]>,
}

/// A point with the first two derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
struct QuinticKnot {
    x: f64,
    y: f64,
    slope: f64,
    bend: f64,
}

impl SmoothTable {
    /// Interpolates points `(x, y)`: at least three, with `x` increasing.
    ///
    /// # Errors
    /// [`Error::Table`] for fewer points, for coordinates or derivatives that are not finite, and if `x` does
    /// not increase.
    pub fn new(points: &[(f64, f64)]) -> Result<Self, Error> {
        if points.len() < 3 || !are_increasing(points) {
            return Err(Error::Table);
        }
        let slopes = slopes_and_bends(points).ok_or(Error::Table)?;
        let knots =
            points.iter().zip(slopes).map(|(&(x, y), s)| QuinticKnot { x, y, slope: s[0], bend: s[1] });
        let table = Self { knots: knots.collect() };
        let is_finite =
            |knot: &QuinticKnot| knot.x.is_finite() && table.at(knot.x).into_iter().all(f64::is_finite);
        if table.knots.iter().all(is_finite) { Ok(table) } else { Err(Error::Table) }
    }

    /// Returns the value and the first three derivatives.
    fn at(&self, x: f64) -> [f64; 4] {
        let last = self.knots.len() - 1;
        let right = self.knots.partition_point(|knot| knot.x <= x).clamp(1, last);
        let (a, b) = (self.knots[right - 1], self.knots[right]);
        match x {
            x if x < a.x => a.parabola(x),
            x if x > b.x => b.parabola(x),
            // Expands about the nearer point, where the terms are small.
            x if x - a.x < b.x - x => between(a, b, x),
            x => between(b, a, x),
        }
    }
}

impl QuinticKnot {
    fn parabola(self, x: f64) -> [f64; 4] {
        let away = x - self.x;
        let slope = self.slope + self.bend * away;
        [self.y + (self.slope + slope) * away / 2.0, slope, self.bend, 0.0]
    }
}

/// Returns the value and the first three derivatives of the quintic Hermite interpolant of two knots.
fn between(a: QuinticKnot, b: QuinticKnot, x: f64) -> [f64; 4] {
    let width = b.x - a.x;
    let u = (x - a.x) / width;
    let (rise, [from, to]) = (b.y - a.y, [a, b].map(|knot| knot.slope * width));
    let [bent, bends] = [a, b].map(|knot| knot.bend * width * width / 2.0);
    let cubic = 10.0 * rise - 6.0 * from - 4.0 * to - 3.0 * bent + bends;
    let quartic = -15.0 * rise + 8.0 * from + 7.0 * to + 3.0 * bent - 2.0 * bends;
    let quintic = 6.0 * rise - 3.0 * (from + to) - bent + bends;
    let value = a.y + u * (from + u * (bent + u * (cubic + u * (quartic + u * quintic))));
    let slope = from + u * (2.0 * bent + u * (3.0 * cubic + u * (4.0 * quartic + u * 5.0 * quintic)));
    let bend = 2.0 * bent + u * (6.0 * cubic + u * (12.0 * quartic + u * 20.0 * quintic));
    let third = 6.0 * cubic + u * (24.0 * quartic + u * 60.0 * quintic);
    [value, slope / width, bend / (width * width), third / (width * width * width)]
}

/// Linear equations for the slope and the second derivative at one point and at its neighbours. They make the
/// third and the fourth derivative continuous, and zero at an end. The third derivatives are divided by 3, the
/// fourth by 12.
struct Condition {
    before: Matrix2<f64>,
    here: Matrix2<f64>,
    after: Matrix2<f64>,
    right_side: Vector2<f64>,
}

impl Condition {
    fn at(points: &[(f64, f64)], i: usize) -> Self {
        let zero = Matrix2::zeros();
        let mut condition = Self { before: zero, here: zero, after: zero, right_side: Vector2::zeros() };
        let step = |i: usize| (points[i + 1].0 - points[i].0, points[i + 1].1 - points[i].1);
        if i > 0 {
            let (h, rise) = step(i - 1);
            let (h2, h3) = (h * h, h * h * h);
            condition.before = Matrix2::new(-8.0 / h2, -1.0 / h, -14.0 / h3, -2.0 / h2);
            condition.here += Matrix2::new(-12.0 / h2, 3.0 / h, -16.0 / h3, 3.0 / h2);
            condition.right_side += Vector2::new(-20.0, -30.0 / h) * (rise / h3);
        }
        if i + 1 < points.len() {
            let (h, rise) = step(i);
            let (h2, h3) = (h * h, h * h * h);
            condition.here += Matrix2::new(12.0 / h2, 3.0 / h, -16.0 / h3, -3.0 / h2);
            condition.after = Matrix2::new(8.0 / h2, -1.0 / h, -14.0 / h3, 2.0 / h2);
            condition.right_side += Vector2::new(20.0, -30.0 / h) * (rise / h3);
        }
        condition
    }
}

/// Returns slopes and second derivatives at the points, by Thomas's algorithm with blocks of two.
fn slopes_and_bends(points: &[(f64, f64)]) -> Option<Vec<Vector2<f64>>> {
    let mut found: Vec<Vector2<f64>> = Vec::with_capacity(points.len());
    let mut above: Vec<Matrix2<f64>> = Vec::with_capacity(points.len());
    for i in 0..points.len() {
        let Condition { before, here, after, right_side } = Condition::at(points, i);
        let (pivot, left) = match (above.last(), found.last()) {
            (Some(above), Some(left)) => (here - before * above, right_side - before * left),
            _ => (here, right_side),
        };
        let inverse = inverse(&pivot)?;
        above.push(inverse * after);
        found.push(inverse * left);
    }
    for i in (0..points.len() - 1).rev() {
        let next = found[i + 1];
        found[i] -= above[i] * next;
    }
    Some(found)
}

/// Inverts a 2 × 2 matrix without square roots and absolute values, which a build without `std` and `libm`
/// lacks.
fn inverse(a: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    let determinant = a.m11 * a.m22 - a.m12 * a.m21;
    (determinant != 0.0).then(|| Matrix2::new(a.m22, -a.m12, -a.m21, a.m11) / determinant)
}

impl Value<f64, 1, 1> for SmoothTable {
    fn value(&self, [x]: [f64; 1]) -> [f64; 1] {
        [self.at(x)[0]]
    }
}

impl First<f64, 1, 1> for SmoothTable {
    fn first(&self, [x]: [f64; 1], _: [usize; 1]) -> [f64; 1] {
        [self.at(x)[1]]
    }
}

impl Second<f64, 1, 1> for SmoothTable {
    fn second(&self, [x]: [f64; 1], _: [usize; 2]) -> [f64; 1] {
        [self.at(x)[2]]
    }
}

impl Third<f64, 1, 1> for SmoothTable {
    fn third(&self, [x]: [f64; 1], _: [usize; 3]) -> [f64; 1] {
        [self.at(x)[3]]
    }
}

pub(super) fn are_increasing(points: &[(f64, f64)]) -> bool {
    points.windows(2).all(|pair| pair[0].0 < pair[1].0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNEVEN: [(f64, f64); 6] =
        [(-1.0, 2.0), (-0.5, -1.0), (0.25, 0.5), (2.0, 3.0), (2.125, 2.5), (4.0, -2.0)];

    #[test]
    fn it_goes_through_its_points_and_has_four_continuous_derivatives() {
        let table = SmoothTable::new(&UNEVEN).expect("a table");
        let fourth = |x: f64, h: f64| (table.at(x + h)[3] - table.at(x)[3]) / h;
        let size = UNEVEN.iter().fold(0.0_f64, |most, (x, _)| most.max(table.at(*x)[3].abs()));
        for (x, y) in UNEVEN {
            assert!((table.at(x)[0] - y).abs() < 1e-13);
            let (before, after) = (table.at(x.next_down()), table.at(x.next_up()));
            for order in 0..4 {
                let jump = (before[order] - after[order]).abs();
                assert!(jump < 1e-11 * size, "order {order} jumps by {jump} at {x}");
            }
            // The fourth derivative is linear on each side: extrapolating two differences gives its value at
            // the point itself.
            let [left, right] = [-1e-4, 1e-4].map(|h| 2.0 * fourth(x, h / 2.0) - fourth(x, h));
            assert!((left - right).abs() < 1e-6 * size, "{left} and {right} at {x}");
        }
        for (end, away) in [(-1.0, -0.5), (4.0, 0.5)] {
            let [y, slope, bend, third] = table.at(end);
            assert!(third.abs() < 1e-11 * size && table.at(end + away)[3] == 0.0);
            assert!((table.at(end + away)[0] - (y + slope * away + bend * away * away / 2.0)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_derivatives_are_those_of_the_values() {
        let table = SmoothTable::new(&UNEVEN).expect("a table");
        for x in [-2.0, -0.9, -0.1, 0.3, 1.1, 2.05, 3.9, 5.0] {
            let h = 1e-4;
            let [left, middle, right] = [x - h, x, x + h].map(|x| table.at(x));
            for order in 0..3 {
                let slope = (right[order] - left[order]) / (2.0 * h);
                assert!((slope - middle[order + 1]).abs() < 1e-4, "order {order} at {x}");
            }
        }
    }

    /// The natural spline of points on a parabola is the parabola. For other functions the error inside falls
    /// with the sixth power of the spacing.
    #[test]
    fn parabolas_are_exact_and_the_order_is_six() {
        let parabola = UNEVEN.map(|(x, _)| (x, 3.0 - 2.0 * x + x * x));
        let table = SmoothTable::new(&parabola).expect("a table");
        for x in [-3.0, -0.7, 0.0, 1.0, 2.1, 3.0, 6.0] {
            assert!((table.at(x)[0] - (3.0 - 2.0 * x + x * x)).abs() < 1e-12, "{x}");
        }
        let error = |n: u32| {
            let points: Vec<_> =
                (0..=n).map(|i| 4.0 * f64::from(i) / f64::from(n)).map(|x| (x, x.sin())).collect();
            let table = SmoothTable::new(&points).expect("a table");
            let places = (0..=200).map(|i| 1.5 + f64::from(i) / 200.0);
            places.map(|x| (table.at(x)[0] - x.sin()).abs()).fold(0.0, f64::max)
        };
        let order = (error(64) / error(128)).log2();
        assert!((order - 6.0).abs() < 0.3, "order {order}");
    }

    #[test]
    fn bad_points_are_an_error() {
        let bad: [&[(f64, f64)]; 5] = [
            &[(0.0, 1.0), (1.0, 2.0)],
            &[(0.0, 1.0), (0.0, 2.0), (1.0, 0.0)],
            &[(0.0, 1.0), (1.0, f64::NAN), (2.0, 0.0)],
            &[(-f64::MAX, 1.0), (0.0, 1.0), (f64::MAX, 2.0)],
            &[(0.0, -f64::MAX), (1e-10, f64::MAX), (1.0, 0.0)],
        ];
        for points in bad {
            assert_eq!(SmoothTable::new(points), Err(Error::Table), "{points:?}");
        }
    }
}
