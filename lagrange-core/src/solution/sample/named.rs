//! Lookup by name in a [`Sample`].

use alloc::vec::Vec;

use super::Sample;
use crate::error::Error;
use crate::number::Real;
use crate::solution::energy_field::EnergyField;
use crate::solution::named_field::NamedField;
use crate::system::lookup::{index, unknown};
use crate::system::{Lagrangian, System};

/// Lookup by name.
impl<S: System<Scalar: Real>> Sample<S>
where
    S::Field: NamedField<S>,
{
    /// Returns the generalized coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn coordinate(&self, name: &str) -> Result<S::Scalar, Error> {
        Ok(self.state.q[S::Field::coordinate(&self.system, name)?])
    }

    /// Returns the generalized velocity of the coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn velocity(&self, name: &str) -> Result<S::Scalar, Error> {
        Ok(self.state.v[S::Field::coordinate(&self.system, name)?])
    }

    /// Returns the generalized momentum ∂L/∂q̇ of the coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn momentum(&self, name: &str) -> Result<S::Scalar, Error>
    where
        S::Field: EnergyField<S>,
    {
        let index = S::Field::coordinate(&self.system, name)?;
        Ok(S::Field::momentum(&self.system, &self.state)[index])
    }

    /// Returns the generalized acceleration of the coordinate of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`], and those of [`Simulate::solve`](crate::Simulate::solve).
    pub fn acceleration(&self, name: &str) -> Result<S::Scalar, Error> {
        let index = S::Field::coordinate(&self.system, name)?;
        Ok(S::Field::accelerations(self)?[index])
    }

    /// Returns the conserved quantity of this name: `p_phi`, `energy`, or one given in `#[conserved(…)]`.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn conserved(&self, name: &str) -> Result<S::Scalar, Error>
    where
        S::Field: EnergyField<S>,
    {
        let names: Vec<&'static str> = S::Field::CONSERVED.iter().map(|conserved| conserved.name).collect();
        let index = names.iter().position(|known| *known == name);
        index
            .and_then(|index| S::Field::conserved(&self.system, index, &self.state))
            .ok_or_else(|| S::Field::unknown(&self.system, &names, "conserved quantity", name))
    }
}

/// Lookup of constraints and observables by name.
impl<S: Lagrangian<Scalar: Real>> Sample<S> {
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
        let index = S::Field::coordinate(&self.system, name)?;
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
}
