//! Angular and linear accelerations of frames, along a motion with given accelerations q̈ or with q̈ = 0.

use super::components::Twists;
use crate::resolve::{Frame, Step, Triple, cross, named, sum};
use crate::symbolic::{Forward, Graph, Id, Rational};

/// Time derivative along a motion, for this number of coordinates.
pub(super) type InTime = fn(&mut Graph, usize) -> Forward;

/// Acceleration of a frame, in its own axes.
#[derive(Clone, Copy)]
pub(super) struct Acceleration {
    /// Angular acceleration ω̇
    pub(super) turning: Triple,
    /// Acceleration of the origin relative to the fixed frame.
    pub(super) moving: Triple,
    /// Matrix of r ↦ ω̇ × r + ω × (ω × r), row by row: acceleration of a point at r due to the rotation.
    pub(super) by_turning: [Triple; 3],
}

impl Twists<'_> {
    /// Accelerations of all frames. `fixed` is the acceleration attributed to the fixed frame: −g in place of
    /// uniform gravity g, else zero.
    pub(super) fn accelerations(
        &self,
        graph: &mut Graph,
        in_time: InTime,
        fixed: Triple,
    ) -> Vec<Acceleration> {
        let frames = &self.problem.frames;
        let mut along = in_time(graph, self.problem.coordinates.len());
        let rest = [Id::ZERO; 3];
        let mut found = vec![Acceleration { turning: rest, moving: fixed, by_turning: [rest; 3] }];
        for frame in &frames[1..] {
            let next = found[frame.before].after(frame, &frames[frame.before], &mut along, graph);
            found.push(next);
        }
        found
    }
}

impl Acceleration {
    /// Acceleration of `frame`, from the acceleration `self` of the frame `before` and the displacement or rotation
    /// between the two frames.
    fn after(&self, frame: &Frame, before: &Frame, along: &mut Forward, graph: &mut Graph) -> Self {
        let mut rates =
            |vector: Triple, graph: &mut Graph| vector.map(|component| along.of(graph, component));
        match &frame.step {
            Step::None => *self,
            Step::Moved(moved) => {
                let carried = self.of_point(moved.by, graph);
                let coriolis = cross(before.angular_velocity, moved.rate, graph);
                let moving = sum([carried, coriolis, coriolis, rates(moved.rate, graph)], graph);
                Self { moving: named(moving, graph), ..*self }
            }
            Step::Turned(turned) => {
                let carried = frame.step.forth(self.turning, graph);
                let across = cross(frame.angular_velocity, turned.rate, graph);
                let turning = sum([carried, across, rates(turned.rate, graph)], graph);
                let turning = named(turning, graph);
                let moving = frame.step.forth(self.moving, graph);
                let by_turning = by_turning(frame.angular_velocity, turning, graph);
                Self { turning, moving: named(moving, graph), by_turning }
            }
        }
    }

    /// Acceleration of a point fixed in the frame at r.
    fn of_point(&self, r: Triple, graph: &mut Graph) -> Triple {
        let carried = self.by_turning.map(|row| graph.dot(&row, &r));
        sum([self.moving, carried], graph)
    }
}

/// The matrix of ω̇ × r + ω × (ω × r) = ω̇ × r + ω (ω·r) − ω² r.
fn by_turning(w: Triple, turning: Triple, graph: &mut Graph) -> [Triple; 3] {
    let one = Rational::from_integer(1);
    let product = w.map(|x| w.map(|y| graph.mul(x, y)));
    let mut entry = |i: usize, j: usize| {
        let sum = if i == j {
            let [b, c] = [(i + 1) % 3, (i + 2) % 3];
            graph.sum([(product[b][b], -one), (product[c][c], -one)])
        } else {
            // For i ≠ j, ω̇ × e_j has the component ω̇_k along e_i if (i, k, j) is cyclic, else −ω̇_k.
            let k = 3 - i - j;
            let sign = if (k + 1) % 3 == j { one } else { -one };
            graph.sum([(product[i][j], one), (turning[k], sign)])
        };
        graph.defined(sum)
    };
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}
