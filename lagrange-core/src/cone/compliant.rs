//! Guesses of faces by Newton's method on the natural map r = proj(r − u/g − α (r − r₀)), of contacts that give way (Alart and Curnier,
//! *Computer Methods in Applied Mechanics and Engineering* 92, 1991).
//!
//! About r₀ = 0, α is a compliance. With α = 1 the equations are strongly monotone, so that Newton's method starts anywhere, and as α
//! becomes smaller each solution is the start of the next. No other start is needed, and what contacts share becomes unique: they share it
//! as equal springs. About the reactions themselves, α r₀ only keeps the equations regular (Rockafellar, *SIAM Journal on Control and
//! Optimization* 14, 1976).

use alloc::vec;
use alloc::vec::Vec;

use super::limits::{SLOWEST, STIFFER};
use super::{ConeSolver, Face, Limit, Set};
use crate::number::limits::HALF_THE_DIGITS;
use crate::number::limits::ITERATIONS;
use crate::numerics::bare::{length, sqrt};

/// Linear equations A δr = b of a Newton step.
struct CompliantStep {
    m: usize,
    a: Vec<f64>,
    b: Vec<f64>,
}

impl ConeSolver {
    /// Guesses faces by contacts that give way, and solves their equations: with shares as of equal springs, or else with the nearest.
    pub(super) fn by_compliance(&mut self) -> bool {
        self.stiffen();
        self.settle(true) || self.refine()
    }

    /// Solves the equations of faces, and of those nearer and nearer to the law. Where rows nearly depend on one another, faces are right
    /// only once reactions are known to more digits than that leaves of them.
    pub(super) fn refine(&mut self) -> bool {
        self.settle(false) || self.approaches(|solver| solver.settle_from(solver.faces(), false, false))
    }

    /// Brings reactions nearer to natural ones, until they are as wanted. The weight of what keeps the equations regular falls to round-off.
    pub(super) fn approaches(&mut self, is_near: impl Fn(&mut Self) -> bool) -> bool {
        let lighter = |weight: &f64| Some(STIFFER * STIFFER * weight).filter(|weight| *weight > f64::EPSILON);
        core::iter::successors(Some(STIFFER * STIFFER), lighter).any(|weight| {
            self.approach(weight);
            is_near(self)
        })
    }

    /// Takes Newton steps from the reactions so far, and keeps those that the natural map changes less.
    fn approach(&mut self, weight: f64) {
        let (before, defects) = (self.r.clone(), self.defects());
        self.newton(weight, &before);
        let leads_nearer = self.defects() < defects;
        if !leads_nearer {
            self.r = before;
            self.refresh();
        }
    }

    /// Follows the reactions of smaller and smaller compliances from no reactions on, to where half of the digits are lost to round-off and half
    /// to the compliance. Where Newton's method does not settle, a step in the compliance is too long.
    pub(super) fn stiffen(&mut self) {
        self.r.fill(0.0);
        self.refresh();
        let center = vec![0.0; self.m];
        // If Newton's method does not settle with the first, the next ones are larger.
        let (mut last, mut factor, mut weight) = (1.0 / (STIFFER * STIFFER), STIFFER, 1.0);
        while weight > HALF_THE_DIGITS && factor < SLOWEST {
            let before = self.r.clone();
            if self.newton(weight, &center) {
                last = weight;
            } else {
                self.r = before;
                self.refresh();
                factor = sqrt(factor);
            }
            weight = last * factor;
        }
    }

    /// Takes Newton steps with one weight of the compliance. Returns whether they settle.
    fn newton(&mut self, weight: f64, center: &[f64]) -> bool {
        for _ in 0..ITERATIONS {
            let mut equations =
                CompliantStep { m: self.m, a: vec![0.0; self.m * self.m], b: vec![0.0; self.m] };
            (0..self.blocks.len()).for_each(|k| self.linearize(k, (weight, center), &mut equations));
            if !equations.solve() {
                return false;
            }
            self.r.iter_mut().zip(&equations.b).for_each(|(r, by)| *r += by);
            self.refresh();
            let size = |x: &[f64]| x.iter().fold(0.0, |sum, x| sum + x.abs());
            let [change, all] = [size(&equations.b), size(&self.r)];
            if change <= HALF_THE_DIGITS * all || !all.is_finite() {
                return all.is_finite();
            }
        }
        false
    }

    /// Writes the rows of a block.
    fn linearize(&self, k: usize, (weight, center): (f64, &[f64]), to: &mut CompliantStep) {
        let (block, g) = (self.blocks[k], self.responses[k]);
        match (block.set, self.natural(k).1) {
            (Set::Ray { force, gap }, _) => {
                let push = self.blocks[gap].first;
                for (i, force) in block.rows().zip(force) {
                    to.set(i, force * self.r[push] - self.r[i]);
                    to.add(i, push, -force);
                }
            }
            (_, Face::Open) => block.rows().for_each(|i| to.set(i, -self.r[i])),
            (Set::Disc(limit), Face::Slide(direction)) => self.slide(k, (limit, direction), to),
            _ => {
                for i in block.rows() {
                    to.b[i] = -self.rate(i) / g - weight * (self.r[i] - center[i]);
                    to.add_response(i, (self.w_row(i), 1.0 / g));
                    to.add(i, i, weight);
                }
            }
        }
    }

    /// Rows of friction at its limit, r = limit · c/|c| with c = r − u/g.
    fn slide(&self, k: usize, (limit, direction): (Limit, [f64; 2]), to: &mut CompliantStep) {
        let (block, g, (limit, gap)) = (self.blocks[k], self.responses[k], self.limit(&limit));
        let turn = if block.count == 2 { limit / length(self.pulled(k)) } else { 0.0 };
        for (c, i) in block.rows().enumerate() {
            to.set(i, limit * direction[c] - self.r[i]);
            gap.into_iter().for_each(|(push, mu)| to.add(i, push, -mu * direction[c]));
            for (d, l) in block.rows().enumerate() {
                let across = turn * (f64::from(u8::from(c == d)) - direction[c] * direction[d]);
                to.add(i, l, -across);
                to.add_response(i, (self.w_row(l), across / g));
            }
        }
    }

    fn w_row(&self, i: usize) -> &[f64] {
        &self.w[i * self.m..][..self.m]
    }
}

impl CompliantStep {
    fn add(&mut self, row: usize, column: usize, by: f64) {
        self.a[row * self.m + column] += by;
    }

    fn add_response(&mut self, row: usize, (response, factor): (&[f64], f64)) {
        let entries = &mut self.a[row * self.m..][..self.m];
        entries.iter_mut().zip(response).for_each(|(a, w)| *a += factor * w);
    }

    /// Begins the row δr = `value`.
    fn set(&mut self, row: usize, value: f64) {
        self.b[row] = value;
        self.add(row, row, 1.0);
    }

    fn solve(&mut self) -> bool {
        eliminate(&mut self.a, &mut self.b)
    }
}

/// Gauss's elimination with pivots by rows; the right-hand side becomes the solution. False if it is not finite.
fn eliminate(matrix: &mut [f64], right: &mut [f64]) -> bool {
    let size = right.len();
    for k in 0..size {
        let entry = |row: usize| matrix[row * size + k].abs();
        let pivot = (k..size).fold(k, |pivot, row| if entry(row) > entry(pivot) { row } else { pivot });
        if !(entry(pivot) > 0.0 && entry(pivot).is_finite()) {
            return false;
        }
        if pivot != k {
            (k..size).for_each(|c| matrix.swap(k * size + c, pivot * size + c));
            right.swap(k, pivot);
        }
        let (above, below) = matrix.split_at_mut((k + 1) * size);
        let top = &above[k * size..];
        for (row, entries) in below.chunks_exact_mut(size).enumerate() {
            let factor = entries[k] / top[k];
            if factor != 0.0 {
                (k..size).for_each(|c| entries[c] -= factor * top[c]);
                right[k + 1 + row] -= factor * right[k];
            }
        }
    }
    for k in (0..size).rev() {
        let rest = (k + 1..size).fold(right[k], |rest, c| rest - matrix[k * size + c] * right[c]);
        right[k] = rest / matrix[k * size + k];
    }
    right.iter().all(|x| x.is_finite())
}
