//! From a [`Problem`] to its equations of motion and what they tell, as the textbook does it.

mod conservation;
mod constraints;
mod degree;
mod determinacy;
mod elimination;
mod euler_lagrange;
mod evidence;
mod facts;
mod gauge;
mod gauss;
mod integrability;
mod linearization;
mod moment;

use crate::diagnostics::{Diagnostics, Place};
use crate::resolve::{Problem, fault_message};
use crate::symbolic::{Approximate, Forward, Graph, Id, Rational, Symbol, Verdict, drawn};
use crate::variables::Variable;
pub(crate) use conservation::Quantity;
pub(crate) use constraints::ConstraintKind;
pub(crate) use evidence::Evidence;
pub(crate) use facts::Facts;
pub(crate) use gauge::LinearPart;
pub(crate) use gauss::Form;
pub(crate) use integrability::{Classification, Integrability, Integrals, Kinds};
use linearization::linearize;
pub(crate) use linearization::{Linearization, arguments};

/// What follows from a problem. Its expressions are nodes of the problem's graph.
pub(crate) struct Derived {
    pub(crate) equations: Equations,
    pub(crate) facts: Facts,
    /// M q̈, as it is read
    pub(crate) inertia: Vec<Id>,
    /// `None` where exact arithmetic cannot write it
    pub(crate) linearization: Option<Linearization>,
}

/// M q̈ − Fᵀλ = h and F q̈ + γ = 0, every entry a node of the problem's graph.
#[derive(Debug)]
pub(crate) struct Equations {
    /// p = ∂L/∂q̇
    pub(crate) momentum: Vec<Id>,
    /// M = ∂p/∂q̇, row by row
    pub(crate) mass: Vec<Vec<Id>>,
    /// ∂L/∂q + Q: dp/dt without constraints
    pub(crate) momentum_rate: Vec<Id>,
    /// h = ∂L/∂q + Q − (dp/dt where q̈ = 0)
    pub(crate) forcing: Vec<Id>,
    /// E = p·q̇ − L
    pub(crate) energy: Id,
    pub(crate) kinds: Vec<ConstraintKind>,
    /// What is integrable
    pub(crate) integrability: Kinds,
    /// Φ of holonomic constraints, zero for the others
    pub(crate) residual: Vec<Id>,
    /// F q̇ + b
    pub(crate) rate: Vec<Id>,
    /// F, row by row
    pub(crate) jacobian: Vec<Vec<Id>>,
    /// γ
    pub(crate) bias: Vec<Id>,
    /// Fᵀλ, in the multipliers' symbols
    pub(crate) constraint_force: Vec<Id>,
    /// M and h as quadratic forms: the first over the accelerations alone
    pub(crate) forms: Vec<Form>,
}

impl Equations {
    /// Every entry.
    pub(crate) fn roots(&self) -> Vec<Id> {
        let matrices = self.mass.iter().chain(&self.jacobian).flatten();
        let vectors =
            [&self.momentum, &self.momentum_rate, &self.forcing, &self.residual, &self.rate, &self.bias];
        matrices
            .chain(vectors.into_iter().flatten())
            .chain([&self.energy])
            .chain(self.integrability.functions.iter().flatten())
            .copied()
            .collect()
    }
}

/// All that follows from a problem; `None` where it has no equations of motion or something said of it is wrong,
/// which is then reported.
pub(crate) fn derive(graph: &mut Graph, problem: &Problem, diagnostics: &mut Diagnostics) -> Option<Derived> {
    let equations = equations(graph, problem, diagnostics)?;
    let facts = Facts::find(graph, problem, &equations, diagnostics);
    let inertia = equations.mass.iter().map(|row| inertia(graph, row)).collect();
    stop_at_fault(graph, problem.place, diagnostics)?;
    diagnostics.is_empty().then_some(())?;
    let linearization = linearize(graph, problem, &equations);
    Some(Derived { equations, facts, inertia, linearization })
}

fn equations(graph: &mut Graph, problem: &Problem, diagnostics: &mut Diagnostics) -> Option<Equations> {
    let motion = euler_lagrange::derive(graph, problem);
    reject_idle_dissipation(graph, problem, diagnostics);
    stop_at_fault(graph, problem.place, diagnostics)?;
    let constraints = constraints::derive(graph, problem, diagnostics)?;
    determinacy::check(problem, &motion, &constraints, diagnostics)?;
    let integrability = integrability::classify(graph, problem, &constraints);
    Some(Equations {
        forms: Form::all(graph, problem, &motion),
        integrability,
        momentum: motion.momentum,
        mass: motion.mass,
        momentum_rate: motion.momentum_rate,
        forcing: motion.forcing,
        energy: motion.energy,
        constraint_force: constraints.force(graph),
        kinds: constraints.kinds,
        residual: constraints.residual,
        rate: constraints.rate,
        jacobian: constraints.jacobian,
        bias: constraints.bias,
    })
}

/// Σ_j M_ij q̈_j of a row of M.
fn inertia(graph: &mut Graph, row: &[Id]) -> Id {
    let mut term = |(j, &mass)| {
        let acceleration = graph.symbol(Variable::Acceleration(j).symbol());
        (graph.mul(mass, acceleration), Rational::from_integer(1))
    };
    let terms: Vec<_> = row.iter().enumerate().map(&mut term).collect();
    graph.sum(terms)
}

/// Whether an expression is zero everywhere, and why one may think so.
fn vanishes(graph: &mut Graph, problem: &Problem, root: Id) -> Option<Evidence> {
    if root == Id::ZERO {
        return Some(Evidence::Proved);
    }
    // Most of what is not zero shows it at the first point, and need not be looked through.
    let symbol = |symbol| Approximate::exact(drawn(symbol, problem.range(symbol), 0));
    if graph.sample(&[root], 0, symbol)[0].excludes_zero() {
        return None;
    }
    match graph.is_zero(root, |symbol| problem.range(symbol)) {
        Verdict::Zero => Some(Evidence::Proved),
        Verdict::Held(points) => Some(Evidence::Held(points)),
        Verdict::NonZero | Verdict::Undecided => None,
    }
}

/// −∂D/∂q̇ is nothing where D has no velocity in it.
fn reject_idle_dissipation(graph: &Graph, problem: &Problem, diagnostics: &mut Diagnostics) {
    let is_velocity = |symbol| matches!(Variable::of(symbol), Variable::Velocity(_));
    if let Some((function, place)) = problem.dissipation
        && !graph.symbols(&[function]).any(is_velocity)
    {
        diagnostics.error(place, "no velocity occurs in this dissipation function, so it does nothing");
    }
}

fn stop_at_fault(graph: &mut Graph, place: Place, diagnostics: &mut Diagnostics) -> Option<()> {
    let fault = graph.take_fault();
    if let Some(fault) = fault {
        diagnostics.error(place, format!("in the derivatives of this: {}", fault_message(fault)));
    }
    fault.is_none().then_some(())
}

/// The symbols of one variable of every coordinate.
fn symbols(count: usize, variable: fn(usize) -> Variable) -> Vec<Symbol> {
    (0..count).map(|i| variable(i).symbol()).collect()
}

/// d/dt along a motion whose accelerations are zero.
fn drift(graph: &mut Graph, coordinates: usize) -> Forward {
    let mut seeds = vec![(Variable::Time.symbol(), Id::ONE)];
    for i in 0..coordinates {
        seeds.push((Variable::Coordinate(i).symbol(), graph.symbol(Variable::Velocity(i).symbol())));
    }
    Forward::along(seeds)
}
