//! Constraints that the parameters cancel to round-off at every pose are refused, and no others.
//!
//! A failure says the number of its case.

use lagrange_core::error::Row;
use lagrange_core::nalgebra::Const;
use lagrange_core::{SolutionOf, prelude::*};
use lagrange_random::{Random, cases};

/// A planar loop of three links, whose plane is turned by a₀, a₁ and a₂ at one base, and by c at the other.
macro_rules! linkage {
    ($name:ident, $($constraint:tt)*) => {
        #[derive(Clone, Lagrangian)]
        #[coordinates(p, q, s)]
        #[frame(one: rotate_x(a[0]), rotate_x(a[1]), rotate_x(a[2]), rotate_z(p))]
        #[frame(two in one: translate([l[0], 0, 0]), rotate_z(q))]
        #[frame(other: translate([l[3], 0, 0]), rotate_x(c), rotate_z(s))]
        #[lagrangian(kinetic(one, m, [l[0]/2, 0, 0], inertia) + kinetic(two, m, [l[1]/2, 0, 0], inertia)
            + kinetic(other, m, [l[2]/2, 0, 0], inertia) - m*g*position(two)[1])]
        #[force(p: torque)]
        $($constraint)*
        pub(crate) struct $name { a: [f64; 3], c: f64, l: [f64; 4], m: f64, g: f64, torque: f64, inertia: nalgebra::Matrix3<f64> }
    };
}
linkage!(Loop, #[define(gap = transpose(rot_x(c))*(position(two, [l[1], 0, 0]) - position(other, [l[2], 0, 0])))]
    #[constraint(closed: gap = 0)]);
linkage!(Moving, #[constraint(closed: transpose(rot_x(c))*(express(velocity(two, [l[1], 0, 0]), fixed) - express(velocity(other, [l[2], 0, 0]), fixed)) = 0)]);

/// A row whose only coefficient is a sum of parameters.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rope: (a[0] + a[1] - c)*x + (a[0] + a[1] - c)*y = 0)]
struct Rope {
    a: [f64; 2],
    c: f64,
    g: f64,
}

/// Rows that vary with the coordinates only as far as the parameters do not cancel.
macro_rules! wheel {
    ($name:ident, $($row:tt)*) => {
        #[derive(Lagrangian)]
        #[coordinates(x, y)]
        #[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
        #[define(d = a[0] + a[1] - c)]
        #[constraint(rope: $($row)*)]
        struct $name {
            a: [f64; 2],
            c: f64,
            g: f64,
        }
    };
}
wheel!(Sine, sin(d * x) * x_dot + sin(d * y) * y_dot = 0);
wheel!(Cosine, cos(d * x + pi / 2) * x_dot + cos(d * y + pi / 2) * y_dot = 0);
wheel!(Angle, atan2(d * x, 1) * x_dot + atan2(d * y, 1) * y_dot = 0);
wheel!(Logarithm, ln(1 + d * x) * x_dot + ln(1 + d * y) * y_dot = 0);
wheel!(Exponential, exp(d * x) * x_dot + exp(d * y) * y_dot = 0);
wheel!(Shifted, (sin(y + d * x) - sin(y)) * x_dot = 0);
wheel!(Gear, sin(y + d * x) - sin(y) = 0);
wheel!(Root, sqrt((a[0] + a[1]) ^ 2 * x ^ 2) - c * x = 0);
wheel!(Power, (x ^ (a[0] + a[1]) * x ^ (-c) - 1) * x_dot = 0);

fn count() -> u64 {
    cases([100, 1_000, 100_000]) as u64
}

pub(crate) fn linkage(random: &mut Random, error: f64) -> (Loop, State<f64, 3>) {
    let a: [f64; 3] = random.array(Random::signed);
    let [m, g] = random.array(Random::positive);
    let [p, q, s] = random.array(|random| random.between(-3.0, 3.0));
    let l: [f64; 3] = random.array(Random::positive);
    let inertia = nalgebra::Matrix3::from_diagonal_element(random.positive());
    // The links meet in the plane at height zero of the last base, which is placed there, or in the plane anywhere.
    let base = l[0] * p.cos() + l[1] * (p + q).cos() - l[2] * s.cos();
    let linkage =
        Loop { a, c: a.iter().sum::<f64>() + error, l: [l[0], l[1], l[2], base], m, g, torque: 0.0, inertia };
    (linkage, State::at_rest([p, q, s]))
}

pub(crate) fn is_refused<T>(found: &Result<T, Error>) -> bool {
    matches!(found, Err(Error::NoGradient { constraint: Row::Constraint("closed[2]" | "rope"), .. }))
}

#[test]
fn rows_that_parameters_cancel_are_refused() {
    for case in 0..count() {
        let random = &mut Random(case);
        let (linkage, state) = linkage(random, 0.0);
        let row = linkage.constraint_jacobian(&state).row(2).into_owned();
        let found = linkage.solve(&state);
        // By chance the row may be zero, and then the constraint has no effect.
        assert!(is_refused(&found) || row.amax() == 0.0, "case {case}: {found:?}, {row}");
        let Loop { a, c, l, m, g, torque, inertia } = linkage;
        let moving = Moving { a, c, l, m, g, torque, inertia };
        let row = moving.constraint_jacobian(&state).row(2).into_owned();
        let found = [moving.solve(&state).map(drop), moving.check_consistent(&state)];
        assert!(found.iter().all(is_refused) || row.amax() == 0.0, "case {case}: {found:?}, {row}");
        let a = [random.signed(), random.signed()];
        let rope = Rope { a, c: a[0] + a[1] + f64::EPSILON * a[0].abs(), g: 9.81 };
        let row = rope.constraint_jacobian(&State::at_rest([0.0; 2]))[0];
        let found = rope.solve(&State::at_rest([0.0; 2]));
        assert!(is_refused(&found) || row == 0.0, "case {case}: {found:?}, {row}");
    }
}

/// Functions of coordinates times a sum of parameters that is round-off; only the last has a row that is not.
#[test]
fn rows_whose_motion_the_parameters_cancel_are_refused() {
    for case in 0..count() {
        let random = &mut Random(case);
        let (a, g) = ([random.signed(), random.signed()], 9.81);
        let c = a[0] + a[1] + f64::EPSILON * a[0].abs();
        let state = State::at_rest([random.between(0.5, 2.0), random.between(0.5, 2.0)]);
        if a[0] + a[1] == c {
            continue;
        }
        let found = [
            Sine { a, c, g }.solve(&state),
            Cosine { a, c, g }.solve(&state),
            Angle { a, c, g }.solve(&state),
        ];
        assert!(found.iter().all(is_refused), "case {case}: {found:?}");
        let logarithm = Logarithm { a, c, g };
        let (found, row) = (logarithm.solve(&state), logarithm.constraint_jacobian(&state));
        assert!(is_refused(&found) || row.amax() == 0.0, "case {case}: {found:?}");
        let found = Exponential { a, c, g }.solve(&state);
        assert!(found.is_ok(), "case {case}: {found:?}");
    }
}

/// A coordinate beside those that vary, and factors that cancel each other's variation.
#[test]
fn rows_whose_terms_differ_by_round_off_are_refused() {
    let mut refused = [0; 4];
    for case in 0..count() {
        let random = &mut Random(case);
        let (a, g) = ([random.positive(), random.positive()], 9.81);
        let c = (a[0] + a[1]) * (1.0 + f64::EPSILON);
        let state = State::at_rest([random.between(0.5, 2.0), random.between(0.5, 2.0)]);
        fn row<L: Lagrangian<N = Const<2>, M = Const<1>, Scalar = f64>>(
            system: L,
            state: &State<f64, 2>,
        ) -> (Result<SolutionOf<L>, Error>, f64) {
            (system.solve(state), system.constraint_jacobian(state).amax())
        }
        let found = [
            row(Shifted { a, c, g }, &state),
            row(Gear { a, c, g }, &state),
            row(Root { a, c, g }, &state),
            row(Power { a, c, g }, &state),
        ];
        for (refused, (found, largest)) in refused.iter_mut().zip(found) {
            assert!(is_refused(&found) || largest == 0.0, "case {case}: {found:?}, {largest}");
            *refused += u64::from(largest != 0.0);
        }
    }
    assert!(refused.iter().all(|&times| times > count() / 10), "{refused:?}");
}

/// Planes that differ by 10⁻¹¹, and the constraints in the plane.
#[test]
fn rows_of_different_planes_are_let_pass() {
    for case in 0..count() {
        let random = &mut Random(case);
        let error = random.size(1e-11, 1.0);
        let (linkage, state) = linkage(random, error);
        let found = linkage.solve(&state);
        assert!(!is_refused(&found), "case {case}: {found:?}, planes differ by {error}");
    }
}
