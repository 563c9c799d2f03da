//! Rewrites equations as a person would print them. Nothing is computed with this form.
//!
//! An expression is expanded into a polynomial in [atoms], whose like terms are collected and cancel exactly. Sines
//! and cosines are [merged](angles), quaternions of bodies are put on the unit [sphere], a [row] is divided by the common
//! factor of its terms, and common factors are [taken out](group) where that is shorter. This is done with definitions
//! by name and with definitions written out. The [shortest](mod@super::length) form is taken; the form used in the
//! computation is also a candidate.

mod angles;
mod arms;
mod atoms;
mod collect;
mod dependence;
mod dots;
mod energies;
mod expand;
mod group;
mod relation;
mod row;
mod sphere;
mod squares;
mod tensors;
mod turned;
mod vectors;

use std::cell::RefCell;

use num_traits::One;
use rustc_hash::FxHashMap;

use super::formula::Formula;
use super::length::{READABLE, divisor_length, length};
use super::lines::Equation;
use super::page::Page;
use super::roots::NamedRoot;
use crate::symbolic::{Id, Monomial, Node, Polynomial, Rational};
use atoms::LIMIT;
use collect::Collector;
use expand::Expansion;
pub(super) use expand::{Names, Reading, constants, readings};
use vectors::VectorTerm;

/// Longest polynomial, in terms, whose sines and cosines are merged.
const TERMS: usize = 100;

/// Largest polynomial that is written, in names and numbers, those in arguments of functions included.
const SIZE: u64 = 2000;

impl Page<'_> {
    /// Begins new readings in place of those whose work is done.
    pub(super) fn begin_readings(&mut self) {
        let Self { graph, problem, derived, .. } = *self;
        self.readings = readings(
            (graph, problem, derived),
            &self.constants,
            (&self.roots, &self.axes, &self.letters),
            self.names,
        );
        // Functions stand in products in the order in which they are read: that of the coordinates.
        for id in graph.ids().filter(|&id| matches!(graph.node(id), Node::Function(..))) {
            self.readings.iter().for_each(|Reading(expansion)| drop(expansion.borrow_mut().of(id)));
        }
    }

    /// Keeps the names of these nodes in all readings.
    pub(super) fn keep_names(&self, nodes: impl Iterator<Item = Id> + Clone) {
        self.readings
            .iter()
            .for_each(|Reading(expansion)| expansion.borrow_mut().names.extend(nodes.clone()));
    }

    /// Equation Σ inertia = Σ forces of the velocity `own`.
    pub(super) fn row(&self, own: usize, inertia: Id, forces: &[Id]) -> Equation {
        let sides = |reading: &Reading| {
            let all = self.polynomial(reading, &[(inertia, 1)], forces)?;
            self.collected(reading, |collector| collector.row(own, &all))
        };
        let computed = self.computed([&[inertia], forces]);
        let size = |[left, right]: &[Formula; 2]| self.length(left) + self.length(right);
        let is_short = |[left, right]: &[Formula; 2]| length(left) + length(right) <= READABLE as usize;
        let read = self.readings.iter().filter_map(sides).filter(is_short);
        let read = preferred(read.collect(), size, |sides| !sides.iter().any(|side| self.hides(side)));
        let hides = |sides: &[Formula; 2]| sides.iter().any(|side| self.hides(side));
        let is_apart = |[_, right]: &[Formula; 2]| !right.mixes_degrees();
        let is_good = |sides: &_| is_apart(sides) && (!hides(sides) || read.iter().all(hides));
        let computed =
            computed.and_then(|sides| if read.is_empty() || is_good(&sides) { Ok(sides) } else { Err(0) });
        self.chosen(read.into_iter(), computed, size, false).into()
    }

    /// Chooses the shortest reading, or the computed form if that is shorter. With `is_first`, the computed form also
    /// wins ties.
    fn chosen<T>(
        &self,
        read: impl Iterator<Item = T>,
        computed: Result<T, u64>,
        length: impl Fn(&T) -> usize,
        is_first: bool,
    ) -> Result<T, u64> {
        let Some(read) = shortest(read, &length) else { return computed };
        let most = length(&read) + usize::from(is_first);
        // The computed form contains names of definitions.
        let computed = computed.ok().filter(|_| self.names != Names::WrittenOut);
        Ok(computed.filter(|computed| length(computed) < most).unwrap_or(read))
    }

    /// Vector equation of several rows, if these are its components; `own` is the velocity of the first.
    pub(super) fn vector_row(&self, own: usize, rows: &[(Id, Vec<Id>)]) -> Option<[Formula; 2]> {
        let sides = |reading: &Reading| {
            let parts =
                rows.iter().map(|(inertia, forces)| self.polynomial(reading, &[(*inertia, 1)], forces));
            let all = self.vector(reading, &parts.collect::<Option<Vec<_>>>()?, -Rational::one())?;
            self.collected(reading, |collector| collector.row(own, &all))
        };
        let size = |[left, right]: &[Formula; 2]| self.length(left) + self.length(right);
        let read = self.readings.iter().filter_map(sides).collect();
        let open = preferred(read, size, |sides| !sides.iter().any(|side| self.hides(side)));
        shortest(open.into_iter(), size)
    }

    /// Returns whether a formula contains a definition that depends on the velocities. In an equation of motion it may hide
    /// a force, such as Coriolis's.
    fn hides(&self, formula: &Formula) -> bool {
        self.moving.iter().any(|name| formula.contains(name))
    }

    /// Vector formula of several nodes, if these are its components.
    pub(super) fn vector_expression(&self, components: &[Id]) -> Option<Formula> {
        let formula = |reading: &Reading| {
            let parts = components.iter().map(|&id| self.polynomial(reading, &[(id, 1)], &[]));
            let all = self.vector(reading, &parts.collect::<Option<Vec<_>>>()?, Rational::one())?;
            self.collected(reading, |collector| Some(collector.sum(&all)))
        };
        shortest(self.readings.iter().filter_map(formula), |formula| self.length(formula))
    }

    /// Combines rows into one polynomial whose terms each contain a vector. Cross products have coefficients of this sign,
    /// but for those with accelerations, which are positive.
    fn vector(&self, reading: &Reading, rows: &[Polynomial], sign: Rational) -> Option<Polynomial> {
        let terms = self.collected(reading, |collector| collector.vector_terms(rows, sign))?;
        Self::assembled(reading, terms)
    }

    fn assembled(Reading(expansion): &Reading, terms: Vec<VectorTerm>) -> Option<Polynomial> {
        let mut expansion = expansion.borrow_mut();
        let mut all = Polynomial::default();
        for VectorTerm { coefficient, mut scalar, factors } in terms {
            for factor in factors {
                let atom = expansion.atoms.atom(factor);
                scalar = scalar.times(&Monomial::of(atom, Rational::one()))?;
            }
            all.push(scalar, coefficient)?;
        }
        Some(all)
    }

    /// Shortest formula of a node.
    pub(super) fn expression(&self, id: Id) -> Result<Formula, u64> {
        let computed = self.computed([&[id]]).map(|[formula]| formula);
        self.chosen(
            self.read(id, |collector, all| collector.sum(all)),
            computed,
            |formula| self.length(formula),
            false,
        )
    }

    /// Shortest formula of a node. In a tie, the form used in the computation wins. If no form is short enough to
    /// print, the error is the number of symbols of the form used in the computation.
    pub(super) fn quantity(&self, id: Id) -> Result<Formula, u64> {
        self.unmixed(id, |collector, all| collector.sum(all))
    }

    /// The same, with common factors before sums.
    pub(super) fn factored(&self, id: Id) -> Result<Formula, u64> {
        self.unmixed(id, |collector, all| collector.factored(all))
    }

    /// Shortest formula of a node. A formula that has velocities both by themselves and inside definitions is taken only if there
    /// is no other.
    fn unmixed(&self, id: Id, write: fn(&Collector, &Polynomial) -> Formula) -> Result<Formula, u64> {
        let computed = self.computed([&[id]]).map(|[formula]| formula);
        let is_mixed = |formula: &Formula| self.hides(formula) && formula.has_velocity();
        let read = preferred(
            self.read(id, write).collect(),
            |formula| self.length(formula),
            |formula| !is_mixed(formula),
        );
        let is_worse = |formula: &Formula| is_mixed(formula) && !read.iter().all(is_mixed);
        let computed = computed.and_then(|formula| if is_worse(&formula) { Err(0) } else { Ok(formula) });
        self.chosen(read.into_iter(), computed, |formula| self.length(formula), true)
    }

    /// Entries of the mass matrix whose shortest reading is, as a divisor, no longer than the computed form. Common factors
    /// stand before a sum.
    pub(super) fn short_entries(&self) -> FxHashMap<Id, Formula> {
        let entries = self.derived.hamilton.iter().flat_map(|hamilton| &hamilton.entries);
        let short = |&id: &Id| {
            let [computed] = self.computed([&[id]]).ok()?;
            let read = shortest(self.read(id, |collector, all| collector.factored(all)), divisor_length)?;
            (divisor_length(&read) <= divisor_length(&computed)).then_some((id, read))
        };
        entries.filter(|id| !self.problem.names.contains_key(id)).filter_map(short).collect()
    }

    /// Formula of an energy that is the sum of two: T and U stay apart. `None` if an energy is too long to print.
    pub(super) fn energy(&self, [kinetic, potential]: [Id; 2]) -> Option<Formula> {
        let parts = [kinetic, potential].into_iter().filter(|&part| part != Id::ZERO);
        let written = |part| self.part_of_energy(part).ok().map(Formula::by_terms);
        let parts: Option<Vec<Formula>> = parts.map(written).collect();
        parts.map(Formula::sum)
    }

    /// Shortest formula of T or U. In a tie, the form used in the computation wins.
    pub(super) fn part_of_energy(&self, id: Id) -> Result<Formula, u64> {
        self.unmixed(id, |collector, all| collector.energy(all))
    }

    /// Shortest formula of a node by the degrees of its terms, if a reading is short enough to print.
    pub(super) fn by_degree(&self, id: Id) -> Option<Formula> {
        shortest(self.read(id, |collector, all| collector.energy_by_degree(all)), |formula| {
            self.length(formula)
        })
    }

    /// Readings of a node by components, and by products of vectors if it has any.
    fn read<'s>(
        &'s self,
        id: Id,
        write: fn(&Collector, &Polynomial) -> Formula,
    ) -> impl Iterator<Item = Formula> + 's {
        let formulas = move |reading: &Reading| {
            let all = self.polynomial(reading, &[(id, 1)], &[])?;
            let terms =
                self.collected(reading, |collector| Some(collector.squared(collector.dotted_terms(&all)?)));
            let dotted = terms.and_then(|terms| Self::assembled(reading, terms));
            let squares = self.unmerged_squares(reading, id);
            let sum = |all: Polynomial| self.collected(reading, |collector| Some(write(collector, &all)));
            Some([Some(all), dotted, squares].into_iter().flatten().filter_map(sum).collect::<Vec<_>>())
        };
        let formulas = self.readings.iter().filter_map(formulas).flatten();
        formulas.filter(|formula| length(formula) <= READABLE as usize)
    }

    /// Polynomial in which 1 − sin² φ is not replaced by cos² φ, if it has squares of sums: (p + a sin φ)² + b.
    fn unmerged_squares(&self, reading: &Reading, id: Id) -> Option<Polynomial> {
        let all = reading.0.borrow_mut().of(id).filter(|all| all.len() <= TERMS)?;
        let has_square = self.collected(reading, |collector| collector.squares(&all).next().map(|_| ()));
        has_square.map(|()| all)
    }

    /// Formula of a momentum: with velocities collected, or the computed form if that is shorter.
    pub(super) fn momentum(&self, id: Id) -> Result<Formula, u64> {
        let collected = |reading: &Reading| {
            let all = self.polynomial(reading, &[(id, 1)], &[])?;
            self.collected(reading, |collector| collector.momentum(&all))
        };
        let collected = self.readings.iter().filter_map(collected);
        let read = collected
            .filter(|formula| length(formula) <= READABLE as usize)
            .chain(self.read(id, |collector, all| collector.sum(all)));
        let computed = self.computed([&[id]]).map(|[formula]| formula);
        // Of equally long forms, a product reads better than a sum: I₃ (φ̇ cos θ + ψ̇).
        let size =
            |formula: &Formula| 2 * self.length(formula) + usize::from(matches!(formula, Formula::Sum(_)));
        self.chosen(read, computed, size, false)
    }

    /// Norm, such as |a − b|, that is the square root of a sum.
    pub(super) fn norm(&self, sum: Id) -> Option<Formula> {
        let norm = |reading: &Reading| {
            let sum = self.polynomial(reading, &[(sum, 1)], &[])?;
            self.collected(reading, |collector| collector.squared_norm(&sum))
        };
        self.readings.iter().find_map(norm)
    }

    /// Formula of a named root, √X or 1/√X.
    pub(super) fn root(&self, root: &NamedRoot) -> Option<Formula> {
        let place = self.roots.iter().position(|known| known.name == root.name)?;
        let written = |reading: &Reading| {
            let atom =
                reading.0.borrow().roots.iter().find(|(_, known)| **known == place).map(|(&atom, _)| atom)?;
            self.collected(reading, |collector| Some(collector.unnamed(atom, Rational::new_raw(1, 2))))
        };
        let written = shortest(self.readings.iter().filter_map(written), length)?;
        Some(if root.is_below {
            Formula::product(Rational::one().into(), Vec::new(), vec![written])
        } else {
            written
        })
    }

    fn polynomial(
        &self,
        Reading(expansion): &Reading,
        plus: &[(Id, i128)],
        minus: &[Id],
    ) -> Option<Polynomial> {
        let mut expansion = expansion.borrow_mut();
        let parts: Vec<_> = plus.iter().copied().chain(minus.iter().map(|&id| (id, -1))).collect();
        if let Some(read) = expansion.read.get(&parts) {
            return read.clone();
        }
        let read = self.sum(&mut expansion, &parts);
        expansion.read.insert(parts, read.clone());
        read
    }

    fn sum(&self, expansion: &mut Expansion, parts: &[(Id, i128)]) -> Option<Polynomial> {
        let mut sum = Polynomial::default();
        for &(id, sign) in parts {
            sum.add(&expansion.of(id)?, Rational::from_integer(sign))?;
        }
        if sum.len() > LIMIT {
            return None;
        }
        for turning in &self.derived.turnings.all {
            sum = expansion.atoms.on_sphere(sum, turning.first)?;
        }
        if sum.len() > TERMS {
            return None;
        }
        let merged = expansion.atoms.merged(sum)?;
        let cancelled = expansion.atoms.cancelled(merged)?;
        let read = expansion.atoms.combined(cancelled)?;
        (expansion.atoms.size(&read) <= SIZE).then_some(read)
    }

    fn collected<T>(
        &self,
        Reading(expansion): &Reading,
        write: impl Fn(&Collector) -> Option<T>,
    ) -> Option<T> {
        let expansion = &expansion.borrow();
        write(&Collector {
            page: self,
            expansion,
            constants: &self.constants,
            powers: RefCell::default(),
            directions: RefCell::default(),
        })
    }
}

/// Good candidates, unless all of them are half as long again as the shortest one.
fn preferred<T>(read: Vec<T>, length: impl Fn(&T) -> usize, is_good: impl Fn(&T) -> bool) -> Vec<T> {
    let Some(least) = read.iter().map(&length).min() else { return read };
    let (good, others): (Vec<T>, Vec<T>) =
        read.into_iter().partition(|candidate| is_good(candidate) && 2 * length(candidate) <= 3 * least);
    if good.is_empty() { others } else { good }
}

/// First of the shortest candidates.
fn shortest<T>(candidates: impl Iterator<Item = T>, length: impl Fn(&T) -> usize) -> Option<T> {
    candidates.reduce(|best, next| if length(&next) < length(&best) { next } else { best })
}
