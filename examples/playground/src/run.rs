//! Motions of a system, sampled for the page.

use lagrange_core::nalgebra::DVector;
use lagrange_core::prelude::*;
use lagrange_core::{Error, Method, generic, nalgebra::Dyn};
use lagrange_interpreter::Model;
use wasm_bindgen::prelude::*;

use crate::Settings;

/// Steps that `RungeKutta4` divides a motion into.
pub(crate) const STEPS: f64 = 5_000.0;

/// Most steps of the other methods: a motion that takes more has come to a stop at a singularity.
const MOST_STEPS: usize = 100_000;

type State = generic::State<f64, Dyn>;

/// A motion, sampled evenly.
#[wasm_bindgen(getter_with_clone)]
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Times of the samples.
    pub times: Vec<f64>,
    /// Coordinates and velocities, sample by sample.
    pub states: Vec<f64>,
    /// Energies.
    pub energies: Vec<f64>,
    /// Conserved quantities, sample by sample.
    pub conserved: Vec<f64>,
    /// Observables, sample by sample.
    pub observables: Vec<f64>,
    /// Multipliers, sample by sample; NaN where there are none.
    pub multipliers: Vec<f64>,
    /// Reason why the motion ends early; empty if it does not.
    pub message: String,
}

impl Run {
    pub(crate) fn of(model: &Model, settings: &Settings<'_>, frames: usize) -> Result<Self, Error> {
        let start = model.state(settings.q.iter().copied(), settings.v.iter().copied());
        let (start, _) = model.project(&start)?;
        match settings.method {
            "Dopri5" => Self::by(
                model,
                start,
                Dopri5::with_tolerance(1e-8).max_steps(MOST_STEPS),
                (settings.end, frames),
            ),
            "RungeKutta4" => {
                Self::by(model, start, RungeKutta4::with_step(settings.end / STEPS), (settings.end, frames))
            }
            _ => Self::by(
                model,
                start,
                Dop853::with_tolerance(1e-10).max_steps(MOST_STEPS),
                (settings.end, frames),
            ),
        }
    }

    fn by<M: Method<Model>>(
        model: &Model,
        start: State,
        method: M,
        (end, frames): (f64, usize),
    ) -> Result<Self, Error> {
        let path = model.motion(start).by(method).towards(end)?;
        let ending = path.ending();
        let message = if ending.is_failure() { ending.to_string() } else { String::new() };
        let mut run = Self { message, ..Self::default() };
        path.samples(frames).try_for_each(|sample| run.push(model, sample.state()))?;
        Ok(run)
    }

    fn push(&mut self, model: &Model, state: &State) -> Result<(), Error> {
        self.times.push(state.t);
        self.states.extend(state.q.iter().chain(&state.v));
        self.energies.push(model.energy(state));
        self.conserved.extend(model.conserved(state)?);
        self.observables.extend(model.observe(state)?);
        let unknown = || DVector::from_element(model.constraints().count(), f64::NAN);
        self.multipliers.extend(model.multipliers(state).unwrap_or_else(|_| unknown()).iter());
        Ok(())
    }
}
