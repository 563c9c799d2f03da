//! Lagrange's equations where L is stated in frames, without differentiating what moves the frames.
//!
//! Displacements are handed from frame to frame as velocities are, and what belongs to them is handed back: the recursions of
//! Newton and Euler (Featherstone, *Rigid Body Dynamics Algorithms*, chapter 5). Of rigid bodies the forces are known in
//! closed form, of everything else in L by Poincaré's equations.

mod accelerations;
mod bodies;
mod composite;
mod poincare;

use indexmap::IndexMap;
use rustc_hash::{FxHashMap, FxHashSet};

use super::euler_lagrange::forces_along;
use super::gauss::{Form, Velocities};
use crate::resolve::{Body, Frame, Problem, Step, Triple};
use crate::symbolic::{Graph, Id, Node, Rational};
use crate::variables::{Variable, drift, has_velocity, nodes, total_time_derivative};
use accelerations::InTime;

/// The components of the frames' twists as velocities beside the generalized ones.
pub(super) struct Twists<'p> {
    problem: &'p Problem,
    /// q̇, then the rates of rotations by more coordinates than three, then all others.
    velocities: Velocities,
    /// How many of these matrices and vectors are over: q̇ and those rates.
    outer: usize,
    /// Which of the velocities a node is.
    numbers: FxHashMap<Id, usize>,
    /// Whose components the velocities are that are no generalized ones, each once.
    components: Vec<Component>,
    /// The bodies whose kinetic energies are terms of L, and L without them.
    bodies: Vec<Body>,
    others: Id,
}

/// A component of the twist of a frame, and which of the velocities it is.
#[derive(Clone, Copy)]
struct Component {
    frame: usize,
    part: TwistPart,
    axis: usize,
    number: usize,
}

#[derive(Clone, Copy)]
enum TwistPart {
    Turning,
    Moving,
}

/// For each velocity what belongs to it, as a sum.
struct TwistParts(Vec<Vec<(Id, Rational)>>);

/// The kinetic energies of the bodies that are terms of L, and L without them; `None` where there is none.
pub(super) fn kinetic_energies(graph: &mut Graph, problem: &Problem) -> Option<(Vec<Id>, Id)> {
    if problem.bodies.is_empty() {
        return None;
    }
    let (bodies, others) = bodies::apart(graph, problem);
    (!bodies.is_empty()).then(|| (bodies.iter().map(|body| body.energy).collect(), others))
}

impl<'p> Twists<'p> {
    /// `None` where no frame moves.
    pub(super) fn of(graph: &mut Graph, problem: &'p Problem) -> Option<Self> {
        let n = problem.coordinates.len();
        let nodes = nodes(graph, n, Variable::Velocity);
        let numbers = nodes.iter().enumerate().map(|(i, &node)| (node, i)).collect();
        let velocities = Velocities { nodes, rows: Vec::new() };
        let (bodies, others) = bodies::apart(graph, problem);
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

    /// A named number that contains a velocity is one.
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

    /// ∂(vector)/∂(velocity) for each of the outer velocities that it depends on.
    fn columns(&self, graph: &mut Graph, vector: Triple) -> Vec<(usize, Triple)> {
        let outer = &self.velocities.nodes[..self.outer];
        let rows = vector.map(|component| graph.gradient_to(component, outer));
        let columns = (0..outer.len()).map(|j| (j, [rows[0][j], rows[1][j], rows[2][j]]));
        columns.filter(|(_, column)| column.iter().any(|&entry| entry != Id::ZERO)).collect()
    }

    /// M and h, over the accelerations alone.
    pub(super) fn mass_and_forcing(&self, graph: &mut Graph) -> (Vec<Vec<Id>>, Vec<Id>) {
        let n = self.problem.coordinates.len();
        let mut mass = self.mass(graph);
        for k in (n..self.outer).rev() {
            self.put_in(graph, &mut mass, &self.velocities.rows[k - n]);
        }
        (mass, self.handed_back(graph, drift, n))
    }

    /// ∂L/∂q + Q − dp/dt, with accelerations as symbols.
    pub(super) fn left_over(&self, graph: &mut Graph) -> Vec<Id> {
        self.handed_back(graph, total_time_derivative, self.problem.coordinates.len())
    }

    /// The last variable of a form as a sum over those before it: H_ij + g_i H_kj + H_ik g_j + g_i H_kk g_j.
    fn put_in(&self, graph: &mut Graph, matrix: &mut Vec<Vec<Id>>, row: &[Id]) {
        let last = matrix.pop().unwrap_or_default();
        let Some((&own, beside)) = last.split_last() else { return };
        for i in 0..matrix.len() {
            matrix[i].pop();
            for j in 0..=i {
                let both = graph.mul(row[j], own);
                let both = graph.add(both, beside[j]);
                let (forth, back) = (graph.mul(row[i], both), graph.mul(beside[i], row[j]));
                let sum = graph.total([matrix[i][j], forth, back]);
                (matrix[i][j], matrix[j][i]) = (sum, sum);
            }
        }
    }

    /// The form over the rates of the outer velocities, where there are others than q̇, and that over the rates of all.
    pub(super) fn forms(&self, graph: &mut Graph) -> Vec<Form> {
        let n = self.problem.coordinates.len();
        let mut forms = Vec::new();
        if self.outer > n {
            let (mass, forcing) = (self.mass(graph), self.handed_back(graph, drift, self.outer));
            let form = Form::over(mass, forcing, &self.velocities.rows[..self.outer - n]);
            forms.push(form.with(self.rows(graph, self.outer)));
        }
        let momenta = graph.gradient_to(self.problem.lagrangian, &self.velocities.nodes);
        let parts = self.parts(graph, drift);
        let linear = parts.sums(graph);
        let form = self.velocities.form_of(graph, &momenta, linear);
        forms.push(form.with(self.rows(graph, self.velocities.nodes.len())));
        forms
    }

    fn rows(&self, graph: &mut Graph, first: usize) -> Vec<Vec<Id>> {
        self.problem.constraints.iter().map(|&(_, constraint)| self.row(graph, constraint, first)).collect()
    }

    /// What belongs to each of the velocities.
    fn parts(&self, graph: &mut Graph, in_time: InTime) -> TwistParts {
        let mut parts = self.nothing();
        let places = self.places(graph);
        let gravity = self.others_of(graph, in_time, &places, &mut parts);
        self.of_bodies(graph, in_time, gravity, &mut parts);
        for (i, force) in forces_along(graph, self.problem, &self.velocities.nodes).into_iter().enumerate() {
            parts.add(i, force, 1);
        }
        parts
    }

    /// What belongs to the first velocities, with all that the others hand back to them.
    fn handed_back(&self, graph: &mut Graph, in_time: InTime, first: usize) -> Vec<Id> {
        let parts = self.parts(graph, in_time);
        self.hand_back(graph, parts, first)
    }

    /// Parts of the first velocities, from those of all.
    fn hand_back(&self, graph: &mut Graph, mut parts: TwistParts, first: usize) -> Vec<Id> {
        let n = self.problem.coordinates.len();
        for k in (first - n..self.velocities.rows.len()).rev() {
            let sum = graph.sum(std::mem::take(&mut parts.0[n + k]));
            let sum = graph.defined(sum);
            for (i, &entry) in self.velocities.rows[k].iter().enumerate() {
                let part = graph.mul(entry, sum);
                parts.add(i, part, 1);
            }
        }
        parts.0.truncate(first);
        parts.sums(graph)
    }

    /// F of a constraint, over the first velocities.
    pub(super) fn row(&self, graph: &mut Graph, constraint: Id, first: usize) -> Vec<Id> {
        let mut parts = self.nothing();
        if has_velocity(graph, &[constraint]) {
            let slopes = graph.gradient_to(constraint, &self.velocities.nodes);
            slopes.into_iter().enumerate().for_each(|(number, slope)| parts.add(number, slope, 1));
        } else {
            let places = self.places(graph);
            let (_, slopes) = self.slopes(graph, constraint, &places);
            self.at_rest(graph, &places, &slopes, &mut parts);
        }
        self.hand_back(graph, parts, first)
    }

    fn nothing(&self) -> TwistParts {
        TwistParts(vec![Vec::new(); self.velocities.nodes.len()])
    }

    /// The named numbers that say where frames are, each once.
    fn places(&self, graph: &Graph) -> IndexMap<Id, RowOrOrigin> {
        let mut places = IndexMap::new();
        let mut add = |node: Id, place: RowOrOrigin| {
            if matches!(graph.node(node), Node::Defined(_)) {
                places.entry(node).or_insert(place);
            }
        };
        for (frame, Frame { axes, origin, .. }) in self.problem.frames.iter().enumerate() {
            for row in 0..3 {
                add(origin[row], RowOrOrigin { frame, row, of: None });
                (0..3).for_each(|axis| add(axes[row][axis], RowOrOrigin { frame, row, of: Some(axis) }));
            }
        }
        places
    }
}

impl TwistParts {
    fn add(&mut self, number: usize, part: Id, sign: i128) {
        if part != Id::ZERO {
            self.0[number].push((part, Rational::from_integer(sign)));
        }
    }

    fn sums(self, graph: &mut Graph) -> Vec<Id> {
        self.0.into_iter().map(|terms| graph.sum(terms)).collect()
    }
}

/// Of the rows of a frame's axes or of its origin.
#[derive(Clone, Copy)]
struct RowOrOrigin {
    frame: usize,
    row: usize,
    /// Which component of the row; `None` for the origin.
    of: Option<usize>,
}
