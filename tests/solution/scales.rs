//! Units in which numbers are huge or tiny: the answer is the same motion in those units, or a named error.

use lagrange_core::{Real, generic::Solution, nalgebra::Const, prelude::*};
use lagrange_systems::Pendulum;

/// A bead on an inclined line, y = −¾ x, the constraint in units of its own.
#[derive(Lagrangian, Clone)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(line: 0.6*s*x + 0.8*s*y = 0)]
pub(crate) struct Bead<T> {
    pub(crate) m: T,
    pub(crate) g: T,
    pub(crate) s: T,
}

/// The same, held twice: by a row and by a multiple of it.
#[derive(Lagrangian, Clone)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(line: 0.6*s*x + 0.8*s*y = 0)]
#[constraint(again: 1.2*r*x + 1.6*r*y = 0)]
struct Twice<T> {
    m: T,
    g: T,
    s: T,
    r: T,
}

/// A point that three planes hold in its place: one in units of its own, one said twice.
#[derive(Lagrangian, Clone)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 + x - 2*y + z/3)]
#[constraint(plane: s*(x + y + z) = 0)]
#[constraint(steep: x - y + 2*z = 0)]
#[constraint(again: x - y + k*z = 0)]
#[constraint(third: 3*x + y - z = 0)]
struct Corner {
    s: f64,
    k: f64,
}

pub(crate) const DOUBLE: [f64; 13] =
    [1e-300, 1e-200, 1e-165, 1e-161, 1e-155, 1e-80, 1.0, 1e80, 1e152, 1e155, 1e165, 1e200, 1e300];
const SINGLE: [f32; 9] = [1e-37, 1e-30, 1e-22, 1e-10, 1.0, 1e10, 1e20, 1e30, 1e37];

/// m ẍ = 0.6 s λ, m ÿ = −m g + 0.8 s λ, ẍ = −4/3 ÿ: s λ = 0.8 m g, ẍ = 0.48 g, ÿ = −0.36 g. Whether it is so; where s λ, or
/// what `is_beyond` says, is no number, it may be an error instead.
fn slides<L>(bead: &L, is_beyond: bool, tolerance: f64)
where
    L: Lagrangian<N = Const<2>, Scalar: Real>,
{
    let state = State::at_rest([L::Scalar::constant(0.0); 2]);
    let Solution { accelerations, rank, .. } = match bead.solve(&state) {
        Err(Error::EquationsNotFinite { .. }) if is_beyond => return,
        solution => solution.expect("a solution"),
    };
    let [x, y] = [0, 1].map(|i| accelerations[i].to_f64());
    assert!((x / 4.8 - 1.0).abs() < tolerance && (y / -3.6 - 1.0).abs() < tolerance, "({x}, {y})");
    assert_eq!(rank, 1);
}

#[test]
fn a_row_of_any_length_constrains() {
    for s in DOUBLE {
        for m in [1e-200, 1e-160, 1e-150, 1.0, 1e150, 1e160, 1e200] {
            let (bead, lambda) = (Bead { m, g: 10.0, s }, 8.0 * m / s);
            slides(&bead, lambda.is_infinite(), 1e-13);
            if lambda.is_normal() {
                let solution = bead.solve(&State::at_rest([0.0; 2])).expect("a solution");
                assert!((solution.multipliers[0] / lambda - 1.0).abs() < 1e-13, "{solution:?} {lambda}");
            }
        }
    }
    for s in SINGLE {
        for m in [1e-30, 1e-20, 1.0, 1e20, 1e30] {
            slides(&Bead { m, g: 10.0_f32, s }, (8.0 * m / s).is_infinite(), 1e-5);
        }
    }
}

#[test]
fn rows_of_unlike_lengths_that_depend_on_one_another_share_the_force() {
    for s in DOUBLE {
        for r in DOUBLE {
            let twice = Twice { m: 1.0, g: 10.0, s, r };
            let lambda = [4.0 / s, 2.0 / r];
            slides(&twice, lambda.iter().any(|lambda| lambda.is_infinite()), 1e-13);
            if lambda.iter().all(|lambda| lambda.is_normal()) {
                // Of least norm in the units of the rows: each carries half of the force.
                let found: [f64; 2] =
                    twice.solve(&State::at_rest([0.0; 2])).expect("a solution").multipliers.into();
                for (found, lambda) in found.iter().zip(lambda) {
                    assert!((found / lambda - 1.0).abs() < 1e-13, "{found} {lambda} for {s} {r}");
                }
            }
        }
    }
}

#[test]
fn a_mass_matrix_that_is_no_number_is_refused() {
    for (m, l) in [(1e200, 1e60), (1e-200, 1e-70), (1e-320, 1.0), (1.0, 1e-160)] {
        let swing = Pendulum { m, g: 10.0 * l, l };
        match swing.solve(&State::at_rest([0.5])) {
            Ok(solution) => {
                let expected = -10.0 * 0.5_f64.sin();
                assert!((solution.accelerations[0] / expected - 1.0).abs() < 1e-12, "{solution:?}");
            }
            Err(error) => {
                let named = matches!(error, Error::EquationsNotFinite { .. } | Error::Singular { .. });
                assert!(named, "{error}");
            }
        }
    }
}

/// A point whose height is the sine of an angle.
#[derive(Lagrangian, Clone)]
#[coordinates(theta, y)]
#[lagrangian(theta_dot^2/2 + y_dot^2/2)]
#[constraint(wave: y = sin(theta))]
struct Wave;

#[test]
fn a_state_is_consistent_where_the_constraint_holds_however_large_an_angle() {
    for theta in [0.3, 1e6, 1e9, 1e12, 1e16] {
        let at = |y: f64| State::at_rest([theta, y]);
        assert!(Wave.check_consistent(&at(theta.sin())).is_ok(), "{theta}");
        let error = Wave.check_consistent(&at(theta.sin() + 3.0)).expect_err("three off");
        assert!(matches!(error, Error::Inconsistent { .. }), "{error}");
        match Wave.make_consistent(&at(theta.sin() + 3.0)) {
            Ok((state, _)) => {
                let left = state.q[1] - state.q[0].sin();
                assert!(left.abs() < 1e-7, "{left} at {theta}");
            }
            Err(error) => assert!(theta > 1e8 && matches!(error, Error::NotProjected { .. }), "{error}"),
        }
    }
}

/// Two points that hold together, by a row so large that the size of its terms is no number.
#[derive(Lagrangian, Clone)]
#[coordinates(x, y)]
#[lagrangian(x_dot^2/2 + y_dot^2/2)]
#[constraint(together: s*(x - y) = 0)]
struct Together {
    s: f64,
}

#[test]
fn what_is_too_large_to_compare_is_refused() {
    let together = Together { s: 1e160 };
    assert!(together.check_consistent(&State::at_rest([1e140, 1e140])).is_ok());
    for y in [1.001e150, f64::MAX] {
        let state = State::at_rest([1e150, y]);
        let error = together.check_consistent(&state).expect_err("off");
        assert!(matches!(error, Error::Inconsistent { .. }), "{error}");
        match together.make_consistent(&state) {
            Ok((state, _)) => assert!((state.q[0] / state.q[1] - 1.0).abs() < 1e-15, "{state:?}"),
            Err(error) => assert!(matches!(error, Error::NotProjected { .. }), "{error}"),
        }
    }
}

/// In (q, p) too: the size of the terms of a row is no number.
#[test]
fn a_velocity_across_a_constraint_is_refused_where_its_terms_are_too_large() {
    let together = Together { s: 1e160 };
    let phase = PhaseState::new([0.0, 0.0], [1e150, 1.002e150]);
    // From rest, and from the velocity that would have these momenta without the constraint.
    for guess in [[0.0; 2], [1e150, 1.002e150]] {
        match together.legendre_near(&phase, &guess.into()) {
            Ok(state) => assert!((state.v[0] / state.v[1] - 1.0).abs() < 1e-15, "{state:?} from {guess:?}"),
            Err(error) => assert!(matches!(error, Error::MomentumNotReached { .. }), "{error}"),
        }
    }
}

/// Beads on parabolas, whose heights have no mass, and a link between them; for a = 1 it is there twice.
#[derive(Lagrangian)]
#[coordinates(x: [2], y: [2])]
#[lagrangian(sum(i in 0..2, x_dot[i]^2/2 - g*y[i]))]
#[constraint(curve[i in 0..2]: y[i] - x[i]^2 = 0)]
#[constraint(link: x[0] + y[1] = 0)]
struct Beads {
    g: f64,
}

/// Near x = 0 a bead hardly moves its height. In natural units the multiplier that holds this height is then tiny beside the
/// others, and must not have their round-off. The singular values of the equations are 0.3 to 3 everywhere, so that small
/// residuals are small errors.
#[test]
fn massless_coordinates_keep_their_digits_where_others_hardly_move_them() {
    let beads = Beads { g: 0.7 };
    for k in 0..32 {
        let e = 10.0_f64.powf(-0.5 * f64::from(k));
        let state = State::new([-e * e, e, e.powi(4), e * e], [-2.0 * e, 1.0, 4.0 * e.powi(3), 2.0 * e]);
        let found = beads.solve(&state).unwrap();
        let (a, lambda) = (found.accelerations, found.multipliers);
        let motion = beads.inverse_dynamics(&state, &a, &lambda).amax();
        let held = (beads.constraint_jacobian(&state) * a + beads.constraint_bias(&state)).amax();
        assert!(motion < 1e-9 && held < 1e-12, "{e:e}: {motion:e}, {held:e}");
    }
}

/// Two coordinates that have an inertia only together.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(k*(x_dot*y_dot - x*y - x^2/4))]
#[constraint(tie: y - x - x^3/3 = 0)]
struct Cross {
    k: f64,
}

/// The motion does not depend on the unit of energy. On y = x + x³/3, L/k is (1 + x²) ẋ² − x² − x⁴/3 − x²/4.
#[test]
fn inertia_between_coordinates_has_any_unit() {
    let (x, v) = (0.6_f64, 0.5);
    let state = State::new([x, x + x.powi(3) / 3.0], [v, (1.0 + x * x) * v]);
    let expected = (-2.5 * x - 4.0 * x.powi(3) / 3.0 - 2.0 * x * v * v) / (2.0 * (1.0 + x * x));
    for power in -14..15 {
        let cross = Cross { k: 10.0_f64.powi(power) };
        let off = cross.solve(&state).unwrap().accelerations[0] - expected;
        assert!(off.abs() < 1e-10, "k = 1e{power}: off by {off:e}");
    }
}

/// At rest, (1, −2, 1/3) + s λ (1, 1, 1) + 2 μ (1, −1, 2) + ν (3, 1, −1) = 0, whatever the units of the first plane are.
#[test]
fn a_short_row_beside_dependent_ones_has_its_multiplier() {
    for s in [1.0, 1e-4, 1e-8, 1e-12, 1e-16, 1e-100, 1e4, 1e8, 1e12, 1e16, 1e100] {
        let solution = Corner { s, k: 2.0 }.solve(&State::at_rest([0.0; 3])).expect("a solution");
        let [plane, steep, again, third]: [f64; 4] = solution.multipliers.into();
        for (found, expected) in
            [(plane * s, 41.0 / 30.0), (steep, -8.0 / 15.0), (again, -8.0 / 15.0), (third, -13.0 / 30.0)]
        {
            assert!((found - expected).abs() < 1e-13, "{s}: {found} for {expected}, {solution:?}");
        }
    }
}
