//! The space of (q, t), with the constraints as one-forms and the random points at which they are evaluated.

use crate::mechanics::ConstraintKind;
use crate::mechanics::Evidence;
use crate::mechanics::constraints::Constraints;
use crate::resolve::Problem;
use crate::symbolic::{Approximate, Graph, Id, Sample};
use crate::symbolic::{Symbol, rank};
use crate::variables::{Variable, symbols};

/// Number of random points on Φ = 0, and largest number of draws in the search for them.
const POINTS: usize = 8;
const DRAWS: u64 = 64;

/// Largest error bound of a usable value, relative to the largest value evaluated with it (at least 1).
const BLUR: f64 = 1e-6;

/// Coefficients of ω = Σ F_a dq_a + b dt, that of time last.
pub(super) type OneForm = Vec<Id>;

/// Constraint forms in a graph of their own. Definitions are inlined, so that canonical forms show which expressions
/// vanish.
pub(super) struct Space {
    pub(super) graph: Graph,
    /// The coordinates, then time.
    pub(super) symbols: Vec<Symbol>,
    /// dΦ of the holonomic constraints that always hold.
    pub(super) holonomic: Vec<OneForm>,
    /// Forms of the velocity constraints, each with the index of its constraint.
    pub(super) velocity: Vec<(usize, OneForm)>,
    samples: Vec<Sample>,
}

impl Space {
    /// `None` if the arithmetic fails or no point on Φ = 0 is found.
    pub(super) fn new(graph: &Graph, problem: &Problem, constraints: &Constraints) -> Option<Self> {
        let n = problem.coordinates.len();
        let mut symbols = symbols(n, Variable::Coordinate);
        symbols.push(Variable::Time.symbol());
        let mut space = Self {
            graph: Graph::default(),
            symbols,
            holonomic: Vec::new(),
            velocity: Vec::new(),
            samples: Vec::new(),
        };
        let is_holonomic = |row: &usize| constraints.kinds[*row] == ConstraintKind::Holonomic;
        let (mut holonomic, velocity): (Vec<_>, Vec<_>) =
            (0..constraints.kinds.len()).partition(is_holonomic);
        holonomic.retain(|&row| constraints.always_holds(row));
        let residuals: Vec<Id> = holonomic.iter().map(|&row| constraints.residual[row]).collect();
        let residuals = space.graph.copied(graph, &residuals);
        space.holonomic =
            residuals.iter().map(|&residual| space.graph.gradient(residual, &space.symbols)).collect();
        for row in velocity {
            let rate = space.graph.copied(graph, &[constraints.rate[row]])[0];
            let form = space.form(rate, n);
            space.velocity.push((row, form));
        }
        space.settled()?;
        space.draw(&residuals, problem);
        (!space.samples.is_empty()).then_some(space)
    }

    /// Coefficients of an expression affine in the velocities.
    fn form(&mut self, rate: Id, n: usize) -> OneForm {
        let velocities = symbols(n, Variable::Velocity);
        let mut form = self.graph.gradient(rate, &velocities);
        // At q̇ = 0 only b remains.
        let at_rest = self.graph.substituted(rate, |symbol| velocities.contains(&symbol).then_some(Id::ZERO));
        form.push(at_rest);
        form
    }

    fn draw(&mut self, residuals: &[Id], problem: &Problem) {
        let forms = self.holonomic.iter().chain(self.velocity.iter().map(|(_, form)| form));
        let roots: Vec<Id> = forms.flatten().copied().collect();
        let all = [residuals, &roots].concat();
        let symbols: Vec<Symbol> = self.graph.symbols(&all).chain(self.symbols.iter().copied()).collect();
        let coordinates = &self.symbols[..self.symbols.len() - 1];
        let slopes: Vec<&[Id]> = self.holonomic.iter().map(|form| &form[..coordinates.len()]).collect();
        let samples = (0..DRAWS).filter_map(|draw| {
            let mut sample =
                Sample::new(symbols.iter().copied(), draw, |symbol, draw| problem.drawn(symbol, draw));
            sample.project(&self.graph, residuals, &slopes, coordinates)?;
            usable(sample.values(&self.graph, &roots))?;
            Some(sample)
        });
        self.samples = samples.take(POINTS).collect();
    }

    /// `None` if the arithmetic failed or the graph exceeds its size limit.
    pub(super) fn settled(&mut self) -> Option<()> {
        const LIMIT: usize = 100_000;
        (self.graph.take_fault().is_none() && self.graph.len() < LIMIT).then_some(())
    }

    /// Values of `roots` at each point where all of them are usable.
    pub(super) fn values(&mut self, roots: &[Id]) -> Vec<Vec<Approximate>> {
        let values = self.samples.iter_mut().map(|sample| sample.values(&self.graph, roots));
        values.filter_map(usable).collect()
    }

    /// Tests whether all of `roots` vanish, and with which evidence; `None` if they have no values.
    pub(super) fn vanish(&mut self, roots: &[Id]) -> Option<(bool, Evidence)> {
        let (mut evidence, mut decided) = (Evidence::Proved, true);
        for &root in roots.iter().filter(|&&root| root != Id::ZERO) {
            let values = self.values(&[root]);
            if values.iter().any(|at| at[0].excludes_zero()) {
                return Some((false, self.seen()));
            }
            decided &= !values.is_empty();
            evidence = evidence.and(Evidence::Held(values.len() as u32));
        }
        decided.then_some((true, evidence))
    }

    /// Largest rank of `rows` at any point, and the number of points; `None` if they have no values.
    pub(super) fn rank(&mut self, rows: &[&[Id]]) -> Option<(usize, u32)> {
        let width = rows.first()?.len();
        let values = self.values(&rows.concat());
        let ranks = values.iter().map(|at| rank(at.chunks(width).map(<[_]>::to_vec).collect()));
        Some((ranks.max()?, values.len() as u32))
    }

    /// Evidence that a value is not zero. Points on Φ = 0 are known only approximately, so that nothing is proved
    /// there.
    pub(super) fn seen(&self) -> Evidence {
        if self.holonomic.is_empty() { Evidence::Proved } else { Evidence::Held(self.samples.len() as u32) }
    }
}

/// `None` if a value is not finite or too inaccurate.
fn usable(values: Vec<Approximate>) -> Option<Vec<Approximate>> {
    let scale = values.iter().fold(1.0, |scale: f64, value| scale.max(value.value.abs()));
    let usable = |value: &Approximate| value.value.is_finite() && value.error <= BLUR * scale;
    values.iter().all(usable).then_some(values)
}
