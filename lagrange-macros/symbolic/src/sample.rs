//! A random point, with the values of expressions at this point.

use rustc_hash::FxHashMap;

use super::evaluate::Approximate;
use super::graph::{Graph, Id, Symbol};
use super::wave::superposition;

/// A point in the space of symbols, with random functions in place of user-supplied ones. The values of all visited
/// nodes are cached, so that common subexpressions are evaluated once.
#[derive(Clone, Debug)]
pub struct Sample {
    draw: u64,
    symbols: FxHashMap<Symbol, Approximate>,
    values: Vec<Option<Approximate>>,
}

impl Sample {
    /// Random point number `draw`, where each symbol has the value given by `drawn`.
    pub fn new(
        symbols: impl IntoIterator<Item = Symbol>,
        draw: u64,
        drawn: impl Fn(Symbol, u64) -> Approximate,
    ) -> Self {
        let value = |symbol| (symbol, drawn(symbol, draw));
        Self { draw, symbols: symbols.into_iter().map(value).collect(), values: Vec::new() }
    }

    /// Value of a symbol; NaN if the point does not define it.
    pub fn get(&self, symbol: Symbol) -> Approximate {
        self.symbols.get(&symbol).copied().unwrap_or(Approximate::exact(f64::NAN))
    }

    /// Sets values of symbols, and clears the cache.
    pub fn set(&mut self, values: impl IntoIterator<Item = (Symbol, Approximate)>) {
        self.values.clear();
        self.symbols.extend(values);
    }

    pub fn values(&mut self, graph: &Graph, roots: &[Id]) -> Vec<Approximate> {
        self.values.resize(graph.len(), None);
        let mut pending = roots.to_vec();
        while let Some(&id) = pending.last() {
            let before = pending.len();
            if self.values[id.index()].is_none() {
                graph.operands(id, |operand| {
                    if self.values[operand.index()].is_none() {
                        pending.push(operand);
                    }
                });
            }
            if pending.len() == before {
                pending.pop();
                let value = self.values[id.index()].unwrap_or_else(|| self.value(graph, id));
                self.values[id.index()] = Some(value);
            }
        }
        roots.iter().map(|&root| self.known(root)).collect()
    }

    /// Value of a node, from the known values of its operands.
    fn value(&self, graph: &Graph, id: Id) -> Approximate {
        let external = |function: &_, arguments: &[_]| superposition(function, arguments, self.draw);
        graph.value_of(id, |operand| self.known(operand), |symbol| self.get(symbol), external)
    }

    fn known(&self, id: Id) -> Approximate {
        self.values[id.index()].unwrap_or(Approximate::exact(f64::NAN))
    }

    /// Projects `unknowns` onto a nearby point at which `residual` vanishes, by Newton's method with least-norm steps.
    /// `slopes` holds the gradient of each residual by the unknowns. `None` if the iteration does not converge.
    pub fn project(
        &mut self,
        graph: &Graph,
        residual: &[Id],
        slopes: &[&[Id]],
        unknowns: &[Symbol],
    ) -> Option<()> {
        const STEPS: usize = 30;
        const CLOSE: f64 = 1e-13;
        if residual.is_empty() {
            return Some(());
        }
        for _ in 0..STEPS {
            let right = self.values(graph, residual);
            let rows: Vec<_> = slopes.iter().map(|row| self.values(graph, row)).collect();
            let step = least_step(&rows, &right);
            let mut is_met = true;
            for (symbol, step) in unknowns.iter().zip(&step) {
                let is_finite = step.value.is_finite() && step.error.is_finite();
                let x = self.symbols.get_mut(symbol).filter(|_| is_finite)?;
                *x = Approximate::exact(x.value - step.value);
                is_met &= step.value.abs() <= CLOSE * (1.0 + x.value.abs());
            }
            self.values.clear();
            if is_met {
                self.blur(unknowns, &step);
                let left = self.values(graph, residual);
                return left.iter().all(|value| !value.excludes_zero()).then_some(());
            }
        }
        None
    }

    /// Sets the error bounds of the unknowns to twice the last correction. The factor 2 accounts for the
    /// linearization.
    fn blur(&mut self, unknowns: &[Symbol], step: &[Approximate]) {
        self.values.clear();
        for (symbol, step) in unknowns.iter().zip(step) {
            if let Some(x) = self.symbols.get_mut(symbol) {
                x.error = 2.0 * (step.value.abs() + step.error) + f64::EPSILON * x.value.abs();
            }
        }
    }
}

impl Graph {
    /// Values of `roots` for given values of the symbols, with the random functions of this draw.
    pub fn sample(&self, roots: &[Id], draw: u64, value: impl Fn(Symbol) -> Approximate) -> Vec<Approximate> {
        let symbols: Vec<Symbol> = self.symbols(roots).collect();
        Sample::new(symbols, draw, |symbol, _| value(symbol)).values(self, roots)
    }

    /// Value of `root` for given values of the symbols.
    pub fn evaluate(&self, root: Id, value: impl Fn(Symbol) -> f64) -> Approximate {
        self.sample(&[root], 0, |symbol| Approximate::exact(value(symbol)))[0]
    }
}

/// Least-norm solution x of `rows` · x = `right`, by orthogonalizing the rows one after the other. Nearly dependent
/// rows are skipped; if such an equation does not hold, its residual stays nonzero.
fn least_step(rows: &[Vec<Approximate>], right: &[Approximate]) -> Vec<Approximate> {
    const DEPENDENT: f64 = 1e-5;
    let dot =
        |x: &[Approximate], y: &[Approximate]| Approximate::dot(x.iter().copied().zip(y.iter().copied()));
    let mut basis: Vec<(Vec<Approximate>, Approximate, Approximate)> = Vec::new();
    for (row, &right) in rows.iter().zip(right) {
        let (mut rest, mut value) = (row.clone(), right);
        for (direction, square, along) in &basis {
            let part = dot(&rest, direction).over(*square);
            rest.iter_mut().zip(direction).for_each(|(x, &y)| *x = x.minus(part.times(y)));
            value = value.minus(part.times(*along));
        }
        let square = dot(&rest, &rest);
        if square.excludes_zero() && square.value > DEPENDENT * DEPENDENT * dot(row, row).value {
            basis.push((rest, square, value));
        }
    }
    let parts = basis.iter().map(|(direction, square, along)| (direction, along.over(*square)));
    let along = |i: usize| Approximate::dot(parts.clone().map(|(direction, part)| (direction[i], part)));
    (0..rows[0].len()).map(along).collect()
}
