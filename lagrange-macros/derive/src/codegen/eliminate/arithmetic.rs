//! Arithmetic on registers that skips structural zeros.

use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Id;

/// Register of a number; `None` for a structural zero.
pub(super) type SparseEntry = Option<Register>;
/// Nonzero entries with their indices.
pub(super) type Sparse = Vec<(usize, Register)>;

pub(super) fn sparse(x: &[SparseEntry]) -> Sparse {
    x.iter().enumerate().filter_map(|(i, entry)| entry.map(|entry| (i, entry))).collect()
}

/// Builder that appends operations to a schedule.
pub(super) struct Solver<'s> {
    pub(super) schedule: &'s mut Schedule,
    /// For each pivot that differs from its diagonal entry before elimination, the ratio of that entry to the
    /// pivot.
    pub(super) growth: Vec<Register>,
    /// Pivots that equal their diagonal entry before elimination, with their reciprocals.
    pub(super) plain: Vec<[Register; 2]>,
    /// Reciprocals of all pivots.
    pub(super) reciprocals: Vec<Register>,
}

impl<'s> Solver<'s> {
    pub(super) fn new(schedule: &'s mut Schedule) -> Self {
        Self { schedule, growth: Vec::new(), plain: Vec::new(), reciprocals: Vec::new() }
    }

    pub(super) fn entry(&self, id: Id) -> SparseEntry {
        (id != Id::ZERO).then(|| self.schedule.register(id))
    }

    pub(super) fn entries(&self, ids: &[Id]) -> Vec<SparseEntry> {
        ids.iter().map(|&id| self.entry(id)).collect()
    }

    pub(super) fn sparse_entries(&self, ids: &[(usize, Id)]) -> Sparse {
        ids.iter().map(|&(i, id)| (i, self.schedule.register(id))).collect()
    }

    pub(super) fn add(&mut self, x: SparseEntry, y: SparseEntry) -> SparseEntry {
        match (x, y) {
            (Some(x), Some(y)) => Some(self.schedule.push(Operation::Add(x, y))),
            (x, y) => x.or(y),
        }
    }

    pub(super) fn subtract(&mut self, x: SparseEntry, y: SparseEntry) -> SparseEntry {
        match (x, y) {
            (Some(x), Some(y)) => Some(self.schedule.push(Operation::Subtract(x, y))),
            (None, y) => self.negate(y),
            (x, None) => x,
        }
    }

    pub(super) fn negate(&mut self, x: SparseEntry) -> SparseEntry {
        x.map(|x| self.schedule.push(Operation::Negate(x)))
    }

    pub(super) fn multiply(&mut self, x: SparseEntry, y: SparseEntry) -> SparseEntry {
        Some(self.schedule.push(Operation::Multiply(x?, y?)))
    }

    /// Σ x_i y_i
    pub(super) fn dot(&mut self, x: &Sparse, y: &[SparseEntry]) -> SparseEntry {
        x.iter().fold(None, |sum, &(i, x)| {
            let part = self.multiply(Some(x), y[i]);
            self.add(sum, part)
        })
    }

    pub(super) fn known(&mut self, entry: SparseEntry) -> Register {
        entry.unwrap_or_else(|| self.schedule.constant(0.0))
    }
}
