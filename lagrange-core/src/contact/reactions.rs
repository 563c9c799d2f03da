//! Problems of the reactions of bodies that touch.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::Contacts;
use super::rows::TouchingRows;
use crate::cone::{ConeDecision, ConeSolver, Face, RowBlock, Set, dot};
use crate::number::Real;

/// The reactions of some rows, of which the others have none.
pub(super) struct ReactionProblem<'a, L> {
    rows: &'a TouchingRows<L>,
    /// Rates without unknown reactions, and their round-off.
    rates: Vec<f64>,
    noise: &'a [f64],
    /// Reactions that are known.
    known: Vec<f64>,
    /// Place of each row of the problem, and what its reactions may be.
    places: Vec<usize>,
    blocks: Vec<RowBlock>,
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

impl<'a, L: Contacts<Scalar: Real>> ReactionProblem<'a, L> {
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
        self.blocks.push(RowBlock { first, count, set });
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
