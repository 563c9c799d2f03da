//! Random states that satisfy the constraints, with the accelerations and multipliers that the equations of motion
//! give.

use super::constraints::ConstraintKind;
use super::equations::{Equations, LinearEquations};
use super::switched::RowGroup;
use crate::resolve::{Entry, Problem, SwitchReading};
use crate::symbolic::{Approximate, Graph, Id, Sample, random, solve};
use crate::variables::{Variable, symbols};

/// Largest number of random draws. A draw fails if no state on the constraints, or no acceleration, is found from it.
const DRAWS: u64 = 48;

/// Random states with their accelerations, drawn on demand.
pub(crate) struct Moments<'a> {
    pub(super) problem: &'a Problem,
    pub(super) equations: &'a Equations,
    /// Whether friction slides in some of them.
    slides: bool,
    found: Vec<Moment>,
    draws: u64,
}

impl<'a> Moments<'a> {
    pub(crate) fn new(problem: &'a Problem, equations: &'a Equations, slides: bool) -> Self {
        Self { problem, equations, slides, found: Vec::new(), draws: 0 }
    }

    /// State number `index`; `None` if the draws are used up before.
    pub(super) fn get(&mut self, index: usize, graph: &Graph) -> Option<&mut Moment> {
        while self.found.len() <= index && self.draws < DRAWS {
            self.draws += 1;
            self.found.extend(Moment::drawn(graph, self, self.draws - 1));
        }
        self.found.get_mut(index)
    }
}

/// Values of parameters, time, coordinates, velocities, accelerations and multipliers at one instant of a motion.
pub(crate) struct Moment(pub(crate) Sample);

/// Stream of random numbers for states, used for nothing else.
const STATES: u64 = 252;

/// State of a constraint that can be switched off.
#[derive(Clone, Copy, PartialEq, Eq)]
enum SwitchState {
    /// It holds, and its friction sticks.
    On,
    /// It does not hold; dry friction has its force then.
    Off,
    /// It holds, and its friction slides.
    Slides,
}

impl SwitchState {
    /// State of switch `k` of `count` in a random draw. All constraints hold in the first draw, none in the second, and about two in each
    /// other one, but at most half of them: the more contacts are closed, the more often two of them contradict each other.
    fn of([k, count]: [usize; 2], draw: u64, slides: bool) -> Self {
        let part = f64::min(0.5, 2.0 / count as f64);
        match (draw, random(STATES, k as u64, draw) / part) {
            (0, _) | (2.., ..0.5) => Self::On,
            (2.., 0.5..1.0) if slides => Self::Slides,
            (2.., 0.5..1.0) => Self::On,
            _ => Self::Off,
        }
    }

    fn reading(self, reading: SwitchReading) -> f64 {
        let is_so = match reading {
            SwitchReading::Holds => self != Self::Off,
            SwitchReading::Sticks(_) => self == Self::On,
            SwitchReading::Slides => self == Self::Slides,
            SwitchReading::Slip(component) => {
                let direction = if self == Self::Slides { [0.8, -0.6] } else { [0.0; 2] };
                return direction[component];
            }
            SwitchReading::Start(_) => false,
        };
        f64::from(u8::from(is_so))
    }
}

impl Moment {
    /// State of this random draw; `None` if no state on the constraints, or no acceleration, is found from it.
    pub(crate) fn drawn(graph: &Graph, moments: &Moments, draw: u64) -> Option<Self> {
        let &Moments { problem, equations, slides, .. } = moments;
        let mut entries: Vec<Entry> = problem.parameters.switches.iter().map(|switch| switch.entry).collect();
        entries.sort_unstable();
        entries.dedup();
        let place = |entry: Entry| entries.partition_point(|&other| other < entry);
        let state_of = |entry: Entry| SwitchState::of([place(entry), entries.len()], draw, slides);
        let n = problem.coordinates.len();
        let (coordinates, velocities) = (symbols(n, Variable::Coordinate), symbols(n, Variable::Velocity));
        let parameters = symbols(problem.parameters.entries.len(), Variable::Parameter);
        let switches = symbols(problem.parameters.switches.len(), Variable::Switch);
        let all =
            [&parameters[..], &switches, &coordinates, &velocities, &[Variable::Time.symbol()]].concat();
        let mut moment = Sample::new(all, draw, |symbol, draw| match Variable::of(symbol) {
            Variable::Switch(k) => {
                let switch = &problem.parameters.switches[k];
                Approximate::exact(state_of(switch.entry).reading(switch.reading))
            }
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

    /// Solves the equations of motion for the accelerations and multipliers.
    fn accelerate(&mut self, graph: &Graph, problem: &Problem, equations: &Equations) -> Option<()> {
        let (n, m) = (problem.coordinates.len(), problem.constraints.len());
        let rows = self.rows(graph, equations);
        let roots = [equations.mass.concat(), equations.forcing.clone()].concat();
        let values = self.0.values(graph, &roots);
        let (mass, forcing) = values.split_at(n * n);
        let of_coordinates = (0..n).map(|i| {
            let force = rows.iter().map(|row| row.push[i].negated());
            mass[i * n..][..n].iter().copied().chain(force).chain([forcing[i]]).collect()
        });
        let of_constraints = rows
            .iter()
            .map(|row| row.jacobian.iter().chain(&row.multiples).copied().chain([row.right]).collect());
        let solution = solve(of_coordinates.chain(of_constraints).collect(), n + m)?;
        if solution.free[..n].contains(&true) {
            return None;
        }
        let variables = (0..n).map(Variable::Acceleration).chain((0..m).map(Variable::Multiplier));
        self.0.set(variables.map(Variable::symbol).zip(solution.values));
        Some(())
    }

    /// The equation of each constraint.
    fn rows(&mut self, graph: &Graph, equations: &Equations) -> Vec<Equation> {
        let LinearEquations { coordinates, jacobian, bias, .. } = &equations.linear;
        let m = jacobian.len();
        let zeros = |count| vec![Approximate::exact(0.0); count];
        let Some(switched) = &equations.switched else {
            let rows = jacobian.iter().zip(bias).map(|(row, &bias)| {
                let (row, bias) = (self.0.values(graph, row), self.0.values(graph, &[bias])[0]);
                Equation { push: row.clone(), jacobian: row, multiples: zeros(m), right: bias.negated() }
            });
            return rows.collect();
        };
        let mut rows: Vec<Equation> = (0..m).map(|a| Equation::off(a, *coordinates, m)).collect();
        for RowGroup { is_on, rows: group, .. } in &switched.groups {
            if is_on.is_some_and(|is_on| self.0.values(graph, &[is_on])[0].value == 0.0) {
                continue;
            }
            let first = group[0].constraint;
            for row in group {
                let Equation { jacobian, push, multiples, right } = &mut rows[row.constraint];
                let [compliance, coupling, _, bias] =
                    row.numbers.map(|number| self.0.values(graph, &[number])[0]);
                (multiples[row.constraint], *right) = (compliance, bias.negated());
                if row.constraint != first {
                    multiples[first] = coupling;
                }
                let f = self.0.values(graph, &row.jacobian);
                let b = self.0.values(graph, row.push.as_ref().unwrap_or(&row.jacobian));
                for (&i, (f, b)) in row.columns.iter().zip(f.into_iter().zip(b)) {
                    (jacobian[i], push[i]) = (f, b);
                }
            }
        }
        rows
    }
}

/// F q̈ + c λ = −γ of a constraint, with the row of B along which its multiplier acts.
struct Equation {
    jacobian: Vec<Approximate>,
    push: Vec<Approximate>,
    /// The row of c.
    multiples: Vec<Approximate>,
    right: Approximate,
}

impl Equation {
    /// That of constraint `a` while it is switched off: λ = 0.
    fn off(a: usize, coordinates: usize, constraints: usize) -> Self {
        let zero = Approximate::exact(0.0);
        let mut multiples = vec![zero; constraints];
        multiples[a] = Approximate::exact(1.0);
        Self { jacobian: vec![zero; coordinates], push: vec![zero; coordinates], multiples, right: zero }
    }
}
