//! Jacobians of accelerations, multipliers and constraints against differences of them.

use lagrange_core::nalgebra::{Const, DVector, SVector};
use lagrange_core::{
    Direction, Jacobian, Lanes, Solution, error::Entry, linearized::PartialDerivatives, prelude::*,
};

use crate::by_hand::{largest, ratio};

/// Largest deviation, as a fraction of the largest entry of the Jacobian.
const TOLERANCE: f64 = 1e-9;

/// Steps of the differences, as parts of the arguments' sizes; near a pole only the short one is right.
const STEPS: [f64; 2] = [2e-3, 5e-5];

/// The coefficients of the central difference of eighth order (Fornberg 1988).
const DIFFERENCE: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// A system with `N` coordinates, `M` constraints and `P` parameters.
pub(crate) trait System<const N: usize, const M: usize, const P: usize>:
    Linearized<N = Const<N>, M = Const<M>, P = Const<P>, Scalar = f64>
{
}

impl<L, const N: usize, const M: usize, const P: usize> System<N, M, P> for L where
    L: Linearized<N = Const<N>, M = Const<M>, P = Const<P>, Scalar = f64>
{
}

/// q̈, λ, F q̇ + b and Φ, or their derivatives.
type Blocks = [DVector<f64>; 4];

fn blocks(of: [&[f64]; 4]) -> Blocks {
    of.map(DVector::from_column_slice)
}

/// The values with argument `k` changed: the time, the coordinates, the velocities or the parameters, in this order.
fn shifted<S: System<N, M, P>, const N: usize, const M: usize, const P: usize>(
    system: &mut S,
    state: &State<f64, N>,
    k: usize,
    change: f64,
) -> Blocks {
    let (mut state, parameters, p) = (*state, system.parameters(), k.wrapping_sub(1 + 2 * N));
    match k {
        0 => state.t += change,
        _ if k <= N => state.q[k - 1] += change,
        _ if k <= 2 * N => state.v[k - 1 - N] += change,
        _ => assert!(system.set_parameter(p, parameters[p] + change), "{}", S::PARAMETERS[p]),
    }
    let Solution { accelerations, multipliers, .. } = system.solve(&state).expect("a regular state");
    let (rate, position) = (system.constraint_rate(&state), system.constraint_residual(&state));
    if k > 2 * N {
        system.set_parameter(p, parameters[p]);
    }
    blocks([accelerations.as_slice(), multipliers.as_slice(), rate.as_slice(), position.as_slice()])
}

/// The derivatives by argument `k`, by the formulas that are emitted.
fn emitted<S: System<N, M, P>, const N: usize, const M: usize, const P: usize>(
    system: &S,
    state: &State<f64, N>,
    jacobian: &Jacobian<f64, Const<N>, Const<M>, Const<P>>,
    k: usize,
) -> Blocks {
    let Jacobian { solution, accelerations: a, multipliers: l } = jacobian;
    let (change, a, l) = match k {
        0 => (system.residual_change(state, solution, &Direction::of_time()), a.t, l.t),
        _ if k <= 2 * N => {
            let i = (k - 1) % N;
            let (direction, a, l) = if k <= N {
                (Direction::of_coordinate(i), a.q.column(i), l.q.column(i))
            } else {
                (Direction::of_velocity(i), a.v.column(i), l.v.column(i))
            };
            (system.residual_change(state, solution, &direction), a.into(), l.into())
        }
        _ => {
            let (p, mut rates) = (k - 1 - 2 * N, SVector::from([0.0; P]));
            rates[p] = 1.0;
            let change = system.residual_change_by_parameters(state, solution, &rates);
            (change, a.parameters.column(p).into(), l.parameters.column(p).into())
        }
    };
    blocks([a.as_slice(), l.as_slice(), change.rate.as_slice(), change.position.as_slice()])
}

/// The largest magnitude.
fn size(x: &DVector<f64>) -> f64 {
    largest(x.iter().copied())
}

/// The columns by names, the last first so that they share lanes with others, and directions on lanes: bit for bit those of
/// the whole.
fn check_columns<S: System<N, M, P>, const N: usize, const M: usize, const P: usize>(
    system: &S,
    state: &State<f64, N>,
    solution: &Solution<f64, N, M>,
    columns: &[Blocks],
) {
    let coordinates = S::COORDINATES.iter().map(|name| name.to_string());
    let velocities = S::COORDINATES.iter().map(|name| Entry::Velocity(name).to_string());
    let parameters = S::PARAMETERS.iter().map(|name| name.to_string());
    let names: Vec<String> = coordinates.chain(velocities).chain(parameters).rev().collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let by = system.jacobian_by(state, &names).expect("a regular state");
    assert_eq!(&by.solution, solution);
    assert!(by.arguments().iter().eq(&names), "{:?}", by.arguments());
    for (column, expected) in columns[1..].iter().rev().enumerate() {
        assert_eq!(by.accelerations.column(column), expected[0]);
        assert_eq!(by.multipliers.column(column), expected[1]);
    }
    let directions = [Direction::of_time(), Direction::of_coordinate(0), Direction::of_velocity(N - 1)];
    let pick = |lane: usize| directions.get(lane).copied().unwrap_or(Direction::zero());
    let lanes =
        |of: &dyn Fn(&Direction<f64, N>) -> f64| Lanes::from(std::array::from_fn(|lane| of(&pick(lane))));
    let wide = Direction {
        t: lanes(&|d| d.t),
        q: SVector::from_fn(|i, _| lanes(&|d| d.q[i])),
        v: SVector::from_fn(|i, _| lanes(&|d| d.v[i])),
    };
    let changes = system.residual_change_with(&system.residual_slopes(state, solution), &wide);
    for lane in 0..Lanes::COUNT {
        let alone = system.residual_change(state, solution, &pick(lane));
        let of_lane = |x: &Lanes| x.to_array()[lane];
        assert!(changes.motion.iter().map(of_lane).eq(alone.motion.iter().copied()), "{}", S::NAME);
        let accelerations = changes.acceleration.iter().map(of_lane);
        assert!(accelerations.eq(alone.acceleration.iter().copied()), "{}", S::NAME);
    }
}

/// Compares all columns; the largest error of a block, relative to its largest entry in any column.
pub(crate) fn check_jacobian<S: System<N, M, P>, const N: usize, const M: usize, const P: usize>(
    system: &mut S,
    state: &State<f64, N>,
) -> f64 {
    let jacobian = system.jacobian(state).expect("a regular state");
    let by_state = system.state_jacobian(state).expect("a regular state").accelerations;
    let PartialDerivatives { t, q, v, .. } = jacobian.accelerations;
    assert_eq!((by_state.t, by_state.q, by_state.v), (t, q, v));
    let columns: Vec<Blocks> = (0..1 + 2 * N + P).map(|k| emitted(system, state, &jacobian, k)).collect();
    check_columns(system, state, &jacobian.solution, &columns);
    let scales: [f64; 4] =
        std::array::from_fn(|block| columns.iter().map(|column| size(&column[block])).fold(1e-3, f64::max));
    let parameters = system.parameters();
    let errors = columns.iter().enumerate().map(|(k, column)| {
        let unit = if k > 2 * N { parameters[k - 1 - 2 * N].abs().max(0.1) } else { 1.0 };
        let errors = STEPS.map(|step| {
            let mut expected = column.each_ref().map(|block| block * 0.0);
            for (times, coefficient) in (1..).zip(DIFFERENCE) {
                let [above, below] =
                    [1, -1].map(|side| shifted(system, state, k, f64::from(side * times) * step * unit));
                for (sum, (above, below)) in expected.iter_mut().zip(above.iter().zip(&below)) {
                    *sum += (above - below) * (coefficient / (step * unit));
                }
            }
            let off = |block: usize| ratio(size(&(&column[block] - &expected[block])), scales[block]);
            largest((0..4).map(off))
        });
        let error = errors[0].min(errors[1]);
        assert!(
            error < TOLERANCE,
            "{}: the derivative by argument {k} is off by {error:e} at {state:?}",
            S::NAME
        );
        error
    });
    largest(errors)
}

#[cfg(feature = "thorough")]
pub(crate) use check_jacobian as check_if_thorough;

#[cfg(not(feature = "thorough"))]
pub(crate) fn check_if_thorough<S, const N: usize>(_: &mut S, _: &State<f64, N>) -> f64 {
    0.0
}
