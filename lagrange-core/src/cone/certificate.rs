//! Whether reactions satisfy the law.
//!
//! What counts is the velocities. The natural map p − proj(p − u/g) says nothing where g p is much larger than u, since their difference
//! then has none of the digits of u; so each block is asked for the rates that its reaction does not allow: |min(g r_n, u_n)| of a gap, |u_T|
//! where friction sticks, and what u_T has across the reaction, or along it, where it slides. These are compared with 10⁻¹² of the terms
//! |J| |x| + |q| of their rows and with the round-off of q.

use alloc::vec;
use alloc::vec::Vec;

use super::limits::{ACCURACY, GAIN, ROUND_OFF};
use super::{ConeSolver, Face, RowBlock, Set};
use crate::numerics::bare::{dot, length, sqrt};
use crate::numerics::least_norm::PivotedQr;

/// The rate of friction that a reaction `p` within this limit does not allow.
fn slip(p: [f64; 2], u: [f64; 2], limit: f64, g: f64) -> f64 {
    let (size, speed) = (length(p), length(u));
    if size == 0.0 || size < limit * (1.0 - ROUND_OFF) {
        let pulled = [0, 1].map(|c| p[c] - u[c] / g);
        let far = length(pulled);
        let over = if far > limit { limit / far } else { 1.0 };
        return if over < 1.0 { g * length([0, 1].map(|c| over * pulled[c] - p[c])) } else { speed };
    }
    let along = (p[0] * u[0] + p[1] * u[1]) / size;
    if along > 0.0 {
        return speed;
    }
    let across = length([0, 1].map(|c| u[c] - along * p[c] / size));
    limit * across / length([size - along / g, across / g])
}

impl ConeSolver {
    /// Whether the reactions satisfy the law, with the velocities that they change.
    pub(super) fn obeys(&self) -> bool {
        let unit = self.speed();
        self.balances(unit) && !self.gains(unit) && (0..self.blocks.len()).all(|k| self.is_lawful(k, unit))
    }

    /// Response of each row: that of its block.
    pub(super) fn compliance(&self) -> Vec<f64> {
        let of = |(block, g): (&RowBlock, &f64)| core::iter::repeat_n(*g, block.count);
        self.blocks.iter().zip(&self.responses).flat_map(of).collect()
    }

    /// The largest rate without reactions, divided by the length of its row: a velocity in coordinates of unit mass.
    fn speed(&self) -> f64 {
        let of = |(q, g): (&f64, f64)| q.abs() / sqrt(g);
        self.q.iter().zip(self.compliance()).map(of).fold(0.0, f64::max)
    }

    /// Terms |J|ᵀ |r| of the sum x = Jᵀ r, and the sum.
    fn sums(&self) -> [Vec<f64>; 2] {
        let [mut sizes, mut sums] = [(); 2].map(|()| vec![0.0; self.n]);
        for (i, r) in self.r.iter().enumerate() {
            for (c, j) in self.row(i).iter().enumerate() {
                sums[c] += j * r;
                sizes[c] += (j * r).abs();
            }
        }
        [sizes, sums]
    }

    /// True if x equals Jᵀ r to the round-off of that sum, and this round-off is at most √[`ACCURACY`] of the largest rate: it can then hide
    /// a motion with at most a part `ACCURACY` of the energy.
    fn balances(&self, unit: f64) -> bool {
        let [sizes, sums] = self.sums();
        let length = sqrt(dot(&self.x, &self.x));
        (0..self.n).all(|c| {
            let round_off = ROUND_OFF * sizes[c] + ACCURACY * length;
            (sums[c] - self.x[c]).abs() <= round_off && round_off <= sqrt(ACCURACY) * unit
        })
    }

    /// Whether the least motion v with J v = q would gain energy, |v + x| > |v|. Asked where reactions are so large that the defects of
    /// rates say nothing of it. No set but a ray allows that.
    fn gains(&self, unit: f64) -> bool {
        let has_rays = self.blocks.iter().any(|block| matches!(block.set, Set::Ray { .. }));
        if has_rays || self.sums()[0].iter().all(|size| *size <= GAIN / ACCURACY * unit) {
            return false;
        }
        let range = PivotedQr::new(self.j.clone(), [self.n, self.m], ACCURACY);
        let (v, x) = (range.coordinates(&self.q), range.components(&self.x));
        2.0 * dot(&x, &v) + dot(&self.x, &self.x) > GAIN * dot(&v, &v)
    }

    /// Terms of a rate.
    fn terms(&self, i: usize) -> f64 {
        self.row(i).iter().zip(&self.x).fold(self.q[i].abs(), |sum, (j, x)| sum + (j * x).abs())
    }

    /// The face of a block by its reaction and its rates. The natural map does not tell it where reactions are much larger than rates.
    pub(super) fn face(&self, k: usize) -> Face {
        let block = self.blocks[k];
        match block.set {
            Set::Line => Face::Stick,
            Set::HalfLine => {
                if self.r[block.first] > 0.0 {
                    Face::Stick
                } else {
                    Face::Open
                }
            }
            Set::Ray { gap, .. } => self.face(gap),
            Set::Disc(limit) => {
                let (limit, r, u) =
                    (self.limit(&limit).0, self.two(k, |i| self.r[i]), self.two(k, |i| self.rate(i)));
                let terms = block.rows().map(|i| self.terms(i)).sum::<f64>();
                let (size, speed) = (length(r), length(u));
                let is_at_limit = size >= limit * (1.0 - ROUND_OFF);
                // A friction at its limit may be at rest: its rate is then within the accuracy, in any direction. A limit as small as
                // round-off may differ from the force in its last bits, so that a rate beyond the accuracy says that it slides.
                let least = if is_at_limit { ROUND_OFF } else { ACCURACY };
                let slides = speed > least * terms && r[0] * u[0] + r[1] * u[1] < 0.0;
                match limit > 0.0 {
                    false => Face::Open,
                    true if !slides => Face::Stick,
                    true => Face::Slide(r.map(|x| x / size)),
                }
            }
        }
    }

    /// Whether the rates of a block are those that its reaction allows.
    fn is_lawful(&self, k: usize, unit: f64) -> bool {
        let (block, g) = (self.blocks[k], self.responses[k]);
        let off = match block.set {
            Set::Line => self.rate(block.first).abs(),
            Set::HalfLine => (g * self.r[block.first]).min(self.rate(block.first)).abs(),
            Set::Disc(limit) => {
                slip(self.two(k, |i| self.r[i]), self.two(k, |i| self.rate(i)), self.limit(&limit).0, g)
            }
            Set::Ray { .. } => return true,
        };
        off <= block
            .rows()
            .fold(ACCURACY * unit * sqrt(g), |sum, i| sum + self.noise[i] + ACCURACY * self.terms(i))
    }
}
