//! From guessed faces to reactions that satisfy the law.
//!
//! On given faces the law is a set of equations: rates that stay zero, and friction at its limit. They are solved in the space of
//! velocities, by a QR decomposition of the rows that stay still: its condition is that of J, and not that of J Jᵀ, which leaves eight more
//! digits in a wedge. Where rows depend on one another, Σ y J = 0, reactions are shared as springs of equal compliance would,
//! Σ y g r = 0, or else as near as can be to those so far.

use alloc::vec;
use alloc::vec::Vec;

use super::limits::ACCURACY;
use super::{ConeSolver, Face, Limit, RowBlock, Set};
use crate::number::limits::HALF_THE_DIGITS;
use crate::number::limits::ITERATIONS;
use crate::numerics::bare::{dot, length, sqrt};
use crate::numerics::least_norm::PivotedQr;

/// What the equations of faces lead to.
enum OnFaces {
    Singular,
    /// Reactions that satisfy the law.
    Lawful,
    /// Others, which lie on these faces.
    Leads(Vec<Face>),
}

fn add_multiple(sum: &mut [f64], of: &[f64], factor: f64) {
    sum.iter_mut().zip(of).for_each(|(sum, x)| *sum += factor * x);
}

/// The equations of faces.
struct FaceEquations {
    /// Rows whose reactions are unknown, and what each of these changes velocities by.
    unknowns: Vec<usize>,
    columns: Vec<Vec<f64>>,
    /// Place of each row among the unknowns.
    places: Vec<usize>,
    /// Rows whose rates stay zero, and their span.
    still: Vec<usize>,
    span: PivotedQr,
    /// Coefficients, for each row, of the sums that shared reactions make zero.
    shares: Vec<Vec<f64>>,
    /// Blocks whose friction is at its limit, with its direction.
    limits: Vec<(usize, [f64; 2])>,
    /// Number of equations, and the matrix by columns of those that do not change in a step.
    height: usize,
    fixed: Vec<f64>,
}

impl FaceEquations {
    fn new(solver: &ConeSolver, faces: &[Face], with_shares: bool) -> Self {
        let (mut unknowns, mut columns, mut still, mut limits) =
            (vec![], Vec::<Vec<f64>>::new(), vec![], vec![]);
        for (k, (&face, block)) in faces.iter().zip(&solver.blocks).enumerate() {
            let stays = match (block.set, face) {
                (_, Face::Open) => continue,
                (Set::Ray { force, gap }, _) => {
                    let gap = unknowns.iter().position(|&i| i == solver.blocks[gap].first);
                    let Some(column) = gap.map(|place| &mut columns[place]) else { continue };
                    for (i, force) in block.rows().zip(force) {
                        add_multiple(column, solver.row(i), force);
                    }
                    continue;
                }
                (_, Face::Slide(direction)) => {
                    limits.push((k, direction));
                    0
                }
                (_, Face::Stick) => block.count,
            };
            still.extend(block.rows().take(stays));
            unknowns.extend(block.rows());
            columns.extend(block.rows().map(|i| solver.row(i).to_vec()));
        }
        let rows = still.iter().flat_map(|&i| solver.row(i).iter().copied()).collect();
        let span = PivotedQr::new(rows, [solver.n, still.len()], ACCURACY);
        let compliance = solver.compliance();
        let share = |y: Vec<f64>| {
            let mut all = vec![0.0; solver.m];
            still.iter().zip(y).for_each(|(&i, y)| all[i] = y * compliance[i]);
            all
        };
        let shares: Vec<_> = if with_shares { span.null() } else { vec![] }.into_iter().map(share).collect();
        let mut places = vec![usize::MAX; solver.m];
        unknowns.iter().enumerate().for_each(|(place, &i)| places[i] = place);
        let of_limits: usize = limits.iter().map(|&(k, _)| solver.blocks[k].count).sum();
        let height = span.rank + shares.len() + of_limits;
        let mut fixed = vec![0.0; height * unknowns.len()];
        for ((&i, column), to) in unknowns.iter().zip(&columns).zip(fixed.chunks_exact_mut(height.max(1))) {
            to[..span.rank].copy_from_slice(&span.components(column));
            shares.iter().zip(&mut to[span.rank..]).for_each(|(share, to)| *to = share[i]);
        }
        Self { unknowns, columns, places, still, span, shares, limits, height, fixed }
    }

    /// x of these reactions.
    fn combine(&self, r: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        for (&i, column) in self.unknowns.iter().zip(&self.columns) {
            add_multiple(x, column, r[i]);
        }
    }

    /// The equations of a Newton step: matrix by columns, and right-hand side. The third is true if no step changes them.
    fn linearized(&self, solver: &ConeSolver) -> (Vec<f64>, Vec<f64>, bool) {
        let rates: Vec<f64> = self.still.iter().map(|&i| solver.rate(i)).collect();
        let mut right: Vec<f64> = self.span.coordinates(&rates).iter().map(|x| -x).collect();
        right.extend(self.shares.iter().map(|share| -dot(share, &solver.r)));
        let (mut matrix, mut is_linear) = (self.fixed.clone(), true);
        for &(k, known) in &self.limits {
            let (block, g) = (solver.blocks[k], solver.responses[k]);
            let Set::Disc(limit) = block.set else { continue };
            let (limit, gap) = solver.limit(&limit);
            let (mut direction, mut turn) = (known, 0.0);
            if block.count == 2 {
                is_linear = false;
                let (pulled, far) = (solver.pulled(k), length(solver.pulled(k)));
                if far > 0.0 {
                    (direction, turn) = (pulled.map(|x| x / far), limit / far);
                }
            }
            for (c, i) in block.rows().enumerate() {
                let row = right.len();
                right.push(limit * direction[c] - solver.r[i]);
                let mut add = |place: usize, by: f64| matrix[place * self.height + row] += by;
                add(self.places[i], 1.0);
                let pressed = gap.filter(|(push, _)| self.places[*push] != usize::MAX);
                pressed.into_iter().for_each(|(push, mu)| add(self.places[push], -mu * direction[c]));
                for (d, l) in block.rows().enumerate() {
                    let across = turn * (f64::from(u8::from(c == d)) - direction[c] * direction[d]);
                    if across != 0.0 {
                        add(self.places[l], -across);
                        let response = |column: &Vec<f64>| across / g * dot(solver.row(l), column);
                        self.columns.iter().enumerate().for_each(|(at, column)| add(at, response(column)));
                    }
                }
            }
        }
        (matrix, right, is_linear)
    }
}

impl ConeSolver {
    /// From the faces of the reactions so far to reactions that satisfy the law.
    pub(super) fn settle(&mut self, with_shares: bool) -> bool {
        self.settle_from(self.faces(), with_shares, true)
    }

    /// Changes all blocks that disagree with their faces until faces come again; then, with patience, the one that disagrees most. Leaves the
    /// reactions as they were if none are found that satisfy the law.
    pub(super) fn settle_from(
        &mut self,
        mut faces: Vec<Face>,
        with_shares: bool,
        has_patience: bool,
    ) -> bool {
        let (before, mut seen, mut is_patient) = (self.r.clone(), Vec::<Vec<u8>>::new(), false);
        for _ in 0..ITERATIONS {
            let next = match self.solve_on(&faces, with_shares, is_patient) {
                OnFaces::Singular => break,
                OnFaces::Lawful => return true,
                OnFaces::Leads(next) => next,
            };
            let [was, is] = [&faces, &next].map(|faces| self.kinds(faces));
            let differs: Vec<usize> = (0..faces.len()).filter(|&k| was[k] != is[k]).collect();
            if differs.is_empty() {
                break;
            }
            if seen.contains(&was) {
                if is_patient || !has_patience {
                    break;
                }
                is_patient = true;
                seen.clear();
            }
            seen.push(was);
            if is_patient {
                let worst = self.worst(&differs);
                (0..faces.len()).filter(|&k| self.pressing(k) == worst).for_each(|k| faces[k] = next[k]);
            } else {
                faces = next;
            }
        }
        self.r = before;
        self.refresh();
        false
    }

    /// The group of blocks that is furthest from its natural reactions, of those of these blocks.
    fn worst(&self, differs: &[usize]) -> usize {
        let defect = |of: usize| {
            (0..self.blocks.len()).filter(|&k| self.pressing(k) == of).map(|k| self.defect(k)).sum::<f64>()
        };
        let groups = differs.iter().map(|&k| self.pressing(k));
        groups.max_by(|&one, &other| defect(one).total_cmp(&defect(other))).unwrap_or(0)
    }

    /// The gap that presses a friction, or the block itself: they change their faces together.
    pub(super) fn pressing(&self, k: usize) -> usize {
        match self.blocks[k].set {
            Set::Ray { gap, .. } | Set::Disc(Limit { gap: Some(gap), .. }) => gap,
            _ => k,
        }
    }

    /// Faces with none for friction whose gap is open, unless it has a limit of its own.
    pub(super) fn without_idle(&self, faces: &[Face]) -> Vec<Face> {
        let of = |k: usize| match self.blocks[k].set {
            Set::Disc(Limit { radius, .. }) if radius > 0.0 => faces[k],
            _ if faces[self.pressing(k)] == Face::Open => Face::Open,
            _ => faces[k],
        };
        (0..faces.len()).map(of).collect()
    }

    /// Whether reactions on these faces satisfy the law.
    pub(super) fn obeys_on(&mut self, faces: &[Face], with_shares: bool) -> bool {
        matches!(self.solve_on(faces, with_shares, true), OnFaces::Lawful)
    }

    /// Whether the reactions satisfy the law once round-off has been taken off those that have left their sets.
    fn obeys_clipped(&mut self, faces: &[Face]) -> bool {
        let x = self.x.clone();
        self.clip(Some(faces));
        self.x = x;
        self.obeys()
    }

    /// Solves the equations of faces, with shared reactions or with those nearest to the reactions so far. An impatient call gives up after a
    /// step that leaves the faces, unless it is a tie.
    fn solve_on(&mut self, given: &[Face], with_shares: bool, is_patient: bool) -> OnFaces {
        self.solved += 1;
        let faces = &self.without_idle(given)[..];
        let equations = FaceEquations::new(self, faces, with_shares);
        let size = equations.unknowns.len();
        (0..self.m).filter(|&i| equations.places[i] == usize::MAX).for_each(|i| self.r[i] = 0.0);
        let (mut solver, mut before, mut next) = (None, f64::INFINITY, vec![]);
        // A step that gains less than a bit does not lead to a solution nearby.
        for step in 0..f64::MANTISSA_DIGITS {
            equations.combine(&self.r, &mut self.x);
            let (matrix, right, is_linear) = equations.linearized(self);
            if solver.is_none() || !is_linear {
                solver = Some(PivotedQr::new(matrix, [equations.height, size], ACCURACY));
            }
            let change = solver.as_ref().map_or_else(Vec::new, |solver| solver.least_norm(&right));
            let norm = sqrt(dot(&change, &change));
            if !norm.is_finite() {
                return OnFaces::Singular;
            }
            equations.unknowns.iter().zip(&change).for_each(|(&i, by)| self.r[i] += by);
            if step == 0 {
                let r = self.r.clone();
                self.clip(Some(faces));
                next = self.faces();
                let is_tie = self.defects() <= f64::EPSILON * dot(&self.r, &self.r);
                if !is_patient && !is_tie && self.kinds(faces) != self.kinds(&next) {
                    return OnFaces::Leads(next);
                }
                self.r = r;
            }
            let all = sqrt(equations.unknowns.iter().fold(0.0, |sum, &i| sum + self.r[i] * self.r[i]));
            let has_stalled = norm <= HALF_THE_DIGITS * all && norm >= 0.5 * before;
            if has_stalled || (is_linear && step == 1) {
                break;
            }
            before = norm;
        }
        self.stop(&equations);
        if self.obeys_clipped(given) {
            return OnFaces::Lawful;
        }
        self.refresh();
        OnFaces::Leads(if is_patient { self.faces() } else { next })
    }

    /// Takes the last bits of the rates that stay zero: velocities are better known than large reactions.
    fn stop(&mut self, equations: &FaceEquations) {
        equations.combine(&self.r, &mut self.x);
        for _ in 0..2 {
            let rates: Vec<f64> = equations.still.iter().map(|&i| self.rate(i)).collect();
            let by = equations.span.combination(&equations.span.coordinates(&rates));
            self.x.iter_mut().zip(by).for_each(|(x, by)| *x -= by);
        }
    }

    /// Faces without the directions of friction along two velocities.
    fn kinds(&self, faces: &[Face]) -> Vec<u8> {
        let kind = |(face, block): (&Face, &RowBlock)| match face {
            Face::Open => 0,
            Face::Stick => 1,
            Face::Slide([x, _]) => 2 + u8::from(*x > 0.0 && block.count == 1),
        };
        faces.iter().zip(&self.blocks).map(kind).collect()
    }
}
