//! Generalized forces of the terms of L beside rigid bodies by the chain rule, to be read.
//!
//! Let ℓ be L without the bodies and their weights. A point r with v = ṙ has ∂v/∂q̇ = ∂r/∂q and d/dt ∂v/∂q̇ = ∂v/∂q. So the
//! generalized force of ℓ(r, v, t) is f·∂r/∂q with f = ∂ℓ/∂r − d/dt ∂ℓ/∂v (Goldstein, Poole and Safko, *Classical
//! Mechanics*, 1.5): of ℓ = e A(r, t)·v Lorentz's force f = e (v×B − ∂A/∂t). That of ℓ(ω), with h = ∂ℓ/∂ω along the axes of
//! the frame, is −(ḣ + ω×h)·∂ω/∂q̇, as in Euler's equations.

use rustc_hash::FxHashMap;

use super::super::evidence::vanishes;
use super::{Link, Twists};
use crate::resolve::{Triple, cross, sum};
use crate::symbolic::{Forward, Graph, Id, Node};
use crate::variables::{Variable, has_velocity, nodes, total_time_derivative};

/// Generalized forces Q_i + ∂ℓ/∂q_i − d/dt ∂ℓ/∂q̇_i of a function ℓ of coordinates, velocities, time and named arguments.
#[derive(Debug)]
pub(crate) struct ChainRule {
    /// Q_i
    pub(crate) given: Vec<Id>,
    /// Q_i + ∂ℓ/∂q_i − d/dt ∂ℓ/∂q̇_i, with the arguments held.
    pub(crate) direct: Vec<Id>,
    /// ∂ℓ/∂q̇_i, with the arguments held.
    pub(crate) momenta: Vec<Id>,
    /// −∂ℓ/∂t, with the arguments held.
    pub(crate) by_time: Id,
    pub(crate) arguments: Vec<ChainArgument>,
    /// Rates of change without names of their own, each with the argument, or the rate of one, that it is the rate of.
    pub(crate) rates: Vec<(Id, Id)>,
}

/// An argument of ℓ: a definition of coordinates and time, or a component of the angular velocity ω of a link.
#[derive(Debug)]
pub(crate) struct ChainArgument {
    pub(crate) node: Id,
    /// Its rate of change; for a component of ω, the component itself.
    pub(crate) rate: Id,
    /// Factor of ∂(node)/∂q in the generalized force, or of ∂ω/∂q̇.
    pub(crate) force: Id,
    /// ∂ℓ/∂(node); zero for a component of ω.
    pub(crate) slope: Id,
    /// ∂ℓ/∂(rate)
    pub(crate) momentum: Id,
}

impl ChainArgument {
    /// True for a component of an angular velocity.
    pub(crate) fn is_rate(&self) -> bool {
        self.node == self.rate
    }
}

impl ChainRule {
    /// Σ q̇ ∂ℓ/∂q̇, with arguments whose rates are linear in q̇ but for what time adds to them.
    pub(super) fn vis_viva(&self, graph: &mut Graph, velocities: &[Id]) -> Id {
        let mut sum = graph.dot(&self.momenta, velocities);
        for &ChainArgument { rate, momentum, .. } in &self.arguments {
            let imposed = graph.without(rate, velocities);
            let rate = graph.sub(rate, imposed);
            let part = graph.mul(momentum, rate);
            sum = graph.add(sum, part);
        }
        sum
    }
}

impl Twists<'_> {
    /// The generalized forces of ℓ = `function` and the given ones: with definitions that contain a point whose rate is in ℓ,
    /// such as a vector potential, by what they contain, and with all definitions as arguments.
    pub(super) fn chain_rules(
        &self,
        graph: &mut Graph,
        (function, links): (Id, &[Link]),
        all: Vec<(Id, Id)>,
    ) -> Vec<ChainRule> {
        let turning = self.turning_in(graph, function, links);
        let inner = within_points(graph, function, &all);
        let both = if inner.len() < all.len() { vec![inner, all] } else { vec![all] };
        both.iter().map(|points| self.chain_rule(graph, function, points, &turning)).collect()
    }

    fn chain_rule(
        &self,
        graph: &mut Graph,
        function: Id,
        points: &[(Id, Id)],
        turning: &[Triple],
    ) -> ChainRule {
        let n = self.problem.coordinates.len();
        let own = [nodes(graph, n, Variable::Coordinate), nodes(graph, n, Variable::Velocity)].concat();
        let time = graph.symbol(Variable::Time.symbol());
        let named = points.iter().flat_map(|&(node, rate)| [node, rate]).chain(turning.concat());
        let named = named.filter(|&id| is_definition(graph, id));
        let held: Vec<Id> = own.iter().copied().chain([time]).chain(named).collect();
        let slopes = graph.gradient_to(function, &held);
        let slopes: FxHashMap<Id, Id> = held.into_iter().zip(slopes).collect();
        let slope =
            |node: Id| slopes.get(&node).copied().filter(|_| !own.contains(&node)).unwrap_or(Id::ZERO);

        let (mut along, rates) = self.rates_of_named(graph, points, turning);
        let mut arguments: Vec<ChainArgument> = Vec::new();
        for &(node, rate) in points {
            let (slope, momentum) = (slope(node), slope(rate));
            let change = along.of(graph, momentum);
            arguments.push(ChainArgument { node, rate, force: graph.sub(slope, change), slope, momentum });
        }
        for &rate in turning {
            let spin = rate.map(slope);
            let change = spin.map(|momentum| along.of(graph, momentum));
            let carried = cross(rate, spin, graph);
            let torque = sum([change, carried], graph).map(|torque| graph.neg(torque));
            for ((node, force), momentum) in rate.into_iter().zip(torque).zip(spin) {
                arguments.push(ChainArgument { node, rate: node, force, slope: Id::ZERO, momentum });
            }
        }
        let mut parts = self.nothing();
        self.given_forces(graph, &mut parts);
        let given = self.hand_back(graph, parts, n);
        let momenta: Vec<Id> = own[n..].iter().map(|velocity| slopes[velocity]).collect();
        let direct = (0..n).map(|i| {
            let change = along.of(graph, momenta[i]);
            let force = graph.add(given[i], slopes[&own[i]]);
            graph.sub(force, change)
        });
        let direct = direct.collect();
        ChainRule { given, direct, momenta, by_time: graph.neg(slopes[&time]), arguments, rates }
    }

    /// Definitions of coordinates and time in L without the bodies, each with its rate of change.
    pub(super) fn points(&self, graph: &mut Graph) -> Vec<(Id, Id)> {
        let within = graph.reachable(&[self.others]);
        let is_in = |id: &Id| within.binary_search(id).is_ok();
        let mut definitions: Vec<Id> = self.problem.names.keys().copied().filter(is_in).collect();
        definitions.sort_unstable();
        let (moving, still): (Vec<Id>, Vec<Id>) =
            definitions.into_iter().partition(|&id| has_velocity(graph, &[id]));
        let mut along = total_time_derivative(graph, self.problem.coordinates.len());
        let mut points = Vec::new();
        for node in still {
            let rate = along.of(graph, node);
            let is_it = |named: &&Id| {
                let difference = graph.sub(**named, rate);
                vanishes(graph, self.problem, difference).is_some()
            };
            let named = if is_in(&rate) || rate == Id::ZERO { None } else { moving.iter().find(is_it) };
            points.push((node, named.copied().unwrap_or(rate)));
        }
        points
    }

    /// Angular velocities of links in ℓ.
    fn turning_in(&self, graph: &Graph, function: Id, links: &[Link]) -> Vec<Triple> {
        let within = graph.reachable(&[function]);
        let all = links.iter().map(|link| self.problem.frames[link.frame].angular_velocity);
        let is_held = |rate: &Triple| {
            rate.iter().all(|&id| is_definition(graph, id))
                && rate.iter().any(|id| within.binary_search(id).is_ok())
        };
        all.filter(is_held).collect()
    }

    /// Time derivative of expressions in named arguments, and the rates that have no names of their own.
    fn rates_of_named(
        &self,
        graph: &mut Graph,
        points: &[(Id, Id)],
        turning: &[Triple],
    ) -> (Forward, Vec<(Id, Id)>) {
        let n = self.problem.coordinates.len();
        let mut along = total_time_derivative(graph, n);
        let mut pairs = points.to_vec();
        let moving = points.iter().map(|(_, rate)| *rate).chain(turning.concat());
        pairs.extend(moving.map(|rate| (rate, along.of(graph, rate))));
        pairs.retain(|(node, _)| is_definition(graph, *node));
        let is_unnamed = |rate: Id| is_definition(graph, rate) && !self.problem.names.contains_key(&rate);
        let unnamed = pairs.iter().filter(|(_, rate)| is_unnamed(*rate)).map(|&(node, rate)| (rate, node));
        let unnamed = unnamed.collect();
        (total_time_derivative(graph, n).through(graph, pairs), unnamed)
    }
}

/// Without those that contain another one whose rate is in ℓ.
fn within_points(graph: &Graph, function: Id, all: &[(Id, Id)]) -> Vec<(Id, Id)> {
    let within = graph.reachable(&[function]);
    let is_moved = |rate: &Id| within.binary_search(rate).is_ok() && is_definition(graph, *rate);
    let moved: Vec<Id> = all.iter().filter(|(_, rate)| is_moved(rate)).map(|(node, _)| *node).collect();
    let contains_one = |node: Id| {
        let inner = graph.reachable(&[node]);
        moved.iter().any(|other| *other != node && inner.binary_search(other).is_ok())
    };
    all.iter().copied().filter(|(node, _)| moved.contains(node) || !contains_one(*node)).collect()
}

fn is_definition(graph: &Graph, id: Id) -> bool {
    matches!(graph.node(id), Node::Defined(_))
}
