//! Constraints that the parameters cancel to round-off at every pose are refused, and no others.
//!
//! A failure says the number of its case.

use lagrange_core::prelude::*;
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
        struct $name { a: [f64; 3], c: f64, l: [f64; 4], m: f64, g: f64, torque: f64, inertia: nalgebra::Matrix3<f64> }
    };
}
linkage!(Loop, #[define(gap = transpose(rot_x(c))*(position(two, [l[1], 0, 0]) - position(other, [l[2], 0, 0])))]
    #[constraint(closed: gap = 0)]);
linkage!(Moving, #[constraint(closed: transpose(rot_x(c))*(express(velocity(two, [l[1], 0, 0]), fixed) - express(velocity(other, [l[2], 0, 0]), fixed)) = 0)]);
linkage!(Planar, #[define(gap = transpose(rot_x(c))*(position(two, [l[1], 0, 0]) - position(other, [l[2], 0, 0])))]
    #[constraint(closed[i in 0..2]: gap[i] = 0)]);

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
    cases([300, 1_000, 100_000]) as u64
}

fn linkage(random: &mut Random, error: f64) -> (Loop, State<f64, 3>) {
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

fn is_refused<T>(found: &Result<T, Error>) -> bool {
    matches!(found, Err(Error::NoGradient { constraint: "closed[2]" | "rope", .. }))
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
        if row.amax() > 0.0 {
            let integrated = moving.integrate(state, 1.0, Dop853::default());
            let found =
                [moving.solve(&state).map(drop), moving.check_consistent(&state), integrated.map(drop)];
            assert!(found.iter().all(is_refused), "case {case}: {found:?}, {row}");
        }
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
            ("sin", Sine { a, c, g }.solve(&state)),
            ("cos", Cosine { a, c, g }.solve(&state)),
            ("atan2", Angle { a, c, g }.solve(&state)),
        ];
        assert!(found.iter().all(|(_, found)| is_refused(found)), "case {case}: {found:?}");
        let logarithm = Logarithm { a, c, g };
        let found = logarithm.solve(&state);
        assert!(
            is_refused(&found) || logarithm.constraint_jacobian(&state).amax() == 0.0,
            "case {case}: {found:?}"
        );
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
        let found = [
            (Shifted { a, c, g }.solve(&state), Shifted { a, c, g }.constraint_jacobian(&state).amax()),
            (Gear { a, c, g }.solve(&state), Gear { a, c, g }.constraint_jacobian(&state).amax()),
            (Root { a, c, g }.solve(&state), Root { a, c, g }.constraint_jacobian(&state).amax()),
            (Power { a, c, g }.solve(&state), Power { a, c, g }.constraint_jacobian(&state).amax()),
        ];
        for (refused, (found, largest)) in refused.iter_mut().zip(found) {
            assert!(is_refused(&found) || largest == 0.0, "case {case}: {found:?}, {largest}");
            *refused += u64::from(largest != 0.0);
        }
    }
    assert!(refused.iter().all(|&times| times > count() / 10), "{refused:?}");
}

/// Whatever uses the constraints says so.
#[test]
fn no_result_follows_from_a_row_that_parameters_cancel() {
    let random = &mut Random(1);
    for _ in 0..100 {
        let (linkage, state) = linkage(random, 0.0);
        let row = linkage.constraint_jacobian(&state).row(2).into_owned();
        if row.amax() == 0.0 {
            continue;
        }
        let found = [
            linkage.check_consistent(&state),
            linkage.make_consistent(&state).map(drop),
            linkage.assemble(&state).map(drop),
            linkage.linearize(&state, &["m"]).map(drop),
            linkage.equilibrium(&state, &[]).map(drop),
            linkage.inputs_for(&state, &[0.0; 3].into(), &["torque"]).map(drop),
            linkage.complete_accelerations(&state, &[1.0; 3].into(), &["p"]).map(drop),
            linkage.hamilton_equations(&linkage.phase_state(&state)).map(drop),
            linkage.integrate(state, 1.0, Radau::default()).map(drop),
            linkage.integrate_hamiltonian(linkage.phase_state(&state), 1.0, Dop853::default()).map(drop),
            linkage.integrate_sensitivities(state, 1.0, Dop853::default(), &["m"]).map(drop),
            linkage.monodromy(&state, 1.0, Dop853::default()).map(drop),
        ];
        assert!(found.iter().all(is_refused), "{found:?}, {row}");
    }
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

/// The advice of the error: without the constraint across the plane, the motion is that of a linkage turned by one angle.
#[test]
fn the_constraint_across_the_plane_is_left_out() {
    let random = &mut Random(7);
    for _ in 0..100 {
        let (Loop { a, c, l, m, g, torque, inertia }, start) = linkage(random, 0.0);
        let turned = Planar { a, c, l, m, g, torque, inertia };
        let flat = Planar { a: [0.0; 3], c: 0.0, g: g * c.cos(), ..turned.clone() };
        let [turned, flat] =
            [turned, flat].map(|linkage| linkage.solve(&start).expect("a solution").accelerations);
        assert!((turned - flat).amax() <= 1e-10 * flat.amax().max(1.0), "{turned} {flat}");
    }
}
