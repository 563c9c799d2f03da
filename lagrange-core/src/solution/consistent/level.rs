//! The two levels of constraints, positions and velocities, and their residuals.

use crate::error::Error;
use crate::names::{Row, name};
use crate::number::limits::{CANCELLED, CHANGE};
use crate::number::{Real, Scalar, beyond_round_off, exceeds, is_within, power_of_epsilon, smaller, sum};
use crate::system::{ConstraintKind, Lagrangian, State, StateOf};
use crate::vector::{Array, Element, StaticLength, Vector, from_fn};

/// Unknowns of a projection: the coordinates, projected onto the holonomic constraints, or the velocities,
/// projected onto all constraints.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Level {
    Position,
    Velocity,
}

pub(crate) const BOTH: [Level; 2] = [Level::Position, Level::Velocity];

impl Level {
    /// True if a constraint acts on this level.
    pub(crate) fn concerns<L: Lagrangian>(self) -> bool {
        L::CONSTRAINT_KINDS.iter().any(|kind| self.is_active(*kind))
    }

    /// Constraint residual of this level, Φ or F q̇ + b.
    pub(crate) fn residual<L: Lagrangian>(self, system: &L, state: &StateOf<L>) -> Vector<L::Scalar, L::M> {
        match self {
            Self::Position => system.constraint_residual(state),
            Self::Velocity => system.constraint_rate(state),
        }
    }

    /// Constraint Jacobian of this level; rows of constraints that do not act on it are zero.
    pub(crate) fn jacobian<L: Lagrangian<Scalar: Real>>(
        self,
        system: &L,
        state: &StateOf<L>,
    ) -> Array<Array<L::Scalar, L::N>, L::M> {
        let (zero, jacobian) = (L::Scalar::constant(0.0), system.constraint_jacobian(state));
        let is_active = |a: usize| self.is_active(L::CONSTRAINT_KINDS[a]);
        from_fn(|a| Array::from_fn(|i| if is_active(a) { jacobian[(a, i)] } else { zero }))
    }

    /// Magnitude of the terms of the residual, for its round-off.
    pub(crate) fn magnitude<L: Lagrangian>(self, system: &L, state: &StateOf<L>) -> Vector<L::Scalar, L::M> {
        match self {
            Self::Position => system.residual_magnitude(state),
            Self::Velocity => system.rate_magnitude(state),
        }
    }

    /// Unknowns of this level: coordinates or velocities.
    pub(crate) fn unknowns<T: Element, N: StaticLength>(self, state: &mut State<T, N>) -> &mut Vector<T, N> {
        match self {
            Self::Position => &mut state.q,
            Self::Velocity => &mut state.v,
        }
    }

    pub(crate) fn is_active(self, kind: ConstraintKind) -> bool {
        self == Self::Velocity || kind == ConstraintKind::Holonomic
    }
}

/// Residual of a level, with its Jacobian and the magnitude of its terms.
pub(super) struct Residual<T: Element, N: StaticLength, M: StaticLength> {
    pub(super) value: Array<T, M>,
    pub(super) jacobian: Array<Array<T, N>, M>,
    /// Σ |F_αa| |x_a|, the magnitude of the terms; ε times it is their round-off.
    pub(super) terms: Array<T, M>,
    /// Σ |F_αa|, the magnitude of the terms for unknowns of size 1.
    pub(super) sensitivity: Array<T, M>,
}

impl<T: Real, N: StaticLength, M: StaticLength> Residual<T, N, M> {
    pub(crate) fn of<L: Lagrangian<N = N, M = M, Scalar = T>>(
        system: &L,
        level: Level,
        state: &State<T, N>,
    ) -> Self {
        let zero = T::constant(0.0);
        let active = |a: usize| level.is_active(L::CONSTRAINT_KINDS[a]);
        let jacobian = level.jacobian(system, state);
        let value = level.residual(system, state);
        let x = *level.unknowns(&mut { *state });
        Self {
            value: Array::from_fn(|a| if active(a) { value[a] } else { zero }),
            terms: Array::from_fn(|a| sum(N::COUNT, |i| Scalar::abs(jacobian[a][i] * x[i]))),
            sensitivity: Array::from_fn(|a| sum(N::COUNT, |i| Scalar::abs(jacobian[a][i]))),
            jacobian,
        }
    }

    /// Returns the first constraint whose residual exceeds `part` of its terms (plus ε^(3/4) of its
    /// sensitivity, for terms near zero).
    pub(crate) fn first_above(&self, part: T) -> Option<usize> {
        (0..M::COUNT).find(|&a| !is_within(Scalar::abs(self.value[a]), self.bound(part, a)))
    }

    pub(crate) fn bound(&self, part: T, a: usize) -> T {
        part * self.terms[a] + power_of_epsilon::<T>(0.75) * self.sensitivity[a]
    }

    /// Returns the residual of each constraint that a projection may leave as round-off.
    pub(crate) fn negligible(&self) -> Array<T, M> {
        Array::from_fn(|a| self.bound(T::constant(CANCELLED * T::EPSILON), a))
    }

    /// Limits each term to the actual change of Φ with its coordinate, measured by an increase of the
    /// coordinate by an eighth. An angle of 10¹⁶ times the gradient of its sine is a large term, but the sine
    /// is never that inaccurate.
    pub(crate) fn limit_terms<L: Lagrangian<N = N, M = M, Scalar = T>>(
        &mut self,
        system: &L,
        state: &State<T, N>,
    ) {
        let part = T::constant(CHANGE);
        self.terms = Array::filled(T::constant(0.0));
        for i in 0..N::COUNT {
            let mut moved = *state;
            moved.q[i] *= T::constant(1.0) + part;
            let value = system.constraint_residual(&moved);
            for a in 0..M::COUNT {
                let change = Scalar::abs(value[a] - self.value[a]) / part;
                self.terms[a] += smaller(Scalar::abs(self.jacobian[a][i] * state.q[i]), change);
            }
        }
    }

    /// Returns the distance to the farthest constraint, each taken alone, and its index. Round-off of the terms
    /// does not count as distance: it must not hide the distance of another constraint.
    pub(crate) fn farthest(&self) -> (T, usize) {
        let zero = T::constant(0.0);
        let mut farthest = (zero, 0);
        for a in 0..M::COUNT {
            let value = beyond_round_off(self.value[a], self.terms[a]);
            let distance = if self.sensitivity[a] > zero { value / self.sensitivity[a] } else { value };
            // NaN counts as the largest distance.
            if is_number(farthest.0) && exceeds(distance, farthest.0) {
                farthest = (distance, a);
            }
        }
        farthest
    }
}

/// True unless `x` is NaN.
fn is_number<T: Real>(x: T) -> bool {
    x.partial_cmp(&x).is_some()
}

/// Checks the constraints of one level, on the coordinates or on the velocities.
pub(crate) fn check_level<L: Lagrangian<Scalar: Real>>(
    system: &L,
    level: Level,
    state: &StateOf<L>,
) -> Result<(), Error> {
    let mut residual = Residual::of(system, level, state);
    if level == Level::Position {
        residual.limit_terms(system, state);
    }
    match residual.first_above(power_of_epsilon(0.5)) {
        None => Ok(()),
        Some(row) => Err(Error::Inconsistent {
            constraint: Row::Constraint(name(L::CONSTRAINTS, row)),
            rate: level == Level::Velocity,
            residual: residual.value[row].to_f64(),
            time: state.t.to_f64(),
        }),
    }
}
