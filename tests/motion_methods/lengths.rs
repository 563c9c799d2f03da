//! Systems whose number of coordinates is known when the program runs.

use std::ops::ControlFlow;
use std::sync::Arc;

use lagrange_core::motion::{AccelerationField, Composition};
use lagrange_core::nalgebra::{Const, DVector, Dyn};
use lagrange_core::structure::VelocityFreeForces;
use lagrange_core::{Ending, Method, System, generic, prelude::*};

use lagrange_systems::{Chain, ChainOf, ChainOfFive};

const BETA: f64 = 0.7;

/// Bits of a state.
fn bits(t: f64, q: &[f64], v: &[f64]) -> Vec<u64> {
    [&[t], q, v].concat().into_iter().map(f64::to_bits).collect()
}

/// A motion is the same to the last bit whether its length is known when the program is compiled or when it runs.
fn agree<const N: usize, P>(method: P, end: f64)
where
    P: Method<Chain> + Method<ChainOf<N>> + Clone,
{
    let at_run_time = Chain { masses: N, beta: BETA };
    let constant = ChainOf::<N> { beta: BETA };
    let one = at_run_time.integrate(Chain::start(N), end, method.clone()).expect("a motion");
    let other = constant.integrate(ChainOf::start(), end, method).expect("a motion");
    assert_eq!(one.statistics(), other.statistics());
    for (one, other) in one.steps().chain(one.samples(77)).zip(other.steps().chain(other.samples(77))) {
        let (one, other) = (one.state(), other.state());
        assert_eq!(
            bits(one.t, one.q.as_slice(), one.v.as_slice()),
            bits(other.t, other.q.as_slice(), other.v.as_slice())
        );
    }
}

fn agree_by_all_methods<const N: usize>() {
    agree::<N, _>(Dop853::with_tolerance(1e-10), 30.0);
    agree::<N, _>(Dop853::default().fixed_step(0.1), -30.0);
    agree::<N, _>(Dopri5::with_tolerance(1e-6), -30.0);
    agree::<N, _>(RungeKutta4::with_step(0.05), 30.0);
    agree::<N, _>(Verlet::with_step(0.05), 30.0);
    agree::<N, _>(Verlet::with_step(0.1).composed(Composition::KahanLi8), -30.0);
}

#[test]
fn lengths_known_when_the_program_runs_give_the_same_bits() {
    agree_by_all_methods::<1>();
    agree_by_all_methods::<2>();
    agree_by_all_methods::<5>();
    agree_by_all_methods::<33>();
}

/// Stated by its accelerations, the chain moves as from its Lagrangian.
#[test]
fn stated_accelerations_move_as_derived_ones() {
    let method = Dop853::with_tolerance(1e-12);
    let stated = Chain { masses: 5, beta: BETA }.integrate(Chain::start(5), 20.0, method).unwrap();
    let derived = ChainOfFive { beta: BETA }.integrate(ChainOf::<5>::start(), 20.0, method).unwrap();
    for (one, other) in stated.samples(40).zip(derived.samples(40)) {
        for i in 0..5 {
            assert!((one.state().q[i] - other.state().q[i]).abs() < 1e-10);
            assert!((one.state().v[i] - other.state().v[i]).abs() < 1e-10);
        }
    }
}

/// Normal mode k of n equal masses and linear springs between walls: x_i = sin(πk(i + 1)/(n + 1)) cos ωt with
/// ω = 2 sin(πk/(2n + 2)).
#[test]
fn a_normal_mode_keeps_its_shape() {
    let (n, k) = (100, 3.0);
    let angle = std::f64::consts::PI * k / (n as f64 + 1.0);
    let shape = DVector::from_fn(n, |i, _| (angle * (i as f64 + 1.0)).sin());
    let omega = 2.0 * (angle / 2.0).sin();
    let mode = generic::State { t: 0.0, q: shape.clone(), v: DVector::zeros(n) };
    let chain = Chain { masses: n, beta: 0.0 };
    let off = |state: &generic::State<f64, Dyn>| {
        let there = (omega * state.t).cos();
        (0..n).fold(0.0, |off: f64, i| off.max((state.q[i] - there * shape[i]).abs()))
    };
    let path = chain.integrate(mode.clone(), 50.0, Dop853::with_tolerance(1e-12)).unwrap();
    assert!(path.samples(99).all(|sample| off(sample.state()) < 1e-10));
    let fourth = |step: f64| {
        let method = RungeKutta4::with_step(step);
        off(chain.integrate(mode.clone(), 50.0, method).unwrap().end().state())
    };
    assert!(((fourth(0.4) / fourth(0.2)).log2() - 4.0).abs() < 0.2);
    let eighth = |step: f64| {
        let method = Verlet::with_step(step).composed(Composition::KahanLi8);
        off(chain.integrate(mode.clone(), 50.0, method).unwrap().end().state())
    };
    let order = (eighth(2.0) / eighth(1.0)).log2();
    assert!((order - 8.0).abs() < 0.6, "{order}");
}

/// Events, samples, quantities, a controller and progress, each beside the same of a constant length.
#[test]
fn a_motion_is_asked_for_the_same_things() {
    let (chain, known) = (Chain { masses: 5, beta: BETA }, ChainOf::<5> { beta: BETA });
    let method = Dop853::with_tolerance(1e-10);
    let path = chain.motion(Chain::start(5)).by(method);
    let path = path.event(chain.event("middle", |sample| sample.state().q[2])).to(30.0).unwrap();
    let same = known.motion(ChainOf::<5>::start()).by(method);
    let same = same.event(known.event("middle", |sample| sample.state().q[2])).to(30.0).unwrap();
    assert!(path.crossings().len() > 10);
    assert!(path.crossings().iter().all(|crossing| crossing.state.q[2].abs() < 1e-15));
    let times = |of: Vec<f64>| of.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    assert_eq!(
        times(path.crossings().iter().map(|crossing| crossing.state.t).collect()),
        times(same.crossings().iter().map(|crossing| crossing.state.t).collect())
    );

    let mut steps = 0;
    let arrival = chain.motion(Chain::start(5)).by(method).every(0.5);
    let arrival = arrival.quantity("first", |sample| sample.state().q[0]).on_progress(|progress| {
        steps = progress.steps;
        if progress.time < 20.0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let arrival = arrival.towards(30.0).unwrap();
    assert!(matches!(arrival.ending(), Ending::Cancelled { .. }) && steps > 10);
    assert_eq!(arrival.samples().len(), arrival.values().len());
    assert!((arrival.samples()[8].q[0] - path.at(4.0).unwrap().state().q[0]).abs() < 1e-7);

    let stiffened = chain.motion(Chain::start(5)).by(method).every(1.0);
    let stiffened = stiffened.controlled(0.25, |chain, state| {
        chain.beta = if state.q[0] > 0.0 { 1.0 } else { 0.0 };
        Ok::<(), &str>(())
    });
    let stiffened = stiffened.to(10.0).unwrap();
    let by_constant = known.motion(ChainOf::<5>::start()).by(method).every(1.0);
    let by_constant = by_constant.controlled(0.25, |chain, state| {
        chain.beta = if state.q[0] > 0.0 { 1.0 } else { 0.0 };
        Ok::<(), &str>(())
    });
    let by_constant = by_constant.to(10.0).unwrap();
    for (one, other) in stiffened.samples().iter().zip(by_constant.samples()) {
        assert_eq!(one.q.as_slice(), other.q.as_slice());
    }
    assert!(stiffened.samples()[9].q[0] != path.at(9.0).unwrap().state().q[0]);
}

/// A motion that its caller advances: states within a step, parameters and states set on the way, crossings.
#[test]
fn a_motion_is_advanced_by_its_caller() {
    let chain = Chain { masses: 5, beta: BETA };
    let mut motion = Motion::new(chain.clone(), Chain::start(5), Dop853::with_tolerance(1e-10)).unwrap();
    let path = chain.integrate(Chain::start(5), 10.0, Dop853::with_tolerance(1e-12)).unwrap();
    motion.advance_to(3.0).unwrap();
    assert!((motion.state().q[1] - path.at(3.0).unwrap().state().q[1]).abs() < 1e-8);
    for state in motion.states_at([4.0, 4.01, 4.02, 7.0]) {
        let state = state.unwrap();
        assert!((state.q[1] - path.at(state.t).unwrap().state().q[1]).abs() < 1e-7);
    }
    let mut first = chain.event("first", |sample| sample.state().q[0]);
    let crossing = motion.advance_to_event(1e3, &mut [&mut first]).unwrap().unwrap();
    assert_eq!(motion.state(), &crossing.state);
    assert!(crossing.state.q[0].abs() < 1e-15);
    motion.system_mut().masses = 5;
    motion.set_state(Chain::start(5)).unwrap();
    motion.advance_by(1.0).unwrap();
    assert!((motion.state().q[3] - path.at(1.0).unwrap().state().q[3]).abs() < 1e-8);
}

/// A state that does not fit its system, and numbers that are none, are refused by name.
#[test]
fn what_does_not_fit_is_refused() {
    let chain = Chain { masses: 5, beta: BETA };
    let error = chain.integrate(Chain::start(4), 1.0, Dop853::default()).unwrap_err();
    assert!(error.to_string().contains("4") && error.to_string().contains("5"), "{error}");
    let mut broken = Chain::start(5);
    broken.v = DVector::zeros(6);
    assert!(chain.integrate(broken, 1.0, Dop853::default()).unwrap_err().to_string().contains("6"));
    let mut broken = Chain::start(5);
    broken.v[3] = f64::NAN;
    let error = chain.integrate(broken.clone(), 1.0, Dop853::default()).unwrap_err();
    assert!(error.to_string().contains("`x_dot[3]`"), "{error}");
    let mut motion = Motion::new(chain, Chain::start(5), RungeKutta4::with_step(0.1)).unwrap();
    assert!(motion.set_state(broken).unwrap_err().to_string().contains("`x_dot[3]`"));
    motion.system_mut().beta = f64::NAN;
    let ending = motion.advance_to(1.0).unwrap_err();
    assert!(ending.to_string().contains("`x[0]`"), "{ending}");
    motion.system_mut().beta = BETA;
    motion.advance_to(1.0).unwrap();
    motion.system_mut().masses = 6;
    let ending = motion.advance_to(2.0).unwrap_err();
    assert!(ending.to_string().contains("5 coordinates or velocities, and the system 6"), "{ending}");
    assert_eq!(motion.state().t, 1.0);
}

/// A chain may grow and shrink on the way, if its state does.
#[test]
fn a_motion_goes_on_with_another_length() {
    fn check(method: impl Method<Chain> + Clone) {
        for (n, looks) in [(3, false), (8, true), (20, false)] {
            let mut motion =
                Motion::new(Chain { masses: 5, beta: BETA }, Chain::start(5), method.clone()).unwrap();
            motion.advance_to(2.0).unwrap();
            if looks {
                motion.at(1.9995).unwrap();
            }
            motion.system_mut().masses = n;
            motion.set_state(Chain::start(n)).unwrap();
            motion.advance_to(1.0).unwrap();
            let mut first = motion.system().event("first", |sample| sample.state().q[0]);
            motion.advance_to_event(1.5, &mut [&mut first]).unwrap();
            motion.advance_to(1.5).unwrap();
            let chain = Chain { masses: n, beta: BETA };
            let path = chain.integrate(Chain::start(n), 1.5, method.clone()).unwrap();
            for (x, y) in motion.state().q.iter().zip(&path.end().state().q) {
                assert!((x - y).abs() < 1e-5, "{x}, not {y}");
            }
        }
    }
    check(Dop853::with_tolerance(1e-9));
    check(Dopri5::default().fixed_step(0.01));
    check(RungeKutta4::with_step(0.01));
    check(Verlet::with_step(0.001));
    check(Verlet::with_step(0.05).composed(Composition::KahanLi8));
}

/// A chain whose length its controller changes stops, and says so before an event sees a state that does not fit.
#[test]
fn a_controller_cannot_change_the_length() {
    let chain = Chain { masses: 5, beta: BETA };
    let last = chain.event("last", |sample| sample.state().q[sample.system().masses - 1]);
    let motion = chain.motion(Chain::start(5)).every(0.5).event(last);
    let arrival = motion.controlled(0.25, |chain, state| {
        chain.masses = if state.t > 1.0 { 7 } else { 5 };
        Ok::<(), &str>(())
    });
    let arrival = arrival.towards(3.0).unwrap();
    assert!(arrival.ending().to_string().contains("and the system 7"), "{}", arrival.ending());
    assert_eq!(arrival.end().state().t, 1.25);
}

/// Two masses on springs, of whose accelerations one is not written, or added to what was there.
#[derive(Clone, Copy)]
enum Unwritten {
    Left,
    Added,
}

impl System for Unwritten {
    type Scalar = f64;
    type Length = Dyn;
    type M = Const<0>;
    type Field = AccelerationField;

    fn length(&self) -> Dyn {
        Dyn(2)
    }

    fn accelerations(&self, _: f64, q: &[f64], _: &[f64], a: &mut [f64]) {
        a[0] = -q[0];
        if let Self::Added = self {
            a[1] += -q[1];
        }
    }
}

#[test]
fn accelerations_that_are_not_written_are_found_at_the_start() {
    for system in [Unwritten::Left, Unwritten::Added] {
        let error = system.integrate(Chain::start(2), 1.0, RungeKutta4::with_step(0.1)).unwrap_err();
        assert!(error.to_string().contains("`q[1]`"), "{error}");
    }
}

/// A motion that stopped because its accelerations had no value goes on once they have one.
#[test]
fn a_motion_goes_on_after_a_failure() {
    let until = |until| Broken { coordinates: 3, broken: 0, until };
    let mut motion = Motion::new(until(4.0), Chain::start(3), Dop853::default()).unwrap();
    motion.advance_to(6.0).unwrap_err();
    assert!((motion.state().t - 4.0).abs() < 1e-6);
    motion.system_mut().until = f64::INFINITY;
    motion.advance_to(6.0).unwrap();
    let sound = until(f64::INFINITY);
    let path = sound.integrate(Chain::start(3), 6.0, Dop853::default()).unwrap();
    assert!((motion.state().q[1] - path.end().state().q[1]).abs() < 1e-7);
}

/// A motion that is set to a state with velocities goes on from it as one that begins there, by the same steps where all have one length.
#[test]
fn nothing_of_the_motion_before_is_left() {
    fn check(method: impl Method<Chain> + Clone, off: f64) {
        let chain = Chain { masses: 9, beta: BETA };
        let mut start = Chain::start(9);
        (start.v, start.q) = (start.q.clone(), -&start.q);
        let mut motion = Motion::new(chain.clone(), Chain::start(9), method.clone()).unwrap();
        motion.advance_to(3.0).unwrap();
        motion.set_state(start.clone()).unwrap();
        motion.advance_to(2.0).unwrap();
        let path = chain.integrate(start, 2.0, method).unwrap();
        assert!((&motion.state().q - &path.end().state().q).amax() <= off);
        assert!((&motion.state().v - &path.end().state().v).amax() <= off);
    }
    check(Dop853::with_tolerance(1e-10), 1e-8);
    check(Dopri5::default().fixed_step(0.01), 0.0);
    check(RungeKutta4::with_step(0.01), 0.0);
    check(Verlet::with_step(0.01), 0.0);
    check(Verlet::with_step(0.05).composed(Composition::KahanLi8), 0.0);
}

/// One entry among many that has no value is found, wherever it is.
#[test]
fn an_entry_without_a_value_is_named() {
    for broken in [0, 3, 7, 8, 15, 16, 18] {
        let name = format!("`q[{broken}]`");
        let system = Broken { coordinates: 19, broken, until: 0.5 };
        let by = |method: &dyn Fn() -> Ending| {
            let ending = method();
            assert!(ending.is_failure() && ending.to_string().contains(&name), "{ending}");
            assert!((ending.time() - 0.5).abs() < 0.02, "{ending}");
        };
        let start = || Chain::start(19);
        by(&|| system.motion(start()).by(Dop853::default()).towards(1.0).unwrap().ending().clone());
        by(&|| {
            system.motion(start()).by(RungeKutta4::with_step(0.01)).towards(1.0).unwrap().ending().clone()
        });
        by(&|| system.motion(start()).by(Verlet::with_step(0.01)).towards(1.0).unwrap().ending().clone());
    }
}

/// Springs, one of whose accelerations has no value after a time.
struct Broken {
    coordinates: usize,
    broken: usize,
    until: f64,
}

impl System for Broken {
    type Scalar = f64;
    type Length = Dyn;
    type M = Const<0>;
    type Field = AccelerationField;

    fn length(&self) -> Dyn {
        Dyn(self.coordinates)
    }

    fn accelerations(&self, t: f64, q: &[f64], _: &[f64], a: &mut [f64]) {
        a.iter_mut().zip(q).for_each(|(a, q)| *a = -q);
        if t > self.until {
            a[self.broken] = f64::NAN;
        }
    }
}

impl VelocityFreeForces for Broken {}

/// A motion is called by the name of its system, also behind a pointer.
#[test]
fn a_system_has_the_name_of_its_type() {
    let chain = Arc::new(Chain { masses: 2, beta: BETA });
    let path = chain.integrate(Chain::start(2), 1.0, Dopri5::default()).unwrap();
    assert!(path.to_string().starts_with("Chain from t = 0 to t = 1:"), "{path}");
    let motion = Motion::new(Arc::clone(&chain), Chain::start(2), Dopri5::default()).unwrap();
    assert!(format!("{motion:?}").contains("\"Chain\""), "{motion:?}");
    let known = ChainOf::<2> { beta: BETA };
    let path = known.integrate(ChainOf::start(), 1.0, Dopri5::default()).unwrap();
    assert!(path.to_string().starts_with("ChainOf from"), "{path}");
}

/// Coordinates of a system that is stated by its accelerations alone are numbered.
#[test]
fn coordinates_without_names_are_numbered() {
    let known = ChainOf::<2> { beta: BETA };
    let path = known.integrate(ChainOf::start(), 1.0, Dop853::default()).unwrap();
    assert_eq!(path.end().coordinate("q[1]").unwrap(), path.end().state().q[1]);
    assert_eq!(path.end().velocity("q[0]").unwrap(), path.end().state().v[0]);
    let table = path.csv(2).to_string();
    assert!(table.starts_with("t,q[0],q[1],q_dot[0],q_dot[1]\n0.0,"), "{table}");
    let said = path.end().coordinate("x[1]").unwrap_err().to_string();
    assert!(said.starts_with("there is no coordinate `x[1]`: did you mean `q[1]`?"), "{said}");
}

/// A chain without masses rests.
#[test]
fn a_system_may_have_no_coordinates() {
    let nothing = Chain { masses: 0, beta: BETA };
    for ending in [
        nothing.integrate(Chain::start(0), 3.0, Dop853::default()).unwrap().ending().clone(),
        nothing.integrate(Chain::start(0), 3.0, Dopri5::default()).unwrap().ending().clone(),
        nothing.integrate(Chain::start(0), 3.0, RungeKutta4::with_step(0.1)).unwrap().ending().clone(),
        nothing.integrate(Chain::start(0), 3.0, Verlet::with_step(0.1)).unwrap().ending().clone(),
    ] {
        assert_eq!(ending, Ending::Complete { time: 3.0 });
    }
}

/// Once a motion has begun, its steps allocate nothing.
#[test]
fn steps_allocate_nothing() {
    fn count(method: impl Method<Chain>) -> u64 {
        let chain = Chain { masses: 20, beta: BETA };
        let mut motion = Motion::new(chain, Chain::start(20), method).unwrap();
        motion.advance_to(1.0).unwrap();
        let used = allocation_counter::measure(|| motion.advance_to(40.0).unwrap());
        assert!(motion.statistics().accepted > 100);
        used.count_total
    }
    assert_eq!(count(Dop853::with_tolerance(1e-12)), 0);
    assert_eq!(count(Dopri5::with_tolerance(1e-6)), 0);
    assert_eq!(count(Dopri5::default().fixed_step(0.05)), 0);
    assert_eq!(count(RungeKutta4::with_step(0.05)), 0);
    assert_eq!(count(Verlet::with_step(0.05)), 0);
    assert_eq!(count(Verlet::with_step(0.1).composed(Composition::KahanLi8)), 0);
}
