//! All settings of a motion can be combined: events, progress, methods, kinds of start, and both directions of time.
//!
//! | start | events, progress, `to`, `towards` | methods |
//! |---|---|---|
//! | `State` | all | all |
//! | `PhaseState` | all | pairs; not `Taylor`, whose series are those of Lagrange's equations (does not compile) |
//! | `StateSensitivity` | all; events that can be differentiated, others do not compile | pairs, `Taylor` where the number type is a parameter |

use core::ops::ControlFlow;

use lagrange_core::{Ending, linearized::TrajectorySensitivity, motion::Progress, prelude::*};

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k/2 * x^2)]
struct Spring<T> {
    k: T,
}

const SPRING: Spring<f64> = Spring { k: 1.0 };

/// x = cos t is zero at π/2, 3π/2, 5π/2; the motion goes to ±10.
const ZEROS: [f64; 3] = [0.5, 1.5, 2.5];

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
            let mut steps = 0;
            let look = |_| {
                steps += 1;
                if steps == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            };
            // Settings come in any order.
            let asked = SPRING.$asked($start).on_progress(look).event(event("zero")).by($method);
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
    asked!(motion(start), Dopri5::default(), event, |path| path);
    asked!(motion(start), Taylor::default(), event, |path| path);
    asked!(motion(start), RungeKutta4::with_step(1e-2), event, |path| path);
}

#[test]
fn a_motion_from_momenta_is_asked_for_everything() {
    let start = PhaseState::new([1.0], [0.0]);
    asked!(motion_in_momenta(start), Dop853::default(), event, |path| path);
    asked!(motion_in_momenta(start), Dopri5::default(), event, |path| path);
}

fn path_of<'m, 's>(
    motion: &'m TrajectorySensitivity<'s, Spring<f64>, 1, 0, 1>,
) -> &'m Trajectory<&'s Spring<f64>, 1, 0> {
    motion.trajectory()
}

#[test]
fn a_motion_with_derivatives_is_asked_for_everything() {
    let start = SPRING.sensitivity(&State::at_rest([1.0]), &["x", "k"]).expect("names");
    asked!(motion_with_derivatives(&start), Dop853::default(), differentiable_event, path_of);
    asked!(motion_with_derivatives(&start), Dopri5::default(), differentiable_event, path_of);
    asked!(motion_with_derivatives(&start), Taylor::default(), differentiable_event, path_of);
}
