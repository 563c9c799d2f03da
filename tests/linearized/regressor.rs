//! Regressors of inertial parameters, and the combinations of these that can be found.

use lagrange_core::linearized::BaseParameters;
use lagrange_core::nalgebra::{Const, DVector, Matrix3, SVector, Vector3};
use lagrange_core::prelude::*;
use lagrange_random::Random;

#[derive(Clone, Copy)]
pub(crate) struct Body {
    pub(crate) m: f64,
    pub(crate) centre: Vector3<f64>,
    pub(crate) inertia: Matrix3<f64>,
}

pub(crate) fn body(random: &mut Random) -> Body {
    let mut vector = || Vector3::from(random.vector::<3>());
    let (centre, [a, b, c]) = (vector(), [0, 1, 2].map(|_| vector()));
    let root = Matrix3::from_columns(&[a, b, c]);
    Body { m: 2.0 + random.number(), centre, inertia: root * root.transpose() }
}

pub(crate) fn somewhere<const N: usize>(random: &mut Random) -> (State<f64, N>, SVector<f64, N>) {
    let mut all = |size: f64| core::array::from_fn(|_| size * random.number());
    (State::new(all(3.0), all(2.0)), all(5.0).into())
}

/// Compares inverse dynamics at a random state with the regressor: what is no body is given by `others`.
pub(crate) fn forces_are_those_of_the_regressor<L, const N: usize, const M: usize>(
    system: &L,
    bodies: &[&str],
    random: &mut Random,
    others: impl Fn(&State<f64, N>) -> SVector<f64, N>,
) where
    L: Linearized<N = Const<N>, M = Const<M>, Scalar = f64> + Clone,
{
    let (state, accelerations) = somewhere(random);
    let regressor = system.regressor(&state, &accelerations, bodies).unwrap();
    let found = &regressor.matrix * system.inertial_parameters(bodies).unwrap() + &regressor.offset;
    let exact = system.inverse_dynamics(&state, &accelerations, &SVector::zeros());
    let off = (found - DVector::from_column_slice(exact.as_slice())).amax();
    assert!(off < 1e-13 * exact.amax(), "off by {off:e} of {:e}", exact.amax());
    let others = others(&state);
    let off = (&regressor.offset - DVector::from_column_slice(others.as_slice())).amax();
    assert!(off < 1e-13 * others.amax(), "off by {off:e} of {:e}", others.amax());
}

/// A parallelogram of four bars in a vertical plane, cut open at a joint, whose cut is a constraint.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [3])]
#[frame(left: rotate_z(q[0]))]
#[frame(coupler in left: translate([l, 0, 0]), rotate_z(q[1]))]
#[frame(right: translate([w, 0, 0]), rotate_z(q[2]))]
#[parameter(a: {m, centre: [3], inertia: symmetric})]
#[parameter(b: {m, centre: [3], inertia: symmetric})]
#[parameter(c: {m, centre: [3], inertia: symmetric})]
#[lagrangian(
    kinetic(left, a.m, a.centre, a.inertia) + kinetic(coupler, b.m, b.centre, b.inertia) + kinetic(right, c.m, c.centre, c.inertia)
    - g*(a.m*position(left, a.centre)[1] + b.m*position(coupler, b.centre)[1] + c.m*position(right, c.centre)[1])
)]
#[define(gap = position(coupler, [w, 0, 0]) - position(right, [l, 0, 0]))]
#[constraint(closed: [gap[0], gap[1]] = 0)]
#[dissipation(damping/2*dot(q_dot, q_dot))]
#[force(q: torque)]
pub(crate) struct Bars {
    a: Body,
    b: Body,
    c: Body,
    l: f64,
    w: f64,
    g: f64,
    damping: f64,
    torque: [f64; 3],
}

pub(crate) const NAMES: [&str; 3] = ["a", "b", "c"];

pub(crate) fn bars(random: &mut Random) -> Bars {
    let [a, b, c] = [0; 3].map(|_| body(random));
    Bars { a, b, c, l: 0.7, w: 1.1, g: 9.81, damping: 0.0, torque: [0.4, 0.0, -0.3] }
}

#[test]
fn forces_of_bars_are_those_of_the_regressor() {
    let mut random = Random(1);
    for _ in 0..100 {
        let bars = Bars { damping: 0.3, ..bars(&mut random) };
        forces_are_those_of_the_regressor(&bars, &NAMES, &mut random, |state| {
            0.3 * state.v - SVector::from(bars.torque)
        });
    }
}

/// The bars of a parallelogram move as one body: q₁ = −q₀ and q₂ = q₀. Three combinations can be found: the inertia I(a) +
/// I(c) + m(b) l², and the moments along and across that gravity acts on; the coupler does not turn.
#[test]
fn a_parallelogram_has_three_base_parameters() {
    let mut random = Random(1);
    let bars = bars(&mut random);
    let regressors: Vec<_> = (0..20)
        .map(|k| {
            let (angle, speed) = (0.25 * f64::from(k) - 2.4, 1.0 + (1.7 * f64::from(k)).sin());
            let state = State::new([angle, -angle, angle], [speed, -speed, speed]);
            let moved = bars.solve(&state).unwrap().accelerations;
            let regressor = bars.regressor(&state, &moved, &NAMES).unwrap();
            // The motion satisfies its equation along what is free, with the torques in the offset.
            let (matrix, offset) = regressor.along_free();
            assert_eq!(matrix.nrows(), 1);
            let left = matrix * bars.inertial_parameters(&NAMES).unwrap() + offset;
            assert!(left.amax() < 1e-11, "{left}");
            regressor
        })
        .collect();
    let base = BaseParameters::of(&regressors).unwrap();
    let told: Vec<String> = base.to_string().lines().map(String::from).collect();
    assert_eq!(
        told,
        [
            "I(a)[2][2] + 0.49 m(b) + 1 I(c)[2][2]",
            "mc(a)[0] + 0.7 m(b) + 1 mc(c)[0]",
            "mc(a)[1] + 1 mc(c)[1]",
        ]
    );
}
