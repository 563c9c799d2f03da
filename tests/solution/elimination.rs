//! The elimination that is emitted: its residuals, its signs and its limits.

use lagrange_core::nalgebra::{Const, DMatrix, DVector, SMatrix};
use lagrange_core::{Scalar, number::FourLanes, prelude::*};
use lagrange_random::Random;
use lagrange_systems::Pendulum;

use crate::{Angles, chains};

fn random_angles(random: &mut Random) -> State<f64, 8> {
    let mut entries = || random.array(|random| random.between(-3.0, 3.0));
    State::new(entries(), entries())
}

/// The Cartesian state of the same motion.
fn in_the_plane(l: &[f64; 8], angles: &State<f64, 8>) -> State<f64, 16> {
    let mut state = State::at_rest([0.0; 16]);
    let (mut x, mut y, mut vx, mut vy) = (0.0, 0.0, 0.0, 0.0);
    for (i, l) in l.iter().enumerate() {
        let (sine, cosine) = angles.q[i].sin_cos();
        (x, y) = (x + l * sine, y - l * cosine);
        (vx, vy) = (vx + l * cosine * angles.v[i], vy + l * sine * angles.v[i]);
        (state.q[i], state.q[8 + i], state.v[i], state.v[8 + i]) = (x, y, vx, vy);
    }
    state
}

/// What the emitted elimination leaves of the equations of motion and of the constraints.
fn residual<L, const N: usize, const M: usize>(system: &L, state: &State<f64, N>) -> f64
where
    L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    let right = (&system.forcing(state), &system.constraint_bias(state));
    crate::residual(system, state, right, &system.accelerations_unchecked(state))
}

/// Both forms of the chain fall alike: accelerations in angles, carried over, are those in the plane.
#[test]
fn rods_and_angles_agree_and_leave_rounding_errors() {
    let random = &mut Random(3);
    let mut entries = || random.array(|random| random.between(0.5, 2.5));
    let (m, l) = (entries(), entries());
    let (rods, angles) = chains(m, l);
    for _ in 0..50 {
        let state = random_angles(random);
        let plane = in_the_plane(&l, &state);
        assert!(residual(&rods, &plane) < 1e-14 && residual(&angles, &state) < 1e-13);
        let turning = angles.solve(&state).unwrap().accelerations;
        let falling = rods.solve(&plane).unwrap().accelerations;
        let mut expected = 0.0;
        for i in 0..8 {
            let (sine, cosine) = state.q[i].sin_cos();
            expected += l[i] * (cosine * turning[i] - sine * state.v[i] * state.v[i]);
            assert!((falling[i] - expected).abs() < 1e-10 * falling.amax(), "{i}: {} {expected}", falling[i]);
        }
    }
}

/// A crank and a rod of equal length: at the top dead centre of the folded mechanism the constraints lose rank.
#[derive(Lagrangian)]
#[coordinates(x, y, s)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m/2*s_dot^2 - m*g*y)]
#[constraint(crank: (x^2 + y^2 - l^2)/2 = 0)]
#[constraint(rod: ((s - x)^2 + y^2 - l^2)/2 = 0)]
struct SliderCrank {
    m: f64,
    g: f64,
    l: f64,
}

const CRANK: SliderCrank = SliderCrank { m: 1.0, g: 9.81, l: 1.0 };

/// This far from the folded pose.
fn nearly_folded(distance: f64) -> State<f64, 3> {
    let (x, y) = (distance, (1.0 - distance * distance).sqrt());
    State::new([x, y, 2.0 * x], [y, -x, 2.0 * y])
}

/// At x = s = 0 both constraints are the same row for motions of the pin: the fast elimination must notice, and
/// the general solve gives accelerations that meet every equation, or names what is wrong.
#[test]
fn a_singular_pose_is_noticed() {
    for distance in [1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 0.0] {
        let state = nearly_folded(distance);
        match CRANK.solve(&state) {
            Ok(solution) => {
                let f = CRANK.constraint_jacobian(&state);
                let a = solution.accelerations;
                let left = f * a + CRANK.constraint_bias(&state);
                assert!(left.amax() < 1e-7 * (1.0 + a.amax()), "{distance:e}: {left}");
                let push = CRANK.mass_matrix(&state) * a - CRANK.forcing(&state);
                let force = f.tr_mul(&solution.multipliers);
                assert!((push - force).amax() < 1e-7 * (1.0 + force.amax()), "{distance:e}: {push} {force}");
            }
            Err(
                Error::Contradictory { .. } | Error::DependentToFirstOrder { .. } | Error::Singular { .. },
            ) => {}
            Err(error) => panic!("{error}"),
        }
    }
    // Nearly dependent constraints show in the pivot of the Schur complement.
    for distance in [1e-3, 1e-4, 1e-5] {
        let pivot = CRANK.accelerations_unchecked(&nearly_folded(distance)).pivot;
        let square = distance * distance;
        assert!(pivot > square && pivot < 10.0 * square, "{distance:e}: {pivot:e}");
    }
    let folded = CRANK.accelerations_unchecked(&nearly_folded(0.0));
    assert!(folded.pivot.is_nan() || folded.pivot < 1e-6, "not noticed: {:e}", folded.pivot);
    assert!(folded.accelerations.iter().chain(&folded.multipliers).all(|x| x.is_nan()), "{folded:?}");
}

/// −L has the same motion.
#[test]
fn a_negative_mass_matrix_is_eliminated_like_a_positive_one() {
    #[derive(Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(s*(m/2*(x_dot^2 + 2*y_dot^2 + x_dot*y_dot) - m*g*y - x^2*y))]
    struct Signed {
        s: f64,
        m: f64,
        g: f64,
    }
    let state = State::new([0.4, -0.3], [1.0, 2.0]);
    let [plus, minus] = [1.0, -1.0].map(|s| Signed { s, m: 2.0, g: 9.81 }.accelerations_unchecked(&state));
    assert!((plus.accelerations - minus.accelerations).amax() < 1e-14);
    assert_eq!(plus.pivot, minus.pivot);
    assert!(plus.pivot > 0.5 && plus.pivot <= 1.0, "{}", plus.pivot);
}

/// M = [[a, c], [c, b]]: the second pivot is b − c²/a, of a diagonal entry b.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(a/2*x_dot^2 + b/2*y_dot^2 + c*x_dot*y_dot - x - y)]
struct Coupled<T> {
    a: T,
    b: T,
    c: T,
}

#[test]
fn the_pivot_is_what_is_left_of_the_diagonal() {
    let pivot = |a, b, c| Coupled { a, b, c }.accelerations_unchecked(&State::at_rest([0.0, 0.0])).pivot;
    for (a, b, c, left) in [(1.0, 1.0, 0.6, 0.64), (2.0, 8.0, 0.0, 1.0), (-1.0, -1.0, -0.6, 0.64)] {
        assert!((pivot(a, b, c) - left).abs() < 1e-15, "{a} {b} {c}: {}", pivot(a, b, c));
    }
    let nearly = pivot(1.0, 1.0, 1.0 - 1e-9);
    assert!(nearly > 0.0 && nearly < 1e-8, "nearly singular: {nearly:e}");
    // Regular, but indefinite: without pivoting the elimination grows by 1/a, which must show too.
    let grown = pivot(1e-9, -1.0, 1.0);
    assert!(grown.abs() < 1e-8, "grown: {grown:e}");
    assert!(pivot(1.0, 1.0, 2.0) < 0.0, "indefinite: {}", pivot(1.0, 1.0, 2.0));
}

/// Where the pivot is too small no number passes for a result; the lanes beside it are none the worse.
#[test]
fn what_the_elimination_cannot_vouch_for_is_no_number() {
    let numbers = |c: f64| {
        let system = Coupled { a: 1.0, b: 1.0, c };
        system.accelerations_unchecked(&State::at_rest([0.0; 2])).accelerations.map(f64::is_finite)
    };
    let single = |c: f32| {
        let system = Coupled { a: 1.0, b: 1.0, c };
        system.accelerations_unchecked(&State::at_rest([0.0; 2])).accelerations.map(f32::is_finite)
    };
    assert!(numbers(0.9999).iter().chain(&single(0.99)).all(|is_number| *is_number));
    for c in [1.0, 0.99999999, -1.0, 2.0, f64::NAN] {
        assert!(!numbers(c).iter().chain(&single(c as f32)).any(|is_number| *is_number), "{c}");
    }
    assert!(!single(0.9999).iter().any(|is_number| *is_number), "too little for single precision");

    // A part that is tied to nothing that is singular is none either: nobody has to know which is which.
    #[derive(Lagrangian)]
    #[coordinates(x, y, u, z)]
    #[lagrangian(x_dot^2/2 + y_dot^2/2 + c*x_dot*y_dot + u_dot^2/2 + u_dot*z_dot/2 + z_dot^2 - x - y - z)]
    #[constraint(rail: z = u)]
    struct Apart {
        c: f64,
    }
    let apart = |c| Apart { c }.accelerations_unchecked(&State::at_rest([0.0; 4]));
    assert!(apart(0.5).accelerations.iter().all(|x| x.is_finite()));
    let spoilt = apart(1.0 - 1e-9);
    assert!(spoilt.accelerations.iter().chain(&spoilt.multipliers).all(|x| x.is_nan()), "{spoilt:?}");

    let [a, b] = [FourLanes::constant(1.0); 2];
    let lanes = Coupled { a, b, c: FourLanes::from([0.5, 1.0, f64::NAN, -0.9]) };
    let state = State::at_rest([FourLanes::constant(0.0); 2]);
    for x in &lanes.accelerations_unchecked(&state).accelerations {
        assert_eq!(x.to_array().map(f64::is_finite), [true, false, false, true]);
    }
}

/// What LDLᵀ of M from the last coordinate to the first leaves of the diagonal, at its worst.
fn least_pivot(mass: &SMatrix<f64, 8, 8>) -> f64 {
    let (mut rest, mut least) = (*mass, 1.0_f64);
    for j in (0..8).rev() {
        least = least.min(rest[(j, j)] / mass[(j, j)]);
        let (column, row) = (rest.column(j).into_owned(), rest.row(j).into_owned());
        rest -= column * row / rest[(j, j)];
    }
    least
}

#[test]
fn the_pivots_over_definitions_are_those_of_the_mass_matrix() {
    let random = &mut Random(5);
    let mut entries = || random.array(|random| random.between(0.5, 2.5));
    let (_, angles) = chains(entries(), entries());
    for _ in 0..50 {
        let state = random_angles(random);
        let (pivot, expected) =
            (angles.accelerations_unchecked(&state).pivot, least_pivot(&angles.mass_matrix(&state)));
        assert!((pivot - expected).abs() < 1e-11 * expected, "{pivot} {expected}");
    }
}

/// Joints without mass in a straight chain: nothing determines how it buckles.
#[test]
fn a_straight_chain_of_massless_joints_is_noticed() {
    let straight = State::new([0.3; 8], [1.0; 8]);
    for mass in [0.0, 1e-15, 1e-9] {
        let mut m = [mass; 8];
        m[7] = 1.0;
        let chain = Angles { m, l: [1.0; 8], g: 9.81 };
        let pivot = chain.accelerations_unchecked(&straight).pivot;
        assert!(pivot.is_nan() || pivot < 1e-7, "{mass:e}: {pivot:e}");
        match chain.solve(&straight) {
            Ok(solution) => {
                let left = chain.mass_matrix(&straight) * solution.accelerations - chain.forcing(&straight);
                assert!(left.amax() < 1e-9, "{mass:e}: {left}");
            }
            Err(Error::Singular { coordinates, .. }) => assert!(mass < 1e-9, "{coordinates:?}"),
            Err(error) => panic!("{error}"),
        }
    }
}

/// A mass that cancels out of the acceleration still has to be there.
#[test]
fn a_pendulum_without_mass_is_singular() {
    let state = State::at_rest([0.5]);
    let solution = Pendulum { m: 2.0, g: 9.81, l: 3.0 }.solve(&state).unwrap();
    assert!((solution.accelerations[0] + 9.81 / 3.0 * 0.5_f64.sin()).abs() < 1e-15);
    let error = Pendulum { m: 0.0, g: 9.81, l: 3.0 }.solve(&state).unwrap_err();
    assert!(matches!(error, Error::Singular { .. }), "{error}");
}

/// A plate that hangs on legs, each of which turns about its foot by an angle and can be screwed out: what closes a leg is
/// eliminated before the plate.
#[derive(Lagrangian)]
#[coordinates(r: [2], phi, turn: [4], length: [4])]
#[define(end[k in 0..4] = foot[k] + length[k]*[cos(turn[k]), sin(turn[k])])]
#[define(corner[k in 0..4] = r + a[k]*[cos(phi + k), sin(phi + k)])]
#[lagrangian(m/2*dot(r_dot, r_dot) + inertia/2*phi_dot^2 - m*g*r[1] + sum(k in 0..4,
    inertia/9*turn_dot[k]^2 + m/7*dot(der(end[k]), der(end[k])) - m/7*g*end[k][1]))]
#[constraint(closed[k in 0..4]: end[k] = corner[k])]
struct Plate {
    foot: [[f64; 2]; 4],
    a: [f64; 4],
    m: f64,
    inertia: f64,
    g: f64,
}

impl Plate {
    /// Of legs of these lengths, in no order.
    fn of(lengths: [f64; 4]) -> (Self, State<f64, 11>) {
        let random = &mut Random(11);
        let mut plate = Self { foot: [[0.0; 2]; 4], a: [0.7; 4], m: 3.0, inertia: 0.4, g: 9.81 };
        let mut state = State::new([0.0; 11], random.vector());
        for (k, length) in lengths.into_iter().enumerate() {
            let (turn, at) = (random.between(-3.0, 3.0), k as f64);
            plate.foot[k] = [0.7 * at.cos() - length * turn.cos(), 0.7 * at.sin() - length * turn.sin()];
            (state.q[3 + k], state.q[7 + k]) = (turn, length);
        }
        (plate, state)
    }
}

/// A leg without length has no way to go along with the plate but one. It need not: the plate stands still there, and the
/// equations have a solution, which is found or not, but not wrong.
#[test]
fn loops_are_closed_before_what_they_hang_on_and_give_no_wrong_number() {
    for length in [0.5, 0.0, 1e-12, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
        let (plate, state) = Plate::of([length, 0.9, 1.3, 0.4]);
        if length == 0.5 {
            assert!(residual(&plate, &state) < 1e-14);
        }
        let (unchecked, checked) = (plate.accelerations_unchecked(&state), plate.solve(&state).unwrap());
        let (mut whole, mut right) = (DMatrix::zeros(19, 19), DVector::zeros(19));
        let f = plate.constraint_jacobian(&state);
        whole.view_mut((0, 0), (11, 11)).copy_from(&plate.mass_matrix(&state));
        whole.view_mut((0, 11), (11, 8)).copy_from(&-f.transpose());
        whole.view_mut((11, 0), (8, 11)).copy_from(&f);
        right.rows_mut(0, 11).copy_from(&plate.forcing(&state));
        right.rows_mut(11, 8).copy_from(&-plate.constraint_bias(&state));
        let dense = whole.full_piv_lu().solve(&right).unwrap();
        let off = |a: nalgebra::SVector<f64, 11>| (a - dense.rows(0, 11)).amax() / dense.rows(0, 11).amax();
        let [checked, unchecked] = [off(checked.accelerations), off(unchecked.accelerations)];
        assert!(checked < 1e-8, "{length:e}: solved, off by {checked:e}");
        assert!(unchecked.is_nan() || unchecked < 1e-8, "{length:e}: unchecked, off by {unchecked:e}");
    }
}
