//! A random point, and the values of all expressions there.

use rustc_hash::FxHashMap;

use super::evaluate::Approximate;
use super::graph::{Graph, Id, Symbol};
use super::zero::drawn;

/// Beyond this error, relative to the largest of the values beside it, a value says nothing.
const BLUR: f64 = 1e-6;

/// A point in the space of the symbols. It remembers the values of all nodes, so that expressions that are
/// built one on the other are evaluated once.
pub(crate) struct Sample {
    draw: u64,
    symbols: FxHashMap<Symbol, Approximate>,
    values: Vec<Approximate>,
}

impl Sample {
    /// The random point of number `draw`, each symbol from its range.
    pub(crate) fn new(
        symbols: impl IntoIterator<Item = Symbol>,
        draw: u64,
        range: impl Fn(Symbol) -> (f64, f64),
    ) -> Self {
        let value = |symbol| Approximate::exact(drawn(symbol, range(symbol), draw));
        let symbols = symbols.into_iter().map(|symbol| (symbol, value(symbol))).collect();
        Self { draw, symbols, values: Vec::new() }
    }

    /// The values of `roots`; `None` where one of them has none there, or too inaccurate a one.
    pub(crate) fn values(&mut self, graph: &Graph, roots: &[Id]) -> Option<Vec<Approximate>> {
        let Self { draw, symbols, values } = self;
        let unknown = Approximate { value: f64::NAN, error: 0.0 };
        graph.extend_values(
            values,
            |symbol| symbols.get(&symbol).copied().unwrap_or(unknown),
            |id, values| graph.wave(id, values, *draw),
        );
        let found: Vec<_> = roots.iter().map(|root| values[root.index()]).collect();
        let scale = found.iter().fold(1.0, |scale: f64, value| scale.max(value.value.abs()));
        let usable = |value: &Approximate| value.value.is_finite() && value.error <= BLUR * scale;
        found.iter().all(usable).then_some(found)
    }

    /// Moves `unknowns` to a point near by at which `roots` vanish, by Newton's method with the least step.
    /// Slopes are differences.
    pub(crate) fn project(&mut self, graph: &Graph, roots: &[Id], unknowns: &[Symbol]) -> Option<()> {
        const STEPS: usize = 40;
        const CLOSE: f64 = 1e-13;
        if roots.is_empty() {
            return Some(());
        }
        for _ in 0..STEPS {
            let residual = self.values(graph, roots)?;
            let slopes = self.slopes(graph, roots, unknowns, &residual)?;
            let step = least_step(&slopes, &residual);
            self.shift(unknowns.iter().copied().zip(step.iter().map(|x| -x)));
            let size = step.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            if size < CLOSE {
                self.blur(unknowns, 2.0 * CLOSE);
                let residual = self.values(graph, roots)?;
                return residual.iter().all(|value| !value.excludes_zero()).then_some(());
            }
        }
        None
    }

    /// ∂root/∂unknown, a column for each root.
    fn slopes(
        &mut self,
        graph: &Graph,
        roots: &[Id],
        unknowns: &[Symbol],
        here: &[Approximate],
    ) -> Option<Vec<Vec<f64>>> {
        const STEP: f64 = 1e-7;
        let mut slopes = vec![Vec::new(); roots.len()];
        for &unknown in unknowns {
            self.shift([(unknown, STEP)]);
            let there = self.values(graph, roots)?;
            self.shift([(unknown, -STEP)]);
            for (row, (there, here)) in slopes.iter_mut().zip(there.iter().zip(here)) {
                row.push((there.value - here.value) / STEP);
            }
        }
        Some(slopes)
    }

    fn shift(&mut self, steps: impl IntoIterator<Item = (Symbol, f64)>) {
        self.values.clear();
        for (symbol, step) in steps {
            if let Some(value) = self.symbols.get_mut(&symbol) {
                value.value += step;
            }
        }
    }

    /// The exact point is this far from here, in each coordinate, at most.
    fn blur(&mut self, unknowns: &[Symbol], error: f64) {
        self.values.clear();
        for symbol in unknowns {
            if let Some(value) = self.symbols.get_mut(symbol) {
                value.error = error * (1.0 + value.value.abs());
            }
        }
    }
}

/// The shortest x with `rows` · x = `right`, by orthonormalising the rows; a row that depends on earlier ones
/// is left out.
fn least_step(rows: &[Vec<f64>], right: &[Approximate]) -> Vec<f64> {
    const DEPENDENT: f64 = 1e-5;
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let mut basis: Vec<(Vec<f64>, f64)> = Vec::new();
    for (row, right) in rows.iter().zip(right) {
        let (mut rest, mut value, length) = (row.clone(), right.value, dot(row, row).sqrt());
        for (unit, along) in &basis {
            let part = dot(&rest, unit);
            rest.iter_mut().zip(unit).for_each(|(x, unit)| *x -= part * unit);
            value -= part * along;
        }
        let left = dot(&rest, &rest).sqrt();
        if left > DEPENDENT * length {
            basis.push((rest.iter().map(|x| x / left).collect(), value / left));
        }
    }
    let width = rows.first().map_or(0, Vec::len);
    (0..width).map(|i| basis.iter().map(|(unit, along)| unit[i] * along).sum()).collect()
}
