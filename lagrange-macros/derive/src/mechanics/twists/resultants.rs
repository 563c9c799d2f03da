//! Rigid bodies by the resultant forces and torques on them, to be read.
//!
//! With F = m (r̈ − g) at the centre of mass and N = I ω̇ + ω × I ω about it, the equation of each velocity u is Jourdain's
//! principle, Σ F·∂ṙ/∂u + N·∂ω/∂u = Q, where Q has neither inertia nor weight (Kane and Levinson, *Dynamics: Theory and
//! Applications*, pages 106 and 124, with the generalized speeds u; Moore, *Learn Multibody Dynamics*, Generalized Forces). It
//! holds for trees of bodies, at every state, with formulas that do not grow with the angles that turn a body.

use std::iter::successors;

use num_traits::One;
use rustc_hash::FxHashMap;

use super::Twists;
use super::chain_rule::ChainRule;
use super::turning::{Turning, Turnings};
use crate::resolve::{Frame, Problem, Step, Triple, columns, sum};
use crate::symbolic::{Forward, Graph, Id, Node};
use crate::variables::{Variable, has_velocity, nodes, total_time_derivative};

/// Largest number of bodies for which the resultants are derived: beyond it the page is too long to be read.
const MOST: usize = 8;

/// Rigid bodies, and the generalized forces beside their inertia and their weight.
#[derive(Debug)]
pub(crate) struct Resultants {
    /// Frames with names that carry bodies, each after the one that carries it.
    pub(crate) links: Vec<Link>,
    pub(crate) bodies: Vec<RigidBody>,
    /// −g for uniform gravity g, along the fixed axes, and its rate of change.
    pub(crate) lift: Triple,
    pub(crate) lift_rate: Triple,
    pub(crate) beside: Beside,
    /// Generalized force on each coordinate, without constraint forces.
    pub(crate) rest: Vec<Id>,
    /// L without the bodies and their weights, and its generalized forces by the chain rule, in one or two ways.
    pub(crate) others: Id,
    pub(crate) chains: Vec<ChainRule>,
    /// Torque along the axes of each [`Turning`], without constraint forces.
    pub(crate) torques: Vec<Triple>,
}

/// What the terms of L that belong to no rigid body add to the momenta and to the energy E = p·q̇ − L, and the power that changes E.
#[derive(Debug)]
pub(crate) struct Beside {
    /// ∂/∂q̇ of these terms.
    pub(crate) momenta: Vec<Id>,
    /// E of these terms, with the weights and without them.
    pub(crate) energies: [Id; 2],
    /// −∂/∂t of these terms, with the weights and without them.
    pub(crate) rates: [Id; 2],
    /// Q·q̇ − λ·b
    pub(crate) power: Id,
}

/// A frame, and how it lies in the next link that carries it, or in the fixed frame.
#[derive(Debug)]
pub(crate) struct Link {
    pub(crate) frame: usize,
    /// Index of the link that carries this one.
    pub(crate) before: Option<usize>,
    /// Rotation matrix from the axes of this link to those of the link before, by rows.
    pub(crate) turned: [Triple; 3],
    /// Displacements between the origins, along the axes of the link before.
    pub(crate) moved: Vec<Triple>,
    /// Angular velocity relative to the link before, along the axes of this link.
    pub(crate) rate: Triple,
    /// The same for q̇ = 0: zero unless a frame turns with time.
    pub(crate) imposed: Triple,
}

/// A rigid body by mass, centre of mass and inertia about it, along the axes of its link.
#[derive(Debug)]
pub(crate) struct RigidBody {
    pub(crate) link: usize,
    pub(crate) mass: Id,
    pub(crate) centre: Triple,
    pub(crate) inertia: [Triple; 3],
    /// Position of the centre of mass, along the fixed axes.
    pub(crate) position: Triple,
}

impl RigidBody {
    /// False for a particle.
    pub(crate) fn has_inertia(&self) -> bool {
        self.inertia != [[Id::ZERO; 3]; 3]
    }
}

impl Resultants {
    /// `None` without rigid bodies or with too many, and if fields switch constraints or friction on and off.
    /// `power` is Q·q̇ − λ·b.
    pub(in super::super) fn of(
        graph: &mut Graph,
        problem: &Problem,
        turnings: &Turnings,
        power: Id,
    ) -> Option<Self> {
        let is_smooth = problem.parameters.switches.is_empty() && problem.frictions.is_empty();
        let twists = Some(()).filter(|()| is_smooth).and_then(|()| Twists::of(graph, problem))?;
        (1..=MOST).contains(&twists.bodies.len()).then(|| twists.resultants(graph, turnings, power))
    }
}

impl Twists<'_> {
    fn resultants(&self, graph: &mut Graph, turnings: &Turnings, power: Id) -> Resultants {
        let frames = self.named_carriers();
        let new = &turnings.new;
        let links = frames.iter().map(|&frame| self.link(graph, frame, &frames).replaced(graph, new));
        let links: Vec<Link> = links.collect();
        let bodies = self.bodies.iter().filter_map(|body| {
            let frame = &self.problem.frames[body.frame];
            let shift = frame.axes.map(|row| graph.dot(&row, &body.centre));
            Some(RigidBody {
                link: frames.iter().position(|&link| link == body.frame)?,
                mass: body.mass,
                centre: body.centre,
                inertia: body.central,
                position: sum([frame.origin, shift], graph),
            })
        });
        let bodies: Vec<RigidBody> = bodies.collect();
        let mut parts = self.nothing();
        let places = self.places(graph);
        let points = self.points(graph);
        let named: Vec<Id> = points.iter().flat_map(|&(node, rate)| [node, rate]).collect();
        let lift = self.others_of(graph, total_time_derivative, &places, &mut parts, Some(&named));
        self.given_forces(graph, &mut parts);
        let n = self.problem.coordinates.len();
        let rest = self.hand_back(graph, parts, if turnings.all.is_empty() { n } else { self.outer });
        let torques = turnings.all.iter().map(|turning| turning.torque(graph, &rest, new)).collect();
        let rest = rest.into_iter().map(|force| graph.replaced(force, new)).collect();
        let weights = weights(graph, &bodies, lift);
        let others = graph.add(self.others, weights);
        let chains = self.chain_rules(graph, (others, &links), points);
        let beside = Beside { power, ..self.beside(graph, weights, &chains[0]) }.replaced(graph, new);
        let mut along_time = Forward::along([(Variable::Time.symbol(), Id::ONE)]);
        let lift_rate = lift.map(|lift| along_time.of(graph, lift));
        Resultants { links, bodies, lift, lift_rate, beside, rest, others, chains, torques }
    }

    fn beside(&self, graph: &mut Graph, weights: Id, chain: &ChainRule) -> Beside {
        let velocities = nodes(graph, self.problem.coordinates.len(), Variable::Velocity);
        let momenta = graph.gradient_to(self.others, &velocities);
        // Terms that are linear in the velocities are no part of E.
        let is_affine = !has_velocity(graph, &momenta);
        let others = if is_affine { graph.without(self.others, &velocities) } else { self.others };
        let vis_viva = if is_affine { Id::ZERO } else { chain.vis_viva(graph, &velocities) };
        let mut along_time = Forward::along([(Variable::Time.symbol(), Id::ONE)]);
        let [with, without] = [Id::ZERO, weights].map(|weights| {
            let part = graph.add(others, weights);
            let energy = graph.sub(vis_viva, part);
            let part = graph.add(self.others, weights);
            let rate = along_time.of(graph, part);
            (energy, graph.neg(rate))
        });
        Beside { momenta, energies: [with.0, without.0], rates: [with.1, without.1], power: Id::ZERO }
    }

    /// Named frames with bodies, and those that carry them.
    fn named_carriers(&self) -> Vec<usize> {
        let is_named = |frame: &usize| self.problem.frame_names.iter().any(|(named, _)| named == frame);
        let mut frames = Vec::new();
        for body in &self.bodies {
            let before = |&frame: &usize| (frame != 0).then(|| self.problem.frames[frame].before);
            frames.extend(successors(Some(body.frame), before).filter(is_named));
        }
        frames.sort_unstable();
        frames.dedup();
        frames
    }

    /// The link of one of these frames.
    fn link(&self, graph: &mut Graph, frame: usize, frames: &[usize]) -> Link {
        let (mut steps, mut at) = (Vec::new(), frame);
        while at != 0 && (at == frame || !frames.contains(&at)) {
            steps.push(&self.problem.frames[at].step);
            at = self.problem.frames[at].before;
        }
        let before = frames.iter().position(|&link| link == at && at != frame);
        let (mut turned, mut moved, mut rate) = (Frame::fixed().axes, Vec::new(), [Id::ZERO; 3]);
        for step in steps.into_iter().rev() {
            match step {
                Step::Moved(step) => moved.push(turned.map(|row| graph.dot(&row, &step.by))),
                Step::Turned(turn) => {
                    let axes = columns(turn.by);
                    turned = turned.map(|row| axes.map(|axis| graph.dot(&row, &axis)));
                    rate = sum([step.forth(rate, graph), turn.rate], graph);
                }
                Step::None => {}
            }
        }
        let velocities = nodes(graph, self.problem.coordinates.len(), Variable::Velocity);
        let imposed = rate.map(|component| graph.without(component, &velocities));
        Link { frame, before, turned, moved, rate, imposed }
    }
}

impl Link {
    /// The link in angular velocities in the place of the rates of quaternions.
    fn replaced(self, graph: &mut Graph, new: &FxHashMap<Id, Id>) -> Self {
        let mut all = |vector: Triple| vector.map(|component| graph.replaced(component, new));
        let (turned, rate, imposed) = (self.turned.map(&mut all), all(self.rate), all(self.imposed));
        Self { turned, moved: self.moved.into_iter().map(all).collect(), rate, imposed, ..self }
    }
}

impl Beside {
    pub(in super::super) fn nodes(&self) -> Vec<Id> {
        [&self.momenta[..], &self.energies, &self.rates, &[self.power]].concat()
    }

    /// The same in angular velocities in the place of the rates of quaternions.
    fn replaced(self, graph: &mut Graph, new: &FxHashMap<Id, Id>) -> Self {
        let mut written = |part: Id| graph.replaced(part, new);
        let (energies, rates) = (self.energies.map(&mut written), self.rates.map(&mut written));
        Self { energies, rates, power: written(self.power), ..self }
    }
}

/// Σ m (−g)·r
fn weights(graph: &mut Graph, bodies: &[RigidBody], lift: Triple) -> Id {
    let mut sum = Id::ZERO;
    for body in bodies {
        let height = graph.dot(&body.position, &lift);
        let weight = graph.mul(body.mass, height);
        sum = graph.add(sum, weight);
    }
    sum
}

impl Turning {
    /// Torque along the turned axes, from generalized forces on the coordinates and along ω.
    fn torque(&self, graph: &mut Graph, forces: &[Id], new: &FxHashMap<Id, Id>) -> Triple {
        [0, 1, 2].map(|axis| {
            let column = self.spread.map(|row| row[axis]);
            let of_coordinates = graph.dot(&column, &forces[self.first..self.first + 4]);
            let torque = graph.add(forces[self.rate + axis], of_coordinates);
            graph.replaced(torque, new)
        })
    }
}

impl Resultants {
    /// True if the centre of mass of a body can move.
    pub(crate) fn is_moving(&self, graph: &Graph, body: &RigidBody) -> bool {
        graph.symbols(&body.position).any(|symbol| !matches!(Variable::of(symbol), Variable::Parameter(_)))
    }

    /// True if the angular velocity of a link is not zero.
    pub(crate) fn is_turning(&self, link: usize) -> bool {
        let Link { before, rate, .. } = &self.links[link];
        *rate != [Id::ZERO; 3] || before.is_some_and(|before| self.is_turning(before))
    }

    /// True if the angular velocity of a link at given coordinates and velocities changes with time.
    pub(crate) fn turns_with_time(&self, graph: &Graph, link: usize) -> bool {
        let Link { before, turned, rate, .. } = &self.links[link];
        let turning = before.filter(|&before| self.is_turning(before));
        has_time(graph, rate)
            || turning.is_some_and(|before| {
                has_time(graph, &turned.concat()) || self.turns_with_time(graph, before)
            })
    }

    /// How the angular velocity of a link depends on a velocity, given by its index.
    pub(crate) fn turns_with(&self, graph: &Graph, link: usize, i: usize) -> Dependence {
        let Link { before, rate, .. } = &self.links[link];
        let carried = before.map_or(Dependence::None, |before| self.turns_with(graph, before, i));
        match (carried, Dependence::of(graph, rate, Variable::Velocity(i))) {
            (Dependence::None, own) => own,
            _ => Dependence::Any,
        }
    }

    /// How the position of a body depends on a coordinate.
    pub(crate) fn moves_with(&self, graph: &Graph, body: &RigidBody, i: usize) -> Dependence {
        Dependence::of(graph, &body.position, Variable::Coordinate(i))
    }
}

fn has_time(graph: &Graph, parts: &[Id]) -> bool {
    graph.symbols(parts).any(|symbol| Variable::of(symbol) == Variable::Time)
}

/// How a vector depends on a variable.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Dependence {
    None,
    /// The variable is a term of this component, and stands nowhere else.
    Component(usize),
    Any,
}

impl Dependence {
    fn of(graph: &Graph, vector: &Triple, variable: Variable) -> Self {
        let has = |id: Id| graph.symbols(&[id]).any(|symbol| symbol == variable.symbol());
        let found: Vec<usize> = (0..3).filter(|&k| has(vector[k])).collect();
        match found[..] {
            [] => Self::None,
            [k] if is_term(graph, vector[k], &has) => Self::Component(k),
            _ => Self::Any,
        }
    }
}

/// True if, of the terms of a sum, the only one that `has` a variable is the variable itself.
fn is_term(graph: &Graph, id: Id, has: &dyn Fn(Id) -> bool) -> bool {
    match graph.node(id) {
        Node::Symbol(_) => has(id),
        Node::Defined(inner) => is_term(graph, *inner, has),
        Node::Sum(terms) => {
            let mut with = terms.iter().filter(|(term, _)| has(*term));
            matches!((with.next(), with.next()), (Some((term, c)), None) if c.is_one() && is_term(graph, *term, has))
        }
        _ => false,
    }
}
