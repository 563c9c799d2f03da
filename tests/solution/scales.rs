//! Units in which numbers are huge or tiny: the answer is the same motion in those units, or a named error.

use lagrange_core::{Real, generic::Solution, linearized::Stability, nalgebra::Const, prelude::*};

/// A bead on an inclined line, y = −¾ x, the constraint in units of its own.
#[derive(Lagrangian, Clone)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(line: 0.6*s*x + 0.8*s*y = 0)]
struct Bead<T> {
    m: T,
    g: T,
    s: T,
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

const DOUBLE: [f64; 13] =
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
}

#[test]
fn a_row_of_any_length_constrains_in_single_precision() {
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
            let (lambda, state) = (8.0 / (s.max(2.0 * r)), State::at_rest([0.0; 2]));
            slides(&twice, lambda.is_infinite(), 1e-13);
            if lambda.is_normal() {
                let [first, second]: [f64; 2] = twice.solve(&state).expect("a solution").multipliers.into();
                assert!(((first * s + 2.0 * second * r) / 8.0 - 1.0).abs() < 1e-13, "{first} {second}");
                // Of least norm: in proportion to the rows.
                let (first, second) = (first / lambda, second / lambda);
                let (s, r) = (s / s.max(2.0 * r), 2.0 * r / s.max(2.0 * r));
                assert!((first * r - second * s).abs() < 1e-13, "{first} {second} for {s} {r}");
            }
        }
    }
}

#[test]
fn it_moves_as_far_in_any_unit() {
    for s in DOUBLE {
        let bead = Bead { m: 1.0, g: 10.0, s };
        let path = bead.integrate(State::at_rest([0.0; 2]), 1.0, Dop853::default()).expect("a path");
        let [x, y]: [f64; 2] = path.end().state().q.into();
        assert!(path.ending().is_complete() && path.multipliers_are_unique());
        assert!((x - 2.4).abs() < 1e-12 && (y + 1.8).abs() < 1e-12, "({x}, {y}) for {s}");
        let phase = bead.phase_state(&State::at_rest([0.0; 2]));
        let path = bead.motion_in_momenta(phase).to(1.0).expect("a path");
        let [x, y]: [f64; 2] = path.end().state().q.into();
        assert!((x - 2.4).abs() < 1e-12 && (y + 1.8).abs() < 1e-12, "({x}, {y}) for {s} in (q, p)");
    }
}

#[test]
fn on_lanes_too() {
    let beads = Ensemble::from_fn(DOUBLE.len(), |k| {
        (Bead { m: 1.0, g: 10.0, s: DOUBLE[k] }, State::at_rest([0.0; 2]))
    });
    let outcome = beads.integrate_on_lanes(1.0, Dop853::default()).expect("an outcome");
    assert_eq!(outcome.completed().count(), DOUBLE.len());
    for (k, state) in outcome.completed() {
        let [x, y]: [f64; 2] = state.q.into();
        assert!((x - 2.4).abs() < 1e-12 && (y + 1.8).abs() < 1e-12, "({x}, {y}) for {}", DOUBLE[k]);
    }
}

/// A pendulum with a rod: M = m, rows of the length l, λ in m g / l, in units of length and mass.
#[derive(Lagrangian, Clone)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
struct Rod<T> {
    m: T,
    g: T,
    l: T,
}

/// The pendulum with an angle: M = m l².
#[derive(Lagrangian, Clone)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2*theta_dot^2 + m*g*l*cos(theta))]
struct Swing<T> {
    m: T,
    g: T,
    l: T,
}

#[test]
fn a_pendulum_swings_alike_in_any_unit_or_is_refused() {
    let along = |state: &State<f64, 2>, unit: f64| state.q[0] / unit;
    let reference = Rod { m: 1.0, g: 10.0, l: 1.0 };
    let path = reference.integrate(State::at_rest([0.6, -0.8]), 1.0, Dop853::default()).expect("a path");
    let expected = along(path.end().state(), 1.0);
    let (mut refused, mut swung) = (0, 0);
    for unit in [1e-150, 1e-100, 1e-8, 1e8, 1e100, 1e150, 1e165, 1e200] {
        for m in [1e-200, 1.0, 1e200] {
            // What the Lagrangian itself loses nobody can see.
            if m * unit * unit < f64::MIN_POSITIVE {
                continue;
            }
            let rod = Rod { m, g: 10.0 * unit, l: unit };
            let start = State::at_rest([0.6 * unit, -0.8 * unit]);
            let Ok(path) = rod.integrate(start, 1.0, Dop853::default().absolute_tolerance(1e-9 * unit))
            else {
                refused += 1;
                continue;
            };
            assert!(path.ending().is_complete(), "{}", path.ending());
            let arrived = along(path.end().state(), unit);
            assert!(
                (arrived - expected).abs() < 1e-7,
                "{arrived} for {expected} in units of {unit}, m = {m}"
            );
            swung += 1;
        }
    }
    // l² is no number for the two largest, nor m g for the next and the largest mass.
    assert_eq!((refused, swung), (7, 15));
}

#[test]
fn a_mass_matrix_that_is_no_number_is_refused() {
    for (m, l) in [(1e200, 1e60), (1e-200, 1e-70), (1e-320, 1.0), (1.0, 1e-160)] {
        let swing = Swing { m, g: 10.0 * l, l };
        match swing.solve(&State::at_rest([0.5])) {
            Ok(solution) => {
                let expected = -10.0 * 0.5_f64.sin();
                assert!((solution.accelerations[0] / expected - 1.0).abs() < 1e-12, "{solution:?}");
            }
            Err(error) => {
                assert!(
                    matches!(error, Error::EquationsNotFinite { .. } | Error::Singular { .. }),
                    "{error}"
                );
            }
        }
    }
}

/// A sphere that rolls down an incline.
#[derive(Lagrangian, Clone)]
#[coordinates(x, phi)]
#[lagrangian(m/2*x_dot^2 + m*a^2/5*phi_dot^2 + m*g*x)]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
struct Sphere {
    m: f64,
    a: f64,
    g: f64,
}

#[test]
fn a_sphere_rolls_as_fast_whatever_its_radius_or_is_refused() {
    for a in [1e-170, 1e-160, 1e-150, 1e-100, 1.0, 1e100, 1e150, 1e160, 1e170] {
        match (Sphere { m: 1.0, a, g: 7.0 }).solve(&State::at_rest([0.0; 2])) {
            Ok(solution) => {
                let x = solution.accelerations[0];
                assert!((x - 5.0).abs() < 1e-13, "{x} for {a}");
            }
            Err(error) => {
                assert!(
                    matches!(error, Error::EquationsNotFinite { .. } | Error::Singular { .. }),
                    "{error}"
                );
                assert!(!(1e-150..=1e150).contains(&a), "{a}: {error}");
            }
        }
    }
}

/// A weight on a spring of which the length without it is far away.
#[derive(Lagrangian, Clone)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*(x - far)^2 + m*g*x)]
struct Spring {
    m: f64,
    g: f64,
    k: f64,
    far: f64,
}

/// At 10¹⁶ an angle is known to ±1: whatever stands there is no equilibrium. A length may be as large.
#[test]
fn an_equilibrium_is_where_the_forces_vanish() {
    let swing = Swing { m: 1.0, g: 9.81, l: 1.0 };
    for guess in [0.1, 3.0, 1e3, 1e6, 1e9, 1e12, 1e14, 1e16, 1e200] {
        match swing.equilibrium(&State::at_rest([guess]), &[]) {
            Ok(found) => {
                assert!(guess < 1e10, "{found:?}");
                let acceleration = swing.solve(&found.state).expect("a solution").accelerations[0];
                assert!(acceleration.abs() < 1e-15 * guess.max(1.0), "{acceleration} at {found:?}");
            }
            Err(error) => {
                assert!(guess > 1e7 && matches!(error, Error::NoEquilibrium { .. }), "{error}");
            }
        }
    }
    for far in [0.0, 1.0, 1e9, 1e16, 1e100] {
        for guess in [0.0, far, 1.1 * far] {
            let spring = Spring { m: 1.0, g: 9.81, k: 0.3, far };
            let found = spring.equilibrium(&State::at_rest([guess]), &[]).expect("an equilibrium");
            let expected = far + 9.81 / 0.3;
            assert!((found.state.q[0] / expected - 1.0).abs() < 1e-14, "{found:?}, not {expected}");
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

/// Two oscillators, coupled, the second in a unit of length of its own.
#[derive(Lagrangian, Clone)]
#[coordinates(x, y)]
#[lagrangian(x_dot^2/2 + u^2*y_dot^2/2 - w^2*(3*x^2 + 3*(u*y)^2 - 2*x*u*y)/2)]
#[dissipation(c*(x_dot^2 + u^2*y_dot^2)/2)]
struct Pair {
    w: f64,
    u: f64,
    c: f64,
}

/// The frequencies are w √2 and 2 w: slow, fast, and in any unit of length.
#[test]
fn frequencies_and_stability_do_not_depend_on_units() {
    let mut tried = 0;
    for w in [1e-140, 1e-120, 1e-80, 1e-3, 1.0, 1e5, 1e80, 1e120, 1e140] {
        for u in [1e-140, 1e-20, 1e-5, 1.0, 1e5, 1e20, 1e140] {
            // What an entry of the matrices themselves loses nobody can see.
            let entries = [u * u, w * w, w * w * u * u, w * w * u, w * w / u];
            if !entries.iter().all(|entry| (1e-290..1e290).contains(entry)) {
                continue;
            }
            tried += 1;
            let near = |c| Pair { w, u, c }.linearize(&State::at_rest([0.0; 2]), &[]).expect("linear");
            let still = near(0.0);
            let found = still.natural_frequencies().expect("frequencies");
            assert!(found.len() == 2, "{found:?} for {w:e} {u:e}");
            for (frequency, expected) in found.iter().zip([2.0_f64.sqrt(), 2.0]) {
                assert!((frequency / w / expected - 1.0).abs() < 1e-12, "{found:?} for {w:e} {u:e}");
            }
            assert_eq!(still.stability().expect("decided"), Stability::Undecided, "{w:e} {u:e}");
            let damped = near(0.1 * w).stability().expect("decided");
            assert_eq!(damped, Stability::AsymptoticallyStable, "{w:e} {u:e}");
        }
    }
    assert!(tried >= 25, "{tried}");
    // Growth so fast that its square is no number.
    for c in [-1e150, -1e160, -1e200, -1e300] {
        let near = Pair { w: 1.0, u: 1.0, c }.linearize(&State::at_rest([0.0; 2]), &[]).expect("linear");
        assert_eq!(near.stability().expect("decided"), Stability::Unstable, "{c:e}");
        let [first, second, ..] = near.eigenvalues().expect("eigenvalues")[..] else { panic!("four") };
        assert!(
            (first.re / -c - 1.0).abs() < 1e-14 && (second.re / -c - 1.0).abs() < 1e-14,
            "{first} {second}"
        );
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
