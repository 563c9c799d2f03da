//! Symmetries of space: translations and rotations of all vectors together, with the momentum and the angular momentum that they
//! conserve by Noether's theorem.

use super::conservation::{Conserved, ConservedKind, Symmetry};
use super::equations::Equations;
use super::euler_lagrange::generalized_forces;
use super::evidence::{Evidence, vanishes};
use crate::resolve::{Problem, vectors};
use crate::symbolic::{Forward, Graph, Id, Polynomials};
use crate::variables::{Variable, drift, nodes};

/// Components of the conserved momentum and angular momentum of all vectors of space, or of a plane. Nothing is gained by one that
/// consists of momenta that are all conserved by themselves.
pub(super) fn totals(
    graph: &mut Graph,
    problem: &Problem,
    equations: &Equations,
    momenta: &[Conserved],
) -> Vec<Conserved> {
    let bodies = bodies(problem);
    let is_known = |a: usize| momenta.iter().any(|known| known.quantity == ConservedKind::Momentum(a));
    let n = bodies.first().map_or(0, Vec::len);
    let translations = (0..n).map(|k| (Symmetry::Translation, k));
    // A plane has one axis only.
    let rotations =
        (0..3).filter(|axis| n == 3 || (n, *axis) == (2, 2)).map(|axis| (Symmetry::Rotation, axis));
    let found = translations.chain(rotations).filter_map(|(symmetry, axis)| {
        let moved = displacements(graph, problem, &bodies, (symmetry, axis));
        let mut parts = moved.iter().enumerate().filter(|(_, moved)| **moved != Id::ZERO);
        (!parts.all(|(a, _)| is_known(a))).then_some(())?;
        let evidence = evidence(graph, problem, equations, &moved)?;
        let momenta = nodes(graph, moved.len(), Variable::Momentum);
        let values = [&equations.momentum, &momenta].map(|momenta| graph.dot(momenta, &moved));
        let component = Some(axis).filter(|&axis| axis < n);
        let name = component.map_or(symmetry.name().to_owned(), |k| format!("{}[{k}]", symmetry.name()));
        Some(Conserved { name, quantity: ConservedKind::Total(symmetry, component, values), evidence })
    });
    found.collect()
}

/// Coordinates of each vector with three components, or with two if none has three.
fn bodies(problem: &Problem) -> Vec<Vec<usize>> {
    let mut first = 0;
    let groups = vectors(&problem.coordinates).map(|labels| {
        first += labels.len();
        (first - labels.len()..first).collect::<Vec<usize>>()
    });
    let groups: Vec<Vec<usize>> = groups.filter(|group| (2..=3).contains(&group.len())).collect();
    let n = groups.iter().map(Vec::len).max();
    groups.into_iter().filter(|group| Some(group.len()) == n).collect()
}

/// δq of each coordinate: a unit vector, or the cross product of one with each of the vectors.
fn displacements(
    graph: &mut Graph,
    problem: &Problem,
    bodies: &[Vec<usize>],
    (symmetry, axis): (Symmetry, usize),
) -> Vec<Id> {
    let coordinates = nodes(graph, problem.coordinates.len(), Variable::Coordinate);
    let mut moved = vec![Id::ZERO; coordinates.len()];
    for body in bodies {
        match symmetry {
            Symmetry::Translation => moved[body[axis]] = Id::ONE,
            Symmetry::Rotation => {
                let [i, j] = [1, 2].map(|k| body[(axis + k) % 3]);
                (moved[i], moved[j]) = (graph.neg(coordinates[j]), coordinates[i]);
            }
        }
    }
    moved
}

/// Proof or numerical evidence that the displacement δq changes neither L nor the work of the forces.
fn evidence(graph: &mut Graph, problem: &Problem, equations: &Equations, moved: &[Id]) -> Option<Evidence> {
    let mut along_motion = drift(graph, moved.len());
    let seeds = moved.iter().enumerate().flat_map(|(i, &shift)| {
        let rate = along_motion.of(graph, shift);
        [(Variable::Coordinate(i).symbol(), shift), (Variable::Velocity(i).symbol(), rate)]
    });
    let change = Forward::along(seeds.collect::<Vec<_>>()).of(graph, problem.lagrangian);
    let forces = generalized_forces(graph, problem);
    let multipliers = nodes(graph, problem.constraints.len(), Variable::Multiplier);
    let power = graph.dot(&forces, moved);
    // The constraint forces contain the forces that are multiples of multipliers.
    let parts = [change, graph.without(power, &multipliers), graph.dot(&equations.constraint_force, moved)];
    let total = graph.total(parts);
    let evidence = vanishes(graph, problem, total)?;
    let total = graph.looked_through(total);
    let is_proved = Polynomials::default().of(graph, total).is_some_and(|total| total.is_zero());
    Some(if is_proved { Evidence::Proved } else { evidence })
}
