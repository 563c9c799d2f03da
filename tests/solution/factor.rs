//! The factor of the equations' matrix: solves for any right-hand sides, on every scalar.

use lagrange_core::{Scalar, number::FourLanes, prelude::*};
use lagrange_random::Random;
use nalgebra::{Const, SVector};
use num_dual::Dual64;

use crate::{Rods, chains, residual, vector};

/// A skate on a plank that swings, held at a height: constraints of all kinds.
#[derive(Lagrangian)]
#[coordinates(x, y, z, phi)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) + j/2*phi_dot^2 + m*a*phi_dot*x_dot - m*g*z)]
#[constraint(plank: z = a*sin(w*t)*x + x*y/4)]
#[constraint(blade: cos(phi)*y_dot - sin(phi)*x_dot = a*cos(w*t))]
pub(crate) struct Skate {
    pub(crate) m: f64,
    pub(crate) j: f64,
    pub(crate) g: f64,
    pub(crate) a: f64,
    pub(crate) w: f64,
}

/// A body that turns: M is singular along the quaternion, and its constraint completes it.
#[derive(Lagrangian)]
#[coordinates(q: [4], r: [3])]
#[define(b = quat_rate_body(q, q_dot))]
#[lagrangian((j[0]*b[0]^2 + j[1]*b[1]^2 + j[2]*b[2]^2)/2 + m/2*dot(r_dot, r_dot))]
#[constraint(unit: (dot(q, q) - 1)/2 = 0)]
pub(crate) struct Body {
    pub(crate) j: [f64; 3],
    pub(crate) m: f64,
}

/// So densely coupled that loops solve it; the massless `z` is completed by its constraint.
#[derive(Lagrangian)]
#[coordinates(x: [30], z)]
#[lagrangian(dot(x_dot, x_dot)/2 + dot(c, x_dot)^2/2 - z)]
#[constraint(height: z = x[0]*x[1] + x[2])]
#[constraint(tie: x[3] = sin(x[4]))]
struct Dense {
    c: [f64; 30],
}

fn state<const N: usize>(random: &mut Random) -> State<f64, N> {
    State::new(vector(random), vector(random)).at_time(0.3)
}

/// Eight rods of equal masses and lengths.
pub(crate) fn rods() -> Rods<f64> {
    chains([1.3; 8], [0.7; 8]).0
}

fn check<L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>, const N: usize, const M: usize>(
    system: &L,
) {
    let random = &mut Random(17);
    for _ in 0..30 {
        let state = state(random);
        let factor = system.factor(&state);
        for _ in 0..3 {
            let (h, gamma) = (vector(random), vector(random));
            let solution = system.solve_with(&factor, &h, &gamma);
            let left = residual(system, &state, (&h, &gamma), &solution);
            // The elimination loses as many digits as its pivot tells.
            assert!(left * solution.pivot < 1e-14, "{}: {left:e}, pivot {:e}", L::NAME, solution.pivot);
        }
        let (h, gamma) = (system.forcing(&state), system.constraint_bias(&state));
        let (solved, fused) =
            (system.solve_with(&factor, &h, &gamma), system.accelerations_unchecked(&state));
        let size = fused.accelerations.amax() + fused.multipliers.amax();
        let apart = (solved.accelerations - fused.accelerations).amax()
            + (solved.multipliers - fused.multipliers).amax();
        assert!(apart * fused.pivot < 1e-13 * size, "{}: {apart:e} of {size:e}", L::NAME);
        assert!((solved.pivot - fused.pivot).abs() <= 1e-12, "{}", L::NAME);
    }
}

#[test]
fn one_factor_solves_for_any_right_hand_sides() {
    let (rods, angles) = chains([1.3; 8], [0.7; 8]);
    check(&rods);
    check(&angles);
    check(&Skate { m: 1.3, j: 0.4, g: 9.81, a: 0.2, w: 3.0 });
    check(&Body { j: [0.3, 1.0, 2.5], m: 1.7 });
    check(&Dense { c: vector::<30>(&mut Random(5)).into() });
}

/// The same rods over another number type.
fn of<T>(number: impl Fn(f64) -> T + Copy) -> Rods<T> {
    Rods { m: [1.3; 8].map(number), l: [0.7; 8].map(number), g: number(9.81) }
}

/// In single precision, on lanes and with derivatives.
#[test]
fn every_scalar_is_solved() {
    let (rods, random) = (rods(), &mut Random(3));
    let states: [State<f64, 16>; 4] = std::array::from_fn(|_| state(random));
    let (h, gamma): (SVector<f64, 16>, SVector<f64, 8>) = (vector(random), vector(random));
    let solve = |state: &State<f64, 16>| rods.solve_with(&rods.factor(state), &h, &gamma);
    let solved = states.each_ref().map(solve);

    let lane = |x: [f64; 4]| FourLanes::from(x);
    let packed = State {
        t: lane(states.map(|state| state.t)),
        q: SVector::from_fn(|i, _| lane(states.map(|state| state.q[i]))),
        v: SVector::from_fn(|i, _| lane(states.map(|state| state.v[i]))),
    };
    let wide = of(FourLanes::constant);
    let (h_of_lanes, gamma_of_lanes) = (h.map(FourLanes::constant), gamma.map(FourLanes::constant));
    let of_lanes = wide.solve_with(&wide.factor(&packed), &h_of_lanes, &gamma_of_lanes);
    for (i, lanes) in of_lanes.accelerations.iter().enumerate() {
        for (lane, solved) in lanes.to_array().iter().zip(&solved) {
            let size = solved.accelerations.amax() / solved.pivot;
            assert!((lane - solved.accelerations[i]).abs() <= 1e-14 * size, "{i}");
        }
    }

    let single = of(|x| x as f32);
    let small = State { t: 0.3, q: states[0].q.cast(), v: states[0].v.cast() };
    let of_single = single.solve_with(&single.factor(&small), &h.cast::<f32>(), &gamma.cast());
    let apart = (of_single.accelerations.cast::<f64>() - solved[0].accelerations).amax();
    assert!(apart * solved[0].pivot < 1e-5 * solved[0].accelerations.amax(), "{apart:e}");

    // Along the first coordinate, against a difference.
    let with = |x: f64| Dual64::from_re(x);
    let mut turned = State { t: with(0.3), q: states[0].q.map(with), v: states[0].v.map(with) };
    turned.q[0] = turned.q[0].derivative();
    let dual = of(with);
    let of_dual = dual.solve_with(&dual.factor(&turned), &h.map(with), &gamma.map(with));
    let [ahead, behind] = [1e-6, -1e-6].map(|step| {
        let mut state = states[0];
        state.q[0] += step;
        solve(&state).accelerations
    });
    let difference = (ahead - behind) / 2e-6;
    assert!((of_dual.accelerations.map(|x| x.eps) - difference).amax() < 1e-6 * difference.amax());
}

/// What cannot be solved shows in the factor, and in every solve by it.
#[test]
fn a_factor_of_nothing_vouches_for_nothing() {
    let pivot = |j: [f64; 3], m: f64| {
        let body = Body { j, m };
        let state = State::at_rest([1.0, 0.0, 0.0, 0.0, 0.1, 0.2, 0.3]);
        body.solve_with(&body.factor(&state), &SVector::repeat(1.0), &SVector::repeat(0.0)).pivot
    };
    assert!(pivot([1.0, 2.0, 3.0], 1.0) > 0.01);
    for (j, m) in [([1.0, 2.0, 3.0], 0.0), ([0.0; 3], 1.0), ([1.0, f64::NAN, 1.0], 1.0)] {
        let pivot = pivot(j, m);
        assert!(pivot.is_nan() || pivot < 1e-6, "{j:?} {m}: {pivot:e}");
    }
}
