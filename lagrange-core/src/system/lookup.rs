//! Lookup of names, with hints for names that belong elsewhere.

#[cfg(test)]
mod tests;

use core::fmt::{self, Write};

use alloc::{
    format,
    string::{String, ToString},
    vec::Vec,
};

use super::lagrangian::{Lagrangian, check_names, entry};
use super::moving::System;
use crate::error::Error;
use crate::error::owned::similar::{listed, nearest};
use crate::names::write_velocity;
use crate::number::Real;
use crate::solution::named_field::NamedField;
use crate::vector::{Length, StaticLength};

/// Returns the names of the coordinates, followed by those of the velocities.
pub(crate) fn entries<L: Lagrangian>() -> Vec<String> {
    const { check_names::<L>() };
    (0..2 * <L::N>::COUNT).map(|index| entry::<L>(index).to_string()).collect()
}

/// Returns the index of `name` among `known`.
pub(crate) fn index<L: Lagrangian>(
    known: &[impl AsRef<str>],
    kind: &'static str,
    name: &str,
) -> Result<usize, Error> {
    const { check_names::<L>() };
    let found = known.iter().position(|known| known.as_ref() == name);
    found.ok_or_else(|| unknown::<L>(known, kind, name))
}

/// Returns the indices of the entries with these names. The name `r` of a vector stands for all elements
/// `r[0]`, `r[1]`, ….
pub(crate) fn indices<L: Lagrangian>(
    known: &[impl AsRef<str>],
    kind: &'static str,
    names: &[&str],
) -> Result<Vec<usize>, Error> {
    const { check_names::<L>() };
    let mut found = Vec::new();
    for name in names {
        let before = found.len();
        found.extend((0..known.len()).filter(|&i| is_part(known[i].as_ref(), name)));
        if found.len() == before {
            return Err(unknown::<L>(known, kind, name));
        }
        if let Some(again) = found[before..].iter().find(|index| found[..before].contains(index)) {
            return Err(Error::RepeatedName { name: known[*again].as_ref().into() });
        }
    }
    Ok(found)
}

/// True if `entry` is `name`, or an element of the vector `name`.
fn is_part(entry: &str, name: &str) -> bool {
    entry.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('['))
}

pub(crate) fn unknown<L: Lagrangian>(known: &[impl AsRef<str>], kind: &'static str, name: &str) -> Error {
    let vocabulary =
        Vocabulary { coordinates: L::COORDINATES, constraints: L::CONSTRAINTS, observables: L::OBSERVABLES };
    vocabulary.unknown(known, kind, name)
}

/// Returns the index of the coordinate whose name is written as `name`.
pub(crate) fn position<L: System<Scalar: Real>, F: NamedField<L>>(system: &L, name: &str) -> Option<usize> {
    (0..system.length().count()).find(|&coordinate| {
        let mut rest = Rest(name);
        F::write_name(system, coordinate, &mut rest).is_ok() && rest.0.is_empty()
    })
}

/// Returns the names of the coordinates.
pub(crate) fn names<L: System<Scalar: Real>, F: NamedField<L>>(system: &L) -> Vec<String> {
    let written = |coordinate: usize| {
        let mut name = String::new();
        // Writing to memory does not fail; after an error of the system's own the name is what it wrote until then.
        F::write_name(system, coordinate, &mut name).ok();
        name
    };
    (0..system.length().count()).map(written).collect()
}

/// Returns the name of the velocity of a coordinate.
pub(crate) fn velocity(coordinate: &str) -> String {
    let mut name = String::new();
    // Writing to memory does not fail.
    write_velocity(coordinate, &mut name).ok();
    name
}

/// The rest of a text to which nothing but its beginning can be written.
struct Rest<'t>(&'t str);

impl Write for Rest<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 = self.0.strip_prefix(text).ok_or(fmt::Error)?;
        Ok(())
    }
}

/// Names of a system, for hints about a name that belongs elsewhere.
pub(crate) struct Vocabulary<'v, C> {
    pub(crate) coordinates: &'v [C],
    pub(crate) constraints: &'v [&'v str],
    pub(crate) observables: &'v [&'v str],
}

impl<C: AsRef<str>> Vocabulary<'_, C> {
    pub(crate) fn unknown(&self, known: &[impl AsRef<str>], kind: &'static str, name: &str) -> Error {
        let known: Vec<String> = known.iter().map(|known| known.as_ref().into()).collect();
        let hint = if let Some(element) = known.iter().find(|known| is_part(known, name)) {
            Some(format!("it is a vector: name an element, such as `{element}`"))
        } else {
            let near = || Some(format!("did you mean `{}`?", nearest(name, &known)?));
            // A name unlike all others is probably a field that occurs in no expression.
            let idle = || {
                let names = listed(name, &known);
                kind.ends_with("parameter").then(|| {
                    format!(
                        "there are {names}; a field is a parameter if an expression of the system names it"
                    )
                })
            };
            self.meaning(kind, name).or_else(near).or_else(idle)
        };
        Error::UnknownName { name: name.into(), kind, hint, known }
    }

    /// Returns the meaning of a name, and the method of a sample that returns its value, or what else is a parameter.
    fn meaning(&self, kind: &str, name: &str) -> Option<String> {
        let coordinates = self.coordinates.iter().map(AsRef::as_ref).flat_map(|x: &str| {
            let (base, index) = x.split_at(x.find('[').unwrap_or(x.len()));
            let derived = |name, method| (name, format!("the {method} of `{x}`"), method, x);
            [
                (x.into(), "a coordinate".into(), "coordinate", x),
                derived(velocity(x), "velocity"),
                derived(format!("{base}_ddot{index}"), "acceleration"),
                derived(format!("p_{x}"), "momentum"),
                derived(format!("p({x})"), "momentum"),
            ]
        });
        let constraints = self.constraints.iter().copied().flat_map(|c| {
            let multiplier = format!("the multiplier of constraint `{c}`");
            [
                (c.into(), "a constraint".into(), "multiplier", c),
                (format!("lambda({c})"), multiplier, "multiplier", c),
            ]
        });
        let observables =
            self.observables.iter().map(|o| ((*o).into(), "an observable".into(), "observable", *o));
        let mut named = coordinates.chain(constraints).chain(observables);
        let found = named.find(|(known, ..): &(String, String, &str, &str)| is_part(known, name));
        let said = found.map(|(known, what, method, of)| {
            let it = if known == name { "it".into() } else { format!("its element `{known}`") };
            match method {
                "coordinate" | "velocity" | "acceleration" if kind == "parameter" => {
                    format!(
                        "{it} is {what}; a parameter is a field, such as the force `u` of `#[force({of}: u)]`"
                    )
                }
                _ => format!("{it} is {what}, which a sample's `{method}(\"{of}\")` gives"),
            }
        });
        said.or_else(|| match name {
            "t" | "time" => {
                Some("it is the time, which a sample's `time()` gives and a state's `at_time(…)` sets".into())
            }
            "E" | "H" | "energy" => Some("it is the energy, which a sample's `energy()` gives".into()),
            _ => None,
        })
    }
}
