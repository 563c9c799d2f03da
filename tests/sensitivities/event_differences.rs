//! Derivatives across events, by differences of motions.

use lagrange_core::nalgebra::{Const, DMatrix, DVector};
use lagrange_core::{Dual, Ending, linearized::StateSensitivity, prelude::*};

use crate::differences::{STEPS, TOLERANCE, difference};
use crate::events::{Flying, method};

/// Columns of derivatives beside columns of differences, each by its own largest.
pub(crate) fn check(what: &str, found: &DMatrix<f64>, of: impl Fn(usize, f64) -> DMatrix<f64>) {
    for (j, column) in found.column_iter().enumerate() {
        let errors = STEPS.map(|step| {
            let expected = difference(step, |change| DVector::from_column_slice(of(j, change).as_slice()));
            (column - &expected).amax() / expected.amax().max(1e-3)
        });
        let error = errors[0].min(errors[1]);
        println!("{what}, by argument {j}: {error:.1e}");
        assert!(error < TOLERANCE, "{what}, by argument {j}: off by {error:e}");
    }
}

/// Time, coordinates and velocities, one below the other.
pub(crate) fn block<const N: usize>(at: &StateSensitivity<f64, Const<N>>) -> DMatrix<f64> {
    DMatrix::from_fn(1 + 2 * N, at.t.len(), |i, j| match i {
        0 => at.t[j],
        i if i <= N => at.q[(i - 1, j)],
        i => at.v[(i - 1 - N, j)],
    })
}

pub(crate) fn values<const N: usize>(state: &State<f64, N>) -> DMatrix<f64> {
    DMatrix::from_iterator(1 + 2 * N, 1, [state.t].iter().chain(&state.q).chain(&state.v).copied())
}

/// One below the other.
pub(crate) fn stack([above, below]: [DMatrix<f64>; 2]) -> DMatrix<f64> {
    let rows = above.nrows();
    DMatrix::from_fn(
        2 * rows,
        above.ncols(),
        |i, j| if i < rows { above[(i, j)] } else { below[(i - rows, j)] },
    )
}

/// A bob on a rod, and a wall that moves away.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + n*x_dot*y_dot*z - m*g*z)]
#[constraint(rod: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
struct Bob {
    m: f64,
    n: f64,
    g: f64,
    l: f64,
}

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
    let given @ [m, n, g, l, ..] = [1.1, 0.3, 9.81, 1.0, 0.12, 0.7];
    let start = State::new([-0.5, 0.2, -0.9], [0.6, 0.9, 0.0]);
    let start = Bob { m, n, g, l }.make_consistent(&start).unwrap().0;
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
            assert!(matches!(swing.trajectory().ending(), Ending::Event { .. }));
            at = walled.impact_sensitivity(swing.end().unwrap(), "wall", ("e", e)).unwrap();
        }
        let end = 2.2;
        assert!(at.state.t > 0.3 && at.state.t < end, "{}", at.state.t);
        let after = bob.motion_with_derivatives(&at).by(method()).towards(end).unwrap();
        assert_eq!(after.trajectory().end().time(), end);
        (at, after.end().unwrap().clone())
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
    let found = stack([block(&at), block(&last)]);
    check("a wall hit twice", &found, |j, change| {
        let (at, last) = changed(j, change);
        stack([values(&at.state), values(&last.state)])
    });
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
#[constraint(wall: x - a*cos(theta) = 0)]
struct Leaning {
    m: f64,
    a: f64,
    g: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
struct Sliding {
    m: f64,
    a: f64,
    g: f64,
}

/// It leaves where sin θ is 2/3 of what it was.
#[test]
fn a_ladder_that_leaves_the_wall() {
    let run = |theta: f64, [m, a, g]: [f64; 3]| {
        let (leaning, sliding) = (Leaning { m, a, g }, Sliding { m, a, g });
        let start = State::at_rest([2.0 * 1.2_f64.cos(), 2.0 * 1.2_f64.sin(), theta]);
        let start = leaning.make_consistent(&start).unwrap().0;
        let leaves = leaning.differentiable_event("leaves", |s| s.multiplier("wall"));
        let mut leaves = leaves.falling().terminal();
        let at = leaning.sensitivity(&start, &["theta", "m", "a", "g"]).unwrap();
        let lean =
            leaning.motion_with_derivatives(&at).by(method()).event(&mut leaves).towards(10.0).unwrap();
        let left = lean.end().unwrap().clone();
        let [from, to] = [start.q[2], left.state.q[2]];
        assert!((to.sin() - from.sin() * 2.0 / 3.0).abs() < 1e-12);
        let (expected, turned) = (2.0 / 3.0 * from.cos() / to.cos(), lean.at(0.0).unwrap().q[(2, 0)]);
        assert!((left.q[(2, 0)] - expected * turned).abs() < 1e-10, "{}", left.q[(2, 0)] / turned);
        let slide = sliding.motion_with_derivatives(&left).by(method()).towards(1.4).unwrap();
        (left, slide.end().unwrap().clone())
    };
    let given = [3.0, 2.0, 9.81];
    let (left, last) = run(1.2, given);
    assert!(left.state.t < 1.3);
    check("a ladder", &stack([block(&left), block(&last)]), |j, change| {
        let (mut theta, mut given) = (1.2, given);
        match j {
            0 => theta += change,
            j => given[j - 1] += change,
        }
        let (left, last) = run(theta, given);
        stack([values(&left.state), values(&last.state)])
    });
}

/// A pendulum swings, its string is cut at an angle, and the bob flies until it lands: from one coordinate to two.
#[test]
fn a_reset_to_other_coordinates() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(theta)]
    #[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
    struct Swinging {
        m: f64,
        l: f64,
        g: f64,
    }
    let run = |[theta, l, g, cut, speed]: [f64; 5]| {
        let (swinging, flying) = (Swinging { m: 0.2, l, g }, Flying { m: 0.2, g });
        let cuts =
            swinging.differentiable_event("cut", |s| Ok(s.coordinate("theta")? - s.number("cut", cut)));
        let mut cuts = cuts.rising().terminal();
        let lands = flying.differentiable_event("lands", |s| Ok(s.coordinate("y")? + Dual::constant(3.0)));
        let mut lands = lands.falling().terminal();
        let at = swinging.sensitivity(&State::at_rest([theta]), &["theta", "l", "g"]).unwrap();
        let at = at.with(&["cut", "speed"]).unwrap();
        let swing =
            swinging.motion_with_derivatives(&at).by(method()).event(&mut cuts).towards(10.0).unwrap();
        let thrown = swinging.push_forward(swing.end().unwrap(), |s| {
            let (l, theta, rate) = (s.parameter("l")?, s.coordinate("theta")?, s.velocity("theta")?);
            let (sin, cos) = theta.sin_cos();
            // Thrown a little faster the later it is.
            let up = l * sin * rate + s.number("speed", speed) * s.time();
            Ok([[l * sin, -l * cos], [l * cos * rate, up]])
        });
        let flight =
            flying.motion_with_derivatives(&thrown.unwrap()).by(method()).event(&mut lands).towards(10.0);
        flight.unwrap().end().unwrap().clone()
    };
    let given = [-1.0, 1.5, 9.81, 0.7, 0.4];
    check("a cut pendulum", &block(&run(given)), |j, change| {
        let mut given = given;
        given[j] += change;
        values(&run(given).state)
    });
}

/// The force of the rod on z is λ z, and m z̈ = n ẋ ẏ − m g + λ z.
#[test]
fn what_follows_from_a_state_changes_with_it() {
    let bob = Bob { m: 1.1, n: 0.0, g: 9.81, l: 1.0 };
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
