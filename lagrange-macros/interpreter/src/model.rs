//! Systems with values of their parameters.

use std::cell::Cell;
use std::fmt::{self, Debug, Formatter};

use lagrange_core::generated::nan_if_ill_conditioned;
use lagrange_core::nalgebra::{DVector, Dyn};
use lagrange_core::{Error, generic};
use lagrange_derive::facts::ConstraintKind;
use lagrange_derive::{Arguments, System, Tape, Tapes};

use crate::dense::DenseEquations;
use crate::error::ModelError;
use crate::parameters::{ParameterNames, Parameters, Values};

/// Time, coordinates and velocities.
pub(crate) type State = generic::State<f64, Dyn>;

/// A mechanical system that was read from a text, with values of its parameters. It moves as every system of `lagrange-core` whose number
/// of coordinates is known when the program runs.
///
/// ```
/// use lagrange_core::prelude::*;
/// use lagrange_interpreter::{Model, System};
///
/// let system = System::parse(
///     "#[coordinates(x, y)]
///      #[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
///      #[constraint(rod: x^2 + y^2 = l^2)]
///      struct Pendulum { m: f64, g: f64, l: f64 }",
/// )?;
/// let mut pendulum = Model::new(&system, [("m", 2.0), ("g", 10.0), ("l", 1.0)])?;
/// let start = pendulum.at_rest([0.0, -1.0]);
/// // λ ∂Φ/∂y holds the weight.
/// assert_eq!(pendulum.multipliers(&start)?[0] * 2.0 * start.q[1], 20.0);
/// pendulum.set("m", 3.0)?;
/// assert_eq!(pendulum.multipliers(&start)?[0] * 2.0 * start.q[1], 30.0);
///
/// let path = pendulum.integrate(pendulum.state([0.0, -1.0], [2.0, 0.0]), 10.0, Dop853::default())?;
/// let end = path.end().state().clone();
/// assert!((end.q.norm() - 1.0).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Model {
    pub(crate) coordinates: Vec<String>,
    pub(crate) constraints: Vec<(String, ConstraintKind)>,
    observables: Vec<String>,
    conserved: Vec<String>,
    parameters: ParameterNames,
    pub(crate) values: Vec<f64>,
    pub(crate) tapes: Tapes,
    pub(crate) digest: u32,
}

impl Model {
    /// Compiles the functions of a system, and sets its parameters.
    ///
    /// # Errors
    ///
    /// [`ModelError::Unsupported`] if parts of the system are not evaluated without a compiler, and [`ModelError::Parameters`] with each
    /// parameter that is missing, unknown or not finite.
    pub fn new(system: &System, parameters: impl Into<Parameters>) -> Result<Self, ModelError> {
        let mut tapes = system.tapes()?;
        let names = ParameterNames { names: system.parameters().to_vec(), fields: tapes.parameters.clone() };
        let values = names.all(parameters.into())?;
        tapes.bind(&values);
        let constraints = system.constraints().iter().map(|found| (found.name.clone(), found.kind));
        Ok(Self {
            coordinates: system.coordinates().to_vec(),
            constraints: constraints.collect(),
            observables: system.observables().to_vec(),
            conserved: system.facts().conserved.iter().map(|conserved| conserved.name.clone()).collect(),
            parameters: names,
            values,
            tapes,
            digest: digest(system.equations().text()),
        })
    }

    /// Changes a parameter, or all of a field.
    ///
    /// # Errors
    ///
    /// [`ModelError::Parameters`] if the parameter is unknown or not finite, or the number of values is wrong.
    pub fn set(&mut self, name: &str, values: impl Into<Values>) -> Result<(), ModelError> {
        let assigned = self.parameters.assigned(name, &values.into()).map_err(|error| vec![error])?;
        assigned.into_iter().for_each(|(place, value)| self.values[place] = value);
        self.tapes.bind(&self.values);
        Ok(())
    }

    /// Parameters and their values, in the order of the fields.
    pub fn parameters(&self) -> impl Iterator<Item = (&str, f64)> {
        self.parameters.names.iter().map(String::as_str).zip(self.values.iter().copied())
    }

    /// Names of the coordinates: `x`, `r[0]`, `r[1]`.
    pub fn coordinates(&self) -> &[String] {
        &self.coordinates
    }

    /// Names of the constraints, in the order of the multipliers.
    pub fn constraints(&self) -> impl Iterator<Item = &str> {
        self.constraints.iter().map(|(name, _)| name.as_str())
    }

    /// Names of the observables, one for each number that [`observe`](Self::observe) returns.
    pub fn observables(&self) -> &[String] {
        &self.observables
    }

    /// Names of the conserved quantities, one for each number that [`conserved`](Self::conserved) returns.
    pub fn conserved_names(&self) -> &[String] {
        &self.conserved
    }

    /// Observables at a state. Those with accelerations or multipliers have the values of the motion through this state.
    ///
    /// # Errors
    ///
    /// [`Error::StateLength`] and [`Error::StateNotFinite`].
    pub fn observe(&self, state: &State) -> Result<Vec<f64>, Error> {
        self.check_entries(state)?;
        let (q, v) = (state.q.as_slice(), state.v.as_slice());
        let solution = self.solution(state.t, q, v);
        let (accelerations, multipliers) = solution.as_slice().split_at(q.len());
        Ok(results(&self.tapes.observables, &Arguments { accelerations, multipliers, ..at(state) }))
    }

    /// Conserved quantities at a state: their values stay the same along a motion, to the error of the method.
    ///
    /// # Errors
    ///
    /// [`Error::StateLength`] and [`Error::StateNotFinite`].
    pub fn conserved(&self, state: &State) -> Result<Vec<f64>, Error> {
        self.check_entries(state)?;
        Ok(results(&self.tapes.conserved, &at(state)))
    }

    /// Residuals of the constraints at a state: Φ of each, zero for velocity constraints, and its rate F q̇ + b.
    ///
    /// # Errors
    ///
    /// [`Error::StateLength`] and [`Error::StateNotFinite`].
    pub fn residuals(&self, state: &State) -> Result<[Vec<f64>; 2], Error> {
        self.check_entries(state)?;
        let all = results(&self.tapes.constraints, &at(state));
        let m = self.constraints.len();
        Ok([all[..m].to_vec(), all[m..2 * m].to_vec()])
    }

    /// Accelerations, followed by multipliers. All are NaN if the equations have no solution that is to be trusted.
    pub(crate) fn solution(&self, t: f64, q: &[f64], v: &[f64]) -> DVector<f64> {
        let mut solution = DVector::zeros(q.len() + self.constraints.len());
        self.write_solution(&Arguments { t, q, v, ..Arguments::default() }, solution.as_mut_slice());
        solution
    }

    /// Writes accelerations, and multipliers as far as there is room.
    pub(crate) fn write_solution(&self, at: &Arguments<'_>, to: &mut [f64]) {
        let is_written = self.tapes.elimination.as_ref().is_some_and(|elimination| {
            with_results(&elimination.accelerations, at, |found| write_trusted(found, to))
        });
        if is_written {
            return;
        }
        match self.dense(at, None) {
            Some(solution) => to.iter_mut().zip(&solution).for_each(|(to, value)| *to = *value),
            None => to.fill(f64::NAN),
        }
    }

    /// Solves M x = Fᵀλ and F x + γ = 0 for x and λ, one behind the other; `None` if they have no solution that is to be trusted.
    pub(crate) fn correction(&self, at: &Arguments<'_>, bias: &[f64]) -> Option<DVector<f64>> {
        let zeros = vec![0.0; self.coordinates.len()];
        let eliminated = self.tapes.elimination.as_ref().and_then(|elimination| {
            let factor = results(&elimination.factor, at);
            let right = Arguments { factor: &factor, forcing: &zeros, bias, ..Arguments::default() };
            let mut solution = DVector::zeros(zeros.len() + bias.len());
            let to = solution.as_mut_slice();
            with_results(&elimination.solve, &right, |found| write_trusted(found, to)).then_some(solution)
        });
        eliminated.or_else(|| self.dense(at, Some([&zeros, bias])))
    }

    /// Solves the equations of motion, or those with other right-hand sides h and γ, by the general solver.
    #[cold]
    fn dense(&self, at: &Arguments<'_>, right: Option<[&[f64]; 2]>) -> Option<DVector<f64>> {
        let n = self.coordinates.len();
        let all = results(&self.tapes.equations, at);
        let (mass, rest) = all.split_at(n * n);
        let (forcing, rest) = rest.split_at(n);
        let (jacobian, bias) = rest.split_at(n * self.constraints.len());
        let [forcing, bias] = right.unwrap_or([forcing, bias]);
        DenseEquations { mass, forcing, jacobian, bias }.solve()
    }
}

/// Writes the results of an elimination before its pivot, as far as there is room. Returns false if they are not to be trusted, by the
/// bound of the emitted code.
fn write_trusted(found: &[f64], to: &mut [f64]) -> bool {
    let Some((pivot, found)) = found.split_last() else { return false };
    to.iter_mut().zip(found).for_each(|(to, value)| *to = *value);
    nan_if_ill_conditioned(*pivot, 1.0) == 0.0 && found.iter().all(|value| value.is_finite())
}

/// Arguments of a function of the state.
pub(crate) fn at(state: &State) -> Arguments<'_> {
    Arguments { t: state.t, q: state.q.as_slice(), v: state.v.as_slice(), ..Arguments::default() }
}

pub(crate) fn results(tape: &Tape, at: &Arguments<'_>) -> Vec<f64> {
    with_results(tape, at, <[f64]>::to_vec)
}

/// Calls a function with the results of a tape, with registers that the thread keeps.
pub(crate) fn with_results<R>(tape: &Tape, at: &Arguments<'_>, function: impl FnOnce(&[f64]) -> R) -> R {
    thread_local! {
        static REGISTERS: Cell<Vec<f64>> = const { Cell::new(Vec::new()) };
    }
    let mut registers = REGISTERS.take();
    let result = function(tape.evaluate(at, &mut registers));
    REGISTERS.set(registers);
    result
}

/// FNV-1a hash of a text (Fowler, Noll and Vo).
fn digest(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

impl Debug for Model {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_map().entries(self.parameters()).finish()
    }
}
