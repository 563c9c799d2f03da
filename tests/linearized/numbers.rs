//! Jacobians by dual numbers.

use lagrange_core::nalgebra::SVector;
use lagrange_core::{Jacobian, Solution, prelude::*};
use num_dual::Dual64;

/// A bob on a spring whose upper end moves, in a wind, on a turning wire.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[define(end = [a*sin(w*t), 0])]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y - k/2*(norm([x, y] - end) - l)^2)]
#[dissipation(c/4*(x_dot^2 + y_dot^2)^2)]
#[constraint(wire: y_dot - x_dot*x*t = b*y)]
#[force(x: wind*exp(-y^2))]
pub(crate) struct Bob<T> {
    m: T,
    g: T,
    k: T,
    l: T,
    a: T,
    w: T,
    c: T,
    b: T,
    wind: T,
}

pub(crate) fn bob<T: Scalar>(parameters: [T; 9]) -> Bob<T> {
    let [m, g, k, l, a, w, c, b, wind] = parameters;
    Bob { m, g, k, l, a, w, c, b, wind }
}

pub(crate) const PARAMETERS: [f64; 9] = [1.3, 9.81, 20.0, 0.8, 0.3, 2.0, 0.7, 0.4, 1.5];
pub(crate) const ARGUMENTS: [f64; 5] = [0.9, 0.3, -0.7, 0.5, 1.1]; // t, q, v

/// Accelerations and multiplier with a dual number in one place.
fn dual(place: usize) -> (SVector<f64, 2>, f64) {
    let mut all = [ARGUMENTS.map(Dual64::from_re).as_slice(), &PARAMETERS.map(Dual64::from_re)].concat();
    all[place] = all[place].derivative();
    let state = State::new([all[1], all[2]], [all[3], all[4]]).at_time(all[0]);
    let Solution { accelerations, multipliers, .. } =
        bob(std::array::from_fn(|k| all[5 + k])).accelerations_unchecked(&state);
    (accelerations.map(|x| x.eps), multipliers[0].eps)
}

/// Through the emitted elimination, which shares nothing with the derivative of the residual.
#[test]
fn dual_numbers_put_through_the_elimination_give_the_same_jacobian() {
    let [t, x, y, vx, vy] = ARGUMENTS;
    let state = State::new([x, y], [vx, vy]).at_time(t);
    let Jacobian { accelerations: a, multipliers: l, .. } = bob(PARAMETERS).jacobian(&state).unwrap();
    let compare = |place, column: SVector<f64, 2>, multiplier: f64| {
        let (expected, expected_multiplier) = dual(place);
        assert!((column - expected).amax() <= 1e-13 * a.q.amax(), "{place}: {column} {expected}");
        assert!((multiplier - expected_multiplier).abs() <= 1e-13 * l.q.amax(), "{place}");
    };
    compare(0, a.t, l.t[0]);
    for i in 0..2 {
        compare(1 + i, a.q.column(i).into(), l.q[i]);
        compare(3 + i, a.v.column(i).into(), l.v[i]);
    }
    for k in 0..9 {
        compare(5 + k, a.parameters.column(k).into(), l.parameters[k]);
    }
    assert_eq!(Bob::<f64>::PARAMETERS, ["m", "g", "k", "l", "a", "w", "c", "b", "wind"]);
    assert_eq!(bob(PARAMETERS).parameters().as_slice(), PARAMETERS);
}
