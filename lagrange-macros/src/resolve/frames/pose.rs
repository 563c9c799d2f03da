//! How a frame lies and moves, from how the one that it is in does.
//!
//! A frame's twist is the angular velocity ω and the velocity v of its origin, both relative to the fixed frame and by
//! their components along its own axes. A step moves the origin or turns the axes (Featherstone, *Rigid Body Dynamics
//! Algorithms*, 2.8 and 5.3, with vectors of three in place of six):
//!
//! ```text
//! moved by s:             ω' = ω        v' = v + ω × s + ṡ
//! turned by E at rate ρ:  ω' = Eᵀω + ρ  v' = Eᵀv
//! ```

use super::super::value::cross;
use crate::symbolic::{Graph, Id};

pub(crate) type Triple = [Id; 3];

/// A frame, and the step that has led to it.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    /// The frame before the step, by its number; the fixed frame is 0 and has none.
    pub(crate) before: usize,
    pub(crate) step: Step,
    pub(crate) angular_velocity: Triple,
    pub(crate) velocity: Triple,
    /// The components of the fixed axes along its own, one row for each.
    pub(crate) axes: [Triple; 3],
    /// Where its origin is, along the fixed axes.
    pub(crate) origin: Triple,
}

/// What leads from one frame to the next.
#[derive(Clone, Debug)]
pub(crate) enum Step {
    /// The fixed frame.
    None,
    Moved(Moved),
    Turned(Turned),
}

/// By a vector s, in the axes before.
#[derive(Clone, Debug)]
pub(crate) struct Moved {
    pub(crate) by: Triple,
    pub(crate) rate: Triple,
}

/// By a rotation E, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Turned {
    pub(crate) by: [Triple; 3],
    /// The angular velocity, in the axes before and after alike: along those after.
    pub(crate) rate: Triple,
}

impl Frame {
    pub(crate) fn fixed() -> Self {
        let zero = [Id::ZERO; 3];
        let axes = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { Id::ONE } else { Id::ZERO }));
        Self { before: 0, step: Step::None, angular_velocity: zero, velocity: zero, axes, origin: zero }
    }

    /// This frame, number `before`, moved.
    pub(super) fn moved(&self, before: usize, moved: Moved, graph: &mut Graph) -> Self {
        let velocity = self.velocity_of(moved.by, moved.rate, graph);
        let origin = self.position_of(moved.by, graph);
        Self {
            before,
            velocity: named(velocity, graph),
            origin: named(origin, graph),
            step: Step::Moved(moved),
            ..self.clone()
        }
    }

    /// This frame, number `before`, turned.
    pub(super) fn turned(&self, before: usize, turned: Turned, graph: &mut Graph) -> Self {
        let step = Step::Turned(turned.clone());
        let carried = step.forth(self.angular_velocity, graph);
        let velocity = step.forth(self.velocity, graph);
        let axes = self.axes.map(|row| step.forth(row, graph));
        let angular_velocity = sum([carried, turned.rate], graph);
        Self {
            before,
            angular_velocity: named(angular_velocity, graph),
            velocity: named(velocity, graph),
            axes: axes.map(|row| named(row, graph)),
            origin: self.origin,
            step,
        }
    }

    /// v + ω × r + ṙ: the velocity of what is at r and has the velocity ṙ, both as seen from the frame.
    pub(super) fn velocity_of(&self, r: Triple, rate: Triple, graph: &mut Graph) -> Triple {
        let carried = cross(self.angular_velocity, r, graph);
        sum([self.velocity, carried, rate], graph)
    }

    /// Where what is at r in the frame is, along the fixed axes.
    pub(super) fn position_of(&self, r: Triple, graph: &mut Graph) -> Triple {
        let shift = self.axes.map(|row| graph.dot(&row, &r));
        sum([self.origin, shift], graph)
    }
}

impl Step {
    /// A vector along the axes before it, along those after.
    pub(crate) fn forth(&self, vector: Triple, graph: &mut Graph) -> Triple {
        match self {
            Self::Turned(turned) => columns(turned.by).map(|axis| graph.dot(&axis, &vector)),
            Self::Moved(_) | Self::None => vector,
        }
    }

    /// A vector along the axes after it, along those before.
    pub(crate) fn back(&self, vector: Triple, graph: &mut Graph) -> Triple {
        match self {
            Self::Turned(turned) => turned.by.map(|row| graph.dot(&row, &vector)),
            Self::Moved(_) | Self::None => vector,
        }
    }
}

impl Turned {
    /// Whether the axes are at rest in those before, and turned about none of them.
    pub(super) fn is_placement(&self) -> bool {
        self.rate == [Id::ZERO; 3] && self.by.iter().flatten().all(|&entry| entry != Id::ZERO)
    }

    /// First by this rotation, which does not change, and then by another.
    pub(super) fn then(&self, next: &Self, graph: &mut Graph) -> Self {
        let axes = columns(next.by);
        let by = self.by.map(|row| axes.map(|axis| graph.dot(&row, &axis)));
        Self { by: by.map(|row| named(row, graph)), ..next.clone() }
    }
}

pub(crate) fn columns([a, b, c]: [Triple; 3]) -> [Triple; 3] {
    std::array::from_fn(|j| [a[j], b[j], c[j]])
}

pub(crate) fn sum<const K: usize>(vectors: [Triple; K], graph: &mut Graph) -> Triple {
    std::array::from_fn(|i| graph.total(vectors.map(|vector| vector[i])))
}

/// A symmetric matrix from its upper triangle.
pub(crate) fn symmetric(mut entry: impl FnMut(usize, usize) -> Id) -> [Triple; 3] {
    let [a, b, c] = [entry(0, 0), entry(0, 1), entry(0, 2)];
    let [d, e, f] = [entry(1, 1), entry(1, 2), entry(2, 2)];
    [[a, b, c], [b, d, e], [c, e, f]]
}

/// Boundaries, so that what builds on them is not multiplied out.
pub(crate) fn named(vector: Triple, graph: &mut Graph) -> Triple {
    vector.map(|component| graph.defined(component))
}
