//! Rest, iterations that diverge, and steps of other lengths. Broken input of all kinds is in `motion_control/faults`.

use lagrange_core::motion::Composition::KahanLi6;
use lagrange_core::nalgebra::Const;
use lagrange_core::{Ending, Lagrangian, Method, prelude::*};
use lagrange_systems::{Pendulum, Spring};

use crate::{IS_LONG, systems::*};

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

/// A rotation decays to nothing on the straight way that a sleigh ends on, far below the round-off of other velocities.
#[test]
fn rotations_that_have_decayed_take_no_more_sweeps() {
    let (system, _) = sleigh();
    let start =
        State::new([24_177.0, 24_704.0, 0.7962], [0.7962_f64.cos() / 2.0, 0.7962_f64.sin() / 2.0, 1e-37]);
    let (start, _) = system.make_consistent(&start).unwrap();
    let path = system.integrate(start, 300.0, DAlembert::with_step(0.15)).unwrap();
    let statistics = path.statistics();
    // Fifteen sweeps of two evaluations in a step; to round-off of this rotation they would be 21.
    assert!(statistics.evaluations < 18 * 2 * statistics.accepted, "{statistics:?}");
}

/// A free body by its principal moments of inertia.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[define(w = quat_rate_body(q, q_dot))]
#[lagrangian((inertia[0]*w[0]^2 + inertia[1]*w[1]^2 + inertia[2]*w[2]^2)/2)]
struct Free {
    inertia: [f64; 3],
}

/// By symmetry, all terms of a momentum cancel but for their round-off.
#[test]
fn steady_rotations_of_symmetric_bodies_go_on() {
    for inertia in [[1.0, 1.0, 2.0], [2.0, 1.0, 2.0], [1.0, 1.0, 1.0], [1.0, 1.0 + 1e-9, 2.0]] {
        for v in [[0.0, 0.005, 2.0, 0.0], [0.0, 0.0, 2.0, 0.0], [0.0, 0.1, 0.0, 1.0]] {
            let (free, start) = (Free { inertia }, State::new([1.0, 0.0, 0.0, 0.0], v));
            let exact = free.integrate(start, 2.0, Taylor::default()).unwrap();
            let off = |path: Trajectory<&Free>| (path.end().state().q - exact.end().state().q).amax();
            for h in if IS_LONG { vec![0.01, 0.001] } else { vec![0.01] } {
                let allowed = 10.0 * h * h;
                assert!(off(free.integrate(start, 2.0, Lobatto::<2>::with_step(h)).unwrap()) < allowed);
                assert!(off(free.integrate(start, 2.0, Lobatto::<4>::with_step(h)).unwrap()) < 1e-9);
                assert!(off(free.integrate(start, 2.0, DAlembert::with_step(h)).unwrap()) < allowed);
            }
        }
    }
}

/// A mass that depends on the place, beside a force of the velocity squared.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2*(1 + 0.9*cos(x))/2 + cos(x))]
struct Varying;

/// The terms of a diverged iteration are so large that its residuals are round-off of them.
#[test]
fn iterations_that_diverge_are_refused() {
    let start = State::new([2.721187321062468], [-1.9724775945970947]);
    for h in [0.215, 0.25, 0.3, 0.4] {
        let refused = |ending: Ending| matches!(ending, Ending::MethodFailed { .. });
        assert!(refused(ending(&Varying, start, h, Lobatto::<2>::with_step(h))));
        assert!(refused(ending(&Varying, start, h, Lobatto::<3>::with_step(h))));
        assert!(refused(ending(&Varying, start, h, DAlembert::with_step(h))));
    }
}

/// What is refused at an angle is refused a thousand turns on, where rounding moves momenta by more.
#[test]
fn far_angles_are_no_excuse() {
    let pendulum = Pendulum { m: 1.0, l: 1.0, g: 1.0 };
    for (turns, k) in [0.0, 1e3, 1e4, 1e6].into_iter().flat_map(|turns| (0..100).map(move |k| (turns, k))) {
        let angle = 1.2774 + 0.02 * f64::from(k);
        let start = State::new([turns * std::f64::consts::TAU + angle], [-1.368]);
        for h in [2.2, 2.6, 3.0, 3.214] {
            let path = pendulum.motion(start).by(Gauss::<1>::with_step(h)).towards(h).unwrap();
            let Ending::Complete { .. } = path.ending() else { continue };
            let last = path.end();
            let middle = f64::midpoint(start.q[0], last.state().q[0]);
            let off = last.state().v[0] - (start.v[0] - h * middle.sin());
            // What may remain: 4096 units of round-off of a coordinate, over the step length.
            let allowed = 1e-9 + 4096.0 * f64::EPSILON * last.state().q[0].abs();
            assert!(off.abs() < allowed, "{turns} turns, {angle}, {h}: off by {off:e}");
        }
    }
}

/// The midpoint rule keeps the energy of a spring, but for the round-off of 10⁴ steps.
#[test]
fn single_precision_is_iterated_to_the_end() {
    let spring = Spring { m: 1.0_f32, k: 1.0 };
    for h in [0.5, 1.0, 1.5, 1.75] {
        let motion = spring.motion(State::new([1.0_f32], [0.3])).by(Gauss::<1>::with_step(h));
        let path = motion.towards(1e4 * h as f32).unwrap();
        let ratio = path.end().energy() / path.start().energy();
        assert!(!path.ending().is_complete() || (ratio - 1.0).abs() < 0.05, "{h}: {ratio}");
    }
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
