//! Jacobians of accelerations, multipliers and constraints against differences of them.

use lagrange_core::nalgebra::{Const, DVector, SVector};
use lagrange_core::{
    Direction, Jacobian, Lanes, Solution, error::Entry, linearized::PartialDerivatives, prelude::*,
};

/// Largest deviation, as a fraction of the largest entry of the Jacobian.
const TOLERANCE: f64 = 1e-9;

/// Steps of the differences, as parts of the arguments' sizes; near a pole only the short one is right.
const STEPS: [f64; 2] = [2e-3, 5e-5];

/// The coefficients of the central difference of eighth order (Fornberg 1988).
const DIFFERENCE: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// What the equations depend on.
#[derive(Clone, Copy, Debug)]
enum Argument {
    Time,
    Coordinate(usize),
    Velocity(usize),
    Parameter(usize),
}

/// q̈, λ, F q̇ + b and Φ, or how they change.
type Blocks = [DVector<f64>; 4];

fn values<S, const N: usize, const M: usize>(system: &S, state: &State<f64, N>) -> Blocks
where
    S: Linearized<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    let Solution { accelerations, multipliers, .. } = system.solve(state).expect("a regular state");
    let (rate, position) = (system.constraint_rate(state), system.constraint_residual(state));
    [dynamic(&accelerations), dynamic(&multipliers), dynamic(&rate), dynamic(&position)]
}

fn dynamic<const K: usize>(x: &SVector<f64, K>) -> DVector<f64> {
    DVector::from_column_slice(x.as_slice())
}

/// The values with one argument changed by `change`.
fn shifted<S, const N: usize, const M: usize, const P: usize>(
    system: &mut S,
    state: &State<f64, N>,
    argument: Argument,
    change: f64,
) -> Blocks
where
    S: Linearized<N = Const<N>, M = Const<M>, P = Const<P>, Scalar = f64>,
{
    let mut state = *state;
    match argument {
        Argument::Time => state.t += change,
        Argument::Coordinate(i) => state.q[i] += change,
        Argument::Velocity(i) => state.v[i] += change,
        Argument::Parameter(k) => {
            let value = system.parameters()[k];
            assert!(system.set_parameter(k, value + change), "{}", S::PARAMETERS[k]);
            let values = values(system, &state);
            system.set_parameter(k, value);
            return values;
        }
    }
    values(system, &state)
}

fn difference<S, const N: usize, const M: usize, const P: usize>(
    system: &mut S,
    state: &State<f64, N>,
    argument: Argument,
    step: f64,
) -> Blocks
where
    S: Linearized<N = Const<N>, M = Const<M>, P = Const<P>, Scalar = f64>,
{
    let mut sum = values(system, state).map(|block| block * 0.0);
    for (k, coefficient) in (1..).zip(DIFFERENCE) {
        let above = shifted(system, state, argument, f64::from(k) * step);
        let below = shifted(system, state, argument, f64::from(-k) * step);
        for (sum, (above, below)) in sum.iter_mut().zip(above.iter().zip(&below)) {
            *sum += (above - below) * (coefficient / step);
        }
    }
    sum
}

/// The same by the formulas that are emitted.
fn emitted<S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    state: &State<f64, N>,
    jacobian: &Jacobian<f64, Const<N>, Const<M>, Const<P>>,
    argument: Argument,
) -> Blocks
where
    S: Linearized<N = Const<N>, M = Const<M>, P = Const<P>, Scalar = f64>,
{
    let Jacobian { solution, accelerations: a, multipliers: l } = jacobian;
    let along = |direction: Direction<f64, N>| system.residual_change(state, solution, &direction);
    let (change, a, l) = match argument {
        Argument::Time => (along(Direction::of_time()), a.t, l.t),
        Argument::Coordinate(i) => {
            (along(Direction::of_coordinate(i)), a.q.column(i).into(), l.q.column(i).into())
        }
        Argument::Velocity(i) => {
            (along(Direction::of_velocity(i)), a.v.column(i).into(), l.v.column(i).into())
        }
        Argument::Parameter(k) => {
            let (a, l) = (a.parameters.column(k).into(), l.parameters.column(k).into());
            let mut rates = SVector::from([0.0; P]);
            rates[k] = 1.0;
            (system.residual_change_by_parameters(state, solution, &rates), a, l)
        }
    };
    [dynamic(&a), dynamic(&l), dynamic(&change.rate), dynamic(&change.position)]
}

/// The columns by names, the last first so that they share lanes with others, and four directions at once: bit for bit those
/// of the whole.
fn check_columns<S, const N: usize, const M: usize, const P: usize>(
    system: &S,
    state: &State<f64, N>,
    jacobian: &Jacobian<f64, Const<N>, Const<M>, Const<P>>,
) where
    S: Linearized<N = Const<N>, M = Const<M>, P = Const<P>, Scalar = f64>,
{
    let mut names: Vec<String> = S::COORDINATES.iter().copied().map(String::from).collect();
    names.extend(S::COORDINATES.iter().map(|name| Entry::Velocity(name).to_string()));
    names.extend(S::PARAMETERS.iter().copied().map(String::from));
    names.reverse();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let by = system.jacobian_by(state, &names).expect("a regular state");
    assert_eq!(by.solution, jacobian.solution);
    assert!(by.arguments().iter().eq(&names), "{:?}", by.arguments());
    let Jacobian { accelerations: a, multipliers: l, .. } = jacobian;
    for (column, k) in (0..names.len()).rev().enumerate() {
        let (q2, lambda) = match k {
            k if k < N => (a.q.column(k), l.q.column(k)),
            k if k < 2 * N => (a.v.column(k - N), l.v.column(k - N)),
            k => (a.parameters.column(k - 2 * N), l.parameters.column(k - 2 * N)),
        };
        assert_eq!(
            (by.accelerations.column(column), by.multipliers.column(column)),
            (q2.as_view(), lambda.as_view())
        );
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
    let changes = system.residual_change_with(&system.residual_slopes(state, &jacobian.solution), &wide);
    for lane in 0..Lanes::COUNT {
        let alone = system.residual_change(state, &jacobian.solution, &pick(lane));
        let of_lane = |x: &Lanes| x.to_array()[lane];
        assert!(changes.motion.iter().map(of_lane).eq(alone.motion.iter().copied()), "{}", S::NAME);
        assert!(
            changes.acceleration.iter().map(of_lane).eq(alone.acceleration.iter().copied()),
            "{}",
            S::NAME
        );
    }
}

/// Compares all columns; the largest error of a block, relative to its largest entry in any column.
pub(crate) fn check_jacobian<S, const N: usize, const M: usize, const P: usize>(
    system: &mut S,
    state: &State<f64, N>,
) -> f64
where
    S: Linearized<N = Const<N>, M = Const<M>, P = Const<P>, Scalar = f64>,
{
    let jacobian = system.jacobian(state).expect("a regular state");
    let by_state = system.state_jacobian(state).expect("a regular state").accelerations;
    let PartialDerivatives { t, q, v, .. } = jacobian.accelerations;
    assert_eq!((by_state.t, by_state.q, by_state.v), (t, q, v));
    check_columns(system, state, &jacobian);
    let arguments: Vec<Argument> = [Argument::Time]
        .into_iter()
        .chain((0..N).map(Argument::Coordinate))
        .chain((0..N).map(Argument::Velocity))
        .chain((0..P).map(Argument::Parameter))
        .collect();
    let columns: Vec<Blocks> =
        arguments.iter().map(|&argument| emitted(system, state, &jacobian, argument)).collect();
    let scale = |block: usize| columns.iter().map(|column| size(&column[block])).fold(1e-3, f64::max);
    let scales: [f64; 4] = std::array::from_fn(scale);
    let mut worst = 0.0_f64;
    for (&argument, column) in arguments.iter().zip(&columns) {
        let unit = match argument {
            Argument::Parameter(k) => system.parameters()[k].abs().max(0.1),
            _ => 1.0,
        };
        let errors = STEPS.map(|step| {
            let expected = difference(system, state, argument, step * unit);
            largest((0..4).map(|block| size(&(&column[block] - &expected[block])) / scales[block]))
        });
        let error = errors[0].min(errors[1]);
        assert!(error < TOLERANCE, "{}: ∂/∂{argument:?} is off by {error:e} at {state:?}", S::NAME);
        worst = worst.max(error);
    }
    worst
}

/// The largest magnitude; zero of nothing.
fn size(x: &DVector<f64>) -> f64 {
    largest(x.iter().map(|x| x.abs()))
}

/// NaN if there is one.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |x, y| if y > x || y.is_nan() { y } else { x })
}
