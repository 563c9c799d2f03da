//! Names of coordinates and velocities, for messages and tables.

use core::fmt;

use super::vector_field::LagrangianVectorField;
use crate::names::{Entry, Row, WrittenName, name};
use crate::number::Real;
use crate::system::{Lagrangian, System};

/// Equations of motion that name the coordinates of a system.
pub trait NamedField<L: System<Scalar: Real>> {
    /// Writes the name of a coordinate.
    ///
    /// # Errors
    /// Those of `to`.
    fn write_name(system: &L, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result;

    /// Returns the entry of a state in this half, 0 for coordinates or 1 for velocities, that belongs to a coordinate.
    fn state_entry(system: &L, half: usize, coordinate: usize) -> Entry {
        let name = WrittenName::of(|to| Self::write_name(system, coordinate, to));
        if half == 0 { Entry::WrittenCoordinate(name) } else { Entry::WrittenVelocity(name) }
    }

    /// Returns the equation of a coordinate.
    fn row(system: &L, coordinate: usize) -> Row {
        Row::Written(WrittenName::of(|to| Self::write_name(system, coordinate, to)))
    }
}

impl<L: Lagrangian<Scalar: Real>> NamedField<L> for LagrangianVectorField {
    fn write_name(_: &L, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
        to.write_str(name(L::COORDINATES, coordinate))
    }

    fn state_entry(_: &L, half: usize, coordinate: usize) -> Entry {
        let name = name(L::COORDINATES, coordinate);
        if half == 0 { Entry::Coordinate(name) } else { Entry::Velocity(name) }
    }

    fn row(_: &L, coordinate: usize) -> Row {
        Row::Coordinate(name(L::COORDINATES, coordinate))
    }
}
