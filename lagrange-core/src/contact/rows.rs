//! The rows of bodies that touch, and problems of their reactions.

use alloc::vec;
use alloc::vec::Vec;
use core::marker::PhantomData;
use core::ops::Range;

use super::Contacts;
use super::bodies::{Bodies, UNITS};
use super::kinetic::KineticFactor;
use super::states::States;
use crate::cone::{Block, ConeDecision, ConeSolver, Face, Set, dot, sqrt};
use crate::error::Error;
use crate::names::Names;
use crate::number::{Real, Scalar};
use crate::solution::solve::solve;
use crate::system::StateOf;
use crate::vector::{Array, Length, Vector, vector};

/// Part of a row that others leave of it below which it depends on them: the elimination of a leg works with the squares of such parts,
/// and has no digits of smaller ones.
const DEPENDENT: f64 = 1e-7;

/// Rows W of gaps, velocities of friction and constraints, in coordinates x = Lᵀ q̇ with M = L Lᵀ, in which |x|² is twice the kinetic
/// energy: J = W L⁻ᵀ. Reactions r change the velocities by x = Jᵀ r.
pub(super) struct TouchingRows<L> {
    /// Index of each among the constraints: gaps, then velocities of friction, then constraints that are not of contacts.
    pub(super) all: Vec<usize>,
    /// Contacts that touch, in the order of their rows.
    pub(super) touching: Vec<usize>,
    /// Friction of these, and dry friction, each with the place of its first row.
    pub(super) frictions: Vec<(usize, usize)>,
    /// Number of rows of contacts and friction.
    pub(super) count: usize,
    /// J by rows, of n entries each.
    j: Vec<f64>,
    n: usize,
    mass: KineticFactor,
    system: PhantomData<fn(&L)>,
}

impl<L: Contacts<Scalar: Real> + Clone> Bodies<L> {
    /// The rows of these contacts, of all friction that may act with them, and of all other constraints.
    pub(super) fn rows(&self, touching: Vec<usize>, state: &StateOf<L>) -> Result<TouchingRows<L>, Error> {
        let mut all: Vec<usize> = touching.iter().map(|&k| L::CONTACTS[k]).collect();
        let mut frictions = Vec::new();
        for (f, friction) in L::FRICTIONS.iter().enumerate() {
            if friction.contact.is_none_or(|k| touching.contains(&k)) {
                frictions.push((f, all.len()));
                all.extend(friction.rows());
            }
        }
        let count = all.len();
        let is_free =
            |a: &usize| !L::CONTACTS.contains(a) && !L::FRICTIONS.iter().any(|of| of.rows().contains(a));
        all.extend((0..<L::M>::COUNT).filter(is_free));
        let (j, mass) = self.kinetic(&all, count, state)?;
        let n = <L::N>::COUNT;
        Ok(TouchingRows { all, touching, frictions, count, j, n, mass, system: PhantomData })
    }

    /// Rows in the coordinates of kinetic energy. Coordinates without mass have constraints that move them: a least mass along these rows
    /// changes nothing, since they do not move.
    fn kinetic(
        &self,
        all: &[usize],
        count: usize,
        state: &StateOf<L>,
    ) -> Result<(Vec<f64>, KineticFactor), Error> {
        let n = <L::N>::COUNT;
        let (jacobian, of_constraints) =
            (self.closed.constraint_jacobian(state), self.open.constraint_jacobian(state));
        let entry = |place: usize, i: usize| match place < count {
            true => jacobian[(all[place], i)].to_f64(),
            false => of_constraints[(all[place], i)].to_f64(),
        };
        let mut j: Vec<f64> = (0..all.len())
            .flat_map(|place| (0..n).map(move |i| (place, i)))
            .map(|(place, i)| entry(place, i))
            .collect();
        let masses = self.open.mass_matrix(state);
        let mut mass: Vec<f64> =
            (0..n).flat_map(|i| (0..n).map(move |k| (i, k))).map(|(i, k)| masses[(i, k)].to_f64()).collect();
        let largest = (0..n).fold(0.0, |most, i| f64::max(most, mass[i * n + i].abs()));
        for row in j.chunks_exact(n.max(1)).skip(count) {
            let along = |i: usize| mass[i * n + i] / (row[i] * row[i]);
            let along = (0..n).map(along).filter(|along| *along > 0.0 && along.is_finite());
            let least = along.fold(f64::INFINITY, f64::min);
            let least = if least.is_finite() { least } else { largest };
            for (i, of) in row.iter().enumerate() {
                mass[i * n..][..n].iter_mut().zip(row).for_each(|(m, w)| *m += least * of * w);
            }
        }
        // The general solver says which coordinates have no mass.
        let Some(mass) = KineticFactor::of(mass, n) else {
            solve(&self.open, state)?;
            return Err(Error::Singular { coordinates: Names::default(), time: state.t.to_f64() });
        };
        j.chunks_exact_mut(n.max(1)).for_each(|row| mass.solve_lower(row));
        Ok((j, mass))
    }
}

impl<L: Contacts<Scalar: Real>> TouchingRows<L> {
    pub(super) fn row(&self, place: usize) -> &[f64] {
        &self.j[place * self.n..][..self.n]
    }

    /// By how much a reaction of 1 of one row changes the rate of another one.
    pub(super) fn response(&self, one: usize, other: usize) -> f64 {
        dot(self.row(one), self.row(other))
    }

    /// Change of the velocities q̇ by this one of x.
    pub(super) fn velocities(&self, x: &[f64]) -> Vector<L::Scalar, L::N> {
        let mut v = x.to_vec();
        self.mass.solve_upper(&mut v);
        vector(Array::from_fn(|i| L::Scalar::constant(v[i])))
    }

    /// What this reaction of a row changes the velocities q̇ by.
    pub(super) fn change(&self, place: usize, reaction: f64) -> Vector<L::Scalar, L::N> {
        let x: Vec<f64> = self.row(place).iter().map(|x| x * reaction).collect();
        self.velocities(&x)
    }

    /// Size of the terms of what reactions change a rate by.
    pub(super) fn size(&self, place: usize, reactions: &[f64]) -> f64 {
        let terms = reactions.iter().enumerate().filter(|(_, r)| **r != 0.0);
        terms.fold(0.0, |sum, (of, r)| sum + (self.response(place, of) * r).abs())
    }

    /// Round-off that the motion of all bodies leaves in rates: |J x| ≤ |J| |x|, in any coordinates. Those of a wedge and a block on it
    /// have no other size.
    pub(super) fn motion_noise(&self, state: &StateOf<L>) -> Vec<f64> {
        let v: Vec<f64> = (0..self.n).map(|i| state.v[i].to_f64()).collect();
        let speed = L::Scalar::EPSILON * UNITS * self.mass.speed(&v);
        (0..self.count).map(|place| speed * sqrt(self.response(place, place))).collect()
    }

    /// Rows that stay at rest: closed gaps, and velocities of friction that sticks.
    pub(super) fn active(&self, states: &States) -> Vec<usize> {
        let gaps = (0..self.touching.len()).filter(|&place| states.is_closed(self.touching[place]));
        let sticks = self.frictions.iter().flat_map(|&(f, place)| {
            let is_kept =
                move |c: &usize| states.is_pressed::<L>(f) && states.frictions[f].friction.keeps(*c);
            (0..L::FRICTIONS[f].count).filter(is_kept).map(move |c| place + c)
        });
        gaps.chain(sticks).collect()
    }

    /// Place of the gap of a touching contact.
    pub(super) fn gap(&self, contact: usize) -> Option<usize> {
        self.touching.iter().position(|&k| k == contact)
    }

    /// The span of rows.
    pub(super) fn span(&self, places: impl IntoIterator<Item = usize>) -> RowSpan<'_, L> {
        let mut span = RowSpan { rows: self, basis: Vec::new(), change: vec![0.0; self.n] };
        (self.count..self.all.len()).chain(places).for_each(|place| {
            span.add(place);
        });
        span
    }
}

/// The span of the rows of constraints and of others, by an orthonormal basis.
pub(super) struct RowSpan<'a, L> {
    rows: &'a TouchingRows<L>,
    basis: Vec<Vec<f64>>,
    /// The least change of x with the changes of rates that were asked for.
    pub(super) change: Vec<f64>,
}

impl<L: Contacts<Scalar: Real>> RowSpan<'_, L> {
    /// What the span leaves of a vector.
    pub(super) fn rest(&self, mut x: Vec<f64>) -> Vec<f64> {
        // Twice, since the first time leaves round-off of the whole.
        for _ in 0..2 {
            for of in &self.basis {
                let along = dot(of, &x);
                x.iter_mut().zip(of).for_each(|(x, y)| *x -= along * y);
            }
        }
        x
    }

    /// Adds a row, if it does not depend on the others, and changes its rate by this, but not those of the others.
    pub(super) fn add_change(&mut self, place: usize, by: f64) {
        if !self.add(place) {
            return;
        }
        let (row, Some(along)) = (self.rows.row(place), self.basis.last()) else { return };
        let rest = by - dot(row, &self.change);
        let factor = rest / dot(row, along);
        self.change.iter_mut().zip(along).for_each(|(x, y)| *x += factor * y);
    }

    /// What the change does to the rate of a row.
    pub(super) fn rate(&self, place: usize) -> f64 {
        dot(self.rows.row(place), &self.change)
    }

    /// Number of independent rows.
    pub(super) fn size(&self) -> usize {
        self.basis.len()
    }

    /// Takes out the rows beyond this number.
    pub(super) fn truncate(&mut self, size: usize) {
        self.basis.truncate(size);
    }

    /// Whether a row depends on those of the span.
    pub(super) fn depends(&self, place: usize) -> bool {
        let (row, rest) = (self.rows.row(place), self.rest(self.rows.row(place).to_vec()));
        let least = f64::max(DEPENDENT, sqrt(L::Scalar::EPSILON));
        dot(&rest, &rest) <= least * least * dot(row, row)
    }

    /// Adds a row, if it does not depend on the others. Returns whether it does not.
    pub(super) fn add(&mut self, place: usize) -> bool {
        if self.depends(place) {
            return false;
        }
        let rest = self.rest(self.rows.row(place).to_vec());
        let size = sqrt(dot(&rest, &rest));
        self.basis.push(rest.into_iter().map(|x| x / size).collect());
        true
    }
}

/// The reactions of some rows, of which the others have none.
pub(super) struct Problem<'a, L> {
    rows: &'a TouchingRows<L>,
    /// Rates without unknown reactions, and their round-off.
    rates: Vec<f64>,
    noise: &'a [f64],
    /// Reactions that are known.
    known: Vec<f64>,
    /// Place of each row of the problem, and what its reactions may be.
    places: Vec<usize>,
    blocks: Vec<Block>,
}

/// Reactions of all rows, the rates with them, and what they change x by.
#[derive(Clone)]
pub(super) struct Reactions {
    pub(super) forces: Vec<f64>,
    pub(super) rates: Vec<f64>,
    pub(super) change: Vec<f64>,
    /// Face of each block, as far as the problem has been decided.
    pub(super) faces: Vec<Face>,
}

/// Why no reactions are known.
#[derive(Clone, Copy, Debug)]
pub(super) enum NoForces {
    /// None satisfy the law.
    Jammed,
    /// Several may, or none were found.
    Undecided,
}

/// Largest number of trials to find out whether there are any reactions.
const TRIALS: usize = 1_000;

impl<'a, L: Contacts<Scalar: Real>> Problem<'a, L> {
    /// Without reactions, but those of constraints, which keep the rates that they have.
    pub(super) fn new(rows: &'a TouchingRows<L>, mut rates: Vec<f64>, noise: &'a [f64]) -> Self {
        rates.resize(rows.all.len(), 0.0);
        let known = vec![0.0; rows.count];
        let mut problem = Self { rows, rates, noise, known, places: vec![], blocks: vec![] };
        (rows.count..rows.all.len()).for_each(|place| {
            problem.push(place..place + 1, Set::Line);
        });
        problem
    }

    /// Adds rows whose reactions are in this set. Returns the number of their block.
    pub(super) fn push(&mut self, places: Range<usize>, set: Set) -> usize {
        let (first, count) = (self.places.len(), places.len());
        self.places.extend(places);
        self.blocks.push(Block { first, count, set });
        self.blocks.len() - 1
    }

    /// Lets a row have a reaction that is known, or more of one.
    pub(super) fn know(&mut self, place: usize, reaction: f64) {
        self.known[place] += reaction;
        for of in 0..self.rates.len() {
            self.rates[of] += self.rows.response(of, place) * reaction;
        }
    }

    /// Finds the reactions.
    pub(super) fn decide(&self) -> Result<Reactions, NoForces> {
        let mut solver = self.solver();
        let found = solver.decide();
        if found.is_found {
            return Ok(self.reactions(found));
        }
        let slides = self.blocks.iter().any(|block| matches!(block.set, Set::Ray { .. }));
        match slides.then(|| solver.solutions(TRIALS)).flatten() {
            Some(solutions) if solutions.is_empty() => Err(NoForces::Jammed),
            _ => Err(NoForces::Undecided),
        }
    }

    fn solver(&self) -> ConeSolver {
        let of =
            |all: &[f64]| self.places.iter().map(|&place| all.get(place).copied().unwrap_or(0.0)).collect();
        let j = self.places.iter().flat_map(|&place| self.rows.row(place)).copied().collect();
        ConeSolver::new(self.rows.n, j, [of(&self.rates), of(self.noise)], self.blocks.clone())
    }

    fn reactions(&self, found: ConeDecision) -> Reactions {
        let ConeDecision { reactions, mut change, faces, .. } = found;
        let rate = |place: usize| self.rates[place] + dot(self.rows.row(place), &change);
        let mut rates: Vec<f64> = (0..self.rows.count).map(rate).collect();
        let mut forces = self.known.clone();
        for (known, place) in self.known.iter().zip(0..) {
            change.iter_mut().zip(self.rows.row(place)).for_each(|(x, j)| *x += known * j);
        }
        for (k, &place) in self.places.iter().enumerate().filter(|(_, place)| **place < self.rows.count) {
            (forces[place], rates[place]) = (forces[place] + reactions[k], found.rates[k]);
        }
        Reactions { forces, rates, change, faces }
    }
}
