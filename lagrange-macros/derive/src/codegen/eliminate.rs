//! Solves the equations of motion at compile time, by an unrolled sparse elimination.
//!
//! The [form](Form) ½ xᵀHx − bᵀx is reduced variable by variable: a free variable is eliminated, M = L D Lᵀ, and a
//! defined one is substituted. The Schur complement S = F M⁻¹ Fᵀ = Z D⁻¹ Zᵀ with Z = F L⁻ᵀ is then factorized as S =
//! L D Lᵀ. Structural zeros generate no code, and both factorizations use an order with little fill-in. (Golub and Van Loan,
//! *Matrix Computations*, 4.1.2; Nocedal and Wright, *Numerical Optimization*, 16.2.) One LDLᵀ of the whole indefinite
//! matrix would need pivoting at run time, except for the kinematic loops in [`loops`].

mod arithmetic;
mod loops;
mod order;
mod pivot;
mod reduce;
mod schur;

use indexmap::IndexSet;

use super::count::OPERATION_LIMIT;
use super::operation::{Operation, Register};
use super::schedule::Schedule;
use crate::mechanics::{Form, LinearEquations};
use crate::symbolic::Id;
use crate::variables::Variable;
use arithmetic::{Solver, Sparse, SparseEntry};
use order::{Pattern, reduction_order};
use reduce::FormFactors;

/// Maximum number of operations of an elimination in straight-line code, even if the matrix is dense.
const UNROLLED: usize = 2_500;
/// Longer code is emitted only if dense loops over arrays take at least this many times as many operations. Otherwise
/// they are as fast, and spare rustc the code.
const SPARSE: usize = 4;

/// Registers of the solution.
pub(super) struct Solved {
    pub(super) accelerations: Vec<Register>,
    pub(super) multipliers: Vec<Register>,
    /// See `Solution::pivot` of the runtime.
    pub(super) pivot: Register,
}

/// Factorization of the KKT matrix, which has M and −Fᵀ above F and 0.
pub(super) struct Factorization {
    form: FormFactors,
    /// Number of multipliers that are variables of the form: all or none.
    among: usize,
    /// Rows of Z = F L⁻ᵀ for the multipliers that are not variables of the form.
    rows: Vec<Sparse>,
    schur: FormFactors,
    /// Rows σ_a F_a of the constraints a that complete M. A solve subtracts γ_a times this row from h.
    completing: Vec<(usize, Sparse)>,
    check: PivotCheck,
}

/// Run-time check of the accuracy of a factorization.
#[derive(Clone, Copy)]
struct PivotCheck {
    pivot: Register,
    /// Zero, or NaN if the factorization is unreliable; `None` if it always is reliable.
    doubt: Option<Register>,
}

/// Appends the elimination to a schedule that computes the entries of the form, F and γ. `None` if it would be too
/// long.
pub(super) fn eliminate(schedule: &mut Schedule, form: &Form, equations: &LinearEquations) -> Option<Solved> {
    let mut solver = Solver::new(schedule);
    let factorization = solver.factorize(form, equations)?;
    let bias = solver.entries(&equations.bias);
    let starts = solver.starts(form, &factorization, &bias);
    let found = solver.solve(&factorization, starts, bias);
    Some(solver.finish(found, equations.coordinates, factorization.check.pivot))
}

/// Appends the factorization to a schedule that computes the entries of the form, F and σ. Also returns the registers
/// that a solve reads.
pub(super) fn factor(
    schedule: &mut Schedule,
    form: &Form,
    equations: &LinearEquations,
) -> Option<(Factorization, IndexSet<Register>)> {
    let mut solver = Solver::new(schedule);
    let factorization = solver.factorize(form, equations)?;
    let mut numbers: IndexSet<Register> = factorization.registers().collect();
    numbers.retain(|&number| !schedule.is_constant(number));
    Some((factorization, numbers))
}

/// Appends the solve to an empty schedule. Its inputs are the numbers of the factorization, h and γ.
pub(super) fn solve_with(
    schedule: &mut Schedule,
    source: &Schedule,
    (factorization, numbers): &(Factorization, IndexSet<Register>),
    equations: &LinearEquations,
) -> Solved {
    let factorization = factorization.with_registers(|register| {
        let number = numbers.get_index_of(&register).map(|k| Operation::Input(Variable::Factor(k).symbol()));
        schedule.push(number.unwrap_or(source.operations[register.index()]))
    });
    let mut input = |variable: Variable| Some(schedule.push(Operation::Input(variable.symbol())));
    let (n, m) = (equations.coordinates, equations.bias.len());
    let forcing: Vec<SparseEntry> = (0..n).map(|i| input(Variable::Forcing(i))).collect();
    let bias: Vec<SparseEntry> = (0..m).map(|a| input(Variable::Bias(a))).collect();
    let mut solver = Solver::new(schedule);
    let mut forcing = solver.completed(&factorization, forcing, &bias);
    forcing.extend_from_slice(&bias[..factorization.among]);
    forcing.resize(factorization.form.reciprocals.len(), None);
    let forward = solver.forward(&factorization.form, forcing);
    let starts = solver.scaled(&factorization.form, forward);
    let found = solver.solve(&factorization, starts, bias);
    solver.finish(found, n, factorization.check.pivot)
}

impl Factorization {
    /// Returns all registers of the factorization.
    fn registers(&self) -> impl Iterator<Item = Register> {
        let completing = self.completing.iter().map(|(_, row)| row);
        let rows = self.rows.iter().chain(completing).flatten();
        let rows = rows.map(|&(_, entry)| entry);
        let check = [Some(self.check.pivot), self.check.doubt].into_iter().flatten();
        check.chain(self.form.registers()).chain(rows).chain(self.schur.registers())
    }

    fn with_registers(&self, mut new: impl FnMut(Register) -> Register) -> Self {
        let form = self.form.with_registers(&mut new);
        let schur = self.schur.with_registers(&mut new);
        let mut row = |row: &Sparse| row.iter().map(|&(i, entry)| (i, new(entry))).collect();
        let rows = self.rows.iter().map(&mut row).collect();
        let completing = self.completing.iter().map(|(a, weighted)| (*a, row(weighted))).collect();
        let PivotCheck { pivot, doubt } = self.check;
        let check = PivotCheck { pivot: new(pivot), doubt: doubt.map(new) };
        Self { form, among: self.among, rows, schur, completing, check }
    }
}

fn pattern(matrix: &[Vec<Id>]) -> Vec<Vec<bool>> {
    matrix.iter().map(|row| row.iter().map(|&id| id != Id::ZERO).collect()).collect()
}

/// Elimination order, and the number of multipliers that it contains.
fn order(form: &Form, equations: &LinearEquations) -> Option<(Vec<usize>, usize)> {
    let (matrix, rows) = (pattern(&form.matrix), pattern(&equations.jacobian));
    if form.definitions.is_empty()
        && let Some(order) = loops::order(&matrix, &rows)
    {
        return Some((order, rows.len()));
    }
    let definitions = form.definitions.iter().map(|row| row.iter().map(|&(i, _)| i).collect()).collect();
    Some((short(&Pattern { matrix, definitions, after: Vec::new() })?, 0))
}

/// Elimination order. `None` if loops are preferable, or if the code exceeds [`OPERATION_LIMIT`].
fn short(pattern: &Pattern) -> Option<Vec<usize>> {
    let (order, cost) = reduction_order(pattern);
    let free = pattern.matrix.len() - pattern.definitions.len();
    let in_loops = free * free * free / 3;
    let is_worth_it = cost <= UNROLLED || SPARSE * cost <= in_loops || !pattern.definitions.is_empty();
    (is_worth_it && cost <= OPERATION_LIMIT).then_some(order)
}

/// Registers of the accelerations and multipliers that a solve computes.
struct Found {
    accelerations: Vec<SparseEntry>,
    multipliers: Vec<SparseEntry>,
}

impl Solver<'_> {
    fn factorize(&mut self, form: &Form, equations: &LinearEquations) -> Option<Factorization> {
        let (order, among) = order(form, equations)?;
        let mut matrix: Vec<Vec<SparseEntry>> = form.matrix.iter().map(|row| self.entries(row)).collect();
        if among > 0 {
            self.put_among(&mut matrix, equations);
        }
        let definitions = form.definitions.iter().map(|row| self.sparse_entries(row)).collect();
        let reduced = self.factor(matrix, definitions, &order, among);
        let written = form.rows.as_ref().unwrap_or(&equations.jacobian);
        let rows = if among > 0 { Vec::new() } else { self.rows(written, &reduced) };
        let schur = self.schur_factors(&reduced, &rows)?;
        let completing = self.completing(form, equations);
        let check = self.pivot_check(!equations.jacobian.is_empty());
        Some(Factorization { form: reduced, among, rows, schur, completing, check })
    }

    /// Appends −Fᵀ to the right of a matrix, and −F below it.
    fn put_among(&mut self, matrix: &mut Vec<Vec<SparseEntry>>, equations: &LinearEquations) {
        let (n, jacobian) = (matrix.len(), &equations.jacobian);
        for row in jacobian {
            let mut below = self.entries(row);
            below.iter_mut().for_each(|entry| *entry = self.negate(*entry));
            matrix.iter_mut().zip(&below).for_each(|(row, &entry)| row.push(entry));
            matrix.push(below);
        }
        matrix[n..].iter_mut().for_each(|row| row.resize(n + jacobian.len(), None));
    }

    /// Rows σ_a F_a of the constraints that complete M.
    fn completing(&mut self, form: &Form, equations: &LinearEquations) -> Vec<(usize, Sparse)> {
        let weighted = form.completing.iter().map(|&(a, weight)| {
            let (weight, row) = (self.entry(weight), self.entries(&equations.jacobian[a]));
            let row: Vec<SparseEntry> = row.into_iter().map(|entry| self.multiply(weight, entry)).collect();
            (a, arithmetic::sparse(&row))
        });
        weighted.collect()
    }

    /// h − Fᵀσγ
    fn completed(
        &mut self,
        factorization: &Factorization,
        mut h: Vec<SparseEntry>,
        bias: &[SparseEntry],
    ) -> Vec<SparseEntry> {
        for (a, row) in &factorization.completing {
            for &(i, entry) in row {
                let part = self.multiply(Some(entry), bias[*a]);
                h[i] = self.subtract(h[i], part);
            }
        }
        h
    }

    /// D⁻¹L⁻¹b, the start of back-substitution. For an uncoupled variable it is b_i/H_ii, a quotient that the
    /// graph may have simplified.
    fn starts(
        &mut self,
        form: &Form,
        factorization: &Factorization,
        bias: &[SparseEntry],
    ) -> Vec<SparseEntry> {
        let mut linear = self.entries(&form.linear);
        linear.extend_from_slice(&bias[..factorization.among]);
        let linear = self.forward(&factorization.form, linear);
        let starts = self.scaled(&factorization.form, linear);
        if factorization.among > 0 {
            return starts;
        }
        let divided = starts.into_iter().zip(&form.alone);
        divided.map(|(start, alone)| alone.map_or(start, |quotient| self.entry(quotient))).collect()
    }

    /// D⁻¹x
    fn scaled(&mut self, factors: &FormFactors, x: Vec<SparseEntry>) -> Vec<SparseEntry> {
        x.into_iter().zip(&factors.reciprocals).map(|(x, &reciprocal)| self.multiply(x, reciprocal)).collect()
    }

    /// F L⁻ᵀ
    fn rows(&mut self, rows: &[Vec<Id>], factors: &FormFactors) -> Vec<Sparse> {
        let row = |row: &Vec<Id>| {
            let mut row = self.entries(row);
            row.resize(factors.reciprocals.len(), None);
            arithmetic::sparse(&self.forward(factors, row))
        };
        rows.iter().map(row).collect()
    }

    /// Computes the variables from D⁻¹L⁻¹b and γ.
    fn solve(
        &mut self,
        factorization: &Factorization,
        starts: Vec<SparseEntry>,
        bias: Vec<SparseEntry>,
    ) -> Found {
        let Factorization { form, among, rows, schur, check: PivotCheck { doubt, .. }, .. } = factorization;
        let multipliers = self.multipliers(schur, &starts, rows, bias);
        // Add `doubt` (zero or NaN) to the finished multipliers. It is known late, and adding it earlier
        // would delay every multiplier that depends on another.
        let mut multipliers: Vec<SparseEntry> =
            multipliers.into_iter().map(|one| self.add(one, *doubt)).collect();
        let pushes = self.pushes(&multipliers, rows, starts.len());
        let mut accelerations = self.backward(form, starts, &pushes, *doubt);
        multipliers.extend(accelerations.split_off(accelerations.len() - among));
        Found { accelerations, multipliers }
    }

    /// Zᵀλ
    fn pushes(&mut self, multipliers: &[SparseEntry], rows: &[Sparse], size: usize) -> Vec<SparseEntry> {
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
