//! Components of the twists of frames, as velocities besides the generalized ones.

use rustc_hash::{FxHashMap, FxHashSet};

use super::super::kinetic::apart;
use super::super::velocities::Velocities;
use crate::resolve::{Body, Frame, Problem, Step, Triple};
use crate::symbolic::{Graph, Id, Node};
use crate::variables::{Variable, has_velocity, nodes};

/// Twist components of all frames, as velocities besides the generalized ones.
pub(crate) struct Twists<'p> {
    pub(super) problem: &'p Problem,
    /// q̇, then the rates of rotations by more than three coordinates, then all other twist components.
    pub(super) velocities: Velocities,
    /// Number of outer velocities, the first of `velocities`: q̇ and the rates of rotations by more than three
    /// coordinates. The mass matrix is first derived over these.
    pub(super) outer: usize,
    /// Index of each node among the velocities.
    pub(super) numbers: FxHashMap<Id, usize>,
    /// Frame, part and axis of each velocity beyond the generalized ones, each once.
    pub(super) components: Vec<Component>,
    /// The bodies whose kinetic energies are terms of L, and L without them.
    pub(super) bodies: Vec<Body>,
    pub(super) others: Id,
}

/// A component of the twist of a frame, and its index `number` among the velocities.
#[derive(Clone, Copy)]
pub(super) struct Component {
    pub(super) frame: usize,
    pub(super) part: TwistPart,
    pub(super) axis: usize,
    pub(super) number: usize,
}

#[derive(Clone, Copy)]
pub(super) enum TwistPart {
    Turning,
    Moving,
}

impl<'p> Twists<'p> {
    /// `None` if no frame moves.
    pub(crate) fn of(graph: &mut Graph, problem: &'p Problem) -> Option<Self> {
        let n = problem.coordinates.len();
        let nodes = nodes(graph, n, Variable::Velocity);
        let numbers = nodes.iter().enumerate().map(|(i, &node)| (node, i)).collect();
        let velocities = Velocities { nodes, rows: Vec::new() };
        let (bodies, others) = apart(graph, problem);
        let mut twists =
            Self { problem, velocities, outer: n, numbers, components: Vec::new(), bodies, others };
        for frame in &problem.frames {
            if let Step::Turned(turned) = &frame.step
                && twists.columns(graph, turned.rate).len() > 3
            {
                turned.rate.iter().for_each(|&node| twists.add(graph, node));
            }
        }
        twists.outer = twists.velocities.nodes.len();
        twists.add_components(graph);
        (!twists.components.is_empty()).then_some(twists)
    }

    fn add_components(&mut self, graph: &mut Graph) {
        let mut seen: FxHashSet<Id> = FxHashSet::default();
        for (frame, Frame { angular_velocity, velocity, .. }) in self.problem.frames.iter().enumerate() {
            for (part, vector) in [(TwistPart::Turning, angular_velocity), (TwistPart::Moving, velocity)] {
                for (axis, &node) in vector.iter().enumerate() {
                    self.add(graph, node);
                    let number = self.numbers.get(&node).copied().filter(|_| seen.insert(node));
                    if let Some(number) = number.filter(|&number| number >= self.problem.coordinates.len()) {
                        self.components.push(Component { frame, part, axis, number });
                    }
                }
            }
        }
    }

    /// Adds `node` to the velocities if it is a definition that contains a velocity.
    fn add(&mut self, graph: &mut Graph, node: Id) {
        let &Node::Defined(inner) = graph.node(node) else { return };
        if self.numbers.contains_key(&node) || !has_velocity(graph, &[node]) {
            return;
        }
        let row = graph.gradient_to(inner, &self.velocities.nodes);
        self.numbers.insert(node, self.velocities.nodes.len());
        self.velocities.nodes.push(node);
        self.velocities.rows.push(row);
    }

    /// For each [outer velocity](Self::outer) that the vector depends on, its index and
    /// ∂(vector)/∂(velocity).
    pub(super) fn columns(&self, graph: &mut Graph, vector: Triple) -> Vec<(usize, Triple)> {
        let outer = &self.velocities.nodes[..self.outer];
        let rows = vector.map(|component| graph.gradient_to(component, outer));
        let columns = (0..outer.len()).map(|j| (j, [rows[0][j], rows[1][j], rows[2][j]]));
        columns.filter(|(_, column)| column.iter().any(|&entry| entry != Id::ZERO)).collect()
    }
}
