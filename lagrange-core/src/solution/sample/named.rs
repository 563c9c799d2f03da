//! Lookup by name in a [`Sample`].

use alloc::vec::Vec;

use super::Sample;
use crate::error::Error;
use crate::number::Real;
use crate::system::Lagrangian;
use crate::system::lookup::{index, unknown};

/// Lookup by name.
impl<S: Lagrangian<Scalar: Real>> Sample<S> {
    /// Returns the generalized coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn coordinate(&self, name: &str) -> Result<S::Scalar, Error> {
        Ok(self.state.q[coordinate::<S>(name)?])
    }

    /// Returns the generalized velocity of the coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn velocity(&self, name: &str) -> Result<S::Scalar, Error> {
        Ok(self.state.v[coordinate::<S>(name)?])
    }

    /// Returns the generalized momentum ∂L/∂q̇ of the coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn momentum(&self, name: &str) -> Result<S::Scalar, Error> {
        Ok(self.system.momentum(&self.state)[coordinate::<S>(name)?])
    }

    /// Returns the generalized acceleration of the coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`], and those of [`solution`](Self::solution).
    pub fn acceleration(&self, name: &str) -> Result<S::Scalar, Error> {
        let index = coordinate::<S>(name)?;
        Ok(self.solution()?.accelerations[index])
    }

    /// Returns the multiplier λ of the constraint of this name. If constraints depend on one another, as
    /// [`Solution::multipliers_are_unique`](crate::Solution::multipliers_are_unique) tells, the multipliers are
    /// those of least norm in units in which masses are 1 and the rows of F have length 1.
    ///
    /// # Errors
    /// [`Error::UnknownName`], and those of [`solution`](Self::solution).
    pub fn multiplier(&self, name: &str) -> Result<S::Scalar, Error> {
        let index = index::<S>(S::CONSTRAINTS, "constraint", name)?;
        Ok(self.solution()?.multipliers[index])
    }

    /// Returns the generalized constraint force Σ_α λ_α F_αa on the coordinate of this name, Milton (8.7). Friction of contacts counts;
    /// that of its own, by `#[friction(…)]`, counts while it sticks, and is an applied force while it slides.
    ///
    /// # Errors
    /// [`Error::UnknownName`], and those of [`solution`](Self::solution).
    pub fn constraint_force(&self, name: &str) -> Result<S::Scalar, Error> {
        let index = coordinate::<S>(name)?;
        Ok(self.system.constraint_force(&self.state, &self.solution()?.multipliers)[index])
    }

    /// Returns the observable of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`], and those of [`solution`](Self::solution).
    pub fn observable(&self, name: &str) -> Result<S::Scalar, Error> {
        let index = index::<S>(S::OBSERVABLES, "observable", name)?;
        let value = self.system.observable(index, &self.state, &self.solution()?);
        value.ok_or_else(|| unknown::<S>(S::OBSERVABLES, "observable", name))
    }

    /// Returns the conserved quantity of this name: `p_phi`, `energy`, or one given in `#[conserved(…)]`.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn conserved(&self, name: &str) -> Result<S::Scalar, Error> {
        let names: Vec<&'static str> = S::FACTS.conserved.iter().map(|conserved| conserved.name).collect();
        let index = index::<S>(&names, "conserved quantity", name)?;
        self.system
            .conserved(index, &self.state)
            .ok_or_else(|| unknown::<S>(&names, "conserved quantity", name))
    }
}

fn coordinate<L: Lagrangian>(name: &str) -> Result<usize, Error> {
    index::<L>(L::COORDINATES, "coordinate", name)
}
