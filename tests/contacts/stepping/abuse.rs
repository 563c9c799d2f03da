//! Settings, states and systems that have no motion: an error says why.

use lagrange_core::contact::MoreauJean;
use lagrange_core::{Ending, prelude::*};
use lagrange_systems::{Block, Slot};

fn block() -> Block<f64> {
    Block { m: 1.0, g: 9.81, e: 0.5, mu: 0.3, ..Block::default() }
}

fn start() -> State<f64, 2> {
    State::new([0.0, 1.0], [0.5, 0.0])
}

#[track_caller]
fn fails(system: &Block<f64>, start: State<f64, 2>, scheme: MoreauJean, end: f64) -> Error {
    match system.motion(start).by_time_stepping(scheme).to(end) {
        Ok(path) => panic!("{path}"),
        Err(error) => error,
    }
}

#[test]
fn wrong_settings_are_errors() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = fails(&block(), start(), MoreauJean::with_step(value), 1.0);
        assert!(matches!(error, Error::Setting { name: "step", .. }), "{error}");
        let error = fails(&block(), start(), MoreauJean::with_step(0.1).tolerance(value), 1.0);
        assert!(matches!(error, Error::Setting { name: "tolerance", .. }), "{error}");
    }
    let error = fails(&block(), start(), MoreauJean::with_step(0.1).max_iterations(0), 1.0);
    assert!(matches!(error, Error::Setting { name: "largest number of iterations", .. }), "{error}");
    for theta in [0.4, 1.1, f64::NAN] {
        let error = fails(&block(), start(), MoreauJean::with_step(0.1).theta(theta), 1.0);
        assert!(matches!(error, Error::Theta { .. }), "{error}");
        assert_eq!(
            error.to_string(),
            format!("the part θ of a time step is {theta}: it must be from 0.5 to 1")
        );
    }
    let backwards = fails(&block(), start(), MoreauJean::with_step(0.1), -1.0);
    assert!(matches!(backwards, Error::MotionBackwards { .. }), "{backwards}");
    assert!(matches!(
        fails(&block(), start(), MoreauJean::with_step(0.1), f64::NAN),
        Error::EndNotFinite { .. }
    ));
}

#[test]
fn numbers_that_are_none_are_named() {
    let step = MoreauJean::with_step(0.01);
    let error = fails(&block(), State::new([0.0, f64::NAN], [0.0; 2]), step, 1.0);
    assert!(matches!(error, Error::StateNotFinite { .. }), "{error}");
    let error = fails(&Block { g: f64::NAN, ..block() }, start(), step, 1.0);
    assert!(matches!(error, Error::ParameterNotFinite { name: "g", .. }), "{error}");
    for (system, text) in [
        (Block { e: f64::NAN, ..block() }, "restitution of `floor` is NaN"),
        (Block { mu: f64::NAN, ..block() }, "`floor_friction`"),
        (Block { mu: -0.1, ..block() }, "`floor_friction`"),
    ] {
        let error = fails(&system, start(), step, 1.0).to_string();
        assert!(error.contains(text), "{error}");
    }
    let slot = Slot { high: f64::NAN, ..Slot::default() };
    let error = slot.motion(State::at_rest([1.0])).by_time_stepping(step).to(1.0).unwrap_err().to_string();
    assert!(error.contains("`ceiling`"), "{error}");
    let below = fails(&block(), State::at_rest([0.0, -0.1]), step, 1.0);
    assert!(matches!(below, Error::Penetration { contact: "floor", .. }), "{below}");
}

/// The ceiling comes down on the ball: no impulses keep both gaps open. What was computed until then is kept.
#[test]
fn walls_that_close_in_end_the_motion_by_name() {
    let slot = Slot { g: 9.81, high: 2.0, speed: 1.0, ..Slot::default() };
    let step = MoreauJean::with_step(0.01);
    let path = slot.motion(State::at_rest([1.0])).by_time_stepping(step).towards(3.0).unwrap();
    let Ending::Unsolved { time, error: Error::ContactsContradict { contacts, .. } } = path.ending() else {
        panic!("{path}")
    };
    assert_eq!(contacts.to_string(), "`floor`, `ceiling`");
    assert!((time - 2.0).abs() < 0.02, "{path}");
    assert!(path.steps().count() > 195 && path.end().state().q[0].abs() < 0.02, "{path}");
    assert!(path.finished().is_err());
}

#[test]
fn limits_and_times() {
    let path = block()
        .motion(start())
        .by_time_stepping(MoreauJean::with_step(0.01).max_steps(7))
        .towards(1.0)
        .unwrap();
    assert!(matches!(path.ending(), Ending::StepLimit { steps: 7, .. }), "{path}");
    assert_eq!(path.steps().count(), 8);
    let tiny = block().motion(start()).by_time_stepping(MoreauJean::with_step(1e-300)).towards(1.0).unwrap();
    assert!(matches!(tiny.ending(), Ending::StepLimit { .. }), "{tiny}");
    let late = State { t: 1e9, ..start() };
    let late = block().motion(late).by_time_stepping(MoreauJean::with_step(1e-9)).towards(1e9 + 1.0).unwrap();
    assert!(matches!(late.ending(), Ending::TimeTooCoarse { .. }), "{late}");
    let late = State { t: 1e9, ..start() };
    let mut late = block().motion(late).by_time_stepping(MoreauJean::with_step(1e-9)).stepper().unwrap();
    let error = late.step().unwrap_err();
    assert!(
        matches!(&error, Error::Unfinished(ending) if matches!(**ending, Ending::TimeTooCoarse { .. })),
        "{error}"
    );
    // The last step is shorter.
    let path = block().motion(start()).by_time_stepping(MoreauJean::with_step(0.3)).to(1.0).unwrap();
    let times: Vec<f64> = path.steps().map(|step| step.time()).collect();
    assert_eq!(times, [0.0, 0.3, 0.6, 0.8999999999999999, 1.0]);
    let path = block().motion(start()).by_time_stepping(MoreauJean::with_step(0.1)).to(0.3).unwrap();
    assert_eq!(path.steps().count(), 4);
    assert!(path.at(0.31).is_err() && path.at(f64::NAN).is_err() && path.at(-0.1).is_err());
    let [half, one, two] = [0.15, 0.1, 0.2].map(|t| *path.at(t).unwrap().state());
    assert!(
        (half.q - (one.q + two.q) * 0.5).amax() < 1e-15 && (half.v - (one.v + two.v) * 0.5).amax() < 1e-15
    );
    assert!(path.end().multiplier("ceiling").is_err());
    let here = block().motion(start()).by_time_stepping(MoreauJean::with_step(0.1)).to(0.0).unwrap();
    assert_eq!(here.end().state(), &start());
    assert!(here.end().multiplier("floor").unwrap().is_nan());
}

#[test]
fn a_callback_cancels() {
    let block = block();
    let motion = block.motion(start()).by_time_stepping(MoreauJean::with_step(0.1));
    let motion = motion.on_progress(|progress| match progress.time > 0.45 {
        true => std::ops::ControlFlow::Break(()),
        false => std::ops::ControlFlow::Continue(()),
    });
    let path = motion.to(1.0).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }) && path.steps().count() == 6, "{path}");
}
