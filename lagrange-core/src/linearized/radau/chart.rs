//! Coordinates of the constraint manifold near a state: the tangent plane there.
//!
//! A point of the manifold has the coordinates Π(q − q₀), where Π projects onto the tangent plane along M⁻¹Fᵀ (tangent
//! space parametrization: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, IV.5.3). In these coordinates a
//! stiff force along the constraints stays one. On all coordinates, a turn ε of the constraints in a step of length h
//! would feed h c ε² of a damping c into the iteration, which then diverges.

use super::iteration::NoSolution;
use super::limits::NEGLIGIBLE;
use crate::error::Error;
use crate::motion::method::control::Tolerance;
use crate::number::limits::CANCELLED;
use crate::number::limits::ITERATIONS;
use crate::number::{Real, Scalar};
use crate::room::Room;
use crate::solution::consistent::BOTH;
use crate::solution::consistent::level::Level;
use crate::solution::kkt::{Factors, Rank};
use crate::solution::pivot::is_trustworthy;
use crate::solution::solve::fault;
use crate::system::{Lagrangian, StateOf, has_velocity_constraints};
use crate::vector::{Array, PhaseVector, StaticLength, rows, vector, zeros};

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
    /// Factorizes by the emitted function if that is reliable and has the constraints of this level; `old` gives its storage.
    fn at(system: &L, level: Level, state: &StateOf<L>, old: Option<Self>) -> Self {
        if level == Level::Velocity || !has_velocity_constraints::<L>() {
            let factor = system.factor(state);
            if is_trustworthy::<L::Scalar, _, _>(&system.solve_with(&factor, &zeros(), &zeros())) {
                return Self::Emitted(factor);
            }
        }
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

    /// The least x with F x = −`residual`.
    fn correction(
        &self,
        system: &L,
        residual: &Array<L::Scalar, L::M>,
        time: L::Scalar,
    ) -> Result<Array<L::Scalar, L::N>, Error> {
        let found = match self {
            Self::Emitted(factor) => system.solve_with(factor, &zeros(), &vector(*residual)),
            Self::General(factors) => factors
                .solve(&Array::filled(zero::<L>()), residual)
                .map_err(|found| fault::<L>(&found, time.to_f64()))?,
        };
        Ok(found.accelerations.into())
    }
}

/// Jacobian F of the corrections towards the constraints.
#[derive(Clone, Copy)]
enum Gradients {
    /// That of the chart, which is factorized.
    OfChart,
    /// That at the state of each correction.
    Own,
}

impl<L: Lagrangian<Scalar: Real>> Chart<L> {
    pub(super) fn at(system: &L, state: &StateOf<L>) -> Self {
        let velocities = (<L::M>::COUNT > 0).then(|| Solver::at(system, Level::Velocity, state, None));
        let coordinates =
            has_velocity_constraints::<L>().then(|| Solver::at(system, Level::Position, state, None));
        Self { f: Room::of(rows(&system.constraint_jacobian(state))), velocities, coordinates }
    }

    /// Moves the chart to another state, and keeps its storage.
    pub(super) fn set(&mut self, system: &L, state: &StateOf<L>) {
        *self.f = rows(&system.constraint_jacobian(state));
        for (level, solver) in BOTH.into_iter().zip([&mut self.coordinates, &mut self.velocities]) {
            *solver = solver.take().map(|old| Solver::at(system, level, state, Some(old)));
        }
    }

    /// The least x with F x = −`residual` on a level.
    pub(super) fn correction(
        &self,
        system: &L,
        level: Level,
        residual: &Array<L::Scalar, L::M>,
        time: L::Scalar,
    ) -> Result<Array<L::Scalar, L::N>, Error> {
        let own = self.coordinates.as_ref().filter(|_| level == Level::Position);
        match own.or(self.velocities.as_ref()) {
            None => Ok(Array::filled(zero::<L>())),
            Some(solver) => solver.correction(system, residual, time),
        }
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
        Ok(Array::from_fn(|i| x[i] + correction[i]))
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
    /// are measured in units of the tolerance at the state `y`.
    ///
    /// The gradients of the chart serve near it. Their corrections x shrink by 1 − σ/σ₀ along a combination of constraints with
    /// F x = σ, and σ₀ at the chart. Past a pose where this combination vanishes, σ and σ₀ have opposite signs and the
    /// corrections grow, however short the step: there the own gradients of each point serve.
    pub(super) fn onto(
        &self,
        system: &L,
        mut state: StateOf<L>,
        size: (Tolerance, &PhaseVector<L::Scalar, L::N>),
    ) -> Result<StateOf<L>, NoSolution> {
        for level in BOTH.into_iter().filter(|level| level.concerns::<L>()) {
            let mut reaches = |gradients| self.reaches(system, level, &mut state, (gradients, size));
            if !reaches(Gradients::OfChart)? && !reaches(Gradients::Own)? {
                return Err(NoSolution::TooSlow);
            }
        }
        Ok(state)
    }

    /// Corrects a state until the constraints hold to round-off. False if a correction is more than half of the one before: they
    /// might lead far, to another branch. Negligible ones need not shrink: they are round-off, or those of dependent constraints,
    /// which agree on the manifold only.
    fn reaches(
        &self,
        system: &L,
        level: Level,
        state: &mut StateOf<L>,
        (gradients, (tolerance, y)): (Gradients, (Tolerance, &PhaseVector<L::Scalar, L::N>)),
    ) -> Result<bool, Error> {
        let bound = L::Scalar::constant(CANCELLED * L::Scalar::EPSILON);
        let (mut before, terms) = (f64::INFINITY, level.magnitude(system, state));
        for _ in 0..ITERATIONS {
            let residual: Array<_, L::M> = level.residual(system, state).into();
            if (0..<L::M>::COUNT).all(|a| Scalar::abs(residual[a]) <= bound * terms[a]) {
                break;
            }
            let correction = match gradients {
                Gradients::OfChart => self.correction(system, level, &residual, state.t)?,
                Gradients::Own => self.own_correction(system, level, &residual, state)?,
            };
            let mut halves = [Array::filled(zero::<L>()); 2];
            halves[level as usize] = correction;
            let size = tolerance.part(L::Scalar::constant(1.0), &PhaseVector::new(halves), y).to_f64();
            let is_small = size <= NEGLIGIBLE;
            if is_small && size >= before {
                break;
            }
            if !(is_small || size <= 0.5 * before) {
                return Ok(false);
            }
            before = size;
            level.unknowns(state).iter_mut().zip(correction).for_each(|(x, change)| *x += change);
        }
        Ok(true)
    }

    /// The part along the normals of the chart of the least x with F x = −`residual`, with F at a state. It leaves a residual
    /// that is smaller by the square of the sine between the tangent planes of the chart and the state.
    fn own_correction(
        &self,
        system: &L,
        level: Level,
        residual: &Array<L::Scalar, L::M>,
        state: &StateOf<L>,
    ) -> Result<Array<L::Scalar, L::N>, Error> {
        let least = Solver::at(system, level, state, None).correction(system, residual, state.t)?;
        let tangent = self.tangent(system, level, &least, state.t)?;
        Ok(Array::from_fn(|i| least[i] - tangent[i]))
    }
}

fn zero<L: Lagrangian>() -> L::Scalar {
    L::Scalar::constant(0.0)
}
