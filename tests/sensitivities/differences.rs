//! Derivatives of a motion by differences of motions.

use lagrange_core::nalgebra::{Const, DVector};
use lagrange_core::{error::Entry, linearized::DifferentiableMethod, prelude::*};

/// The coefficients of the central difference of eighth order (Fornberg 1988).
const DIFFERENCE: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Steps of the differences, as parts of what is changed: where a motion changes fast with it, only the short one is right.
pub(crate) const STEPS: [f64; 2] = [1e-2, 2e-3];

/// The largest error of a column, as a part of its largest entry.
pub(crate) const TOLERANCE: f64 = 1e-9;

/// The derivative of what there is after a change, by central differences of this step.
pub(crate) fn difference(step: f64, of: impl Fn(f64) -> DVector<f64>) -> DVector<f64> {
    let parts = (1..).zip(DIFFERENCE).map(|(k, coefficient)| {
        let change = f64::from(k) * step;
        (of(change) - of(-change)) * (coefficient / step)
    });
    parts.reduce(|sum, part| sum + part).unwrap()
}

/// The states at these times where an argument is changed, the start as near as the constraints allow.
fn states<S, D, const N: usize>(
    system: &S,
    start: &State<f64, N>,
    times: &[f64],
    method: D,
    argument: usize,
    change: f64,
) -> DVector<f64>
where
    S: Linearized<N = Const<N>, Scalar = f64> + Clone,
    D: DifferentiableMethod<S> + Copy,
{
    let (mut system, mut start) = (system.clone(), *start);
    match argument {
        i if i < N => start.q[i] += change,
        i if i < 2 * N => start.v[i - N] += change,
        i => {
            let k = i - 2 * N;
            assert!(system.set_parameter(k, system.parameters()[k] + change));
        }
    }
    let start = system.make_consistent(&start).unwrap().0;
    let path = system.integrate(start, *times.last().unwrap(), method).unwrap();
    let states = times.iter().flat_map(|t| {
        let state = *path.at(*t).unwrap().state();
        state.q.iter().chain(&state.v).copied().collect::<Vec<f64>>()
    });
    DVector::from_iterator(2 * N * times.len(), states)
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
    let (exact, found) = (exact.end().unwrap(), found.end().unwrap());
    for (j, name) in names.iter().enumerate() {
        let off = (found.q.column(j) - exact.q.column(j)).amax();
        let off = off.max((found.v.column(j) - exact.v.column(j)).amax());
        let size = exact.q.column(j).amax().max(exact.v.column(j).amax()).max(1e-3);
        assert!(off < 1e-10 * size, "{} by {name}, by Radau: off by {off:e} of {size:e}", S::NAME);
    }
}

/// Names of all entries of the state, and of all parameters.
pub(crate) fn names<S: Linearized>() -> Vec<String> {
    let mut names: Vec<String> = S::COORDINATES.iter().copied().map(String::from).collect();
    names.extend(S::COORDINATES.iter().map(|name| Entry::Velocity(name).to_string()));
    names.extend(S::PARAMETERS.iter().copied().map(String::from));
    names
}

/// Compares the derivatives by everything at two times within and at the end; gives the largest error.
pub(crate) fn check<S, D, const N: usize>(system: &S, start: State<f64, N>, end: f64, method: D) -> f64
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
    let (with, alone) = (*motion.trajectory().end().state(), *alone.end().state());
    let apart = (with.q - alone.q).norm() + (with.v - alone.v).norm();
    assert!(
        apart < TOLERANCE * (alone.q.norm() + alone.v.norm()),
        "the same motion, by other steps: {with:?}, {alone:?}"
    );
    let times = [0.31, 0.8, 1.0].map(|part| start.t + part * (end - start.t));
    let found = times.map(|t| motion.at(t).unwrap());
    let mut worst = 0.0_f64;
    for (argument, name) in names.iter().enumerate() {
        let size = match argument {
            i if i < 2 * N => 1.0,
            i => system.parameters()[i - 2 * N].abs().max(0.1),
        };
        let column = found.iter().flat_map(|at| {
            at.q.column(argument).iter().chain(&at.v.column(argument)).copied().collect::<Vec<f64>>()
        });
        let column = DVector::from_iterator(2 * N * times.len(), column);
        let errors = STEPS.map(|step| {
            let shifted = |by| states(system, &start, &times, method, argument, by);
            let expected = difference(step * size, shifted);
            (&column - &expected).amax() / expected.amax().max(1e-3)
        });
        let error = errors[0].min(errors[1]);
        assert!(error < TOLERANCE, "{} by {name}: off by {error:e}", S::NAME);
        worst = worst.max(error);
    }
    for at in &found {
        check_tangent(system, at, &names);
    }
    println!("{}: {worst:.1e}", S::NAME);
    worst
}

/// δΦ = 0 and δ(F q̇ + b) = 0, along the derivatives by the start.
fn check_tangent<S, const N: usize>(
    system: &S,
    at: &lagrange_core::linearized::StateSensitivity<f64, Const<N>>,
    names: &[&str],
) where
    S: Linearized<N = Const<N>, Scalar = f64>,
{
    let solution = system.solve(&at.state).unwrap();
    for (j, name) in names.iter().enumerate().take(2 * N) {
        let direction = lagrange_core::Direction {
            t: 0.0,
            q: at.q.column(j).fixed_rows::<N>(0).into(),
            v: at.v.column(j).fixed_rows::<N>(0).into(),
        };
        let change = system.residual_change(&at.state, &solution, &direction);
        let size = direction.q.amax().max(direction.v.amax()).max(1.0);
        let off = change.position.amax().max(change.rate.amax());
        assert!(
            S::CONSTRAINTS.is_empty() || off < 1e-12 * size,
            "{} leaves the constraints by {name}: {off:e}",
            S::NAME
        );
    }
}
