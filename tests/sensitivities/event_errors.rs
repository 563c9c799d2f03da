//! Events without a derivative, and what is wrong with what is asked for.

use lagrange_core::{Dual, Ending, prelude::*};
use lagrange_systems::{Flying, Touching};

use crate::events::method;

#[test]
fn what_grazes_has_no_derivative() {
    let (ball, start) = (Flying { m: 1.0, g: 1.0 }, State::new([0.0, 0.0], [0.0, 1.0]));
    let start = ball.sensitivity(&start, &["y_dot"]).unwrap();
    let method = Dop853::default().fixed_step(0.25);
    // One that touches zero at t = 1, and one that is flat where it crosses.
    let mut touches = ball.differentiable_event("touches", |s| {
        let left = s.time() - Dual::constant(1.0);
        left * left
    });
    touches = touches.terminal();
    let mut flat = ball.differentiable_event("flat", |s| {
        let over = s.coordinate("y")? - Dual::constant(0.3);
        Ok(over * over * over)
    });
    flat = flat.terminal();
    let motion = ball.motion_with_derivatives(&start).by(method).event(&mut touches).towards(3.0).unwrap();
    let error = motion.derivatives_at_end().unwrap_err();
    assert_eq!(error, Error::Grazing { event: "touches", time: 1.0 });
    // The motion is there all the same, and its derivatives at given times.
    assert!((motion.derivatives_at(0.6).unwrap().q[(1, 0)] - 0.6).abs() < 1e-14);
    let motion = ball.motion_with_derivatives(&start).by(method).event(&mut flat).towards(3.0).unwrap();
    let error = motion.derivatives_at_end().unwrap_err().to_string();
    assert!(error.contains("grazes the event `flat` at t = 0.367"), "{error}");
}

/// What was computed is there, and there is no end to go on from.
#[test]
fn what_is_not_finished_is_said() {
    let (ball, floor) = (Flying { m: 1.0, g: 9.81 }, Touching { m: 1.0, g: 9.81 });
    let mut at = ball.sensitivity(&State::at_rest([0.0, 1.0]), &["y"]).unwrap();
    let mut lands = ball.differentiable_event("lands", |s| s.coordinate("y")).falling().terminal();
    let few = method().max_steps(2);
    let fall = ball.motion_with_derivatives(&at).by(few).event(&mut lands).towards(5.0).unwrap();
    assert!(
        matches!(fall.ending(), Ending::StepLimit { .. })
            && fall.derivatives_at(fall.end().time() / 2.0).is_ok()
    );
    assert!(
        fall.derivatives_at_end().unwrap_err().to_string().contains("after 2 steps")
            && fall.finished().is_err()
    );
    assert!(matches!(ball.integrate_sensitivities(at.state, 5.0, few, &["y"]), Err(Error::Unfinished(_))));
    let mut bounces = 0;
    let ending = loop {
        let flight = ball.motion_with_derivatives(&at).by(method()).event(&mut lands).towards(50.0).unwrap();
        match flight.derivatives_at_end() {
            Ok(landing) => at = floor.impact_sensitivity(landing, "floor", ("e", 0.4)).unwrap(),
            Err(_) => break flight.ending().clone(),
        }
        bounces += 1;
    };
    assert!(matches!(ending, Ending::EventsAccumulate { event: "lands", .. }) && bounces > 10, "{ending}");
}

#[test]
fn what_cannot_be_is_named() {
    let (ball, floor) = (Flying { m: 1.0, g: 1.0 }, Touching { m: 1.0, g: 1.0 });
    let state = State::new([0.0, 0.0], [0.0, -1.0]);
    let start = ball.sensitivity(&state, &["y", "g"]).unwrap();
    assert!(matches!(ball.sensitivity(&state, &["h"]), Err(Error::UnknownName { .. })));
    for taken in ["g", "y"] {
        assert_eq!(
            start.clone().with(&["e", taken]).unwrap_err(),
            Error::RepeatedName { name: taken.into() }
        );
    }
    let error = floor.impact_sensitivity(&start, "flor", ("e", 0.5)).unwrap_err();
    assert!(error.to_string().contains("did you mean `floor`?"), "{error}");
    assert!(matches!(floor.impact_sensitivity(&start, "floor", ("e", -1.0)), Err(Error::Restitution { .. })));
    let mut event = ball.differentiable_event("no", |s| s.multiplier("floor"));
    let error = ball.motion_with_derivatives(&start).by(method()).event(&mut event).towards(1.0).unwrap_err();
    assert!(error.to_string().contains("there is no constraint `floor`"), "{error}");
    // A value without a derivative.
    let mut kink = ball.differentiable_event("kink", |s| {
        let down = s.coordinate("y")?.value + 0.5;
        Ok(Dual { value: down, slope: f64::NAN })
    });
    kink = kink.terminal();
    let fall = ball.motion_with_derivatives(&start).by(method()).event(&mut kink).towards(1.0).unwrap();
    assert!(
        matches!(fall.derivatives_at_end(), Err(Error::EventNotFinite { event: "kink", .. })),
        "{:?}",
        fall.derivatives_at_end()
    );
}
