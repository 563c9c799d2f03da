use crate::names::Row;
use nalgebra::{Const, SMatrix};

use super::*;
use crate::Solution;
use crate::fixtures::{At, Mechanism, identity, rolling_sphere, spherical_pendulum};
use crate::generated::vector;
use crate::prelude::*;

fn general<const N: usize, const M: usize, const H: usize>(
    system: &Mechanism<N, M, H>,
    state: &At<N>,
) -> Result<Solution<f64, N, M>, Fault<f64, Const<N>>> {
    let equations = KktSystem {
        m: (system.mass)(state).into(),
        h: (system.forcing)(state).into(),
        f: (system.jacobian)(state).into(),
        gamma: (system.bias)(state).into(),
    };
    solve(&equations, Rank::on_constraints()).map(|(solution, _)| solution)
}

/// Norm of the residual of the equations of motion.
fn defect<const N: usize, const M: usize, const H: usize>(
    system: &Mechanism<N, M, H>,
    state: &At<N>,
    s: &Solution<f64, N, M>,
) -> f64 {
    let force = system.constraint_force(state, &s.multipliers);
    let motion = system.mass_matrix(state) * s.accelerations - force - system.forcing(state);
    let constraints = system.constraint_jacobian(state) * s.accelerations + system.constraint_bias(state);
    motion.norm().max(constraints.norm())
}

fn solves<const N: usize, const M: usize, const H: usize>(
    system: &Mechanism<N, M, H>,
    state: &At<N>,
) -> Solution<f64, N, M> {
    let solution = system.solve(state).unwrap();
    let defect = defect(system, state, &solution);
    assert!(defect < 1e-12, "defect {defect:e} of {solution:?}");
    solution
}

#[test]
fn it_agrees_with_the_elimination_where_both_apply() {
    let sphere = rolling_sphere();
    let state = State::new([0.3, 3.0], [0.2, 2.0]);
    let (a, b) = (general(&sphere, &state).unwrap(), sphere.accelerations_unchecked(&state));
    assert!((a.accelerations - b.accelerations).norm() < 1e-12, "{a:?} {b:?}");
    assert!((a.multipliers - b.multipliers).norm() < 1e-14);
    assert_eq!(a.rank, 1);

    let pendulum = spherical_pendulum();
    let state = State::new([0.6, 0.0, -0.8], [0.4, 1.0, 0.3]);
    let (a, b) = (general(&pendulum, &state).unwrap(), pendulum.accelerations_unchecked(&state));
    assert!((a.accelerations - b.accelerations).norm() < 1e-14);
    assert!((a.multipliers - b.multipliers).norm() < 1e-14);
}

#[test]
fn a_massless_coordinate_follows_its_constraint() {
    // x has mass 3 and a force of 6; the massless y is 10⁻⁹ x: ẍ = 2.
    let system = Mechanism::<2, 1, 1> {
        mass: |_| [[3.0, 0.0], [0.0, 0.0]],
        forcing: |_| [6.0, 0.0],
        residual: |s| [s.q[1] - 1e-9 * s.q[0]],
        rate: |s| [s.v[1] - 1e-9 * s.v[0]],
        jacobian: |_| [[-1e-9, 1.0]],
        bias: |_| [0.0],
    };
    let s = solves(&system, &State::at_rest([0.0, 0.0]));
    assert!((s.accelerations[0] - 2.0).abs() < 1e-15 && (s.accelerations[1] - 2e-9).abs() < 1e-24);
    // The same with a large massless coordinate: x = 10⁻⁹ y.
    let system = Mechanism { jacobian: |_| [[1.0, -1e-9]], ..system };
    let s = solves(&system, &State::at_rest([0.0, 0.0]));
    assert!((s.accelerations[0] - 2.0).abs() < 1e-15 && (s.accelerations[1] / 2e9 - 1.0).abs() < 1e-15);
}

/// A rigid body of inertia (1, 2, 3) with a unit quaternion: M = 4 Gᵀ J G has rank 3, and its null vector is
/// the normal of the constraint.
fn quaternion() -> Mechanism<4, 1, 1> {
    fn rate(q: &At<4>) -> SMatrix<f64, 3, 4> {
        let [w, x, y, z]: [f64; 4] = q.q.into();
        SMatrix::<f64, 4, 3>::from([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]]).transpose()
    }
    fn mass(s: &At<4>) -> [[f64; 4]; 4] {
        let g = rate(s);
        let inertia = SMatrix::<f64, 3, 3>::from_diagonal(&[1.0, 2.0, 3.0].into());
        (g.transpose() * inertia * g * 4.0).into()
    }
    Mechanism {
        mass,
        forcing: |s| {
            // Torque about the third axis of the body, as a generalized force 2 Gᵀ τ, without a component along
            // q.
            let torque = rate(s).transpose() * vector([0.0, 0.0, 1.5]) * 2.0;
            torque.into()
        },
        residual: |s| [0.5 * (s.q.norm_squared() - 1.0)],
        rate: |s| [s.q.dot(&s.v)],
        jacobian: |s| [s.q.into()],
        bias: |s| [s.v.norm_squared()],
    }
}

#[test]
fn a_quaternion_has_a_singular_mass_matrix_and_a_definite_motion() {
    for q in [[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, -0.5, 0.5], [0.6, 0.0, 0.0, 0.8]] {
        let state = State::at_rest(q);
        let s = solves(&quaternion(), &state);
        let (w, z) = (q[0], q[3]);
        // ω̇ = 2 G q̈ = τ/J about the third axis.
        let spin = 2.0 * (-z * s.accelerations[0] + w * s.accelerations[3])
            + 2.0 * (q[2] * s.accelerations[1] - q[1] * s.accelerations[2]);
        assert!((spin - 0.5).abs() < 1e-14, "{spin}");
        assert!(s.multipliers[0].abs() < 1e-14);
    }
}

#[test]
fn the_negative_lagrangian_has_the_same_motion() {
    let system = Mechanism {
        mass: |_| [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]],
        forcing: |_| [0.0, 0.0, 9.81],
        ..spherical_pendulum()
    };
    let state = State::new([0.6, 0.0, -0.8], [0.0, 1.0, 0.0]);
    let (a, b) = (general(&system, &state).unwrap(), spherical_pendulum().accelerations_unchecked(&state));
    assert!((a.accelerations - b.accelerations).norm() < 1e-14);
    assert!((a.multipliers + b.multipliers).norm() < 1e-14);
    solves(&system, &state);
}

#[test]
fn a_mass_matrix_without_a_diagonal_is_solved_by_pairs() {
    // L = ẋẏ + żẇ/10⁶ − …: the diagonal of M vanishes, so no 1×1 pivot exists.
    let mass = |_: &At<4>| {
        [[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1e-6], [0.0, 0.0, 1e-6, 0.0]]
    };
    let none = crate::fixtures::free::<4>(|_| [1.0, 2.0, 3.0e-6, 4.0e-6]);
    let s = solves(&Mechanism { mass, ..none }, &State::at_rest([0.0; 4]));
    for (x, expected) in s.accelerations.iter().zip([2.0, 1.0, 4.0, 3.0]) {
        assert!((x - expected).abs() < 1e-14, "{x}");
    }
}

#[test]
fn repeated_constraints_give_the_motion_and_the_least_multipliers() {
    // c1 = 2 c0 and c2 = 0 · c0: λ₀ + 2 λ₁ equals the multiplier of c0 alone. In units of the rows the norm is least for
    // λ₀ = 2 λ₁ and λ₂ = 0.
    let system = Mechanism::<3, 3, 3> {
        mass: identity,
        forcing: |_| [0.0, 0.0, -9.81],
        residual: |s| [1.0, 2.0, 0.0].map(|k| k * 0.5 * (s.q.norm_squared() - 1.0)),
        rate: |s| [1.0, 2.0, 0.0].map(|k| k * s.q.dot(&s.v)),
        jacobian: |s| [1.0, 2.0, 0.0].map(|k| (s.q * k).into()),
        bias: |s| [1.0, 2.0, 0.0].map(|k| k * s.v.norm_squared()),
    };
    let state = State::new([0.6, 0.0, -0.8], [0.0, 1.0, 0.0]);
    let (s, alone) = (solves(&system, &state), spherical_pendulum().accelerations_unchecked(&state));
    assert!((s.accelerations - alone.accelerations).norm() < 1e-14);
    let lambda = alone.multipliers[0] / 4.0;
    assert!((s.multipliers - SMatrix::from([[2.0 * lambda, lambda, 0.0]])).norm() < 1e-14, "{s:?}");
    assert!(s.rank == 1 && !s.multipliers_are_unique());

    let start = State::new([0.6, 0.0, -0.8], [0.0, 1.0, 0.0]);
    let path = system.integrate(start, 1.0, Dop853::default()).unwrap();
    let pendulum = spherical_pendulum();
    let single = pendulum.integrate(start, 1.0, Dop853::default()).unwrap();
    assert!(path.ending().is_complete() && !path.multipliers_are_unique());
    assert!((path.end().state().q - single.end().state().q).norm() < 1e-9);
}

#[test]
fn contradictory_constraints_are_named() {
    let system = Mechanism::<2, 2, 0> {
        mass: identity,
        forcing: |_| [1.0, 0.0],
        residual: |_| [0.0; 2],
        rate: |s| [s.v[0] - s.t, s.v[0] - 2.0 * s.t],
        jacobian: |_| [[1.0, 0.0], [1.0, 0.0]],
        bias: |_| [-1.0, -2.0],
    };
    let error = system.solve(&State::at_rest([0.0, 0.0])).unwrap_err();
    assert_eq!(error, Error::Contradictory { constraint: "c1", time: 0.0 });
    let error = system.integrate(State::at_rest([0.0, 0.0]), 1.0, Dop853::default()).unwrap_err();
    assert!(std::format!("{error}").contains("constraint `c1` contradicts the others at t = 0"), "{error}");
}

#[test]
fn a_constraint_without_a_gradient_is_named() {
    // ½ x² = 0 at x = 0: the row of F is zero, but ẋ² is not.
    let system = Mechanism::<1, 1, 1> {
        mass: identity,
        forcing: |_| [0.0],
        residual: |s| [0.5 * s.q[0] * s.q[0]],
        rate: |s| [s.q[0] * s.v[0]],
        jacobian: |s| [[s.q[0]]],
        bias: |s| [s.v[0] * s.v[0]],
    };
    let error = system.solve(&State::new([0.0], [1.0])).unwrap_err();
    assert_eq!(error, Error::Contradictory { constraint: "c0", time: 0.0 });
    let error = system.solve(&State::at_rest([0.0])).unwrap_err();
    assert_eq!(error, Error::NoGradient { constraint: Row::Constraint("c0"), time: 0.0 });
}

#[test]
fn coordinates_that_nothing_determines_are_named() {
    // L = ½(ẋ + ẏ)² + ½ z²: x − y and z are undetermined.
    let system = crate::fixtures::free::<3>(|s| [0.0, 0.0, s.q[2]]);
    let mass = |_: &At<3>| [[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0; 3]];
    let error = Mechanism { mass, ..system }.solve(&State::at_rest([0.0; 3])).unwrap_err();
    assert!(std::format!("{error}").contains("`x`, `y`, `z` at t = 0"), "{error}");
    let mass = |_: &At<3>| [[1.0, 0.0, 0.0], [0.0, 1e9, 1e6], [0.0, 1e6, 1e3]];
    let Err(Error::Singular { coordinates, .. }) =
        (Mechanism { mass, ..system }).solve(&State::at_rest([0.0; 3]))
    else {
        panic!("solved a singular system");
    };
    assert_eq!(coordinates.as_slice(), ["y", "z"]);
}

#[test]
fn equations_that_are_not_finite_are_named() {
    let system = crate::fixtures::free::<2>(|_| [1.0, f64::NAN]);
    let error = system.integrate(State::at_rest([0.0; 2]).at_time(2.0), 3.0, Dopri5::default()).unwrap_err();
    assert_eq!(error, Error::EquationsNotFinite { row: crate::error::Row::Coordinate("y"), time: 2.0 });
    let system = Mechanism { bias: |_| [f64::INFINITY], ..spherical_pendulum() };
    let error = system.solve(&State::at_rest([1.0, 0.0, 0.0])).unwrap_err();
    assert_eq!(error, Error::EquationsNotFinite { row: crate::error::Row::Constraint("c0"), time: 0.0 });
}

#[test]
fn single_precision_is_solved_too() {
    let equations = KktSystem::<f32, Const<2>, Const<2>> {
        m: [[2.0, 0.0], [0.0, 0.0]].into(),
        h: [4.0, 0.0].into(),
        f: [[3.0, -3.0], [1.0, -1.0]].into(),
        gamma: [0.0; 2].into(),
    };
    let (s, _) = solve(&equations, Rank::on_constraints()).unwrap();
    assert!((s.accelerations - vector([2.0, 2.0])).norm() < 1e-6, "{s:?}");
    assert_eq!(s.rank, 1);
}

/// Two dependent rows x + y and 2x + 2y, and an independent row z, with different masses.
fn dependent() -> Factors<f64, Const<3>, Const<3>> {
    let m = [[4.0, 1.0, 0.0], [1.0, 9.0, 0.5], [0.0, 0.5, 0.01]];
    let f = [[1.0, 1.0, 0.0], [2.0, 2.0, 0.0], [0.0, 0.0, 1.0]];
    Factors::of(&m.into(), &f.into(), Rank::off_constraints())
}

#[test]
fn one_factorization_serves_all_right_hand_sides() {
    let factors = dependent();
    for (h, gamma) in [([1.0, 0.0, 0.0], [0.0; 3]), ([0.0, 2.0, -3.0], [1.0, 2.0, -0.5])] {
        let s = factors.solve(&h.into(), &gamma.into()).unwrap();
        let [x, y, z]: [f64; 3] = s.accelerations.into();
        // x + y = −γ₀ and z = −γ₂; the difference of the first two rows of M q̈ = h + Fᵀλ does not contain λ.
        assert!((x + y + gamma[0]).abs() < 1e-15 && (z + gamma[2]).abs() < 1e-15, "{s:?}");
        assert!((4.0 * x + y - (x + 9.0 * y + 0.5 * z) - (h[0] - h[1])).abs() < 1e-14, "{s:?}");
        // The second row is twice the first, and carries as much of the force.
        assert!((2.0 * s.multipliers[1] - s.multipliers[0]).abs() < 1e-14, "not the least: {s:?}");
        assert!((0.5 * y + 0.01 * z - h[2] - s.multipliers[2]).abs() < 1e-14, "{s:?}");
    }
}

#[test]
fn rows_leave_a_null_space_and_fix_the_rest() {
    let rows = dependent().rows;
    let free: Vec<_> = rows.null_space().collect();
    assert_eq!(free.len(), 1);
    assert!((free[0][0] + free[0][1]).abs() < 1e-15 && free[0][2].abs() < 1e-15 && free[0][0].abs() > 0.1);
    let x = rows.least(&[3.0, 6.0, -2.0].into());
    assert!((x[0] + x[1] + 3.0).abs() < 1e-15 && (x[2] - 2.0).abs() < 1e-15, "{x}");
    // Least norm in natural units, where masses are 1: x m_x = y m_y for equal rows.
    assert!((4.0 * x[0] - 9.0 * x[1]).abs() < 1e-14, "{x}");
}
