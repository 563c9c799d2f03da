//! Motions that go on when they are told to: inputs that change, times that are reached, states in between.

use lagrange_core::motion::{Limits, VectorField};
use lagrange_core::{Ending, Method, prelude::*, runge_kutta_step};
use lagrange_systems::DrivenSpring;

use crate::{ROD, spring_of, swinging};

/// A mass with a motor, whose force is `a`, and a brake.
pub(crate) fn cart(m: f64, c: f64) -> DrivenSpring<f64> {
    DrivenSpring { m, k: 0.0, c, a: 0.0, w: 0.0 }
}

/// The input of tick `k`.
fn input(k: u32) -> f64 {
    f64::from((k * 7 + 3) % 11) - 5.0
}

/// With m = 1 and this brake, held inputs give x̂ = x + (v − u/c)(1 − e^(−ct))/c + u t/c.
fn held(state: (f64, f64), u: f64, c: f64, t: f64) -> (f64, f64) {
    let ((x, v), decay) = (state, (-c * t).exp());
    (x + (v - u / c) * (1.0 - decay) / c + u / c * t, u / c + (v - u / c) * decay)
}

/// Two seconds at 100 inputs a second; how far from the solution, and the evaluations.
fn driven<P: Method<DrivenSpring<f64>>>(method: P) -> (f64, usize) {
    let mut motion = Motion::new(cart(1.0, 0.7), State::new([0.3], [1.0]), method).expect("a start");
    let (mut expected, mut off) = ((0.3, 1.0), 0.0_f64);
    for k in 0..200 {
        motion.system_mut().a = input(k);
        motion.advance_to(0.01 * f64::from(k + 1)).expect("no end before");
        assert_eq!(motion.state().t, 0.01 * f64::from(k + 1));
        expected = held(expected, input(k), 0.7, 0.01);
        let State { q, v, .. } = motion.state();
        off = off.max((q[0] - expected.0).abs()).max((v[0] - expected.1).abs());
    }
    (off, motion.statistics().evaluations)
}

#[test]
fn inputs_are_held_from_tick_to_tick() {
    // One evaluation at the start and one where a first step is sought; then a change and a step each tick. With steps of one
    // size, the rates at the end of a step are evaluated after the change, and not before.
    for ((off, found), bound, evaluations) in [
        (driven(Dop853::default()), 1e-12, 2 + 200 * (1 + 12)),
        (driven(Dopri5::with_tolerance(1e-6).fixed_step(0.01)), 1e-12, 1 + 200 * 6),
        (driven(Dop853::default().fixed_step(0.01)), 1e-12, 1 + 200 * 12),
        (driven(RungeKutta4::with_step(0.01)), 1e-9, 200 * 4),
    ] {
        assert!(off < bound && found == evaluations, "{off:e}, {found} evaluations, not {evaluations}");
    }
}

#[test]
fn several_changes_cost_one_evaluation_and_none_cost_none() {
    let mut motion = Motion::new(cart(1.0, 0.0), State::at_rest([0.0]), Dopri5::default()).unwrap();
    motion.advance_to(1.0).unwrap();
    let evaluations = |motion: &Motion<_, Dopri5>| motion.statistics().evaluations;
    let (before, accepted) = (evaluations(&motion), motion.statistics().accepted);
    motion.advance_to(1.0).unwrap();
    assert_eq!(evaluations(&motion), before);
    motion.system_mut().a = 1.0;
    motion.system_mut().m = 2.0;
    motion.advance_to(1.0).unwrap();
    assert_eq!(evaluations(&motion), before + 1);
    motion.advance_by(2.0).unwrap();
    // The step is as long as it has grown to be, not sought again.
    assert_eq!((evaluations(&motion), motion.statistics().accepted), (before + 7, accepted + 1));
    assert!((motion.state().q[0] - 0.25 * 4.0).abs() < 1e-14 && motion.system().a == 1.0);
    assert_eq!(motion.into_system().m, 2.0);
}

/// The step to a time of the caller's choice says nothing about the steps after it.
#[test]
fn a_short_advance_does_not_make_the_next_steps_short() {
    let mut motion = Motion::new(spring_of(1.0), State::at_rest([1.0]), Dop853::default()).unwrap();
    motion.advance_to(10.0).unwrap();
    let steps = |motion: &Motion<_, Dop853>| motion.statistics().accepted + motion.statistics().rejected;
    let before = steps(&motion);
    motion.advance_to(20.0).unwrap();
    let usual = steps(&motion) - before;
    motion.advance_by(1e-9).unwrap();
    let before = steps(&motion);
    motion.advance_by(10.0).unwrap();
    assert!(steps(&motion) - before <= usual + 1, "{} steps instead of {usual}", steps(&motion) - before);
}

#[test]
fn a_motion_left_alone_is_the_trajectory() {
    let path = ROD.integrate(swinging(), 5.0, Dop853::default()).unwrap();
    let mut motion = Motion::new(ROD, swinging(), Dop853::default()).unwrap();
    motion.advance_to(5.0).unwrap();
    assert_eq!(motion.state(), path.end().state());
    assert_eq!(motion.statistics().accepted, path.statistics().accepted);
    // Nobody asked for what lies between: three evaluations fewer a step.
    assert_eq!(
        motion.statistics().evaluations + 3 * path.statistics().accepted,
        path.statistics().evaluations
    );
    let mut motion = Motion::new(&ROD, swinging(), Dop853::default()).unwrap();
    let times = |k: u32| 0.05 * f64::from(k);
    let states = motion.states_at((0..=100).map(times));
    for (k, state) in (0..=100).zip(states) {
        assert_eq!(state.unwrap(), *path.at(times(k)).unwrap().state());
    }
    assert_eq!(motion.state(), path.end().state());
}

/// Steps of one size are the same to the bit whether the rates where they end are evaluated at once, for what lies within,
/// or by the next step.
fn same_ends<L, P, F>(
    mut motion: Motion<L, P, F>,
    path: &Trajectory<L, F>,
    within: usize,
    (start, left): (usize, usize),
) where
    L: Lagrangian<Scalar = f64> + Clone,
    F: VectorField<L>,
    P: Method<L, F>,
{
    assert_eq!(motion.statistics().evaluations, start);
    for k in 1..=4 {
        motion.advance_to(0.5 * f64::from(k)).expect("no end before");
        assert_eq!(motion.state(), path.at(0.5 * f64::from(k)).expect("a state").state());
    }
    let (own, stored) = (*motion.statistics(), path.statistics());
    assert_eq!((own.accepted, stored.accepted), (32, 32));
    assert_eq!(own.evaluations + 32 * within + left, stored.evaluations);
    for t in [1.95, 1.99] {
        assert_eq!(motion.at(t).expect("a state"), *path.at(t).expect("a state").state());
    }
    assert_eq!(motion.statistics().evaluations, own.evaluations + within + left);
}

#[test]
fn fixed_steps_are_the_same_whoever_asks_for_their_ends() {
    let (fifth, eighth) = (Dopri5::default().fixed_step(0.0625), Dop853::default().fixed_step(0.0625));
    let spring = spring_of(1.3);
    let (rest, start) = (State::at_rest([1.0]), swinging());
    let path = spring.integrate(rest, 2.0, fifth).unwrap();
    same_ends(Motion::new(&spring, rest, fifth).unwrap(), &path, 0, (1, 1));
    let path = ROD.integrate(start, 2.0, fifth).unwrap();
    same_ends(Motion::new(&ROD, start, fifth).unwrap(), &path, 0, (1, 1));
    let path = ROD.integrate(start, 2.0, eighth).unwrap();
    same_ends(Motion::new(&ROD, start, eighth).unwrap(), &path, 3, (1, 1));
    // In momenta the velocity is one of the rates: nothing is left for later.
    let start = ROD.phase_state(&start);
    let path = ROD.motion_in_momenta(start).by(eighth).to(2.0).unwrap();
    same_ends(Motion::in_momenta(&ROD, start, eighth).unwrap(), &path, 3, (1, 0));
}

/// A spring with a hole, in which the force is not a number.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[force(x: none*sqrt((x - hole)^2 - 1e-24))]
pub(crate) struct Holed<T> {
    none: T,
    hole: T,
}

/// A motion by steps of one size into the hole, which is at the state at t = 1/2: without the hole, with it, the start, that
/// state, and the method.
pub(crate) fn into_a_hole() -> ([Holed<f64>; 2], State<f64, 1>, State<f64, 1>, Dopri5) {
    let whole = Holed { none: 0.0, hole: 1e3 };
    let (start, method) = (State::at_rest([1.0]), Dopri5::default().fixed_step(0.125));
    let at = *whole.integrate(start, 0.5, method).expect("a motion").end().state();
    ([whole, Holed { hole: at.q[0], ..whole }], start, at, method)
}

/// Where the equations have no solution at the end of a step of one size, the next finds out, or what asks for its rates.
#[test]
fn a_step_into_a_hole_is_an_error_of_the_next() {
    let ([_, holed], start, at, method) = into_a_hole();
    let mut motion = Motion::new(holed, start, method).unwrap();
    motion.advance_to(0.5).unwrap();
    assert_eq!(*motion.state(), at);
    assert!(matches!(motion.at(0.45), Err(Error::EquationsNotFinite { time: 0.5, .. })));
    for _ in 0..2 {
        let ending = motion.advance_to(1.0).unwrap_err();
        assert!(matches!(ending, Ending::NotFinite { time: 0.5, .. }), "{ending}");
        assert_eq!(*motion.state(), at);
    }
    motion.system_mut().hole = 1e3;
    motion.advance_to(1.0).unwrap();
    assert!((motion.state().q[0] - 1_f64.cos()).abs() < 1e-6);
    // A trajectory has what lies within each step, and that one has none.
    let path = holed.motion(start).by(method).towards(1.0).unwrap();
    assert!(matches!(path.ending(), Ending::NotFinite { time: 0.375, .. }), "{}", path.ending());
    assert_eq!((path.end().time(), path.statistics().accepted), (0.375, 3));
    assert!((path.at(0.3).unwrap().coordinate("x").unwrap() - 0.3_f64.cos()).abs() < 1e-6);
}

#[test]
fn states_are_given_at_times_in_both_directions() {
    let mut motion = Motion::new(spring_of(1.0), State::at_rest([1.0]), Dopri5::default()).unwrap();
    for times in [[0.0, 0.5, 0.5, 3.0, 7.0], [7.0, 6.9, 0.0, -2.0, -9.0], [-9.0, -8.0, -8.0, 1.0, 2.0]] {
        let states: Result<Vec<_>, _> = motion.states_at(times).collect();
        for (state, t) in states.unwrap().into_iter().zip(times) {
            assert_eq!(state.t, t);
            assert!((state.q[0] - t.cos()).abs() < 1e-7 && (state.v[0] + t.sin()).abs() < 1e-7);
        }
        assert_eq!(motion.state().t, times[4]);
    }
    assert_eq!(motion.states_at([]).count(), 0);
    // Out of order, and what comes after it.
    let items: Vec<_> = motion.states_at([3.0, 1.0, 4.0]).collect();
    assert_eq!(items.len(), 2);
    let Err(Ending::Unsolved { error, .. }) = &items[1] else { panic!("{items:?}") };
    assert!(matches!(error, Error::OutsideTrajectory { time: 1.0, .. }), "{error}");
}

#[test]
fn the_last_step_can_be_looked_into() {
    let mut motion = Motion::new(ROD, swinging(), Dop853::with_tolerance(1e-6)).unwrap();
    assert_eq!(motion.at(0.0).unwrap(), swinging());
    assert!(matches!(motion.at(0.1), Err(Error::OutsideTrajectory { start: 0.0, end: 0.0, .. })));
    motion.advance_to(0.1).unwrap();
    let path = ROD.integrate(swinging(), 0.1, Dop853::with_tolerance(1e-6)).unwrap();
    let last = path.steps().map(|step| step.time()).nth(path.statistics().accepted - 1).unwrap();
    let evaluations = motion.statistics().evaluations;
    for k in 0..=10 {
        let t = last + (0.1 - last) * f64::from(k) / 10.0;
        assert_eq!(motion.at(t).unwrap(), *path.at(t).unwrap().state());
    }
    assert_eq!(motion.statistics().evaluations, evaluations + 3, "the extension is computed once");
    assert!(matches!(motion.at(last - 1e-3), Err(Error::OutsideTrajectory { .. })));
    // With another system the step would have been another one.
    motion.system_mut().g = 1.6;
    assert!(motion.at(0.5 * (last + 0.1)).is_err() && motion.at(0.1).is_ok());
}

#[test]
fn a_state_is_set_and_gone_on_from() {
    let mut motion = Motion::new(ROD, swinging(), Dop853::default()).unwrap();
    motion.advance_to(1.0).unwrap();
    motion.set_state(swinging().at_time(-3.0)).unwrap();
    assert_eq!(*motion.state(), swinging().at_time(-3.0));
    motion.advance_to(2.0).unwrap();
    let path = ROD.integrate(swinging().at_time(-3.0), 2.0, Dop853::default()).unwrap();
    assert!((motion.state().q - path.end().state().q).norm() < 1e-7);
}

#[test]
fn what_cannot_be_is_an_error_and_leaves_the_motion_where_it_was() {
    let mut motion = Motion::new(ROD, swinging(), Dop853::default()).unwrap();
    motion.advance_to(0.5).unwrap();
    let here = *motion.state();
    // A rod of another length is not at this place.
    motion.system_mut().square = 4.0;
    let ending = motion.advance_by(0.1).unwrap_err();
    assert!(ending.to_string().contains("`rod`"), "{ending}");
    assert_eq!(*motion.state(), here);
    motion.system_mut().square = 1.0;
    motion.advance_by(0.1).unwrap();
    let here = *motion.state();
    motion.system_mut().g = f64::NAN;
    let ending = motion.advance_by(0.1).unwrap_err();
    assert!(matches!(ending, Ending::NotFinite { .. }), "{ending}");
    assert_eq!(*motion.state(), here);
}

#[test]
fn limits_are_those_of_one_advance() {
    let mut motion =
        Motion::new(spring_of(1.0), State::at_rest([1.0]), Dopri5::default().max_steps(100)).unwrap();
    for k in 1..=50 {
        motion.advance_to(f64::from(k)).unwrap();
    }
    assert!(motion.statistics().accepted > 200 && Limits::default().max_steps == 100_000);
    let ending = motion.advance_by(1e6).unwrap_err();
    assert!(matches!(ending, Ending::StepLimit { steps: 100, .. }), "{ending}");
    let t = motion.state().t;
    assert!(t > 50.0 && (motion.state().q[0] - t.cos()).abs() < 1e-6);
    motion.advance_to(0.0).unwrap_err();
    assert!(motion.state().t < t);
}

/// The mean slope of log error over log step in four halvings, at the end and in between.
fn order(at: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
    let (coarse, fine) = (at(0.1), at(0.1 / 16.0));
    ((coarse.0 / fine.0).log2() / 4.0, (coarse.1 / fine.1).log2() / 4.0)
}

#[test]
fn the_classical_method_is_of_order_four() {
    let spring = spring_of(1.3);
    let (end, between) = order(|h| {
        let path = spring.integrate(State::at_rest([1.0]), -6.0, RungeKutta4::with_step(h)).unwrap();
        assert_eq!(path.statistics().accepted, (6.0 / h).round() as usize);
        let off = |s: &State<f64, 1>| (s.q[0] - (1.3 * s.t).cos()).abs();
        (off(path.end().state()), path.samples(1000).map(|s| off(s.state())).fold(0.0, f64::max))
    });
    assert!((end - 4.0).abs() < 0.1 && (between - 4.0).abs() < 0.2, "{end}, {between}");
}

#[test]
fn the_classical_method_keeps_to_constraints_and_drifts_without_projection() {
    let mut motion = Motion::new(ROD, swinging(), RungeKutta4::with_step(0.01)).unwrap();
    motion.advance_to(20.0).unwrap();
    assert!((motion.state().q.norm() - 1.0).abs() < 1e-12);
    let exact = ROD.integrate(swinging(), 20.0, Dop853::with_tolerance(1e-12)).unwrap();
    assert!((motion.state().q - exact.end().state().q).norm() < 1e-3);
    let mut state = swinging();
    for _ in 0..2000 {
        state = runge_kutta_step(&ROD, &state, 0.01);
    }
    let drift = (state.q.norm() - 1.0).abs();
    assert!((1e-10..1e-3).contains(&drift), "{drift:e}");
}
