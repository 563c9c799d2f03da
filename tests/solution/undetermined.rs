//! Where the equations determine no acceleration, or contradict one another, no function gives a number.

use lagrange_core::prelude::*;
use lagrange_core::{Motion, SolutionOf, nalgebra::Const, runge_kutta_step};

/// In polar coordinates nothing determines the angle at the pole.
#[derive(Clone, Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(r_dot^2/2 + r^2*phi_dot^2/2 - r^2/2 + torque*phi)]
struct Polar {
    torque: f64,
}

/// Two walls that part: the particle cannot stay on both.
#[derive(Clone, Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(r_dot^2/2 + phi_dot^2/2 - phi*torque)]
#[constraint(wall: phi = 0)]
#[constraint(moving: phi + phi*r = push*t^2)]
struct Walls {
    torque: f64,
    push: f64,
}

/// What each function answers: whether it gives numbers, all of them finite.
fn answers<L>(system: &L, state: State<f64, 2>) -> Vec<(&'static str, bool)>
where
    L: Linearized<N = Const<2>, Scalar = f64> + Clone,
{
    let is_known = |s: &SolutionOf<L>| s.accelerations.iter().chain(&s.multipliers).all(|x| x.is_finite());
    let solved = |s: SolutionOf<L>| is_known(&s);
    let phase = system.phase_state(&state);
    let (h, gamma) = (system.forcing(&state), system.constraint_bias(&state));
    let stepped = runge_kutta_step(system, &state, 0.01);
    vec![
        ("solve", system.solve(&state).is_ok_and(solved)),
        ("accelerations_unchecked", solved(system.accelerations_unchecked(&state))),
        ("solve_with", solved(system.solve_with(&system.factor(&state), &h, &gamma))),
        ("jacobian", system.jacobian(&state).is_ok()),
        ("state_jacobian", system.state_jacobian(&state).is_ok()),
        ("jacobian_by", system.jacobian_by(&state, &["torque"]).is_ok()),
        ("linearize", system.linearize(&state, &["torque"]).is_ok()),
        ("equilibrium", system.equilibrium(&state, &[]).is_ok()),
        ("hamilton_equations", system.hamilton_equations(&phase).is_ok()),
        ("runge_kutta_step", stepped.q.iter().chain(&stepped.v).all(|x| x.is_finite())),
        ("integrate", system.integrate(state, 1.0, Dop853::default()).is_ok()),
        ("motion", system.motion_in_momenta(phase).to(1.0).is_ok()),
        ("Motion", Motion::new(system, state, Dop853::default()).is_ok()),
    ]
}

fn assert_all(answers: Vec<(&'static str, bool)>, known: bool) {
    let others: Vec<_> = answers.iter().filter(|(_, is_known)| *is_known != known).collect();
    assert!(others.is_empty(), "the others give {}: {others:?}", if known { "numbers" } else { "none" });
}

#[test]
fn what_nothing_determines_is_no_number() {
    let polar = Polar { torque: 0.1 };
    let at = |r| State::new([r, 0.1], [0.0, 0.0]);
    assert_all(answers(&polar, at(0.0)), false);
    // The velocity of the angle cannot be had from its momentum either.
    let phase = polar.phase_state(&State::new([0.0, 0.1], [0.1, 0.2]));
    assert!(polar.legendre(&phase).is_err() && polar.hamiltonian(&phase).is_err());
    // Elsewhere all is known, but that a torque turns it.
    let elsewhere = answers(&polar, at(1.0)).into_iter().filter(|(name, _)| *name != "equilibrium").collect();
    assert_all(elsewhere, true);
}

#[test]
fn what_contradicts_itself_is_no_number() {
    let state = State::at_rest([0.3, 0.0]);
    assert_all(answers(&Walls { torque: 1.0, push: 1.0 }, state), false);
    // Without the contradiction the constraints are dependent still: the checked functions know, the others do not.
    let both = answers(&Walls { torque: 1.0, push: 0.0 }, state);
    let unchecked = ["accelerations_unchecked", "solve_with", "runge_kutta_step"];
    let (unchecked, checked) = both.into_iter().partition(|(name, _)| unchecked.contains(name));
    assert_all(checked, true);
    assert_all(unchecked, false);
}
