//! An event, samples, contacts, derivatives, another method or a controller are added to a motion in one line: the lines that read its
//! result stay.

use lagrange_core::Sample;
use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::prelude::*;

/// A ball above a floor.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - g*y)]
#[contact(floor: y >= 0, restitution: e)]
struct Ball {
    g: f64,
    e: f64,
    floor: Contact,
}

/// The same ball without a floor.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - g*y)]
struct Stone {
    g: f64,
}

/// What a program reads of a motion to t = 1, whatever it has asked for.
macro_rules! read {
    ($path:expr) => {{
        let path = $path.expect("a motion");
        let (start, end) = (path.start(), path.end());
        assert_eq!((start.coordinate("y").unwrap(), end.time()), (2.0, 1.0));
        assert_eq!(path.system().g, 9.81);
        assert!(path.ending().is_complete() && path.statistics().accepted > 0);
        assert_eq!(path.adjustment().largest_coordinate_change(), 0.0);
        assert!(format!("{path}").contains("reached the end at t = 1"));
        let y = end.coordinate("y").unwrap();
        (y, path.crossings().len(), path.transitions().len())
    }};
}

#[test]
fn requests_are_added_in_one_line() {
    let (start, stone) = (State::at_rest([2.0]), Stone { g: 9.81 });
    let ball = Ball { g: 9.81, e: 0.5, floor: Contact::Open };
    let below = || stone.event("below", |sample| sample.state().q[0] + 1.0);
    let fallen = 2.0 - 9.81 / 2.0;
    for (found, crossings) in [
        (read!(stone.motion(start).to(1.0)), 0),
        (read!(stone.motion(start).event(below()).to(1.0)), 1),
        (read!(stone.motion(start).by(Verlet::with_step(0.01)).to(1.0)), 0),
        (read!(stone.motion(start).every(0.1).to(1.0)), 0),
        (read!(stone.motion(start).event(below()).samples_at([0.5]).to(1.0)), 1),
        (read!(stone.motion(start).controlled(0.1, |_, _| Ok::<_, Error>(())).to(1.0)), 0),
        (read!(stone.motion(start).derivatives(&["g", "y"]).unwrap().to(1.0)), 0),
        (read!(stone.motion(start).every(0.1).derivatives(&["g", "y"]).unwrap().to(1.0)), 0),
    ] {
        assert!((found.0 - fallen).abs() < 1e-9, "{found:?}");
        assert_eq!((found.1, found.2), (crossings, 0));
    }
    let falls = stone.motion(start).derivatives(&["g", "y"]).unwrap().to(1.0).unwrap();
    assert!((falls.derivative(1.0, "y", "g").unwrap() + 0.5).abs() < 1e-9);
    assert!((falls.derivatives_at_end().unwrap().q[(0, 1)] - 1.0).abs() < 1e-12);
    assert!(stone.motion(start).derivatives(&["h"]).is_err());
    // It lands at √(2 y/g) = 0.64, and leaves with half of its velocity.
    let (lands, v) = ((4.0_f64 / 9.81).sqrt(), (4.0 * 9.81_f64).sqrt() / 2.0);
    let bounced = v * (1.0 - lands) - 9.81 / 2.0 * (1.0 - lands).powi(2);
    for found in [
        read!(ball.motion(start).with_contacts().to(1.0)),
        read!(ball.motion(start).with_contacts().every(0.1).to(1.0)),
        read!(ball.motion(start).with_contacts().controlled(0.1, |_, _| Ok::<_, Error>(())).to(1.0)),
    ] {
        assert!((found.0 - bounced).abs() < 1e-9, "{found:?} {bounced}");
        assert_eq!((found.1, found.2), (0, 1));
    }
    let scheme = MoreauJean::with_step(1e-3);
    for found in [
        read!(ball.motion(start).by_time_stepping(scheme).to(1.0)),
        read!(ball.motion(start).by_time_stepping(scheme).every(0.1).to(1.0)),
    ] {
        assert!((found.0 - bounced).abs() < 1e-2, "{found:?} {bounced}");
    }
}

/// The start has the system, the contacts and the forces as they are there.
#[test]
fn samples_alone_have_the_start_as_it_was() {
    let stone = Stone { g: 9.81 };
    let heavier = |stone: &mut Stone, _: &State<f64, 1>| {
        stone.g += 1.0;
        Ok::<_, Error>(())
    };
    let steered = stone.motion(State::at_rest([2.0])).every(0.1).controlled(0.1, heavier);
    let path = steered.quantity("energy", |sample| sample.energy()).to(1.0).unwrap();
    assert_eq!(path.start().acceleration("y").unwrap(), -9.81);
    assert_eq!(Some(path.start().energy()), path.quantity("energy").unwrap().next());
    assert!((path.system().g - 19.81).abs() < 1e-12 && path.end().system().g == path.system().g);
    let ball = Ball { g: 9.81, e: 0.0, floor: Contact::Open };
    let motion = || ball.motion(State::at_rest([1.0])).with_contacts();
    let steps = || ball.motion(State::at_rest([1.0])).by_time_stepping(MoreauJean::with_step(0.01));
    let pairs = [
        (motion().to(1.0), motion().every(0.1).to(1.0)),
        (steps().to(0.2), steps().every(0.1).to(0.2)),
        (steps().to(1.0), steps().every(0.1).to(1.0)),
    ];
    for (stored, sampled) in pairs {
        let (stored, sampled) = (stored.unwrap(), sampled.unwrap());
        for (one, other) in [(stored.start(), sampled.start()), (stored.end(), sampled.end())] {
            assert_eq!(one.acceleration("y").unwrap(), other.acceleration("y").unwrap());
            assert_eq!(one.multiplier("floor").unwrap(), other.multiplier("floor").unwrap());
            assert_eq!(one.system().floor, other.system().floor);
        }
        assert_eq!(stored.system().floor, sampled.system().floor);
    }
    assert!(steps().every(0.1).to(0.0).unwrap().start().multiplier("floor").unwrap().is_nan());
}

/// Contacts that a controller opens stay closed in the system of a sample by time steps.
#[test]
fn forces_of_time_steps_do_not_depend_on_the_contacts_that_a_controller_sets() {
    let ball = Ball { g: 9.81, e: 0.0, floor: Contact::Open };
    let motion = ball.motion(State::at_rest([0.0])).by_time_stepping(MoreauJean::with_step(0.01)).every(0.1);
    let motion = motion.quantity("force", |sample| sample.constraint_force("y"));
    let path = motion.controlled(0.1, |ball, _| {
        *ball = Ball { g: 9.81, e: 0.0, floor: Contact::Open };
        Ok::<_, Error>(())
    });
    let path = path.to(0.3).unwrap();
    assert!(path.quantity("force").unwrap().skip(1).all(|force| (force - 9.81).abs() < 1e-9));
    assert!((path.end().constraint_force("y").unwrap() - 9.81).abs() < 1e-9);
}

#[test]
fn nothing_is_kept_beyond_the_end() {
    let stone = Stone { g: 9.81 };
    let below = stone.event("below", |sample| sample.state().q[0] - 1.0);
    let fails = |sample: &Sample<&Stone>| {
        if sample.time() > 0.4 { Err(Error::EndNotFinite { end: 1.0 }) } else { Ok(0.0) }
    };
    let motion = stone.motion(State::at_rest([2.0])).event(below).every(0.05).quantity("fails", fails);
    let path = motion.towards(10.0).unwrap();
    assert!(path.ending().is_failure() && path.end().time() < 0.451, "{path}");
    assert!(path.crossings().is_empty());
    let ball = Ball { g: 9.81, e: 0.5, floor: Contact::Open };
    let below = ball.event("below", |sample| sample.state().q[0] - 1.0);
    let fails = |sample: &Sample<&Ball>| match sample.time() > 0.4 {
        true => Err(Error::EndNotFinite { end: 1.0 }),
        false => Ok(0.0),
    };
    let motion = ball.motion(State::at_rest([2.0])).with_contacts().event(below).every(0.05);
    let path = motion.quantity("fails", fails).towards(10.0).unwrap();
    assert!(path.ending().is_failure() && path.end().time() < 0.451, "{path}");
    assert!(path.crossings().is_empty());
    let twice = stone.motion(State::at_rest([2.0])).every(0.1).quantity("E", |_| 1.0).quantity("E", |_| 2.0);
    assert!(matches!(twice.to(1.0), Err(Error::RepeatedName { .. })));
}

/// A multiple of the interval that rounding keeps from the end is the end.
#[test]
fn a_controller_is_not_called_a_rounding_error_before_the_end() {
    for (interval, end) in [(0.1, 0.3), (0.3, 0.9), (0.7, 2.1), (0.1, -0.3), (0.3, -0.9)] {
        let (mut calls, stone) = (0, Stone { g: 9.81 });
        let motion = stone.motion(State::at_rest([2.0])).controlled(interval, |_, _| {
            calls += 1;
            Ok::<_, Error>(())
        });
        motion.to(end).unwrap();
        assert_eq!(calls, 3, "{interval} {end}");
    }
}

/// The end of a motion by time steps that keeps samples alone has the forces of its last step, as if all steps were kept.
#[test]
fn samples_alone_have_the_forces_at_the_end() {
    let ball = Ball { g: 9.81, e: 0.0, floor: Contact::Open };
    let motion = || ball.motion(State::at_rest([0.0])).by_time_stepping(MoreauJean::with_step(0.01));
    let (stored, sampled) = (motion().to(1.0).unwrap(), motion().every(0.1).to(1.0).unwrap());
    let force = sampled.end().multiplier("floor").unwrap();
    assert!((force - 9.81).abs() < 1e-9, "{force}");
    assert_eq!(force, stored.end().multiplier("floor").unwrap());
    assert_eq!(sampled.to_string(), stored.to_string());
    let located = ball.motion(State::at_rest([0.0])).with_contacts().every(0.1).to(1.0).unwrap();
    assert_eq!(located.end().multiplier("floor").unwrap(), 9.81);
    let stored = ball.motion(State::at_rest([0.0])).with_contacts().to(1.0).unwrap();
    assert_eq!(located.to_string(), stored.to_string());
}
