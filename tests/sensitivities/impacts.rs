//! Further impacts and events.

use lagrange_core::nalgebra::DMatrix;
use lagrange_core::{Dual, prelude::*};
use lagrange_systems::{Flying, HenonHeiles, Pendulum, Touching};

use crate::differences::compare_columns;
use crate::event_differences::{block, values};
use crate::events::method;

/// A bob on a rod with a knife, and a stop that moves against its turning.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, th, u)]
#[lagrangian(x_dot^2/2 + 2*y_dot^2 + th_dot^2/2 + u_dot^2/2 + x*y_dot*u_dot/4 - g*x)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[constraint(knife: x_dot*sin(th) = y_dot*cos(th) + th_dot)]
struct Turning {
    l: f64,
    g: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, th, u)]
#[lagrangian(x_dot^2/2 + 2*y_dot^2 + th_dot^2/2 + u_dot^2/2 + x*y_dot*u_dot/4 - g*x)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[constraint(knife: x_dot*sin(th) = y_dot*cos(th) + th_dot)]
#[constraint(stop: th + x^2/4 + u/3 = s - w*t)]
struct Stopped {
    l: f64,
    g: f64,
    s: f64,
    w: f64,
}

/// To the impact, where the rod and the knife hold on, and after it.
#[test]
fn an_impact_on_constraints_of_both_kinds() {
    const NAMES: [&str; 4] = ["x", "l", "w", "e"];
    let (given, start) = ([1.0, 0.1, 0.5], State::new([0.6, 0.8, 0.2, 0.1], [1.2, -0.8, 1.5, 1.0]));
    let start = Turning { l: given[0], g: 3.0 }.make_consistent(&start).unwrap().0;
    let run = |start: State<f64, 4>, [l, w, e]: [f64; 3]| {
        let (g, s) = (3.0, 0.6);
        let (turning, stopped) = (Turning { l, g }, Stopped { l, g, s, w });
        let start = turning.make_consistent(&start).unwrap().0;
        let hits = turning.differentiable_event("hits", |at| {
            let ([x, _, th, u], moved) = (at.state().q.into(), at.number("w", w) * at.time());
            th + x * x * Dual::constant(0.25) + u / Dual::constant(3.0) + moved - Dual::constant(s)
        });
        let at = turning.sensitivity(&start, &NAMES[..2]).unwrap().with(&NAMES[2..]).unwrap();
        let turn =
            turning.motion_with_derivatives(&at).by(method()).event(hits.rising().terminal()).towards(10.0);
        let hit = stopped
            .impact_sensitivity(turn.unwrap().derivatives_at_end().unwrap(), "stop", ("e", e))
            .unwrap();
        let after = turning.motion_with_derivatives(&hit).by(method()).towards(1.2).unwrap();
        (hit, after.derivatives_at_end().unwrap().clone())
    };
    let (hit, end) = run(start, given);
    assert!(hit.state.t > 0.1 && hit.state.t < 1.0, "{}", hit.state.t);
    compare_columns("a knife on a rod that is stopped", &block(&[&hit, &end]), |j, change| {
        let (mut start, mut given) = (start, given);
        match j {
            0 => start.q[0] += change,
            j => given[j - 1] += change,
        }
        let (hit, end) = run(start, given);
        values(&[&hit.state, &end.state])
    });
}

/// The map from one crossing of x = 0 to the next, at one energy, keeps areas of (y, ẏ).
#[test]
fn a_poincare_map_keeps_areas() {
    let state = State::new([0.0, 0.1], [0.35, 0.1]);
    let start = HenonHeiles.sensitivity(&state, &["y", "y_dot", "x_dot"]).unwrap();
    let mut section = HenonHeiles.differentiable_event("section", |s| s.state().q[0]).rising().terminal_at(5);
    let method = Dop853::with_tolerance(1e-13);
    let motion =
        HenonHeiles.motion_with_derivatives(&start).by(method).event(&mut section).towards(1e3).unwrap();
    let end = motion.derivatives_at_end().unwrap();
    assert_eq!(motion.crossings().len(), 5);
    assert!(end.q.row(0).amax() < 1e-14 && end.t.amin() > 1e-3, "{end:?}");
    // At x = 0 the energy is (ẋ² + ẏ² + y²)/2 − y³/3: with y and ẏ changes ẋ.
    let by_x_dot = [-(0.1 - 0.01) / 0.35, -0.1 / 0.35];
    let at = |row: &DMatrix<f64>, j: usize| row[(1, j)] + row[(1, 2)] * by_x_dot[j];
    let area = at(&end.q, 0) * at(&end.v, 1) - at(&end.q, 1) * at(&end.v, 0);
    assert!((area - 1.0).abs() < 1e-10, "{area}");
}

/// There and back again: a bounce undoes itself where time goes back.
#[test]
fn an_elastic_bounce_backwards() {
    let (ball, floor) = (Flying { m: 1.0, g: 9.81 }, Touching { m: 1.0, g: 9.81 });
    let mut lands = ball.differentiable_event("lands", |s| s.coordinate("y")).terminal();
    let start = ball.sensitivity(&State::new([0.0, 1.0], [1.0, 0.5]), &["x", "y", "x_dot", "y_dot"]).unwrap();
    let mut at = start.clone();
    for time in [10.0, 0.7, -10.0, 0.0_f64] {
        let flight = ball.motion_with_derivatives(&at).by(method()).event(&mut lands).towards(time).unwrap();
        at = flight.derivatives_at_end().unwrap().clone();
        if time.abs() == 10.0 {
            assert!(at.state.q[1].abs() < 1e-15 && at.t[1].abs() > 1e-2);
            at = floor.impact_sensitivity(&at, "floor", ("e", 1.0)).unwrap();
        }
    }
    assert!((&at.q - &start.q).amax() < 1e-13 && (&at.v - &start.v).amax() < 1e-12, "{at:?}");
}

/// A pendulum swings, its string is cut at an angle, and the bob flies until it lands: from one coordinate to two.
#[test]
fn a_reset_to_other_coordinates() {
    let run = |[theta, l, g, cut, speed]: [f64; 5]| {
        let (swinging, flying) = (Pendulum { m: 0.2, l, g }, Flying { m: 0.2, g });
        let cuts =
            swinging.differentiable_event("cut", |s| Ok(s.coordinate("theta")? - s.number("cut", cut)));
        let mut cuts = cuts.rising().terminal();
        let lands = flying.differentiable_event("lands", |s| Ok(s.coordinate("y")? + Dual::constant(3.0)));
        let mut lands = lands.falling().terminal();
        let at = swinging.sensitivity(&State::at_rest([theta]), &["theta", "l", "g"]).unwrap();
        let at = at.with(&["cut", "speed"]).unwrap();
        let swing =
            swinging.motion_with_derivatives(&at).by(method()).event(&mut cuts).towards(10.0).unwrap();
        let thrown = swinging.push_forward(swing.derivatives_at_end().unwrap(), |s| {
            let (l, theta, rate) = (s.parameter("l")?, s.coordinate("theta")?, s.velocity("theta")?);
            let (sin, cos) = theta.sin_cos();
            // Thrown a little faster the later it is.
            let up = l * sin * rate + s.number("speed", speed) * s.time();
            Ok([[l * sin, -l * cos], [l * cos * rate, up]])
        });
        let flight =
            flying.motion_with_derivatives(&thrown.unwrap()).by(method()).event(&mut lands).towards(10.0);
        flight.unwrap().derivatives_at_end().unwrap().clone()
    };
    let given = [-1.0, 1.5, 9.81, 0.7, 0.4];
    compare_columns("a cut pendulum", &block(&[&run(given)]), |j, change| {
        let mut given = given;
        given[j] += change;
        values(&[&run(given).state])
    });
}

/// As far as single precision goes.
#[test]
fn a_bounce_in_single_precision() {
    let (ball, floor) = (Flying { m: 1.0_f32, g: 9.81 }, Touching { m: 1.0_f32, g: 9.81 });
    let mut lands = ball.differentiable_event("lands", |s| s.coordinate("y")).falling().terminal();
    let start = ball.sensitivity(&State::at_rest([0.0, 1.0]), &["y", "g"]).unwrap().with(&["e"]).unwrap();
    let method = Dop853::with_tolerance(1e-6);
    let fall = ball.motion_with_derivatives(&start).by(method).event(&mut lands).towards(10.0).unwrap();
    let bounce = floor.impact_sensitivity(fall.derivatives_at_end().unwrap(), "floor", ("e", 0.8)).unwrap();
    let flight = ball.motion_with_derivatives(&bounce).by(method).towards(0.6).unwrap();
    let (v, fall) = (19.62_f32.sqrt(), (2.0_f32 / 9.81).sqrt());
    assert!((flight.derivative(0.6, "y", "e").unwrap() - v * (0.6 - fall)).abs() < 1e-5);
}
