//! Trajectories as comma-separated values.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

use super::records::{Records, write_row};
use super::stored::Trajectory;
use crate::facts::Conserved;
use crate::number::{Real, Scalar};
use crate::solution::Sample;
use crate::solution::energy_field::EnergyField;
use crate::solution::named_field::NamedField;
use crate::solution::vector_field::VectorField;
use crate::system::{StateOf, System, lookup};
use crate::vector::Numbers;

/// Table of a trajectory, one line per sample: `t`, coordinates `x`, velocities `x_dot`, multipliers
/// `lambda(no_slip)`, constraint forces `force(x)` and observables; on request the energy and the conserved
/// quantities.
///
/// Numbers are printed in the shortest form that reads back the same. If the equations have no solution, values
/// that depend on it are `NaN`. The equations are solved once per line, and not at all if no column needs them.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(r, phi)]
/// #[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2) + k/r)]
/// #[observable(height = r*sin(phi))]
/// struct Planet { m: f64, k: f64 }
///
/// let planet = Planet { m: 1.0, k: 1.0 };
/// let path = planet.integrate(State::new([1.0, 0.0], [0.0, 1.2]), 10.0, Dop853::default())?;
/// let table = path.csv(200).conserved().to_string();
/// assert_eq!(table.lines().next(), Some("t,r,phi,r_dot,phi_dot,height,p_phi,energy"));
/// # Ok::<(), Error>(())
/// ```
#[must_use = "a table is to be printed, or written to a file"]
pub struct Csv<'t, S: System, F = <S as System>::Field> {
    motion: &'t Trajectory<S, F>,
    count: usize,
    quantities: Vec<Quantity<S>>,
}

/// Evaluates component k of a quantity at a state.
type Value<S> = fn(usize, &S, &StateOf<S>) -> <S as System>::Scalar;

/// A quantity of states, with the column of a table.
struct Quantity<S: System> {
    name: &'static str,
    value: Value<S>,
    index: usize,
}

impl<S: System, F> Trajectory<S, F> {
    /// Returns a table of `count` states at evenly spaced times, as comma-separated values.
    ///
    /// Print it, or write `path.csv(200).to_string()` to a file.
    pub fn csv(&self, count: usize) -> Csv<'_, S, F> {
        Csv { motion: self, count, quantities: Vec::new() }
    }
}

impl<S: System<Scalar: Real>, F: VectorField<S>> Csv<'_, S, F> {
    /// Adds a column `energy`, E = p·q̇ − L.
    pub fn energy(mut self) -> Self
    where
        F::Checks: EnergyField<S>,
    {
        let value: Value<S> = |_, system, state| F::Checks::energy(system, state);
        self.quantities.retain(|quantity| quantity.name != "energy");
        self.quantities.insert(0, Quantity { name: "energy", value, index: 0 });
        self
    }

    /// Adds a column for each [conserved](crate::facts::Facts::conserved) quantity that no other column contains, under its name.
    pub fn conserved(mut self) -> Self
    where
        F::Checks: EnergyField<S>,
    {
        let value: Value<S> = |index, system, state| {
            F::Checks::conserved(system, index, state).unwrap_or(S::Scalar::constant(f64::NAN))
        };
        let columns = F::Checks::columns();
        for (index, Conserved { name, .. }) in F::Checks::CONSERVED.iter().enumerate() {
            let is_known = columns.iter().any(|known| known == name);
            if !is_known && self.quantities.iter().all(|known| known.name != *name) {
                self.quantities.push(Quantity { name, value, index });
            }
        }
        self
    }

    /// Returns the names and the numbers of the table, for storage, plots, or other formats (feature `serde`).
    pub fn records(&self) -> Records<S::Scalar> {
        let row = |sample| {
            let mut cells = Vec::new();
            self.cells(&sample, &mut cells);
            cells
        };
        Records { names: self.names(), rows: self.motion.borrowed_samples(self.count).map(row).collect() }
    }

    fn names(&self) -> Vec<String> {
        let mut names = names_of_entries::<_, F::Checks>(self.motion.system());
        names.extend(F::Checks::columns());
        names.extend(self.quantities.iter().map(|quantity| quantity.name.into()));
        names
    }

    /// Appends the cells of a line, in the order of the names.
    fn cells(&self, sample: &Sample<&S>, cells: &mut Vec<S::Scalar>) {
        let (system, state) = (*sample.system(), sample.state());
        cells.push(state.t);
        cells.extend(state.q.entries().iter().chain(state.v.entries()));
        F::Checks::append_cells(sample, cells);
        let value = |Quantity { value, index, .. }: &Quantity<S>| value(*index, system, state);
        cells.extend(self.quantities.iter().map(value));
    }
}

/// Names of the entries of a state: `t`, coordinates `x`, velocities `x_dot`.
pub(super) fn names_of_entries<S: System<Scalar: Real>, F: NamedField<S>>(system: &S) -> Vec<String> {
    let mut names = lookup::names::<_, F>(system);
    let velocities: Vec<String> = names.iter().map(|name| lookup::velocity(name)).collect();
    names.insert(0, "t".into());
    names.extend(velocities);
    names
}

impl<S: System<Scalar: Real>, F: VectorField<S>> Display for Csv<'_, S, F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.names().join(","))?;
        let mut cells = Vec::new();
        for sample in self.motion.borrowed_samples(self.count) {
            cells.clear();
            self.cells(&sample, &mut cells);
            write_row(&cells, f)?;
        }
        Ok(())
    }
}

impl<S: System<Scalar: Real>, F: VectorField<S>> Debug for Csv<'_, S, F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.quantities.iter().map(|quantity| quantity.name).collect();
        let mut fields = f.debug_struct("Csv");
        fields.field("motion", self.motion).field("count", &self.count).field("quantities", &names).finish()
    }
}
