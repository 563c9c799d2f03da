//! Coordinates of the constraint manifold near a state: the tangent plane there.
//!
//! A point of the manifold has the coordinates Π(q − q₀), where Π projects onto the tangent plane along M⁻¹Fᵀ (tangent
//! space parametrization: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, IV.5.3). In these coordinates a
//! stiff force along the constraints stays one. On all coordinates, a turn ε of the constraints in a step of length h
//! would feed h c ε² of a damping c into the iteration, which then diverges.

use super::iteration::NoSolution;
use crate::error::Error;
use crate::motion::method::control::Tolerance;
use crate::number::{Real, Scalar};
use crate::room::Room;
use crate::solution::consistent::BOTH;
use crate::solution::consistent::level::Level;
use crate::solution::kkt::{Factors, Rank};
use crate::solution::pivot::is_trustworthy;
use crate::solution::solve::fault;
use crate::system::{ConstraintKind, Lagrangian, StateOf};
use crate::vector::{Array, Length, PhaseVector, rows, vector};

/// Largest number of corrections towards the constraints. Those that are not round-off shrink by two each.
const CORRECTIONS: usize = 60;
/// Residual, in units of ε of its terms, at which corrections end.
const ROUND_OFF: f64 = 4.0;
/// Largest ratio of a correction to the one before: with a half, all together are at most twice the first.
pub(super) const TURN: f64 = 0.5;
/// Part of [`TURN`] at which the next step aims: the ratio is proportional to the length of a step.
pub(super) const MARGIN: f64 = 0.8;
/// Size of a correction, in units of the tolerance, below which corrections need not shrink: they are round-off, or those
/// of dependent constraints, which agree on the manifold only.
const SMALL: f64 = 1e-3;

/// The tangent plane at a state.
pub(super) struct Chart<L: Lagrangian> {
    /// Constraint Jacobian, row by row.
    f: Room<Array<Array<L::Scalar, L::N>, L::M>>,
    /// For the velocities, which all constraints hold; `None` without constraints.
    velocities: Option<Solver<L>>,
    /// For the coordinates, which only holonomic constraints hold, if there are others.
    coordinates: Option<Solver<L>>,
}

/// Factorization for the least x with F x = −γ: the emitted one, or the general one where constraints are dependent.
enum Solver<L: Lagrangian> {
    Emitted(L::Factor),
    General(Room<Factors<L::Scalar, L::N, L::M>>),
}

impl<L: Lagrangian<Scalar: Real>> Solver<L> {
    /// Factorizes by the emitted function if that is reliable; `old` gives its storage.
    fn velocities(system: &L, state: &StateOf<L>, old: Option<Self>) -> Self {
        let (factor, none) = (system.factor(state), zero::<L>());
        let zeros = (vector(Array::filled(none)), vector(Array::filled(none)));
        if is_trustworthy(&system.solve_with(&factor, &zeros.0, &zeros.1)) {
            return Self::Emitted(factor);
        }
        Self::general(Level::Velocity, system, state, old)
    }

    fn general(level: Level, system: &L, state: &StateOf<L>, old: Option<Self>) -> Self {
        let (m, f) = (system.mass_matrix(state).into(), level.jacobian(system, state));
        let factors = Factors::of(&m, &f, Rank::off_constraints());
        match old {
            Some(Self::General(mut room)) => {
                *room = factors;
                Self::General(room)
            }
            _ => Self::General(Room::of(factors)),
        }
    }
}

impl<L: Lagrangian<Scalar: Real>> Chart<L> {
    pub(super) fn at(system: &L, state: &StateOf<L>) -> Self {
        let is_mixed = L::CONSTRAINT_KINDS.contains(&ConstraintKind::Velocity);
        let velocities = (<L::M>::COUNT > 0).then(|| Solver::velocities(system, state, None));
        let coordinates = is_mixed.then(|| Solver::general(Level::Position, system, state, None));
        Self { f: Room::of(rows(&system.constraint_jacobian(state))), velocities, coordinates }
    }

    /// Moves the chart to another state, and keeps its storage.
    pub(super) fn set(&mut self, system: &L, state: &StateOf<L>) {
        *self.f = rows(&system.constraint_jacobian(state));
        self.velocities = self.velocities.take().map(|old| Solver::velocities(system, state, Some(old)));
        let general = |old| Solver::general(Level::Position, system, state, Some(old));
        self.coordinates = self.coordinates.take().map(general);
    }

    /// The least x with F x = −`residual` on a level; `None` without constraints.
    pub(super) fn correction(
        &self,
        system: &L,
        level: Level,
        residual: &Array<L::Scalar, L::M>,
        time: L::Scalar,
    ) -> Result<Option<Array<L::Scalar, L::N>>, Error> {
        let own = self.coordinates.as_ref().filter(|_| level == Level::Position);
        let none = Array::filled(zero::<L>());
        let found = match own.or(self.velocities.as_ref()) {
            None => return Ok(None),
            Some(Solver::Emitted(factor)) => system.solve_with(factor, &vector(none), &vector(*residual)),
            Some(Solver::General(factors)) => {
                factors.solve(&none, residual).map_err(|found| fault::<L>(&found, time.to_f64()))?
            }
        };
        Ok(Some(found.accelerations.into()))
    }

    /// Projects a vector of coordinates or velocities onto the tangent plane.
    pub(super) fn tangent(
        &self,
        system: &L,
        level: Level,
        x: &Array<L::Scalar, L::N>,
        time: L::Scalar,
    ) -> Result<Array<L::Scalar, L::N>, Error> {
        if <L::M>::COUNT == 0 {
            return Ok(*x);
        }
        let row = |a: usize| (0..<L::N>::COUNT).fold(zero::<L>(), |sum, i| sum + self.f[a][i] * x[i]);
        let residual =
            Array::from_fn(|a| if level.is_active(L::CONSTRAINT_KINDS[a]) { row(a) } else { zero::<L>() });
        let correction = self.correction(system, level, &residual, time)?;
        Ok(correction.map_or(*x, |correction| Array::from_fn(|i| x[i] + correction[i])))
    }

    /// Projects both halves onto the tangent plane.
    pub(super) fn tangents(
        &self,
        system: &L,
        y: &PhaseVector<L::Scalar, L::N>,
        time: L::Scalar,
    ) -> Result<PhaseVector<L::Scalar, L::N>, Error> {
        let [q, v] = y.arrays();
        Ok(PhaseVector::new([
            self.tangent(system, Level::Position, &q, time)?,
            self.tangent(system, Level::Velocity, &v, time)?,
        ]))
    }

    /// Moves a state onto the constraints along M⁻¹Fᵀ, without a change of its coordinates in the tangent plane. Corrections
    /// are measured in units of the tolerance at the state `y`; `turn` is raised to the largest ratio of one to that before.
    /// [`NoSolution::TooSlow`] if it exceeds [`TURN`]: the step is too long for the chart, and might lead to another branch.
    pub(super) fn onto(
        &self,
        system: &L,
        mut state: StateOf<L>,
        (tolerance, y): (Tolerance, &PhaseVector<L::Scalar, L::N>),
        turn: &mut f64,
    ) -> Result<StateOf<L>, NoSolution> {
        let bound = L::Scalar::constant(ROUND_OFF * L::Scalar::EPSILON);
        for level in BOTH.into_iter().filter(|level| level.concerns::<L>()) {
            let (mut before, terms) = (f64::INFINITY, level.magnitude(system, &state));
            for _ in 0..CORRECTIONS {
                let residual = level.residual(system, &state);
                if (0..<L::M>::COUNT).all(|a| Scalar::abs(residual[a]) <= bound * terms[a]) {
                    break;
                }
                let Some(correction) = self.correction(system, level, &residual.into(), state.t)? else {
                    break;
                };
                let mut halves = [Array::filled(zero::<L>()); 2];
                halves[level as usize] = correction;
                let size = tolerance.part(L::Scalar::constant(1.0), &PhaseVector::new(halves), y).to_f64();
                let is_small = size <= SMALL;
                if is_small && size >= before {
                    break;
                }
                if before > SMALL {
                    *turn = turn.max(size / before);
                }
                if !(is_small || size <= TURN * before) {
                    return Err(NoSolution::TooSlow((MARGIN * TURN / *turn).clamp(0.1, 0.8)));
                }
                before = size;
                let unknowns = level.unknowns(&mut state);
                unknowns.iter_mut().zip(correction).for_each(|(x, change)| *x += change);
            }
        }
        Ok(state)
    }
}

fn zero<L: Lagrangian>() -> L::Scalar {
    L::Scalar::constant(0.0)
}
