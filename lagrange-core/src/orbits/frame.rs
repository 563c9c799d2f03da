//! Components of small changes of a state, in units of the orbit.

use nalgebra::{DMatrix, DVector};

use super::form::symplectic_form;
use crate::error::Error;
use crate::generic::StaticLength;
use crate::linearized::Linearized;
use crate::number::{Real, larger, norm, power_of_epsilon, smaller, unit_of};
use crate::trajectory::Trajectory;
use crate::{ConstraintKind, StateOf};

/// Units of an orbit: its largest coordinate and its largest velocity, 1 if all are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OrbitUnits<T> {
    pub(super) q: T,
    pub(super) v: T,
}

impl<T: Real> OrbitUnits<T> {
    /// Largest coordinate and velocity of all steps of some motions.
    pub(super) fn of<'t, L: Linearized<Scalar = T> + 't>(
        motions: impl Iterator<Item = &'t Trajectory<&'t L>>,
    ) -> Self {
        let mut largest = [T::constant(0.0); 2];
        for state in motions.flat_map(Trajectory::steps).map(|sample| *sample.state()) {
            largest = [larger(largest[0], state.q.amax()), larger(largest[1], state.v.amax())];
        }
        let [q, v] = largest.map(unit_of);
        Self { q, v }
    }

    /// True if either differs by more than a factor of 2.
    pub(super) fn differ(self, other: Self) -> bool {
        let differs = |x: T, y: T| larger(x, y) > T::constant(2.0) * smaller(x, y);
        differs(self.q, other.q) || differs(self.v, other.v)
    }

    /// The larger of both.
    pub(super) fn united(self, other: Self) -> Self {
        Self { q: larger(self.q, other.q), v: larger(self.v, other.v) }
    }

    /// Unit of entry `i` of the `2 n` entries of (q, q̇).
    pub(super) fn unit(&self, i: usize, n: usize) -> T {
        if i < n { self.q } else { self.v }
    }
}

/// Components at a state: δ(q, q̇) = B ξ with columns B that are orthonormal in the units of the orbit, and span the
/// tangent space of the constraints.
#[derive(Clone, Debug)]
pub(super) struct Frame<T> {
    /// B, one row for each entry of (q, q̇).
    pub(super) basis: DMatrix<T>,
    /// B⁺, which takes δ(q, q̇) to the components of its part in the tangent space.
    pub(super) dual: DMatrix<T>,
    /// Rate (q̇, q̈).
    pub(super) rate: DVector<T>,
    /// Orthonormal basis Z of the tangent space, in the units of the user.
    pub(super) tangents: DMatrix<T>,
}

impl<T: Real> Frame<T> {
    pub(super) fn at<L: Linearized<Scalar = T>>(
        system: &L,
        state: &StateOf<L>,
        units: OrbitUnits<T>,
    ) -> Result<Self, Error> {
        let (near, n) = (system.linearize(state, &[])?, <L::N>::COUNT);
        let scaled =
            DMatrix::from_fn(2 * n, near.basis.ncols(), |i, j| near.basis[(i, j)] / units.unit(i, n));
        let q = if scaled.is_square() { DMatrix::identity(2 * n, 2 * n) } else { scaled.qr().q() };
        let basis = DMatrix::from_fn(2 * n, q.ncols(), |i, j| q[(i, j)] * units.unit(i, n));
        let dual = DMatrix::from_fn(q.ncols(), 2 * n, |i, j| q[(j, i)] / units.unit(j, n));
        Ok(Self { basis, dual, rate: near.rate, tangents: near.basis })
    }

    /// Number of components.
    pub(super) fn count(&self) -> usize {
        self.basis.ncols()
    }

    /// Components of the direction along the motion, of length 1; `None` at rest.
    pub(super) fn along(&self) -> Option<DVector<T>> {
        unit(&self.dual * &self.rate)
    }

    /// Components of the gradient of the energy, of length 1, and its length: dE = ω(·, f) for the rate f. `None` where it
    /// vanishes.
    pub(super) fn energy<L: Linearized<Scalar = T>>(
        &self,
        system: &L,
        state: &StateOf<L>,
    ) -> Option<(DVector<T>, T)> {
        let gradient = match L::CONSTRAINT_KINDS.contains(&ConstraintKind::Velocity) {
            false => self.basis.tr_mul(&(symplectic_form(system, state) * &self.rate)),
            // There the form lacks the work of the multipliers along changes that velocities do not allow.
            true => self.energy_by_differences(system, state),
        };
        let length = norm(gradient.as_slice());
        Some((unit(gradient)?, length))
    }
}

impl<T: Real> Frame<T> {
    /// Derivatives of the energy along the columns of B, by central differences.
    fn energy_by_differences<L: Linearized<Scalar = T>>(&self, system: &L, state: &StateOf<L>) -> DVector<T> {
        let step = power_of_epsilon::<T>(1.0 / 3.0);
        let energy = |by: T, j: usize| system.energy(&shifted::<L>(state, &(self.basis.column(j) * by)));
        DVector::from_fn(self.basis.ncols(), |j, _| (energy(step, j) - energy(-step, j)) / (step + step))
    }
}

fn unit<T: Real>(x: DVector<T>) -> Option<DVector<T>> {
    let length = norm(x.as_slice());
    (length > T::constant(0.0) && length.is_finite()).then(|| x / length)
}

/// Entries (q, q̇) of a state.
pub(super) fn flat<L: Linearized<Scalar: Real>>(state: &StateOf<L>) -> DVector<L::Scalar> {
    DVector::from_iterator(2 * <L::N>::COUNT, state.q.iter().chain(&state.v).copied())
}

/// The state moved by these changes of (q, q̇).
pub(super) fn shifted<L: Linearized<Scalar: Real>>(
    state: &StateOf<L>,
    by: &DVector<L::Scalar>,
) -> StateOf<L> {
    let mut moved = *state;
    moved.q.iter_mut().chain(&mut moved.v).zip(by.iter()).for_each(|(x, by)| *x += *by);
    moved
}
