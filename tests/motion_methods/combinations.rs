//! All settings of a motion can be combined: events, progress, methods, kinds of start, what is kept, who steers, and both
//! directions of time.
//!
//! | start | kept | events, progress, `to`, `towards` | controller | methods |
//! |---|---|---|---|---|
//! | `State` | all steps | all | no: a state between steps would be one of other parameters; who asks for it keeps samples alone | all |
//! | `State` | samples | all | yes | all |
//! | `PhaseState` | all steps, samples | as `State` | as `State` | pairs; not `Taylor`, whose series are those of Lagrange's equations, nor `Radau` and the methods of fixed steps (does not compile) |
//! | `StateSensitivity` | all steps, samples | all; events that can be differentiated, others do not compile | no: what it sets depends on the state by a function that is not differentiated (does not compile) | pairs, `RungeKutta4` and `Radau`; `Taylor`, `Verlet`, `Gauss`, `Lobatto` and `DAlembert` where the number type is a parameter |
//! | member of an `Ensemble`, see `tests/ensembles` | samples | all; progress is `observe` | yes | all |
//! | the same on lanes | samples | all; progress is `observe` | yes | pairs, `Taylor` |
//!
//! What does not compile stands in `tests/rustc/cases`: `motions_that_cannot_be_asked_for.rs`.

use core::ops::ControlFlow;

#[cfg(feature = "thorough")]
use lagrange_core::linearized::TrajectorySensitivity;
#[cfg(feature = "thorough")]
use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::motion::Progress;
use lagrange_core::{Ending, prelude::*};
use lagrange_systems::Spring;

const SPRING: Spring<f64> = Spring { m: 1.0, k: 1.0 };

/// x = cos t is zero at π/2, 3π/2, 5π/2; the motion goes to ±10.
const ZEROS: [f64; 3] = [0.5, 1.5, 2.5];

/// Progress that cancels after the second step.
fn second_step() -> impl FnMut(Progress) -> ControlFlow<()> {
    |progress| if progress.steps == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Integrates from this start by this method, forward and backward: with events and progress, cancelled, and with too few steps.
macro_rules! asked {
    ($asked:ident($start:expr), $method:expr, $event:ident, $trajectory:expr) => {
        for sign in [1.0, -1.0] {
            let event = |name| SPRING.$event(name, |s| s.coordinate("x"));
            let (mut looks, end) = (Vec::new(), 10.0 * sign);
            let look = |progress: Progress| {
                looks.push(progress);
                ControlFlow::Continue(())
            };
            // Two events, one by value and one lent, one of which ends the motion.
            let mut third = event("third").terminal_at(3);
            let asked = SPRING.$asked($start).by($method).event(event("zero")).event(&mut third);
            let motion = asked.on_progress(look).to(end).expect("a motion");
            let path = $trajectory(&motion);
            assert!(matches!(path.ending(), Ending::Event { event: "third", .. }));
            let found: Vec<_> = path.crossings().iter().filter(|crossing| crossing.index == 0).collect();
            assert_eq!(found.len(), 3);
            for (crossing, part) in found.iter().zip(ZEROS) {
                assert!((crossing.state.t - sign * part * core::f64::consts::PI).abs() < 1e-6);
            }
            // After every step but the one that the event is in.
            assert_eq!(looks.len() + 1, path.statistics().accepted);
            assert!(looks.windows(2).all(|pair| (pair[1].time - pair[0].time) * sign > 0.0));
            assert!(looks.iter().all(|look| (look.start, look.end) == (0.0, end)));

            // Cancelled after the second step; `to` takes that for an end.
            // Settings come in any order.
            let asked = SPRING.$asked($start).on_progress(second_step()).event(event("zero")).by($method);
            let cancelled = asked.to(end).expect("a motion");
            let path = $trajectory(&cancelled);
            assert!(matches!(path.ending(), Ending::Cancelled { .. }) && path.statistics().accepted == 2);

            // What is looked at changes nothing.
            let plain = SPRING.$asked($start).by($method).to(end).expect("a motion");
            let watched = SPRING.$asked($start).by($method).event(event("zero")).to(end).expect("a motion");
            let states = [&plain, &watched].map(|motion| *$trajectory(motion).end().state());
            assert_eq!(states[0], states[1]);

            // What was computed until a failure is kept by `towards` alone.
            let short = || SPRING.$asked($start).by($method.max_steps(2)).event(event("zero"));
            assert!(matches!(short().to(end), Err(Error::Unfinished(_))));
            let kept = short().towards(end).expect("a motion");
            assert!(matches!($trajectory(&kept).ending(), Ending::StepLimit { steps: 2, .. }));
            assert_eq!($trajectory(&kept).steps().count(), $trajectory(&kept).statistics().accepted + 1);
        }
    };
}

#[test]
fn a_motion_from_a_state_is_asked_for_everything() {
    let start = State::at_rest([1.0]);
    asked!(motion(start), Dop853::default(), event, |path| path);
    #[cfg(feature = "thorough")]
    {
        asked!(motion(start), Dopri5::default(), event, |path| path);
        asked!(motion(start), Taylor::default(), event, |path| path);
        asked!(motion(start), RungeKutta4::with_step(1e-2), event, |path| path);
        asked!(motion(start), Verlet::with_step(0.2).composed(KahanLi8), event, |path| path);
        asked!(motion(start), Gauss::<3>::with_step(0.1), event, |path| path);
        asked!(motion(start), Lobatto::<4>::with_step(0.1), event, |path| path);
        asked!(motion(start), DAlembert::with_step(0.2).composed(KahanLi8), event, |path| path);
        asked!(motion(start), Radau::with_tolerance(1e-12), event, |path| path);
    }
}

#[cfg(feature = "thorough")]
#[test]
fn a_motion_from_momenta_is_asked_for_everything() {
    let start = PhaseState::new([1.0], [0.0]);
    asked!(motion_in_momenta(start), Dop853::default(), event, |path| path);
    asked!(motion_in_momenta(start), Dopri5::default(), event, |path| path);
}

#[cfg(feature = "thorough")]
#[test]
fn a_motion_with_derivatives_is_asked_for_everything() {
    fn path_of<'m, 's>(
        motion: &'m TrajectorySensitivity<'s, Spring<f64>>,
    ) -> &'m Trajectory<&'s Spring<f64>> {
        motion
    }
    let start = SPRING.sensitivity(&State::at_rest([1.0]), &["x", "k"]).expect("names");
    let verlet = Verlet::with_step(0.2).composed(KahanLi8);
    asked!(motion_with_derivatives(&start), Dop853::default(), differentiable_event, path_of);
    asked!(motion_with_derivatives(&start), Dopri5::default(), differentiable_event, path_of);
    asked!(motion_with_derivatives(&start), Taylor::default(), differentiable_event, path_of);
    asked!(motion_with_derivatives(&start), verlet, differentiable_event, path_of);
    asked!(motion_with_derivatives(&start), Gauss::<3>::with_step(0.1), differentiable_event, path_of);
    asked!(motion_with_derivatives(&start), Radau::with_tolerance(1e-12), differentiable_event, path_of);
}

/// Keeps samples alone, from this start by this method: they are those of the motion that is stored, with the same steps and crossings.
macro_rules! sampled {
    ($asked:ident($start:expr), $method:expr) => {
        for sign in [1.0, -1.0] {
            let (end, every) = (10.0 * sign, 0.25);
            let zero = || SPRING.event("zero", |s| s.coordinate("x"));
            let stored = SPRING.$asked($start).by($method).event(zero()).to(end).expect("a motion");
            let mut looks = 0;
            let look = |progress: Progress| {
                looks += 1;
                assert_eq!((progress.start, progress.end, progress.steps), (0.0, end, looks));
                ControlFlow::Continue(())
            };
            let asked = SPRING.$asked($start).every(every).by($method).event(zero()).on_progress(look);
            let asked = asked.quantity("x", |s| s.coordinate("x"));
            let path = asked.quantity("twice", |s| 2.0 * s.state().q[0]).to(end).expect("a motion");
            assert_eq!(
                (path.start().state(), path.end().state()),
                (stored.start().state(), stored.end().state())
            );
            assert_eq!((path.ending(), path.adjustment()), (stored.ending(), stored.adjustment()));
            assert_eq!(path.crossings(), stored.crossings());
            assert_eq!((path.samples().len(), path.values().len()), (41, 82));
            assert!(path.quantity("x").unwrap().eq(path.samples().iter().map(|state| state.q[0])));
            assert_eq!(looks, path.statistics().accepted);
            for (k, (state, values)) in path.samples().iter().zip(path.values().chunks(2)).enumerate() {
                assert_eq!(state.t, sign * every * k as f64);
                assert_eq!(state, stored.at(state.t).expect("within").state());
                assert_eq!(values, [state.q[0], 2.0 * state.q[0]]);
            }
            let table = path.csv().to_string();
            assert_eq!(table.lines().next(), Some("t,x,x_dot,x,twice"));
            let last = path.samples()[40];
            let [t, q, v] = [last.t, last.q[0], last.v[0]];
            assert_eq!(table.lines().last(), Some(&*format!("{t:?},{q:?},{v:?},{q:?},{:?}", 2.0 * q)));
            let given = SPRING.$asked($start).samples_at([1.0 * sign, 7.5 * sign]).by($method).to(end);
            let given = given.expect("a motion");
            assert_eq!(given.samples(), [path.samples()[4], path.samples()[30]]);
            assert!(given.quantity("x").is_err());

            // An event that ends the motion: samples up to there.
            let ends = SPRING.$asked($start).event(zero().terminal()).every(every).by($method).to(end);
            let ends = ends.expect("a motion");
            assert!(matches!(ends.ending(), Ending::Event { event: "zero", .. }));
            assert_eq!((ends.samples().len(), ends.crossings()[0].state), (7, *ends.end().state()));

            // Cancelled after the second step, and with too few steps.
            let cancelled =
                SPRING.$asked($start).samples_at([]).on_progress(second_step()).by($method).to(end);
            let cancelled = cancelled.expect("a motion");
            assert!(matches!(cancelled.ending(), Ending::Cancelled { .. }));
            assert_eq!(cancelled.statistics().accepted, 2);
            let short = || SPRING.$asked($start).by($method.max_steps(2)).every(every);
            assert!(matches!(short().to(end), Err(Error::Unfinished(_))));
            let kept = short().towards(end).expect("a motion");
            assert!(matches!(kept.ending(), Ending::StepLimit { steps: 2, .. }));
            assert_eq!(kept.samples().len(), 1 + (kept.end().state().t.abs() / every) as usize);
        }
    };
}

/// Derivatives of samples are those of the motion that is stored, bit for bit, at its events too.
#[test]
fn derivatives_are_sampled_instead_of_stored() {
    let start = SPRING.sensitivity(&State::at_rest([1.0]), &["x", "k"]).expect("names");
    let dop853 = || SPRING.motion_with_derivatives(&start).by(Dop853::default());
    let zero = || SPRING.differentiable_event("zero", |s| s.coordinate("x"));
    macro_rules! both {
        ($method:expr, $end:ident) => {{
            let by = || SPRING.motion_with_derivatives(&start).by($method).event(zero());
            (by().to($end), by().every(0.25).to($end), 41)
        }};
    }
    for sign in [1.0, -1.0] {
        let end = 10.0 * sign;
        let terminal = || dop853().event(zero().terminal());
        let ends = [
            both!(Dop853::default(), end),
            (terminal().to(end), terminal().every(0.25).to(end), 7),
            (dop853().to(end), dop853().samples_at([0.0, 2.5 * sign]).to(end), 2),
            #[cfg(feature = "thorough")]
            both!(Taylor::default(), end),
            #[cfg(feature = "thorough")]
            both!(Radau::with_tolerance(1e-12), end),
        ];
        for (stored, sampled, count) in ends {
            let (stored, sampled) = (stored.expect("a motion"), sampled.expect("a motion"));
            assert_eq!(
                sampled.derivatives_at_end().expect("the end"),
                stored.derivatives_at_end().expect("the end")
            );
            assert_eq!((sampled.crossings(), sampled.ending()), (stored.crossings(), stored.ending()));
            assert_eq!(
                (sampled.end().state(), sampled.arguments()),
                (stored.end().state(), stored.arguments())
            );
            assert_eq!((sampled.samples().len(), sampled.derivatives().len()), (count, count));
            for (sample, state) in sampled.derivatives().iter().zip(sampled.samples()) {
                assert_eq!(
                    (sample, &sample.state),
                    (&stored.derivatives_at(state.t).expect("within"), state)
                );
            }
        }
        let (mut steps, short) = (0, || dop853().every(0.25).by(Dop853::default().max_steps(2)));
        let look = |progress: Progress| {
            steps += 1;
            assert_eq!((progress.start, progress.end, progress.steps), (0.0, end, steps));
            if steps == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let cancelled = dop853().every(0.25).on_progress(look).to(end).expect("a motion");
        assert!(matches!(cancelled.ending(), Ending::Cancelled { .. }));
        assert!(matches!(short().to(end), Err(Error::Unfinished(_))));
        let kept = short().towards(end).expect("a motion");
        assert!(
            matches!(kept.ending(), Ending::StepLimit { steps: 2, .. }) && kept.derivatives_at_end().is_err()
        );
        assert_eq!(kept.samples().len(), kept.derivatives().len());
    }
}

/// Steers a motion, which then goes as one that is advanced from call to call, bit for bit.
macro_rules! steered {
    ($asked:ident($start:expr), $method:expr, $new:expr) => {
        for sign in [1.0, -1.0] {
            let (mut calls, soft) = (0, Spring { k: 0.5, ..SPRING });
            let rises = soft.event("rises", |s| s.state().q[0] + 0.5).rising();
            // Settings come in any order.
            let steered = soft.$asked($start).event(rises).controlled(0.5, |spring, state| {
                calls += 1;
                spring.k = 1.0 + state.q[0] * state.q[0];
                if calls < 20 { Ok(()) } else { Err("tired") }
            });
            let steered = steered.quantity("k", |s| s.system().k).by($method).every(0.25);
            let path = steered.towards(10.0 * sign).expect("a motion");
            let failed = Ending::ControllerFailed { time: 9.5 * sign, said: "tired".into() };
            assert_eq!(*path.ending(), failed);
            let mut alone = $new(soft, $start, $method).expect("a start");
            // Samples are taken before the call at their time: at the start with the parameter as given.
            let mut expected = vec![0.5];
            for call in 1..20_usize {
                alone.system_mut().k = 1.0 + alone.state().q[0] * alone.state().q[0];
                expected.extend([alone.system().k; 2]);
                alone.advance_to(sign * 0.5 * call as f64).expect("a motion");
                assert_eq!(path.samples()[2 * call], *alone.state());
            }
            assert_eq!((path.samples().len(), path.values()), (39, &expected[..]));
            assert_eq!((calls, path.end().state()), (20, alone.state()));
            // The end has the system as the controller leaves it.
            assert_eq!(path.system().k, 1.0 + alone.state().q[0] * alone.state().q[0]);
            assert!(!path.crossings().is_empty());
            assert_eq!(soft.k, 0.5);
        }
    };
}

#[test]
fn a_motion_is_sampled_instead_of_stored() {
    let start = State::at_rest([1.0]);
    sampled!(motion(start), Dop853::default());
    #[cfg(feature = "thorough")]
    {
        let momenta = PhaseState::new([1.0], [0.0]);
        sampled!(motion(start), Dopri5::default());
        sampled!(motion(start), Taylor::default());
        sampled!(motion(start), RungeKutta4::with_step(1e-2));
        sampled!(motion(start), Verlet::with_step(0.2).composed(KahanLi8));
        sampled!(motion(start), Gauss::<3>::with_step(0.1));
        sampled!(motion(start), Radau::with_tolerance(1e-12));
        sampled!(motion_in_momenta(momenta), Dop853::default());
        sampled!(motion_in_momenta(momenta), Dopri5::default());
    }
}

#[test]
fn a_motion_is_steered() {
    let start = State::at_rest([1.0]);
    steered!(motion(start), Dop853::default(), Motion::new);
    #[cfg(feature = "thorough")]
    {
        steered!(motion(start), Dopri5::default(), Motion::new);
        steered!(motion(start), Taylor::default(), Motion::new);
        steered!(motion(start), RungeKutta4::with_step(1e-2), Motion::new);
        steered!(motion(start), Verlet::with_step(0.1), Motion::new);
        steered!(motion(start), Gauss::<2>::with_step(0.1), Motion::new);
        steered!(motion(start), Radau::default(), Motion::new);
        steered!(motion_in_momenta(PhaseState::new([1.0], [0.0])), Dop853::default(), Motion::in_momenta);
    }
}

/// What cannot be sampled is told before the first step. Intervals and times are in `motion_control/faults`.
#[test]
fn samples_that_cannot_be_taken_are_refused() {
    let motion = || SPRING.motion(State::at_rest([1.0])).every(0.1);
    let unknown = motion().quantity("y", |s| s.coordinate("y")).to(1.0).expect_err("a name");
    assert!(matches!(unknown, Error::UnknownName { .. }), "{unknown}");
    let far = motion().to(f64::INFINITY).expect_err("an end");
    assert!(matches!(far, Error::EndNotFinite { .. }), "{far}");
    let fine = SPRING.motion(State::at_rest([1.0])).every(1e-16).to(1.0).expect_err("an interval");
    assert!(matches!(fine, Error::Setting { name: "interval of the samples", .. }), "{fine}");
    // Nothing to integrate: the start alone.
    assert_eq!(motion().to(0.0).expect("a motion").samples().len(), 1);
}
