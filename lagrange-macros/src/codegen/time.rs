//! About how long a schedule takes on a processor of our day, in cycles: enough to choose between two of them.

use super::operation::{Operation, Register};
use super::schedule::Schedule;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Time {
    /// What there is to do, were nothing ever waited for.
    pub(super) work: usize,
    /// Latency of the critical path: the longest chain of dependent operations.
    pub(super) path: usize,
}

impl Time {
    /// An elimination waits for its pivots while it works: chains in angles took about this long, measured from 2 to
    /// 20 links with either form.
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

    /// When each result is there, were there nothing else to do.
    pub(super) fn ready(&self) -> Vec<usize> {
        let mut ready: Vec<usize> = Vec::with_capacity(self.operations.len());
        for &operation in &self.operations {
            let start = self.operands(operation).map(|operand| ready[operand.index()]).max().unwrap_or(0);
            ready.push(start + cost(operation).0);
        }
        ready
    }
}

/// Cycles until the result is there, and until the next operation may begin.
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
