//! Equations of motion of systems whose numbers of bodies are known at run time.
//!
//! L is a sum over loops of expressions ℓ in a few slots, elements such as `q[i]` and `q[i+1]`. Each ℓ is differentiated once by
//! its slots; what the derivative by a slot gives belongs to the element at which the slot is in this iteration of the loop, and is
//! added to it. That is ∂L/∂q_k = Σ over iterations and slots of [index of the slot = k] ∂ℓ/∂slot, without a search for the iterations.
//! Slots that meet in one element, such as both ends of a bond from an atom to itself, add up as the chain rule demands.

mod band;
mod conservation;
mod constraints;
mod elimination;
mod hamilton;
mod inertia;
mod patterns;
mod recursion;
mod rows;

use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::resolve::many::Range;
use crate::symbolic::{Forward, Graph, Id};
use crate::variables::{Variable, drift, has_velocity};
pub(crate) use band::{Band, Place, element};
pub(crate) use conservation::ManyConserved;
pub(crate) use constraints::{ConstraintRow, ManyConstraint};
pub(crate) use hamilton::ManyHamilton;
pub(crate) use inertia::{Guarded, Inertia};
pub(crate) use patterns::{Pattern, patterns};
pub(crate) use recursion::{Recursion, Step};
pub(crate) use rows::{ElementRows, ElementSum, Over, Region};

/// Values that loop iterations add to elements of the coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Scatter {
    pub(crate) ranges: Vec<Range>,
    /// Slots, each once, and the values.
    pub(crate) values: Vec<(usize, Id)>,
}

/// Equations M q̈ = h of a system whose number of bodies is known at run time.
pub(crate) struct ManyEquations {
    /// p = ∂L/∂q̇
    pub(crate) momentum: Vec<Scatter>,
    /// h = ∂L/∂q + Q − (dp/dt at q̈ = 0), without the forces of constraints.
    pub(crate) forcing: Vec<Scatter>,
    /// M by blocks, one for each set of coordinates that share it, but for those of `recursion`.
    pub(crate) inertia: Vec<Inertia>,
    pub(crate) recursion: Option<Recursion>,
    pub(crate) constraints: Vec<ManyConstraint>,
    /// F M⁻¹ Fᵀ as a band, if it is one.
    pub(crate) band: Option<Band>,
    /// E = p·q̇ − L
    pub(crate) energy: Id,
    /// The same by loops, to be printed; empty if it has no such form.
    pub(crate) energies: Vec<Pattern>,
    /// Equations of the elements of each array, to be printed; `None` where they have another form.
    pub(crate) rows: Vec<Option<Vec<ElementRows>>>,
    pub(crate) conserved: Vec<ManyConserved>,
    pub(crate) energy_is_conserved: bool,
    /// p of the elements of each array, to be printed, as `rows`; empty with recursions.
    pub(crate) momenta: Vec<Option<Vec<ElementRows>>>,
    /// `None` if momenta do not determine the velocities of each element alone.
    pub(crate) hamilton: Option<ManyHamilton>,
    /// True if L has parts of degree zero and two in the velocities only, proved.
    pub(crate) is_even: bool,
    /// True if neither M nor h depends on velocities.
    pub(crate) forces_are_free_of_velocities: bool,
}

const NOT_A_SUM: &str = "here a sum of velocities, over a length that is known when the program runs, is in a function or times another sum, so that the mass matrix would be full: such sums may be added, and multiplied by what contains no sum";

/// Derives the equations of motion. Reports what cannot be derived, and then returns `None`.
pub(crate) fn derive(
    graph: &mut Graph,
    problem: &mut Problem,
    diagnostics: &mut Diagnostics,
) -> Option<ManyEquations> {
    let patterns = self::patterns(graph, problem, problem.lagrangian);
    if !patterns::have_momenta_of_their_own(graph, &patterns) {
        diagnostics.error(problem.place, NOT_A_SUM);
        return None;
    }
    let dissipation =
        problem.dissipation.map_or(Vec::new(), |(function, _)| self::patterns(graph, problem, function));
    let (mut momentum, mut forcing, mut rates, mut energies) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut rate = drift(graph, problem.many.slots.len());
    for pattern in &patterns {
        let derived = Derived::of(graph, &mut rate, pattern);
        // The value of a function of a sum is in the pattern that contains the function.
        if pattern.factor == Id::ONE {
            energies.push(Pattern { body: derived.energy, ..pattern.clone() });
        }
        push(&mut momentum, graph, &pattern.ranges, derived.momentum);
        push(&mut rates, graph, &pattern.ranges, derived.rate);
        push(&mut forcing, graph, &pattern.ranges, derived.forcing);
    }
    for pattern in &dissipation {
        let slots = slots(graph, pattern.body);
        let slopes = gradient(graph, pattern.body, &slots, Variable::Velocity);
        let factor = graph.neg(pattern.factor);
        let forces =
            slots.into_iter().zip(slopes.into_iter().map(|slope| graph.mul(factor, slope))).collect();
        push_both(graph, [&mut forcing, &mut rates], (&pattern.ranges, forces));
    }
    let mut has_forces = !dissipation.is_empty();
    for force in std::mem::take(&mut problem.many.forces) {
        let values: Vec<Id> = force.values.iter().map(|(_, value)| *value).collect();
        has_forces |= values.iter().any(|&value| value != Id::ZERO);
        push_both(graph, [&mut forcing, &mut rates], (&force.ranges, force.values.clone()));
        problem.many.forces.push(force);
    }
    if let ([_, ..], Some(constraint)) = (&problem.many.recursions[..], problem.many.constraints.first()) {
        diagnostics.error(constraint.place, "constraints beside definitions by recursion are not derived yet: take the positions as coordinates, and a constraint in the place of the recursion, `rod[i in 1..n]: norm(r[i] - r[i-1]) = l`");
        return None;
    }
    let chained = recursion::arrays(graph, problem, diagnostics)?;
    let (mut inertia, mass) = inertia::blocks(graph, problem, (&patterns, &chained), diagnostics)?;
    let is_chained = |block: &mut Inertia| chained.contains(&block.rows[0].0);
    let recursion = match inertia.extract_if(.., is_chained).next() {
        Some(block) => Some(Recursion::of(graph, problem, block, diagnostics)?),
        None => None,
    };
    let parts: Vec<Id> =
        energies.iter().map(|Pattern { ranges, body, .. }| problem.summed(graph, ranges, *body)).collect();
    let energy = graph.total(parts);
    diagnostics.stop_at_fault(problem.place, graph)?;
    let all: Vec<Id> = forcing.iter().flat_map(|scatter| &scatter.values).map(|(_, value)| *value).collect();
    let depends_on_time = depends_on_time(graph, problem);
    let constraints = constraints::derive(graph, problem, diagnostics)?;
    let conserved = match has_forces || recursion.is_some() {
        true => Vec::new(),
        false => conservation::find(graph, problem, (&patterns, &constraints)),
    };
    let recursions = constraints::of_recursions(graph, problem);
    let stated = || constraints.iter().chain(&recursions);
    let is_even = patterns.iter().all(|pattern| is_even(graph, pattern));
    let mut printed = forcing.clone();
    for Scatter { ranges, values } in
        stated().flat_map(|constraint| constraint.forces(graph)).collect::<Vec<_>>()
    {
        push_both(graph, [&mut printed, &mut rates], (&ranges, values));
    }
    let rows = rows::rows(graph, problem, &printed, &mass);
    let momenta = match recursion {
        Some(_) => Vec::new(),
        None => rows::rows(graph, problem, &momentum, &[]),
    };
    let hamilton = match recursion {
        Some(_) => None,
        None => ManyHamilton::of(graph, problem, (&inertia, &momenta), (&energies, &rates)),
    };
    // Where recursions depend on the time, p·q̇ is not the sum over all velocities, and the energy has no form of its own.
    let is_homogeneous = stated().flat_map(|constraint| &constraint.rows).all(|row| row.is_homogeneous);
    if recursion.is_some() && !is_homogeneous {
        energies.clear();
    }
    problem.coordinates = problem.many.labels(&problem.parameters);
    let band = Band::of(graph, problem, (&constraints, &inertia));
    Some(ManyEquations {
        forces_are_free_of_velocities: constraints.is_empty()
            && recursion.is_none()
            && !has_velocity(graph, &problem.many.with_bodies(graph, &all))
            && inertia.iter().all(|block| !block.has_velocity(graph)),
        momentum,
        forcing,
        inertia,
        energy,
        energies,
        rows,
        momenta,
        hamilton,
        is_even,
        conserved,
        energy_is_conserved: !has_forces && !depends_on_time && is_homogeneous,
        recursion,
        band,
        constraints,
    })
}

/// Contributions of one pattern of L.
struct Derived {
    momentum: Vec<(usize, Id)>,
    /// ∂ℓ/∂q
    rate: Vec<(usize, Id)>,
    forcing: Vec<(usize, Id)>,
    energy: Id,
}

impl Derived {
    fn of(graph: &mut Graph, rate: &mut Forward, pattern: &Pattern) -> Self {
        let slots = slots(graph, pattern.body);
        let momenta = gradient(graph, pattern.body, &slots, Variable::Velocity);
        let slopes = gradient(graph, pattern.body, &slots, Variable::Coordinate);
        let slopes: Vec<Id> = slopes.into_iter().map(|slope| graph.mul(pattern.factor, slope)).collect();
        let velocities: Vec<Id> =
            slots.iter().map(|&k| graph.symbol(Variable::Velocity(k).symbol())).collect();
        let power = graph.dot(&momenta, &velocities);
        let of_places: Vec<(usize, Id)> = slots.iter().copied().zip(slopes.iter().copied()).collect();
        let forces = momenta.iter().zip(slopes).map(|(&momentum, slope)| {
            let drift = rate.of(graph, momentum);
            graph.sub(slope, drift)
        });
        let forcing: Vec<(usize, Id)> = slots.iter().copied().zip(forces.collect::<Vec<_>>()).collect();
        let energy = graph.sub(power, pattern.body);
        Self { momentum: slots.into_iter().zip(momenta).collect(), rate: of_places, forcing, energy }
    }
}

/// True if the momenta of a pattern are linear in the velocities, without a part that is free of them.
fn is_even(graph: &mut Graph, pattern: &Pattern) -> bool {
    let slots = slots(graph, pattern.body);
    let momenta = gradient(graph, pattern.body, &slots, Variable::Velocity);
    momenta.into_iter().all(|momentum| {
        let row = gradient(graph, momentum, &slots, Variable::Velocity);
        let is_velocity = |symbol| matches!(Variable::of(symbol), Variable::Velocity(_));
        let at_rest = graph.substituted(momentum, |symbol| is_velocity(symbol).then_some(Id::ZERO));
        !has_velocity(graph, &row) && at_rest == Id::ZERO
    })
}

/// Slots in an expression without sums, by their coordinates or velocities.
fn slots(graph: &Graph, body: Id) -> Vec<usize> {
    let mut slots: Vec<usize> = graph
        .symbols(&[body])
        .filter_map(|symbol| match Variable::of(symbol) {
            Variable::Coordinate(k) | Variable::Velocity(k) => Some(k),
            _ => None,
        })
        .collect();
    slots.sort_unstable();
    slots.dedup();
    slots
}

fn gradient(graph: &mut Graph, of: Id, slots: &[usize], variable: fn(usize) -> Variable) -> Vec<Id> {
    let symbols: Vec<_> = slots.iter().map(|&k| variable(k).symbol()).collect();
    graph.gradient(of, &symbols)
}

/// Adds values to those of the same loops.
fn push(all: &mut Vec<Scatter>, graph: &mut Graph, ranges: &[Range], mut values: Vec<(usize, Id)>) {
    values.retain(|(_, value)| *value != Id::ZERO);
    if values.is_empty() {
        return;
    }
    let place = all.iter().position(|known| known.ranges == ranges).unwrap_or_else(|| {
        all.push(Scatter { ranges: ranges.to_vec(), values: Vec::new() });
        all.len() - 1
    });
    for (slot, value) in values {
        match all[place].values.iter_mut().find(|(known, _)| *known == slot) {
            Some((_, sum)) => *sum = graph.add(*sum, value),
            None => all[place].values.push((slot, value)),
        }
    }
}

fn push_both(
    graph: &mut Graph,
    [one, other]: [&mut Vec<Scatter>; 2],
    (ranges, values): (&[Range], Vec<(usize, Id)>),
) {
    push(one, graph, ranges, values.clone());
    push(other, graph, ranges, values);
}

fn depends_on_time(graph: &Graph, problem: &Problem) -> bool {
    let all = problem.many.with_bodies(graph, &[problem.lagrangian]);
    graph.symbols(&all).any(|symbol| Variable::of(symbol) == Variable::Time)
}
