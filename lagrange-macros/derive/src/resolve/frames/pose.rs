//! Pose and twist of a frame, derived from those of the frame that it lies in.
//!
//! The twist of a frame is its angular velocity ω and the velocity v of its origin, both relative to the fixed frame,
//! by components along the axes of the frame itself. A step displaces the origin or rotates the axes (Featherstone,
//! *Rigid Body Dynamics Algorithms*, 2.8 and 5.3, with vectors of three in place of six):
//!
//! ```text
//! moved by s:             ω' = ω        v' = v + ω × s + ṡ
//! turned by E at rate ρ:  ω' = Eᵀω + ρ  v' = Eᵀv
//! ```

use super::super::value::cross;
use crate::symbolic::{Graph, Id};

pub(crate) type Triple = [Id; 3];

/// A frame, and the displacement or rotation that leads to it from the frame before.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    /// Index of the frame before the step. The fixed frame, index 0, has none.
    pub(crate) before: usize,
    pub(crate) step: Step,
    pub(crate) angular_velocity: Triple,
    pub(crate) velocity: Triple,
    /// Row i holds the components of fixed axis i along the axes of this frame.
    pub(crate) axes: [Triple; 3],
    /// Position of the origin, along the fixed axes.
    pub(crate) origin: Triple,
}

/// Step from one frame to the next.
#[derive(Clone, Debug)]
pub(crate) enum Step {
    /// No step: the fixed frame.
    None,
    Moved(Moved),
    Turned(Turned),
}

/// Displacement by a vector s, along the axes of the frame before.
#[derive(Clone, Debug)]
pub(crate) struct Moved {
    pub(crate) by: Triple,
    pub(crate) rate: Triple,
}

/// Rotation by a matrix E, by rows.
#[derive(Clone, Debug)]
pub(crate) struct Turned {
    pub(crate) by: [Triple; 3],
    /// Angular velocity relative to the frame before, along the axes after the rotation.
    pub(crate) rate: Triple,
}

impl Frame {
    pub(crate) fn fixed() -> Self {
        let zero = [Id::ZERO; 3];
        let axes = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { Id::ONE } else { Id::ZERO }));
        Self { before: 0, step: Step::None, angular_velocity: zero, velocity: zero, axes, origin: zero }
    }

    /// Frame after a displacement of this one, whose index is `before`.
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

    /// Frame after a rotation of this one, whose index is `before`.
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

    /// Velocity v + ω × r + ṙ of a point at r that moves at ṙ relative to the frame, along the axes of the frame.
    pub(super) fn velocity_of(&self, r: Triple, rate: Triple, graph: &mut Graph) -> Triple {
        let carried = cross(self.angular_velocity, r, graph);
        sum([self.velocity, carried, rate], graph)
    }

    /// Position, along the fixed axes, of a point at r in the frame.
    pub(super) fn position_of(&self, r: Triple, graph: &mut Graph) -> Triple {
        let shift = self.axes.map(|row| graph.dot(&row, &r));
        sum([self.origin, shift], graph)
    }
}

impl Step {
    /// Converts the components of a vector from the axes before the step to those after it.
    pub(crate) fn forth(&self, vector: Triple, graph: &mut Graph) -> Triple {
        match self {
            Self::Turned(turned) => columns(turned.by).map(|axis| graph.dot(&axis, &vector)),
            Self::Moved(_) | Self::None => vector,
        }
    }

    /// Converts the components of a vector from the axes after the step to those before it.
    pub(crate) fn back(&self, vector: Triple, graph: &mut Graph) -> Triple {
        match self {
            Self::Turned(turned) => turned.by.map(|row| graph.dot(&row, &vector)),
            Self::Moved(_) | Self::None => vector,
        }
    }
}

impl Turned {
    /// Returns whether the rotation is constant in time and no entry of its matrix is zero. The matrix of a rotation
    /// about a coordinate axis has zero entries.
    pub(super) fn is_placement(&self) -> bool {
        self.rate == [Id::ZERO; 3] && self.by.iter().flatten().all(|&entry| entry != Id::ZERO)
    }

    /// Composes this constant rotation with the one that follows it.
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

/// Symmetric matrix from its upper triangle.
pub(crate) fn symmetric(mut entry: impl FnMut(usize, usize) -> Id) -> [Triple; 3] {
    let [a, b, c] = [entry(0, 0), entry(0, 1), entry(0, 2)];
    let [d, e, f] = [entry(1, 1), entry(1, 2), entry(2, 2)];
    [[a, b, c], [b, d, e], [c, e, f]]
}

/// Wraps each component in a definition node, so that later products do not expand it.
pub(crate) fn named(vector: Triple, graph: &mut Graph) -> Triple {
    vector.map(|component| graph.defined(component))
}
