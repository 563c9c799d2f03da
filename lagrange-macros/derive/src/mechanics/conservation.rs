//! Conserved quantities: momenta of cyclic coordinates, the energy, and observables declared as conserved.
//!
//! A quantity that symbols do not prove conserved is tested on random states. There its rate of change along the
//! motion is a number with an error bound.

use super::constraints::ConstraintKind;
use super::equations::Equations;
use super::euler_lagrange;
use super::evidence::{Evidence, vanishes};
use super::moment::{Moment, Moments};
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::{Approximate, Forward, Graph, Id, Verdict};
use crate::variables::{Variable, nodes};

/// Number of random states at which a quantity must pass the test to count as conserved.
const STATES: u32 = 8;
/// The same for a system with contacts: other contacts are closed in each state. There is no state where closed contacts contradict one
/// another, as two opposite walls do; if fewer states are found therefore, [`STATES`] are enough.
const STATES_OF_SWITCHES: u32 = 24;
/// Largest number of coordinates plus constraints for which random states are tried unasked. Quantities declared as
/// conserved are always tested.
const LARGE: usize = 120;
/// Largest error bound of a rate that is zero within it, relative to the sum of magnitudes of its terms. A less
/// accurate rate is not counted.
const INFORMATIVE: f64 = 1e-6;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum ConservedKind {
    /// Generalized momentum of this coordinate.
    Momentum(usize),
    /// Momentum or angular momentum of all vectors together: symmetry, component, and value in velocities and in momenta. In a plane,
    /// the angular momentum is one number.
    Total(Symmetry, Option<usize>, [Id; 2]),
    Energy,
    /// One entry of an observable: indices of the observable and of the entry.
    Observable(usize, usize),
}

/// Symmetry of space.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Symmetry {
    Translation,
    Rotation,
}

impl Symmetry {
    /// Name of the conserved quantity.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Translation => "momentum",
            Self::Rotation => "angular_momentum",
        }
    }
}

#[derive(Debug)]
pub(crate) struct Conserved {
    pub(crate) name: String,
    pub(crate) quantity: ConservedKind,
    pub(crate) evidence: Evidence,
}

/// A term of dE/dt.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum EnergyChange {
    /// −∂L/∂t
    Time,
    /// Q·q̇
    Forces,
    /// −λ·b, with b the inhomogeneous part of the constraints F q̇ + b = 0
    Constraints,
}

/// Result of the test of a quantity on random states.
enum Trial {
    Held(u32),
    /// The rate is not zero: index of the state, value of the quantity and its rate of change.
    Broken(usize, Approximate, Approximate),
    /// The rate is accurate enough at too few states.
    Undecided,
}

/// Evidence that random motions conserve `quantity`. `None` if they do not, if the test is undecided, if the system
/// exceeds [`LARGE`], or if forces have kinks, beyond which no random state may lie.
pub(super) fn found(graph: &mut Graph, moments: &mut Moments, quantity: Id) -> Option<Evidence> {
    let Moments { problem, equations, .. } = moments;
    let is_large = problem.coordinates.len() + problem.constraints.len() > LARGE;
    if is_large || graph.is_piecewise(&equations.momentum_rate) || graph.is_piecewise(&equations.rate) {
        return None;
    }
    match trial(graph, moments, quantity) {
        Trial::Held(states) => Some(Evidence::Held(states)),
        Trial::Broken(..) | Trial::Undecided => None,
    }
}

/// The energy if it is a conserved quantity, as long as nothing slides, and the terms of its rate that do not vanish
/// individually.
pub(super) fn of_energy(
    graph: &mut Graph,
    moments: &mut Moments,
) -> (Option<Conserved>, Vec<(EnergyChange, Id)>) {
    let &mut Moments { problem, equations, .. } = moments;
    let changes = energy_changes(graph, problem, equations);
    let rate = graph.total(changes.map(|(_, part)| part));
    let evidence = match graph.is_zero(rate, |symbol, draw| problem.drawn(symbol, draw)) {
        Verdict::NonZero if !problem.constraints.is_empty() => found(graph, moments, equations.energy),
        verdict => Evidence::of(verdict),
    };
    let conserved =
        |evidence| Conserved { name: "energy".to_owned(), quantity: ConservedKind::Energy, evidence };
    let remain = changes.into_iter().filter(|&(_, part)| vanishes(graph, problem, part).is_none());
    (evidence.map(conserved), remain.collect())
}

/// dE/dt = −∂L/∂t + Q·q̇ − Σ_α λ_α b_α
fn energy_changes(graph: &mut Graph, problem: &Problem, equations: &Equations) -> [(EnergyChange, Id); 3] {
    let mut along_time = Forward::along([(Variable::Time.symbol(), Id::ONE)]);
    let explicit = along_time.of(graph, problem.lagrangian);
    let velocities = nodes(graph, problem.coordinates.len(), Variable::Velocity);
    let forces = euler_lagrange::generalized_forces(graph, problem);
    let power = graph.dot(&forces, &velocities);
    // b of F q̇ + b
    let inhomogeneous = (0..problem.constraints.len()).map(|a| match equations.kinds[a] {
        ConstraintKind::Holonomic => along_time.of(graph, equations.residual[a]),
        ConstraintKind::Velocity => {
            let homogeneous = graph.dot(&equations.linear.jacobian[a], &velocities);
            graph.sub(equations.rate[a], homogeneous)
        }
    });
    let inhomogeneous: Vec<Id> = inhomogeneous.collect();
    let multipliers = nodes(graph, inhomogeneous.len(), Variable::Multiplier);
    let work = graph.dot(&multipliers, &inhomogeneous);
    [
        (EnergyChange::Time, graph.neg(explicit)),
        (EnergyChange::Forces, power),
        (EnergyChange::Constraints, graph.neg(work)),
    ]
}

/// Tests the quantities declared as conserved. Reports those that are not conserved or cannot be tested.
pub(super) fn of_observables(
    graph: &mut Graph,
    moments: &mut Moments,
    diagnostics: &mut Diagnostics,
) -> Vec<Conserved> {
    let problem = moments.problem;
    let mut conserved = Vec::new();
    for &(observable, place) in &problem.conserved {
        let observed = &problem.observables[observable];
        if observed.values.iter().all(|&value| graph.as_number(value).is_some()) {
            diagnostics.error(place, "a number is conserved by every motion: write the function of coordinates and velocities that keeps its value, `#[conserved(name = expression)]`");
            continue;
        }
        for (entry, (name, &value)) in observed.names().into_iter().zip(&observed.values).enumerate() {
            match trial(graph, moments, value) {
                Trial::Held(states) => conserved.push(Conserved {
                    name,
                    quantity: ConservedKind::Observable(observable, entry),
                    evidence: Evidence::Held(states),
                }),
                Trial::Broken(index, value, rate) => {
                    let moment = moments.get(index, graph);
                    let moment = moment.map(|moment| written(moment, problem)).unwrap_or_default();
                    let (value, rate, suspects) = (short(value), short(rate), suspects(graph, problem));
                    diagnostics.error(place, format!(
                        "`{name}` is not conserved: at {moment} it is {value} and changes at the rate {rate}{suspects}"
                    ));
                }
                Trial::Undecided => diagnostics.error(place, format!(
                    "whether `{name}` is conserved cannot be tried: too few states were found that satisfy the constraints and where its rate of change has a value; give ranges to the parameters, `#[parameter(l: 1..2)]`, or make it an `observable`"
                )),
            }
        }
    }
    conserved
}

/// Tests dX/dt = ∂X/∂t + ∂X/∂q·q̇ + ∂X/∂q̇·q̈ = 0 on random states that satisfy the constraints.
fn trial(graph: &mut Graph, moments: &mut Moments, quantity: Id) -> Trial {
    let n = moments.problem.coordinates.len();
    let state = (0..n).map(Variable::Coordinate).chain((0..n).map(Variable::Velocity));
    let state: Vec<_> = state.chain([Variable::Time]).map(Variable::symbol).collect();
    let mut roots = graph.gradient(quantity, &state);
    roots.push(quantity);
    let states = if moments.equations.switched.is_some() { STATES_OF_SWITCHES } else { STATES };
    let mut held = 0;
    for index in 0.. {
        let Some(moment) = moments.get(index, graph) else { break };
        let mut slopes = moment.values(graph, &roots);
        let value = slopes.pop().unwrap_or(Approximate::exact(f64::NAN));
        let rates = (0..n).map(Variable::Velocity).chain((0..n).map(Variable::Acceleration));
        let rates: Vec<_> =
            rates.map(|variable| moment.get(variable)).chain([Approximate::exact(1.0)]).collect();
        let rate = Approximate::dot(slopes.iter().copied().zip(rates.iter().copied()));
        if rate.excludes_zero() {
            return Trial::Broken(index, value, rate);
        }
        // Rates below 1 count as 1, so that a state at rest has a scale, too.
        let size: f64 = slopes.iter().zip(&rates).map(|(s, r)| s.value.abs() * r.value.abs().max(1.0)).sum();
        if rate.error <= INFORMATIVE * size {
            held += 1;
        }
        if held == states {
            break;
        }
    }
    if held >= STATES { Trial::Held(held) } else { Trial::Undecided }
}

/// The state and the parameters as text for a message, at most `ROOM` coordinates and parameters.
fn written(moment: &Moment, problem: &Problem) -> String {
    const ROOM: usize = 4;
    let coordinates = problem.coordinates.iter().take(ROOM).enumerate().flat_map(|(i, label)| {
        let (base, index) = label.text.split_at(label.text.find('[').unwrap_or(label.text.len()));
        let (q, v) = (moment.get(Variable::Coordinate(i)), moment.get(Variable::Velocity(i)));
        [format!("{} = {}", label.text, short(q)), format!("{base}_dot{index} = {}", short(v))]
    });
    let parameters = (0..problem.parameters.entries.len())
        .take(ROOM)
        .map(|k| format!("{} = {}", problem.parameters.name(k), short(moment.get(Variable::Parameter(k)))));
    let more = problem.coordinates.len().max(problem.parameters.entries.len()) > ROOM;
    let all = coordinates.chain(parameters).chain(more.then(|| "…".to_owned()));
    all.collect::<Vec<_>>().join(", ")
}

/// Formats a number with four digits.
fn short(number: Approximate) -> String {
    let value = number.value;
    match value.abs() {
        size if size == 0.0 || (1e-3..1e4).contains(&size) => format!("{value:.4}"),
        _ => format!("{value:.3e}"),
    }
}

/// Lists the parts of the system that may break a conservation law, as text for a message.
fn suspects(graph: &Graph, problem: &Problem) -> String {
    let has_time = |roots: &[Id]| graph.symbols(roots).any(|symbol| Variable::of(symbol) == Variable::Time);
    let mut suspects = Vec::new();
    if has_time(&[problem.lagrangian]) {
        suspects.push("the time in the Lagrangian".to_owned());
    }
    if problem.forces.iter().any(|&force| force != Id::ZERO) || !problem.powers.is_empty() {
        suspects.push("the forces".to_owned());
    }
    if problem.dissipation.is_some() {
        suspects.push("the dissipation".to_owned());
    }
    let constraints = problem.constraints.iter().take(3);
    suspects.extend(constraints.map(|(label, _)| format!("the force of the constraint `{}`", label.text)));
    suspects.extend(
        (!problem.functions.is_empty())
            .then(|| "the supplied functions, for which it tries random ones".to_owned()),
    );
    match suspects.is_empty() {
        true => "; look for a wrong sign or factor in it".to_owned(),
        false => format!("; what may change it: a wrong sign or factor in it, {}", suspects.join(", ")),
    }
}
