//! Consistent states: coordinates on Φ = 0, velocities on F q̇ + b = 0.
//!
//! Newton's iteration with corrections δ of least norm in the metric of the mass matrix: M δ − Fᵀμ = 0, F δ =
//! −residual. This is the linear system of the dynamics with other right-hand sides (Hairer, Lubich and Wanner,
//! *Geometric Numerical Integration*, IV.4). Each correction is the least, but on curved constraints their sum
//! is not. For a state within round-off of the constraints the difference is negligible; from farther away the
//! [nearest] point is then sought.

pub(crate) mod assembly;
pub(crate) mod dependence;
pub(crate) mod gradient;
pub(crate) mod level;
mod nearest;
#[cfg(test)]
mod tests;

use core::fmt::{self, Display, Formatter};
use nalgebra::ComplexField;

use crate::error::Error;
use crate::names::{Row, name};
use crate::number::limits::{CANCELLED, ITERATIONS};
use crate::number::{Real, Scalar, largest};
use crate::numerics::newton::{self, Left, Search, halvings};
use crate::room::Room;
use crate::solution::eliminate::eliminate;
use crate::solution::kkt::{Factors, Rank};
use crate::solution::near::{self, Corrections};
use crate::solution::pivot::is_trustworthy;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{
    Array, Element, Entrywise, Length, Numbers, StaticLength, Vector, VectorOf, from_fn, vector, vector_of,
};
use level::Residual;
pub(crate) use level::{BOTH, Level, check_level};

/// Displacement of a state by a projection onto the constraints.
#[derive(Clone, Debug, PartialEq)]
pub struct Adjustment<T: Element, N: Length> {
    /// Projected minus given generalized coordinates.
    pub q: VectorOf<T, N>,
    /// Projected minus given generalized velocities.
    pub v: VectorOf<T, N>,
}

impl<T: Element, N: Length> Copy for Adjustment<T, N> where VectorOf<T, N>: Copy {}

impl<T: Real, N: Length> Adjustment<T, N> {
    /// Returns the zero displacement.
    pub(crate) fn none(length: N) -> Self {
        let none = vector_of::<_, N>(length.count(), T::constant(0.0));
        Self { q: none.clone(), v: none }
    }

    /// Returns the displacement from one state to another.
    pub(crate) fn between(given: &State<T, N>, projected: &State<T, N>) -> Self {
        let change = |from: &VectorOf<T, N>, to: &VectorOf<T, N>| {
            let mut change = to.clone();
            change.entries_mut().iter_mut().zip(from.entries()).for_each(|(to, from)| *to -= *from);
            change
        };
        Self { q: change(&given.q, &projected.q), v: change(&given.v, &projected.v) }
    }

    /// Returns the largest change of a coordinate, in magnitude.
    pub fn largest_coordinate_change(&self) -> T {
        largest(self.q.entries())
    }

    /// Returns the largest change of a velocity, in magnitude.
    pub fn largest_velocity_change(&self) -> T {
        largest(self.v.entries())
    }
}

impl<T: Real, N: Length> Display for Adjustment<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (q, v) = (self.largest_coordinate_change().to_f64(), self.largest_velocity_change().to_f64());
        write!(f, "coordinates moved by at most {q:e}, velocities by at most {v:e}")
    }
}

/// A consistent state and its displacement from the given state.
pub type Consistent<T, N> = (State<T, N>, Adjustment<T, N>);

/// Implements [`Simulate::make_consistent_holding`](crate::Simulate::make_consistent_holding); `held` marks the
/// coordinates and the velocities to hold.
pub(crate) fn make_consistent<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    held: &[Array<bool, L::N>; 2],
) -> Result<Consistent<L::Scalar, L::N>, Error> {
    let mut consistent = *state;
    if const { <L::M>::COUNT > 0 } {
        gradient::check(system, state)?;
        project_holding(system, Level::Position, &held[0], &mut consistent)?;
        nearest::approach(system, state, &held[0], &mut consistent);
        project_holding(system, Level::Velocity, &held[1], &mut consistent)?;
    }
    adjusted(system, state, consistent)
}

/// Projects a state that satisfies the constraints to √ε onto them, to round-off.
pub(crate) fn project_to_round_off<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Result<Consistent<L::Scalar, L::N>, Error> {
    let mut settled = *state;
    project_in_general(system, &BOTH, &mut settled)?;
    adjusted(system, state, settled)
}

/// Checks the projected state and returns it with its displacement from the given state.
fn adjusted<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    consistent: StateOf<L>,
) -> Result<Consistent<L::Scalar, L::N>, Error> {
    check(system, &consistent).map_err(|error| match error {
        Error::Inconsistent { constraint, residual, time, .. } => {
            Error::NotProjected { constraint, residual, iterations: 0, time }
        }
        error => error,
    })?;
    Ok((consistent, Adjustment::between(state, &consistent)))
}

/// Projects the coordinates, the velocities or both, the coordinates first, to the nearest ones on their
/// constraints.
pub(crate) fn project<L: Lagrangian<Scalar: Real>>(
    system: &L,
    levels: &[Level],
    state: &mut StateOf<L>,
) -> Result<(), Error> {
    project_by(Corrections::ToRoundOff, system, levels, state, &mut none())
}

/// Zero rounding errors of coordinates and velocities.
fn none<T: Scalar, N: StaticLength>() -> [Array<T, N>; 2] {
    [Array::filled(T::constant(0.0)); 2]
}

/// Projects with the given corrections if the state is near the constraints, else by the general projection.
/// `rest` holds the rounding errors of coordinates and velocities.
#[inline]
pub(crate) fn project_by<L: Lagrangian<Scalar: Real>>(
    corrections: Corrections<L::Scalar>,
    system: &L,
    levels: &[Level],
    state: &mut StateOf<L>,
    rest: &mut [Array<L::Scalar, L::N>; 2],
) -> Result<(), Error> {
    // `const`: the compiler omits the rest for a system without constraints.
    if const { <L::M>::COUNT == 0 }
        || !levels.iter().any(|level| level.concerns::<L>())
        || are_all_off(system)
    {
        return Ok(());
    }
    let (near, doubt) = near::project::<L, L::Scalar>(system, levels, corrections, *state, rest);
    if doubt == L::Scalar::constant(0.0) {
        *state = near;
        return Ok(());
    }
    *rest = none();
    project_in_general(system, levels, state)
}

/// True if no constraint holds, so that every state is consistent.
#[inline(always)]
fn are_all_off<L: Lagrangian>(system: &L) -> bool {
    system.compliance().iter().all(|&off| off == L::Scalar::constant(1.0))
}

#[cold]
fn project_in_general<L: Lagrangian<Scalar: Real>>(
    system: &L,
    levels: &[Level],
    state: &mut StateOf<L>,
) -> Result<(), Error> {
    levels.iter().try_for_each(|&level| search(system, (level, Reach::Near), &Array::filled(false), state))
}

/// Projects a guess onto the constraints of a level, from anywhere.
pub(crate) fn project_guess<L: Lagrangian<Scalar: Real>>(
    system: &L,
    level: Level,
    state: &mut StateOf<L>,
) -> Result<(), Error> {
    project_holding(system, level, &Array::filled(false), state)
}

fn project_holding<L: Lagrangian<Scalar: Real>>(
    system: &L,
    level: Level,
    held: &Array<bool, L::N>,
    state: &mut StateOf<L>,
) -> Result<(), Error> {
    let found = search(system, (level, Reach::Far), held, state);
    if found.is_err() && held.contains(&true) {
        // If the constraints cannot hold even with all entries free, this error takes precedence.
        project_guess(system, level, &mut { *state })?;
    }
    found
}

fn search<L: Lagrangian<Scalar: Real>>(
    system: &L,
    (level, reach): (Level, Reach),
    held: &Array<bool, L::N>,
    state: &mut StateOf<L>,
) -> Result<(), Error> {
    if const { <L::M>::COUNT == 0 } || !level.concerns::<L>() {
        return Ok(());
    }
    let mut projection = Projection { system, level, reach, held };
    let start = projection.trial(*state);
    *state = newton::find(&mut projection, start)?.0.0;
    Ok(())
}

/// Distance from the constraints at which a projection begins.
#[derive(Clone, Copy, PartialEq)]
enum Reach {
    /// The end of a step: whole corrections reach the constraints, and each gains a bit at least. Others lead far, to another branch.
    Near,
    /// A guess, from which corrections are damped.
    Far,
}

/// Implements [`Simulate::check_consistent`](crate::Simulate::check_consistent).
pub(crate) fn check<L: Lagrangian<Scalar: Real>>(system: &L, state: &StateOf<L>) -> Result<(), Error> {
    gradient::check(system, state)?;
    BOTH.into_iter().try_for_each(|level| check_level(system, level, state))
}

/// Newton's search for the nearest state on the constraints of a level.
struct Projection<'a, L: Lagrangian> {
    system: &'a L,
    level: Level,
    reach: Reach,
    /// True for entries that keep their value.
    held: &'a Array<bool, L::N>,
}

/// A trial state and its residual.
type Trial<T, N, M> = (State<T, N>, Residual<T, N, M>);

impl<L: Lagrangian<Scalar: Real>> Projection<'_, L> {
    #[inline(never)]
    fn trial(&self, state: StateOf<L>) -> Trial<L::Scalar, L::N, L::M> {
        (state, Residual::of(self.system, self.level, &state))
    }

    /// Returns the least δ with F δ = −residual over the entries that are not held. Neither this function nor
    /// its callees are inlined, so the stack holds few matrices at a time.
    #[inline(never)]
    fn correction(
        &self,
        (state, residual): &Trial<L::Scalar, L::N, L::M>,
        rank: Rank<L::Scalar>,
    ) -> Option<Vector<L::Scalar, L::N>> {
        let mut m = mass_matrix(self.system, state);
        let mut f = residual.jacobian;
        hold(self.held, &mut m, &mut f);
        // For small constraints beside large ones the elimination is more accurate than the general solver.
        fast_correction(&m, &f, &residual.value)
            .or_else(|| self.general_correction(&m, &f, &residual.value, rank))
    }

    #[cold]
    #[inline(never)]
    fn general_correction(
        &self,
        m: &Array<Array<L::Scalar, L::N>, L::N>,
        f: &Array<Array<L::Scalar, L::N>, L::M>,
        left: &Array<L::Scalar, L::M>,
        rank: Rank<L::Scalar>,
    ) -> Option<Vector<L::Scalar, L::N>> {
        let zero = L::Scalar::constant(0.0);
        let step = factors_of_nearest(m, f, rank).solve(&Array::filled(zero), left).ok()?.accelerations;
        let moving: Vector<_, L::N> = vector(Array::from_fn(|i| if self.held[i] { zero } else { step[i] }));
        moving.iter().all(|x| x.is_finite()).then_some(moving)
    }
}

impl<L: Lagrangian<Scalar: Real>> Search for Projection<'_, L> {
    type Scalar = L::Scalar;
    type Error = Error;
    type Trial = Trial<L::Scalar, L::N, L::M>;
    type Linear = ();

    fn limit(&self) -> usize {
        match self.reach {
            Reach::Near => f64::MANTISSA_DIGITS as usize,
            Reach::Far => ITERATIONS,
        }
    }

    fn linearize(&mut self, _: &Self::Trial) -> Result<(), Error> {
        Ok(())
    }

    fn left(&self, (): &(), (_, residual): &Self::Trial) -> Left<L::Scalar> {
        let (distance, _) = residual.farthest();
        let is_rounded = distance == L::Scalar::constant(0.0);
        let part = L::Scalar::constant(CANCELLED * L::Scalar::EPSILON);
        let is_negligible = is_rounded || residual.first_above(part).is_none();
        Left { distance, is_rounded, is_negligible }
    }

    fn corrected(
        &self,
        (): &(),
        trial: &Self::Trial,
        converged: bool,
    ) -> Result<impl Iterator<Item = Self::Trial>, Error> {
        // Constraints that are nearly dependent at this trial are usually dependent where they hold. If these
        // steps fail, all constraints count as independent.
        let ranks = [Rank::towards_constraints(), Rank::off_constraints()].into_iter();
        let steps = ranks.filter_map(|rank| self.correction(trial, rank));
        Ok(steps.flat_map(move |step| {
            halvings::<L::Scalar>(converged || self.reach == Reach::Near).map(move |part| {
                let mut state = trial.0;
                let unknowns = self.level.unknowns(&mut state);
                *unknowns = unknowns.each_with(&step, |x, change| x + change * part);
                self.trial(state)
            })
        }))
    }

    #[cold]
    fn not_found(&self, (): &(), (state, residual): &Self::Trial, steps: usize) -> Error {
        let (_, row) = residual.farthest();
        let constraint = name(L::CONSTRAINTS, row);
        let left = residual.value.get(row).map_or(f64::NAN, |value| value.to_f64());
        let time = state.t.to_f64();
        if !self.held.contains(&true) {
            let constraint = Row::Constraint(constraint);
            return Error::NotProjected { constraint, residual: left, iterations: steps, time };
        }
        let held = (0..<L::N>::COUNT).filter(|&i| self.held[i]).map(|i| L::COORDINATES[i]).collect();
        Error::HeldTooMuch { constraint, rate: self.level == Level::Velocity, residual: left, held, time }
    }
}

#[inline(never)]
fn fast_correction<T: Real, N: StaticLength, M: StaticLength>(
    m: &Array<Array<T, N>, N>,
    f: &Array<Array<T, N>, M>,
    left: &Array<T, M>,
) -> Option<Vector<T, N>> {
    let fast = eliminate(*m, Array::filled(T::constant(0.0)), *f, *left);
    is_trustworthy(&fast).then_some(fast.accelerations)
}

/// Factorization for the least x with F x + γ = 0, in the metric of the mass matrix. If F leaves a direction
/// without mass, the metric is the diagonal of M. Holonomic constraints alone leave such a direction if a
/// velocity constraint ties a massless coordinate.
pub(crate) fn factors_of_nearest<T: Real, N: StaticLength, M: StaticLength>(
    m: &Array<Array<T, N>, N>,
    f: &Array<Array<T, N>, M>,
    rank: Rank<T>,
) -> Factors<T, N, M> {
    let factors = Factors::of(m, f, rank);
    if factors.are_regular() { factors } else { Factors::of(&diagonal(m), f, rank) }
}

/// Removes held entries from the equations: zero columns in the constraints, and a unit mass without coupling.
fn hold<T: Real, N: StaticLength>(held: &Array<bool, N>, m: &mut [Array<T, N>], f: &mut [Array<T, N>]) {
    for i in (0..N::COUNT).filter(|&i| held[i]) {
        m.iter_mut().chain(&mut *f).for_each(|row| row[i] = T::constant(0.0));
        if let Some(row) = m.get_mut(i) {
            *row = Array::from_fn(|j| T::constant(if i == j { 1.0 } else { 0.0 }));
        }
    }
}

/// Mass matrix, in a function of its own: while it is made it takes more of the stack than its result.
#[inline(never)]
fn mass_matrix<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Array<Array<L::Scalar, L::N>, L::N> {
    system.mass_matrix(state).into()
}

/// Diagonal part of the mass matrix, with 1 in place of zero masses.
#[inline(never)]
fn diagonal<T: Real, N: StaticLength>(m: &Array<Array<T, N>, N>) -> Room<Array<Array<T, N>, N>> {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let mass = |i: usize| if m[i][i] == zero { one } else { Scalar::abs(m[i][i]) };
    Room::of(from_fn(|i| Array::from_fn(|j| if i == j { mass(i) } else { zero })))
}
