use crate::names::Row;
use nalgebra::Const;

use crate::fixtures::{Mechanism, dependent_on_the_manifold, identity, rolling_sphere, spherical_pendulum};
use crate::prelude::*;
use crate::solution::Adjustment;

#[test]
fn a_state_off_the_sphere_is_put_on_it() {
    let pendulum = spherical_pendulum();
    let state = State::new([1.2, 0.0, -1.6], [0.6, 1.0, 0.8]);
    let (consistent, adjustment) = pendulum.make_consistent(&state).unwrap();
    // The nearest point of the sphere and the tangential part of the velocity.
    assert!((consistent.q - State::at_rest([0.6, 0.0, -0.8]).q).norm() < 1e-15, "{consistent:?}");
    let expected = State::new([0.6, 0.0, -0.8], [0.768, 1.0, 0.576]);
    assert!((consistent.v - expected.v).norm() < 1e-15, "{consistent:?}");
    assert!((adjustment.largest_coordinate_change() - 0.8).abs() < 1e-15);
    assert!((adjustment.largest_velocity_change() - 0.224).abs() < 1e-15);
    assert_eq!(
        pendulum.make_consistent(&consistent).unwrap().1,
        Adjustment { q: [0.0; 3].into(), v: [0.0; 3].into() }
    );
}

#[test]
fn the_projection_is_orthogonal_in_the_metric_of_the_mass_matrix() {
    // Mass 9 along x and 1 along y: from 0, x + y = 2 is reached by a displacement nine times as large in y.
    let system = Mechanism::<2, 1, 1> {
        mass: |_| [[9.0, 0.0], [0.0, 1.0]],
        forcing: |_| [0.0; 2],
        residual: |s| [s.q[0] + s.q[1] - 2.0],
        rate: |s| [s.v[0] + s.v[1]],
        jacobian: |_| [[1.0, 1.0]],
        bias: |_| [0.0],
    };
    let (consistent, _) = system.make_consistent(&State::at_rest([0.0, 0.0])).unwrap();
    assert!((consistent.q - State::at_rest([0.2, 1.8]).q).norm() < 1e-15, "{consistent:?}");
}

/// c0: x² + y² = 1 on the coordinates; c1: ẏ = ẋ + 1 on the velocities; c2: ż = ẋ for the massless z.
fn mixed() -> Mechanism<3, 3, 1> {
    Mechanism {
        mass: |_| [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]],
        forcing: |_| [0.0; 3],
        residual: |s| [0.5 * (s.q[0].powi(2) + s.q[1].powi(2) - 1.0), 0.0, 0.0],
        rate: |s| [s.q[0] * s.v[0] + s.q[1] * s.v[1], s.v[1] - s.v[0] - 1.0, s.v[2] - s.v[0]],
        jacobian: |s| [[s.q[0], s.q[1], 0.0], [-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]],
        bias: |s| [s.v[0].powi(2) + s.v[1].powi(2), 0.0, 0.0],
    }
}

#[test]
fn velocity_constraints_do_not_move_coordinates() {
    let (consistent, _) = mixed().make_consistent(&State::at_rest([1.2, 1.6, 5.0])).unwrap();
    assert!((consistent.q - State::at_rest([0.6, 0.8, 5.0]).q).norm() < 1e-15, "{consistent:?}");
    let rate = mixed().constraint_rate(&consistent);
    assert!(rate.norm() < 1e-15, "{rate}");
    // 0.6 ẋ + 0.8 ẏ = 0 and ẏ − ẋ = 1.
    assert!((consistent.v[0] + 4.0 / 7.0).abs() < 1e-14 && (consistent.v[2] + 4.0 / 7.0).abs() < 1e-14);
}

#[test]
fn constraints_that_cannot_hold_are_named() {
    let system = Mechanism::<1, 1, 1> {
        mass: identity,
        forcing: |_| [0.0],
        residual: |s| [s.q[0].powi(2) + 1.0],
        rate: |s| [2.0 * s.q[0] * s.v[0]],
        jacobian: |s| [[2.0 * s.q[0]]],
        bias: |s| [2.0 * s.v[0].powi(2)],
    };
    let error = system.make_consistent(&State::at_rest([0.3])).unwrap_err();
    assert!(
        matches!(error, Error::NotProjected { constraint: Row::Constraint("c0"), residual, .. } if residual >= 1.0),
        "{error}"
    );
    let error = spherical_pendulum().make_consistent(&State::at_rest([0.0; 3])).unwrap_err();
    assert!(
        matches!(error, Error::NotProjected { constraint: Row::Constraint("c0"), residual: -0.5, .. }),
        "{error}"
    );
}

#[test]
fn newton_gets_there_from_afar() {
    let pendulum = spherical_pendulum();
    for start in [[1e6, 2e5, 3.0], [1e-6, 0.0, 1e-7]] {
        let (state, _) = pendulum.make_consistent(&State::new(start, [1.0, 2.0, 3.0])).unwrap();
        assert!((state.q.norm() - 1.0).abs() < 1e-15, "{state:?}");
    }
}

#[test]
fn a_step_that_leads_away_is_halved() {
    // Newton's method for atan x = 0 diverges from |x| > 1.39.
    let system = Mechanism::<1, 1, 1> {
        mass: identity,
        forcing: |_| [0.0],
        residual: |s| [s.q[0].atan()],
        rate: |s| [s.v[0] / (1.0 + s.q[0].powi(2))],
        jacobian: |s| [[1.0 / (1.0 + s.q[0].powi(2))]],
        bias: |_| [0.0],
    };
    let (state, _) = system.make_consistent(&State::at_rest([20.0])).unwrap();
    assert!(state.q[0].abs() < 1e-12, "{state:?}");
}

#[test]
fn constraints_dependent_only_where_they_hold_leave_the_nearest_state_nearest() {
    let off = State::new([0.6 + 1e-6, -0.8], [0.8, 0.6]);
    let (state, _) = dependent_on_the_manifold().make_consistent(&off).unwrap();
    assert!((state.q - off.q.normalize()).norm() < 1e-11, "{state:?}");
}

#[test]
fn an_inconsistent_start_is_refused_with_its_constraint() {
    let pendulum = spherical_pendulum();
    let off = State::at_rest([0.6, 0.0, -0.81]);
    let error = pendulum.integrate(off, 1.0, Dop853::default()).unwrap_err();
    assert!(
        matches!(error, Error::Inconsistent { constraint: Row::Constraint("c0"), rate: false, .. }),
        "{error}"
    );
    assert!(std::format!("{error}").contains("call `make_consistent`"));
    let off = State::new([0.0, 0.0], [1.0, 9.9]);
    let error = rolling_sphere().integrate(off, 1.0, Dop853::default()).unwrap_err();
    assert!(
        matches!(error, Error::Inconsistent { constraint: Row::Constraint("c0"), rate: true, .. }),
        "{error}"
    );
    let nearly = State::at_rest([0.6, 0.0, -0.8 + 1e-9]);
    let path = pendulum.integrate(nearly, 0.1, Dop853::default()).unwrap();
    let moved = path.adjustment().largest_coordinate_change();
    assert!((0.1e-9..1e-9).contains(&moved), "{moved:e}");
}

#[test]
fn a_residual_that_is_no_number_is_the_farthest() {
    let residual = super::Residual::<f64, Const<1>, Const<3>> {
        value: [1.0, f64::NAN, 5.0].into(),
        jacobian: [[1.0]; 3].into(),
        terms: [1.0; 3].into(),
        sensitivity: [1.0; 3].into(),
    };
    let (distance, row) = residual.farthest();
    assert!(distance.is_nan() && row == 1, "{distance} in row {row}");
}

/// Three coordinates on the plane x + y + z = 3, with a full mass matrix.
fn coupled() -> Mechanism<3, 1, 1> {
    Mechanism {
        mass: |_| [[2.0, 1.0, 0.5], [1.0, 3.0, 1.0], [0.5, 1.0, 4.0]],
        forcing: |_| [0.0; 3],
        residual: |s| [s.q.sum() - 3.0],
        rate: |s| [s.v.sum() - 6.0],
        jacobian: |_| [[1.0; 3]],
        bias: |_| [0.0],
    }
}

/// With x held, δ = (y, z) on y + z = 3 is least in the metric ((3, 1), (1, 4)): δ is proportional to its
/// inverse times (1, 1).
#[test]
fn what_is_held_stays_and_the_rest_is_nearest_in_its_own_metric() {
    let start = State::new([0.0; 3], [1.0, 0.0, 0.0]);
    let (state, moved) = coupled().make_consistent_holding(&start, &["x", "x_dot"]).unwrap();
    assert_eq!((state.q[0], state.v[0]), (0.0, 1.0));
    assert!((state.q - State::at_rest([0.0, 1.8, 1.2]).q).norm() < 1e-15, "{state:?}");
    assert!((state.v - State::at_rest([1.0, 3.0, 2.0]).q).norm() < 1e-14, "{state:?}");
    assert!((moved.largest_coordinate_change() - 1.8).abs() < 1e-15);
    // Two held entries leave one direction.
    let (state, _) = coupled().make_consistent_holding(&start, &["y_dot", "z", "x"]).unwrap();
    assert!((state.q - State::at_rest([0.0, 3.0, 0.0]).q).norm() < 1e-15 && state.v[1] == 0.0, "{state:?}");
    // With nothing held, the result is the nearest state.
    assert_eq!(coupled().make_consistent_holding(&start, &[]), coupled().make_consistent(&start));
}

#[test]
fn what_is_held_stays_in_the_general_solve_too() {
    // Dependent constraints; the velocity is tangential to the circle.
    let start = State::new([0.6, -0.7], [0.4, 0.0]);
    let (state, _) = dependent_on_the_manifold().make_consistent_holding(&start, &["x", "x_dot"]).unwrap();
    assert_eq!((state.q[0], state.v[0]), (0.6, 0.4));
    assert!((state.q[1] + 0.8).abs() < 1e-11 && (state.v[1] - 0.3).abs() < 1e-11, "{state:?}");
    // A coordinate without mass.
    let start = State::new([1.2, 1.6, 5.0], [0.0, 0.0, 0.25]);
    let (state, _) = mixed().make_consistent_holding(&start, &["z"]).unwrap();
    assert!((state.q - State::at_rest([0.6, 0.8, 5.0]).q).norm() < 1e-15, "{state:?}");
    let (state, _) = mixed().make_consistent_holding(&State::at_rest([0.6, 0.7, 5.0]), &["x", "z"]).unwrap();
    assert_eq!((state.q[0], state.q[2]), (0.6, 5.0));
    assert!((state.q[1] - 0.8).abs() < 1e-15, "{state:?}");
}

#[test]
fn too_much_held_is_said_with_the_constraint() {
    let pendulum = spherical_pendulum();
    let off = State::new([0.6, 0.0, -0.9], [1.0, 0.0, 0.5]);
    let hold = |held: &[&str]| pendulum.make_consistent_holding(&off, held).unwrap_err();
    let error = hold(&["z", "x", "y", "y_dot"]);
    assert!(matches!(error, Error::HeldTooMuch { constraint: "c0", rate: false, .. }), "{error}");
    let text = std::format!("{error}");
    assert!(
        text.starts_with("what is held, `x`, `y`, `z`, leaves too little freedom for constraint `c0`"),
        "{text}"
    );
    // Velocities: x ẋ + z ż = 0 does not contain ẏ at y = 0.
    let error = hold(&["x", "x_dot", "z_dot"]);
    assert!(matches!(error, Error::HeldTooMuch { constraint: "c0", rate: true, .. }), "{error}");
    assert!(std::format!("{error}").contains("the velocity of `x`, `z`, leaves"), "{error}");
    // x beyond the sphere, with y and z free to move.
    let beyond = State::at_rest([1.5, 0.1, 0.1]);
    let error = pendulum.make_consistent_holding(&beyond, &["x"]).unwrap_err();
    assert!(
        matches!(error, Error::HeldTooMuch { constraint: "c0", residual, .. } if residual >= 0.625),
        "{error}"
    );
    // If the constraints cannot hold with all entries free, the held entries are not blamed.
    let error = pendulum.make_consistent_holding(&State::at_rest([0.0; 3]), &["x"]).unwrap_err();
    assert!(
        matches!(error, Error::NotProjected { constraint: Row::Constraint("c0"), residual: -0.5, .. }),
        "{error}"
    );
    // All entries may be held if the state is consistent.
    let on = State::new([0.6, 0.0, -0.8], [0.8, 3.0, 0.6]);
    assert_eq!(
        pendulum.make_consistent_holding(&on, &["x", "y", "z", "x_dot", "y_dot", "z_dot"]).unwrap().0,
        on
    );
}

#[test]
fn names_of_what_is_held_are_checked() {
    let hold = |held: &[&str]| rolling_sphere().make_consistent_holding(&State::at_rest([0.0; 2]), held);
    assert_eq!(hold(&["x", "x"]), Err(Error::RepeatedName { name: "x".into() }));
    let error = hold(&["lambda(c0)"]).unwrap_err();
    assert!(std::format!("{error}").contains("it is the multiplier of constraint `c0`"), "{error}");
    let off = State::at_rest([f64::NAN, 0.0]);
    let error = rolling_sphere().make_consistent_holding(&off, &["x"]).unwrap_err();
    assert!(matches!(error, Error::StateNotFinite { .. }), "{error}");
}

/// Two circles whose radii differ by a factor of 10¹², from starts far away.
#[test]
fn a_large_constraint_hides_no_small_one() {
    let system = Mechanism::<4, 2, 2> {
        mass: identity,
        forcing: |_| [0.0; 4],
        residual: |s| [s.q[0].powi(2) + s.q[1].powi(2) - 1e24, s.q[2].powi(2) + s.q[3].powi(2) - 1.0],
        rate: |s| [2.0 * (s.q[0] * s.v[0] + s.q[1] * s.v[1]), 2.0 * (s.q[2] * s.v[2] + s.q[3] * s.v[3])],
        jacobian: |s| [[2.0 * s.q[0], 2.0 * s.q[1], 0.0, 0.0], [0.0, 0.0, 2.0 * s.q[2], 2.0 * s.q[3]]],
        bias: |_| [0.0; 2],
    };
    for (far, near) in [(1.1e12, 3.0), (1.3e12, 1e3), (0.7e12, 1e-3), (1e12, 1e5)] {
        let start = State::at_rest([0.6 * far, 0.8 * far, 0.6 * near, 0.8 * near]);
        let (state, _) = system.make_consistent(&start).unwrap();
        assert!((state.q[2] - 0.6).abs() < 1e-15 && (state.q[3] - 0.8).abs() < 1e-15, "{state:?}");
    }
}
