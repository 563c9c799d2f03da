//! What belongs to a displacement of the frames, of any Lagrangian.
//!
//! Of a frame with the twist ω, v in its own axes a displacement of the coordinates is a turn ξ and a shift η, δω = ξ̇ + ω × ξ
//! and δv = η̇ + ω × η + v × ξ: so the parts of dp/dt = ∂L/∂q + Q that belong to ξ and η are, with the momenta
//! μ = ∂L/∂ω and π = ∂L/∂v (Poincaré, *Comptes rendus* 132, 1901; Marsden and Ratiu, *Introduction to Mechanics and Symmetry*,
//! 13.5),
//!
//! ```text
//! −μ̇ + μ × ω + π × v + the torque of what depends on where the frame is,
//! −π̇ + π × ω + the force of it.
//! ```

use indexmap::IndexMap;

use super::accelerations::InTime;
use super::{Component, Part, Parts, Place, Twists};
use crate::resolve::{Frame, Triple, cross, sum};
use crate::symbolic::{Forward, Graph, Id, Node};
use crate::variables::{Variable, symbols};

impl Twists<'_> {
    /// What belongs to the velocities of all in L that is no body; gravity, which is given, is left to the bodies.
    pub(super) fn others_of(
        &self,
        graph: &mut Graph,
        in_time: InTime,
        places: &IndexMap<Id, Place>,
        parts: &mut Parts,
    ) -> Triple {
        let n = self.problem.coordinates.len();
        let coordinates = symbols(n, Variable::Coordinate).into_iter().map(|q| graph.symbol(q));
        let coordinates: Vec<Id> = coordinates.collect();
        let held: Vec<Id> =
            [&coordinates[..], &self.velocities.nodes, &places.keys().copied().collect::<Vec<_>>()].concat();
        let mut slopes = graph.gradient_to(self.others, &held);
        let momenta: Vec<Id> = slopes.drain(n..n + self.velocities.nodes.len()).collect();
        let placed: Vec<Id> = coordinates.iter().chain(places.keys()).copied().collect();
        let gravity = self.without_gravity(graph, &placed, &mut slopes);
        self.at_rest(graph, places, &slopes, parts);
        self.in_motion(graph, in_time, &momenta, parts);
        gravity
    }

    /// ∂L/∂q where the velocities and what says where the frames are are held, and forces and torques by the latter.
    fn at_rest(&self, graph: &mut Graph, places: &IndexMap<Id, Place>, slopes: &[Id], parts: &mut Parts) {
        let (of_coordinates, of_places) = slopes.split_at(self.problem.coordinates.len());
        of_coordinates.iter().enumerate().for_each(|(i, &slope)| parts.add(i, slope, 1));
        for (place, &slope) in places.values().zip(of_places).filter(|(_, slope)| **slope != Id::ZERO) {
            let Frame { axes, angular_velocity, velocity, .. } = &self.problem.frames[place.frame];
            let row = axes[place.row];
            match place.of {
                // A row r of the axes changes by r × ξ.
                Some(axis) => self.across(graph, slope, (axis, row), *angular_velocity, parts),
                // The origin by the rows times η.
                None => self.along(graph, row.map(|entry| (slope, entry)), *velocity, parts),
            }
        }
    }

    /// −d/dt of the momenta, and μ × ω, π × v and π × ω component by component.
    fn in_motion(&self, graph: &mut Graph, in_time: InTime, momenta: &[Id], parts: &mut Parts) {
        if momenta.iter().all(|&momentum| momentum == Id::ZERO) {
            return;
        }
        let mut along = self.rates(graph, in_time);
        for (number, &momentum) in momenta.iter().enumerate() {
            let rate = along.of(graph, momentum);
            parts.add(number, rate, -1);
        }
        for &Component { frame, part, axis, number } in &self.components {
            let &Frame { angular_velocity, velocity, .. } = &self.problem.frames[frame];
            let momentum = momenta[number];
            match part {
                Part::Turning => {
                    self.across(graph, momentum, (axis, angular_velocity), angular_velocity, parts);
                }
                Part::Moving => {
                    self.across(graph, momentum, (axis, angular_velocity), velocity, parts);
                    self.across(graph, momentum, (axis, velocity), angular_velocity, parts);
                }
            }
        }
    }

    /// `weight` times the component `axis` of `vector` × the displacement that goes with the velocity `of`.
    fn across(
        &self,
        graph: &mut Graph,
        weight: Id,
        (axis, vector): (usize, Triple),
        of: Triple,
        parts: &mut Parts,
    ) {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        for (from, to, sign) in [(b, c, 1), (c, b, -1)] {
            if let Some(&number) = self.numbers.get(&of[to]) {
                let part = graph.mul(weight, vector[from]);
                parts.add(number, part, sign);
            }
        }
    }

    /// A product for each component of the displacement that goes with the velocity `of`.
    pub(super) fn along(&self, graph: &mut Graph, products: [(Id, Id); 3], of: Triple, parts: &mut Parts) {
        for ((x, y), node) in products.into_iter().zip(of) {
            if let Some(&number) = self.numbers.get(&node) {
                let part = graph.mul(x, y);
                parts.add(number, part, 1);
            }
        }
    }

    /// d/dt, by what is known of frames.
    fn rates(&self, graph: &mut Graph, in_time: InTime) -> Forward {
        let accelerations = self.accelerations(graph, in_time, [Id::ZERO; 3]);
        let mut rates: Vec<(Id, Id)> = Vec::new();
        for (frame, acceleration) in self.problem.frames.iter().zip(accelerations) {
            let Frame { angular_velocity, velocity, axes, origin, .. } = frame;
            let carried = cross(*velocity, *angular_velocity, graph);
            let moving = sum([acceleration.moving, carried], graph);
            let twist = [(*angular_velocity, acceleration.turning), (*velocity, moving)];
            let turned = axes.map(|row| (row, cross(row, *angular_velocity, graph)));
            let moved = (*origin, axes.map(|row| graph.dot(&row, velocity)));
            let vectors = twist.into_iter().chain(turned).chain([moved]);
            rates.extend(vectors.flat_map(|(of, rate)| of.into_iter().zip(rate)));
        }
        rates.retain(|(node, _)| matches!(graph.node(*node), Node::Defined(_)));
        in_time(graph, self.problem.coordinates.len()).through(graph, rates)
    }
}
