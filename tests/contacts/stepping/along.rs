//! Events, samples, controllers and progress along motions by time steps, against closed solutions.

use core::ops::ControlFlow;

use lagrange_core::contact::{Contact, MoreauJean};
use lagrange_core::{Ending, Trajectory, prelude::*};
use lagrange_systems::{Ball, Walled};

const G: f64 = 9.81;

const BALL: Ball = Ball { m: 0.2, g: G, r: 0.0, e: 0.8, thrust: 0.0, floor: Contact::Open };

fn start() -> State<f64, 2> {
    State::new([0.0, 1.0], [0.5, 0.0])
}

fn fall() -> f64 {
    (2.0 / G).sqrt()
}

/// A block that a motor pulls along a floor.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[force(x: motor)]
#[contact(floor: y - rise >= 0, friction(mu): x_dot)]
struct Cart {
    m: f64,
    g: f64,
    mu: f64,
    rise: f64,
    motor: f64,
    floor: Contact,
}

const CART: Cart = Cart { m: 2.0, g: G, mu: 0.3, rise: 0.0, motor: 0.0, floor: Contact::Closed };

/// Height and velocity are on chords, which leave the parabola by g h²/8; the velocity in free flight is exact.
#[test]
fn crossings_are_those_of_the_flight_on_chords() {
    for h in [0.03, 0.01, 0.003] {
        let half = || BALL.event("half", |sample| sample.state().q[1] - 0.5);
        let post = || BALL.event("post", |sample| sample.coordinate("x").map(|x| x - 0.2)).terminal();
        let scheme = MoreauJean::with_step(h);
        let path = BALL.motion(start()).event(half()).by_time_stepping(scheme).event(post()).to(1.0).unwrap();
        let [crossing, last] = path.crossings() else { panic!("{path}") };
        assert_eq!((crossing.event, crossing.index, crossing.count, crossing.rising), ("half", 0, 1, false));
        assert!((crossing.state.q[1] - 0.5).abs() < 1e-15, "{crossing:?}");
        let (time, speed) = ((1.0 / G).sqrt(), G.sqrt());
        assert!((crossing.state.t - time).abs() < 1.1 * G * h * h / 8.0 / speed, "{crossing:?}");
        assert!((crossing.state.v[1] + G * crossing.state.t).abs() < 1e-13, "{crossing:?}");
        // The second one ends the motion within a step.
        assert!(matches!(path.ending(), Ending::Event { event: "post", .. }), "{path}");
        assert!((last.state.t - 0.4).abs() < 1e-14 && path.end().state() == &last.state);
        assert_eq!(path.end().multiplier("floor").unwrap(), 0.0);
        let again = BALL.motion(start()).by_time_stepping(scheme).event(half()).event(post()).to(1.0);
        assert_eq!(again.unwrap().crossings(), path.crossings());
    }
}

/// A bounce is up to a step too early or late, with up to g h more or less of velocity.
#[test]
fn apexes_of_a_bouncing_ball_are_those_of_the_closed_solution() {
    for h in [1e-3, 1e-4] {
        let apex = BALL.event("apex", |sample| sample.state().v[1]).falling();
        let hits = BALL.event("hits", |sample| sample.state().v[1]).rising();
        let motion = BALL.motion(start()).by_time_stepping(MoreauJean::with_step(h));
        let path = motion.event(apex).event(hits).to(2.3).unwrap();
        let of = |event| path.crossings().iter().filter(move |crossing| crossing.event == event);
        // The velocity crosses zero at each impact, too.
        assert_eq!((of("apex").count(), of("hits").count()), (3, 4), "{path}");
        for (n, apex) in of("apex").enumerate() {
            let (bounces, error) = (n as i32 + 1, 2.0 * h * (n + 1) as f64);
            let height = 0.64_f64.powi(bounces);
            let time =
                fall() * (1.0 + 2.0 * 0.8 * (1.0 - 0.8_f64.powi(n as i32)) / 0.2 + 0.8_f64.powi(bounces));
            assert!((apex.state.q[1] - height).abs() < error * G * fall(), "{n}: {apex:?} {height}");
            assert!((apex.state.t - time).abs() < error, "{n}: {apex:?} {time}");
        }
        for (n, hit) in of("hits").enumerate() {
            let time = fall() * (1.0 + 2.0 * 0.8 * (1.0 - 0.8_f64.powi(n as i32)) / 0.2);
            assert!((hit.state.t - time).abs() < 2.0 * h * (n + 1) as f64, "{n}: {hit:?} {time}");
        }
    }
}

/// Samples are those of the motion that keeps all its steps, wherever they are in a step.
#[test]
fn samples_are_states_of_the_motion_without_samples() {
    for (h, every) in [(0.01, 0.05), (0.03, 0.05), (0.03, 0.007)] {
        let motion = || BALL.motion(start()).by_time_stepping(MoreauJean::with_step(h));
        let (path, sampled) = (motion().to(2.0).unwrap(), motion().every(every));
        let sampled = sampled.quantity("floor", |sample| sample.multiplier("floor")).to(2.0).unwrap();
        assert_eq!(sampled.samples().len(), (2.0 / every + 1.0) as usize);
        assert!(sampled.values()[0].is_nan() && sampled.values().iter().any(|push| *push > 0.0));
        for (state, push) in sampled.samples().iter().zip(sampled.values()).skip(1) {
            let at = path.at(state.t).unwrap();
            assert_eq!((at.state(), at.multiplier("floor").unwrap()), (state, *push));
        }
        let steps = sampled.statistics().accepted;
        assert_eq!((sampled.end().state(), steps), (path.end().state(), path.steps().count() - 1));
        for state in sampled.samples().iter().take_while(|state| state.t < fall() - h) {
            let off = state.q[1] - 1.0 + G / 2.0 * state.t * state.t;
            // Samples at the ends of steps are on the parabola, and the others within the height of an arc.
            let arc = if every > 4.0 * h { 1e-14 } else { G * h * h / 8.0 };
            assert!(off.abs() < 1.01 * arc, "{state:?}: {off:e}");
        }
    }
}

/// The motor pulls with other forces each tenth of a second, of which three steps and a third are one, or a whole number but for round-off. The
/// block slides all the time: steps are exact then, if they end where the force changes.
#[test]
fn a_controller_pulls_when_it_is_due() {
    let pull = |k: f64| 8.0 + 3.0 * k;
    for (h, steps) in [(0.03, 40), (0.02, 50), (0.01, 100), (1.0, 10)] {
        let motion = CART.motion(State::new([0.0; 2], [2.0, 0.0])).by_time_stepping(MoreauJean::with_step(h));
        let mut calls = 0.0;
        let motion = motion.every(0.1).quantity("motor", |sample| sample.system().motor);
        let motion = motion.controlled(0.1, |cart, _| {
            cart.motor = pull(calls);
            calls += 1.0;
            Ok::<_, Error>(())
        });
        let arrival = motion.to(1.0).unwrap();
        assert_eq!((arrival.samples().len(), arrival.statistics().accepted), (11, steps));
        let [mut x, mut v] = [0.0, 2.0];
        for (k, (state, motor)) in arrival.samples().iter().zip(arrival.values()).enumerate() {
            let off = (state.q[0] - x).abs().max((state.v[0] - v).abs());
            assert!(off < 1e-13, "{h}, {k}: {state:?} {x} {v}");
            // Before the call at its time.
            assert_eq!(*motor, if k == 0 { 0.0 } else { pull(k as f64 - 1.0) });
            let a = pull(k as f64) / 2.0 - 0.3 * G;
            (x, v) = (x + 0.1 * v + a * 0.005, v + 0.1 * a);
        }
    }
}

/// A loop that changes the system and takes the steps of a controlled motion has its states, bit by bit.
#[test]
fn a_stepper_takes_the_steps_of_a_controlled_motion() {
    let (start, scheme) = (State::new([0.0; 2], [0.4, 0.0]), MoreauJean::with_step(0.03));
    let motor = |state: &State<f64, 2>| 20.0 * (1.0 - state.q[0]) - 4.0 * state.v[0];
    let motion = CART.motion(start).by_time_stepping(scheme).every(0.1).controlled(0.1, |cart, state| {
        cart.motor = motor(state);
        Ok::<_, Error>(())
    });
    let arrival = motion.to(3.0).unwrap();
    let mut stepper = CART.motion(start).by_time_stepping(scheme).stepper().unwrap();
    for (k, state) in arrival.samples().iter().enumerate() {
        assert_eq!(stepper.state(), state);
        let force = motor(stepper.state());
        stepper.change(|cart| cart.motor = force);
        for _ in 0..3 {
            stepper.step().unwrap();
        }
        stepper.step_to(0.1 * (k + 1) as f64).unwrap();
    }
    assert!((arrival.end().state().q[0] - 1.0).abs() < 0.3, "{arrival:?}");
}

/// A pendulum on a rod, whose velocities leave the constraint in each step: a controller and samples leave them as they are.
#[test]
fn a_controller_that_does_nothing_changes_nothing() {
    let pendulum = Walled { m: 1.5, l: 1.0, g: G, d: 0.2, e: 0.6, ..Walled::default() };
    let motion =
        || pendulum.motion(State::at_rest([-0.6, -0.8])).by_time_stepping(MoreauJean::with_step(0.125));
    let path: Trajectory<_> = motion().to(4.0).unwrap();
    let idle = motion().every(0.0625).controlled(0.5, |_, _| Ok::<_, Error>(())).to(4.0).unwrap();
    assert!(idle.samples().iter().all(|state| path.at(state.t).unwrap().state() == state));
    assert_eq!((idle.samples().len(), idle.end().state()), (65, path.end().state()));
}

#[test]
fn what_cannot_be_is_an_error() {
    let motion = || CART.motion(State::at_rest([0.0; 2])).by_time_stepping(MoreauJean::with_step(0.01));
    // Impulses are means of steps, and none at all at the start.
    for force in [1.0, -1.0] {
        let lifts = CART.event("lifts", |sample| sample.multiplier("floor").map(|push| push - force));
        let error = motion().event(lifts).to(1.0).unwrap_err();
        assert!(matches!(error, Error::EventInTimeSteps { event: "lifts", time: 0.0 }), "{error}");
        assert!(error.to_string().ends_with("by `every` and `quantity`"), "{error}");
    }
    for interval in [0.0, -0.1, f64::NAN] {
        let error = motion().every(interval).to(1.0).unwrap_err();
        assert!(matches!(error, Error::Setting { name: "interval of the samples", .. }), "{error}");
        let error = motion().controlled(interval, |_, _| Ok::<_, Error>(())).to(1.0).unwrap_err();
        assert!(matches!(error, Error::Setting { name: "interval of the controller", .. }), "{error}");
    }
    let error = motion().samples_at([0.5, 1.5]).to(1.0).unwrap_err();
    assert!(matches!(error, Error::OutsideTrajectory { .. }), "{error}");
    // A controller that fails, and one that lifts the floor into the block: samples until then are kept.
    let fails =
        motion().every(0.1).controlled(0.25, |_, state| if state.t < 0.4 { Ok(()) } else { Err("late") });
    let fails = fails.towards(1.0).unwrap();
    assert!(matches!(fails.ending(), Ending::ControllerFailed { time: 0.5, said } if said == "late"));
    assert_eq!((fails.samples().len(), fails.end().state().t), (6, 0.5));
    let lifts = motion().every(0.1).controlled(0.5, |cart, state| {
        cart.rise = 0.1 * state.t;
        Ok::<_, Error>(())
    });
    let lifts = lifts.towards(1.0).unwrap();
    let Ending::Unsolved { time: 0.5, error: Error::Penetration { contact: "floor", .. } } = lifts.ending()
    else {
        panic!("{lifts:?}")
    };
    assert_eq!(lifts.samples().len(), 6);
    let cancelled = motion().every(0.1).on_progress(|progress| match progress.time > 0.45 {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    });
    let cancelled = cancelled.to(1.0).unwrap();
    assert!(matches!(cancelled.ending(), Ending::Cancelled { .. }) && cancelled.samples().len() == 5);
}
