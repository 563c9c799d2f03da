//! The two levels of constraints, and how far a state is off them.

use core::array::from_fn;

use nalgebra::SVector;

use crate::error::Error;
use crate::names::name;
use crate::number::{
    Real, Scalar, beyond_round_off, entries, exceeds, is_within, power_of_epsilon, smaller, sum,
};
use crate::system::{ConstraintKind, Lagrangian, State};

/// What is projected: the coordinates onto the holonomic constraints, or the velocities onto all.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Level {
    Position,
    Velocity,
}

pub(crate) const BOTH: [Level; 2] = [Level::Position, Level::Velocity];

impl Level {
    /// Whether a constraint acts on it.
    pub(crate) fn concerns<L: Lagrangian<N, M>, const N: usize, const M: usize>(self) -> bool {
        L::CONSTRAINT_KINDS.iter().any(|kind| self.is_active(*kind))
    }

    /// What should be zero.
    pub(crate) fn residual<L: Lagrangian<N, M>, const N: usize, const M: usize>(
        self,
        system: &L,
        state: &State<L::Scalar, N>,
    ) -> SVector<L::Scalar, M> {
        match self {
            Self::Position => system.constraint_residual(state),
            Self::Velocity => system.constraint_rate(state),
        }
    }

    /// The rows of the constraints that act on it, zeros for the others.
    pub(crate) fn jacobian<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
        self,
        system: &L,
        state: &State<L::Scalar, N>,
    ) -> [[L::Scalar; N]; M] {
        let (zero, jacobian) = (L::Scalar::constant(0.0), system.constraint_jacobian(state));
        let is_active = |a: usize| self.is_active(L::CONSTRAINT_KINDS[a]);
        from_fn(|a| entries(|i| if is_active(a) { jacobian[(a, i)] } else { zero }))
    }

    /// The size of the terms that it is the sum of.
    pub(crate) fn magnitude<L: Lagrangian<N, M>, const N: usize, const M: usize>(
        self,
        system: &L,
        state: &State<L::Scalar, N>,
    ) -> SVector<L::Scalar, M> {
        match self {
            Self::Position => system.residual_magnitude(state),
            Self::Velocity => system.rate_magnitude(state),
        }
    }

    /// Unknowns of this level: coordinates or velocities.
    pub(crate) fn unknowns<T, const N: usize>(self, state: &mut State<T, N>) -> &mut SVector<T, N> {
        match self {
            Self::Position => &mut state.q,
            Self::Velocity => &mut state.v,
        }
    }

    pub(crate) fn is_active(self, kind: ConstraintKind) -> bool {
        self == Self::Velocity || kind == ConstraintKind::Holonomic
    }
}

/// So many units of round-off of the terms of a constraint may be round-off, where these cancel.
pub(super) const NEGLIGIBLE: f64 = 16.0;

/// What should be zero, with the Jacobian and the size of the terms that it is the sum of.
pub(super) struct Residual<T, const N: usize, const M: usize> {
    pub(super) value: [T; M],
    pub(super) jacobian: [[T; N]; M],
    /// Σ |F_αa| |x_a|: of this, a part ε is round-off.
    pub(super) terms: [T; M],
    /// Σ |F_αa|: the terms where the unknowns are about 1.
    pub(super) sensitivity: [T; M],
}

impl<T: Real, const N: usize, const M: usize> Residual<T, N, M> {
    pub(crate) fn of<L: Lagrangian<N, M, Scalar = T>>(system: &L, level: Level, state: &State<T, N>) -> Self {
        let zero = T::constant(0.0);
        let active = L::CONSTRAINT_KINDS.map(|kind| level.is_active(kind));
        let jacobian = level.jacobian(system, state);
        let value = level.residual(system, state);
        let x = *level.unknowns(&mut { *state });
        Self {
            value: entries(|a| if active[a] { value[a] } else { zero }),
            terms: entries(|a| sum(N, |i| Scalar::abs(jacobian[a][i] * x[i]))),
            sensitivity: entries(|a| sum(N, |i| Scalar::abs(jacobian[a][i]))),
            jacobian,
        }
    }

    /// The first constraint with a residual of more than this part of its terms (and of ε^(3/4) where they vanish).
    pub(crate) fn first_above(&self, part: T) -> Option<usize> {
        (0..M).find(|&a| !is_within(Scalar::abs(self.value[a]), self.bound(part, a)))
    }

    pub(crate) fn bound(&self, part: T, a: usize) -> T {
        part * self.terms[a] + power_of_epsilon::<T>(0.75) * self.sensitivity[a]
    }

    /// What a projection may leave of each as round-off.
    pub(crate) fn negligible(&self) -> [T; M] {
        entries(|a| self.bound(T::constant(NEGLIGIBLE * T::EPSILON), a))
    }

    /// Counts of each term only what Φ really changes by with its coordinate, of which an eighth more is tried. The angle
    /// 10¹⁶ and the gradient of its sine have a large product, but a sine is never as far off.
    pub(crate) fn limit_terms<L>(&mut self, system: &L, state: &State<T, N>)
    where
        L: Lagrangian<N, M, Scalar = T>,
    {
        let part = T::constant(0.125);
        self.terms = [T::constant(0.0); M];
        for i in 0..N {
            let mut moved = *state;
            moved.q[i] *= T::constant(1.0) + part;
            let value = system.constraint_residual(&moved);
            for a in 0..M {
                let change = Scalar::abs(value[a] - self.value[a]) / part;
                self.terms[a] += smaller(Scalar::abs(self.jacobian[a][i] * state.q[i]), change);
            }
        }
    }

    /// The distance to the constraint farthest off, as if each stood alone, and which one that is. Round-off of the terms
    /// of a constraint is no distance: it must not hide another.
    pub(crate) fn farthest(&self) -> (T, usize) {
        let zero = T::constant(0.0);
        let mut farthest = (zero, 0);
        for a in 0..M {
            let value = beyond_round_off(self.value[a], self.terms[a]);
            let distance = if self.sensitivity[a] > zero { value / self.sensitivity[a] } else { value };
            // What is not a number is farthest of all, and stays that.
            if is_number(farthest.0) && exceeds(distance, farthest.0) {
                farthest = (distance, a);
            }
        }
        farthest
    }
}

/// Whether `x` is anything but NaN.
fn is_number<T: Real>(x: T) -> bool {
    x.partial_cmp(&x).is_some()
}

/// The coordinates only, or the velocities only.
pub(crate) fn check_level<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    level: Level,
    state: &State<L::Scalar, N>,
) -> Result<(), Error> {
    let mut residual = Residual::of(system, level, state);
    if level == Level::Position {
        residual.limit_terms(system, state);
    }
    match residual.first_above(power_of_epsilon(0.5)) {
        None => Ok(()),
        Some(row) => Err(Error::Inconsistent {
            constraint: name(&L::CONSTRAINTS, row),
            rate: level == Level::Velocity,
            residual: residual.value[row].to_f64(),
            time: state.t.to_f64(),
        }),
    }
}
