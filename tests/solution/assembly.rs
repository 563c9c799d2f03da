//! Mechanisms are assembled from rough guesses; constraints that conflict are named.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};

/// A chain of four rods from the origin to the point (d, 0).
#[derive(Lagrangian)]
#[coordinates(a: [2], b: [2], c: [2])]
#[lagrangian((dot(a_dot, a_dot) + dot(b_dot, b_dot) + dot(c_dot, c_dot))/2)]
#[constraint(first: dot(a, a) = 1)]
#[constraint(second: dot(b - a, b - a) = 1)]
#[constraint(third: dot(c - b, c - b) = 1)]
#[constraint(last: (c[0] - d)^2 + c[1]^2 = 1)]
struct Chain {
    d: f64,
}

#[test]
fn chains_are_assembled_from_any_guess() {
    let (chain, random) = (Chain { d: 2.5 }, &mut Random(1));
    for _ in 0..cases([50, 300, 10_000]) {
        let guess = State::at_rest(random.vector().map(|x: f64| 5.0 * x));
        let assembly = chain.assemble(&guess).unwrap_or_else(|error| panic!("{guess:?}: {error}"));
        chain.check_consistent(&assembly.state).unwrap();
        assert_eq!((assembly.rank, assembly.degrees_of_freedom), (4, 2));
        assert!(assembly.redundant.as_slice().is_empty());
        assert_eq!(assembly.adjustment.q, assembly.state.q - guess.q);
    }
}

#[test]
fn chains_that_are_too_short_name_their_rods() {
    let (chain, random) = (Chain { d: 6.0 }, &mut Random(2));
    for _ in 0..30 {
        let guess = State::at_rest(random.vector().map(|x: f64| 3.0 * x));
        match chain.assemble(&guess).unwrap_err() {
            Error::Conflicting { constraints, distance, .. } => {
                assert_eq!(constraints.as_slice(), ["first", "second", "third", "last"]);
                assert!(distance > 0.1 && distance < 3.0, "{distance}");
            }
            other => panic!("{guess:?}: {other}"),
        }
    }
}

/// One of three constraints has nothing to do with the conflict.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2)]
#[constraint(circle: x^2 + y^2 = 1)]
#[constraint(line: x + y = far)]
#[constraint(height: z^3 + z = 2)]
struct Apart {
    far: f64,
}

#[test]
fn constraints_that_can_hold_are_not_blamed() {
    let guess = State::at_rest([0.3, 0.2, 4.0]);
    let error = Apart { far: 3.0 }.assemble(&guess).unwrap_err();
    assert!(
        matches!(&error, Error::Conflicting { constraints, .. } if constraints.as_slice() == ["circle", "line"]),
        "{error}"
    );
    let text = error.to_string();
    assert!(text.starts_with("the constraints `circle`, `line` conflict near the state given"), "{text}");
    let assembly = Apart { far: 1.0 }.assemble(&guess).unwrap();
    assert!((assembly.state.q[2] - 1.0).abs() < 1e-14 && assembly.degrees_of_freedom == 0);
    assert!(
        assembly.to_string().starts_with("assembled with 0 degrees of freedom, 3 independent constraints")
    );
}

/// A constraint twice, where the parameters are equal, and one on velocities.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2)]
#[constraint(rod: x^2 + y^2 = 1)]
#[constraint(again: a*x^2 + b*y^2 = 1)]
#[constraint(turn: z_dot - y*x_dot = 0)]
struct Twice {
    a: f64,
    b: f64,
}

#[test]
fn redundant_constraints_are_counted_once() {
    let guess = State::new([0.1, 0.2, 0.0], [1.0, 1.0, 1.0]);
    let assembly = Twice { a: 1.0, b: 1.0 }.assemble(&guess).unwrap();
    assert_eq!((assembly.rank, assembly.degrees_of_freedom), (2, 1));
    assert_eq!(assembly.redundant.as_slice().len(), 1);
    let [x, y, _] = assembly.state.q.into();
    let [u, v, w] = assembly.state.v.into();
    assert!(
        (x * x + y * y - 1.0).abs() < 1e-15 && (x * u + y * v).abs() < 1e-15 && (w - y * u).abs() < 1e-15
    );
    // From the centre, where the gradients vanish.
    let assembly = Twice { a: 1.0, b: 1.0 }.assemble(&State::at_rest([0.0; 3])).unwrap();
    assert_eq!(assembly.degrees_of_freedom, 1);
}

#[test]
fn guesses_must_be_numbers() {
    let broken = State::at_rest([f64::NAN, 0.0, 0.0]);
    assert!(matches!(Apart { far: 1.0 }.assemble(&broken), Err(Error::StateNotFinite { .. })));
}
