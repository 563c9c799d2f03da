//! A page on which a Lagrangian is typed, and moves. The page asks for a [`Reading`] of its text, and that for a [`Run`].

mod program;
mod run;
#[cfg(test)]
mod tests;

use lagrange_interpreter::{Diagnostic, Model, Parameters, Refusal, System, Unsupported};
pub use run::Run;
use wasm_bindgen::prelude::*;

/// What a text says: a system, or errors.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Reading {
    text: String,
    found: Result<System, Refusal>,
}

/// An error at tokens of the text.
#[wasm_bindgen(getter_with_clone)]
#[derive(Clone, Debug)]
pub struct Fault {
    /// What is wrong, and what to write instead, as the compiler says it.
    pub message: String,
    /// First character, counted in UTF-16 as JavaScript does.
    pub start: usize,
    /// Number of characters.
    pub length: usize,
}

/// Values of the parameters and a start, in the order of their names.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings<'a> {
    pub(crate) parameters: &'a [f64],
    pub(crate) q: &'a [f64],
    pub(crate) v: &'a [f64],
    /// Name of the method.
    pub(crate) method: &'a str,
    pub(crate) end: f64,
}

#[wasm_bindgen]
impl Reading {
    /// Derives the system that a text states.
    #[wasm_bindgen(constructor)]
    pub fn new(text: String) -> Self {
        Self { found: System::parse(&text), text }
    }

    /// Errors; none if the system is derived.
    pub fn faults(&self) -> Vec<Fault> {
        let errors = self.found.as_ref().err().into_iter().flat_map(Refusal::diagnostics);
        errors.map(|error| Fault::of(&self.text, error)).collect()
    }

    /// Name of the struct.
    pub fn name(&self) -> String {
        self.of_system(|system| system.name().to_owned())
    }

    /// Equations as HTML, with formulas in MathML.
    pub fn mathml(&self) -> String {
        self.of_system(|system| system.equations().mathml().to_owned())
    }

    /// Facts, one a line.
    pub fn facts(&self) -> String {
        self.of_system(|system| system.facts().to_string())
    }

    /// Names of the coordinates.
    pub fn coordinates(&self) -> Vec<String> {
        self.of_system(|system| system.coordinates().to_vec())
    }

    /// Names of the parameters.
    pub fn parameters(&self) -> Vec<String> {
        self.of_system(|system| system.parameters().to_vec())
    }

    /// Names of the observables.
    pub fn observables(&self) -> Vec<String> {
        self.of_system(|system| system.observables().to_vec())
    }

    /// Names of the conserved quantities.
    pub fn conserved(&self) -> Vec<String> {
        self.of_system(|system| system.facts().conserved.iter().map(|found| found.name.clone()).collect())
    }

    /// Names of the constraints.
    pub fn constraints(&self) -> Vec<String> {
        self.of_system(|system| system.constraints().iter().map(|found| found.name.clone()).collect())
    }

    /// Reason why the system is derived and does not move here; empty if it moves.
    pub fn unsupported(&self) -> String {
        let unsupported = |system: &System| system.tapes().err().as_ref().map(Unsupported::to_string);
        self.of_system(|system| unsupported(system).unwrap_or_default())
    }

    /// Moves the system from a start, which is projected onto the constraints, and samples the motion evenly `frames` times.
    ///
    /// # Errors
    /// Why there is no motion.
    pub fn run(
        &self,
        parameters: &[f64],
        q: &[f64],
        v: &[f64],
        method: &str,
        end: f64,
        frames: usize,
    ) -> Result<Run, String> {
        let system = self.found.as_ref().map_err(ToString::to_string)?;
        let pairs = system.parameters().iter().cloned().zip(parameters.iter().copied());
        let model = Model::new(system, pairs.collect::<Parameters>()).map_err(|error| error.to_string())?;
        let settings = Settings { parameters, q, v, method, end };
        Run::of(&model, &settings, frames).map_err(|error| error.to_string())
    }

    /// The program that moves the system in Rust; empty if there is none.
    pub fn program(&self, parameters: &[f64], q: &[f64], v: &[f64], method: &str, end: f64) -> String {
        let settings = Settings { parameters, q, v, method, end };
        self.of_system(|system| program::program(&self.text, system, &settings))
    }

    fn of_system<T: Default>(&self, get: impl FnOnce(&System) -> T) -> T {
        self.found.as_ref().map_or_else(|_| T::default(), get)
    }
}

impl Fault {
    fn of(text: &str, error: &Diagnostic) -> Self {
        let length = |text: &str| text.encode_utf16().count();
        let bytes = error.location().map_or(0..0, |location| location.bytes.clone());
        let notes = error.notes().iter().map(|note| format!("\n{note}"));
        Self {
            message: error.message().to_owned() + &notes.collect::<String>(),
            start: length(text.get(..bytes.start).unwrap_or_default()),
            length: length(text.get(bytes).unwrap_or_default()),
        }
    }
}
