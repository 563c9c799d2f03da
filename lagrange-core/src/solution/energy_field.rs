//! Energy, momenta and conserved quantities of a system.

use super::named_field::NamedField;
use super::vector_field::LagrangianVectorField;
use crate::facts::Conserved;
use crate::number::Real;
use crate::system::{Lagrangian, StateOf, System};
use crate::vector::VectorOf;
#[cfg(feature = "alloc")]
use crate::{
    solution::vector_field::VectorField,
    trajectory::{Deviation, Leg, balance},
};

/// Equations of motion of a system with a Lagrangian, which has an energy and momenta.
#[diagnostic::on_unimplemented(
    message = "`{L}` has no energy, momenta or conserved quantities",
    label = "its accelerations alone are stated",
    note = "`#[derive(Lagrangian)]` derives accelerations and energy from a Lagrangian; an energy of one's own is a function of `sample.state()`"
)]
pub trait EnergyField<L: System<Scalar: Real>>: NamedField<L> {
    /// Conserved quantities.
    const CONSERVED: &'static [Conserved];

    /// Energy E = p·q̇ − L.
    fn energy(system: &L, state: &StateOf<L>) -> L::Scalar;

    /// Generalized momenta p = ∂L/∂q̇.
    fn momentum(system: &L, state: &StateOf<L>) -> VectorOf<L::Scalar, L::Length>;

    /// Value of a conserved quantity; `None` if there are fewer.
    fn conserved(system: &L, index: usize, state: &StateOf<L>) -> Option<L::Scalar>;

    /// Balance of an energy that is not conserved, or not throughout, with the work done along these legs; `None` if it is conserved,
    /// or if the power of forces is not known.
    #[cfg(feature = "alloc")]
    #[doc(hidden)]
    fn balance<F: VectorField<L>>(_: &[Leg<L, F>]) -> Option<Deviation<L::Scalar>> {
        None
    }
}

impl<L: Lagrangian<Scalar: Real>> EnergyField<L> for LagrangianVectorField {
    const CONSERVED: &'static [Conserved] = L::FACTS.conserved;

    fn energy(system: &L, state: &StateOf<L>) -> L::Scalar {
        system.energy(state)
    }

    fn momentum(system: &L, state: &StateOf<L>) -> VectorOf<L::Scalar, L::N> {
        system.momentum(state)
    }

    fn conserved(system: &L, index: usize, state: &StateOf<L>) -> Option<L::Scalar> {
        system.conserved(index, state)
    }

    #[cfg(feature = "alloc")]
    fn balance<F: VectorField<L>>(legs: &[Leg<L, F>]) -> Option<Deviation<L::Scalar>> {
        let is_conserved = L::FACTS.energy_is_conserved.is_some() && !L::HAS_CONTACTS;
        if is_conserved { None } else { balance(legs) }
    }
}
