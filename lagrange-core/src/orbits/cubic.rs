//! The cubic with the values and slopes of a test at two neighbours of a family (Hermite).

use super::limits::SHALLOW;
use crate::number::{Real, Scalar, smaller};

/// A test at an arclength, and its slope.
#[derive(Clone, Copy)]
pub(super) struct Knot<T> {
    pub(super) length: T,
    pub(super) value: T,
    pub(super) slope: T,
}

/// Value, slope, half of the second and a sixth of the third derivative of the cubic between two knots, by part of the distance.
fn cubic<T: Real>(left: Knot<T>, right: Knot<T>) -> [T; 4] {
    let span = right.length - left.length;
    let (rise, first, last) = (right.value - left.value, left.slope * span, right.slope * span);
    let (two, three) = (T::constant(2.0), T::constant(3.0));
    [left.value, first, three * rise - two * first - last, first + last - two * rise]
}

/// Where the cubic between two knots has its minimum, if this is far below both.
pub(super) fn lowest<T: Real>(left: Knot<T>, right: Knot<T>) -> Option<T> {
    let [start, first, square, cube] = cubic(left, right);
    let root = Scalar::sqrt(square * square - T::constant(3.0) * first * cube);
    let part = -first / (square + root);
    let value = start + part * (first + part * (square + part * cube));
    let is_inside = part > T::constant(0.0) && part < T::constant(1.0);
    let is_low = value < T::constant(SHALLOW) * smaller(left.value, right.value);
    (is_inside && is_low).then(|| left.length + part * (right.length - left.length))
}

/// A zero of the cubic between two knots of different signs, the left one positive.
pub(super) fn crossing<T: Real>(left: Knot<T>, right: Knot<T>) -> T {
    let [start, first, square, cube] = cubic(left, right);
    let (mut low, mut high) = (T::constant(0.0), T::constant(1.0));
    while high - low > T::constant(T::EPSILON) {
        let part = (low + high) * T::constant(0.5);
        let value = start + part * (first + part * (square + part * cube));
        if value > T::constant(0.0) { low = part } else { high = part }
    }
    left.length + (low + high) * T::constant(0.5) * (right.length - left.length)
}
