//! What goes wrong is an error that says so, and what was computed until then is kept.

use core::ops::ControlFlow;
use std::time::Duration;

use lagrange_core::motion::Composition::KahanLi6;
use lagrange_core::nalgebra::Const;
use lagrange_core::{Ending, Lagrangian, Method, prelude::*};

use crate::systems::*;

/// The ending of a motion, which kept all states until then, all of them finite.
fn ending<L, P, const N: usize>(system: &L, start: State<f64, N>, end: f64, method: P) -> Ending
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
    P: Method<L>,
{
    let path = system.motion(start).by(method).towards(end).unwrap();
    assert_eq!(path.steps().count(), path.statistics().accepted + 1);
    assert!(path.steps().all(|step| step.state().q.iter().chain(&step.state().v).all(|x| x.is_finite())));
    path.ending().clone()
}

/// Runs a check with methods of every kind, on the same system.
macro_rules! by_all {
    (|$method:ident| $check:expr) => {{
        by_all!(@one $method, Verlet::with_step(0.01), $check);
        by_all!(@one $method, Verlet::with_step(0.05).composed(KahanLi6), $check);
        by_all!(@one $method, Lobatto::<2>::with_step(0.01), $check);
        by_all!(@one $method, Lobatto::<4>::with_step(0.02), $check);
        by_all!(@one $method, DAlembert::with_step(0.01), $check);
        by_all!(@one $method, DAlembert::with_step(0.05).composed(KahanLi6), $check);
    }};
    (@one $method:ident, $value:expr, $check:expr) => {{
        let $method = $value;
        $check
    }};
}

#[test]
fn steps_must_be_positive_and_finite() {
    let (system, start) = spherical();
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let refused = |error: Error| matches!(error, Error::Setting { name: "fixed step", .. });
        assert!(refused(system.integrate(start, 1.0, Verlet::with_step(step)).unwrap_err()));
        assert!(refused(system.integrate(start, 1.0, Lobatto::<3>::with_step(step)).unwrap_err()));
        assert!(refused(system.integrate(start, 1.0, DAlembert::with_step(step)).unwrap_err()));
        let (system, start) = double_pendulum();
        assert!(refused(system.integrate(start, 1.0, Gauss::<2>::with_step(step)).unwrap_err()));
    }
}

#[test]
fn starts_and_ends_are_checked() {
    let (system, start) = spherical();
    by_all!(|method| {
        let broken = State::new([f64::NAN, 0.0, -1.0], [0.0; 3]);
        assert!(matches!(system.integrate(broken, 1.0, method), Err(Error::StateNotFinite { .. })));
        let inside = State::at_rest([0.5, 0.0, 0.0]);
        assert!(matches!(system.integrate(inside, 1.0, method), Err(Error::Inconsistent { .. })));
        let leaving = State::new([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]);
        assert!(matches!(system.integrate(leaving, 1.0, method), Err(Error::Inconsistent { .. })));
        for end in [f64::NAN, f64::INFINITY] {
            assert!(matches!(system.integrate(start, end, method), Err(Error::EndNotFinite { .. })));
        }
        // A span of length zero is over at its start.
        assert!(ending(&system, start, 0.0, method).is_complete());
    });
}

#[test]
fn limits_end_a_motion() {
    let (system, start) = spherical();
    by_all!(|method| {
        assert!(matches!(
            ending(&system, start, 10.0, method.max_steps(7)),
            Ending::StepLimit { steps: 7, .. }
        ));
        let at_once = method.wall_time(Duration::ZERO);
        assert!(matches!(ending(&system, start, 10.0, at_once), Ending::WallTimeLimit { .. }));
        // Neighbouring times are 128 apart.
        let late = start.at_time(1e18);
        assert!(matches!(ending(&system, late, 2e18, method), Ending::TimeTooCoarse { .. }));
        let stop = |_| ControlFlow::Break(());
        let path = system.motion(start).by(method).on_progress(stop).towards(1.0).unwrap();
        assert!(matches!(path.ending(), Ending::Cancelled { .. }));
    });
}

#[test]
fn equilibria_stay() {
    let (system, _) = spherical();
    let hanging = State::at_rest([0.0, 0.0, -1.0]);
    by_all!(|method| {
        let path = system.integrate(hanging, 20.0, method).unwrap();
        assert!(error(path.end().state(), &State { t: 20.0, ..hanging }) < 1e-14);
    });
    // At rest off the axes, where multipliers and forces cancel but for rounding.
    let (system, _) = two_bobs();
    let hanging = State::at_rest([0.0, -1.0, 0.0, -2.0]);
    by_all!(|method| {
        let path = system.integrate(hanging, 20.0, method).unwrap();
        assert!(error(path.end().state(), &State { t: 20.0, ..hanging }) < 1e-12);
    });
    let (system, _) = double_pendulum();
    let path = system.integrate(State::at_rest([0.0, 0.0]), 20.0, Gauss::<3>::with_step(0.1)).unwrap();
    assert!(path.end().state().q.iter().all(|x| *x == 0.0));
}

/// A step over several oscillations has no stages that the iteration finds.
#[test]
fn steps_that_are_too_long_are_refused() {
    let (system, start) = double_pendulum();
    let refused = |ending: &Ending| match ending {
        Ending::MethodFailed { reason, .. } => reason.contains("take shorter steps"),
        Ending::NotFinite { .. } => true,
        _ => false,
    };
    assert!(refused(&ending(&system, start, 10.0, Gauss::<2>::with_step(2.0))));
    assert!(refused(&ending(&system, start, 10.0, Lobatto::<3>::with_step(2.0))));
    let (system, start) = spherical();
    assert!(refused(&ending(&system, start, 10.0, Verlet::with_step(2.0))));
    assert!(refused(&ending(&system, start, 10.0, Lobatto::<4>::with_step(2.0))));
    assert!(refused(&ending(&system, start, 10.0, DAlembert::with_step(2.0))));
}

/// A stone that falls on a star, and a root that ends.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - sqrt(1 - x))]
struct Cliff;

#[test]
fn forces_that_end_are_named() {
    let start = State::new([0.0], [0.5]);
    let named = |ending: Ending| matches!(ending, Ending::NotFinite { time, .. } if time > 0.5 && time < 3.0);
    assert!(named(ending(&Cliff, start, 10.0, Verlet::with_step(0.01))));
    assert!(named(ending(&Cliff, start, 10.0, Gauss::<2>::with_step(0.01))));
    assert!(named(ending(&Cliff, start, 10.0, Lobatto::<3>::with_step(0.01))));
    assert!(named(ending(&Cliff, start, 10.0, DAlembert::with_step(0.01))));
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*x_dot^2 + n/2*y_dot^2 - y)]
struct Masses {
    m: f64,
    n: f64,
}

#[test]
fn masses_of_zero_are_singular() {
    let (system, start) = (Masses { m: 1.0, n: 0.0 }, State::at_rest([0.0, 0.0]));
    let refused = |error: Error| matches!(error, Error::Singular { .. }) && error.to_string().contains("`y`");
    assert!(refused(system.integrate(start, 1.0, Verlet::with_step(0.1)).unwrap_err()));
    assert!(refused(system.integrate(start, 1.0, Gauss::<2>::with_step(0.1)).unwrap_err()));
    assert!(refused(system.integrate(start, 1.0, Lobatto::<2>::with_step(0.1)).unwrap_err()));
    assert!(refused(system.integrate(start, 1.0, DAlembert::with_step(0.1)).unwrap_err()));
    let infinite = Masses { m: f64::INFINITY, n: 1.0 };
    assert!(infinite.integrate(start, 1.0, Gauss::<1>::with_step(0.1)).is_err());
}

/// A rod twice, where the parameters are equal.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - y)]
#[constraint(rod: x^2 + y^2 = 1)]
#[constraint(again: a*x^2 + b*y^2 = 1)]
struct Twice {
    a: f64,
    b: f64,
}

/// The emitted factorization does not take dependent constraints; these methods say so, and do not go on.
#[test]
fn dependent_constraints_are_refused() {
    let (system, start) = (Twice { a: 1.0, b: 1.0 }, State::at_rest([0.6, -0.8]));
    by_all!(|method| {
        let path = system.motion(start).by(method).towards(1.0).unwrap();
        match path.ending() {
            Ending::MethodFailed { reason, .. } => {
                assert!(reason.contains("depend on one another"), "{reason}");
            }
            other => panic!("{other}"),
        }
    });
}

#[test]
fn events_and_controllers_that_fail_end_a_motion() {
    let (system, start) = spherical();
    by_all!(|method| {
        let broken = system.event("broken", |sample| if sample.time() > 0.3 { f64::NAN } else { 1.0 });
        let path = system.motion(start).by(method).event(broken).towards(1.0).unwrap();
        assert!(matches!(path.ending(), Ending::EventNotFinite { event: "broken", .. }), "{}", path.ending());
        assert!(path.end().time() > 0.2);
        // A storm of 3,000 crossings in one unit of time; each is found, or the motion says that they accumulate.
        let storm = system.event("storm", |sample| (3_000.0 * core::f64::consts::PI * sample.time()).sin());
        let path = system.motion(start).by(method).event(storm).towards(0.01).unwrap();
        assert!(path.ending().is_complete() && path.crossings().len() >= 29, "{}", path.crossings().len());
    });
}

/// A motion that is led to a time just after a step goes on with steps of its length.
#[test]
fn short_steps_do_not_spoil_the_next() {
    fn check<L: Lagrangian<N = Const<N>, Scalar = f64> + Clone, P: Method<L> + Copy, const N: usize>(
        system: &L,
        start: State<f64, N>,
        method: P,
    ) {
        let straight = *system.integrate(start, 2.0, method).unwrap().end().state();
        for length in [1e-3, 1e-6, 1e-9, 1e-12, 1e-14] {
            let mut motion = Motion::new(system.clone(), start, method).unwrap();
            motion.advance_to(1.0).unwrap();
            motion.advance_to(1.0 + length).unwrap();
            motion.advance_to(2.0).unwrap();
            assert!(error(motion.state(), &straight) < 1e-5, "{}", error(motion.state(), &straight));
        }
    }
    let (system, start) = spherical();
    check(&system, start, Verlet::with_step(0.001));
    check(&system, start, Lobatto::<2>::with_step(0.001));
    check(&system, start, Lobatto::<3>::with_step(0.01));
    check(&system, start, Lobatto::<4>::with_step(0.02));
    let (system, start) = double_pendulum();
    check(&system, start, Gauss::<3>::with_step(0.02));
    check(&system, start, Gauss::<4>::with_step(0.02));
}

/// Backwards and forwards in time, the end of the last step is exact.
#[test]
fn ends_are_reached_exactly() {
    let (system, start) = spherical();
    by_all!(|method| {
        for end in [1.0, -1.0, 0.005, -0.123] {
            let path = system.integrate(start, end, method).unwrap();
            assert_eq!(path.end().time(), end);
        }
    });
}
