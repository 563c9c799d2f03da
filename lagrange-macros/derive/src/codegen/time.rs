//! Estimates the time of a schedule in cycles of a current processor, accurate enough to choose between two
//! schedules.

use super::operation::{Operation, Register};
use super::schedule::Schedule;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Time {
    /// Issue time of all operations, in cycles, without stalls.
    pub(super) work: usize,
    /// Latency of the critical path, the longest chain of dependent operations, in cycles.
    pub(super) path: usize,
}

impl Time {
    /// Sum of work and latency, because an elimination stalls on its pivots. Agrees roughly with the times measured
    /// for chains of 2 to 20 links in angles, by either form.
    pub(super) fn total(self) -> usize {
        self.work + self.path
    }
}

impl Schedule {
    pub(super) fn time(&self, roots: &[Register]) -> Time {
        let uses = self.uses(roots);
        let needed = self.operations.iter().zip(&uses).filter(|(_, uses)| **uses > 0);
        let work = needed.map(|(&operation, _)| cost(operation).1).sum();
        let ready = self.ready();
        Time { work, path: roots.iter().map(|root| ready[root.index()]).max().unwrap_or(0) }
    }

    /// Cycle at which each result is ready, if operations only wait for their operands.
    pub(super) fn ready(&self) -> Vec<usize> {
        let mut ready: Vec<usize> = Vec::with_capacity(self.operations.len());
        for &operation in &self.operations {
            let start = self.operands(operation).map(|operand| ready[operand.index()]).max().unwrap_or(0);
            ready.push(start + cost(operation).0);
        }
        ready
    }
}

/// Latency and reciprocal throughput of an operation, in cycles.
fn cost(operation: Operation) -> (usize, usize) {
    match operation {
        Operation::Constant(_) | Operation::Input(_) => (0, 0),
        Operation::Divide(..) | Operation::SquareRoot(_) => (13, 5),
        Operation::Function(..) | Operation::Atan2(..) | Operation::Power(..) | Operation::Result { .. } => {
            (40, 30)
        }
        _ => (4, 1),
    }
}
