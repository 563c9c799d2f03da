//! Random states that satisfy the constraints, with what the equations of motion give there.
//!
//! All numbers carry bounds on their errors. A state met by Newton's method is off the constraints by about its
//! last correction, which counts as an error of the state.

use rustc_hash::FxHashMap;

use super::constraints::ConstraintKind;
use super::elimination::solve;
use super::equations::Equations;
use crate::resolve::Problem;
use crate::symbolic::{Approximate, Graph, Id, Symbol, drawn};
use crate::variables::Variable;

/// How often a state is drawn anew where no motion is found from it.
const DRAWS: u64 = 48;
const NEWTON_STEPS: usize = 30;

/// Moments of random motions, drawn when first asked for.
#[derive(Default)]
pub(super) struct Moments {
    found: Vec<Moment>,
    draws: u64,
}

impl Moments {
    /// The moment of this index, unless states become too hard to find before.
    pub(super) fn get(
        &mut self,
        index: usize,
        graph: &Graph,
        problem: &Problem,
        equations: &Equations,
    ) -> Option<&Moment> {
        while self.found.len() <= index && self.draws < DRAWS {
            self.draws += 1;
            self.found.extend(Moment::drawn(graph, problem, equations, self.draws - 1));
        }
        self.found.get(index)
    }
}

/// Parameters, time, coordinates, velocities, accelerations and multipliers.
pub(super) struct Moment {
    draw: u64,
    values: FxHashMap<Symbol, Approximate>,
}

impl Moment {
    fn drawn(graph: &Graph, problem: &Problem, equations: &Equations, draw: u64) -> Option<Self> {
        let n = problem.coordinates.len();
        let parameters = (0..problem.parameters.entries.len()).map(Variable::Parameter);
        let state = (0..n).flat_map(|i| [Variable::Coordinate(i), Variable::Velocity(i)]);
        let values = parameters.chain(state).chain([Variable::Time]).map(|variable| {
            let symbol = variable.symbol();
            (symbol, Approximate::exact(drawn(symbol, problem.range(symbol), draw)))
        });
        let mut moment = Self { draw, values: values.collect() };
        let is_holonomic = |a: &usize| equations.kinds[*a] == ConstraintKind::Holonomic;
        let holonomic: Vec<usize> = (0..equations.kinds.len()).filter(is_holonomic).collect();
        let all: Vec<usize> = (0..equations.kinds.len()).collect();
        moment.project(graph, &equations.residual, &equations.jacobian, &holonomic, Variable::Coordinate)?;
        moment.project(graph, &equations.rate, &equations.jacobian, &all, Variable::Velocity)?;
        moment.accelerate(graph, problem, equations)?;
        Some(moment)
    }

    pub(super) fn get(&self, variable: Variable) -> Approximate {
        self.values.get(&variable.symbol()).copied().unwrap_or(Approximate::exact(f64::NAN))
    }

    pub(super) fn values(&self, graph: &Graph, roots: &[Id]) -> Vec<Approximate> {
        graph.sample(roots, self.draw, |symbol| self.get(Variable::of(symbol)))
    }

    /// Moves the coordinates or the velocities to where the residuals of `rows` vanish.
    fn project(
        &mut self,
        graph: &Graph,
        residual: &[Id],
        jacobian: &[Vec<Id>],
        rows: &[usize],
        variable: fn(usize) -> Variable,
    ) -> Option<()> {
        if rows.is_empty() {
            return Some(());
        }
        let residual: Vec<Id> = rows.iter().map(|&a| residual[a]).collect();
        let jacobian: Vec<&[Id]> = rows.iter().map(|&a| jacobian[a].as_slice()).collect();
        for _ in 0..NEWTON_STEPS {
            let correction = self.correction(graph, &residual, &jacobian)?;
            let mut met = true;
            for (i, step) in correction.iter().enumerate() {
                let x = self.values.get_mut(&variable(i).symbol())?;
                *x = Approximate::exact(x.value - step.value);
                met &= step.value.abs() <= 1e-13 * (1.0 + x.value.abs());
            }
            if met {
                self.blur(&correction, variable);
                return Some(());
            }
        }
        None
    }

    /// What was still to be corrected is how far the state may be from one that meets the constraints: twice,
    /// because the correction is that of the linearized constraints.
    fn blur(&mut self, correction: &[Approximate], variable: fn(usize) -> Variable) {
        for (i, step) in correction.iter().enumerate() {
            if let Some(x) = self.values.get_mut(&variable(i).symbol()) {
                x.error = 2.0 * (step.value.abs() + step.error) + f64::EPSILON * x.value.abs();
            }
        }
    }

    /// The shortest Δ with F Δ = residual: Fᵀ (F Fᵀ)⁻¹ residual.
    fn correction(&self, graph: &Graph, residual: &[Id], jacobian: &[&[Id]]) -> Option<Vec<Approximate>> {
        let n = jacobian[0].len();
        let values = self.values(graph, &[&jacobian.concat(), residual].concat());
        let (jacobian, residual) = values.split_at(n * residual.len());
        let jacobian: Vec<&[Approximate]> = jacobian.chunks(n).collect();
        let gram = jacobian.iter().zip(residual).map(|(row, &right)| {
            let products = jacobian.iter().map(|other| dot(row.iter().zip(*other).map(|(&x, &y)| (x, y))));
            products.chain([right]).collect()
        });
        let weights = solve(gram.collect(), residual.len())?.values;
        let along = |i: usize| dot(jacobian.iter().zip(&weights).map(|(row, &weight)| (row[i], weight)));
        let correction: Vec<_> = (0..n).map(along).collect();
        correction.iter().all(|step| step.value.is_finite() && step.error.is_finite()).then_some(correction)
    }

    /// M q̈ − Fᵀλ = h, F q̈ = −γ
    fn accelerate(&mut self, graph: &Graph, problem: &Problem, equations: &Equations) -> Option<()> {
        let (n, m) = (problem.coordinates.len(), problem.constraints.len());
        let zero = Approximate::exact(0.0);
        let roots =
            [&equations.mass.concat(), &equations.forcing, &equations.jacobian.concat(), &equations.bias];
        let values = self.values(graph, &roots.map(Vec::as_slice).concat());
        let (mass, rest) = values.split_at(n * n);
        let (forcing, rest) = rest.split_at(n);
        let (jacobian, bias) = rest.split_at(n * m);
        let of_coordinates = (0..n).map(|i| {
            let force = (0..m).map(|a| zero.minus(jacobian[a * n + i]));
            mass[i * n..][..n].iter().copied().chain(force).chain([forcing[i]]).collect()
        });
        let of_constraints = (0..m).map(|a| {
            let row = jacobian[a * n..][..n].iter().copied();
            row.chain(vec![zero; m]).chain([zero.minus(bias[a])]).collect()
        });
        let solution = solve(of_coordinates.chain(of_constraints).collect(), n + m)?;
        if solution.free[..n].contains(&true) {
            return None;
        }
        let variables = (0..n).map(Variable::Acceleration).chain((0..m).map(Variable::Multiplier));
        self.values.extend(variables.map(Variable::symbol).zip(solution.values));
        Some(())
    }
}

/// Σ x y
pub(super) fn dot(pairs: impl Iterator<Item = (Approximate, Approximate)>) -> Approximate {
    pairs.fold(Approximate::exact(0.0), |sum, (x, y)| sum.plus(x.times(y)))
}
