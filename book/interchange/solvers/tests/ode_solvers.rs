//! A double pendulum under `ode_solvers`.

use lagrange_core::prelude::*;
use ode_solvers::{SVector, System};

#[derive(Lagrangian)]
#[coordinates(theta, phi)]
#[define(first = [l*sin(theta), -l*cos(theta)])]
#[define(second = first + [l*sin(phi), -l*cos(phi)])]
#[lagrangian(m/2*(dot(der(first), der(first)) + dot(der(second), der(second))) - m*g*(first[1] + second[1]))]
struct Double {
    m: f64,
    g: f64,
    l: f64,
}

/// Coordinates, then velocities.
type Phase = SVector<f64, 4>;

impl System<f64, Phase> for Double {
    fn system(&self, t: f64, y: &Phase, dy: &mut Phase) {
        let state = State::new([y[0], y[1]], [y[2], y[3]]).at_time(t);
        let accelerations = self.accelerations_unchecked(&state).accelerations;
        *dy = Phase::new(y[2], y[3], accelerations[0], accelerations[1]);
    }
}

#[test]
fn another_solver_finds_the_same_motion() {
    let start = State::at_rest([2.0, 1.0]);
    let double = || Double { m: 1.0, g: 9.81, l: 0.5 };
    let path_of_ours = double();
    let ours = path_of_ours.integrate(start, 2.0, Dop853::with_tolerance(1e-12)).expect("a motion");

    let y = Phase::new(2.0, 1.0, 0.0, 0.0);
    let mut theirs = ode_solvers::Dop853::new(double(), 0.0, 2.0, 0.01, y, 1e-12, 1e-12);
    theirs.integrate().expect("a motion");
    let end = theirs.y_out().last().expect("a step");
    assert!((end[0] - ours.end().state().q[0]).abs() < 1e-8);
    assert!((end[3] - ours.end().state().v[1]).abs() < 1e-7);
}
