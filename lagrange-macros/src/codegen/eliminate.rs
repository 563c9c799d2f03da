//! The equations of motion solved at compile time: an unrolled sparse elimination.
//!
//! The [form](Form) ½ xᵀHx − bᵀx is reduced variable by variable: a free one is eliminated, M = L D Lᵀ, and a
//! defined one is put in. Then the Schur complement S = F M⁻¹ Fᵀ = Z D⁻¹ Zᵀ with Z = F L⁻ᵀ, and S = L D Lᵀ in its
//! turn. Every structural zero is gone, and both factorizations go in an order of little fill. (Golub and Van Loan,
//! *Matrix Computations*, 4.1.2; Nocedal and Wright, *Numerical Optimization*, 16.2. One LDLᵀ of the whole indefinite
//! matrix would need pivots that only run time can choose.)

mod arithmetic;
mod order;
mod pivot;
mod reduce;
mod schur;

use super::kernel::OPERATION_LIMIT;
use super::operation::Register;
use super::schedule::Schedule;
use crate::mechanics::{Equations, Form};
use crate::symbolic::Id;
use arithmetic::{Entry, Solver, Sparse};
use order::{Pattern, reduction_order};
use reduce::Factors;

/// Up to as many operations a matrix is reduced in straight-line code, full as it may be.
const UNROLLED: usize = 2_500;
/// Beyond, loops over arrays are as fast, and rustc does not have to read it all, unless they would do so many times as
/// much.
const SPARSE: usize = 4;

/// Where the results are.
pub(super) struct Solved {
    pub(super) accelerations: Vec<Register>,
    pub(super) multipliers: Vec<Register>,
    /// See `Solution::pivot` of the runtime.
    pub(super) pivot: Register,
}

/// Appends the elimination to a schedule that computes the entries of the form, F and γ; `None` where it would be
/// too long.
pub(super) fn eliminate(schedule: &mut Schedule, form: &Form, equations: &Equations) -> Option<Solved> {
    let order = order(form)?;
    let mut solver = Solver { schedule, growth: Vec::new(), plain: Vec::new(), reciprocals: Vec::new() };
    let matrix = form.matrix.iter().map(|row| solver.entries(row)).collect();
    let definitions = form.definitions.iter().map(|row| solver.sparse_entries(row)).collect();
    let factors = solver.factor(matrix, definitions, &order);
    let starts = solver.starts(form, &factors);
    let rows = solver.rows(equations, &factors, starts.len());
    let multipliers = solver.multipliers(&factors, &starts, &rows, equations)?;
    let pushes = solver.pushes(&multipliers, &rows, starts.len());
    let mut accelerations = solver.backward(&factors, starts, &pushes);
    accelerations.truncate(equations.forcing.len());
    Some(solver.finish(accelerations, multipliers, &pushes))
}

fn order(form: &Form) -> Option<Vec<usize>> {
    let matrix = form.matrix.iter().map(|row| row.iter().map(|&id| id != Id::ZERO).collect()).collect();
    let definitions = form.definitions.iter().map(|row| row.iter().map(|&(i, _)| i).collect()).collect();
    short(&Pattern { matrix, definitions })
}

/// The order of a reduction that is better not left to loops, and not longer than a function may be.
fn short(pattern: &Pattern) -> Option<Vec<usize>> {
    let (order, cost) = reduction_order(pattern);
    let free = pattern.matrix.len() - pattern.definitions.len();
    let in_loops = free * free * free / 3;
    let is_worth_it = cost <= UNROLLED || SPARSE * cost <= in_loops;
    (is_worth_it && cost <= OPERATION_LIMIT).then_some(order)
}

impl Solver<'_> {
    /// D⁻¹L⁻¹b. What is tied to nothing is divided in the graph, where it may cancel.
    fn starts(&mut self, form: &Form, factors: &Factors) -> Vec<Entry> {
        let linear = self.entries(&form.linear);
        let linear = self.forward(factors, linear);
        let starts = linear.into_iter().zip(&factors.reciprocals).zip(&form.alone);
        starts
            .map(|((entry, &reciprocal), alone)| match alone {
                Some(quotient) => self.entry(*quotient),
                None => self.multiply(entry, reciprocal),
            })
            .collect()
    }

    /// Z = F L⁻ᵀ
    fn rows(&mut self, equations: &Equations, factors: &Factors, size: usize) -> Vec<Sparse> {
        let row = |row: &Vec<Id>| {
            let mut row = self.entries(row);
            row.resize(size, None);
            arithmetic::sparse(&self.forward(factors, row))
        };
        equations.jacobian.iter().map(row).collect()
    }

    /// Zᵀλ
    fn pushes(&mut self, multipliers: &[Entry], rows: &[Sparse], size: usize) -> Vec<Entry> {
        let mut pushes = vec![None; size];
        for (&multiplier, row) in multipliers.iter().zip(rows) {
            for &(i, z) in row {
                let part = self.multiply(multiplier, Some(z));
                pushes[i] = self.add(pushes[i], part);
            }
        }
        pushes
    }
}
