//! Total momentum and angular momentum, conserved for any number of bodies.
//!
//! If moving or turning all vectors together leaves each pattern of L as it is, in symbols, Noether's theorem gives P = Σ p_k and
//! J = Σ r_k × p_k.

use super::{ConstraintRow, ManyConstraint, Pattern, gradient, slots};
use crate::mechanics::Symmetry;
use crate::mechanics::evidence::{Evidence, vanishes};
use crate::resolve::Problem;
use crate::resolve::many::Range;
use crate::symbolic::{Graph, Id, Polynomials};
use crate::syntax::numbers;
use crate::variables::Variable;

/// A vector that the motion conserves, proved.
pub(crate) struct ManyConserved {
    pub(crate) symmetry: Symmetry,
    /// Its components, with sums.
    pub(crate) values: Vec<Id>,
    /// The same by loops, to be printed: the components in each.
    pub(crate) patterns: Vec<(Vec<Range>, Vec<Id>)>,
}

/// Finds conserved momenta of a system without generalized forces other than those of constraints. Coordinates must all be vectors of one
/// dimension, or all scalars.
pub(super) fn find(
    graph: &mut Graph,
    problem: &mut Problem,
    (patterns, constraints): (&[Pattern], &[ManyConstraint]),
) -> Vec<ManyConserved> {
    let lengths: Vec<usize> = problem.many.arrays.iter().map(|array| numbers(&array.lengths)).collect();
    let is_uniform = lengths.iter().all(|length| *length == lengths[0])
        && problem.many.arrays.iter().all(|array| array.lengths.len() <= 1);
    let dimension = lengths[0];
    if !is_uniform || dimension > 3 {
        return Vec::new();
    }
    let mut found = Vec::new();
    let rows: Vec<(usize, &ConstraintRow)> = constraints
        .iter()
        .flat_map(|constraint| constraint.rows.iter().map(|row| (constraint.ranges.len(), row)))
        .collect();
    if patterns.iter().all(|pattern| is_moved(graph, problem, pattern, dimension))
        && rows.iter().all(|&row| is_free_of(Symmetry::Translation, graph, problem, row, dimension))
    {
        let of =
            |graph: &mut Graph, all: &[Component]| (0..dimension).map(|c| momentum(graph, all, c)).collect();
        found.push(conserved(graph, problem, patterns, (Symmetry::Translation, dimension), of));
    }
    let turns = !planes(dimension).is_empty()
        && patterns.iter().all(|pattern| is_turned(graph, problem, pattern, dimension))
        && rows.iter().all(|&row| is_free_of(Symmetry::Rotation, graph, problem, row, dimension));
    if turns {
        let by_velocity: (fn(usize) -> Variable, usize) = (Variable::Coordinate, 1);
        let of = |graph: &mut Graph, all: &[Component]| {
            planes(dimension).iter().map(|&plane| moment(graph, all, plane, by_velocity)).collect()
        };
        found.push(conserved(graph, problem, patterns, (Symmetry::Rotation, dimension), of));
    }
    found
}

/// A component of one element in a pattern.
struct Component {
    number: usize,
    /// Slots of all components of the element.
    element: Vec<usize>,
    /// ∂ℓ/∂q and ∂ℓ/∂q̇
    slopes: [Id; 2],
}

fn components(
    graph: &mut Graph,
    problem: &mut Problem,
    pattern: &Pattern,
    dimension: usize,
) -> Vec<Component> {
    let slots = slots(graph, pattern.body);
    let by_place = gradient(graph, pattern.body, &slots, Variable::Coordinate);
    let by_velocity = gradient(graph, pattern.body, &slots, Variable::Velocity);
    let slopes = by_place.into_iter().zip(by_velocity);
    let component = |(slot, (q, v)): (usize, (Id, Id))| {
        let place = problem.many.slots[slot].clone();
        let first = slot - place.number;
        Component { number: place.number, element: (first..first + dimension).collect(), slopes: [q, v] }
    };
    slots.into_iter().zip(slopes).map(component).collect()
}

/// True if ℓ is invariant under a common translation of all vectors.
fn is_moved(graph: &mut Graph, problem: &mut Problem, pattern: &Pattern, dimension: usize) -> bool {
    let all = components(graph, problem, pattern, dimension);
    (0..dimension).all(|c| {
        let slopes: Vec<Id> = all.iter().filter(|one| one.number == c).map(|one| one.slopes[0]).collect();
        let slope = graph.total(slopes);
        is_zero(graph, problem, slope)
    })
}

/// True if ℓ is invariant under a common rotation of all vectors.
fn is_turned(graph: &mut Graph, problem: &mut Problem, pattern: &Pattern, dimension: usize) -> bool {
    let all = components(graph, problem, pattern, dimension);
    planes(dimension).iter().all(|&plane| {
        let coordinates = moment(graph, &all, plane, (Variable::Coordinate, 0));
        let velocities = moment(graph, &all, plane, (Variable::Velocity, 1));
        let slope = graph.add(coordinates, velocities);
        is_zero(graph, problem, slope)
    })
}

/// Coefficients of a constraint in loops of some depth, as slopes of F q̇ + b by the velocities; `None` if some are in deeper loops.
fn coefficients(
    problem: &Problem,
    (depth, row): (usize, &ConstraintRow),
    dimension: usize,
) -> Option<Vec<Component>> {
    let is_own = row.slopes.iter().all(|part| part.ranges.len() == depth);
    let component = |&(slot, slope): &(usize, Id)| {
        let number = problem.many.slots[slot].number;
        let first = slot - number;
        Component { number, element: (first..first + dimension).collect(), slopes: [Id::ZERO, slope] }
    };
    is_own.then(|| row.slopes.iter().flat_map(|part| &part.values).map(component).collect())
}

/// True if the forces of a constraint add up to zero, or for rotations their moments.
fn is_free_of(
    symmetry: Symmetry,
    graph: &mut Graph,
    problem: &Problem,
    row: (usize, &ConstraintRow),
    dimension: usize,
) -> bool {
    let Some(all) = coefficients(problem, row, dimension) else { return false };
    let sums: Vec<Id> = match symmetry {
        Symmetry::Translation => (0..dimension).map(|component| momentum(graph, &all, component)).collect(),
        Symmetry::Rotation => {
            let by_velocity: (fn(usize) -> Variable, usize) = (Variable::Coordinate, 1);
            planes(dimension).iter().map(|&plane| moment(graph, &all, plane, by_velocity)).collect()
        }
    };
    sums.into_iter().all(|sum| is_zero(graph, problem, sum))
}

/// Planes of the components of a moment, each from one axis to another.
fn planes(dimension: usize) -> &'static [[usize; 2]] {
    match dimension {
        2 => &[[0, 1]],
        3 => &[[1, 2], [2, 0], [0, 1]],
        _ => &[],
    }
}

/// True if an expression is zero, proved in symbols.
fn is_zero(graph: &mut Graph, problem: &Problem, id: Id) -> bool {
    if id == Id::ZERO {
        return true;
    }
    match vanishes(graph, problem, id) {
        None => false,
        Some(Evidence::Proved) => true,
        Some(Evidence::Held(_)) => {
            let id = graph.looked_through(id);
            Polynomials::default().of(graph, id).is_some_and(|polynomial| polynomial.is_zero())
        }
    }
}

fn momentum(graph: &mut Graph, all: &[Component], component: usize) -> Id {
    let own: Vec<Id> = all.iter().filter(|one| one.number == component).map(|one| one.slopes[1]).collect();
    graph.total(own)
}

/// Σ x_a s_b − x_b s_a, where x are coordinates or velocities, and s the slopes of ℓ by one of them.
fn moment(
    graph: &mut Graph,
    all: &[Component],
    [a, b]: [usize; 2],
    (variable, slope): (fn(usize) -> Variable, usize),
) -> Id {
    let mut terms = Vec::new();
    for one in all {
        let (arm, is_negative) = match one.number {
            number if number == b => (one.element[a], false),
            number if number == a => (one.element[b], true),
            _ => continue,
        };
        let arm = graph.symbol(variable(arm).symbol());
        let term = graph.mul(arm, one.slopes[slope]);
        terms.push(if is_negative { graph.neg(term) } else { term });
    }
    graph.total(terms)
}

fn conserved(
    graph: &mut Graph,
    problem: &mut Problem,
    patterns: &[Pattern],
    (symmetry, dimension): (Symmetry, usize),
    of: impl Fn(&mut Graph, &[Component]) -> Vec<Id>,
) -> ManyConserved {
    let mut parts = Vec::new();
    for pattern in patterns {
        let components = components(graph, problem, pattern, dimension);
        let values = of(graph, &components);
        if values.iter().any(|&value| value != Id::ZERO) {
            parts.push((pattern.ranges.clone(), values));
        }
    }
    let count = parts.first().map_or(0, |(_, values)| values.len());
    let value = |component: usize| {
        let parts: Vec<Id> =
            parts.iter().map(|(ranges, values)| problem.summed(graph, ranges, values[component])).collect();
        graph.total(parts)
    };
    let values = (0..count).map(value).collect();
    ManyConserved { symmetry, values, patterns: parts }
}
