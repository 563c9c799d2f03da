//! Guesses of faces by sweeps: each block in turn takes its natural reaction, there and back, so that none comes first (projected
//! Gauss–Seidel; Jourdan, Alart and Jean, *Computer Methods in Applied Mechanics and Engineering* 155, 1998).

use super::{ConeSolver, Set, length};

impl ConeSolver {
    /// Guesses faces by sweeps from the reactions so far, then by Newton steps from there, and solves their equations.
    pub(super) fn by_sweeps(&mut self) -> bool {
        (0..4 + self.m / 2).for_each(|turn| self.sweep(turn % 2 == 1));
        self.refresh();
        if self.settle(false) {
            return true;
        }
        self.improve();
        self.settle(false)
    }

    /// Gaps first within a block, then its friction with the new reaction of the gap.
    fn sweep(&mut self, is_back: bool) {
        let count = self.blocks.len();
        for at in 0..count {
            let k = if is_back { count - 1 - at } else { at };
            let (block, natural) = (self.blocks[k], self.natural(k).0);
            let Set::Cone { mu } = block.set else {
                block.rows().zip(natural).for_each(|(i, to)| self.put(i, to));
                continue;
            };
            self.put(block.first, natural[0]);
            let (tries, limit) = (self.pulled(k), mu * natural[0]);
            let part = if length(tries) > limit { limit / length(tries) } else { 1.0 };
            block.tangent().zip(tries).for_each(|(i, to)| self.put(i, part * to));
        }
    }

    /// Sets a reaction, and changes the velocities by it.
    fn put(&mut self, i: usize, to: f64) {
        let by = to - self.r[i];
        self.r[i] = to;
        let row = &self.j[i * self.n..][..self.n];
        self.x.iter_mut().zip(row).for_each(|(x, j)| *x += by * j);
    }
}
