//! Newton–Euler equations of rigid bodies, in the axes of their frames and about the origins of these.
//!
//! Let m be the mass, h = m c the first moment, J the inertia about the origin, and a the acceleration of the origin.
//! The force is m a + ω̇ × h + ω × (ω × h), and the torque J ω̇ + ω × Jω + h × a. Uniform gravity g enters as the
//! contribution −g to a.

use super::accelerations::InTime;
use super::components::Twists;
use super::parts::TwistParts;
use crate::resolve::{Body, Frame, Step, Triple, cross, sum};
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

impl Twists<'_> {
    /// Adds the inertial forces of the bodies. `fixed` is the acceleration attributed to the fixed frame: −g in
    /// place of uniform gravity g, else zero.
    pub(super) fn of_bodies(
        &self,
        graph: &mut Graph,
        in_time: InTime,
        fixed: Triple,
        parts: &mut TwistParts,
    ) {
        let accelerations = self.accelerations(graph, in_time, fixed);
        let minus = graph.integer(-1);
        for &Body { frame, mass, moment, inertia, .. } in &self.bodies {
            let own = &accelerations[frame];
            let Frame { angular_velocity, velocity, .. } = self.problem.frames[frame];
            let force = own.by_turning.map(|row| graph.dot(&row, &moment));
            let mut times = |vector: Triple| inertia.map(|row| graph.dot(&row, &vector));
            let (spin, change) = (times(angular_velocity), times(own.turning));
            let gyroscopic = cross(angular_velocity, spin, graph);
            let arm = cross(moment, own.moving, graph);
            let torque = sum([change, gyroscopic, arm], graph);
            self.along(graph, force.map(|component| (minus, component)), velocity, parts);
            self.along(graph, torque.map(|component| (minus, component)), angular_velocity, parts);
            // The force m a at the origin is independent of the axes: use the first frame with this origin.
            let first = self.unturned(frame);
            let own = accelerations[first].moving.map(|component| graph.neg(component));
            self.along(
                graph,
                own.map(|component| (mass, component)),
                self.problem.frames[first].velocity,
                parts,
            );
        }
    }

    /// First frame of the chain whose origin is that of `frame`.
    fn unturned(&self, mut frame: usize) -> usize {
        while let Step::Turned(_) = self.problem.frames[frame].step {
            frame = self.problem.frames[frame].before;
        }
        frame
    }

    /// Removes uniform gravity from `slopes`, the partial derivatives with respect to `places` of L without kinetic
    /// energies of bodies. Returns the equivalent acceleration of the fixed frame. Only contributions
    /// proportional to masses and first moments are removed. With `by_moments`, gravity is also found where no origin
    /// of a frame with a body moves.
    pub(super) fn without_gravity(
        &self,
        graph: &mut Graph,
        places: &[Id],
        slopes: &mut [Id],
        by_moments: bool,
    ) -> Triple {
        let slope = |node: Id| places.iter().position(|place| *place == node);
        let mut fixed = [Id::ZERO; 3];
        for axis in 0..3 {
            let candidate = self.bodies.iter().find_map(|body| {
                let Frame { axes, origin, .. } = &self.problem.frames[body.frame];
                let moments = body.moment.map(|moment| graph.looked_through(moment));
                let moments = axes[axis].into_iter().zip(moments).filter(|_| by_moments);
                let weights = [(origin[axis], body.mass)].into_iter().chain(moments);
                weights.filter(|(_, weight)| *weight != Id::ZERO).find_map(|(node, weight)| {
                    let at = slope(node)?;
                    let candidate = (slopes[at] != Id::ZERO).then(|| graph.div(slopes[at], weight))?;
                    is_uniform(graph, candidate, body.mass).then_some(candidate)
                })
            });
            let Some(candidate) = candidate else { continue };
            let mut rest = slopes.to_vec();
            for body in &self.bodies {
                let Frame { axes, origin, .. } = &self.problem.frames[body.frame];
                let weights =
                    [(origin[axis], body.mass)].into_iter().chain(axes[axis].into_iter().zip(body.moment));
                for (node, weight) in weights {
                    if let Some(at) = slope(node) {
                        let part = graph.mul(weight, candidate);
                        let left = graph.sub(rest[at], part);
                        // What is left keeps its definitions.
                        rest[at] = if graph.looked_through(left) == Id::ZERO { Id::ZERO } else { left };
                    }
                }
            }
            let count = |slopes: &[Id]| slopes.iter().filter(|slope| **slope != Id::ZERO).count();
            if count(&rest) < count(slopes) {
                slopes.copy_from_slice(&rest);
                fixed[axis] = graph.neg(candidate);
            }
        }
        fixed
    }
}

/// True if the candidate is uniform in space and not a force divided by a mass, which may be zero.
fn is_uniform(graph: &mut Graph, candidate: Id, mass: Id) -> bool {
    let of_mass: Vec<Symbol> = graph.symbols(&[mass]).collect();
    let is_given = |symbol| matches!(Variable::of(symbol), Variable::Parameter(_) | Variable::Time);
    graph.take_fault().is_none()
        && graph.symbols(&[candidate]).all(|symbol| is_given(symbol) && !of_mass.contains(&symbol))
}
