//! The natural map of reactions. It takes the reaction r of each block to the point of its set that is nearest to r − u/g, with the rates u
//! and the response g of the block. Reactions that it does not change satisfy the law.

use alloc::vec::Vec;

use super::{ConeSolver, Face, Limit, RowBlock, Set};
use crate::numerics::bare::{dot, length, sqrt};

impl ConeSolver {
    /// Projects r − u/g of a friction onto the disc of this radius. Returns the point, and its face.
    pub(super) fn within(&self, k: usize, limit: f64) -> ([f64; 2], Face) {
        let tries = self.pulled(k);
        let far = length(tries);
        if limit <= 0.0 {
            return ([0.0; 2], Face::Open);
        }
        if far <= limit {
            return (tries, Face::Stick);
        }
        (tries.map(|x| x * (limit / far)), Face::Slide(tries.map(|x| x / far)))
    }

    /// Two entries of the rows of a block, the second zero if there is one row.
    pub(super) fn two(&self, k: usize, value: impl Fn(usize) -> f64) -> [f64; 2] {
        let RowBlock { first, count, .. } = self.blocks[k];
        [value(first), if count > 1 { value(first + 1) } else { 0.0 }]
    }

    /// r − u/g of a block.
    pub(super) fn pulled(&self, k: usize) -> [f64; 2] {
        self.two(k, |i| self.r[i] - self.rate(i) / self.responses[k])
    }

    /// The reaction nearest to r − u/g that its set allows, and its face. Reactions that are so themselves satisfy the law.
    pub(super) fn natural(&self, k: usize) -> ([f64; 2], Face) {
        let push = |k: usize| self.pulled(k)[0].max(0.0);
        match self.blocks[k].set {
            Set::Line => (self.pulled(k), Face::Stick),
            Set::HalfLine => ([push(k), 0.0], if push(k) > 0.0 { Face::Stick } else { Face::Open }),
            Set::Disc(Limit { radius, mu, gap }) => {
                self.within(k, radius + gap.map_or(0.0, |gap| mu * push(gap)))
            }
            Set::Ray { force, gap } => (force.map(|x| x * push(gap)), self.natural(gap).1),
        }
    }

    pub(super) fn faces(&self) -> Vec<Face> {
        (0..self.blocks.len()).map(|k| self.natural(k).1).collect()
    }

    /// Squared distance of the reactions of a block from its natural ones.
    pub(super) fn defect(&self, k: usize) -> f64 {
        let (natural, [x, y]) = (self.natural(k).0, self.two(k, |i| self.r[i]));
        let off = [natural[0] - x, natural[1] - y];
        dot(&off, &off)
    }

    pub(super) fn defects(&self) -> f64 {
        (0..self.blocks.len()).fold(0.0, |sum, k| sum + self.defect(k))
    }

    /// Moves reactions into their sets; what is open on these faces is zero.
    pub(super) fn clip(&mut self, faces: Option<&[Face]>) {
        for k in 0..self.blocks.len() {
            let block = self.blocks[k];
            if faces.is_some_and(|faces| faces[k] == Face::Open) {
                self.r[block.rows()].fill(0.0);
            }
            match block.set {
                Set::Line => {}
                Set::HalfLine => self.r[block.first] = self.r[block.first].max(0.0),
                Set::Disc(limit) => {
                    let (limit, _) = self.limit(&limit);
                    let size = length(self.two(k, |i| self.r[i]));
                    if size > limit {
                        self.r[block.rows()].iter_mut().for_each(|x| *x *= limit / size);
                    }
                }
                Set::Ray { force, gap } => {
                    let push = self.r[self.blocks[gap].first];
                    block.rows().zip(force).for_each(|(i, force)| self.r[i] = force * push);
                }
            }
        }
        self.refresh();
    }

    /// The largest distance of reactions from their natural ones, as a part of the largest rate without reactions.
    pub(super) fn residual(&self) -> f64 {
        let most = (0..self.blocks.len()).fold(0.0, |most, k| f64::max(most, self.defect(k)));
        if most == 0.0 { 0.0 } else { sqrt(most) / self.unit() }
    }
}
