//! Names of coordinates and velocities, for messages, lookup and tables.

use core::fmt;

use super::sample::Sample;
use super::vector_field::LagrangianVectorField;
use crate::error::Error;
use crate::names::{Entry, Row, WrittenName, name};
use crate::number::{Parts, Real};
use crate::system::{Lagrangian, System, check_names};
use crate::vector::{Numbers, PhaseVector, Vector, VectorOf, view_of};
#[cfg(feature = "alloc")]
use crate::{
    number::Scalar,
    system::lookup::{self, Vocabulary, names, position},
    vector::StaticLength,
};
#[cfg(feature = "alloc")]
use alloc::{
    format,
    string::{String, ToString},
    vec::Vec,
};

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

    /// Returns the index of the coordinate of this name. Names that are written are compared one after another.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    #[cfg(feature = "alloc")]
    fn coordinate(system: &L, name: &str) -> Result<usize, Error>
    where
        Self: Sized,
    {
        let unknown = || Self::unknown(system, &names::<_, Self>(system), "coordinate", name);
        position::<_, Self>(system, name).ok_or_else(unknown)
    }

    /// Returns the accelerations at a sample.
    ///
    /// # Errors
    /// Those of [`Simulate::solve`](crate::Simulate::solve).
    fn accelerations(sample: &Sample<L>) -> Result<VectorOf<L::Scalar, L::Length>, Error> {
        let (system, state) = (sample.system(), sample.state());
        let mut rates = PhaseVector::<_, L::Length>::joined(&state.q, &state.v);
        let [q, v] = [&state.q, &state.v].map(view_of::<_, L::Length>);
        system.accelerations(state.t, q, v, rates.view_mut(1));
        match rates[1].iter().position(|a| !Parts::is_finite(*a)) {
            None => Ok(VectorOf::<_, L::Length>::from_entries(&rates[1])),
            Some(i) => Err(Error::EquationsNotFinite { row: Self::row(system, i), time: state.t.to_f64() }),
        }
    }

    /// Returns the error about a name that is not among those `known`, with its meaning if it belongs elsewhere.
    #[cfg(feature = "alloc")]
    #[doc(hidden)]
    fn unknown(system: &L, known: &[impl AsRef<str>], kind: &'static str, name: &str) -> Error
    where
        Self: Sized,
    {
        let coordinates = names::<_, Self>(system);
        Vocabulary { coordinates: &coordinates, constraints: &[], observables: &[] }
            .unknown(known, kind, name)
    }

    /// Returns the names of the columns that a table has after coordinates and velocities.
    #[cfg(feature = "alloc")]
    #[doc(hidden)]
    fn columns() -> Vec<String> {
        Vec::new()
    }

    /// Appends the cells of these columns.
    #[cfg(feature = "alloc")]
    #[doc(hidden)]
    fn append_cells(_: &Sample<&L>, _: &mut Vec<L::Scalar>) {}
}

impl<L: Lagrangian<Scalar: Real>> NamedField<L> for LagrangianVectorField {
    fn write_name(_: &L, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
        to.write_str(name(L::COORDINATES, coordinate))
    }

    fn state_entry(_: &L, half: usize, coordinate: usize) -> Entry {
        const { check_names::<L>() };
        let name = name(L::COORDINATES, coordinate);
        if half == 0 { Entry::Coordinate(name) } else { Entry::Velocity(name) }
    }

    fn row(_: &L, coordinate: usize) -> Row {
        Row::Coordinate(name(L::COORDINATES, coordinate))
    }

    fn accelerations(sample: &Sample<L>) -> Result<Vector<L::Scalar, L::N>, Error> {
        Ok(sample.solution()?.accelerations)
    }

    #[cfg(feature = "alloc")]
    fn coordinate(_: &L, name: &str) -> Result<usize, Error> {
        lookup::index::<L>(L::COORDINATES, "coordinate", name)
    }

    #[cfg(feature = "alloc")]
    fn unknown(_: &L, known: &[impl AsRef<str>], kind: &'static str, name: &str) -> Error {
        lookup::unknown::<L>(known, kind, name)
    }

    /// Multipliers, constraint forces if there are any, and observables.
    #[cfg(feature = "alloc")]
    fn columns() -> Vec<String> {
        let multipliers = L::CONSTRAINTS.iter().map(|name| format!("lambda({name})"));
        let forced = if <L::M>::COUNT > 0 { L::COORDINATES } else { &[] };
        let forces = forced.iter().map(|name| format!("force({name})"));
        multipliers.chain(forces).chain(L::OBSERVABLES.iter().map(ToString::to_string)).collect()
    }

    #[cfg(feature = "alloc")]
    fn append_cells(sample: &Sample<&L>, cells: &mut Vec<L::Scalar>) {
        let (system, state) = (*sample.system(), sample.state());
        let unknown = L::Scalar::constant(f64::NAN);
        let is_solved = <L::M>::COUNT > 0 || !L::OBSERVABLES.is_empty();
        let solution = is_solved.then(|| sample.solution().ok()).flatten();
        if <L::M>::COUNT > 0 {
            let multipliers = solution.map(|solution| solution.multipliers);
            let force = multipliers.map(|lambda| system.constraint_force(state, &lambda));
            cells.extend((0..<L::M>::COUNT).map(|a| multipliers.map_or(unknown, |lambda| lambda[a])));
            cells.extend((0..<L::N>::COUNT).map(|i| force.map_or(unknown, |force| force[i])));
        }
        let observable = |k: usize| system.observable(k, state, solution.as_ref()?);
        cells.extend((0..L::OBSERVABLES.len()).map(|k| observable(k).unwrap_or(unknown)));
    }
}
