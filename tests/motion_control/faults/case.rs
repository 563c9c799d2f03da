//! One broken motion, and what becomes of it by one method.

use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use lagrange_core::nalgebra::Const;
use lagrange_core::{Lagrangian, Method, prelude::*};

/// Longest time of one motion before it counts as hanging.
const WATCH: Duration = Duration::from_secs(60);

/// What is asked for besides the path.
#[derive(Clone)]
pub(crate) enum Ask {
    Path,
    /// An event whose function is this of the time.
    Event(fn(f64) -> f64),
    /// An event on a coordinate that does not exist.
    UnknownEvent,
    /// Progress that cancels after three steps.
    Cancelled,
    Samples(Vec<f64>),
    Every(f64),
    /// A controller with this interval, which sets the first parameter after half of the time, or fails.
    Controlled(f64, Option<f64>),
    /// Half of the way, then from this state.
    SetState(State<f64, 2>),
    /// Half of the way, then to this time.
    AdvanceTo(f64),
}

/// Which methods are asked.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Scope {
    All,
    FixedSteps,
    StepControl,
}

#[derive(Clone)]
pub(crate) struct Case<L> {
    pub(crate) system: L,
    pub(crate) start: State<f64, 2>,
    pub(crate) end: f64,
    pub(crate) ask: Ask,
    pub(crate) scope: Scope,
    /// Step length or tolerance, if it is not that of the method.
    pub(crate) setting: Option<f64>,
    pub(crate) max_steps: usize,
    pub(crate) wall_time: Option<Duration>,
}

/// The text of the error or of the ending, and the last state.
#[derive(Clone, Debug)]
pub(crate) struct Outcome {
    pub(crate) method: &'static str,
    pub(crate) text: String,
    pub(crate) state: Option<State<f64, 2>>,
}

impl<L> Case<L> {
    pub(crate) fn of(system: L, start: State<f64, 2>, end: f64) -> Self {
        let (ask, scope) = (Ask::Path, Scope::All);
        Self { system, start, end, ask, scope, setting: None, max_steps: 20_000, wall_time: None }
    }

    pub(crate) fn asking(self, ask: Ask) -> Self {
        Self { ask, ..self }
    }

    /// Asks the methods with fixed steps alone, with steps of this length.
    pub(crate) fn with_step(self, step: f64) -> Self {
        Self { scope: Scope::FixedSteps, setting: Some(step), ..self }
    }

    /// Asks the methods with step control alone, with this tolerance.
    pub(crate) fn with_tolerance(self, tolerance: f64) -> Self {
        Self { scope: Scope::StepControl, setting: Some(tolerance), ..self }
    }
}

impl<L> Case<L>
where
    L: Lagrangian<N = Const<2>, Scalar = f64> + SetParameter + Clone + Send + 'static,
{
    /// Runs the motion in a thread of its own, and panics if it panics or hangs.
    pub(crate) fn run<P: Method<L> + Clone + Send + 'static>(
        &self,
        name: &'static str,
        method: P,
    ) -> Outcome {
        let (case, (done, outcome)) = (self.clone(), mpsc::channel());
        thread::spawn(move || done.send(case.outcome(method)));
        let (text, state) = outcome.recv_timeout(WATCH).unwrap_or_else(|error| panic!("{name}: {error}"));
        Outcome { method: name, text, state }
    }

    fn outcome<P: Method<L> + Clone>(&self, method: P) -> (String, Option<State<f64, 2>>) {
        match &self.ask {
            Ask::Samples(_) | Ask::Every(_) | Ask::Controlled(..) => self.sampled(method),
            Ask::SetState(_) | Ask::AdvanceTo(_) => self.steered(method),
            _ => self.stored(method),
        }
        .map_or_else(|error| (error.to_string(), None), |(text, state)| (text, Some(state)))
    }

    fn stored<P: Method<L>>(&self, method: P) -> Result<(String, State<f64, 2>), Error> {
        let motion = self.system.motion(self.start).by(method);
        let path = match self.ask {
            Ask::Event(function) => motion
                .event(self.system.event("bell", move |sample| function(sample.time())))
                .towards(self.end),
            Ask::UnknownEvent => {
                motion.event(self.system.event("bell", |sample| sample.coordinate("z"))).towards(self.end)
            }
            Ask::Cancelled => {
                motion.on_progress(|progress| crate::stop_if(progress.steps >= 3)).towards(self.end)
            }
            _ => motion.towards(self.end),
        }?;
        // What was computed is kept.
        assert!(path.steps().all(|step| step.state().q.iter().chain(&step.state().v).all(|x| x.is_finite())));
        // A step within which the function of an event is not a number is not kept.
        let kept = path.statistics().accepted + 1;
        assert!((kept - 1..=kept).contains(&path.steps().count()));
        let end = *path.end().state();
        assert!(path.ending().time() == end.t || !path.ending().is_complete());
        Ok((path.ending().to_string(), end))
    }

    fn sampled<P: Method<L>>(&self, method: P) -> Result<(String, State<f64, 2>), Error> {
        let motion = self.system.motion(self.start).by(method);
        let path = match self.ask.clone() {
            Ask::Samples(times) => motion.samples_at(times).towards(self.end)?.into_owned(),
            Ask::Every(interval) => motion.every(interval).towards(self.end)?.into_owned(),
            Ask::Controlled(interval, value) => {
                let late = self.end / 2.0;
                let controller = move |system: &mut L, state: &State<f64, 2>| match value {
                    _ if state.t < late => Ok(()),
                    Some(value) => {
                        system.set_first(value);
                        Ok(())
                    }
                    None => Err("the battery is empty"),
                };
                motion.every(0.1).controlled(interval, controller).towards(self.end)?
            }
            _ => unreachable!("no samples"),
        };
        assert!(path.samples().iter().all(|state| state.q.iter().all(|x| x.is_finite())));
        Ok((path.ending().to_string(), *path.end().state()))
    }

    fn steered<P: Method<L>>(&self, method: P) -> Result<(String, State<f64, 2>), Error> {
        let mut motion = Motion::new(self.system.clone(), self.start, method)?;
        motion.advance_to(self.end / 2.0)?;
        let here = *motion.state();
        let text = match self.ask {
            Ask::SetState(state) => {
                motion.set_state(state).map_or_else(|error| error.to_string(), |()| String::new())
            }
            Ask::AdvanceTo(t) => {
                motion.advance_to(t).map_or_else(|error| error.to_string(), |()| String::new())
            }
            _ => unreachable!("not steered"),
        };
        // The motion stays where it was, and goes on.
        assert_eq!(*motion.state(), here);
        motion.advance_to(self.end)?;
        Ok((text, *motion.state()))
    }
}

/// Sets the first parameter.
pub(crate) trait SetParameter {
    fn set_first(&mut self, value: f64);
}
