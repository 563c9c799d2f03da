//! Random states that satisfy the constraints, with the accelerations and multipliers that the equations of motion
//! give.

use super::constraints::ConstraintKind;
use super::equations::Equations;
use crate::resolve::Problem;
use crate::symbolic::{Approximate, Graph, Id, Sample, solve};
use crate::variables::{Variable, symbols};

/// Largest number of random draws. A draw fails if no state on the constraints, or no acceleration, is found from it.
const DRAWS: u64 = 48;

/// Random states with their accelerations, drawn on demand.
pub(super) struct Moments<'a> {
    pub(super) problem: &'a Problem,
    pub(super) equations: &'a Equations,
    found: Vec<Moment>,
    draws: u64,
}

impl<'a> Moments<'a> {
    pub(super) fn new(problem: &'a Problem, equations: &'a Equations) -> Self {
        Self { problem, equations, found: Vec::new(), draws: 0 }
    }

    /// State number `index`; `None` if the draws are used up before.
    pub(super) fn get(&mut self, index: usize, graph: &Graph) -> Option<&mut Moment> {
        while self.found.len() <= index && self.draws < DRAWS {
            self.draws += 1;
            self.found.extend(Moment::drawn(graph, self.problem, self.equations, self.draws - 1));
        }
        self.found.get_mut(index)
    }
}

/// Values of parameters, time, coordinates, velocities, accelerations and multipliers at one instant of a motion.
pub(super) struct Moment(Sample);

/// Whether switch `k` is on in a draw: all are in the first, none is in the second, some are in the others.
fn is_on(k: usize, draw: u64) -> bool {
    match draw {
        0 => true,
        1 => false,
        _ => (draw + 2) >> (k % 5) & 1 == 1,
    }
}

impl Moment {
    fn drawn(graph: &Graph, problem: &Problem, equations: &Equations, draw: u64) -> Option<Self> {
        let n = problem.coordinates.len();
        let (coordinates, velocities) = (symbols(n, Variable::Coordinate), symbols(n, Variable::Velocity));
        let parameters = symbols(problem.parameters.entries.len(), Variable::Parameter);
        let switches = symbols(problem.parameters.switches.len(), Variable::Switch);
        let all =
            [&parameters[..], &switches, &coordinates, &velocities, &[Variable::Time.symbol()]].concat();
        let mut moment = Sample::new(all, draw, |symbol, draw| match Variable::of(symbol) {
            Variable::Switch(k) => Approximate::exact(f64::from(u8::from(is_on(k, draw)))),
            _ => problem.drawn(symbol, draw),
        });
        let slopes: Vec<&[Id]> = equations.linear.jacobian.iter().map(Vec::as_slice).collect();
        let is_holonomic = |a: &usize| equations.kinds[*a] == ConstraintKind::Holonomic;
        let holonomic = (0..equations.kinds.len()).filter(is_holonomic);
        let (residual, of_residual): (Vec<Id>, Vec<&[Id]>) =
            holonomic.map(|a| (equations.residual[a], slopes[a])).unzip();
        moment.project(graph, &residual, &of_residual, &coordinates)?;
        moment.project(graph, &equations.rate, &slopes, &velocities)?;
        let mut moment = Self(moment);
        moment.accelerate(graph, problem, equations)?;
        Some(moment)
    }

    pub(super) fn get(&self, variable: Variable) -> Approximate {
        self.0.get(variable.symbol())
    }

    pub(super) fn values(&mut self, graph: &Graph, roots: &[Id]) -> Vec<Approximate> {
        self.0.values(graph, roots)
    }

    /// Solves M q̈ − Fᵀλ = h, F q̈ = −γ for the accelerations and multipliers.
    fn accelerate(&mut self, graph: &Graph, problem: &Problem, equations: &Equations) -> Option<()> {
        let (n, m) = (problem.coordinates.len(), problem.constraints.len());
        let roots = [
            &equations.mass.concat(),
            &equations.forcing,
            &equations.linear.jacobian.concat(),
            &equations.linear.bias,
        ];
        let values = self.0.values(graph, &roots.map(Vec::as_slice).concat());
        let (mass, rest) = values.split_at(n * n);
        let (forcing, rest) = rest.split_at(n);
        let (jacobian, bias) = rest.split_at(n * m);
        let of_coordinates = (0..n).map(|i| {
            let force = (0..m).map(|a| jacobian[a * n + i].negated());
            mass[i * n..][..n].iter().copied().chain(force).chain([forcing[i]]).collect()
        });
        let of_constraints = (0..m).map(|a| {
            let row = jacobian[a * n..][..n].iter().copied();
            row.chain(vec![Approximate::exact(0.0); m]).chain([bias[a].negated()]).collect()
        });
        let solution = solve(of_coordinates.chain(of_constraints).collect(), n + m)?;
        if solution.free[..n].contains(&true) {
            return None;
        }
        let variables = (0..n).map(Variable::Acceleration).chain((0..m).map(Variable::Multiplier));
        self.0.set(variables.map(Variable::symbol).zip(solution.values));
        Some(())
    }
}
