//! Derivatives across events, by differences of motions.

use lagrange_core::nalgebra::{Const, DMatrix, DVector};
use lagrange_core::{Dual, Ending, linearized::StateSensitivity, prelude::*};

use crate::differences::{compare_columns, flat, flow};
use crate::events::method;

/// Derivatives of [`values`] by each argument.
pub(crate) fn block<const N: usize>(states: &[&StateSensitivity<f64, Const<N>>]) -> DMatrix<f64> {
    let blocks = states.iter().map(|at| {
        let mut block = flow(at).insert_row(0, 0.0);
        block.row_mut(0).copy_from_slice(at.t.as_slice());
        block
    });
    let rows = blocks.flat_map(|block| block.row_iter().map(|row| row.into_owned()).collect::<Vec<_>>());
    DMatrix::from_rows(&rows.collect::<Vec<_>>())
}

/// Times, coordinates and velocities, one below the other.
pub(crate) fn values<const N: usize>(states: &[&State<f64, N>]) -> DVector<f64> {
    let all = states.iter().flat_map(|state| flat(state).insert_row(0, state.t).as_slice().to_vec());
    DVector::from_vec(all.collect())
}

/// A bob on a rod, with a mass that depends on where it is.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + n*x_dot*y_dot*z - m*g*z)]
#[constraint(rod: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
pub(crate) struct Bob<T> {
    m: T,
    n: T,
    g: T,
    l: T,
}

pub(crate) const BOB: Bob<f64> = Bob { m: 1.1, n: 0.3, g: 9.81, l: 1.0 };

/// The same at a wall that moves away.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + n*x_dot*y_dot*z - m*g*z)]
#[constraint(rod: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
#[constraint(wall: x + y^2/2 = w*t)]
struct Walled {
    m: f64,
    n: f64,
    g: f64,
    l: f64,
    w: f64,
}

/// Through two impacts and on: entries of the start and all parameters; a rod, a curved wall that moves, masses
/// that depend on where it is, and an event that depends on the time.
#[test]
fn a_spherical_pendulum_that_hits_a_wall_twice() {
    const NAMES: [&str; 8] = ["x_dot", "y", "m", "n", "g", "l", "w", "e"];
    let Bob { m, n, g, l } = BOB;
    let given = [m, n, g, l, 0.12, 0.7];
    let start = State::new([-0.5, 0.2, -0.9], [0.6, 0.9, 0.0]);
    let start = BOB.make_consistent(&start).unwrap().0;
    // Derivatives by all of the names, or none: the motion is the same, and takes less.
    let run = |start: State<f64, 3>, [m, n, g, l, w, e]: [f64; 6], [own, others]: [&[&'static str]; 2]| {
        let (bob, walled) = (Bob { m, n, g, l }, Walled { m, n, g, l, w });
        let start = bob.make_consistent(&start).unwrap().0;
        let mut hits = bob.differentiable_event("hits", |s| {
            let [x, y, _] = s.state().q.into();
            x + y * y * Dual::constant(0.5) - s.number("w", w) * s.time()
        });
        hits = hits.rising().terminal();
        let mut at = bob.sensitivity(&start, own).unwrap().with(others).unwrap();
        for _ in 0..2 {
            let swing = bob.motion_with_derivatives(&at).by(method()).event(&mut hits).towards(10.0).unwrap();
            assert!(matches!(swing.ending(), Ending::Event { .. }));
            at = walled.impact_sensitivity(swing.derivatives_at_end().unwrap(), "wall", ("e", e)).unwrap();
        }
        let end = 2.2;
        assert!(at.state.t > 0.3 && at.state.t < end, "{}", at.state.t);
        let after = bob.motion_with_derivatives(&at).by(method()).towards(end).unwrap();
        assert_eq!(after.end().time(), end);
        (at, after.derivatives_at_end().unwrap().clone())
    };
    let (at, last) = run(start, given, [&NAMES[..6], &NAMES[6..]]);
    // Derivatives by the start stay on the rod.
    let off = |j: usize| (last.q.column(j).transpose() * last.state.q)[0];
    assert!(off(0).abs() < 1e-11 && off(1).abs() < 1e-11 && off(6).abs() < 1e-11);
    let changed = |j: usize, change: f64| {
        let (mut start, mut given) = (start, given);
        match j {
            0 => start.v[0] += change,
            1 => start.q[1] += change,
            j => given[j - 2] += change,
        }
        run(start, given, [&[], &[]])
    };
    // After the second impact, and at the end.
    let found = block(&[&at, &last]);
    compare_columns("a wall hit twice", &found, |j, change| {
        let (at, last) = changed(j, change);
        values(&[&at.state, &last.state])
    });
}

/// The force of the rod on z is λ z, and m z̈ = n ẋ ẏ − m g + λ z.
#[test]
fn what_follows_from_a_state_changes_with_it() {
    let bob = Bob { n: 0.0, ..BOB };
    let state = State::new([-0.5, 0.2, -0.9], [0.6, 0.9, 0.0]);
    let state = bob.make_consistent(&state).unwrap().0;
    let at = bob.sensitivity(&state, &["x", "y", "z", "z_dot", "m", "n", "g", "l"]).unwrap();
    let forces = bob.push_forward(&at, |s| {
        let [m, g, z] = [s.parameter("m")?, s.parameter("g")?, s.coordinate("z")?];
        let lever = s.multiplier("rod")? * z;
        let row =
            m * s.acceleration("z")? + m * g - s.parameter("n")? * s.velocity("x")? * s.velocity("y")?;
        Ok([[s.constraint_force("z")?, lever], [row, lever]])
    });
    let StateSensitivity { state, q, v, .. } = forces.unwrap();
    assert!((state.q[0] - state.q[1]).abs() < 1e-14 && (state.q[0] - state.v[0]).abs() < 1e-13);
    assert!(q.row(0).amax() > 1.0 && (q.row(0) - q.row(1)).amax() < 1e-12, "{q}");
    assert!((q.row(0) - v.row(0)).amax() < 1e-12, "{q}{v}");
}
