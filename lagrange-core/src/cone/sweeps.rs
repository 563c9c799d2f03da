//! Guesses of faces by sweeps: each block in turn takes its natural reaction, there and back, so that none comes first (projected
//! Gauss–Seidel; Jourdan, Alart and Jean, *Computer Methods in Applied Mechanics and Engineering* 155, 1998).

use super::{ConeSolver, Set};

impl ConeSolver {
    /// Guesses faces by sweeps from the reactions so far, then by Newton steps from there, and solves their equations.
    pub(super) fn by_sweeps(&mut self) -> bool {
        (0..4 + self.m / 2).for_each(|turn| self.sweep(turn % 2 == 1));
        self.refresh();
        self.refine()
    }

    /// The limit of a friction is that of the new reaction of its gap.
    fn sweep(&mut self, is_back: bool) {
        let count = self.blocks.len();
        for at in 0..count {
            let k = if is_back { count - 1 - at } else { at };
            let block = self.blocks[k];
            let to = match block.set {
                Set::Disc(limit) => self.within(k, self.limit(&limit).0).0,
                Set::Ray { force, gap } => force.map(|x| x * self.r[self.blocks[gap].first]),
                _ => self.natural(k).0,
            };
            block.rows().zip(to).for_each(|(i, to)| self.put(i, to));
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
