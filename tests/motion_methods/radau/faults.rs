//! What goes wrong ends the motion by name.

use core::ops::ControlFlow;
use std::f64::consts::FRAC_PI_2;
use std::time::Duration;

use lagrange_core::{Ending, prelude::*};

use crate::radau::off;

#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 9.81*(2*cos(a) + cos(b)))]
#[dissipation(c/2*(a_dot^2 + b_dot^2))]
struct DoublePendulum {
    c: f64,
}

#[test]
fn what_goes_wrong_is_said() {
    let (pendulum, start) = (DoublePendulum { c: 0.0 }, State::new([1.0, 0.5], [0.0, 0.3]));
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused =
            |method: Radau| matches!(pendulum.integrate(start, 1.0, method), Err(Error::Setting { .. }));
        assert!(refused(Radau::with_tolerance(wrong)) && refused(Radau::default().max_step(wrong)));
        assert!(
            refused(Radau::default().first_step(wrong))
                && refused(Radau::default().absolute_tolerance(wrong))
        );
    }
    let ending = |method| pendulum.motion(start).by(method).towards(10.0).unwrap().ending().clone();
    assert!(matches!(ending(Radau::default().max_steps(5)), Ending::StepLimit { steps: 5, .. }));
    assert!(matches!(ending(Radau::default().wall_time(Duration::ZERO)), Ending::WallTimeLimit { .. }));
    let broken = pendulum.event("broken", |sample| if sample.time() > 0.3 { f64::NAN } else { 1.0 });
    let path = pendulum.motion(start).by(Radau::default()).event(broken).towards(1.0).unwrap();
    assert!(matches!(path.ending(), Ending::EventNotFinite { .. }));
    let stop = |_| ControlFlow::Break(());
    let path = pendulum.motion(start).by(Radau::default()).on_progress(stop).towards(1.0).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }));
    // Tolerances at and below round-off come to an end, one way or the other.
    let path = pendulum.motion(start).by(Radau::with_tolerance(1e-16)).towards(1.0).unwrap();
    assert!(
        off(
            path.end().state(),
            pendulum
                .integrate(start, path.end().time(), Dop853::with_tolerance(1e-14))
                .unwrap()
                .end()
                .state()
        ) < 1e-11
    );
}

/// A root that ends, and a stone that falls on a star.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - sqrt(1 - x))]
struct Cliff;

#[derive(Clone, Lagrangian)]
#[coordinates(r)]
#[lagrangian(r_dot^2/2 + 1/r)]
struct Stone;

#[test]
fn singular_motions_end_where_they_are_singular() {
    let path = Cliff.motion(State::new([0.0], [0.5])).by(Radau::default()).towards(10.0).unwrap();
    assert!(path.ending().is_failure() && path.end().coordinate("x").unwrap() > 0.99, "{}", path.ending());
    let path = Stone.motion(State::at_rest([1.0])).by(Radau::default()).towards(10.0).unwrap();
    let fall = FRAC_PI_2 / 2.0_f64.sqrt();
    assert!(path.ending().is_failure() && (path.end().time() - fall).abs() < 1e-6, "{}", path.ending());
}

/// A force whose derivative is not finite on a whole side.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[force(x: max(x, 0)^(3/2)*sqrt(max(-x, 0)))]
struct Flat;

#[test]
fn derivatives_that_are_not_finite_end_the_motion_at_once() {
    let path = Flat.motion(State::new([0.5], [0.0])).by(Radau::default()).towards(1.0).unwrap();
    let named = path.ending().to_string();
    assert!(named.contains("derivative") && named.contains('x'), "{named}");
    assert_eq!(path.statistics().rejected, 0);
}
