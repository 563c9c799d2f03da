//! Dense output of steps of any method, from the states at both ends.

use core::array;

use crate::number::Scalar;
use crate::solution::interpolant::{evaluate, hermite};
use crate::system::State;
use crate::vector::{Length, Numbers, PhaseVector, VectorOf};

/// Coefficients of dense output; those beyond the cubic are zero for methods up to order 4.
pub(crate) type Coefficients<T, N> = [PhaseVector<T, N>; 8];

/// Times of the evaluations within a step, in units of it. They are not those of Lobatto's quadrature: its sum of
/// slopes would determine the change over the step, and leave a polynomial undetermined.
const NODES: [f64; 4] = [0.2, 0.4, 0.6, 0.8];
/// Inverse of the matrix of the slopes, at these times, of the polynomials after the cubic: θ²(1−θ)², θ³(1−θ)²,
/// θ³(1−θ)³ and θ⁴(1−θ)³.
const FROM_SLOPES: [[f64; 4]; 4] = [
    [-11.363_636_363_636_363, -28.409_090_909_090_91, -7.575_757_575_757_576, -26.988_636_363_636_363],
    [38.352_272_727_272_73, 35.984_848_484_848_484, 35.984_848_484_848_484, 38.352_272_727_272_73],
    [67.077_020_202_020_2, 102.588_383_838_383_83, 15.782_828_282_828_282, 110.479_797_979_797_98],
    [-177.556_818_181_818_2, -118.371_212_121_212_12, -118.371_212_121_212_12, -177.556_818_181_818_2],
];

/// Cubic Hermite polynomial through states and rates at both ends: an error of fourth order in the step.
pub(super) fn cubic<T: Scalar, N: Length>(
    [start, end]: [&State<T, N>; 2],
    accelerations: &PhaseVector<T, N>,
) -> Coefficients<T, N> {
    let node = |state: &State<T, N>, end: usize| {
        let y = PhaseVector::joined(&state.q, &state.v);
        let mut rates = y.clone();
        rates[0].copy_from_slice(&y[1]);
        rates[1].copy_from_slice(&accelerations[end]);
        (y, rates)
    };
    let [(from, first), (to, last)] = [node(start, 0), node(end, 1)];
    let mut coefficients: Coefficients<T, N> = array::from_fn(|_| from.clone());
    coefficients.iter_mut().for_each(|r| r.flat_mut().fill(T::constant(0.0)));
    hermite(end.t - start.t, (&from, &first), (&to, &last), &mut coefficients);
    coefficients
}

/// Polynomials of degree 7 through states and rates at both ends, and accelerations at four times within the step: an error of
/// seventh order in the step, of sixth if forces depend on velocities.
///
/// Between, accelerations are those of the quintic polynomial through coordinates, velocities and accelerations at both
/// ends, whose error is of sixth order.
pub(super) fn septic<T: Scalar, N: Length, E>(
    ends: [&State<T, N>; 2],
    accelerations: &PhaseVector<T, N>,
    mut between: impl FnMut(&State<T, N>) -> Result<VectorOf<T, N>, E>,
) -> Result<Coefficients<T, N>, E> {
    let h = ends[1].t - ends[0].t;
    let mut coefficients = cubic(ends, accelerations);
    let mut slopes = NODES.map(|_| accelerations.clone());
    for (slope, node) in slopes.iter_mut().zip(NODES) {
        let found = between(&quintic(ends, accelerations, h, T::constant(node)))?;
        slope[1].copy_from_slice(found.entries());
    }
    complete(&mut coefficients, 1, h, &slopes);
    for (slope, node) in slopes.iter_mut().zip(NODES) {
        let (y, _) = evaluate(&coefficients, T::constant(node));
        slope[0].copy_from_slice(&y[1]);
    }
    complete(&mut coefficients, 0, h, &slopes);
    Ok(coefficients)
}

/// Adds the polynomials after the cubic to one half, so that it has these slopes at the nodes.
fn complete<T: Scalar, N: Length>(
    coefficients: &mut Coefficients<T, N>,
    half: usize,
    h: T,
    slopes: &[PhaseVector<T, N>; 4],
) {
    let cubic: [[T; 4]; 4] = NODES.map(|node| slopes_of_cubic(T::constant(node)));
    for i in 0..slopes[0][half].len() {
        let left: [T; 4] = array::from_fn(|k| {
            let slope = (0..4).fold(T::constant(0.0), |sum, r| sum + cubic[k][r] * coefficients[r][half][i]);
            h * slopes[k][half][i] - slope
        });
        for (r, row) in FROM_SLOPES.iter().enumerate() {
            let entry = (0..4).fold(T::constant(0.0), |sum, k| sum + T::constant(row[k]) * left[k]);
            coefficients[4 + r][half][i] = entry;
        }
    }
}

/// Slopes at θ of 1, θ, θ(1−θ) and θ²(1−θ).
fn slopes_of_cubic<T: Scalar>(theta: T) -> [T; 4] {
    let number = T::constant;
    let (one, two, three) = (number(1.0), number(2.0), number(3.0));
    [number(0.0), one, one - two * theta, theta * (two - three * theta)]
}

/// State at θ of the quintic polynomial through coordinates, velocities and accelerations at both ends.
fn quintic<T: Scalar, N: Length>(
    [start, end]: [&State<T, N>; 2],
    ends: &PhaseVector<T, N>,
    h: T,
    theta: T,
) -> State<T, N> {
    let number = T::constant;
    let square = theta * theta;
    let cube = square * theta;
    let mut state = start.clone();
    state.t = start.t + theta * h;
    for i in 0..ends[0].len() {
        // Deviation from the start's parabola: θ³ times a quadratic polynomial in θ.
        let (v, a) = (h * start.v[i], h * h * ends[0][i]);
        let position = end.q[i] - start.q[i] - v - number(0.5) * a;
        let velocity = h * end.v[i] - v - a;
        let acceleration = h * h * ends[1][i] - a;
        let c = number(10.0) * position - number(4.0) * velocity + number(0.5) * acceleration;
        let d = number(7.0) * velocity - number(15.0) * position - acceleration;
        let e = number(6.0) * position - number(3.0) * velocity + number(0.5) * acceleration;
        state.q[i] = start.q[i] + theta * v + number(0.5) * square * a + cube * (c + theta * (d + theta * e));
        let slope = number(3.0) * c + theta * (number(4.0) * d + theta * number(5.0) * e);
        state.v[i] = (v + theta * a + square * slope) / h;
    }
    state
}
