//! Drift of conserved quantities along a trajectory.

use alloc::vec::Vec;
use core::fmt::{self, Display, Formatter};

use super::stored::Trajectory;
use crate::number::{Real, Scalar, exceeds};
use crate::solution::vector_field::VectorField;
use crate::system::{Lagrangian, StateOf};

/// Largest deviation of a conserved quantity from its initial value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Deviation<T> {
    /// Name of the quantity in [`Facts::conserved`](crate::facts::Facts::conserved).
    pub name: &'static str,
    /// Value at the start of the trajectory.
    pub start: T,
    /// Largest deviation from the initial value over all steps.
    pub largest: T,
}

/// Deviations of every conserved quantity of a system along a trajectory.
///
#[cfg_attr(
    feature = "std",
    doc = r#"
```
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2) + k/r)]
struct Planet { m: f64, k: f64 }

let planet = Planet { m: 1.0, k: 1.0 };
let path = planet.integrate(State::new([1.0, 0.0], [0.0, 1.2]), 10.0, Dop853::with_tolerance(1e-12))?;
let drift = path.drift();
println!("{drift}");
let names: Vec<&str> = drift.iter().map(|quantity| quantity.name).collect();
assert_eq!(names, ["p_phi", "energy"]);
assert!(drift.iter().all(|quantity| quantity.largest < 1e-10));
# Ok::<(), Error>(())
```
"#
)]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(transparent))]
pub struct Drift<T> {
    quantities: Vec<Deviation<T>>,
}

impl<S: Lagrangian<Scalar: Real>, F: VectorField<S>> Trajectory<S, F> {
    /// Returns the largest deviation of each conserved quantity from its initial value.
    pub fn drift(&self) -> Drift<S::Scalar> {
        Drift::of(self.states_of_steps().map(|state| (&self.system, state)))
    }
}

impl<T: Real> Drift<T> {
    /// The largest deviations from the first of these states, each with the system of its time.
    pub(crate) fn of<'s, S: Lagrangian<Scalar = T> + 's>(
        mut steps: impl Iterator<Item = (&'s S, StateOf<S>)>,
    ) -> Self {
        // One pass for all quantities: in (q, p) every state requires a search for the velocity.
        let start = steps.next().into_iter().flat_map(|(system, start)| {
            let conserved = S::FACTS.conserved.iter().enumerate();
            conserved.filter_map(move |(index, conserved)| {
                let (name, start) = (conserved.name, system.conserved(index, &start)?);
                Some((index, Deviation { name, start, largest: T::constant(0.0) }))
            })
        });
        let mut quantities: Vec<_> = start.collect();
        for (system, step) in steps {
            for (index, Deviation { start, largest, .. }) in &mut quantities {
                if let Some(value) = system.conserved(*index, &step) {
                    *largest = farther(*largest, value - *start);
                }
            }
        }
        Self { quantities: quantities.into_iter().map(|(_, deviation)| deviation).collect() }
    }

    /// Iterates over the quantities in the order of [`Facts::conserved`](crate::facts::Facts::conserved).
    pub fn iter(&self) -> core::slice::Iter<'_, Deviation<T>> {
        self.quantities.iter()
    }

    /// Returns the quantity of this name, or `None` if there is none.
    pub fn get(&self, name: &str) -> Option<&Deviation<T>> {
        self.iter().find(|quantity| quantity.name == name)
    }
}

/// Returns the larger distance; once a distance is NaN, the result stays NaN.
fn farther<T: Real>(largest: T, difference: T) -> T {
    let distance = Scalar::abs(difference);
    let is_number = largest.partial_cmp(&largest).is_some();
    if is_number && exceeds(distance, largest) { distance } else { largest }
}

impl<'d, T> IntoIterator for &'d Drift<T> {
    type Item = &'d Deviation<T>;
    type IntoIter = core::slice::Iter<'d, Deviation<T>>;

    fn into_iter(self) -> Self::IntoIter {
        self.quantities.iter()
    }
}

impl<T: Real> Display for Drift<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.iter().next().is_none() {
            return writeln!(f, "nothing is known to be conserved: `#[conserved(name = …)]` says what is");
        }
        let width = self.iter().map(|quantity| quantity.name.chars().count()).max().unwrap_or(0).max(9);
        writeln!(f, "{:width$}  {:>13}  {:>17}", "conserved", "at the start", "largest deviation")?;
        for Deviation { name, start, largest } in self {
            writeln!(f, "{name:width$}  {:>13.6e}  {:>17.1e}", start.to_f64(), largest.to_f64())?;
        }
        Ok(())
    }
}
