//! Marker traits of the runtime: statements about a system on which integrators rely.

use super::constraints::ConstraintKind;
use super::equations::Equations;
use crate::symbolic::{Graph, Id, Node, Polynomials};
use crate::variables::Variable;

/// Marker trait of `lagrange_core::structure` that a system implements if its statement is proved. Each variant has the
/// name of the trait.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Marker {
    /// The mass matrix depends on the parameters alone.
    ConstantMassMatrix,
    /// The forces h of M q̈ = h + Fᵀλ do not depend on the velocities.
    VelocityFreeForces,
    /// Every constraint is written without velocities.
    HolonomicConstraints,
    /// There is no constraint.
    Unconstrained,
}

impl Marker {
    pub(crate) const ALL: [Self; 4] =
        [Self::ConstantMassMatrix, Self::VelocityFreeForces, Self::HolonomicConstraints, Self::Unconstrained];

    /// Markers of the system with these equations.
    pub(super) fn proved(graph: &Graph, equations: &Equations) -> Vec<Self> {
        let Equations { mass, forcing, kinds, .. } = equations;
        let holds = |marker: &Self| match marker {
            Self::ConstantMassMatrix => {
                are_free(graph, &mass.concat(), |variable| !matches!(variable, Variable::Parameter(_)))
            }
            Self::VelocityFreeForces => {
                are_free(graph, forcing, |variable| matches!(variable, Variable::Velocity(_)))
            }
            Self::HolonomicConstraints => kinds.iter().all(|kind| *kind == ConstraintKind::Holonomic),
            Self::Unconstrained => kinds.is_empty(),
        };
        Self::ALL.into_iter().filter(holds).collect()
    }
}

/// Largest number of nodes of an entry that is expanded. A pendulum in frames has entries of up to 68 nodes. With this
/// limit an unoptimized macro takes up to 10 ms for a system of the tests. With 1,000 nodes it takes up to 350 ms, and
/// proves no more.
const LONGEST: usize = 100;

/// True if the variables that `varies` selects occur in none of the entries, or cancel in the expanded polynomials:
/// m l² (sin² θ + cos² θ) is free of θ. Entries with more than [`LONGEST`] nodes are not expanded.
fn are_free(graph: &Graph, entries: &[Id], varies: fn(Variable) -> bool) -> bool {
    // A copy, because new nodes would change the order of terms in the emitted code.
    let (mut copy, mut ring) = (Graph::default(), Polynomials::default());
    let is_free = |entry: Id| {
        if graph.reachable(&[entry]).len() > LONGEST {
            return false;
        }
        let entry = copy.copied(graph, &[entry])[0];
        let Some(polynomial) = ring.of(&mut copy, entry) else { return false };
        let bases: Vec<Id> = polynomial.bases().collect();
        !copy.symbols(&bases).any(|symbol| varies(Variable::of(symbol))) && copy.take_fault().is_none()
    };
    dependent(graph, entries, varies).into_iter().all(is_free)
}

/// Entries in which such a variable occurs, each once.
fn dependent(graph: &Graph, entries: &[Id], varies: fn(Variable) -> bool) -> Vec<Id> {
    let mut depends = vec![false; graph.len()];
    for id in graph.reachable(entries) {
        let mut any = matches!(graph.node(id), Node::Symbol(symbol) if varies(Variable::of(*symbol)));
        graph.operands(id, |operand| any |= depends[operand.index()]);
        depends[id.index()] = any;
    }
    let mut found: Vec<Id> = entries.iter().copied().filter(|entry| depends[entry.index()]).collect();
    found.sort_unstable();
    found.dedup();
    found
}
