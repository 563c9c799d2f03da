//! Projection of states of systems of any number of bodies onto their constraints.
//!
//! Newton's iteration with corrections δ = M⁻¹ Fᵀ μ, F δ = −residual, which are least in the metric of M: of the coordinates onto Φ = 0,
//! then of the velocities onto F q̇ + b = 0, as for [other systems](crate::solution::consistent). The corrections at the end of a
//! step share one factorization.

use nalgebra::{DVector, Dyn};

use super::reduced::Reduced;
use super::{doubt, name};
use crate::error::Error;
use crate::number::limits::{CANCELLED, SUM};
use crate::number::{Real, Scalar, beyond_round_off, exceeds, is_within, power_of_epsilon};
use crate::numerics::newton::{self, Left, Search, halvings};
use crate::solution::consistent::level::{BOTH, Level};
use crate::solution::consistent::{Adjustment, Consistent};
use crate::system::{ManyBodies, State, StateOf};
use crate::vector::scratch::with_scratch;

/// Corrections at the end of a step.
const CORRECTIONS: usize = 3;

/// Projects a state near the constraints onto them, to round-off. Allocates nothing where a few corrections suffice.
pub(crate) fn project<L: ManyBodies<Scalar: Real>>(system: &L, state: &mut StateOf<L>) -> Result<(), Error> {
    BOTH.into_iter().try_for_each(|level| {
        let is_done = with_scratch(|reduced: &mut Reduced<L::Scalar>| reduced.settle(system, level, state));
        if is_done { Ok(()) } else { search(system, level, state) }
    })
}

/// Implements [`ManyBodies::make_consistent`].
pub(crate) fn make_consistent<L: ManyBodies<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<Consistent<L::Scalar, Dyn>, Error> {
    let mut consistent = state.clone();
    BOTH.into_iter().try_for_each(|level| search(system, level, &mut consistent))?;
    let adjustment = Adjustment::between(state, &consistent);
    Ok((consistent, adjustment))
}

/// Checks that a state satisfies the constraints, to √ε of the size of their terms.
pub(crate) fn check<L: ManyBodies<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Result<(), Error> {
    BOTH.into_iter().try_for_each(|level| {
        with_scratch(|reduced: &mut Reduced<L::Scalar>| {
            reduced.evaluate(system, (state.t, state.q.as_slice(), state.v.as_slice()));
            let x = level.of(state);
            let is_off = |row: &usize| !reduced.is_within(*row, level, x, power_of_epsilon(0.5));
            match (0..reduced.rows()).find(is_off) {
                None => Ok(()),
                Some(row) => Err(Error::Inconsistent {
                    constraint: name(system, row),
                    rate: level == Level::Velocity,
                    residual: reduced.residual(row, level).to_f64(),
                    time: state.t.to_f64(),
                }),
            }
        })
    })
}

impl Level {
    /// Coordinates or velocities of a state.
    fn of<T: Real>(self, state: &State<T, Dyn>) -> &[T] {
        match self {
            Self::Position => state.q.as_slice(),
            Self::Velocity => state.v.as_slice(),
        }
    }
}

impl<T: Real> Reduced<T> {
    fn rows(&self) -> usize {
        self.stated.rows.len()
    }

    /// Φ, zero for a velocity constraint, or F q̇ + b.
    fn residual(&self, row: usize, level: Level) -> T {
        let stated = &self.stated.rows[row];
        match level {
            Level::Position => stated.residual.unwrap_or(T::constant(0.0)),
            Level::Velocity => stated.rate,
        }
    }

    /// Σ |F x| and Σ |F| of a row.
    fn terms(&self, row: usize, x: &[T]) -> [T; 2] {
        let pattern = &self.stated.pattern;
        pattern.slopes(row).fold([T::constant(0.0); 2], |[terms, sensitivity], slope| {
            let (size, x) = (Scalar::abs(self.stated.slopes[slope]), x[pattern.coordinate(slope)]);
            [terms + size * Scalar::abs(x), sensitivity + size]
        })
    }

    /// True if a residual is at most `part` of its terms, plus ε^(3/4) of its sensitivity for terms near zero.
    fn is_within(&self, row: usize, level: Level, x: &[T], part: T) -> bool {
        let [terms, sensitivity] = self.terms(row, x);
        let bound = part * terms + power_of_epsilon::<T>(0.75) * sensitivity;
        is_within(Scalar::abs(self.residual(row, level)), bound)
    }

    /// Corrects a state up to three times with one factorization. Returns whether only round-off is left.
    fn settle<L: ManyBodies<Scalar = T>>(
        &mut self,
        system: &L,
        level: Level,
        state: &mut State<T, Dyn>,
    ) -> bool {
        for round in 0..=CORRECTIONS {
            self.evaluate(system, (state.t, state.q.as_slice(), state.v.as_slice()));
            let x = level.of(state);
            let is_rounded = |row: usize| {
                is_within(
                    Scalar::abs(self.residual(row, level)),
                    T::constant(SUM * T::EPSILON) * self.terms(row, x)[0],
                )
            };
            if (0..self.rows()).all(is_rounded) {
                return true;
            }
            if round == CORRECTIONS {
                let part = T::constant(CANCELLED * T::EPSILON);
                return (0..self.rows()).all(|row| self.is_within(row, level, x, part));
            }
            if round == 0 && self.factor_at(system, level, state).is_none() {
                return false;
            }
            for row in 0..self.rows() {
                self.multipliers[row] = -self.residual(row, level);
            }
            match level {
                Level::Position => self.solve(state.q.as_mut_slice()),
                Level::Velocity => self.solve(state.v.as_mut_slice()),
            }
        }
        false
    }

    /// Factorizes the rows of a level; `None` if they are not independent.
    fn factor_at<L: ManyBodies<Scalar = T>>(
        &mut self,
        system: &L,
        level: Level,
        state: &State<T, Dyn>,
    ) -> Option<()> {
        let at = (state.t, state.q.as_slice(), state.v.as_slice());
        doubt(self.factor(system, at, level == Level::Position)).is_finite().then_some(())
    }
}

/// Newton's search for a state on the constraints of a level.
struct Projection<'a, L> {
    system: &'a L,
    level: Level,
}

/// A state, and how far it is from the constraints.
struct Trial<L: ManyBodies> {
    state: StateOf<L>,
    /// Largest distance from a constraint, each taken alone, beyond round-off; its row and residual.
    distance: L::Scalar,
    row: usize,
    residual: L::Scalar,
    is_negligible: bool,
}

fn search<L: ManyBodies<Scalar: Real>>(
    system: &L,
    level: Level,
    state: &mut StateOf<L>,
) -> Result<(), Error> {
    let mut projection = Projection { system, level };
    let start = projection.trial(state.clone());
    *state = newton::find(&mut projection, start)?.0.state;
    Ok(())
}

impl<L: ManyBodies<Scalar: Real>> Projection<'_, L> {
    fn trial(&self, state: StateOf<L>) -> Trial<L> {
        with_scratch(|reduced: &mut Reduced<L::Scalar>| {
            reduced.evaluate(self.system, (state.t, state.q.as_slice(), state.v.as_slice()));
            let (zero, x) = (L::Scalar::constant(0.0), self.level.of(&state));
            let mut farthest = (zero, 0);
            let mut is_negligible = true;
            for row in 0..reduced.rows() {
                let [terms, sensitivity] = reduced.terms(row, x);
                let value = beyond_round_off(reduced.residual(row, self.level), terms);
                let distance = if sensitivity > zero { value / sensitivity } else { value };
                // NaN counts as the largest distance.
                if farthest.0 == farthest.0 && exceeds(distance, farthest.0) {
                    farthest = (distance, row);
                }
                let part = L::Scalar::constant(CANCELLED * L::Scalar::EPSILON);
                is_negligible &= reduced.is_within(row, self.level, x, part);
            }
            let (distance, row) = farthest;
            let residual = if reduced.rows() > 0 { reduced.residual(row, self.level) } else { zero };
            Trial { state, distance, row, residual, is_negligible }
        })
    }
}

impl<L: ManyBodies<Scalar: Real>> Search for Projection<'_, L> {
    type Scalar = L::Scalar;
    type Error = Error;
    type Trial = Trial<L>;
    /// Correction of the coordinates or the velocities.
    type Linear = DVector<L::Scalar>;

    fn linearize(&mut self, trial: &Trial<L>) -> Result<DVector<L::Scalar>, Error> {
        let mut step = DVector::from_element(trial.state.q.len(), L::Scalar::constant(0.0));
        if trial.distance == L::Scalar::constant(0.0) {
            return Ok(step);
        }
        with_scratch(|reduced: &mut Reduced<L::Scalar>| {
            if reduced.factor_at(self.system, self.level, &trial.state).is_none() {
                return Err(reduced
                    .fault(self.system, &trial.state)
                    .unwrap_or_else(|| self.not_projected(trial, 0)));
            }
            for row in 0..reduced.rows() {
                reduced.multipliers[row] = -reduced.residual(row, self.level);
            }
            reduced.solve(step.as_mut_slice());
            Ok(step)
        })
    }

    fn left(&self, _: &Self::Linear, trial: &Trial<L>) -> Left<L::Scalar> {
        let is_rounded = trial.distance == L::Scalar::constant(0.0);
        Left { distance: trial.distance, is_rounded, is_negligible: is_rounded || trial.is_negligible }
    }

    fn corrected(
        &self,
        step: &Self::Linear,
        trial: &Trial<L>,
        converged: bool,
    ) -> Result<impl Iterator<Item = Trial<L>>, Error> {
        Ok(halvings::<L::Scalar>(converged).map(move |part| {
            let mut state = trial.state.clone();
            let unknowns = match self.level {
                Level::Position => &mut state.q,
                Level::Velocity => &mut state.v,
            };
            unknowns.iter_mut().zip(step.iter()).for_each(|(x, change)| *x += *change * part);
            self.trial(state)
        }))
    }

    fn not_found(&self, _: &Self::Linear, trial: &Trial<L>, steps: usize) -> Error {
        self.not_projected(trial, steps)
    }
}

impl<L: ManyBodies<Scalar: Real>> Projection<'_, L> {
    fn not_projected(&self, trial: &Trial<L>, iterations: usize) -> Error {
        Error::NotProjected {
            constraint: name(self.system, trial.row),
            residual: trial.residual.to_f64(),
            iterations,
            time: trial.state.t.to_f64(),
        }
    }
}
