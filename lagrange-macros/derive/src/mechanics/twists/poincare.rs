//! Poincaré's equations: generalized forces conjugate to displacements of frames, for any Lagrangian.
//!
//! Let a frame have the twist (ω, v) in its own axes. A displacement of the coordinates is a rotation ξ and a translation η
//! of the frame, with δω = ξ̇ + ω × ξ and δv = η̇ + ω × η + v × ξ. With the momenta μ = ∂L/∂ω and π = ∂L/∂v, the terms of
//! dp/dt = ∂L/∂q + Q that are conjugate to ξ and η are (Poincaré, *Comptes rendus* 132, 1901; Marsden and Ratiu,
//! *Introduction to Mechanics and Symmetry*, 13.5)
//!
//! ```text
//! ξ: −μ̇ + μ × ω + π × v + torque due to the position and orientation of the frame
//! η: −π̇ + π × ω + force due to the position and orientation of the frame
//! ```

use indexmap::IndexMap;

use super::accelerations::InTime;
use super::components::{Component, TwistPart, Twists};
use super::parts::TwistParts;
use super::places::RowOrOrigin;
use crate::resolve::{Frame, Triple, columns, cross, named, sum};
use crate::symbolic::{Forward, Graph, Id, Node};
use crate::variables::{Variable, nodes};

impl Twists<'_> {
    /// Adds the generalized forces of all terms of L that are not bodies. Returns uniform gravity as an acceleration,
    /// which the equations of the bodies include. With `definitions`, it is also sought as in
    /// [`without_gravity`](Self::without_gravity) `by_moments`, and in the terms outside of these nodes, which may contain
    /// positions of the same frames.
    pub(super) fn others_of(
        &self,
        graph: &mut Graph,
        in_time: InTime,
        places: &IndexMap<Id, RowOrOrigin>,
        parts: &mut TwistParts,
        definitions: Option<&[Id]>,
    ) -> Triple {
        let (momenta, mut slopes) = self.slopes(graph, self.others, places);
        let coordinates = nodes(graph, self.problem.coordinates.len(), Variable::Coordinate);
        let placed: Vec<Id> = coordinates.iter().chain(places.keys()).copied().collect();
        let mut gravity = self.without_gravity(graph, &placed, &mut slopes, definitions.is_some());
        if let Some(definitions) = definitions.filter(|_| gravity == [Id::ZERO; 3]) {
            gravity = self.without_gravity_beside(graph, definitions, &placed, &mut slopes);
        }
        self.at_rest(graph, places, &slopes, parts);
        self.in_motion(graph, in_time, &momenta, parts);
        gravity
    }

    /// Removes uniform gravity in the terms outside of these definitions.
    fn without_gravity_beside(
        &self,
        graph: &mut Graph,
        definitions: &[Id],
        placed: &[Id],
        slopes: &mut [Id],
    ) -> Triple {
        let held = [placed, &self.velocities.nodes, definitions].concat();
        let before = graph.gradient_to(self.others, &held);
        let mut after = before[..placed.len()].to_vec();
        let gravity = self.without_gravity(graph, placed, &mut after, true);
        for ((slope, before), after) in slopes.iter_mut().zip(before).zip(after) {
            let weight = graph.sub(before, after);
            *slope = graph.sub(*slope, weight);
        }
        gravity
    }

    /// Returns ∂(expression)/∂(velocities), and the slopes by the coordinates and frame positions, each with all
    /// others held.
    pub(super) fn slopes(
        &self,
        graph: &mut Graph,
        expression: Id,
        places: &IndexMap<Id, RowOrOrigin>,
    ) -> (Vec<Id>, Vec<Id>) {
        let n = self.problem.coordinates.len();
        let coordinates = nodes(graph, n, Variable::Coordinate);
        let held = coordinates.iter().chain(&self.velocities.nodes).chain(places.keys());
        let held: Vec<Id> = held.copied().collect();
        let mut slopes = graph.gradient_to(expression, &held);
        let of_velocities = slopes.drain(n..n + self.velocities.nodes.len()).collect();
        (of_velocities, slopes)
    }

    /// Adds ∂L/∂q at fixed velocities and frame positions, and the forces and torques of the slopes by frame
    /// positions.
    pub(super) fn at_rest(
        &self,
        graph: &mut Graph,
        places: &IndexMap<Id, RowOrOrigin>,
        slopes: &[Id],
        parts: &mut TwistParts,
    ) {
        let (of_coordinates, of_places) = slopes.split_at(self.problem.coordinates.len());
        of_coordinates.iter().enumerate().for_each(|(i, &slope)| parts.add(i, slope, 1));
        for (place, &slope) in places.values().zip(of_places).filter(|(_, slope)| **slope != Id::ZERO) {
            let Frame { axes, angular_velocity, velocity, .. } = &self.problem.frames[place.frame];
            let row = axes[place.row];
            match place.of {
                // A displacement ξ changes an axis row r by r × ξ.
                Some(axis) => self.across(graph, slope, (axis, row), *angular_velocity, parts),
                // A displacement η changes the origin by the rows times η.
                None => self.along(graph, row.map(|entry| (slope, entry)), *velocity, parts),
            }
        }
    }

    /// Adds −d/dt of the momenta, and μ × ω, π × v and π × ω component by component.
    fn in_motion(&self, graph: &mut Graph, in_time: InTime, momenta: &[Id], parts: &mut TwistParts) {
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
                TwistPart::Turning => {
                    self.across(graph, momentum, (axis, angular_velocity), angular_velocity, parts);
                }
                TwistPart::Moving => {
                    self.across(graph, momentum, (axis, angular_velocity), velocity, parts);
                    self.across(graph, momentum, (axis, velocity), angular_velocity, parts);
                }
            }
        }
    }

    /// Time derivative along the motion, from the known twists of frames. Second derivatives of frame
    /// positions are known too, as accelerations.
    pub(super) fn rates(&self, graph: &mut Graph, in_time: InTime) -> Forward {
        let accelerations = self.accelerations(graph, in_time, [Id::ZERO; 3]);
        let mut rates: Vec<(Id, Id)> = Vec::new();
        for (frame, acceleration) in self.problem.frames.iter().zip(accelerations) {
            let Frame { angular_velocity, velocity, axes, origin, .. } = frame;
            let carried = cross(*velocity, *angular_velocity, graph);
            let moving = sum([acceleration.moving, carried], graph);
            let twist = [(*angular_velocity, acceleration.turning), (*velocity, moving)];
            let [moved, accelerated] =
                [*velocity, acceleration.moving].map(|vector| axes.map(|row| graph.dot(&row, &vector)));
            let moved = named(moved, graph);
            let turned = axes.map(|row| named(cross(row, *angular_velocity, graph), graph));
            let by_turning = columns(acceleration.by_turning);
            let turned_further = axes.map(|row| by_turning.map(|column| graph.dot(&row, &column)));
            let of_axes = axes.iter().copied().zip(turned).chain(turned.into_iter().zip(turned_further));
            let vectors = twist.into_iter().chain(of_axes).chain([(*origin, moved), (moved, accelerated)]);
            rates.extend(vectors.flat_map(|(of, rate)| of.into_iter().zip(rate)));
        }
        rates.retain(|(node, _)| matches!(graph.node(*node), Node::Defined(_)));
        in_time(graph, self.problem.coordinates.len()).through(graph, rates)
    }
}
