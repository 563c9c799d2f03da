//! A family of periodic orbits as a table.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter, Write};

use super::bifurcation::{Bifurcation, BifurcationKind, Branch, Test};
use super::multipliers::modulus;
use super::orbit::PeriodicOrbit;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::number::Real;
use crate::system::lookup;

/// Why a family ends.
#[derive(Clone, Debug, PartialEq)]
pub enum FamilyEnding {
    /// It has as many orbits as were asked for.
    Count,
    /// The condition of [`until`](super::FamilySearch::until) holds, or the bifurcation of
    /// [`until_first`](super::FamilySearch::until_first) is found.
    Until,
    /// It has come back to its first orbit.
    Closed,
    /// No orbit was found beyond the last, for this reason: the motion fails near it, or the family shrinks to an equilibrium.
    Stopped(Box<Error>),
}

/// A family of periodic orbits, with its bifurcations.
#[derive(Clone)]
pub struct Family<L: Linearized> {
    name: String,
    parameter: Option<usize>,
    orbits: Vec<PeriodicOrbit<L>>,
    bifurcations: Vec<Bifurcation<L>>,
    ending: FamilyEnding,
}

impl<L: Linearized<Scalar: Real>> Family<L> {
    pub(super) fn begin(name: String, parameter: Option<usize>) -> Self {
        let (orbits, bifurcations) = (Vec::new(), Vec::new());
        Self { name, parameter, orbits, bifurcations, ending: FamilyEnding::Count }
    }

    pub(super) fn push(&mut self, orbit: PeriodicOrbit<L>) {
        self.orbits.push(orbit);
    }

    pub(super) fn push_bifurcation(
        &mut self,
        (test, orbit, branch): (Test, PeriodicOrbit<L>, Option<Branch<L>>),
    ) {
        let (kind, value, after) = (test.kind(), self.value(&orbit), self.orbits.len() - 1);
        self.bifurcations.push(Bifurcation { kind, orbit, value, after, branch });
    }

    pub(super) fn end(&mut self, ending: FamilyEnding) {
        self.ending = ending;
    }

    /// The orbits, along the family.
    pub fn orbits(&self) -> &[PeriodicOrbit<L>] {
        &self.orbits
    }

    /// The bifurcations, along the family.
    pub fn bifurcations(&self) -> &[Bifurcation<L>] {
        &self.bifurcations
    }

    /// The first bifurcation of a kind.
    pub fn first(&self, kind: BifurcationKind) -> Option<&Bifurcation<L>> {
        self.bifurcations.iter().find(|found| found.kind == kind)
    }

    /// Reason why the family ends.
    pub fn ending(&self) -> &FamilyEnding {
        &self.ending
    }

    /// Value of the parameter of the family at an orbit, or the energy if there is none.
    pub fn value(&self, orbit: &PeriodicOrbit<L>) -> L::Scalar {
        self.parameter.map_or_else(|| orbit.energy(), |k| orbit.system.parameters()[k])
    }

    /// The family as comma-separated values, an orbit a line: parameter or energy, period, gap, error, the start, the multipliers
    /// (real and imaginary parts), and the bifurcations found between this orbit and the next.
    pub fn csv(&self) -> String {
        let mut text = String::new();
        let names: Vec<String> = lookup::entries::<L>();
        let count = self.orbits.first().map_or(0, |orbit| orbit.monodromy.basis().ncols());
        let mut header = alloc::vec![self.name.clone(), "period".into(), "gap".into(), "error".into()];
        header.extend(names);
        header.extend((1..=count).flat_map(|k| [alloc::format!("re{k}"), alloc::format!("im{k}")]));
        header.push("then".into());
        text.push_str(&header.join(","));
        text.push('\n');
        for (k, orbit) in self.orbits.iter().enumerate() {
            self.write_line(&mut text, k, orbit).unwrap_or_default();
        }
        text
    }

    fn write_line(&self, text: &mut String, k: usize, orbit: &PeriodicOrbit<L>) -> fmt::Result {
        write!(text, "{},{},{},{}", self.value(orbit), orbit.period, orbit.gap, orbit.error)?;
        for x in orbit.start.q.iter().chain(&orbit.start.v) {
            write!(text, ",{x}")?;
        }
        for multiplier in orbit.multipliers().unwrap_or_default() {
            write!(text, ",{},{}", multiplier.re, multiplier.im)?;
        }
        let then: Vec<String> = self.after(k).map(|found| alloc::format!("{}", found.kind)).collect();
        writeln!(text, ",{}", then.join("; "))
    }

    fn after(&self, k: usize) -> impl Iterator<Item = &Bifurcation<L>> {
        self.bifurcations.iter().filter(move |found| found.after == k)
    }
}

/// Prints a line for the first and last orbit and every tenth between, and one for every bifurcation.
impl<L: Linearized<Scalar: Real>> Display for Family<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} periodic orbits of {}", self.orbits.len(), L::NAME)?;
        let name = &self.name;
        writeln!(f, "{:>6} {name:>18} {:>18} {:>9} {:>14}", "", "period", "error", "|λ|")?;
        for (k, orbit) in self.orbits.iter().enumerate() {
            if k % 10 == 0 || k + 1 == self.orbits.len() {
                self.line(f, k, orbit, "")?;
            }
            for found in self.after(k) {
                self.line(f, k, &found.orbit, &alloc::format!("  {}", found.kind))?;
            }
        }
        match &self.ending {
            FamilyEnding::Count | FamilyEnding::Until => Ok(()),
            FamilyEnding::Closed => writeln!(f, "the family closes"),
            FamilyEnding::Stopped(error) => writeln!(f, "the family ends: {error}"),
        }
    }
}

impl<L: Linearized<Scalar: Real>> Family<L> {
    fn line(&self, f: &mut Formatter<'_>, k: usize, orbit: &PeriodicOrbit<L>, note: &str) -> fmt::Result {
        let largest = orbit.multipliers().ok().and_then(|all| all.first().map(|x| modulus(*x).to_f64()));
        let (value, period) = (self.value(orbit).to_f64(), orbit.period.to_f64());
        let (error, largest) = (orbit.error.to_f64(), largest.unwrap_or(f64::NAN));
        writeln!(f, "{k:>6} {value:>18.12} {period:>18.12} {error:>9.1e} {largest:>14.8}{note}")
    }
}

/// Leaves out the systems, which need not implement `Debug`.
impl<L: Linearized<Scalar: Real>> Debug for Family<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("Family");
        text.field("orbits", &self.orbits).field("bifurcations", &self.bifurcations);
        text.field("ending", &self.ending).finish_non_exhaustive()
    }
}
