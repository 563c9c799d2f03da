//! Reduces a quadratic form variable by variable, and applies the reduction to vectors.

use super::arithmetic::{Solver, Sparse, SparseEntry, sparse};
use crate::codegen::operation::{Operation, Register};

/// Record of the reduction of a form, step by step.
pub(super) struct FormFactors {
    steps: Vec<ReductionStep>,
    /// 1/D of M = L D Lᵀ, for each eliminated variable.
    pub(super) reciprocals: Vec<SparseEntry>,
}

struct ReductionStep {
    variable: usize,
    kind: StepKind,
}

enum StepKind {
    /// Elimination of a free variable: its column of L below the diagonal.
    Eliminated(Sparse),
    /// Substitution of a defined variable: its definition.
    Substituted(Sparse),
}

impl FormFactors {
    /// Returns all registers of the reduction.
    pub(super) fn registers(&self) -> impl Iterator<Item = Register> {
        let columns = self.steps.iter().flat_map(|step| step.kind.entries());
        let columns = columns.map(|&(_, entry)| entry);
        self.reciprocals.iter().flatten().copied().chain(columns)
    }

    pub(super) fn with_registers(&self, mut new: impl FnMut(Register) -> Register) -> Self {
        let reciprocals = self.reciprocals.iter().map(|entry| entry.map(&mut new)).collect();
        let steps = self.steps.iter().map(|&ReductionStep { variable, ref kind }| {
            let mut renewed = |entries: &Sparse| entries.iter().map(|&(i, entry)| (i, new(entry))).collect();
            let kind = match kind {
                StepKind::Eliminated(column) => StepKind::Eliminated(renewed(column)),
                StepKind::Substituted(entries) => StepKind::Substituted(renewed(entries)),
            };
            ReductionStep { variable, kind }
        });
        Self { steps: steps.collect(), reciprocals }
    }
}

impl StepKind {
    fn entries(&self) -> &Sparse {
        let (Self::Eliminated(entries) | Self::Substituted(entries)) = self;
        entries
    }
}

/// Number of leading variables in `order` that can be substituted together: they are defined, and no
/// definition of one contains another.
fn independent(order: &[usize], free: usize, definitions: &[Sparse]) -> usize {
    let contains = |k: usize, variable: usize| definitions[k - free].iter().any(|&(i, _)| i == variable);
    let is_apart = |position: usize| {
        let next = order[position];
        next >= free && order[..position].iter().all(|&k| !contains(k, next))
    };
    (1..order.len()).find(|&position| !is_apart(position)).unwrap_or(order.len())
}

/// Coupling of a variable to the substituted ones: its coefficients g in their definitions, its entries c of
/// the form, and w = K g + c with the block K of the substituted variables.
struct Tie {
    variable: usize,
    g: Vec<SparseEntry>,
    c: Vec<SparseEntry>,
    w: Vec<SparseEntry>,
}

impl Tie {
    fn is_there(&self) -> bool {
        self.g.iter().chain(&self.c).any(Option::is_some)
    }
}

/// Form during the reduction.
struct Reduced {
    matrix: Vec<Vec<SparseEntry>>,
    /// Diagonal entries before elimination, to which pivots are compared.
    scale: Vec<SparseEntry>,
    /// Index of the first multiplier among the variables. The diagonal of a multiplier is zero at first, and negative
    /// once coordinates are eliminated.
    multipliers: usize,
}

impl Reduced {
    /// Off-diagonal entries of a row.
    fn beside(&self, i: usize) -> Sparse {
        sparse(&self.matrix[i]).into_iter().filter(|&(j, _)| j != i).collect()
    }

    fn set(&mut self, i: usize, j: usize, entry: SparseEntry) {
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
    /// Reduces a form with a symmetric matrix. The variables after the free ones have definitions. The last
    /// `multipliers` variables are multipliers.
    pub(super) fn factor(
        &mut self,
        matrix: Vec<Vec<SparseEntry>>,
        definitions: Vec<Sparse>,
        order: &[usize],
        multipliers: usize,
    ) -> FormFactors {
        let free = matrix.len() - definitions.len();
        let scale = (0..matrix.len()).map(|i| matrix[i][i]).collect();
        let multipliers = matrix.len() - multipliers;
        let mut form = Reduced { matrix, scale, multipliers };
        let mut factors = FormFactors { steps: Vec::new(), reciprocals: vec![None; form.matrix.len()] };
        let mut rest = order;
        while let Some(&variable) = rest.first() {
            let mut taken = 1;
            if variable < free {
                let (column, reciprocal) = self.eliminate(&mut form, variable);
                factors.reciprocals[variable] = Some(reciprocal);
                factors.steps.push(ReductionStep { variable, kind: StepKind::Eliminated(column) });
            } else {
                taken = independent(rest, free, &definitions);
                let together = rest[..taken].iter().map(|&k| (k, &definitions[k - free])).collect::<Vec<_>>();
                self.put_in(&mut form, &together);
                for (variable, definition) in together {
                    factors
                        .steps
                        .push(ReductionStep { variable, kind: StepKind::Substituted(definition.clone()) });
                }
            }
            rest[..taken].iter().for_each(|&variable| form.remove(variable));
            rest = &rest[taken..];
        }
        factors
    }

    /// Eliminates a variable, at its stationary value. Returns its column of L, and 1/D.
    fn eliminate(&mut self, form: &mut Reduced, variable: usize) -> (Sparse, Register) {
        let one = self.schedule.constant(1.0);
        // A structural zero on the diagonal becomes a pivot of zero, which the check detects at run time.
        let pivot = self.known(form.matrix[variable][variable]);
        let reciprocal = self.schedule.push(Operation::Divide(one, pivot));
        self.note_pivot(form.scale[variable], pivot, reciprocal);
        let beside = form.beside(variable);
        let mut column = Sparse::new();
        for &(i, entry) in &beside {
            let Some(l) = self.multiply(Some(entry), Some(reciprocal)) else { continue };
            for &(j, other) in beside.iter().take_while(|(j, _)| *j <= i) {
                let part = self.multiply(Some(l), Some(other));
                let rest = self.subtract(form.matrix[i][j], part);
                form.set(i, j, rest);
                if i == j && variable < form.multipliers && i >= form.multipliers {
                    form.scale[i] = self.subtract(form.scale[i], part);
                }
            }
            column.push((i, l));
        }
        (column, reciprocal)
    }

    /// Substitutes x_k = Σ g_ki x_i for several k at once: H becomes H + Gᵀ(K G + C) + CᵀG. K is the block of the
    /// x_k, and C couples them to the other variables.
    fn put_in(&mut self, form: &mut Reduced, definitions: &[(usize, &Sparse)]) {
        let block: Vec<Sparse> = definitions
            .iter()
            .map(|&(k, _)| {
                sparse(&definitions.iter().map(|&(other, _)| form.matrix[k][other]).collect::<Vec<_>>())
            })
            .collect();
        let ties: Vec<Tie> = (0..form.matrix.len())
            .filter(|i| definitions.iter().all(|(k, _)| k != i))
            .map(|i| self.tie(form, definitions, &block, i))
            .filter(Tie::is_there)
            .collect();
        for (position, x) in ties.iter().enumerate() {
            self.put_in_scale(form, definitions, x);
            for y in &ties[..=position] {
                let part = if x.variable == y.variable { self.own(x) } else { self.mutual(x, y) };
                let sum = self.add(form.matrix[x.variable][y.variable], part);
                form.set(x.variable, y.variable, sum);
            }
            // A diagonal entry that was zero has no other reference than its new value.
            form.scale[x.variable] = form.scale[x.variable].or(form.matrix[x.variable][x.variable]);
        }
    }

    fn tie(&mut self, form: &Reduced, definitions: &[(usize, &Sparse)], block: &[Sparse], i: usize) -> Tie {
        let coefficient = |definition: &Sparse| definition.iter().find(|(j, _)| *j == i).map(|&(_, g)| g);
        let g: Vec<SparseEntry> = definitions.iter().map(|(_, definition)| coefficient(definition)).collect();
        let c: Vec<SparseEntry> = definitions.iter().map(|&(k, _)| form.matrix[k][i]).collect();
        let w = block.iter().zip(&c).map(|(row, &c)| {
            let through = self.dot(row, &g);
            self.add(through, c)
        });
        let w = w.collect();
        Tie { variable: i, g, c, w }
    }

    /// Term Σ_k g_k (w_k + c_k) that the substituted variables k add to the diagonal entry of [`x`](Tie).
    fn own(&mut self, x: &Tie) -> SparseEntry {
        let mut sum = None;
        for k in 0..x.g.len() {
            let both = if x.g[k].is_some() { self.add(x.w[k], x.c[k]) } else { None };
            let part = self.multiply(x.g[k], both);
            sum = self.add(sum, part);
        }
        sum
    }

    /// Term Σ_k (g_k w'_k + c_k g'_k) that the substituted variables k add to the entry of [`x` and
    /// `y`](Tie). `x` and `y` change places if that takes fewer multiplications.
    fn mutual(&mut self, x: &Tie, y: &Tie) -> SparseEntry {
        let one = self.schedule.constant(1.0);
        let cost = |x: &Tie, y: &Tie| {
            let is_product = |x: SparseEntry, y: SparseEntry| {
                x.is_some() && y.is_some() && x != Some(one) && y != Some(one)
            };
            let products = |x: &[SparseEntry], y: &[SparseEntry]| {
                x.iter().zip(y).filter(|&(&x, &y)| is_product(x, y)).count()
            };
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

    /// Forward substitution L⁻¹ x, for the linear part of the form or a row of F.
    pub(super) fn forward(&mut self, factors: &FormFactors, mut x: Vec<SparseEntry>) -> Vec<SparseEntry> {
        for ReductionStep { variable, kind } in &factors.steps {
            match kind {
                StepKind::Eliminated(column) => {
                    for &(i, l) in column {
                        let part = self.multiply(Some(l), x[*variable]);
                        x[i] = self.subtract(x[i], part);
                    }
                }
                StepKind::Substituted(definition) => {
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

    /// Back-substitution L⁻ᵀ(x + D⁻¹y), in the reverse order. Each variable follows from those found before.
    /// `doubt`, zero or NaN, is added to variables that depend on no other and have no entry in y, so that a
    /// NaN reaches every variable.
    pub(super) fn backward(
        &mut self,
        factors: &FormFactors,
        mut x: Vec<SparseEntry>,
        y: &[SparseEntry],
        doubt: SparseEntry,
    ) -> Vec<SparseEntry> {
        for ReductionStep { variable, kind } in factors.steps.iter().rev() {
            x[*variable] = match kind {
                StepKind::Eliminated(column) => {
                    let pushed = self.multiply(y[*variable], factors.reciprocals[*variable]);
                    let is_first = column.is_empty() && pushed.is_none();
                    let start = self.add(x[*variable], if is_first { doubt } else { pushed });
                    column.iter().fold(start, |rest, &(i, l)| {
                        let part = self.multiply(Some(l), x[i]);
                        self.subtract(rest, part)
                    })
                }
                StepKind::Substituted(definition) => self.dot(definition, &x),
            };
        }
        x
    }
}
