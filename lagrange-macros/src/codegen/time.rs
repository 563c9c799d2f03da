//! About how long a schedule takes on a processor of our day, in cycles: enough to choose between two of them.

use super::schedule::{Operation, Register, Schedule};

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Time {
    /// What there is to do, were nothing ever waited for.
    pub(super) work: usize,
    /// The longest chain of operations that wait for one another.
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
        let mut ready = vec![0; self.operations.len()];
        let mut work = 0;
        for (index, &operation) in self.operations.iter().enumerate().filter(|(index, _)| uses[*index] > 0) {
            let (latency, share) = cost(operation);
            let start = self.operands(operation).map(|operand| ready[operand.index()]).max().unwrap_or(0);
            ready[index] = start + latency;
            work += share;
        }
        Time { work, path: ready.into_iter().max().unwrap_or(0) }
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
