//! Where the Legendre transform has no solution, or several.

use lagrange_core::prelude::*;
use lagrange_systems::PolarPendulum;

fn message<T: std::fmt::Debug>(result: Result<T, Error>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn a_coordinate_without_inertia_is_named() {
    #[derive(Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2 * x_dot^2 + n/2 * y_dot^2 - x*y^2/2)]
    struct Massless {
        m: f64,
        n: f64,
    }
    let error = Massless { m: 1.0, n: 0.0 }.legendre(&PhaseState::new([1.0, 1.0], [0.5, 0.0])).unwrap_err();
    assert!(
        matches!(error, Error::VelocityUndetermined { coordinates, .. } if coordinates.as_slice() == ["y"])
    );
    assert!(error.to_string().starts_with("the momenta do not determine the velocity of `y` at t = 0"));
}

/// The same coordinate with a constraint that makes up for its mass.
#[test]
fn a_constraint_makes_up_for_a_mass() {
    #[derive(Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m/2 * x_dot^2 - y^2/2)]
    #[constraint(gear: y = 3*x)]
    struct Geared {
        m: f64,
    }
    let system = Geared { m: 2.0 };
    let state = system.legendre(&PhaseState::new([1.0, 3.0], [0.5, 0.0])).unwrap();
    assert!((state.v[0] - 0.25).abs() < 1e-15 && (state.v[1] - 0.75).abs() < 1e-15);
    // p_y moves along the constraint too: (p_x + 3 p_y)/m.
    let state = system.legendre(&PhaseState::new([1.0, 3.0], [0.5, 0.1])).unwrap();
    assert!((state.v[0] - 0.4).abs() < 1e-15 && (state.v[1] - 1.2).abs() < 1e-15);
}

/// p = q̇/√(1 + q̇²) is never more than 1.
#[test]
fn momenta_that_no_velocity_has_are_refused() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(sqrt(1 + x_dot^2))]
    struct Bounded;
    assert!((Bounded.legendre(&PhaseState::new([0.0], [0.6])).unwrap().v[0] - 0.75).abs() < 1e-15);
    let text = message(Bounded.legendre(&PhaseState::new([0.0], [2.0])));
    assert!(
        text.starts_with("no velocity found with the momenta given at t = 0: that of `x` is off"),
        "{text}"
    );
    assert!(text.contains("legendre_near"), "{text}");
}

/// p = q̇³ − q̇ has three velocities for small p; the search finds the one that it starts near.
#[test]
fn of_several_velocities_the_nearest_is_found() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^4/4 - x_dot^2/2)]
    struct Quartic;
    let phase = PhaseState::new([0.0], [0.1]);
    for guess in [-1.0, 0.0, 1.0] {
        let v = Quartic.legendre_near(&phase, &[guess].into()).unwrap().v[0];
        assert!((v.powi(3) - v - 0.1).abs() < 1e-15 && (v - guess).abs() < 0.2, "{v} near {guess}");
    }
    // p is stationary at 1/√3: nothing leads on from there.
    let error = Quartic.legendre_near(&phase, &[1.0 / 3.0_f64.sqrt()].into()).unwrap_err();
    assert!(matches!(error, Error::MomentumNotReached { coordinate: "x", iterations: 0, .. }), "{error:?}");
}

/// In a wind w = 0.2 t − 1.1 the momentum of u = q̇ − w is u³ − u, constant, and so is u. It starts with u = 1.1, the one
/// that the search from rest finds then; later that search would find another, but the motion does not jump.
#[test]
fn a_motion_stays_on_its_branch() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[define(u = x_dot - t/5 + 11/10)]
    #[lagrangian(u^4/4 - u^2/2)]
    struct Wind;
    let u = 1.1_f64;
    let phase = PhaseState::new([0.0], [u.powi(3) - u]);
    let path = Wind.motion_in_momenta(phase).by(Dop853::default().max_step(0.5)).to(10.0).unwrap();
    for sample in path.samples(101) {
        let t = sample.time();
        assert!((sample.state().q[0] - (u - 1.1) * t - 0.1 * t * t).abs() < 1e-12);
        assert!((sample.state().v[0] - (u - 1.1) - 0.2 * t).abs() < 1e-12);
    }
    assert!((Wind.legendre(&phase.at_time(5.5)).unwrap().v[0] - u).abs() > 0.1);
}

/// p = q̇³ says nothing about the change of the velocity at rest.
#[test]
fn where_the_search_cannot_start_at_rest_it_starts_elsewhere() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^4/4)]
    struct Cubic;
    let phase = PhaseState::new([0.0], [8.0]);
    assert!(matches!(Cubic.legendre(&phase), Err(Error::VelocityUndetermined { .. })));
    assert!((Cubic.legendre_near(&phase, &[0.1].into()).unwrap().v[0] - 2.0).abs() < 1e-15);
}

#[test]
fn entries_that_are_no_numbers_are_named() {
    let pendulum = PolarPendulum { m: 1.0, g: 9.81, l: 1.0 };
    let text = message(pendulum.hamiltonian(&PhaseState::new([0.0, 0.0], [0.0, f64::NAN])));
    assert_eq!(text, "`p(phi)` is NaN in the state given: every entry must be finite");
    let start = PhaseState::new([f64::INFINITY, 0.0], [0.0, 0.0]);
    let text = message(pendulum.motion_in_momenta(start).to(1.0));
    assert_eq!(text, "`theta` is inf in the state given: every entry must be finite");
}

/// One coordinate with a large momentum beside one whose momentum grows with the cube of its velocity.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*x_dot^2 + y_dot^2/2 + y_dot^4/12)]
struct Beside {
    m: f64,
}

/// The round-off of one momentum is no excuse for another: p_y = v + v³/3 to its own.
#[test]
fn a_large_momentum_hides_no_small_one() {
    for (mass, large) in [(1.0, 1e12), (1e-6, 1e9), (1e10, 1e17), (1.0, 1.0)] {
        let velocity = Beside { m: mass }.legendre(&PhaseState::new([0.0; 2], [large, 10.0])).unwrap().v;
        // v³ + 3 v = 30, by Cardano.
        let expected = 2.0 * (15.0_f64.asinh() / 3.0).sinh();
        assert!((velocity[0] * mass / large - 1.0).abs() < 1e-15, "{velocity:?}");
        let found = velocity[1];
        assert!((found / expected - 1.0).abs() < 1e-15, "beside {large:e}: {found} for {expected}");
    }
}
