//! The equations of motion solved at compile time: an unrolled sparse elimination.
//!
//! The [form](Form) ½ xᵀHx − bᵀx is reduced variable by variable: a free one is eliminated, M = L D Lᵀ, and a
//! defined one is put in. Then the Schur complement S = F M⁻¹ Fᵀ = Z D⁻¹ Zᵀ with Z = F L⁻ᵀ, and S = L D Lᵀ in its
//! turn. Every structural zero is gone, and both factorizations go in an order of little fill. (Golub and Van Loan,
//! *Matrix Computations*, 4.1.2; Nocedal and Wright, *Numerical Optimization*, 16.2. One LDLᵀ of the whole indefinite
//! matrix would need pivots that only run time can choose.)

mod order;

use super::schedule::{Operation, Register, Schedule};
use crate::mechanics::{Equations, Form};
use crate::symbolic::Id;
use order::{Pattern, reduction_order};

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

/// Appends the elimination to a schedule that computes the entries of the form, F and γ; `None` where it would be
/// too long.
pub(super) fn eliminate(schedule: &mut Schedule, form: &Form, equations: &Equations) -> Option<Solved> {
    let n = equations.forcing.len();
    let matrix = pattern(&form.matrix);
    let definitions = form.definitions.iter().map(|row| row.iter().map(|&(i, _)| i).collect()).collect();
    let (order, cost) = reduction_order(&Pattern { matrix, definitions });
    if cost > UNROLLED {
        return None;
    }
    let mut solver = Solver { schedule, growth: Vec::new() };
    let matrix = form.matrix.iter().map(|row| solver.entries(row)).collect();
    let definitions = form.definitions.iter().map(|row| solver.sparse_entries(row)).collect();
    let factors = solver.factor(matrix, definitions, &order);
    let linear = solver.entries(&form.linear);
    let linear = solver.forward(&factors, linear);
    let rows: Vec<Sparse> = equations
        .jacobian
        .iter()
        .map(|row| {
            let mut row = solver.entries(row);
            row.resize(form.linear.len(), None);
            sparse(&solver.forward(&factors, row))
        })
        .collect();
    let multipliers = solver.multipliers(&factors, &linear, &rows, equations)?;
    let mut push = linear;
    for (&multiplier, row) in multipliers.iter().zip(&rows) {
        for &(i, z) in row {
            let part = solver.multiply(multiplier, Some(z));
            push[i] = solver.add(push[i], part);
        }
    }
    let mut accelerations = solver.backward(&factors, push);
    accelerations.truncate(n);
    Some(solver.finish(accelerations, multipliers))
}

fn pattern(rows: &[Vec<Id>]) -> Vec<Vec<bool>> {
    rows.iter().map(|row| row.iter().map(|&id| id != Id::ZERO).collect()).collect()
}

fn sparse(x: &[Entry]) -> Sparse {
    x.iter().enumerate().filter_map(|(i, entry)| entry.map(|entry| (i, entry))).collect()
}

/// How the form was reduced, step by step.
struct Factors {
    steps: Vec<Step>,
    /// 1/D of the variables that were eliminated.
    reciprocals: Vec<Entry>,
}

struct Step {
    variable: usize,
    kind: StepKind,
}

enum StepKind {
    /// A free variable, with its column of L below the diagonal.
    Eliminated(Sparse),
    /// A defined variable, with its definition.
    PutIn(Sparse),
}

/// How many of the first variables are defined by none of one another.
fn independent(order: &[usize], free: usize, definitions: &[Sparse]) -> usize {
    let contains = |k: usize, variable: usize| definitions[k - free].iter().any(|&(i, _)| i == variable);
    let is_apart = |position: usize| {
        let next = order[position];
        next >= free && order[..position].iter().all(|&k| !contains(k, next))
    };
    (1..order.len()).find(|&position| !is_apart(position)).unwrap_or(order.len())
}

/// What ties a variable to those that are put in: its coefficients g in their definitions, its entries c of the form,
/// and w = K g + c.
struct Tie {
    variable: usize,
    g: Vec<Entry>,
    c: Vec<Entry>,
    w: Vec<Entry>,
}

impl Tie {
    fn is_there(&self) -> bool {
        self.g.iter().chain(&self.c).any(Option::is_some)
    }
}

/// Arithmetic that knows zeros and ones.
struct Solver<'s> {
    schedule: &'s mut Schedule,
    /// For each pivot that differs from what it was before anything was subtracted, that over the pivot.
    growth: Vec<Register>,
}

/// A form while it is reduced.
struct Reduced {
    matrix: Vec<Vec<Entry>>,
    /// The diagonal as it would be had nothing been subtracted.
    scale: Vec<Entry>,
}

impl Reduced {
    /// The entries of a row but for the diagonal.
    fn beside(&self, i: usize) -> Sparse {
        sparse(&self.matrix[i]).into_iter().filter(|&(j, _)| j != i).collect()
    }

    fn set(&mut self, i: usize, j: usize, entry: Entry) {
        self.matrix[i][j] = entry;
        self.matrix[j][i] = entry;
    }

    fn remove(&mut self, variable: usize) {
        for i in 0..self.matrix.len() {
            self.set(i, variable, None);
        }
    }
}

impl Solver<'_> {
    fn entries(&self, ids: &[Id]) -> Vec<Entry> {
        ids.iter().map(|&id| (id != Id::ZERO).then(|| self.schedule.register(id))).collect()
    }

    fn sparse_entries(&self, ids: &[(usize, Id)]) -> Sparse {
        ids.iter().map(|&(i, id)| (i, self.schedule.register(id))).collect()
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

    /// Reduces a form of which the matrix is symmetric; the variables behind the free ones have definitions.
    fn factor(&mut self, matrix: Vec<Vec<Entry>>, definitions: Vec<Sparse>, order: &[usize]) -> Factors {
        let free = matrix.len() - definitions.len();
        let scale = (0..matrix.len()).map(|i| matrix[i][i]).collect();
        let mut form = Reduced { matrix, scale };
        let mut factors = Factors { steps: Vec::new(), reciprocals: vec![None; form.matrix.len()] };
        let mut rest = order;
        while let Some(&variable) = rest.first() {
            let mut taken = 1;
            if variable < free {
                let (column, reciprocal) = self.eliminate(&mut form, variable);
                factors.reciprocals[variable] = Some(reciprocal);
                factors.steps.push(Step { variable, kind: StepKind::Eliminated(column) });
            } else {
                taken = independent(rest, free, &definitions);
                let together = rest[..taken].iter().map(|&k| (k, &definitions[k - free])).collect::<Vec<_>>();
                self.put_in(&mut form, &together);
                for (variable, definition) in together {
                    factors.steps.push(Step { variable, kind: StepKind::PutIn(definition.clone()) });
                }
            }
            rest[..taken].iter().for_each(|&variable| form.remove(variable));
            rest = &rest[taken..];
        }
        factors
    }

    /// What is left where a variable has the value that makes the form least: its column of L, and 1/D.
    fn eliminate(&mut self, form: &mut Reduced, variable: usize) -> (Sparse, Register) {
        let one = self.schedule.constant(1.0);
        // A diagonal that is known to be zero is a pivot of zero, which shows at run time.
        let pivot = self.known(form.matrix[variable][variable]);
        let reciprocal = self.schedule.push(Operation::Divide(one, pivot));
        self.note_growth(form.scale[variable], pivot, reciprocal);
        let beside = form.beside(variable);
        let mut column = Sparse::new();
        for &(i, entry) in &beside {
            let Some(l) = self.multiply(Some(entry), Some(reciprocal)) else { continue };
            for &(j, other) in beside.iter().take_while(|(j, _)| *j <= i) {
                let part = self.multiply(Some(l), Some(other));
                let rest = self.subtract(form.matrix[i][j], part);
                form.set(i, j, rest);
            }
            column.push((i, l));
        }
        (column, reciprocal)
    }

    /// The form with x_k = Σ g_ki x_i for several k at once: H becomes H + Gᵀ(K G + C) + CᵀG, where K is the block of
    /// the x_k and C what ties them to the others.
    fn put_in(&mut self, form: &mut Reduced, definitions: &[(usize, &Sparse)]) {
        let ties: Vec<Tie> = (0..form.matrix.len())
            .filter(|i| definitions.iter().all(|(k, _)| k != i))
            .map(|i| self.tie(form, definitions, i))
            .filter(Tie::is_there)
            .collect();
        for (position, x) in ties.iter().enumerate() {
            self.put_in_scale(form, definitions, x);
            for y in &ties[..=position] {
                let part = if x.variable == y.variable { self.own(x) } else { self.mutual(x, y) };
                let sum = self.add(form.matrix[x.variable][y.variable], part);
                form.set(x.variable, y.variable, sum);
            }
        }
    }

    fn tie(&mut self, form: &Reduced, definitions: &[(usize, &Sparse)], i: usize) -> Tie {
        let coefficient = |definition: &Sparse| definition.iter().find(|(j, _)| *j == i).map(|&(_, g)| g);
        let g: Vec<Entry> = definitions.iter().map(|(_, definition)| coefficient(definition)).collect();
        let c: Vec<Entry> = definitions.iter().map(|&(k, _)| form.matrix[k][i]).collect();
        let w = definitions.iter().zip(&c).map(|(&(k, _), &c)| {
            let row: Sparse = definitions
                .iter()
                .enumerate()
                .filter_map(|(position, &(other, _))| form.matrix[k][other].map(|entry| (position, entry)))
                .collect();
            let through = self.dot(&row, &g);
            self.add(through, c)
        });
        let w = w.collect();
        Tie { variable: i, g, c, w }
    }

    /// Σ_k g_k (w_k + c_k)
    fn own(&mut self, x: &Tie) -> Entry {
        let mut sum = None;
        for k in 0..x.g.len() {
            let both = if x.g[k].is_some() { self.add(x.w[k], x.c[k]) } else { None };
            let part = self.multiply(x.g[k], both);
            sum = self.add(sum, part);
        }
        sum
    }

    /// Σ_k (g_k w'_k + c_k g'_k), from the side that takes fewer multiplications.
    fn mutual(&mut self, x: &Tie, y: &Tie) -> Entry {
        let one = self.schedule.constant(1.0);
        let cost = |x: &Tie, y: &Tie| {
            let is_product =
                |x: Entry, y: Entry| x.is_some() && y.is_some() && x != Some(one) && y != Some(one);
            let products =
                |x: &[Entry], y: &[Entry]| x.iter().zip(y).filter(|&(&x, &y)| is_product(x, y)).count();
            products(&x.g, &y.w) + products(&x.c, &y.g)
        };
        let (x, y) = if cost(x, y) <= cost(y, x) { (x, y) } else { (y, x) };
        let mut sum = None;
        for k in 0..x.g.len() {
            for (factor, other) in [(x.g[k], y.w[k]), (x.c[k], y.g[k])] {
                let part = self.multiply(factor, other);
                sum = self.add(sum, part);
            }
        }
        sum
    }

    fn put_in_scale(&mut self, form: &mut Reduced, definitions: &[(usize, &Sparse)], x: &Tie) {
        for (&(k, _), &g) in definitions.iter().zip(&x.g) {
            let scaled = self.multiply(g, form.scale[k]);
            let square = self.multiply(scaled, g);
            form.scale[x.variable] = self.add(form.scale[x.variable], square);
        }
    }

    fn note_growth(&mut self, scale: Entry, pivot: Register, reciprocal: Register) {
        if let Some(scale) = scale.filter(|&scale| scale != pivot) {
            self.growth.push(self.schedule.push(Operation::Multiply(scale, reciprocal)));
        }
    }

    /// L⁻¹ x: what the linear part of the form, or a constraint, comes to.
    fn forward(&mut self, factors: &Factors, mut x: Vec<Entry>) -> Vec<Entry> {
        for Step { variable, kind } in &factors.steps {
            match kind {
                StepKind::Eliminated(column) => {
                    for &(i, l) in column {
                        let part = self.multiply(Some(l), x[*variable]);
                        x[i] = self.subtract(x[i], part);
                    }
                }
                StepKind::PutIn(definition) => {
                    let value = x[*variable].take();
                    for &(i, g) in definition {
                        let part = self.multiply(Some(g), value);
                        x[i] = self.add(x[i], part);
                    }
                }
            }
        }
        x
    }

    /// L⁻ᵀ D⁻¹ x: the variables themselves, in the reverse order.
    fn backward(&mut self, factors: &Factors, mut x: Vec<Entry>) -> Vec<Entry> {
        for Step { variable, kind } in factors.steps.iter().rev() {
            x[*variable] = match kind {
                StepKind::Eliminated(column) => {
                    let start = self.multiply(x[*variable], factors.reciprocals[*variable]);
                    column.iter().fold(start, |rest, &(i, l)| {
                        let part = self.multiply(Some(l), x[i]);
                        self.subtract(rest, part)
                    })
                }
                StepKind::PutIn(definition) => self.dot(definition, &x),
            };
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
                scaled[i] = self.multiply(Some(z), factors.reciprocals[i]);
            }
            for (b, other) in rows.iter().enumerate().take(a + 1) {
                schur[a][b] = self.dot(other, &scaled);
                schur[b][a] = schur[a][b];
            }
            let reached = self.dot(&sparse(&scaled), forcing);
            let sum = self.add(bias[a], reached);
            target.push(self.negate(sum));
        }
        let matrix = schur.iter().map(|row| row.iter().map(Option::is_some).collect()).collect();
        let (order, cost) = reduction_order(&Pattern { matrix, definitions: Vec::new() });
        if cost > UNROLLED {
            return None;
        }
        let factors = self.factor(schur, Vec::new(), &order);
        let half = self.forward(&factors, target);
        Some(self.backward(&factors, half))
    }

    fn known(&mut self, entry: Entry) -> Register {
        entry.unwrap_or_else(|| self.schedule.constant(0.0))
    }

    fn finish(mut self, accelerations: Vec<Entry>, multipliers: Vec<Entry>) -> Solved {
        let mut registers =
            |entries: Vec<Entry>| entries.into_iter().map(|entry| self.known(entry)).collect();
        let accelerations: Vec<Register> = registers(accelerations);
        let multipliers: Vec<Register> = registers(multipliers);
        let results = [&accelerations[..], &multipliers].concat();
        let ends = self.schedule.not_used_by_one_another(&results);
        let sum = ends.into_iter().reduce(|sum, x| self.schedule.push(Operation::Add(sum, x)));
        let sum = sum.unwrap_or_else(|| self.schedule.constant(0.0));
        let pivot = self.smallest_pivot();
        // 0 · Σ is zero, but not a number where any result is none, or infinite; and such a result makes all that
        // it is used by the like.
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
