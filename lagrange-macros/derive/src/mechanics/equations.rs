//! The equations of motion in symbols, with the momenta, the energy and the constraint residuals that a simulation
//! evaluates.

use super::completion::Completed;
use super::constraints::{ConstraintKind, Multiples};
use super::coordinates::Coordinates;
use super::euler_lagrange::{Momenta, energy};
use super::form::Form;
use super::formulation::Formulation;
use super::integrability::Kinds;
use super::switched::SwitchedEquations;
use super::twists::Twists;
use super::{consistency, constraints, determinacy, dissipation, integrability, vanishing};
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id};
use crate::variables::{Variable, has_velocity, nodes, total_time_derivative};

/// M q̈ − Fᵀλ = h and F q̈ + γ = 0, linear in q̈ and λ.
#[derive(Debug)]
pub(crate) struct LinearEquations {
    /// Number of the coordinates.
    pub(crate) coordinates: usize,
    /// Equivalent quadratic forms of M and h, completed by constraints where M is singular. The first has the
    /// accelerations as its only variables.
    pub(crate) forms: Vec<Form>,
    /// Constraint Jacobian F, row by row
    pub(crate) jacobian: Vec<Vec<Id>>,
    /// γ
    pub(crate) bias: Vec<Id>,
    /// For each constraint of the system, its multiplier if that is known; `None` if it is solved for. Empty if all are solved for.
    pub(crate) given: Vec<Option<Id>>,
}

impl LinearEquations {
    /// M x = h without constraints.
    pub(super) fn of_masses(graph: &mut Graph, mass: Vec<Vec<Id>>, forcing: Vec<Id>) -> Self {
        let coordinates = forcing.len();
        let mut form = Form::new(mass, forcing, Vec::new());
        form.divide_what_is_alone(graph);
        Self { coordinates, forms: vec![form], jacobian: Vec::new(), bias: Vec::new(), given: Vec::new() }
    }

    /// The same with each node replaced.
    pub(super) fn map(&self, mut node: impl FnMut(Id) -> Id) -> Self {
        Self {
            coordinates: self.coordinates,
            forms: self.forms.iter().map(|form| form.map(&mut node)).collect(),
            jacobian: self.jacobian.iter().map(|row| row.iter().map(|&id| node(id)).collect()).collect(),
            bias: self.bias.iter().map(|&id| node(id)).collect(),
            given: self.given.iter().map(|id| id.map(&mut node)).collect(),
        }
    }
}

/// The equations of motion, every entry a node of the problem's graph.
#[derive(Debug)]
pub(crate) struct Equations {
    /// p = ∂L/∂q̇
    pub(crate) momentum: Vec<Id>,
    /// True if M does not depend on the velocities.
    pub(crate) momenta_are_linear: bool,
    /// M = ∂p/∂q̇, row by row
    pub(crate) mass: Vec<Vec<Id>>,
    /// ∂L/∂q + Q: equals dp/dt if there are no constraints
    pub(crate) momentum_rate: Vec<Id>,
    /// h = ∂L/∂q + Q − (dp/dt at q̈ = 0)
    pub(crate) forcing: Vec<Id>,
    /// E = p·q̇ − L
    pub(crate) energy: Id,
    pub(crate) kinds: Vec<ConstraintKind>,
    /// Integrability of each constraint, and of the set.
    pub(crate) integrability: Kinds,
    /// Φ of holonomic constraints, zero for velocity constraints
    pub(crate) residual: Vec<Id>,
    /// F q̇ + b of each constraint
    pub(crate) rate: Vec<Id>,
    /// Scales of the constraint residuals: Σ |F_αi q_i| of holonomic constraints, and Σ |F_αi q̇_i| of all
    pub(crate) magnitudes: [Vec<Id>; 2],
    /// Bounds of the rounding errors of F, in units of the round-off unit, of rows that parameters may cancel; else zero
    pub(crate) jacobian_round_off: Vec<Vec<Id>>,
    /// h to be printed, without switches
    pub(crate) printed_forcing: Vec<Id>,
    /// Fᵀλ and forces that are multiples of multipliers, with the multipliers λ as symbols
    pub(crate) constraint_force: Vec<Id>,
    /// Fᵀλ to be printed, without switches: where a constraint does not hold, its λ is zero, and that of friction is its force
    pub(crate) printed_force: Vec<Id>,
    /// d/dt p − ∂L/∂q − Q − Fᵀλ, with accelerations and multipliers as symbols
    pub(crate) balance: Vec<Id>,
    /// d/dt (F q̇ + b), and what friction that slides adds to it, with accelerations and multipliers as symbols
    pub(crate) constraint_acceleration: Vec<Id>,
    /// Diagonal of c in F q̈ + γ + c λ = 0: zero, but 1 while a switched constraint does not hold
    pub(crate) compliance: Vec<Id>,
    /// What determines accelerations and multipliers where all constraints hold.
    pub(crate) linear: LinearEquations,
    /// The same in parts if some constraints can be switched off.
    pub(crate) switched: Option<SwitchedEquations>,
    /// Lagrangian with the same motions and a regular mass matrix; `None` if no constraint completes M.
    pub(crate) completed: Option<Completed>,
}

impl Equations {
    /// Equations of no coordinate.
    pub(super) fn none() -> Self {
        Self {
            momentum: Vec::new(),
            momenta_are_linear: true,
            mass: Vec::new(),
            momentum_rate: Vec::new(),
            forcing: Vec::new(),
            energy: Id::ZERO,
            kinds: Vec::new(),
            integrability: Kinds { classes: Vec::new(), integrals: None, functions: Vec::new() },
            residual: Vec::new(),
            rate: Vec::new(),
            magnitudes: [Vec::new(), Vec::new()],
            jacobian_round_off: Vec::new(),
            printed_forcing: Vec::new(),
            constraint_force: Vec::new(),
            printed_force: Vec::new(),
            balance: Vec::new(),
            constraint_acceleration: Vec::new(),
            compliance: Vec::new(),
            linear: LinearEquations {
                coordinates: 0,
                forms: Vec::new(),
                jacobian: Vec::new(),
                bias: Vec::new(),
                given: Vec::new(),
            },
            switched: None,
            completed: None,
        }
    }

    /// Derives the equations of motion. Reports why they do not exist, and then returns `None`.
    pub(super) fn derive(
        graph: &mut Graph,
        problem: &Problem,
        diagnostics: &mut Diagnostics,
    ) -> Option<Self> {
        let twists = Twists::of(graph, problem);
        let momenta = Momenta::of(graph, problem);
        let coordinates = Coordinates { problem, momenta: &momenta };
        let formulation: &dyn Formulation = twists.as_ref().map_or(&coordinates, |twists| twists);
        let (mass, mut forcing) = formulation.mass_and_forcing(graph);
        let energy = energy(graph, problem, &momenta.momentum);
        diagnostics.stop_at_fault(problem.place, graph)?;
        dissipation::check(graph, problem, diagnostics);
        let constraints = constraints::derive(graph, problem, formulation, diagnostics)?;
        consistency::check(graph, problem, &constraints, diagnostics)?;
        determinacy::check(problem, &mass, &constraints, diagnostics)?;
        let integrability = integrability::classify(graph, problem, &constraints);
        let forms = Form::all(graph, problem, formulation, (&mass, &forcing), &constraints);
        let constraint_force = constraints.force(graph);
        let printed_force = without_switches(graph, problem, &constraint_force);
        let mut along_motion = total_time_derivative(graph, problem.coordinates.len());
        let acceleration = |(&rate, &sliding): (&Id, &Id)| {
            let acceleration = along_motion.of(graph, rate);
            graph.add(acceleration, sliding)
        };
        let constraint_acceleration =
            constraints.rate.iter().zip(&constraints.sliding).map(acceleration).collect();
        let balance = balance(graph, formulation, &constraint_force);
        let mut momenta = momenta;
        let mut constraint_force = constraint_force;
        let mut multiples = Vec::new();
        if !problem.frictions.is_empty() {
            multiples = without_multiples(graph, &mut forcing);
            let forces = without_multiples(graph, &mut momenta.rate);
            let multipliers = nodes(graph, constraints.kinds.len(), Variable::Multiplier);
            for (sum, of) in constraint_force.iter_mut().zip(forces) {
                let terms = of.into_iter().map(|(a, multiple)| graph.mul(multiple, multipliers[a]));
                let terms: Vec<Id> = terms.collect();
                *sum = graph.total([vec![*sum], terms].concat());
            }
        }
        let completed = Completed::of(graph, (&momenta, &mass), &constraints, &forms[0].completing);
        let magnitudes = [
            constraints.magnitude(graph, Variable::Coordinate, |kind| kind == ConstraintKind::Holonomic),
            constraints.magnitude(graph, Variable::Velocity, |_| true),
        ];
        let linear = LinearEquations {
            coordinates: mass.len(),
            forms,
            jacobian: constraints.jacobian.clone(),
            bias: constraints.bias.clone(),
            given: Vec::new(),
        };
        Some(Self {
            printed_forcing: without_switches(graph, problem, &forcing),
            balance,
            switched: SwitchedEquations::of(graph, problem, (&linear, &constraints), &multiples),
            compliance: constraints.compliance,
            completed,
            integrability,
            momenta_are_linear: !has_velocity(graph, &mass.concat()),
            momentum: momenta.momentum,
            mass,
            momentum_rate: momenta.rate,
            forcing,
            energy,
            constraint_force,
            printed_force,
            constraint_acceleration,
            magnitudes,
            jacobian_round_off: vanishing::round_off(graph, problem, &linear.jacobian),
            kinds: constraints.kinds,
            residual: constraints.residual,
            rate: constraints.rate,
            linear,
        })
    }

    /// All expressions of the equations, as roots in the graph.
    pub(crate) fn roots(&self) -> Vec<Id> {
        let matrices = self.mass.iter().chain(&self.linear.jacobian).flatten();
        let vectors = [
            &self.momentum,
            &self.momentum_rate,
            &self.forcing,
            &self.residual,
            &self.rate,
            &self.linear.bias,
        ];
        matrices
            .chain(vectors.into_iter().flatten())
            .chain([&self.energy])
            .chain(self.integrability.functions.iter().flatten())
            .copied()
            .collect()
    }
}

/// dp/dt − ∂L/∂q − Q − Fᵀλ
fn balance(graph: &mut Graph, formulation: &dyn Formulation, constraint_force: &[Id]) -> Vec<Id> {
    let mut balance = formulation.balance(graph);
    for (sum, &force) in balance.iter_mut().zip(constraint_force) {
        *sum = graph.sub(*sum, force);
    }
    balance
}

/// Takes the multiples of multipliers out of expressions, and returns them.
fn without_multiples(graph: &mut Graph, expressions: &mut [Id]) -> Vec<Vec<(usize, Id)>> {
    let multiples = expressions.iter_mut().map(|expression| {
        let Multiples { rest, of } = Multiples::of(graph, *expression);
        *expression = rest;
        of
    });
    multiples.collect()
}

/// Expressions with all switches on, and without forces of friction that slides: these are its multipliers.
pub(super) fn without_switches(graph: &mut Graph, problem: &Problem, expressions: &[Id]) -> Vec<Id> {
    if problem.parameters.switches.is_empty() {
        return expressions.to_vec();
    }
    let on = |symbol| problem.parameters.switched_on(symbol);
    expressions.iter().map(|&expression| graph.substituted(expression, on)).collect()
}
