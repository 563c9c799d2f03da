//! Problems of the reactions of bodies that touch.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::Contacts;
use super::rows::TouchingRows;
use crate::cone::{ConeDecision, ConeProblem, ConeSearch, Face, RowBlock, Set};
use crate::number::Real;
use crate::numerics::bare::dot;

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
    /// How reactions are looked for, with faces by constraints.
    search: ConeSearch<'a>,
}

/// Reactions of all rows, the rates with them, and what they change x by.
#[derive(Clone)]
pub(super) struct Reactions {
    pub(super) forces: Vec<f64>,
    pub(super) rates: Vec<f64>,
    pub(super) change: Vec<f64>,
    /// Face of each row.
    pub(super) faces: Vec<Face>,
    /// Zero if the law holds; else what is off it, see [`ConeDecision::residual`].
    pub(super) residual: f64,
}

/// Why no reactions are known.
#[derive(Clone, Copy, Debug)]
pub(super) enum NoForces {
    /// None satisfy the law.
    Jammed,
    /// Several may, or none were found.
    Undecided,
}

impl<'a, L: Contacts<Scalar: Real>> ReactionProblem<'a, L> {
    /// Without reactions, but those of constraints, which keep the rates that they have if none are given.
    pub(super) fn new(rows: &'a TouchingRows<L>, mut rates: Vec<f64>, noise: &'a [f64]) -> Self {
        rates.resize(rows.all.len(), 0.0);
        let known = vec![0.0; rows.all.len()];
        let mut problem =
            Self { rows, rates, noise, known, places: vec![], blocks: vec![], search: ConeSearch::Law };
        (rows.count..rows.all.len()).for_each(|place| {
            problem.push(place..place + 1, Set::Line);
        });
        problem
    }

    /// Looks for reactions in this way, with faces by constraints.
    pub(super) fn by(self, search: ConeSearch<'a>) -> Self {
        Self { search, ..self }
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
        let problem = self.problem();
        let found = match self.search {
            ConeSearch::Law => problem.decide(ConeSearch::Law),
            ConeSearch::Near { faces, tolerance } => {
                let face = |block: &RowBlock| faces[self.rows.all[self.places[block.first]]];
                let faces: Vec<Face> = self.blocks.iter().map(face).collect();
                problem.decide(ConeSearch::Near { faces: &faces, tolerance })
            }
        };
        match found.is_found {
            true => Ok(self.reactions(found)),
            false if problem.is_jammed() => Err(NoForces::Jammed),
            false => Err(NoForces::Undecided),
        }
    }

    fn problem(&self) -> ConeProblem {
        let of =
            |all: &[f64]| self.places.iter().map(|&place| all.get(place).copied().unwrap_or(0.0)).collect();
        let j = self.places.iter().flat_map(|&place| self.rows.row(place)).copied().collect();
        let (rates, noise, blocks) = (of(&self.rates), of(self.noise), self.blocks.clone());
        ConeProblem { n: self.rows.n, j, rates, noise, blocks }
    }

    fn reactions(&self, found: ConeDecision) -> Reactions {
        let ConeDecision { reactions, mut change, faces: of_blocks, residual, .. } = found;
        let mut rates: Vec<f64> =
            (0..).zip(&self.rates).map(|(place, rate)| rate + dot(self.rows.row(place), &change)).collect();
        let (mut forces, mut faces) = (self.known.clone(), vec![Face::Open; rates.len()]);
        for (known, place) in self.known.iter().zip(0..).filter(|(known, _)| **known != 0.0) {
            change.iter_mut().zip(self.rows.row(place)).for_each(|(x, j)| *x += known * j);
        }
        for (k, &place) in self.places.iter().enumerate() {
            (forces[place], rates[place]) = (forces[place] + reactions[k], found.rates[k]);
        }
        for (block, face) in self.blocks.iter().zip(of_blocks) {
            block.rows().for_each(|k| faces[self.places[k]] = face);
        }
        Reactions { forces, rates, change, faces, residual }
    }
}
