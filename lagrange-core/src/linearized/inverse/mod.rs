//! Inverse dynamics: inputs that produce given accelerations.

mod completed;
mod regressor;

use alloc::{format, string::String, vec::Vec};

use nalgebra::{ComplexField, DMatrix, DVector};

pub(crate) use completed::complete;
pub use regressor::{BaseParameters, Regressor};
pub(crate) use regressor::{inertial_parameters, regressor};

use super::Linearized;
use super::argument::{Argument, set_parameter};
use crate::error::Error;
use crate::number::limits::CANCELLED;
use crate::number::limits::ITERATIONS;
use crate::number::{Real, Scalar, larger, power_of_epsilon, unit_of};
use crate::numerics::singular::Singular;
use crate::solution::consistent::gradient::check_parameters;
use crate::solution::kkt::Units;
use crate::solution::solve::{first_row, row};
use crate::system::{Solution, StateOf, finite::check_finite, unit};
use crate::vector::{Array, Element, StaticLength, Vector, rows, zeros};

/// Inputs and multipliers that produce given accelerations.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseDynamics<T: Element, M: StaticLength> {
    /// Generalized forces on the named coordinates, and values of the named parameters.
    pub inputs: DVector<T>,
    /// Multipliers λ of the constraints. If constraints are dependent, those of least norm, in units in which the rows
    /// of F have length 1.
    pub multipliers: Vector<T, M>,
    names: Vec<String>,
}

impl<T: Element, M: StaticLength> InverseDynamics<T, M> {
    /// Names of the inputs, in their order.
    pub fn names(&self) -> &[String] {
        &self.names
    }
}

/// See [`Linearized::inputs_for`].
pub(crate) fn inputs_for<L: Linearized<Scalar: Real> + Clone>(
    system: &L,
    state: &StateOf<L>,
    accelerations: &Vector<L::Scalar, L::N>,
    names: &[&str],
) -> Result<InverseDynamics<L::Scalar, L::M>, Error> {
    check_finite(system, state)?;
    check_parameters(system, state)?;
    let inputs = Argument::actuators::<L>(names)?;
    let mut balance = InputBalance::new(system.clone(), state, accelerations, inputs)?;
    for _ in 0..ITERATIONS {
        let step = balance.step()?;
        if balance.go(&step) {
            break;
        }
    }
    balance.check()?;
    let InputBalance { inputs, values, multipliers, .. } = balance;
    let names = inputs.iter().map(|input| format!("{}", input.entry::<L>())).collect();
    Ok(InverseDynamics { inputs: values, multipliers, names })
}

/// Solves M a = h + Fᵀλ + Σ τ and F a + γ = 0 for inputs and multipliers; holds the current guess.
struct InputBalance<'a, L: Linearized> {
    /// The system, with the current values of the inputs that are parameters.
    system: L,
    state: &'a StateOf<L>,
    accelerations: &'a Vector<L::Scalar, L::N>,
    inputs: Vec<Argument>,
    values: DVector<L::Scalar>,
    multipliers: Vector<L::Scalar, L::M>,
    /// Units in which masses are 1 and rows of constraints have length 1.
    units: Units<L::Scalar, L::N, L::M>,
}

impl<'a, L: Linearized<Scalar: Real>> InputBalance<'a, L> {
    fn new(
        mut system: L,
        state: &'a StateOf<L>,
        accelerations: &'a Vector<L::Scalar, L::N>,
        inputs: Vec<Argument>,
    ) -> Result<Self, Error> {
        let (zero, parameters) = (L::Scalar::constant(0.0), system.parameters());
        let mut values = DVector::from_element(inputs.len(), zero);
        for (value, input) in values.iter_mut().zip(&inputs) {
            let Argument::Parameter(k) = *input else { continue };
            *value = parameters[k];
            set_parameter(&mut system, k, parameters[k])?;
        }
        let f = rows(&system.constraint_jacobian(state));
        let units = Units::of(&system.mass_matrix(state).into(), &f);
        Ok(Self { system, state, accelerations, inputs, values, multipliers: zeros(), units })
    }

    /// Converts a number of row `i` to the unit of that row. The rows of motion come first.
    fn scaled(&self, i: usize, x: L::Scalar) -> L::Scalar {
        if i < <L::N>::COUNT {
            x * self.units.coordinates[i]
        } else {
            self.units.of_row(i - <L::N>::COUNT, x)
        }
    }

    /// Residual of each row.
    fn residual(&self) -> Result<DVector<L::Scalar>, Error> {
        let Self { system, state, accelerations, .. } = self;
        let mut motion = system.inverse_dynamics(state, accelerations, &self.multipliers);
        for (input, value) in self.inputs.iter().zip(&self.values) {
            if let Argument::Coordinate(i) = *input {
                motion[i] -= *value;
            }
        }
        let (f, bias, zero) =
            (system.constraint_jacobian(state), system.constraint_bias(state), L::Scalar::constant(0.0));
        let demanded: Array<_, L::M> = Array::from_fn(|a| {
            (0..<L::N>::COUNT).fold(zero, |sum, i| sum + f[(a, i)] * accelerations[i]) + bias[a]
        });
        if let Some(row) = first_row::<L>(|i| !motion[i].is_finite(), |a| !demanded[a].is_finite()) {
            return Err(Error::EquationsNotFinite { row, time: state.t.to_f64() });
        }
        let rows = motion.iter().chain(&demanded).enumerate();
        Ok(DVector::from_iterator(<L::N>::COUNT + <L::M>::COUNT, rows.map(|(i, x)| self.scaled(i, *x))))
    }

    /// Derivatives of the rows by each input and each multiplier.
    fn jacobian(&self) -> Result<DMatrix<L::Scalar>, Error> {
        let Self { system, state, multipliers, .. } = self;
        let here = Solution::given(*self.accelerations, *multipliers);
        let (one, count) = (L::Scalar::constant(1.0), self.inputs.len());
        let mut jacobian = DMatrix::zeros(<L::N>::COUNT + <L::M>::COUNT, count + <L::M>::COUNT);
        for (j, input) in self.inputs.iter().enumerate() {
            if let Argument::Coordinate(i) = *input {
                jacobian[(i, j)] = self.scaled(i, -one);
            }
            let Argument::Parameter(k) = *input else { continue };
            let change = system.residual_change_by_parameters(state, &here, &unit(k));
            for (i, x) in change.motion.iter().chain(&change.acceleration).enumerate() {
                jacobian[(i, j)] = self.scaled(i, *x);
            }
            if let Some(i) = jacobian.column(j).iter().position(|x| !x.is_finite()) {
                let (row, entry) = (row::<L>(i), input.entry::<L>());
                return Err(Error::DerivativeNotFinite { row, entry, time: state.t.to_f64() });
            }
        }
        let f = system.constraint_jacobian(state);
        for (i, a) in (0..<L::N>::COUNT).flat_map(|i| (0..<L::M>::COUNT).map(move |a| (i, a))) {
            jacobian[(i, count + a)] = self.scaled(i, -f[(a, i)]);
        }
        Ok(jacobian)
    }

    /// Newton step of least norm. Fails if an input is undetermined.
    fn step(&self) -> Result<DVector<L::Scalar>, Error> {
        let (residual, mut jacobian) = (self.residual()?, self.jacobian()?);
        let columns = jacobian.ncols();
        // Scale columns to length 1: the step then does not depend on the units of inputs and multipliers.
        let lengths = DVector::from_fn(columns, |j, _| unit_of(jacobian.column(j).norm()));
        (0..columns).for_each(|j| jacobian.column_mut(j).unscale_mut(lengths[j]));
        let factors = Singular::of(&jacobian).ok_or(Error::EigenvaluesNotFound)?;
        let least = power_of_epsilon::<L::Scalar>(2.0 / 3.0);
        let is_free = |j: &usize| factors.freedom(*j, least) > power_of_epsilon::<L::Scalar>(0.5);
        let undetermined: Vec<usize> = (0..self.inputs.len()).filter(is_free).collect();
        if undetermined.is_empty() {
            let undamped = (least, L::Scalar::constant(0.0));
            return Ok(factors.step(residual.iter().copied(), undamped, |j, x| x / lengths[j]));
        }
        let inputs = undetermined.into_iter().map(|j| match self.inputs[j] {
            Argument::Coordinate(i) | Argument::Velocity(i) => L::COORDINATES[i],
            Argument::Parameter(k) => L::PARAMETERS[k],
        });
        Err(Error::InputsNotUnique { inputs: inputs.collect(), time: self.state.t.to_f64() })
    }

    /// Applies the step; returns true if it was mere round-off.
    fn go(&mut self, step: &DVector<L::Scalar>) -> bool {
        let mut is_small = true;
        let small = L::Scalar::constant(CANCELLED * L::Scalar::EPSILON);
        let unknowns = self.values.iter_mut().chain(self.multipliers.iter_mut());
        for (x, step) in unknowns.zip(step) {
            *x += *step;
            is_small &= Scalar::abs(*step) <= small * Scalar::abs(*x);
        }
        for (input, value) in self.inputs.iter().zip(&self.values) {
            if let Argument::Parameter(k) = *input {
                self.system.set_parameter(k, *value);
            }
        }
        is_small
    }

    /// Requires each row of the residual to be below √ε of the terms.
    fn check(&self) -> Result<(), Error> {
        let Self { system, state, accelerations, multipliers, .. } = self;
        let (m, f) = (system.mass_matrix(state), system.constraint_jacobian(state));
        let (h, gamma) = (system.forcing(state), system.constraint_bias(state));
        let zero = L::Scalar::constant(0.0);
        let sum =
            |terms: &mut dyn Iterator<Item = L::Scalar>| terms.fold(zero, |sum, x| sum + Scalar::abs(x));
        let mut terms = DVector::from_element(<L::N>::COUNT + <L::M>::COUNT, zero);
        for i in 0..<L::N>::COUNT {
            let forces = sum(&mut (0..<L::M>::COUNT).map(|a| f[(a, i)] * multipliers[a])) + Scalar::abs(h[i]);
            terms[i] =
                self.scaled(i, forces + sum(&mut (0..<L::N>::COUNT).map(|j| m[(i, j)] * accelerations[j])));
        }
        // What the inputs do is in h, where it may cancel what it holds.
        let by_inputs = self.jacobian()?;
        for (j, value) in self.values.iter().enumerate() {
            (0..<L::N>::COUNT).for_each(|i| terms[i] += Scalar::abs(by_inputs[(i, j)] * *value));
        }
        for a in 0..<L::M>::COUNT {
            let demands =
                sum(&mut (0..<L::N>::COUNT).map(|j| f[(a, j)] * accelerations[j])) + Scalar::abs(gamma[a]);
            terms[<L::N>::COUNT + a] = self.scaled(<L::N>::COUNT + a, demands);
        }
        // In these units forces are comparable, and so are accelerations: a row small beside others may be their
        // round-off.
        let most = |numbers: &mut dyn Iterator<Item = L::Scalar>| numbers.fold(zero, larger);
        let force = most(&mut terms.rows(0, <L::N>::COUNT).iter().copied());
        let own = |i: usize| Scalar::abs(accelerations[i]) / self.units.coordinates[i];
        let acceleration = most(
            &mut terms.rows(<L::N>::COUNT, <L::M>::COUNT).iter().copied().chain((0..<L::N>::COUNT).map(own)),
        );
        let (residual, part) = (self.residual()?, power_of_epsilon::<L::Scalar>(0.5));
        let scale = |i: usize| if i < <L::N>::COUNT { force } else { acceleration };
        match (0..<L::N>::COUNT + <L::M>::COUNT).rev().find(|&i| Scalar::abs(residual[i]) > part * scale(i)) {
            None => Ok(()),
            Some(i) => {
                let left = residual[i] / self.scaled(i, L::Scalar::constant(1.0));
                Err(Error::NotRealizable {
                    row: row::<L>(i),
                    residual: left.to_f64(),
                    time: state.t.to_f64(),
                })
            }
        }
    }
}
