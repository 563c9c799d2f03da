//! OntoConstraints of states of systems of any number of bodies onto their constraints.
//!
//! Newton's iteration with corrections δ = M⁻¹ Fᵀ μ, F δ = −residual, which are least in the metric of M: of the coordinates onto Φ = 0,
//! then of the velocities onto F q̇ + b = 0, as for [other systems](crate::solution::consistent).

use alloc::vec::Vec;

use nalgebra::{ComplexField, DVector, Dyn};

use super::{ConstraintRows, Correction, doubt, fault, name};
use crate::error::Error;
use crate::number::limits::{CANCELLED, SUM};
use crate::number::{Real, Scalar, beyond_round_off, exceeds, is_within, power_of_epsilon};
use crate::numerics::newton::{self, Left, Search, halvings};
use crate::solution::consistent::{Adjustment, Consistent};
use crate::solution::limits::CORRECTIONS;
use crate::system::{ManyBodies, State, StateOf};
use crate::vector::scratch::with_scratch;

/// What is projected, in turn.
const BOTH: [Correction; 2] = [Correction::Coordinates, Correction::Velocities];

/// Projects coordinates and velocities near the constraints onto them, to round-off. Allocates nothing where a few corrections suffice.
pub(crate) fn project<L: ManyBodies<Scalar: Real>>(
    system: &L,
    t: L::Scalar,
    [q, v]: [&mut [L::Scalar]; 2],
) -> Result<(), Error> {
    BOTH.into_iter().try_for_each(|target| {
        if settle(system, target, t, [&mut *q, &mut *v]) {
            return Ok(());
        }
        let [from_q, from_v] = [&*q, &*v].map(DVector::from_column_slice);
        let mut state = State { t, q: from_q, v: from_v };
        search(system, target, &mut state)?;
        q.copy_from_slice(state.q.as_slice());
        v.copy_from_slice(state.v.as_slice());
        Ok(())
    })
}

/// Implements [`ManyBodies::project`].
pub(crate) fn make_consistent<L: ManyBodies<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<Consistent<L::Scalar, Dyn>, Error> {
    let mut consistent = state.clone();
    BOTH.into_iter().try_for_each(|target| search(system, target, &mut consistent))?;
    let adjustment = Adjustment::between(state, &consistent);
    Ok((consistent, adjustment))
}

/// Checks that a state satisfies the constraints, to √ε of the size of their terms.
pub(crate) fn check<L: ManyBodies<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Result<(), Error> {
    BOTH.into_iter().try_for_each(|target| {
        with_rows(system, at(state), |rows| {
            let is_off = |row: &usize| !rows.is_within(*row, target, at(state), power_of_epsilon(0.5));
            match rows.indices().find(is_off) {
                None => Ok(()),
                Some(row) => Err(Error::Inconsistent {
                    constraint: name(system, row),
                    rate: target == Correction::Velocities,
                    residual: rows.residual(row, target).to_f64(),
                    time: state.t.to_f64(),
                }),
            }
        })
    })
}

/// Time, coordinates and velocities.
type StateSlices<'a, T> = (T, &'a [T], &'a [T]);

fn at<T: Real>(state: &State<T, Dyn>) -> StateSlices<'_, T> {
    (state.t, state.q.as_slice(), state.v.as_slice())
}

/// Calls a function with the constraints at a state.
fn with_rows<L: ManyBodies<Scalar: Real>, R>(
    system: &L,
    (t, q, v): StateSlices<L::Scalar>,
    function: impl FnOnce(&ConstraintRows<L::Scalar>) -> R,
) -> R {
    with_scratch(|rows: &mut ConstraintRows<L::Scalar>| {
        rows.clear();
        system.constraints(t, q, v, rows);
        function(rows)
    })
}

impl<T: Real> ConstraintRows<T> {
    /// Φ, zero for a velocity constraint, or F q̇ + b.
    fn residual(&self, row: usize, target: Correction) -> T {
        -target.right(&self.rows[row], || T::constant(0.0))
    }

    /// Σ |F x| and Σ |F| of a row, where x are the coordinates or velocities.
    fn terms(&self, row: usize, target: Correction, (_, q, v): StateSlices<T>) -> [T; 2] {
        let x = if target == Correction::Coordinates { q } else { v };
        self.pattern.slopes(row).fold([T::constant(0.0); 2], |[terms, sensitivity], slope| {
            let (size, x) = (Scalar::abs(self.slopes[slope]), x[self.pattern.coordinate(slope)]);
            [terms + size * Scalar::abs(x), sensitivity + size]
        })
    }

    /// True if a residual is at most `part` of its terms, plus ε^(3/4) of its sensitivity for terms near zero.
    fn is_within(&self, row: usize, target: Correction, at: StateSlices<T>, part: T) -> bool {
        let [terms, sensitivity] = self.terms(row, target, at);
        let bound = part * terms + power_of_epsilon::<T>(0.75) * sensitivity;
        is_within(Scalar::abs(self.residual(row, target)), bound)
    }

    fn is_rounded(&self, row: usize, target: Correction, at: StateSlices<T>) -> bool {
        let round_off = T::constant(SUM * T::EPSILON) * self.terms(row, target, at)[0];
        is_within(Scalar::abs(self.residual(row, target)), round_off)
    }

    /// True if residuals are small enough to be round-off of cancelling terms.
    fn are_negligible(&self, target: Correction, at: StateSlices<T>) -> bool {
        let part = T::constant(CANCELLED * T::EPSILON);
        self.indices().all(|row| self.is_within(row, target, at, part))
    }
}

/// Corrects coordinates or velocities a few times. Returns whether only round-off is left.
fn settle<L: ManyBodies<Scalar: Real>>(
    system: &L,
    target: Correction,
    t: L::Scalar,
    [q, v]: [&mut [L::Scalar]; 2],
) -> bool {
    with_scratch(|step: &mut Vec<L::Scalar>| {
        for _ in 0..CORRECTIONS {
            let at = (t, &*q, &*v);
            if with_rows(system, at, |rows| rows.indices().all(|row| rows.is_rounded(row, target, at))) {
                return true;
            }
            step.clear();
            step.resize(q.len(), L::Scalar::constant(0.0));
            if !find_step(system, target, at, step) {
                return false;
            }
            let unknowns = if target == Correction::Coordinates { &mut *q } else { &mut *v };
            move_by(unknowns, (step, L::Scalar::constant(1.0)));
        }
        let at = (t, &*q, &*v);
        with_rows(system, at, |rows| rows.are_negligible(target, at))
    })
}

/// Adds the correction at a state to `step`. Returns false where the constraints are not independent.
fn find_step<L: ManyBodies<Scalar: Real>>(
    system: &L,
    target: Correction,
    at: StateSlices<L::Scalar>,
    step: &mut [L::Scalar],
) -> bool {
    with_scratch(|multipliers: &mut Vec<L::Scalar>| {
        doubt(system.correct(at, target, (step, multipliers))).is_finite()
    })
}

fn move_by<T: Real>(unknowns: &mut [T], (step, part): (&[T], T)) {
    unknowns.iter_mut().zip(step).for_each(|(x, change)| *x += *change * part);
}

/// Newton's search for a state on the constraints.
struct OntoConstraints<'a, L> {
    system: &'a L,
    target: Correction,
}

/// A state, and how far it is from the constraints.
struct Candidate<L: ManyBodies> {
    state: StateOf<L>,
    /// Largest distance from a constraint, each taken alone, beyond round-off; its row and residual.
    distance: L::Scalar,
    row: usize,
    residual: L::Scalar,
    is_negligible: bool,
}

fn search<L: ManyBodies<Scalar: Real>>(
    system: &L,
    target: Correction,
    state: &mut StateOf<L>,
) -> Result<(), Error> {
    let mut search = OntoConstraints { system, target };
    let start = search.candidate(state.clone());
    *state = newton::find(&mut search, start)?.0.state;
    Ok(())
}

impl<L: ManyBodies<Scalar: Real>> OntoConstraints<'_, L> {
    fn candidate(&self, state: StateOf<L>) -> Candidate<L> {
        let zero = L::Scalar::constant(0.0);
        let (distance, row, residual, is_negligible) = with_rows(self.system, at(&state), |rows| {
            let mut farthest = (zero, 0, zero);
            for row in rows.indices() {
                let [terms, sensitivity] = rows.terms(row, self.target, at(&state));
                let residual = rows.residual(row, self.target);
                let value = beyond_round_off(residual, terms);
                let distance = if sensitivity > zero { value / sensitivity } else { value };
                // NaN counts as the largest distance.
                if farthest.0 >= zero && exceeds(distance, farthest.0) {
                    farthest = (distance, row, residual);
                }
            }
            (farthest.0, farthest.1, farthest.2, rows.are_negligible(self.target, at(&state)))
        });
        Candidate { state, distance, row, residual, is_negligible }
    }

    fn not_projected(&self, trial: &Candidate<L>, iterations: usize) -> Error {
        Error::NotProjected {
            constraint: name(self.system, trial.row),
            residual: trial.residual.to_f64(),
            iterations,
            time: trial.state.t.to_f64(),
        }
    }
}

impl<L: ManyBodies<Scalar: Real>> Search for OntoConstraints<'_, L> {
    type Scalar = L::Scalar;
    type Error = Error;
    type Trial = Candidate<L>;
    /// Correction of the coordinates or the velocities.
    type Linear = DVector<L::Scalar>;

    fn linearize(&mut self, trial: &Candidate<L>) -> Result<DVector<L::Scalar>, Error> {
        let mut step = DVector::from_element(trial.state.q.len(), L::Scalar::constant(0.0));
        let is_there = trial.distance == L::Scalar::constant(0.0);
        if is_there || find_step(self.system, self.target, at(&trial.state), step.as_mut_slice()) {
            return Ok(step);
        }
        Err(fault(self.system, &trial.state).unwrap_or_else(|| self.not_projected(trial, 0)))
    }

    fn left(&self, _: &Self::Linear, trial: &Candidate<L>) -> Left<L::Scalar> {
        let is_rounded = trial.distance == L::Scalar::constant(0.0);
        Left { distance: trial.distance, is_rounded, is_negligible: is_rounded || trial.is_negligible }
    }

    fn corrected(
        &self,
        step: &Self::Linear,
        trial: &Candidate<L>,
        converged: bool,
    ) -> Result<impl Iterator<Item = Candidate<L>>, Error> {
        Ok(halvings::<L::Scalar>(converged).map(move |part| {
            let mut state = trial.state.clone();
            let unknowns = if self.target == Correction::Coordinates { &mut state.q } else { &mut state.v };
            move_by(unknowns.as_mut_slice(), (step.as_slice(), part));
            self.candidate(state)
        }))
    }

    fn not_found(&self, _: &Self::Linear, trial: &Candidate<L>, steps: usize) -> Error {
        self.not_projected(trial, steps)
    }
}
