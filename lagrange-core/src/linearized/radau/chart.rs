//! Coordinates of the constraint manifold near a state: the tangent plane there.
//!
//! A point of the manifold has the coordinates Π(q − q₀), where Π projects onto the tangent plane along M⁻¹Fᵀ (tangent
//! space parametrization: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, IV.5.3). In these coordinates a
//! stiff force along the constraints stays one. On all coordinates, a turn ε of the constraints in a step of length h
//! would feed h c ε² of a damping c into the iteration, which then diverges.

use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::room::Room;
use crate::solution::consistent::BOTH;
use crate::solution::consistent::level::Level;
use crate::solution::kkt::{Factors, Rank};
use crate::solution::pivot::is_trustworthy;
use crate::solution::solve::fault;
use crate::system::{ConstraintKind, Lagrangian, StateOf};
use crate::vector::{Array, Length, PhaseVector, Vector, rows, vector};

/// Largest number of corrections towards the constraints; each divides the residual by four or more.
const CORRECTIONS: usize = 30;
/// Residual, in units of ε of its terms, at which corrections end.
const ROUND_OFF: f64 = 4.0;
/// Residual, in the same units, that may remain where it no longer shrinks.
const NEAR: f64 = 4096.0;
/// Largest ratio of the residual after a correction to that before. With a quarter, all corrections together are at most
/// 4/3 of the first.
const CONTRACTION: f64 = 0.25;

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

impl<L: Lagrangian<Scalar: Real>> Chart<L> {
    pub(super) fn at(system: &L, state: &StateOf<L>) -> Self {
        let general = |level: Level| {
            let (m, f) = (system.mass_matrix(state).into(), level.jacobian(system, state));
            Solver::General(Room::of(Factors::of(&m, &f, Rank::off_constraints())))
        };
        let zeros = (vector(Array::filled(zero::<L>())), vector(Array::filled(zero::<L>())));
        let emitted = || {
            let factor = system.factor(state);
            is_trustworthy(&system.solve_with(&factor, &zeros.0, &zeros.1)).then_some(Solver::Emitted(factor))
        };
        let is_mixed = L::CONSTRAINT_KINDS.contains(&ConstraintKind::Velocity);
        let velocities = (<L::M>::COUNT > 0).then(|| emitted().unwrap_or_else(|| general(Level::Velocity)));
        let coordinates = is_mixed.then(|| general(Level::Position));
        Self { f: Room::of(rows(&system.constraint_jacobian(state))), velocities, coordinates }
    }

    /// The least x with F x = −`residual` on a level; `None` without constraints.
    fn correction(
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

    /// Moves a state onto the constraints along M⁻¹Fᵀ, without a change of its coordinates in the tangent plane. `None` if
    /// the step of length `h` is too long for the chart: corrections that contract by less than [`CONTRACTION`] may lead to
    /// another branch.
    pub(super) fn onto(
        &self,
        system: &L,
        mut state: StateOf<L>,
        h: L::Scalar,
    ) -> Result<Option<StateOf<L>>, Error> {
        for level in BOTH.into_iter().filter(|level| level.concerns::<L>()) {
            let mut before = None;
            for _ in 0..CORRECTIONS {
                let residual = level.residual(system, &state);
                let total = total::<L>(&residual);
                let terms = level.magnitude(system, &state);
                let bound = L::Scalar::constant(ROUND_OFF * L::Scalar::EPSILON);
                let is_there = (0..<L::M>::COUNT).all(|a| Scalar::abs(residual[a]) <= bound * terms[a]);
                let shrinks = before.is_none_or(|before| total <= before * L::Scalar::constant(CONTRACTION));
                if is_there || !shrinks && is_near_round_off(system, level, &state, (total, h)) {
                    break;
                }
                if !shrinks {
                    return Ok(None);
                }
                before = Some(total);
                let correction = self.correction(system, level, &residual.into(), state.t)?;
                let unknowns = level.unknowns(&mut state);
                for (x, change) in unknowns.iter_mut().zip(correction.iter().flatten()) {
                    *x += *change;
                }
            }
        }
        Ok(Some(state))
    }
}

/// True if a residual is near the round-off of its terms, or of those of a motion over the step. Projection at the end of
/// a step has a criterion of its own.
fn is_near_round_off<L: Lagrangian<Scalar: Real>>(
    system: &L,
    level: Level,
    state: &StateOf<L>,
    (residual, h): (L::Scalar, L::Scalar),
) -> bool {
    let [positions, rates] = BOTH.map(|level| total::<L>(&level.magnitude(system, state)));
    let terms = match level {
        Level::Position => positions + rates * Scalar::abs(h),
        Level::Velocity => rates + positions / Scalar::abs(h),
    };
    residual <= terms * L::Scalar::constant(NEAR * L::Scalar::EPSILON)
}

/// Sum of the magnitudes.
fn total<L: Lagrangian<Scalar: Real>>(x: &Vector<L::Scalar, L::M>) -> L::Scalar {
    x.iter().fold(zero::<L>(), |sum, x| sum + Scalar::abs(*x))
}

fn zero<L: Lagrangian>() -> L::Scalar {
    L::Scalar::constant(0.0)
}
