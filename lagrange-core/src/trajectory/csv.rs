//! Trajectories as comma-separated values.

use alloc::string::{String, ToString};
use alloc::{format, vec::Vec};
use core::fmt::{self, Debug, Display, Formatter};

use super::records::{Records, write_row};
use super::stored::Trajectory;
use crate::names::Entry;
use crate::number::{Real, Scalar};
use crate::solution::Sample;
use crate::solution::vector_field::{LagrangianVectorField, VectorField};
use crate::system::Lagrangian;
use crate::vector::StaticLength;

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
pub struct Csv<'t, S: Lagrangian, F = LagrangianVectorField> {
    motion: &'t Trajectory<S, F>,
    count: usize,
    has_energy: bool,
    has_conserved: bool,
}

impl<S: Lagrangian, F> Trajectory<S, F> {
    /// Returns a table of `count` states at evenly spaced times, as comma-separated values.
    ///
    /// Print it, or write `path.csv(200).to_string()` to a file.
    pub fn csv(&self, count: usize) -> Csv<'_, S, F> {
        Csv { motion: self, count, has_energy: false, has_conserved: false }
    }
}

impl<S: Lagrangian, F> Csv<'_, S, F> {
    /// Adds a column `energy`, E = p·q̇ − L.
    pub fn energy(self) -> Self {
        Self { has_energy: true, ..self }
    }

    /// Adds a column for each [conserved](crate::facts::Facts::conserved) quantity, under its name.
    pub fn conserved(self) -> Self {
        Self { has_conserved: true, ..self }
    }
}

impl<S: Lagrangian<Scalar: Real>, F: VectorField<S>> Csv<'_, S, F> {
    /// Returns the names and the numbers of the table, for storage, plots, or other formats (feature `serde`).
    pub fn records(&self) -> Records<S::Scalar> {
        let row = |sample| {
            let mut cells = Vec::new();
            self.cells(&sample, &mut cells);
            cells
        };
        Records { names: self.names(), rows: self.motion.borrowed_samples(self.count).map(row).collect() }
    }

    /// Conserved quantities that no other column contains.
    fn conserved_columns(&self) -> impl Iterator<Item = (usize, &'static str)> {
        let (has_energy, wanted) = (self.has_energy, self.has_conserved);
        let named = S::FACTS.conserved.iter().map(|conserved| conserved.name).enumerate();
        named.filter(move |(_, name)| {
            wanted && !(has_energy && *name == "energy") && !S::OBSERVABLES.contains(name)
        })
    }

    fn names(&self) -> Vec<String> {
        let mut names = Vec::from(["t".to_string()]);
        names.extend(S::COORDINATES.iter().copied().map(String::from));
        names.extend(S::COORDINATES.iter().copied().map(|name| Entry::Velocity(name).to_string()));
        names.extend(S::CONSTRAINTS.iter().copied().map(|name| format!("lambda({name})")));
        if <S::M>::COUNT > 0 {
            names.extend(S::COORDINATES.iter().copied().map(|name| format!("force({name})")));
        }
        names.extend(S::OBSERVABLES.iter().map(ToString::to_string));
        names.extend(self.has_energy.then(|| "energy".to_string()));
        names.extend(self.conserved_columns().map(|(_, name)| name.to_string()));
        names
    }

    /// Appends the cells of a line, in the order of the names.
    fn cells(&self, sample: &Sample<&S>, cells: &mut Vec<S::Scalar>) {
        let (system, state) = (*sample.system(), sample.state());
        let unknown = S::Scalar::constant(f64::NAN);
        let is_solved = <S::M>::COUNT > 0 || !S::OBSERVABLES.is_empty();
        let solution = is_solved.then(|| sample.solution().ok()).flatten();
        cells.push(state.t);
        cells.extend(state.q.iter().chain(&state.v));
        if <S::M>::COUNT > 0 {
            let multipliers = solution.map(|solution| solution.multipliers);
            let force = multipliers.map(|lambda| system.constraint_force(state, &lambda));
            cells.extend((0..<S::M>::COUNT).map(|a| multipliers.map_or(unknown, |lambda| lambda[a])));
            cells.extend((0..<S::N>::COUNT).map(|i| force.map_or(unknown, |force| force[i])));
        }
        let observable = |k: usize| system.observable(k, state, solution.as_ref()?);
        cells.extend((0..S::OBSERVABLES.len()).map(|k| observable(k).unwrap_or(unknown)));
        cells.extend(self.has_energy.then(|| system.energy(state)));
        cells.extend(self.conserved_columns().map(|(k, _)| system.conserved(k, state).unwrap_or(unknown)));
    }
}

impl<S: Lagrangian<Scalar: Real>, F: VectorField<S>> Display for Csv<'_, S, F> {
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

impl<S: Lagrangian<Scalar: Real>, F: VectorField<S>> Debug for Csv<'_, S, F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { motion, count, has_energy, has_conserved } = self;
        let mut fields = f.debug_struct("Csv");
        fields.field("motion", motion).field("count", count);
        fields.field("energy", has_energy).field("conserved", has_conserved).finish()
    }
}
