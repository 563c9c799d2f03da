//! The contract of `lagrange-core`: what moves a [`Model`].

use std::fmt;

use lagrange_core::error::{Row, WrittenName};
use lagrange_core::motion::{ManyBodyField, SystemChecks};
use lagrange_core::nalgebra::{Const, DVector, Dyn};
use lagrange_core::{ConstraintRows, Correction, Error, ManyBodies, System};
use lagrange_derive::Arguments;
use lagrange_derive::facts::ConstraintKind;

use crate::model::{Model, State, at, results, with_results};

impl System for Model {
    type Scalar = f64;
    type Length = Dyn;
    type M = Const<0>;
    type Field = ManyBodyField;

    fn length(&self) -> Dyn {
        Dyn(self.coordinates.len())
    }

    fn accelerations(&self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) {
        self.write_solution(&Arguments { t, q, v, ..Arguments::default() }, a);
    }
}

impl ManyBodies for Model {
    /// It depends on the text: [`Facts`](lagrange_derive::facts::Facts) of the system tell it.
    const ENERGY_IS_CONSERVED: bool = false;
    const HAS_CONSTRAINTS: bool = true;
    const DIGEST: u32 = 0;

    fn write_name(&self, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
        to.write_str(&self.coordinates[coordinate])
    }

    fn check(&self) -> Result<(), Error> {
        Ok(())
    }

    fn visit_numbers(&self, visit: &mut dyn FnMut(f64)) {
        visit(f64::from(self.digest));
        self.values.iter().for_each(|value| visit(*value));
    }

    fn lagrangian(&self, state: &State) -> f64 {
        results(&self.tapes.energies, &at(state))[1]
    }

    fn energy(&self, state: &State) -> f64 {
        results(&self.tapes.energies, &at(state))[0]
    }

    fn momenta(&self, state: &State) -> DVector<f64> {
        DVector::from_vec(results(&self.tapes.energies, &at(state)).split_off(2))
    }

    fn constraints(&self, t: f64, q: &[f64], v: &[f64], rows: &mut ConstraintRows<f64>) {
        let (n, m) = (q.len(), self.constraints.len());
        if m == 0 {
            return;
        }
        let all = results(&self.tapes.constraints, &Arguments { t, q, v, ..Arguments::default() });
        for (a, (_, kind)) in self.constraints.iter().enumerate() {
            let residual = (*kind == ConstraintKind::Holonomic).then_some(all[a]);
            rows.row(residual, all[m + a], all[(2 + n) * m + a]);
            (0..n).for_each(|i| rows.entry([i], 0, all[2 * m + a * n + i]));
        }
    }

    fn correct(
        &self,
        (t, q, v): (f64, &[f64], &[f64]),
        target: Correction,
        (x, multipliers): (&mut [f64], &mut Vec<f64>),
    ) -> f64 {
        let at = Arguments { t, q, v, ..Arguments::default() };
        let bias = self.defects(&at, target, x);
        let Some(solution) = self.correction(&at, &bias) else { return f64::NAN };
        x.iter_mut().zip(&solution).for_each(|(x, change)| *x += *change);
        multipliers.clear();
        multipliers.extend(solution.iter().skip(x.len()));
        // A correction that is returned is to be trusted.
        1.0
    }

    fn write_constraint_name(&self, constraint: usize, to: &mut dyn fmt::Write) -> fmt::Result {
        to.write_str(&self.constraints[constraint].0)
    }

    fn multipliers(&self, state: &State) -> Result<DVector<f64>, Error> {
        self.check_entries(state)?;
        let solution = self.solution(state.t, state.q.as_slice(), state.v.as_slice());
        let multipliers = solution.rows(self.coordinates.len(), self.constraints.len());
        let not_finite = |row: usize| Error::EquationsNotFinite {
            row: Row::WrittenConstraint(WrittenName::of(|to| self.write_constraint_name(row, to))),
            time: state.t,
        };
        let wrong = multipliers.iter().position(|multiplier| !multiplier.is_finite());
        wrong.map_or_else(|| Ok(multipliers.into_owned()), |row| Err(not_finite(row)))
    }
}

impl Model {
    /// Φ, F q̇ + b, or F x + γ of each constraint; zero for a velocity constraint on coordinates.
    fn defects(&self, at: &Arguments<'_>, target: Correction, x: &[f64]) -> Vec<f64> {
        let (n, m) = (x.len(), self.constraints.len());
        with_results(&self.tapes.constraints, at, |results| match target {
            Correction::Coordinates => results[..m].to_vec(),
            Correction::Velocities => results[m..2 * m].to_vec(),
            Correction::Accelerations => {
                let (jacobian, bias) = results[2 * m..].split_at(m * n);
                let along = |row: &[f64]| row.iter().zip(x).map(|(f, x)| f * x).sum::<f64>();
                jacobian.chunks_exact(n).zip(bias).map(|(row, bias)| bias + along(row)).collect()
            }
        })
    }

    /// Checks that a state has as many entries as the system has coordinates, and that they are finite.
    pub(crate) fn check_entries(&self, state: &State) -> Result<(), Error> {
        <ManyBodyField as SystemChecks<Self>>::check_entries(self, state)
    }
}
