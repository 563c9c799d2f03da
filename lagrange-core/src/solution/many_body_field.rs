//! Equations of motion of systems of any number of bodies.

use core::fmt;

use nalgebra::DVector;

use super::acceleration_field::{Stated, StatedField};
use super::energy_field::EnergyField;
use super::many_constraints;
use super::named_field::NamedField;
use crate::error::Error;
use crate::facts::{Conserved, Evidence};
use crate::number::Real;
use crate::system::{ManyBodies, StateOf};

/// The accelerations of [`ManyBodies`].
pub type ManyBodyField = Stated<WithLagrangian>;

/// Kind of the systems whose accelerations follow from a Lagrangian that they state too.
#[derive(Clone, Copy, Debug)]
pub enum WithLagrangian {}

impl<L: ManyBodies<Scalar: Real>> NamedField<L> for ManyBodyField {
    fn write_name(system: &L, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
        system.write_name(coordinate, to)
    }
}

impl<L: ManyBodies<Scalar: Real>> EnergyField<L> for ManyBodyField {
    const CONSERVED: &'static [Conserved] = if L::ENERGY_IS_CONSERVED {
        &[Conserved { name: "energy", evidence: Evidence::Proved }]
    } else {
        &[]
    };

    fn energy(system: &L, state: &StateOf<L>) -> L::Scalar {
        system.energy(state)
    }

    fn momentum(system: &L, state: &StateOf<L>) -> DVector<L::Scalar> {
        system.momenta(state)
    }

    fn conserved(system: &L, index: usize, state: &StateOf<L>) -> Option<L::Scalar> {
        <Self as EnergyField<L>>::CONSERVED.get(index).map(|_| system.energy(state))
    }
}

impl<L: ManyBodies<Scalar: Real>> StatedField<L> for ManyBodyField {
    const DIGEST: u32 = L::DIGEST;

    fn check_fields(system: &L) -> Result<(), Error> {
        system.check()
    }

    fn visit_fields(system: &L, visit: &mut dyn FnMut(f64)) {
        system.visit_numbers(&mut |number| visit(number.to_f64()));
    }

    fn fault(system: &L, state: &StateOf<L>) -> Option<Error> {
        many_constraints::fault(system, state)
    }

    fn check_constraints(system: &L, state: &StateOf<L>) -> Result<(), Error> {
        many_constraints::check(system, state)
    }

    const HAS_CONSTRAINTS: bool = L::HAS_CONSTRAINTS;

    fn project(system: &L, t: L::Scalar, halves: [&mut [L::Scalar]; 2]) -> Result<(), Error> {
        many_constraints::project(system, t, halves)
    }
}
