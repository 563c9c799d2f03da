//! The maps of the methods are symplectic, and their derivatives are those of the map, to round-off.

use lagrange_core::linearized::DifferentiableMethod;
use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::nalgebra::{Const, DMatrix, DVector, SVector};
use lagrange_core::{Lagrangian, prelude::*};

use crate::systems::*;

/// The tangent space of {Φ = 0, Φ̇ = 0} at a state, by an orthonormal basis in columns. The derivatives of both
/// residuals are differences of emitted functions, which are exact enough for polynomials of second degree.
fn tangent_basis<L, const N: usize>(system: &L, state: &State<f64, N>) -> DMatrix<f64>
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    let constraints = system.constraint_residual(state).len();
    let rows = DMatrix::from_fn(2 * N, 2 * N, |row, column| {
        if row >= 2 * constraints {
            return 0.0;
        }
        let at = |by: f64| {
            let mut state = *state;
            if column < N {
                state.q[column] += by;
            } else {
                state.v[column - N] += by;
            }
            match row < constraints {
                true => system.constraint_residual(&state)[row],
                false => system.constraint_rate(&state)[row - constraints],
            }
        };
        (at(0.5) - at(-0.5)) / 1.0
    });
    let decomposition = rows.svd(false, true);
    let (right, values) = (decomposition.v_t.unwrap(), decomposition.singular_values);
    let free: Vec<_> = (0..2 * N).filter(|&k| values[k] < 1e-8).map(|k| right.row(k).transpose()).collect();
    assert_eq!(free.len(), 2 * (N - constraints));
    DMatrix::from_columns(&free)
}

/// δp for a change of (q, q̇), by central differences with Richardson's extrapolation in the coordinates; p is linear in
/// the velocities.
fn momenta_along<L, const N: usize>(
    system: &L,
    state: &State<f64, N>,
    change: &DVector<f64>,
) -> SVector<f64, N>
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    let at = |by: f64| {
        let q = SVector::from_fn(|i, _| state.q[i] + by * change[i]);
        let v = SVector::from_fn(|i, _| state.v[i] + by * change[N + i]);
        system.momentum(&State { t: state.t, q, v })
    };
    let slope = |h: f64| (at(h) - at(-h)) / (2.0 * h);
    // Errors of order h², h⁴ and h⁶ cancel.
    let table = [slope(0.04), slope(0.02), slope(0.01), slope(0.005)];
    let next = |x: &[SVector<f64, N>], factor: f64| -> Vec<SVector<f64, N>> {
        x.windows(2).map(|pair| (pair[1] * factor - pair[0]) / (factor - 1.0)).collect()
    };
    next(&next(&next(&table, 4.0), 16.0), 64.0)[0]
}

/// Asserts that the derivative of the map over the time 1 keeps the symplectic form on the tangent space, to 10⁻¹² of
/// its size.
pub(crate) fn check<L, P, const N: usize>(name: &str, (system, start): &(L, State<f64, N>), method: P)
where
    L: Linearized<N = Const<N>, Scalar = f64>,
    P: DifferentiableMethod<L>,
{
    let velocity = |name: &str| match name.split_once('[') {
        Some((vector, index)) => format!("{vector}_dot[{index}"),
        None => format!("{name}_dot"),
    };
    let names: Vec<String> = (0..2 * N)
        .map(|k| if k < N { L::COORDINATES[k].into() } else { velocity(L::COORDINATES[k - N]) })
        .collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let motion = system.integrate_sensitivities(*start, 1.0, method, &names).unwrap();
    let (end, last) = (motion.derivatives_at_end().unwrap(), *motion.end().state());
    let map = DMatrix::from_fn(2 * N, 2 * N, |i, j| if i < N { end.q[(i, j)] } else { end.v[(i - N, j)] });
    let basis = tangent_basis(system, start);
    let form = |state: &State<f64, N>, x: &DVector<f64>, y: &DVector<f64>| {
        let (p, r) = (momenta_along(system, state, x), momenta_along(system, state, y));
        (0..N).map(|i| x[i] * r[i] - y[i] * p[i]).sum::<f64>()
    };
    let mut worst = 0.0_f64;
    for x in basis.column_iter() {
        for y in basis.column_iter() {
            let (x, y) = (x.into_owned(), y.into_owned());
            let change = form(&last, &(&map * &x), &(&map * &y)) - form(start, &x, &y);
            worst = worst.max(change.abs() / map.norm_squared());
        }
    }
    println!("{name}: {worst:.1e}");
    assert!(worst < 1e-12, "{name}: the symplectic form changes by {worst:e}");
}

#[test]
fn maps_are_symplectic() {
    check("Verlet on Hénon–Heiles", &henon_heiles(), Verlet::with_step(0.05));
    check("order 8 on Hénon–Heiles", &henon_heiles(), Verlet::with_step(0.2).composed(KahanLi8));
    check("RATTLE", &spherical(), Verlet::with_step(0.02));
    check("RATTLE of order 8", &spherical(), Verlet::with_step(0.1).composed(KahanLi8));
    check("RATTLE with two rods", &two_bobs(), Verlet::with_step(0.02));
    check("Gauss 1", &double_pendulum(), Gauss::<1>::with_step(0.02));
    check("Gauss 2", &double_pendulum(), Gauss::<2>::with_step(0.05));
    check("Gauss 3", &charge(), Gauss::<3>::with_step(0.1));
    check("Gauss 4", &double_pendulum(), Gauss::<4>::with_step(0.1));
    check("Lobatto 2", &spherical(), Lobatto::<2>::with_step(0.02));
    check("Lobatto 3", &bowl(), Lobatto::<3>::with_step(0.05));
    check("Lobatto 4", &bowl(), Lobatto::<4>::with_step(0.1));
    check("Lobatto 2 with a unit quaternion", &top(), Lobatto::<2>::with_step(0.01));
    check("Lobatto 4 with a unit quaternion", &top(), Lobatto::<4>::with_step(0.05));
    check("Lobatto 3 with a massless weight", &weight(), Lobatto::<3>::with_step(0.05));
    check("DAlembert on holonomic constraints", &bowl(), DAlembert::with_step(0.02));
}

/// A method that is not symplectic is noticed.
#[test]
#[should_panic(expected = "the symplectic form changes")]
fn a_pair_is_not_symplectic() {
    check("Dop853", &double_pendulum(), Dop853::with_tolerance(1e-6));
}

/// Derivatives by the start and by a parameter, against differences of the same map: at the end, and by dense output.
#[test]
fn derivatives_are_those_of_the_map() {
    let (system, start) = bowl();
    let method = Lobatto::<3>::with_step(0.1);
    let motion = system.integrate_sensitivities(start, 1.0, method, &["omega", "phi_dot"]).unwrap();
    let moved = |by: f64, k: usize, t: f64| {
        let (mut system, mut start) = (system.clone(), start);
        match k {
            0 => assert!(system.set_parameter(0, 0.7 + by)),
            _ => start.v[1] += by,
        }
        let path = system.integrate(start, 1.0, method).unwrap();
        path.at(t).unwrap().state().q[1]
    };
    for (k, argument) in ["omega", "phi_dot"].into_iter().enumerate() {
        for t in [0.33, 0.75, 1.0] {
            let differences = |h: f64| {
                let ends = [h, -h].map(|by| moved(by, k, t));
                (ends[0] - ends[1]) / (2.0 * h)
            };
            let by_differences = (4.0 * differences(5e-4) - differences(1e-3)) / 3.0;
            let off = motion.derivative(t, "phi", argument).unwrap() - by_differences;
            assert!(off.abs() < 1e-9, "phi by {argument} at {t}: {off:e}");
        }
    }
}

/// On ẍ = −x steps of `Verlet` keep v² + (1 − h²/4) x² but for rounding. Over a million steps plain sums change it by 5·10⁻¹⁴,
/// compensated sums by 7·10⁻¹⁶.
#[test]
fn sums_of_small_steps_are_compensated() {
    let h = 1.0 / 256.0;
    let kept = |state: &State<f64, 1>| state.v[0].powi(2) + (1.0 - h * h / 4.0) * state.q[0].powi(2);
    let start = State::new([1.0], [0.5]);
    let spring = lagrange_systems::Spring { m: 1.0, k: 1.0 };
    let mut motion = Motion::new(spring, start, Verlet::with_step(h).max_steps(usize::MAX)).unwrap();
    let mut worst = 0.0_f64;
    for k in 1..=1000 {
        motion.advance_to(1000.0 * h * f64::from(k)).unwrap();
        worst = worst.max((kept(motion.state()) / kept(&start) - 1.0).abs());
    }
    assert_eq!(motion.statistics().accepted, 1_000_000);
    assert!(worst < 3e-15, "{worst:e}");
}
