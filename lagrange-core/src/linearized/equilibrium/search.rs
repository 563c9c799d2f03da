//! Levenberg–Marquardt method (Moré 1978) for R = (h + Fᵀλ, γ, F q̇ + b, Φ) = 0.
//!
//! The damping is proportional to |R|: so the convergence is quadratic to families of equilibria too (Fan and Yuan,
//! *Computing* 74, 2005). A step never moves the unknowns along directions in which R does not change.

use alloc::{format, string::String, vec::Vec};

use nalgebra::{ComplexField, DMatrix, DVector};

use super::point::Point;
use super::weights::weights;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::argument::{Argument, set_parameter};
use crate::number::limits::{CANCELLED, DAMPING, SUM};
use crate::number::{Real, Scalar, is_within, larger, power_of_epsilon, smaller, unit_of};
use crate::numerics::newton::{Left, Search, dampings};
use crate::numerics::singular::Singular;
use crate::solution::consistent::{Level, project_guess};
use crate::solution::solve::{row, solve};
use crate::system::StateOf;
use crate::vector::{StaticLength, zeros};

/// Unknowns of the search, and the units of rows and columns.
pub(super) struct EquilibriumSearch<L: Linearized> {
    unknowns: Vec<Argument>,
    /// Factor of each row, so that rows of different units can be compared.
    weights: DVector<L::Scalar>,
    /// Largest norm so far of each column of the row-weighted Jacobian. Its inverse scales the steps of the unknown
    /// of that column (Moré).
    scale: DVector<L::Scalar>,
}

/// Point of the search, with residual, Jacobian and damping.
pub(super) struct Iterate<L: Linearized> {
    pub(super) point: Point<L>,
    residual: DVector<L::Scalar>,
    jacobian: DMatrix<L::Scalar>,
    damping: L::Scalar,
}

impl<L: Linearized<Scalar: Real> + Clone> EquilibriumSearch<L> {
    /// Starts a search at the guess; returns it with its first iterate.
    pub(super) fn start(
        system: L,
        guess: &StateOf<L>,
        unknowns: Vec<Argument>,
    ) -> Result<(Self, Iterate<L>), Error> {
        let mut state = *guess;
        // Project onto the constraints if no coordinate is held. A guess that cannot be projected is kept.
        if (0..<L::N>::COUNT).all(|i| unknowns.contains(&Argument::Coordinate(i))) {
            project_guess(&system, Level::Position, &mut state).unwrap_or_default();
        }
        let multipliers = solve(&system, &state).map_or(zeros(), |solution| solution.multipliers);
        let mut point = Point { system, state, multipliers };
        for &unknown in &unknowns {
            let Argument::Parameter(k) = unknown else { continue };
            let value = point.value(unknown);
            set_parameter(&mut point.system, k, value)?;
        }
        let mut balance = Self { unknowns, weights: DVector::zeros(0), scale: DVector::zeros(0) };
        let start = balance.trial(point, L::Scalar::constant(DAMPING));
        if let Some(i) = start.residual.iter().position(|x| !x.is_finite()) {
            return Err(Error::EquationsNotFinite { row: row::<L>(i), time: state.t.to_f64() });
        }
        balance.weights = weights(&start.jacobian, &start.residual, <L::N>::COUNT);
        balance.scale = DVector::zeros(start.jacobian.ncols());
        Ok((balance, start))
    }

    fn trial(&self, point: Point<L>, damping: L::Scalar) -> Iterate<L> {
        Iterate { residual: point.residual(), jacobian: point.jacobian(&self.unknowns), point, damping }
    }

    /// Damped step, along the directions in which the residual changes.
    fn damped(
        &self,
        factors: &Singular<L::Scalar>,
        residual: &DVector<L::Scalar>,
        damping: L::Scalar,
    ) -> DVector<L::Scalar> {
        let least = factors.norm() * L::Scalar::constant(L::Scalar::EPSILON);
        let rows = residual.iter().zip(&self.weights).map(|(r, w)| *r * *w);
        factors.step(rows, (least, damping), |j, x| x * self.unit(j))
    }

    /// Unit of a step in unknown `j`: such a step changes R by about as much as R is at the guess.
    fn unit(&self, j: usize) -> L::Scalar {
        L::Scalar::constant(1.0) / unit_of(self.scale[j])
    }

    fn moved(&self, trial: &Point<L>, step: &DVector<L::Scalar>) -> Point<L> {
        let mut next = trial.clone();
        for (j, &unknown) in self.unknowns.iter().enumerate() {
            next.set(unknown, next.value(unknown) + step[j]);
        }
        for a in 0..<L::M>::COUNT {
            next.multipliers[a] += step[self.unknowns.len() + a];
        }
        next
    }

    /// Σ_j |∂R_i/∂x_j| size(j, |x_j|) over the unknowns and multipliers, for each row i.
    fn terms(&self, trial: &Iterate<L>, size: impl Fn(usize, L::Scalar) -> L::Scalar) -> DVector<L::Scalar> {
        let unknowns = self.unknowns.iter().map(|&unknown| trial.point.value(unknown));
        let values = unknowns.chain(trial.point.multipliers.iter().copied());
        let sizes = values.enumerate().map(|(j, x)| size(j, Scalar::abs(x)));
        let sizes = DVector::from_iterator(trial.jacobian.ncols(), sizes);
        trial.jacobian.map(Scalar::abs) * sizes
    }

    /// Weighted norm |W R| of the residual; W holds the row weights.
    fn distance(&self, trial: &Iterate<L>) -> L::Scalar {
        trial.residual.component_mul(&self.weights).norm()
    }

    /// True if every row of the residual is within the round-off of its terms.
    fn is_rounded(&self, trial: &Iterate<L>) -> bool {
        let part = L::Scalar::constant(SUM * L::Scalar::EPSILON);
        let bound = self.terms(trial, |_, x| part * x);
        trial.residual.iter().zip(&bound).all(|(r, bound)| is_within(Scalar::abs(*r), *bound))
    }

    /// True if the residual may be round-off. First, each row must be small beside its terms, and beside its terms for
    /// unknowns of size 1. Second, the part of R that no step can remove must be round-off of the terms here or at the
    /// guess. The second test detects forces that cannot balance, however small their unit makes them.
    fn is_negligible(&self, factors: &Singular<L::Scalar>, trial: &Iterate<L>) -> bool {
        let part = L::Scalar::constant(CANCELLED * L::Scalar::EPSILON);
        let floor = power_of_epsilon(0.75);
        let small = self.terms(trial, |_, x| part * x + floor);
        let round_off = self.terms(trial, |j, x| part * (x + self.unit(j)));
        let residual = &trial.residual;
        let stays = residual + &trial.jacobian * self.damped(factors, residual, L::Scalar::constant(0.0));
        (0..residual.len()).all(|i| {
            is_within(Scalar::abs(residual[i]), small[i]) && is_within(Scalar::abs(stays[i]), round_off[i])
        })
    }

    /// Rejects a residual that is round-off only of gradient times value. Example: an angle of 10¹⁶ is known to ±1, so
    /// every force is round-off of the angle times its gradient. The bound therefore uses the actual change of the row
    /// with each unknown, if that is smaller.
    pub(super) fn check_resolved(&self, found: &Iterate<L>, steps: usize) -> Result<(), Error> {
        let (part, root) =
            (L::Scalar::constant(CANCELLED * L::Scalar::EPSILON), power_of_epsilon::<L::Scalar>(0.5));
        let unknowns = self.unknowns.len();
        let floor = power_of_epsilon(0.75);
        // R is linear in the multipliers.
        let mut bound = self.terms(found, |j, x| if j < unknowns { floor } else { part * x + floor });
        for (j, &unknown) in self.unknowns.iter().enumerate() {
            let (mut moved, x) = (found.point.clone(), found.point.value(unknown));
            moved.set(unknown, x + root * x);
            let change = (moved.residual() - &found.residual) / root;
            for i in 0..change.len() {
                let by_gradient = Scalar::abs(found.jacobian[(i, j)] * x);
                bound[i] += part * smaller(by_gradient, Scalar::abs(change[i]));
            }
        }
        match found.residual.iter().zip(&bound).all(|(r, bound)| is_within(Scalar::abs(*r), *bound)) {
            true => Ok(()),
            false => Err(self.no_equilibrium(found, steps)),
        }
    }

    /// Names of the unknowns that take part in directions along which R does not change.
    pub(super) fn undetermined(&mut self, found: &Iterate<L>) -> Result<Vec<String>, Error> {
        let factors = self.linearize(found)?;
        let least = factors.norm() * power_of_epsilon(2.0 / 3.0);
        let is_free = |(j, _): &(usize, _)| factors.freedom(*j, least) > power_of_epsilon(1.0 / 3.0);
        let free = self.unknowns.iter().enumerate().filter(is_free);
        Ok(free.map(|(_, unknown)| format!("{}", unknown.entry::<L>())).collect())
    }
}

impl<L: Linearized<Scalar: Real> + Clone> Search for EquilibriumSearch<L> {
    type Scalar = L::Scalar;
    type Error = Error;
    type Trial = Iterate<L>;
    type Linear = Singular<L::Scalar>;

    /// Singular value decomposition of the Jacobian in the units of rows and columns.
    fn linearize(&mut self, trial: &Self::Trial) -> Result<Self::Linear, Error> {
        trial.point.check_derivatives(&trial.jacobian, &self.unknowns)?;
        let mut scaled = trial.jacobian.clone();
        for (i, weight) in self.weights.iter().enumerate() {
            scaled.row_mut(i).scale_mut(*weight);
        }
        for (j, mut column) in scaled.column_iter_mut().enumerate() {
            self.scale[j] = larger(self.scale[j], column.norm());
            column.scale_mut(self.unit(j));
        }
        Singular::of(&scaled).ok_or(Error::EigenvaluesNotFound)
    }

    fn left(&self, near: &Self::Linear, trial: &Self::Trial) -> Left<L::Scalar> {
        let (distance, is_rounded) = (self.distance(trial), self.is_rounded(trial));
        Left { distance, is_rounded, is_negligible: is_rounded || self.is_negligible(near, trial) }
    }

    /// Raises the damping until a step reduces the residual, and lowers it after such a step.
    fn corrected(
        &self,
        factors: &Self::Linear,
        from: &Self::Trial,
        _: bool,
    ) -> Result<impl Iterator<Item = Self::Trial>, Error> {
        let distance = self.distance(from);
        Ok(dampings(from.damping, factors.norm()).map(move |[damping, next]| {
            let step = self.damped(factors, &from.residual, damping * distance);
            self.trial(self.moved(&from.point, &step), next)
        }))
    }

    #[cold]
    fn not_found(&self, _: &Self::Linear, trial: &Self::Trial, steps: usize) -> Error {
        self.no_equilibrium(trial, steps)
    }
}

impl<L: Linearized<Scalar: Real> + Clone> EquilibriumSearch<L> {
    fn no_equilibrium(&self, trial: &Iterate<L>, steps: usize) -> Error {
        let size = |i: usize| Scalar::abs(trial.residual[i]) * self.weights[i];
        let worst =
            (1..trial.residual.len()).fold(0, |worst, i| if size(i) > size(worst) { i } else { worst });
        let best = self.unknowns.iter().map(|&unknown| {
            let value = trial.point.value(unknown).to_f64();
            format!("{} = {value:?}", unknown.entry::<L>())
        });
        Error::NoEquilibrium {
            row: row::<L>(worst),
            residual: trial.residual[worst].to_f64(),
            iterations: steps,
            best: best.collect(),
            time: trial.point.state.t.to_f64(),
        }
    }
}
