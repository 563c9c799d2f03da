//! Properties of a system that a motion needs besides the rates.

use super::consistent::{Consistent, check, project_to_round_off};
use super::named_field::NamedField;
use super::solve::solve;
use super::vector_field::{LagrangianVectorField, VectorField};
use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::system::finite::check_finite;
use crate::system::{Lagrangian, StateOf, System};
use crate::vector::{Length, Numbers, Vector, VectorOf};

/// Checks of the states of a system, and names for messages about it.
pub trait SystemChecks<L: System<Scalar: Real>>: NamedField<L> {
    /// True for a system with [contacts](crate::contact).
    const HAS_CONTACTS: bool;
    /// True if the force of friction is a multiple of a multiplier.
    const HAS_FRICTION: bool;
    /// Names of the coordinates; empty if they are known when the program runs.
    const COORDINATES: &'static [&'static str];
    /// Names of the constraints.
    const CONSTRAINTS: &'static [&'static str];
    /// Hash of the equations; 0 if they are written by hand.
    const DIGEST: u32;
    /// Names of the functions that the user supplies.
    const SUPPLIED: &'static [&'static str];

    /// Returns the name of the system.
    fn name() -> &'static str;

    /// Checks that a state has as many entries as its system has coordinates, and that the fields of the system fit one another.
    ///
    /// # Errors
    /// [`Error::StateLength`].
    fn check_fit(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        check_length(system, state)
    }

    /// Checks that the entries of a state and the parameters are finite, and that the state has as many entries as the system has
    /// coordinates.
    ///
    /// # Errors
    /// [`Error::StateNotFinite`], [`Error::StateLength`] and [`Error::ParameterNotAsSaid`].
    fn check_entries(system: &L, state: &StateOf<L>) -> Result<(), Error>;

    /// Checks that the equations of motion have a solution at a state.
    ///
    /// # Errors
    /// Those of [`Simulate::solve`](crate::Simulate::solve).
    fn check_solution(system: &L, state: &StateOf<L>) -> Result<(), Error>;

    /// Checks that a state satisfies the constraints, to √ε.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] and [`Error::NoGradient`].
    fn check_constraints(system: &L, state: &StateOf<L>) -> Result<(), Error>;

    /// Projects a state that satisfies the constraints to √ε onto them, to round-off.
    ///
    /// # Errors
    /// [`Error::NotProjected`].
    fn adjust(system: &L, state: &StateOf<L>) -> Result<Consistent<L::Scalar, L::Length>, Error>;

    /// Calls `visit` with each number of the system that its equations name, and the index of each constraint that is switched off.
    fn visit_numbers(system: &L, visit: &mut dyn FnMut(f64));

    /// Returns the momenta; of a system that is stated by its accelerations, the velocities.
    fn momenta(system: &L, state: &StateOf<L>) -> VectorOf<L::Scalar, L::Length>;
}

/// Checks by the constraints, the parameters and the names of a Lagrangian system.
impl<L: Lagrangian<Scalar: Real>> SystemChecks<L> for LagrangianVectorField {
    const HAS_CONTACTS: bool = L::HAS_CONTACTS;
    const HAS_FRICTION: bool = L::HAS_FRICTION;
    const COORDINATES: &'static [&'static str] = L::COORDINATES;
    const CONSTRAINTS: &'static [&'static str] = L::CONSTRAINTS;
    const DIGEST: u32 = L::DIGEST;
    const SUPPLIED: &'static [&'static str] = L::SUPPLIED;

    fn name() -> &'static str {
        L::NAME
    }

    fn check_entries(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        check_finite(system, state)
    }

    fn check_solution(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        solve(system, state).map(|_| ())
    }

    #[inline]
    fn check_constraints(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        check(system, state)
    }

    fn adjust(system: &L, state: &StateOf<L>) -> Result<Consistent<L::Scalar, L::N>, Error> {
        project_to_round_off(system, state)
    }

    fn visit_numbers(system: &L, visit: &mut dyn FnMut(f64)) {
        system.visit_parameters(&mut |_, x| visit(x.to_f64()));
        // Open contacts are constraints that are switched off, too.
        let off = |c: &L::Scalar| *c != L::Scalar::constant(0.0);
        let compliance = system.compliance();
        compliance.iter().enumerate().filter(|(_, c)| off(c)).for_each(|(a, _)| visit(a as f64));
    }

    fn momenta(system: &L, state: &StateOf<L>) -> Vector<L::Scalar, L::N> {
        system.momentum(state)
    }
}

/// Checks that a state has as many coordinates and velocities as its system has coordinates.
pub(super) fn check_length<L: System>(system: &L, state: &StateOf<L>) -> Result<(), Error> {
    let expected = system.length().count();
    match [state.q.entries(), state.v.entries()].iter().find(|half| half.len() != expected) {
        None => Ok(()),
        Some(half) => Err(Error::StateLength { found: half.len(), expected }),
    }
}

/// Checks of a system by its own equations of motion.
pub(crate) type ChecksOf<L> = <<L as System>::Field as VectorField<L>>::Checks;
