//! Points of the phase space of coordinates and momenta, and their rates by Hamilton's equations.

use core::fmt::{self, Display, Formatter};

use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::solution::solve::solve_near;
use crate::system::{Entries, Lagrangian, StateOf, write_state};
use crate::vector::{Array, Element, Entrywise, StaticLength, Vector};

/// The time `t`, the generalized coordinates `q` and the generalized momenta `p` = ∂L/∂q̇.
///
/// ```
/// use lagrange_core::PhaseState;
/// let state = PhaseState::new([0.1, 0.0], [0.0, 2.0]).at_time(1.0);
/// assert_eq!((state.t, state.q[0], state.p[1]), (1.0, 0.1, 2.0));
/// assert_eq!(PhaseState::new([1e-17], [2.0]).to_string(), "t = 0.0: q = (1e-17), p = (2.0)");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "T: nalgebra::Scalar + serde::Serialize",
        deserialize = "T: nalgebra::Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct PhaseState<T: Element, N: StaticLength> {
    /// Time.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::system::serial::number"))]
    pub t: T,
    /// Generalized coordinates.
    #[cfg_attr(feature = "serde", serde(with = "crate::system::serial::numbers"))]
    pub q: Vector<T, N>,
    /// Generalized momenta.
    #[cfg_attr(feature = "serde", serde(with = "crate::system::serial::numbers"))]
    pub p: Vector<T, N>,
}

impl<T: Scalar, N: StaticLength> PhaseState<T, N> {
    /// Creates a phase state of coordinates and momenta at `t = 0`.
    pub fn new(q: impl Entries<T, N>, p: impl Entries<T, N>) -> Self {
        Self { t: T::constant(0.0), q: q.into_vector(), p: p.into_vector() }
    }

    /// Returns the same coordinates and momenta at the time `t`.
    #[must_use]
    pub fn at_time(self, t: T) -> Self {
        Self { t, ..self }
    }
}

/// Formats a phase state as `t = 1.0: q = (0.1, 0.0), p = (0.0, 2e-17)`. Format options apply to each number:
/// `{state:.3}`.
impl<T: Scalar, N: StaticLength> Display for PhaseState<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write_state(f, &self.t, [("q", self.q.as_slice()), ("p", self.p.as_slice())])
    }
}

/// Rates by Hamilton's equations at a [`PhaseState`], with the multipliers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "T: nalgebra::Scalar + serde::Serialize",
        deserialize = "T: nalgebra::Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct PhaseDerivative<T: Element, N: StaticLength, M: StaticLength> {
    /// q̇ = ∂H/∂p.
    #[cfg_attr(feature = "serde", serde(with = "crate::system::serial::numbers"))]
    pub q: Vector<T, N>,
    /// ṗ = ∂L/∂q + Q + Fᵀλ.
    #[cfg_attr(feature = "serde", serde(with = "crate::system::serial::numbers"))]
    pub p: Vector<T, N>,
    /// Lagrange multipliers λ, in the order written.
    #[cfg_attr(feature = "serde", serde(with = "crate::system::serial::numbers"))]
    pub multipliers: Vector<T, M>,
}

/// Rates, number of independent constraints, and the constraints that determine the rates.
pub(super) type Rates<T, N, M> = (PhaseDerivative<T, N, M>, usize, Array<bool, M>);

/// Returns the rates by Hamilton's equations at a state that the Legendre transform gave.
pub(super) fn equations<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    active: Option<&Array<bool, L::M>>,
) -> Result<Rates<L::Scalar, L::N, L::M>, Error> {
    solve_near(system, state, active, |solution, &active| {
        (rate(system, state, solution.multipliers), solution.rank, active)
    })
}

/// Rates of coordinates and momenta for these multipliers.
pub(super) fn rate<L: Lagrangian>(
    system: &L,
    state: &StateOf<L>,
    multipliers: Vector<L::Scalar, L::M>,
) -> PhaseDerivative<L::Scalar, L::N, L::M> {
    let p = system.momentum_rate(state).plus(&system.constraint_force(state, &multipliers));
    PhaseDerivative { q: state.v, p, multipliers }
}
