//! Guesses of faces from reactions inside all sets. Each friction gets a multiplier λ ≥ |u_T|, and the products that the law makes zero are
//! made σ > 0: r_n u_n = σ for a gap, and (R, r_T) ∘ (λ, u_T) = σ e for friction with the limit R, where ∘ is the product of second-order
//! cones. These equations are smooth. Their solutions for smaller and smaller σ are a path to the law, which may break off, since Coulomb's
//! law is not convex; another one then begins elsewhere.

use alloc::vec;
use alloc::vec::Vec;

use super::compliant::eliminate;
use super::{ConeSolver, RowBlock, Set, dot, length, sqrt};

/// Sizes of the reactions that the path begins with, as multiples of the largest rate.
const SIZES: [f64; 3] = [1.0, 100.0, 0.01];
/// Most Newton steps along the path.
const STEPS: usize = 60;
/// Factor by which σ falls until faces are solved again.
const AGAIN: f64 = 1e-2;
/// Mean of r u, as a part of the square of the largest rate, beyond which it is round-off.
const END: f64 = 1e-20;

/// Unknowns beside the reactions.
struct CentralPath {
    /// λ of each block.
    lambda: Vec<f64>,
    /// What stands for u_n of each block, positive along the path.
    slack: Vec<f64>,
    /// Part of the mean of r u that the next step aims at.
    aim: f64,
}

/// PathStep of a Newton step in the changes of r, λ and x: with J, as those with J Jᵀ lose half of the digits where rows nearly depend on
/// one another.
struct PathStep {
    size: usize,
    a: Vec<f64>,
    b: Vec<f64>,
}

/// Largest step up to 1 that keeps |b + s db| ≤ a + s da.
fn to_boundary([a, da]: [f64; 2], b: [f64; 2], db: [f64; 2]) -> f64 {
    // The least positive root of p s² + 2 q s + r.
    let (p, q, r) = (da * da - dot(&db, &db), a * da - dot(&b, &db), a * a - dot(&b, &b));
    let discriminant = q * q - p * r;
    let mut step = 1.0_f64;
    if discriminant >= 0.0 {
        let root = sqrt(discriminant);
        for candidate in [r / (root - q), -r / (root + q)] {
            if candidate > 0.0 {
                step = step.min(candidate);
            }
        }
    }
    if da < 0.0 { step.min(-a / da) } else { step }
}

impl ConeSolver {
    /// Follows the path, and solves the equations of the faces that it comes near.
    pub(super) fn by_interior_points(&mut self) -> bool {
        SIZES.into_iter().any(|size| self.follow(size * self.unit()))
    }

    /// From reactions of this size. Leaves the reactions as they were if the path does not lead to any that satisfy the law.
    fn follow(&mut self, size: f64) -> bool {
        let (before, unit) = (self.r.clone(), self.unit());
        if unit == 0.0 {
            return false;
        }
        let mut path = self.enter(size);
        let mut next = f64::INFINITY;
        for _ in 0..STEPS {
            let mean = self.mean(&path);
            if mean <= next.min(1e-4 * unit * unit) {
                next = mean * AGAIN;
                if self.settle(false) {
                    return true;
                }
            }
            if mean <= END * unit * unit || !self.advance(&mut path, mean) {
                break;
            }
        }
        self.r = before;
        self.refresh();
        false
    }

    /// The limit of a friction that has one, and by how much it grows with the reaction of which row.
    fn positive_limit(&self, k: usize) -> Option<(f64, Option<(usize, f64)>)> {
        let Set::Disc(limit) = self.blocks[k].set else { return None };
        Some(self.limit(&limit)).filter(|(_, gap)| limit.radius > 0.0 || gap.is_some())
    }

    /// Puts all reactions inside their sets.
    fn enter(&mut self, size: f64) -> CentralPath {
        self.r.fill(0.0);
        for block in self.blocks.iter().filter(|block| block.set == Set::HalfLine) {
            self.r[block.first] = size;
        }
        self.clip(None);
        let slack = |block: &RowBlock| self.rate(block.first).max(size);
        let lambda = |k: usize| 1.1 * length(self.two(k, |i| self.rate(i))) + size;
        let (lambda, slack) =
            ((0..self.blocks.len()).map(lambda).collect(), self.blocks.iter().map(slack).collect());
        CentralPath { lambda, slack, aim: 0.3 }
    }

    /// Mean of the products that are σ on the path; zero if there are none.
    fn mean(&self, path: &CentralPath) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for (k, block) in self.blocks.iter().enumerate() {
            if block.set == Set::HalfLine {
                (sum, count) = (sum + self.r[block.first] * path.slack[k], count + 1.0);
            }
            if let Some((limit, _)) = self.positive_limit(k) {
                let power = block.rows().map(|i| self.r[i] * self.rate(i)).sum::<f64>();
                (sum, count) = (sum + limit * path.lambda[k] + power, count + 1.0);
            }
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Takes a step towards a smaller σ. False if it cannot be computed.
    fn advance(&mut self, path: &mut CentralPath, mean: f64) -> bool {
        let mut equations = PathStep::new(self);
        let sigma = path.aim * mean;
        (0..self.blocks.len()).for_each(|k| equations.add_block(self, (k, path), sigma));
        if !eliminate(&mut equations.a, &mut equations.b) {
            return false;
        }
        let (m, count) = (self.m, self.blocks.len());
        let (dr, rest) = equations.b.split_at(m);
        let (dl, dx) = rest.split_at(count);
        let du: Vec<f64> = (0..m).map(|i| dot(self.row(i), dx)).collect();
        let ds: Vec<f64> = (0..count)
            .map(|k| du[self.blocks[k].first] + self.rate(self.blocks[k].first) - path.slack[k])
            .collect();
        let longest = self.longest(path, [dr, dl, &du, &ds]);
        let step = if longest < 1.0 { longest * (1.0 - 0.1 * path.aim.max(0.01)) } else { 1.0 - 1e-3 };
        self.r.iter_mut().zip(dr).for_each(|(r, by)| *r += step * by);
        self.x.iter_mut().zip(dx).for_each(|(x, by)| *x += step * by);
        path.lambda.iter_mut().zip(dl).for_each(|(lambda, by)| *lambda += step * by);
        path.slack.iter_mut().zip(&ds).for_each(|(slack, by)| *slack += step * by);
        path.aim = ((1.0 - step) * (1.0 - step)).clamp(0.02, 0.8);
        true
    }

    /// Longest step up to 1 that stays inside all sets.
    fn longest(&self, path: &CentralPath, [dr, dl, du, ds]: [&[f64]; 4]) -> f64 {
        let mut step = 1.0_f64;
        for (k, block) in self.blocks.iter().enumerate() {
            if block.set == Set::HalfLine {
                for (value, by) in [(self.r[block.first], dr[block.first]), (path.slack[k], ds[k])] {
                    step = if by < 0.0 { step.min(-value / by) } else { step };
                }
            }
            if let Some((limit, gap)) = self.positive_limit(k) {
                let by = gap.map_or(0.0, |(push, mu)| mu * dr[push]);
                let [r, dr] = [self.two(k, |i| self.r[i]), self.two(k, |i| dr[i])];
                let [u, du] = [self.two(k, |i| self.rate(i)), self.two(k, |i| du[i])];
                step = step.min(to_boundary([limit, by], r, dr)).min(to_boundary(
                    [path.lambda[k], dl[k]],
                    u,
                    du,
                ));
            }
        }
        step
    }
}

impl PathStep {
    /// With the rows of dx = Jᵀ dr.
    fn new(solver: &ConeSolver) -> Self {
        let (m, count) = (solver.m, solver.blocks.len());
        let size = m + count + solver.n;
        let mut equations = Self { size, a: vec![0.0; size * size], b: vec![0.0; size] };
        for c in 0..solver.n {
            let row = m + count + c;
            *equations.entry(row, row) = 1.0;
            equations.b[row] = -solver.x[c];
            for i in 0..m {
                *equations.entry(row, i) = -solver.row(i)[c];
                equations.b[row] += solver.row(i)[c] * solver.r[i];
            }
        }
        equations
    }

    fn entry(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.a[row * self.size + column]
    }

    /// Adds a multiple of the change of a rate to a row.
    fn add_rate(&mut self, row: usize, (solver, i): (&ConeSolver, usize), factor: f64) {
        let first = row * self.size + solver.m + solver.blocks.len();
        self.a[first..first + solver.n].iter_mut().zip(solver.row(i)).for_each(|(a, j)| *a += factor * j);
    }

    fn add_block(&mut self, solver: &ConeSolver, (k, path): (usize, &CentralPath), sigma: f64) {
        let block = solver.blocks[k];
        let (r, u, of_lambda) = (&solver.r, |i: usize| solver.rate(i), solver.m + k);
        *self.entry(of_lambda, of_lambda) = 1.0;
        match block.set {
            Set::Line => {
                self.b[block.first] = -u(block.first);
                self.add_rate(block.first, (solver, block.first), 1.0);
                // Where rows depend on one another, reactions of equality constraints have to be determined all the same.
                *self.entry(block.first, block.first) += 1e-14;
            }
            Set::HalfLine => {
                let i = block.first;
                self.b[i] = sigma - r[i] * u(i);
                self.add_rate(i, (solver, i), r[i]);
                *self.entry(i, i) += path.slack[k];
            }
            Set::Ray { force, gap } => {
                let push = solver.blocks[gap].first;
                for (i, force) in block.rows().zip(force) {
                    self.b[i] = force * r[push] - r[i];
                    *self.entry(i, i) = 1.0;
                    *self.entry(i, push) -= force;
                }
            }
            Set::Disc(_) => self.add_friction(solver, (k, path.lambda[k]), sigma),
        }
    }

    fn add_friction(&mut self, solver: &ConeSolver, (k, lambda): (usize, f64), sigma: f64) {
        let (block, r, of_lambda) = (solver.blocks[k], &solver.r, solver.m + k);
        let Some((limit, gap)) = solver.positive_limit(k) else {
            for i in block.rows() {
                self.b[i] = -r[i];
                *self.entry(i, i) = 1.0;
            }
            return;
        };
        self.b[of_lambda] = sigma - limit * lambda;
        *self.entry(of_lambda, of_lambda) = limit;
        for i in block.rows() {
            let u = solver.rate(i);
            self.b[of_lambda] -= r[i] * u;
            *self.entry(of_lambda, i) += u;
            self.add_rate(of_lambda, (solver, i), r[i]);
            self.b[i] = -(limit * u + lambda * r[i]);
            self.add_rate(i, (solver, i), limit);
            *self.entry(i, i) += lambda;
            *self.entry(i, of_lambda) += r[i];
            gap.into_iter().for_each(|(push, mu)| *self.entry(i, push) += mu * u);
        }
        gap.into_iter().for_each(|(push, mu)| *self.entry(of_lambda, push) += mu * lambda);
    }
}
