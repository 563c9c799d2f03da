//! How accelerations and multipliers change along a direction: K δ(q̈, λ) = −∂R, with one factorization for all.

use core::cell::OnceCell;

use nalgebra::{ComplexField, SVector};

use super::direction::unit;
use super::{Direction, Linearized, ResidualChange, StateDerivatives};
use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;
use crate::solution::kkt::{Factors, Rank};
use crate::solution::solve::{fault, first_row, is_trustworthy, solve};
use crate::system::{Lagrangian, Solution, State};

/// The equations of motion at a state, solved and factorized.
pub(super) struct Tangent<'a, L: Lagrangian<N, M>, const N: usize, const M: usize> {
    system: &'a L,
    pub(super) state: &'a State<L::Scalar, N>,
    pub(super) solution: Solution<L::Scalar, N, M>,
    factor: L::Factor,
    matrices: OnceCell<Matrices<L::Scalar, N, M>>,
}

/// What the emitted factor does not tell, or cannot vouch for.
pub(super) struct Matrices<T, const N: usize, const M: usize> {
    /// The mass matrix, row by row.
    #[cfg(feature = "alloc")]
    pub(super) m: [[T; N]; N],
    /// The constraint Jacobian, row by row.
    #[cfg(feature = "alloc")]
    pub(super) f: [[T; N]; M],
    pub(super) factors: Factors<T, N, M>,
}

impl<'a, L, const N: usize, const M: usize> Tangent<'a, L, N, M>
where
    L: StateDerivatives<N, M, Scalar: Real>,
{
    pub(super) fn at(system: &'a L, state: &'a State<L::Scalar, N>) -> Result<Self, Error> {
        let (solution, factor) = (solve(system, state)?, system.factor(state));
        Ok(Self { system, state, solution, factor, matrices: OnceCell::new() })
    }

    /// Made where they are asked for.
    pub(super) fn matrices(&self) -> &Matrices<L::Scalar, N, M> {
        self.matrices.get_or_init(|| {
            let m = self.system.mass_matrix(self.state).into();
            let f = self.system.constraint_jacobian(self.state).transpose().into();
            // A change that leaves the constraints may make dependent ones disagree: those left out do not count.
            let factors = Factors::of(&m, &f, Rank::off_constraints());
            Matrices {
                #[cfg(feature = "alloc")]
                m,
                #[cfg(feature = "alloc")]
                f,
                factors,
            }
        })
    }

    /// δq̈ and δλ along a direction; `entry` is what to call it.
    pub(super) fn along(
        &self,
        direction: &Direction<L::Scalar, N>,
        entry: Entry,
    ) -> Result<Solution<L::Scalar, N, M>, Error> {
        self.response(&self.change(direction, entry)?, entry)
    }

    /// δq̈ and δλ by parameter `k` alone.
    pub(super) fn by_parameter<const P: usize>(&self, k: usize) -> Result<Solution<L::Scalar, N, M>, Error>
    where
        L: Linearized<N, M, P>,
    {
        let change = self.change_by_parameter(&self.solution, k)?;
        self.response(&change, Entry::Parameter(L::PARAMETERS[k]))
    }

    /// What makes up for a change of the residual.
    fn response(
        &self,
        change: &ResidualChange<L::Scalar, N, M>,
        entry: Entry,
    ) -> Result<Solution<L::Scalar, N, M>, Error> {
        let (h, gamma) = (-change.motion, change.acceleration);
        let fast = self.system.solve_with(&self.factor, &h, &gamma);
        if is_trustworthy(&fast) {
            return Ok(fast);
        }
        let (time, factors) = (self.state.t.to_f64(), &self.matrices().factors);
        let solution =
            factors.solve(&h.into(), &gamma.into()).map_err(|found| fault::<L, N, M>(&found, time))?;
        self.check_finite(&solution.accelerations, &[solution.multipliers], entry)?;
        Ok(solution)
    }

    /// The derivative of the residual, which must be finite.
    pub(super) fn change(
        &self,
        direction: &Direction<L::Scalar, N>,
        entry: Entry,
    ) -> Result<ResidualChange<L::Scalar, N, M>, Error> {
        self.checked(self.system.residual_change(self.state, &self.solution, direction), entry)
    }

    /// The derivative of the residual by parameter `k`, with these accelerations and multipliers; it must be finite.
    pub(super) fn change_by_parameter<const P: usize>(
        &self,
        solution: &Solution<L::Scalar, N, M>,
        k: usize,
    ) -> Result<ResidualChange<L::Scalar, N, M>, Error>
    where
        L: Linearized<N, M, P>,
    {
        let change = self.system.residual_change_by_parameters(self.state, solution, &unit(k));
        self.checked(change, Entry::Parameter(L::PARAMETERS[k]))
    }

    fn checked(
        &self,
        change: ResidualChange<L::Scalar, N, M>,
        entry: Entry,
    ) -> Result<ResidualChange<L::Scalar, N, M>, Error> {
        let ResidualChange { motion, acceleration, rate, position } = change;
        self.check_finite(&motion, &[acceleration, rate, position], entry)?;
        Ok(change)
    }

    /// Names the first row that is not finite, of a coordinate or of a constraint.
    fn check_finite(
        &self,
        motion: &SVector<L::Scalar, N>,
        constraints: &[SVector<L::Scalar, M>],
        entry: Entry,
    ) -> Result<(), Error> {
        let finite = |a: usize| constraints.iter().all(|x| x[a].is_finite());
        match first_row::<L, N, M>(|i| !motion[i].is_finite(), |a| !finite(a)) {
            None => Ok(()),
            Some(row) => Err(Error::DerivativeNotFinite { row, entry, time: self.state.t.to_f64() }),
        }
    }
}
