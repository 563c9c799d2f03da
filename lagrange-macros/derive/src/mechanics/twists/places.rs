//! Definitions that hold the positions and orientations of frames.

use indexmap::IndexMap;

use super::components::Twists;
use crate::resolve::Frame;
use crate::symbolic::{Graph, Id, Node};

/// A component of an axis row or of the origin of a frame.
#[derive(Clone, Copy)]
pub(super) struct RowOrOrigin {
    pub(super) frame: usize,
    pub(super) row: usize,
    /// Component of the row; `None` for the origin.
    pub(super) of: Option<usize>,
}

impl Twists<'_> {
    /// Definitions that hold positions and orientations of frames, each once.
    pub(super) fn places(&self, graph: &Graph) -> IndexMap<Id, RowOrOrigin> {
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
