//! Trees of rigid bodies, for the derivatives of their inertial forces by composite bodies.

use std::iter::successors;

use super::Twists;
use crate::resolve::{Body, Frame, Problem, Step, Triple, named, sum, symmetric};
use crate::symbolic::{Graph, Id, Rational};
use crate::variables::{Variable, nodes, symbols, total_time_derivative};

/// Rigid bodies in a tree of joints, and the generalized forces beside their inertia and their weight.
pub(crate) struct BodyTree {
    /// Depth first: a joint comes after the one that carries it, and all that it carries come next.
    pub(crate) joints: Vec<TreeJoint>,
    /// Joint by joint.
    pub(crate) columns: Vec<TreeColumn>,
    /// Pairs of columns of one joint, with the derivative of the axis of the first by the coordinate of the second.
    pub(crate) bends: Vec<([usize; 2], Triple)>,
    pub(crate) bodies: Vec<TreeBody>,
    /// −g for uniform gravity g, along the fixed axes.
    pub(crate) fixed: Triple,
    /// Negative generalized force on each coordinate, without inertial forces and weights of the bodies and without
    /// constraint forces.
    pub(crate) rest: Vec<Id>,
}

/// A frame that moves in the one before or carries bodies.
pub(crate) struct TreeJoint {
    /// Index of the joint that carries this one.
    pub(crate) before: Option<usize>,
    pub(crate) turns: bool,
    /// Index of the first of its columns, and of the first after them.
    pub(crate) columns: [usize; 2],
    /// Number of columns of the joints that carry this one.
    pub(crate) depth: usize,
    /// Rotation matrix to the fixed axes, by rows.
    pub(crate) axes: [Triple; 3],
    /// Origin, from that of the frame where the tree starts to carry bodies or to branch.
    pub(crate) origin: Triple,
}

/// A coordinate that moves a frame in the one before.
pub(crate) struct TreeColumn {
    pub(crate) coordinate: usize,
    /// Angular velocity along the axes after a rotation, or velocity, for the unit rate of the coordinate.
    pub(crate) axis: Triple,
    /// First and second derivative of the axis by the time; `None` if it is constant.
    pub(crate) rates: Option<[Triple; 2]>,
}

/// A body, with the inertia about its centre of mass.
pub(crate) struct TreeBody {
    pub(crate) joint: usize,
    pub(crate) mass: Id,
    pub(crate) centre: Triple,
    pub(crate) inertia: [Triple; 3],
}

impl BodyTree {
    /// `None` without rigid bodies, with fewer columns than `least`, where frames or bodies depend on the time or on
    /// functions that the user supplies, and where switches or friction change the forces.
    pub(in super::super) fn of(graph: &mut Graph, twists: &Twists, least: usize) -> Option<Self> {
        let problem = twists.problem;
        let is_smooth = problem.parameters.switches.is_empty() && problem.frictions.is_empty();
        (is_smooth && !twists.bodies.is_empty() && is_still(graph, problem)).then_some(())?;
        let (joints, columns, bends, bodies, rest) = Default::default();
        let mut tree = Self { joints, columns, bends, bodies, fixed: [Id::ZERO; 3], rest };
        let numbers = tree.add_joints(graph, twists);
        (tree.columns.len() >= least).then_some(())?;
        let half = Rational::new(1, 2);
        for &Body { frame, mass, centre, central, .. } in &twists.bodies {
            // The antisymmetric part of an inertia matrix does not contribute.
            let inertia = symmetric(|i, j| graph.sum([(central[i][j], half), (central[j][i], half)]));
            tree.bodies.push(TreeBody { joint: numbers[frame]?, mass, centre, inertia });
        }
        let mut rest = twists.nothing();
        let places = twists.places(graph);
        tree.fixed = twists.others_of(graph, total_time_derivative, &places, &mut rest, None);
        twists.given_forces(graph, &mut rest);
        let rest = twists.hand_back(graph, rest, problem.coordinates.len());
        tree.rest = rest.into_iter().map(|force| graph.neg(force)).collect();
        tree.is_given(graph).then_some(tree)
    }

    /// Adds the joints depth first. Returns the index of the joint that each frame belongs to.
    fn add_joints(&mut self, graph: &mut Graph, twists: &Twists) -> Vec<Option<usize>> {
        let frames = &twists.problem.frames;
        let origins = twists.origins(graph);
        let mut numbers = vec![None; frames.len()];
        let mut order: Vec<usize> = (0..frames.len()).collect();
        order.sort_by_cached_key(|&frame| carriers(frames, frame));
        for number in order {
            let Frame { before, step, axes, .. } = &frames[number];
            let (before, first) = (numbers[*before], self.columns.len());
            self.add_columns(graph, twists.problem.coordinates.len(), step);
            let columns = [first, self.columns.len()];
            let carries = || twists.bodies.iter().any(|body| body.frame == number);
            numbers[number] = before;
            if first < columns[1] || carries() {
                let depth = before.map(|before: usize| &self.joints[before]);
                let depth = depth.map_or(0, |before| before.depth + before.columns[1] - before.columns[0]);
                let turns = matches!(step, Step::Turned(_));
                numbers[number] = Some(self.joints.len());
                let origin = origins[number];
                self.joints.push(TreeJoint { before, turns, columns, depth, axes: *axes, origin });
            }
        }
        numbers
    }

    fn add_columns(&mut self, graph: &mut Graph, n: usize, step: &Step) {
        let rate = match step {
            Step::None => return,
            Step::Moved(moved) => moved.rate,
            Step::Turned(turned) => turned.rate,
        };
        let velocities = nodes(graph, n, Variable::Velocity);
        let rows = rate.map(|component| graph.gradient_to(component, &velocities));
        let axes = (0..n).map(|coordinate| (coordinate, rows.each_ref().map(|row| row[coordinate])));
        let axes: Vec<_> = axes.filter(|(_, axis)| *axis != [Id::ZERO; 3]).collect();
        let (coordinates, first) = (symbols(n, Variable::Coordinate), self.columns.len());
        let mut in_time = total_time_derivative(graph, n);
        let mut rate_of = |graph: &mut Graph, vector: Triple| vector.map(|entry| in_time.of(graph, entry));
        for (number, &(coordinate, axis)) in axes.iter().enumerate() {
            let change = rate_of(graph, axis);
            let rates = (change != [Id::ZERO; 3]).then(|| [change, rate_of(graph, change)]);
            self.columns.push(TreeColumn { coordinate, axis, rates });
            let slopes = axis.map(|entry| graph.gradient(entry, &coordinates));
            let bends = axes.iter().enumerate().map(|(by, (coordinate, _))| {
                ([first + number, first + by], slopes.each_ref().map(|slope| slope[*coordinate]))
            });
            self.bends.extend(bends.filter(|(_, bend)| *bend != [Id::ZERO; 3]));
        }
    }

    /// True if bodies and gravity are constant, and poses and axes depend on coordinates and parameters alone.
    fn is_given(&self, graph: &Graph) -> bool {
        let bodies = self.bodies.iter();
        let bodies = bodies.flat_map(|body| [[body.mass; 3], body.centre].into_iter().chain(body.inertia));
        let poses = self.joints.iter().flat_map(|joint| joint.axes.into_iter().chain([joint.origin]));
        let constants: Vec<Id> = bodies.chain([self.fixed]).flatten().collect();
        let placed: Vec<Id> = poses.chain(self.columns.iter().map(|column| column.axis)).flatten().collect();
        let of = |roots: &[Id], is_one: fn(Variable) -> bool| {
            !graph.has_external(roots) && graph.symbols(roots).all(|symbol| is_one(Variable::of(symbol)))
        };
        of(&constants, |variable| matches!(variable, Variable::Parameter(_)))
            && of(&placed, |variable| matches!(variable, Variable::Parameter(_) | Variable::Coordinate(_)))
    }
}

/// True if no displacement depends on the time. Origins do not tell, which are counted from a frame that moves.
fn is_still(graph: &Graph, problem: &Problem) -> bool {
    let displacements = problem.frames.iter().flat_map(|frame| match &frame.step {
        Step::Moved(moved) => moved.by,
        Step::Turned(_) | Step::None => [Id::ZERO; 3],
    });
    let displacements: Vec<Id> = displacements.collect();
    graph.symbols(&displacements).all(|symbol| Variable::of(symbol) != Variable::Time)
}

/// Frames that carry this one from the fixed frame on, and itself.
fn carriers(frames: &[Frame], frame: usize) -> Vec<usize> {
    let before = |&frame: &usize| (frame > 0).then(|| frames[frame].before);
    let mut carriers: Vec<usize> = successors(Some(frame), before).collect();
    carriers.reverse();
    carriers
}

impl Twists<'_> {
    /// Origins of the frames along the fixed axes, from that of the first frame that carries bodies or several frames: far
    /// from the fixed frame, small distances keep their digits.
    fn origins(&self, graph: &mut Graph) -> Vec<Triple> {
        let frames = &self.problem.frames;
        let shifts: Vec<Triple> = frames
            .iter()
            .map(|frame| match &frame.step {
                Step::Moved(moved) => frame.axes.map(|row| graph.dot(&row, &moved.by)),
                Step::Turned(_) | Step::None => [Id::ZERO; 3],
            })
            .collect();
        let only = |frame: usize| {
            let mut next = (1..frames.len()).filter(|&next| frames[next].before == frame);
            let carries = self.bodies.iter().any(|body| body.frame == frame);
            next.next().filter(|_| !carries && next.next().is_none())
        };
        let mut origins: Vec<Option<Triple>> = vec![None; frames.len()];
        for number in 1..frames.len() {
            let Frame { before, .. } = frames[number];
            if before == 0 {
                let stem: Vec<usize> = successors(Some(number), |&frame| only(frame)).collect();
                let mut origin = [Id::ZERO; 3];
                for &frame in stem.iter().rev() {
                    origins[frame] = Some(origin);
                    origin = [0, 1, 2].map(|i| graph.sub(origin[i], shifts[frame][i]));
                    origin = named(origin, graph);
                }
            } else if origins[number].is_none() {
                let carrier = origins[before].unwrap_or([Id::ZERO; 3]);
                origins[number] = Some(named(sum([carrier, shifts[number]], graph), graph));
            }
        }
        origins.into_iter().map(|origin| origin.unwrap_or([Id::ZERO; 3])).collect()
    }
}
