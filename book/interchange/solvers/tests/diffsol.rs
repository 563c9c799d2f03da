//! A stiff system under `diffsol`: its implicit solver takes the exact Jacobian from here.

use diffsol::{MatrixCommon, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};
use lagrange_core::StateDerivatives;
use lagrange_core::prelude::*;

/// A pendulum in honey.
#[derive(Lagrangian)]
#[coordinates(theta)]
#[lagrangian(l^2/2 * theta_dot^2 + g*l*cos(theta))]
#[dissipation(c/2 * theta_dot^2)]
struct Slow {
    g: f64,
    l: f64,
    c: f64,
}

fn state(y: &[f64], t: f64) -> State<f64, 1> {
    State::new([y[0]], [y[1]]).at_time(t)
}

#[test]
fn an_implicit_solver_takes_long_steps() {
    let slow = Slow { g: 9.81, l: 1.0, c: 1e6 };
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(1e-8)
        .atol([1e-10])
        .rhs_implicit(
            |y, _, t, dy| {
                dy[0] = y[1];
                dy[1] = slow.accelerations_unchecked(&state(y, t)).accelerations[0];
            },
            // The Jacobian times a vector.
            |y, _, t, along, dy| {
                let jacobian = slow.state_jacobian(&state(y, t)).expect("derivatives").accelerations;
                dy[0] = along[1];
                dy[1] = jacobian.q[(0, 0)] * along[0] + jacobian.v[(0, 0)] * along[1];
            },
        )
        .init(|_, _, y| y.copy_from_slice(&[1.0, 0.0]), 2)
        .build()
        .expect("a problem");
    let mut solver = problem.bdf::<NalgebraLU<f64>>().expect("a solver");
    let (states, times, _) = solver.solve(1e5).expect("a motion");

    // It creeps, c θ̇ = −g l sin θ: tan(θ/2) falls as exp(−g l t/c).
    let law = 2.0 * (0.5_f64.tan() * (-9.81 * 1e5 / 1e6_f64).exp()).atan();
    let end = states[(0, states.ncols() - 1)];
    assert!((end - law).abs() < 1e-5, "{end} {law}");
    assert!(times.len() < 500, "{} steps", times.len());
}
