//! The equations of motion solved at compile time: an unrolled sparse elimination.
//!
//! M = L D Lᵀ, then the Schur complement S = F M⁻¹ Fᵀ = Z D⁻¹ Zᵀ with Z = F L⁻ᵀ, and S = L D Lᵀ in its turn. Every
//! structural zero is gone, and both factorizations go in an order of little fill. (Golub and Van Loan, *Matrix
//! Computations*, 4.1.2; Nocedal and Wright, *Numerical Optimization*, 16.2. One LDLᵀ of the whole indefinite
//! matrix would need pivots that only run time can choose.)

mod order;

use super::schedule::{Operation, Register, Schedule};
use crate::mechanics::Equations;
use crate::symbolic::Id;
use order::{elimination_order, permuted, reordered, restored};

/// A number, unless it is known to be zero.
type Entry = Option<Register>;
/// The entries that are not zero, by index.
type Sparse = Vec<(usize, Register)>;

/// Beyond as many operations loops over arrays are as fast, and rustc does not have to read them all.
const UNROLLED: usize = 2_500;

/// Where the results are.
pub(super) struct Solved {
    pub(super) accelerations: Vec<Register>,
    pub(super) multipliers: Vec<Register>,
    /// See `Solution::pivot` of the runtime.
    pub(super) pivot: Register,
}

/// Appends the elimination to a schedule that computes M, h, F and γ; `None` where it would be too long.
pub(super) fn eliminate(schedule: &mut Schedule, equations: &Equations) -> Option<Solved> {
    let (order, cost) = elimination_order(&pattern(&equations.mass));
    if cost > UNROLLED {
        return None;
    }
    let mut solver = Solver { schedule, growth: Vec::new() };
    let mass = equations.mass.iter().map(|row| solver.entries(row)).collect();
    let factors = solver.factor(permuted(mass, &order));
    let forcing = solver.entries(&equations.forcing);
    let forcing = solver.forward(&factors, reordered(forcing, &order));
    let rows: Vec<Sparse> = equations
        .jacobian
        .iter()
        .map(|row| {
            let row = solver.entries(row);
            sparse(&solver.forward(&factors, reordered(row, &order)))
        })
        .collect();
    let multipliers = solver.multipliers(&factors, &forcing, &rows, equations)?;
    let mut push = forcing;
    for (&multiplier, row) in multipliers.iter().zip(&rows) {
        for &(i, z) in row {
            let part = solver.multiply(multiplier, Some(z));
            push[i] = solver.add(push[i], part);
        }
    }
    let push = solver.scale(&factors, &push);
    let accelerations = restored(solver.backward(&factors, push), &order);
    Some(solver.finish(accelerations, multipliers))
}

fn pattern(rows: &[Vec<Id>]) -> Vec<Vec<bool>> {
    rows.iter().map(|row| row.iter().map(|&id| id != Id::ZERO).collect()).collect()
}

fn sparse(x: &[Entry]) -> Sparse {
    x.iter().enumerate().filter_map(|(i, entry)| entry.map(|entry| (i, entry))).collect()
}

/// L by rows and by columns, without the diagonal, and 1/D.
struct Factors {
    rows: Vec<Sparse>,
    columns: Vec<Sparse>,
    reciprocal: Vec<Register>,
}

/// Arithmetic that knows zeros and ones.
struct Solver<'s> {
    schedule: &'s mut Schedule,
    /// For each pivot that differs from the diagonal entry it came from, that entry over the pivot.
    growth: Vec<Register>,
}

impl Solver<'_> {
    fn entries(&self, ids: &[Id]) -> Vec<Entry> {
        ids.iter().map(|&id| (id != Id::ZERO).then(|| self.schedule.register(id))).collect()
    }

    fn add(&mut self, x: Entry, y: Entry) -> Entry {
        match (x, y) {
            (Some(x), Some(y)) => Some(self.schedule.push(Operation::Add(x, y))),
            (x, y) => x.or(y),
        }
    }

    fn subtract(&mut self, x: Entry, y: Entry) -> Entry {
        match (x, y) {
            (Some(x), Some(y)) => Some(self.schedule.push(Operation::Subtract(x, y))),
            (None, y) => self.negate(y),
            (x, None) => x,
        }
    }

    fn negate(&mut self, x: Entry) -> Entry {
        x.map(|x| self.schedule.push(Operation::Negate(x)))
    }

    fn multiply(&mut self, x: Entry, y: Entry) -> Entry {
        let one = self.schedule.constant(1.0);
        match (x?, y?) {
            (x, y) if x == one => Some(y),
            (x, y) if y == one => Some(x),
            (x, y) => Some(self.schedule.push(Operation::Multiply(x, y))),
        }
    }

    /// Σ x_i y_i
    fn dot(&mut self, x: &Sparse, y: &[Entry]) -> Entry {
        x.iter().fold(None, |sum, &(i, x)| {
            let part = self.multiply(Some(x), y[i]);
            self.add(sum, part)
        })
    }

    /// L D Lᵀ of a symmetric matrix, of which the lower triangle is read.
    fn factor(&mut self, mut a: Vec<Vec<Entry>>) -> Factors {
        let n = a.len();
        let diagonal: Vec<Entry> = (0..n).map(|i| a[i][i]).collect();
        let one = self.schedule.constant(1.0);
        let mut factors = Factors { rows: vec![Vec::new(); n], columns: Vec::new(), reciprocal: Vec::new() };
        for j in 0..n {
            // A diagonal that is known to be zero is a pivot of zero, which shows at run time.
            let pivot = self.known(a[j][j]);
            let reciprocal = self.schedule.push(Operation::Divide(one, pivot));
            self.note_growth(diagonal[j], pivot, reciprocal);
            let column: Sparse = (j + 1..n).filter_map(|i| a[i][j].map(|entry| (i, entry))).collect();
            let mut scaled = Sparse::new();
            for &(i, entry) in &column {
                let Some(l) = self.multiply(Some(entry), Some(reciprocal)) else { continue };
                for &(k, other) in column.iter().take_while(|(k, _)| *k <= i) {
                    let part = self.multiply(Some(l), Some(other));
                    a[i][k] = self.subtract(a[i][k], part);
                }
                factors.rows[i].push((j, l));
                scaled.push((i, l));
            }
            factors.columns.push(scaled);
            factors.reciprocal.push(reciprocal);
        }
        factors
    }

    fn note_growth(&mut self, diagonal: Entry, pivot: Register, reciprocal: Register) {
        if let Some(diagonal) = diagonal.filter(|&diagonal| diagonal != pivot) {
            self.growth.push(self.schedule.push(Operation::Multiply(diagonal, reciprocal)));
        }
    }

    /// L⁻¹ x
    fn forward(&mut self, factors: &Factors, mut x: Vec<Entry>) -> Vec<Entry> {
        for i in 0..x.len() {
            for &(j, l) in &factors.rows[i] {
                let part = self.multiply(Some(l), x[j]);
                x[i] = self.subtract(x[i], part);
            }
        }
        x
    }

    /// D⁻¹ x
    fn scale(&mut self, factors: &Factors, x: &[Entry]) -> Vec<Entry> {
        x.iter().zip(&factors.reciprocal).map(|(&x, &r)| self.multiply(x, Some(r))).collect()
    }

    /// L⁻ᵀ x
    fn backward(&mut self, factors: &Factors, mut x: Vec<Entry>) -> Vec<Entry> {
        for i in (0..x.len()).rev() {
            for &(j, l) in &factors.columns[i] {
                let part = self.multiply(Some(l), x[j]);
                x[i] = self.subtract(x[i], part);
            }
        }
        x
    }

    /// S λ = −γ − Z D⁻¹ L⁻¹h
    fn multipliers(
        &mut self,
        factors: &Factors,
        forcing: &[Entry],
        rows: &[Sparse],
        equations: &Equations,
    ) -> Option<Vec<Entry>> {
        let m = rows.len();
        let bias = self.entries(&equations.bias);
        let mut schur = vec![vec![None; m]; m];
        let mut target = Vec::with_capacity(m);
        for (a, row) in rows.iter().enumerate() {
            let mut scaled = vec![None; forcing.len()];
            for &(i, z) in row {
                scaled[i] = self.multiply(Some(z), Some(factors.reciprocal[i]));
            }
            for (b, other) in rows.iter().enumerate().take(a + 1) {
                schur[a][b] = self.dot(other, &scaled);
                schur[b][a] = schur[a][b];
            }
            let reached = self.dot(&sparse(&scaled), forcing);
            let sum = self.add(bias[a], reached);
            target.push(self.negate(sum));
        }
        let occupied: Vec<Vec<bool>> =
            schur.iter().map(|row| row.iter().map(Option::is_some).collect()).collect();
        let (order, cost) = elimination_order(&occupied);
        if cost > UNROLLED {
            return None;
        }
        let factors = self.factor(permuted(schur, &order));
        let half = self.forward(&factors, reordered(target, &order));
        let half = self.scale(&factors, &half);
        Some(restored(self.backward(&factors, half), &order))
    }

    fn known(&mut self, entry: Entry) -> Register {
        entry.unwrap_or_else(|| self.schedule.constant(0.0))
    }

    fn finish(mut self, accelerations: Vec<Entry>, multipliers: Vec<Entry>) -> Solved {
        let mut registers =
            |entries: Vec<Entry>| entries.into_iter().map(|entry| self.known(entry)).collect();
        let accelerations: Vec<Register> = registers(accelerations);
        let multipliers: Vec<Register> = registers(multipliers);
        let mut results = accelerations.iter().chain(&multipliers).copied();
        let first = results.next().unwrap_or_else(|| self.schedule.constant(0.0));
        let sum = results.fold(first, |sum, x| self.schedule.push(Operation::Add(sum, x)));
        let pivot = self.smallest_pivot();
        // 0 · Σ is zero, but not a number where any result is none, or infinite.
        let zero = self.schedule.constant(0.0);
        let poison = self.schedule.push(Operation::Multiply(zero, sum));
        let pivot = self.schedule.push(Operation::Add(pivot, poison));
        Solved { accelerations, multipliers, pivot }
    }

    /// The least of pivot/diagonal and diagonal/pivot.
    fn smallest_pivot(&mut self) -> Register {
        let one = self.schedule.constant(1.0);
        let Some((&first, rest)) = self.growth.split_first() else { return one };
        let (mut least, mut most) = (first, first);
        for &growth in rest {
            least = self.schedule.push(Operation::Minimum(least, growth));
            most = self.schedule.push(Operation::Maximum(most, growth));
        }
        let inverse = self.schedule.push(Operation::Divide(one, most));
        self.schedule.push(Operation::Minimum(least, inverse))
    }
}
