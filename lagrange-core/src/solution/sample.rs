//! A state of a motion, with lookup by name.

#[cfg(feature = "alloc")]
mod named;

use core::borrow::Borrow;
use core::fmt::{self, Debug, Display, Formatter};

use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;
use crate::solution::energy_field::EnergyField;
use crate::solution::named_field::NamedField;
use crate::solution::solve::solve;
use crate::system::{Lagrangian, SolutionOf, State, StateOf, System};
use crate::vector::{Numbers, zeros};

/// A state of a system with derived quantities: accelerations, multipliers, energy, observables.
///
/// Quantities are looked up by name; [`state`](Self::state) and [`solution`](Self::solution) hold them by
/// index, in the order of the attributes. Accelerations and multipliers are computed on request.
///
/// The sample holds the system `S` in the same way as its trajectory: borrowed, or as a copy. For a system in
/// an `Arc` or an `Rc`, only the pointer is copied.
pub struct Sample<S: System> {
    system: S,
    state: StateOf<S>,
    /// Accelerations and multipliers, if they are not those that the equations have at this state.
    given: Option<SolutionOf<S>>,
}

impl<S: System + Clone> Clone for Sample<S> {
    #[inline]
    fn clone(&self) -> Self {
        Self { system: self.system.clone(), state: self.state.clone(), given: self.given }
    }
}

impl<S: System + Copy> Copy for Sample<S> where StateOf<S>: Copy {}

impl<S: System> Sample<S> {
    #[inline]
    pub(crate) fn of(system: S, state: StateOf<S>) -> Self {
        Self { system, state, given: None }
    }

    /// The same with these accelerations and multipliers; `None` for those of the equations.
    pub(crate) fn with(self, given: Option<SolutionOf<S>>) -> Self {
        Self { given, ..self }
    }

    /// The same sample of the borrowed system.
    #[cfg(feature = "alloc")]
    pub(crate) fn borrowed(&self) -> Sample<&S> {
        Sample { system: &self.system, state: self.state.clone(), given: self.given }
    }

    /// Accelerations and multipliers, if they are not those of the equations.
    pub(crate) fn given(&self) -> Option<SolutionOf<S>> {
        self.given
    }
}

impl<L: System> Sample<&L> {
    /// The same sample of the system behind a pointer.
    #[inline]
    pub(crate) fn behind<K>(&self) -> Sample<&K>
    where
        L: Borrow<K>,
        K: System<Length = L::Length, M = L::M, Scalar = L::Scalar>,
    {
        Sample { system: self.system.borrow(), state: self.state.clone(), given: self.given }
    }
}

impl<L: System + Clone> Sample<&L> {
    /// Returns the sample with its own copy of the system; the original may then change or be dropped.
    pub fn into_owned(self) -> Sample<L> {
        let Self { system, state, given } = self;
        Sample { system: system.clone(), state, given }
    }
}

impl<S: System> Sample<S> {
    /// Returns the system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Returns time, coordinates and velocities.
    pub fn state(&self) -> &StateOf<S> {
        &self.state
    }

    /// Returns the time.
    pub fn time(&self) -> S::Scalar {
        self.state.t
    }
}

impl<S: System<Scalar: Real>> Sample<S> {
    /// Returns the energy E = p·q̇ − L, the value of the Hamiltonian H(t, q, p).
    pub fn energy(&self) -> S::Scalar
    where
        S::Field: EnergyField<S>,
    {
        S::Field::energy(&self.system, &self.state)
    }
}

impl<S: Lagrangian<Scalar: Real>> Sample<S> {
    /// Returns accelerations and multipliers, solved for at this state; in a [motion by time steps](crate::contact::MoreauJean) the
    /// means over the step that leads there, and NaN for its events.
    ///
    /// # Errors
    /// Those of [`Simulate::solve`](crate::Simulate::solve).
    pub fn solution(&self) -> Result<SolutionOf<S>, Error> {
        self.given.map_or_else(|| solve(&self.system, &self.state), Ok)
    }

    /// Returns dE/dt along the motion, the power of forces, moving constraints and a Lagrangian that changes with time; see
    /// [`energy_rate`](Lagrangian::energy_rate).
    ///
    /// # Errors
    /// Those of [`solution`](Self::solution).
    pub fn energy_rate(&self) -> Result<S::Scalar, Error> {
        let multipliers = self.solution()?.multipliers;
        Ok(match self.given {
            None => self.system.energy_rate(&self.state, &multipliers),
            // Velocities need not satisfy the constraints: their forces have a power of their own.
            Some(_) => {
                let power = self.system.constraint_force(&self.state, &multipliers).dot(&self.state.v);
                self.system.energy_rate(&self.state, &zeros()) + power
            }
        })
    }
}

/// Formats a sample as `t = 1.0: theta = 0.1, theta_dot = -2e-17`. Format options apply to each number:
/// `{sample:.3}`.
impl<S: System<Scalar: Real, Field: NamedField<S>>> Display for Sample<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let State { t, q, v } = &self.state;
        write!(f, "{} = ", Entry::Time)?;
        Debug::fmt(t, f)?;
        let mut before = ':';
        for (half, numbers) in [q.entries(), v.entries()].into_iter().enumerate() {
            for (i, number) in numbers.iter().enumerate() {
                write!(f, "{before} {} = ", S::Field::state_entry(&self.system, half, i))?;
                Debug::fmt(number, f)?;
                before = ',';
            }
        }
        Ok(())
    }
}

impl<S: System> Debug for Sample<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Sample").field("state", &self.state).finish_non_exhaustive()
    }
}
