//! What contacts, friction and equality constraints do at one instant: one problem, solved to a certificate.
//!
//! Bodies have velocities in ℝⁿ, in coordinates in which |x|² is twice the kinetic energy. Rows J give the rates u = J x + q of gaps,
//! of velocities of friction and of constraints, where q are the rates without reactions and x = Jᵀ r is what the reactions r change.
//! The law of all of them is De Saxcé's (*Mechanics of Structures and Machines* 26, 1998; Acary, Brémond and Huber, *Advanced Topics
//! in Nonsmooth Dynamics*, 2018):
//!
//! K* ∋ u + μ |u_T| n ⊥ r ∈ K,
//!
//! with K a product of the [sets](Set). It holds for impulses and velocities, for forces and accelerations, and for a step in time.
//!
//! What is guaranteed: reactions that are [found](ConeDecision::is_found) lie in their sets, and [satisfy](certificate) the law to 10⁻¹² of the
//! terms of each rate, |J| |x| + |q|. The same problem has the same answer, and blocks that are alike in it share what they have in
//! common alike.
//!
//! How they are found:
//!
//! 1. [Islands](islands): blocks that change no velocity in common are problems of their own.
//! 2. [Contacts that give way](compliant): Newton's method with a compliance, which becomes smaller, guesses the [faces](Face).
//! 3. [The faces](faces): their equations are solved to round-off by a rank-revealing QR of J. If the law does not hold there, blocks change
//!    their faces.
//! 4. Else the same from [sweeps], from other reactions again and again.
//!
//! A time step [looks](ConeSearch) at the faces of the last one first, and is content with the reactions of 2, brought nearer to the law up to a
//! tolerance, where their faces do not satisfy it.

mod certificate;
mod compliant;
mod faces;
mod islands;
mod limits;
mod natural;
mod sweeps;
#[cfg(test)]
mod tests;
mod trials;

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

pub(crate) use islands::ConeProblem;
pub(crate) use limits::ACCURACY;
use limits::{ROUND_OFF, STARTS, WORK};

use crate::numerics::bare::{dot, length, power_of_two_near_root, sqrt};
use crate::numerics::spread::scattered;

/// What the reactions of a block may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Set {
    /// An equality constraint: u = 0.
    Line,
    /// A gap: 0 ≤ u ⊥ r ≥ 0.
    HalfLine,
    /// Friction along one or two velocities, with |r| up to the limit.
    Disc(Limit),
    /// Friction that slides in a known direction, r = `force` times the reaction of the block `gap`, which comes before it.
    Ray { force: [f64; 2], gap: usize },
}

/// The limit of friction: `radius`, and μ times the reaction of the block `gap`, which comes before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limit {
    pub(crate) radius: f64,
    pub(crate) mu: f64,
    pub(crate) gap: Option<usize>,
}

/// Rows that belong together: one, or the two velocities of a friction in a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowBlock {
    pub(crate) first: usize,
    pub(crate) count: usize,
    pub(crate) set: Set,
}

impl RowBlock {
    pub(crate) fn rows(&self) -> Range<usize> {
        self.first..self.first + self.count
    }
}

/// The part of its set on which the reaction of a block lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Face {
    /// No reaction: a gap that is open, or friction whose limit is zero.
    Open,
    /// No rates, or for a ray those that its force leads to.
    Stick,
    /// Friction at its limit, in this direction of its force.
    Slide([f64; 2]),
}

/// How reactions are looked for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ConeSearch<'a> {
    /// They satisfy the law.
    Law,
    /// They satisfy the law on these faces or others of few changes; or else they may be off it by a residual up to the tolerance.
    Near { faces: &'a [Face], tolerance: f64 },
}

/// What is known of a problem.
#[derive(Clone, Debug)]
pub(crate) struct ConeDecision {
    /// Whether the reactions satisfy the law, or come near enough to it. Else no faces were found on which reactions do, or reactions would
    /// be needed that are so much larger than the rates that their round-off decides.
    pub(crate) is_found: bool,
    /// Zero if the reactions satisfy the law; else their largest distance from natural ones, as a part of the largest rate without them.
    pub(crate) residual: f64,
    /// Reaction of each row.
    pub(crate) reactions: Vec<f64>,
    /// Rate of each row.
    pub(crate) rates: Vec<f64>,
    /// Face of each block.
    pub(crate) faces: Vec<Face>,
    /// Change of the velocities.
    pub(crate) change: Vec<f64>,
}

/// A problem, with what is known of its reactions so far. Rows are scaled by powers of two, which rounds nothing, to responses near 1:
/// reactions and rates then have one unit, the root of an energy.
pub(crate) struct ConeSolver {
    n: usize,
    m: usize,
    j: Vec<f64>,
    /// J Jᵀ, for guesses alone.
    w: Vec<f64>,
    q: Vec<f64>,
    /// Round-off of q.
    noise: Vec<f64>,
    blocks: Vec<RowBlock>,
    /// By how much a reaction of 1 of each block changes its own rate, in the direction where that is most; 1 for rows of zeros.
    responses: Vec<f64>,
    scale: Vec<f64>,
    r: Vec<f64>,
    x: Vec<f64>,
    /// Equations of faces solved so far.
    solved: usize,
}

impl ConeSolver {
    /// `j` has rows of length `n`; `noise` is the round-off of `q`.
    pub(crate) fn new(n: usize, j: Vec<f64>, [q, noise]: [Vec<f64>; 2], blocks: Vec<RowBlock>) -> Self {
        let m = q.len();
        let zeros = || vec![0.0; m];
        let mut solver = Self {
            n,
            m,
            j,
            w: vec![0.0; m * m],
            q,
            noise,
            blocks,
            responses: Vec::new(),
            scale: vec![1.0; m],
            r: zeros(),
            x: vec![0.0; n],
            solved: 0,
        };
        (0..solver.blocks.len()).for_each(|k| solver.scale_block(k));
        for (a, b) in (0..m).flat_map(|a| (0..=a).map(move |b| (a, b))) {
            let entry = dot(solver.row(a), solver.row(b));
            (solver.w[a * m + b], solver.w[b * m + a]) = (entry, entry);
        }
        solver.responses = solver.blocks.iter().map(|block| solver.response_of(block)).collect();
        solver
    }

    /// Divides the rows of a block by a power of two.
    fn scale_block(&mut self, k: usize) {
        let RowBlock { first, count, set } = self.blocks[k];
        let squares = (first..first + count).map(|i| dot(self.row(i), self.row(i)));
        let by = power_of_two_near_root(squares.fold(0.0, f64::max));
        for i in first..first + count {
            self.j[i * self.n..][..self.n].iter_mut().for_each(|x| *x /= by);
            (self.q[i], self.noise[i], self.scale[i]) = (self.q[i] / by, self.noise[i] / by, by);
        }
        let of_gap = |gap: usize| by / self.scale[self.blocks[gap].first];
        self.blocks[k].set = match set {
            Set::Disc(Limit { radius, mu, gap }) => {
                Set::Disc(Limit { radius: radius * by, mu: gap.map_or(0.0, |gap| mu * of_gap(gap)), gap })
            }
            Set::Ray { force, gap } => Set::Ray { force: force.map(|x| x * of_gap(gap)), gap },
            set => set,
        };
    }

    fn response_of(&self, block: &RowBlock) -> f64 {
        let w = |a: usize, b: usize| self.w[a * self.m + b];
        let (i, k) = (block.first, block.first + block.count - 1);
        let most = (w(i, i) + w(k, k)) / 2.0
            + length([(w(i, i) - w(k, k)) / 2.0, if i < k { w(i, k) } else { 0.0 }]);
        if most > 0.0 { most } else { 1.0 }
    }

    /// The row of the gap that presses a friction.
    fn gap_row(&self, gap: Option<usize>) -> Option<usize> {
        gap.map(|gap| self.blocks[gap].first)
    }

    /// The limit of a friction with the reactions so far, and by how much it grows with the reaction of which row.
    fn limit(&self, Limit { radius, mu, gap }: &Limit) -> (f64, Option<(usize, f64)>) {
        match self.gap_row(*gap).filter(|_| *mu > 0.0) {
            Some(i) => (radius + mu * self.r[i], Some((i, *mu))),
            None => (*radius, None),
        }
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.j[i * self.n..][..self.n]
    }

    fn rate(&self, i: usize) -> f64 {
        dot(self.row(i), &self.x) + self.q[i]
    }

    /// Largest rate without reactions, the unit of reactions and rates.
    fn unit(&self) -> f64 {
        self.q.iter().fold(0.0, |most, q| f64::max(most, q.abs()))
    }

    /// x = Jᵀ r.
    fn refresh(&mut self) {
        let mut x = core::mem::take(&mut self.x);
        x.fill(0.0);
        for i in (0..self.m).filter(|&i| self.r[i] != 0.0) {
            x.iter_mut().zip(self.row(i)).for_each(|(x, j)| *x += self.r[i] * j);
        }
        self.x = x;
    }

    /// Finds reactions, and tells which part of them is off the law; `None` if none are found.
    fn find(&mut self, search: ConeSearch) -> Option<f64> {
        let is_lawful = match search {
            ConeSearch::Law => self.by_compliance(),
            ConeSearch::Near { faces, .. } => {
                self.settle_from(faces.to_vec(), true, false) || {
                    self.stiffen();
                    self.settle_from(self.faces(), true, false)
                }
            }
        };
        match search {
            ConeSearch::Near { tolerance, .. }
                if !is_lawful && self.approaches(|solver| solver.residual() <= tolerance) =>
            {
                Some(self.residual())
            }
            _ => (is_lawful || self.by_other_starts()).then_some(0.0),
        }
    }

    fn decide(&mut self, search: ConeSearch) -> ConeDecision {
        self.solved = 0;
        let found = self.find(search);
        if found != Some(0.0) {
            self.clip(None);
        }
        ConeDecision {
            is_found: found.is_some(),
            residual: found.unwrap_or_else(|| self.residual()),
            reactions: self.r.iter().zip(&self.scale).map(|(r, scale)| r / scale).collect(),
            rates: (0..self.m).map(|i| self.rate(i) * self.scale[i]).collect(),
            faces: (0..self.blocks.len()).map(|k| self.face(k)).collect(),
            change: self.x.clone(),
        }
    }

    /// From reactions spread over sizes from the largest rate to those whose round-off hides it.
    fn by_other_starts(&mut self) -> bool {
        let (unit, mut size, mut place) = (self.unit(), 0.0, 0);
        for _ in 0..STARTS {
            if self.solved * self.m > WORK {
                break;
            }
            for r in &mut self.r {
                place += 1;
                *r = size * scattered(place);
            }
            self.clip(None);
            if self.by_sweeps() {
                return true;
            }
            size = if size < sqrt(ACCURACY) / ROUND_OFF * unit { f64::max(10.0 * size, unit) } else { unit };
        }
        false
    }
}
