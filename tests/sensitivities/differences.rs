//! Derivatives of a motion by differences of motions.

use lagrange_core::linearized::{DifferentiableMethod, StateSensitivity};
use lagrange_core::nalgebra::{Const, DMatrix, DVector};
use lagrange_core::{Direction, error::Entry, prelude::*};
use lagrange_random::cases;

/// Coefficients of the central difference of eighth order (Fornberg 1988).
const DIFFERENCE: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Steps of the differences, as parts of what is changed: where a motion changes fast with it, only the short one is right.
const STEPS: [f64; 2] = [1e-2, 2e-3];

/// Largest error of a column, as a part of its largest entry.
const TOLERANCE: f64 = 1e-9;

/// Returns the derivative of a function by central differences of this step.
pub(crate) fn difference(step: f64, of: impl Fn(f64) -> DVector<f64>) -> DVector<f64> {
    let parts = (1..).zip(DIFFERENCE).map(|(k, coefficient)| {
        let change = f64::from(k) * step;
        (of(change) - of(-change)) * (coefficient / step)
    });
    parts.reduce(|sum, part| sum + part).unwrap()
}

/// Compares a derivative with differences whose steps are parts of `size`. One of them must be right.
fn compare(what: &str, found: &DVector<f64>, size: f64, of: impl Fn(f64) -> DVector<f64>) {
    let errors = STEPS.iter().map(|step| {
        let expected = difference(step * size, &of);
        (found - &expected).amax() / expected.amax().max(1e-3)
    });
    let mut least = f64::INFINITY;
    for error in errors {
        least = least.min(error);
        if least < TOLERANCE {
            break;
        }
    }
    println!("{what}: {least:.1e}");
    assert!(least < TOLERANCE, "{what}: off by {least:e}");
}

/// Compares the columns of a matrix with differences by each argument, at the level `test` every third of them.
pub(crate) fn compare_columns(what: &str, found: &DMatrix<f64>, of: impl Fn(usize, f64) -> DVector<f64>) {
    for (j, column) in found.column_iter().enumerate().step_by(cases([3, 1, 1])) {
        compare(&format!("{what}, by argument {j}"), &column.into(), 1.0, |change| of(j, change));
    }
}

/// Coordinates and velocities, one below the other.
pub(crate) fn flat<const N: usize>(state: &State<f64, N>) -> DVector<f64> {
    DVector::from_iterator(2 * N, state.q.iter().chain(&state.v).copied())
}

/// Derivatives of [`flat`] by each argument.
pub(crate) fn flow<const N: usize>(at: &StateSensitivity<f64, Const<N>>) -> DMatrix<f64> {
    DMatrix::from_fn(2 * N, at.q.ncols(), |i, j| if i < N { at.q[(i, j)] } else { at.v[(i - N, j)] })
}

/// Names of all entries of the state, and of all parameters.
pub(crate) fn names<S: Linearized>() -> Vec<String> {
    let mut names: Vec<String> = S::COORDINATES.iter().copied().map(String::from).collect();
    names.extend(S::COORDINATES.iter().map(|name| Entry::Velocity(name).to_string()));
    names.extend(S::PARAMETERS.iter().copied().map(String::from));
    names
}

/// Returns system and start after a change of one of the [`names`], the start as near as the constraints allow.
pub(crate) fn changed<S, const N: usize>(
    system: &S,
    start: &State<f64, N>,
    argument: usize,
    by: f64,
) -> Result<(S, State<f64, N>), Error>
where
    S: Linearized<N = Const<N>, Scalar = f64> + Clone,
{
    let (mut system, mut start) = (system.clone(), *start);
    match argument {
        i if i < N => start.q[i] += by,
        i if i < 2 * N => start.v[i - N] += by,
        i => assert!(system.set_parameter(i - 2 * N, system.parameters()[i - 2 * N] + by)),
    }
    let start = system.make_consistent(&start)?.0;
    Ok((system, start))
}

/// [`check`]s the derivatives by pairs and by Taylor's method, which give the same, and by Radau at the end: its dense output has
/// fewer digits than its steps.
pub(crate) fn check_each<S, const N: usize>(system: &S, start: State<f64, N>, end: f64)
where
    S: Linearized<N = Const<N>, Scalar = f64> + Clone,
    Taylor: DifferentiableMethod<S>,
{
    check(system, start, end, crate::method());
    check(system, start, end, Taylor::default());
    let start = system.make_consistent(&start).unwrap().0;
    let (names, radau) = (names::<S>(), Radau::with_tolerance(1e-13).stages::<7>());
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let exact = system.integrate_sensitivities(start, end, Taylor::default(), &names).unwrap();
    let found = system.integrate_sensitivities(start, end, radau, &names).unwrap();
    let [exact, found] = [exact, found].map(|motion| flow(motion.derivatives_at_end().unwrap()));
    for (j, name) in names.iter().enumerate() {
        let (off, size) = ((found.column(j) - exact.column(j)).amax(), exact.column(j).amax().max(1e-3));
        assert!(off < 1e-10 * size, "{} by {name}, by Radau: off by {off:e} of {size:e}", S::NAME);
    }
}

/// Compares the derivatives by everything with differences at two times within and at the end.
pub(crate) fn check<S, D, const N: usize>(system: &S, start: State<f64, N>, end: f64, method: D)
where
    S: Linearized<N = Const<N>, Scalar = f64> + Clone,
    D: DifferentiableMethod<S> + Copy,
{
    let start = system.make_consistent(&start).unwrap().0;
    let names = names::<S>();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let motion = system.integrate_sensitivities(start, end, method, &names).unwrap();
    assert!(motion.arguments().iter().map(Entry::to_string).eq(names.iter().copied()));
    let alone = system.integrate(start, end, method).unwrap();
    let (with, alone) = (flat(motion.end().state()), flat(alone.end().state()));
    assert!((&with - &alone).norm() < TOLERANCE * alone.norm(), "by other steps: {with} for {alone}");
    let times = [0.31, 0.8, 1.0].map(|part| start.t + part * (end - start.t));
    let found = times.map(|t| motion.derivatives_at(t).unwrap());
    let joined = |parts: [DVector<f64>; 3]| DVector::from_iterator(6 * N, parts.iter().flatten().copied());
    for (argument, name) in names.iter().enumerate().step_by(cases([3, 1, 1])) {
        let column = joined(found.each_ref().map(|at| flow(at).column(argument).into()));
        let size = match argument {
            i if i < 2 * N => 1.0,
            i => system.parameters()[i - 2 * N].abs().max(0.1),
        };
        compare(&format!("{} by {name}", S::NAME), &column, size, |by| {
            let (system, start) = changed(system, &start, argument, by).unwrap();
            let path = system.integrate(start, end, method).unwrap();
            joined(times.map(|t| flat(path.at(t).unwrap().state())))
        });
    }
    for at in &found {
        check_tangent(system, at, &names);
    }
}

/// δΦ = 0 and δ(F q̇ + b) = 0, along the derivatives by the start.
fn check_tangent<S, const N: usize>(system: &S, at: &StateSensitivity<f64, Const<N>>, names: &[&str])
where
    S: Linearized<N = Const<N>, Scalar = f64>,
{
    let solution = system.solve(&at.state).unwrap();
    for (j, name) in names.iter().enumerate().take(2 * N) {
        let [q, v] = [&at.q, &at.v].map(|rows| rows.column(j).fixed_rows::<N>(0).into());
        let direction = Direction { t: 0.0, q, v };
        let change = system.residual_change(&at.state, &solution, &direction);
        let size = direction.q.amax().max(direction.v.amax()).max(1.0);
        let off = change.position.amax().max(change.rate.amax());
        let is_tangent = S::CONSTRAINTS.is_empty() || off < 1e-12 * size;
        assert!(is_tangent, "{} leaves the constraints by {name}: {off:e}", S::NAME);
    }
}
