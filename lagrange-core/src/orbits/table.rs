//! A family of periodic orbits as a table.

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter, Write};

use super::bifurcation::{Bifurcation, BifurcationKind, Branch, Test};
use super::digits::parts;
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

/// A bifurcation that is known to lie between two orbits of a family, and was not found.
#[derive(Clone, Debug, PartialEq)]
pub struct LostBifurcation {
    /// Its kind.
    pub kind: BifurcationKind,
    /// Index of the member of the family before it.
    pub after: usize,
    /// Reason why it was not found.
    pub reason: Error,
}

/// A family of periodic orbits, with its bifurcations.
#[derive(Clone)]
pub struct Family<L: Linearized> {
    name: String,
    parameter: Option<usize>,
    orbits: Vec<PeriodicOrbit<L>>,
    bifurcations: Vec<Bifurcation<L>>,
    lost: Vec<LostBifurcation>,
    ending: FamilyEnding,
}

impl<L: Linearized<Scalar: Real>> Family<L> {
    pub(super) fn begin(name: String, parameter: Option<usize>) -> Self {
        let (orbits, bifurcations, lost) = (Vec::new(), Vec::new(), Vec::new());
        Self { name, parameter, orbits, bifurcations, lost, ending: FamilyEnding::Count }
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

    pub(super) fn push_lost(&mut self, (test, reason): (Test, Error)) {
        self.lost.push(LostBifurcation { kind: test.kind(), after: self.orbits.len() - 1, reason });
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

    /// Bifurcations that lie between two orbits, but whose own orbit, or the family that leaves there, was not found. Shorter
    /// steps find them, as a rule.
    pub fn lost(&self) -> &[LostBifurcation] {
        &self.lost
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
    /// (real and imaginary parts), and the bifurcations between this orbit and the next.
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
            let [re, im] = parts(multiplier, 4.0 * L::Scalar::EPSILON);
            write!(text, ",{re},{im}")?;
        }
        let found = self.after(k).map(|found| alloc::format!("{}", found.kind));
        let lost = self.lost_after(k).map(|lost| alloc::format!("{} not found", lost.kind));
        let then: Vec<String> = found.chain(lost).collect();
        writeln!(text, ",{}", then.join("; "))
    }

    fn lost_after(&self, k: usize) -> impl Iterator<Item = &LostBifurcation> {
        self.lost.iter().filter(move |lost| lost.after == k)
    }

    fn after(&self, k: usize) -> impl Iterator<Item = &Bifurcation<L>> {
        self.bifurcations.iter().filter(move |found| found.after == k)
    }
}

/// Prints a line for the first and last orbit and every tenth between, and one for every bifurcation, below lines that say so.
impl<L: Linearized<Scalar: Real>> Display for Family<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} periodic orbits of {}: every tenth, the last, and all bifurcations; `csv` has all orbits",
            self.orbits.len(),
            L::NAME
        )?;
        writeln!(
            f,
            "|λ|: largest modulus of the multipliers that are not 1 for every orbit; an orbit with more than 1 is unstable"
        )?;
        let name = &self.name;
        writeln!(f, "{:>6} {name:>18} {:>18} {:>9} {:>14}", "", "period", "error", "|λ|")?;
        for (k, orbit) in self.orbits.iter().enumerate() {
            if k % 10 == 0 || k + 1 == self.orbits.len() {
                self.line(f, k, orbit, "")?;
            }
            for found in self.after(k) {
                self.line(f, k, &found.orbit, &alloc::format!("  {}", found.kind))?;
            }
            for lost in self.lost_after(k) {
                writeln!(f, "{k:>6} then {} that is not found: {}", lost.kind, lost.reason)?;
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
        text.field("orbits", &self.orbits)
            .field("bifurcations", &self.bifurcations)
            .field("lost", &self.lost);
        text.field("ending", &self.ending).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prelude::*;

    #[derive(Clone, Lagrangian)]
    #[coordinates(theta)]
    #[lagrangian(theta_dot^2/2 + cos(theta))]
    struct Pendulum;

    /// A sign that changes is told, though no orbit is found there.
    #[test]
    fn what_is_not_found_is_told() {
        let search = Pendulum.periodic_orbit(&State::at_rest([1.0])).period_near(6.7);
        let orbit = search.energy(-(1.0_f64.cos())).find().expect("an orbit");
        let mut family = Family::begin("energy".into(), None);
        family.push(orbit.clone());
        family.push(orbit);
        family.push_lost((Test::Doubling, Error::EigenvaluesNotFound));
        let [lost] = family.lost() else { panic!("{:?}", family.lost()) };
        assert_eq!((lost.kind, lost.after), (BifurcationKind::PeriodDoubling, 1));
        let (text, csv) = (family.to_string(), family.csv());
        assert!(text.contains("     1 then period doubling that is not found: the eigenvalues"), "{text}");
        assert!(csv.lines().nth(2).is_some_and(|line| line.ends_with(",period doubling not found")), "{csv}");
    }
}
