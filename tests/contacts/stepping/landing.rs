//! A body whose contact moves along a curve after it has landed: its impulses are forces times the step.

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

/// A rod whose lower end lands on the floor; then it tips over.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(foot = [x - l/2*sin(theta), y - l/2*cos(theta)])]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*l^2/24 * theta_dot^2 - m*g*y)]
#[contact(floor: foot[1] >= 0, friction(static: mu, kinetic: nu): der(foot)[0])]
struct Tipping {
    m: f64,
    l: f64,
    g: f64,
    mu: f64,
    nu: f64,
    floor: Contact,
}

#[test]
fn impulses_after_a_landing_are_forces_and_the_error_falls_with_the_step() {
    let rod = Tipping { m: 1.0, l: 1.0, g: 9.81, mu: 0.8, nu: 0.4, floor: Contact::Open };
    let start = State::new([0.0, 0.5 * 0.2_f64.cos() + 0.05, 0.2], [0.0, 0.0, 1.5]);
    let exact = rod.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(0.5).unwrap();
    let push = exact.at(0.25).unwrap().multiplier("floor").unwrap();
    let errors = [0.5, 0.6, 1.0].map(|theta| {
        [1e-3, 1e-4].map(|h| {
            let scheme = MoreauJean::with_step(h).theta(theta);
            let path = rod.motion(start).by_time_stepping(scheme).to(0.5).unwrap();
            for step in path.steps().skip_while(|step| step.time() <= 0.25).take(4) {
                let found = step.multiplier("floor").unwrap();
                assert!((found - push).abs() < 40.0 * h * push, "{theta} {h}: {found} for {push}");
            }
            (path.end().state().q - exact.end().state().q).amax()
        })
    });
    assert!(errors.iter().all(|[long, short]| *long < 3e-3 && *short < 3e-4), "{errors:?}");
}
