//! A point of the phase space of coordinates and momenta, and its rate.

use nalgebra::SVector;

use crate::error::Error;
use crate::names::Entry;
use crate::number::{Real, Scalar};
use crate::system::Lagrangian;
use crate::system::finite::all_finite;

/// The time `t`, the generalized coordinates `q` and the generalized momenta `p` = ∂L/∂q̇.
///
/// ```
/// use lagrange_core::PhaseState;
/// let state = PhaseState::new([0.1, 0.0], [0.0, 2.0]).at_time(1.0);
/// assert_eq!((state.t, state.q[0], state.p[1]), (1.0, 0.1, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseState<T, const N: usize> {
    /// Time.
    pub t: T,
    /// Generalized coordinates.
    pub q: SVector<T, N>,
    /// Generalized momenta.
    pub p: SVector<T, N>,
}

impl<T: Scalar, const N: usize> PhaseState<T, N> {
    /// Coordinates and momenta at `t = 0`.
    pub fn new(q: impl Into<SVector<T, N>>, p: impl Into<SVector<T, N>>) -> Self {
        Self { t: T::constant(0.0), q: q.into(), p: p.into() }
    }

    /// The same coordinates and momenta at the time `t`.
    #[must_use]
    pub fn at_time(self, t: T) -> Self {
        Self { t, ..self }
    }
}

/// What Hamilton's equations give at a [`PhaseState`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseRate<T, const N: usize, const M: usize> {
    /// q̇ = ∂H/∂p.
    pub q: SVector<T, N>,
    /// ṗ = ∂L/∂q + Q + Fᵀλ.
    pub p: SVector<T, N>,
    /// Lagrange multipliers λ, in the order written.
    pub multipliers: SVector<T, M>,
}

/// Every entry must be a number.
pub(super) fn check_finite<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    _: &L,
    phase: &PhaseState<L::Scalar, N>,
) -> Result<(), Error> {
    let q = L::COORDINATES.iter().zip(&phase.q).map(|(name, x)| (Entry::Coordinate(name), *x));
    let p = L::COORDINATES.iter().zip(&phase.p).map(|(name, x)| (Entry::Momentum(name), *x));
    all_finite(core::iter::once((Entry::Time, phase.t)).chain(q).chain(p))
}
