//! What is wrong is said, with the names at fault.

use lagrange_core::prelude::*;
use lagrange_core::{
    Direction, StateDerivatives,
    error::{Entry, Row},
    number::FourLanes,
};
use lagrange_systems::{DrivenSpring, PolarPendulum};

use crate::PENDULUM;

const HANGING: [f64; 2] = [0.0, -2.0];

pub(crate) fn message<T: std::fmt::Debug>(result: Result<T, Error>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn names_are_checked() {
    let state = State::at_rest(HANGING);
    let message = message(PENDULUM.linearize(&state, &["pusch"]));
    assert_eq!(message, "there is no parameter `pusch`: did you mean `push`?");
    assert_eq!(
        self::message(PENDULUM.linearize(&state, &["colour"])),
        "there is no parameter `colour`: there are `m`, `g`, `l`, `push`; a field is a parameter if an expression of the system names it"
    );
    let error = PENDULUM.linearize(&state, &["push", "push"]).unwrap_err();
    assert_eq!(error, Error::RepeatedName { name: "push".into() });
    let Err(Error::UnknownName { kind, known, .. }) = PENDULUM.equilibrium(&state, &["z"]) else {
        panic!("z is no unknown");
    };
    assert_eq!((kind, known.len()), ("coordinate, velocity or parameter", 8));
}

#[test]
fn a_state_off_the_constraints_has_no_linear_system() {
    let error = PENDULUM.linearize(&State::at_rest([0.0, -1.0]), &[]).unwrap_err();
    assert!(matches!(error, Error::Inconsistent { constraint: Row::Constraint("rod"), .. }), "{error}");
}

#[test]
fn an_input_that_shifts_a_constraint_is_refused() {
    let error = PENDULUM.linearize(&State::at_rest(HANGING), &["push", "l"]).unwrap_err();
    assert_eq!(error, Error::InputShiftsConstraint { input: "l", constraint: "rod" });
}

#[test]
fn what_is_behind_a_reference_cannot_be_sought() {
    let error = PENDULUM.equilibrium(&State::at_rest(HANGING), &["g"]).unwrap_err();
    assert_eq!(error, Error::ParameterFixed { name: "g" });
    let error = PENDULUM.inputs_for(&State::at_rest(HANGING), &[0.0, 0.0].into(), &["g"]).unwrap_err();
    assert_eq!(error, Error::ParameterFixed { name: "g" });
    // It can be differentiated by, though.
    let jacobian = PENDULUM.jacobian(&State::at_rest(HANGING)).unwrap();
    let by_g = jacobian.multipliers.parameters[(0, 1)];
    // 2 λ y = m g
    assert!((by_g - 1.0 / (2.0 * -2.0)).abs() < 1e-15, "{by_g}");
}

/// A force that grows like a power: ∂/∂n of xⁿ is xⁿ ln x, which is not a number at 0.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[force(y: x^n)]
struct Power {
    n: f64,
}

#[test]
fn a_derivative_that_is_not_finite_is_named() {
    let root = Power { n: 0.5 };
    let at_the_root = State::at_rest([0.0, 1.0]).at_time(2.0);
    let expected =
        Error::DerivativeNotFinite { row: Row::Coordinate("y"), entry: Entry::Coordinate("x"), time: 2.0 };
    assert_eq!(root.jacobian(&at_the_root), Err(expected.clone()));
    assert_eq!(root.linearize(&at_the_root, &[]), Err(expected.clone()));
    assert_eq!(root.equilibrium(&at_the_root, &[]).unwrap_err(), expected);
    assert!(expected.to_string().contains("by `x` is not finite at t = 2; row of coordinate `y`"));
    assert_eq!(root.jacobian_by(&at_the_root, &["y", "x", "y_dot"]), Err(expected.clone()));
    // What was not asked for does no harm, nor what lies in another lane.
    assert_eq!(root.jacobian_by(&at_the_root, &["y", "y_dot"]).unwrap().accelerations.as_slice(), [0.0; 4]);
    let slopes = root.residual_slopes(&at_the_root, &root.solve(&at_the_root).unwrap());
    let mut both = Direction::<FourLanes, 2>::zero();
    (both.q[0], both.q[1]) = (FourLanes::from([1.0, 0.0, 1.0, 0.0]), FourLanes::from([0.0, 1.0, 1.0, 0.0]));
    let change = root.residual_change_with(&slopes, &both).motion[1].to_array();
    assert_eq!(change.map(f64::is_finite), [false, true, false, true]);
    let off = State::at_rest([f64::NAN, 1.0]);
    assert!(matches!(root.equilibrium(&off, &[]), Err(Error::StateNotFinite { .. })));
    // Beyond the root the force itself is no number.
    let beyond = root.equilibrium(&State::at_rest([-1.0, 1.0]), &["y"]).unwrap_err();
    assert_eq!(beyond, Error::EquationsNotFinite { row: Row::Coordinate("y"), time: 0.0 });
}

#[test]
fn a_derivative_that_does_not_exist_leaves_the_others() {
    let (cube, rest) = (Power { n: 3.0 }, State::at_rest([0.0; 2]));
    assert!(cube.linearize(&rest, &[]).is_ok());
    let error = cube.linearize(&rest, &["n"]).unwrap_err();
    let entry = Entry::Parameter("n");
    assert_eq!(error, Error::DerivativeNotFinite { row: Row::Coordinate("y"), entry, time: 0.0 });
}

/// Where θ = 0 the azimuth has no inertia.
#[test]
fn at_a_pole_there_is_an_equilibrium_but_no_motion_to_differentiate() {
    let polar = PolarPendulum { m: 1.0, g: 1.0, l: 1.0 };
    let found = polar.equilibrium(&State::at_rest([0.2, 0.7]), &[]).unwrap();
    assert!(found.state.q[0].abs() < 1e-15);
    assert_eq!(found.undetermined(), ["phi"]);
    let error = polar.linearize(&State::at_rest([0.0, 0.7]), &[]).unwrap_err();
    assert!(error.to_string().contains("`phi`"), "{error}");
}

#[test]
fn numbers_too_large_are_named_and_never_stable() {
    let spring = |m, k| DrivenSpring { m, k, c: 0.0, a: 0.0, w: 0.0 };
    let error = spring(1e-200, 1e200).linearize(&State::at_rest([0.0]), &[]).unwrap_err();
    let (row, entry) = (Row::Coordinate("x"), Entry::Coordinate("x"));
    assert_eq!(error, Error::DerivativeNotFinite { row, entry, time: 0.0 });
    let mut near = spring(1.0, 1.0).linearize(&State::at_rest([0.0]), &[]).unwrap();
    for entry in [f64::NAN, f64::INFINITY] {
        near.a[(1, 0)] = entry;
        assert_eq!(near.stability(), Err(Error::EigenvaluesNotFound));
        assert_eq!(near.natural_frequencies(), Err(Error::EigenvaluesNotFound));
    }
    let text = Error::EigenvaluesNotFound.to_string();
    assert!(text.contains("eigenvalues or singular values"), "{text}");
}
