//! Prints a linear system as tables of numbers with named rows and columns.

use alloc::{format, string::String, vec::Vec};
use core::fmt::{self, Display, Formatter};

use nalgebra::DMatrix;

use super::Linearization;
use crate::number::Real;

/// Prints the matrices A and B with the names of their rows and columns; with constraints, also the basis Z.
///
/// Numbers are rounded to four decimals, or to four digits if they are large or small.
impl<T: Real> Display for Linearization<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let is_free = self.basis.is_identity(T::constant(0.0));
        let freedom = match is_free {
            true => self.states().to_vec(),
            false => (1..=self.a.nrows()).map(|k| format!("z{k}")).collect(),
        };
        writeln!(f, "ż = A z{}", if self.inputs().is_empty() { "" } else { " + B u" })?;
        table(f, "A", &freedom, &freedom, &self.a)?;
        if !self.inputs().is_empty() {
            table(f, "B", &freedom, self.inputs(), &self.b)?;
        }
        if !is_free {
            writeln!(f, "\nδ(q, q̇) = Z z")?;
            table(f, "Z", self.states(), &freedom, &self.basis)?;
        }
        Ok(())
    }
}

fn table<T: Real>(
    f: &mut Formatter<'_>,
    title: &str,
    rows: &[String],
    columns: &[String],
    entries: &DMatrix<T>,
) -> fmt::Result {
    let longest = |names: &[String]| names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let numbers: Vec<String> = entries.iter().map(|entry| number(entry.to_f64())).collect();
    let (first, width) = (longest(rows), longest(columns).max(longest(&numbers)));
    write!(f, "\n{title:first$}")?;
    columns.iter().try_for_each(|name| write!(f, "  {name:>width$}"))?;
    writeln!(f)?;
    for (i, name) in rows.iter().enumerate() {
        write!(f, "{name:first$}")?;
        // nalgebra iterates over entries column by column.
        numbers.iter().skip(i).step_by(rows.len()).try_for_each(|number| write!(f, "  {number:>width$}"))?;
        writeln!(f)?;
    }
    Ok(())
}

fn number(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        1e-2..1e5 => format!("{x:.4}"),
        _ => format!("{x:.3e}"),
    }
}
